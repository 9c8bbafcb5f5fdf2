#include "warp_server/fill_nearest_background.h"

#include <algorithm>
#include <vector>

#include "warp_server/hole_ends.h"

namespace lw {
namespace {

class NearestBackgroundFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "nearest-background"; }

    void apply(DisplayFrame& frame, const FillGuide& /*guide*/) override {
        ends_.find(frame, threads_);
        frame_ = &frame;
        const bool alone = threads_ == nullptr || ends_.hole_count() < HoleEnds::kWorthThreads;
        if (alone) return fill(ends_.runs(), scratch_[0]);
        shares_ = kSharesPerThread * threads_->threads();
        threads_->run(shares_, fill_share_);
    }

    void work_on(TaskPool* threads) override {
        threads_ = threads;
        scratch_.resize(threads == nullptr ? 1 : static_cast<std::size_t>(threads->threads()));
    }

private:
    static constexpr std::size_t kAhead = 16;
    static constexpr int kSharesPerThread = 4;

    // What is copied was reached, and what is written was not: shares do not meet.
    void fill(std::span<const HoleRun> runs, HoleScratch& scratch) {
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const HoleRun& run = runs[i];
            prefetch(*frame_, runs[std::min(i + kAhead, runs.size() - 1)]);
            copy(*frame_, run, ends_.background_of(*frame_, run, scratch).index);
            const auto coverage = frame_->coverage.row(run.y);
            std::fill(coverage.begin() + run.begin, coverage.begin() + run.end, Coverage::filled);
        }
    }

    // The ends of a short run, which most are: reading them was what the time went for.
    static void prefetch(const DisplayFrame& frame, const HoleRun& run) {
        const std::ptrdiff_t width = frame.depth.width();
        const std::ptrdiff_t first = run.y * width + run.begin;
        const auto last = static_cast<std::ptrdiff_t>(frame.depth.pixels().size()) - 1;
        for (const std::ptrdiff_t pixel : {first - width, first - 1, first + width}) {
            if (pixel < 0 || pixel > last) continue;
            __builtin_prefetch(frame.depth.pixels().data() + pixel);
            __builtin_prefetch(frame.colour.pixels().data() + pixel);
        }
    }

    static void copy(DisplayFrame& frame, const HoleRun& run, std::span<const std::int32_t> chosen) {
        const std::span<Rgba8> colours = frame.colour.pixels();
        const std::span<float> depths = frame.depth.pixels();
        const std::span<Rgba8> colours_to = frame.colour.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        const std::span<float> depths_to = frame.depth.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            // In a long run it lies above or below, in another row for every pixel.
            const auto next = static_cast<std::size_t>(std::max(chosen[std::min(i + kAhead, chosen.size() - 1)], 0));
            __builtin_prefetch(depths.data() + next);
            __builtin_prefetch(colours.data() + next);
            const std::int32_t from = chosen[i];
            colours_to[i] = from < 0 ? kNothingColour : colours[static_cast<std::size_t>(from)];
            depths_to[i] = from < 0 ? 0.0F : depths[static_cast<std::size_t>(from)];
        }
    }

    HoleEnds ends_;
    DisplayFrame* frame_ = nullptr;
    TaskPool* threads_ = nullptr;
    std::vector<HoleScratch> scratch_{1};  // by worker
    int shares_ = 1;
    // Kept, because making a function object may allocate.
    TaskPool::Work fill_share_ = [this](int share, int worker) {
        fill(ends_.share(share, shares_), scratch_[static_cast<std::size_t>(worker)]);
    };
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
