#include "apps/image_errors.h"

#include "core/metrics.h"

namespace lw {

ImageErrors errors_against(const ColourImage& truth, const ColourImage& shown, double pixels_per_degree,
                           const Image<ErrorCause>* causes) {
    ImageErrors errors;
    const FlipResult difference = flip(truth, shown, pixels_per_degree);
    errors.flip = difference.mean;
    if (causes != nullptr) errors.attribution = attribute_error(difference.error_map, *causes);
    errors.ssim = ssim(truth, shown);
    errors.psnr_db = psnr_db(truth, shown);
    return errors;
}

}  // namespace lw
