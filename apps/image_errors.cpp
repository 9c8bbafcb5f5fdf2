#include "apps/image_errors.h"

#include "core/metrics.h"

namespace lw {

ImageErrors errors_against(const ColourImage& truth, const ColourImage& shown, double pixels_per_degree) {
    ImageErrors errors;
    errors.flip = flip(truth, shown, pixels_per_degree).mean;
    errors.ssim = ssim(truth, shown);
    errors.psnr_db = psnr_db(truth, shown);
    return errors;
}

}  // namespace lw
