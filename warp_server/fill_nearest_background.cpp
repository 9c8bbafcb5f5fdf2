#include "warp_server/fill_nearest_background.h"

#include <algorithm>

#include "warp_server/hole_ends.h"

namespace lw {
namespace {

class NearestBackgroundFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "nearest-background"; }

    void apply(DisplayFrame& frame, const FillGuide& /*guide*/) override {
        ends_.find(frame);
        for (const HoleRun& run : ends_.runs()) copy(frame, run, ends_.background_of(frame, run).index);
        // Last, because the passes above tell holes from reached pixels by it.
        for (const HoleRun& run : ends_.runs()) {
            const auto row = frame.coverage.row(run.y);
            std::fill(row.begin() + run.begin, row.begin() + run.end, Coverage::filled);
        }
    }

private:
    static void copy(DisplayFrame& frame, const HoleRun& run, std::span<const std::int32_t> chosen) {
        const std::span<Rgba8> colours = frame.colour.pixels();
        const std::span<float> depths = frame.depth.pixels();
        const std::span<Rgba8> colours_to = frame.colour.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        const std::span<float> depths_to = frame.depth.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const std::int32_t from = chosen[i];
            colours_to[i] = from < 0 ? kNothingColour : colours[static_cast<std::size_t>(from)];
            depths_to[i] = from < 0 ? 0.0F : depths[static_cast<std::size_t>(from)];
        }
    }

    HoleEnds ends_;
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
