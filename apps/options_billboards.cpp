#include "apps/option_declarer.h"
#include "apps/option_groups.h"

namespace lw {

void declare_billboards(Declarer& declare) {
    BillboardSettings& billboards = declare.options().billboards;
    declare.value(
        "--billboards", "off|flat|warped",
        "far objects of the client as quads that carry a G-buffer; warped: moved by their own depth (off)",
        [&billboards](const std::string& text) {
            option_values::check_name("way to draw billboards", "--billboards", text, {"off", "flat", "warped"});
            billboards.mode = text == "flat"     ? BillboardMode::flat
                              : text == "warped" ? BillboardMode::warped
                                                 : BillboardMode::off;
        });
    declare.value("--billboard-criterion", "angles|error",
                  "what makes a billboard be drawn anew: three angles, or the pixels it is off (error)",
                  [&billboards](const std::string& text) {
                      option_values::check_name("criterion", "--billboard-criterion", text, {"angles", "error"});
                      billboards.criterion = text == "angles" ? UpdateCriterion::angles : UpdateCriterion::error;
                  });
    declare.number("--billboard-error", "PX", {0.01, 1000.0}, billboards.error_cap_px,
                   "pixels that a billboard may be off (2)");
    declare.number("--billboard-updates", "N", {0, 100000}, billboards.max_updates,
                   "billboards drawn anew per frame; what is left is drawn as meshes (256)");
    declare.number("--billboard-budget", "MS", {0, 10000}, billboards.budget_ms,
                   "estimated time for them per frame, the worst first; what is left waits; 0: none (0)");
    declare.number("--billboard-fade", "N", {0, 60}, billboards.fade_frames,
                   "frames over which the new version of a billboard replaces the old one (0)");
}

}  // namespace lw
