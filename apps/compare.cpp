/// `latewarp compare`: how different two images are.

#include <cstdio>

#include "apps/image_errors.h"
#include "apps/report.h"
#include "apps/subcommands.h"
#include "core/image_io.h"

namespace lw {

Status run_compare(const Options& options) {
    const Result<ColourImage> reference = read_png(options.input);
    if (!reference) return reference.error();
    const Result<ColourImage> judged = read_png(options.other_input);
    if (!judged) return judged.error();
    const glm::ivec2 a_px = reference->size_px();
    const glm::ivec2 b_px = judged->size_px();
    if (a_px != b_px) {
        return Error{fmt::format("images of different sizes, {}x{} and {}x{}", a_px.x, a_px.y, b_px.x, b_px.y),
                     fmt::format("{} and {}", options.input.string(), options.other_input.string()),
                     "compare images of one size"};
    }
    const ImageErrors errors = errors_against(*reference, *judged, options.pixels_per_degree);
    Report report;
    report.set("psnr_db", errors.psnr_db);
    report.set("ssim", errors.ssim);
    report.set("flip", errors.flip);
    std::fputs(report.text().c_str(), stdout);
    return Done{};
}

}  // namespace lw
