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
        if (threads_ == nullptr || ends_.hole_count() < HoleEnds::kWorthThreads) {
            fill(ends_.columns(), workers_[0]);
        } else {
            shares_ = kSharesPerThread * threads_->threads();
            threads_->run(shares_, fill_share_);
        }
        ends_.spread_sideways([&](int y, int x, int from_x) {
            frame.colour.at(x, y) = frame.colour.at(from_x, y);
            frame.depth.at(x, y) = frame.depth.at(from_x, y);
        });
    }

    void work_on(TaskPool* threads) override {
        threads_ = threads;
        workers_.resize(threads == nullptr ? 1 : static_cast<std::size_t>(threads->threads()));
    }

private:
    static constexpr std::size_t kAhead = 16;
    static constexpr int kSharesPerThread = 2;

    // What one thread works with.
    struct Worker {
        std::vector<HolePart> parts;
        HoleScratch scratch;
    };

    // What is copied was reached, and what is written was not: shares do not meet.
    void fill(RowRange columns, Worker& worker) {
        const std::vector<HolePart>& parts = worker.parts;
        ends_.parts_in(columns, worker.parts);
        worker.scratch.resize(frame_->depth.width());
        for (std::size_t i = parts.size(); i-- > 0;) look_below(*frame_, parts[i], worker.scratch);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            prefetch(parts[std::min(i + kAhead, parts.size() - 1)]);
            choose_background(*frame_, parts[i], {}, worker.scratch);
            copy_background(*frame_, parts[i], kNothingColour, worker.scratch);
        }
        for (const HolePart& part : parts) {
            const auto coverage = frame_->coverage.row(part.run.y);
            std::fill(coverage.begin() + part.columns.begin, coverage.begin() + part.columns.end, Coverage::filled);
        }
    }

    // The ends of a short run, which most are: reading them was what the time went for.
    void prefetch(const HolePart& part) const {
        const std::ptrdiff_t width = frame_->depth.width();
        const std::ptrdiff_t first = part.run.y * width + part.columns.begin;
        const auto last = static_cast<std::ptrdiff_t>(frame_->depth.pixels().size()) - 1;
        for (const std::ptrdiff_t pixel : {first - width, first - 1, first + width}) {
            if (pixel < 0 || pixel > last) continue;
            __builtin_prefetch(frame_->depth.pixels().data() + pixel);
            __builtin_prefetch(frame_->colour.pixels().data() + pixel);
        }
    }

    HoleEnds ends_;
    DisplayFrame* frame_ = nullptr;
    TaskPool* threads_ = nullptr;
    std::vector<Worker> workers_{1};
    int shares_ = 1;
    // Kept, because making a function object may allocate.
    TaskPool::Work fill_share_ = [this](int share, int worker) {
        fill(ends_.share(share, shares_), workers_[static_cast<std::size_t>(worker)]);
    };
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
