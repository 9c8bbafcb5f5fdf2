/// Single pixels of `surface`, collected until they fill vectors: reading and encoding colours costs the same for one
/// as for a vector full.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_QUEUES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_QUEUES_H
#undef LW_WARP_SERVER_METHODS_SURFACE_QUEUES_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_QUEUES_H
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_reader.h"
#include "warp_server/methods/surface_sampling.h"
#include "warp_server/warp_method.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Places in a queue's arrays: a batch, and room for the vector that fills it and what a store writes beyond.
inline constexpr std::size_t kBatch = 16 * kMaxLanes;
inline constexpr std::size_t kQueueRoom = kBatch + 2 * kMaxLanes;

/// Appends the lanes `wanted` to `to`, whose lanes beyond are overwritten too.
template <class D, class T, class M>
HWY_INLINE void append_lanes(D d, hn::VFromD<D> values, M wanted, T* to) {
    hn::StoreU(hn::Compress(values, hn::RebindMask(d, wanted)), d, to);
}

// Pieces overlap a little, and the number of lanes decides which comes first: of equal depths the larger word is shown.

/// Runs of opaque pixels in a row whose depth is written already. Reading and encoding one run waits for one result
/// after the other; many runs in turn wait for none.
class RunQueue {
public:
    RunQueue(const SurfaceReader& reader, const ColourEncoder& encoder, DisplayFrame& out)
        : reader_{reader}, encoder_{encoder}, colours_{reinterpret_cast<std::uint32_t*>(out.colour.pixels().data())} {}

    /// The lanes whose bits are in `wanted`, of the pixels from number `pixel` on, show the source at the taps. Those
    /// of them in `equal` have the depth that was there.
    HWY_INLINE void push(std::uint32_t wanted, std::uint32_t equal, std::size_t pixel, const Taps& taps) {
        __builtin_prefetch(colours_ + pixel, 1);
        Run& run = runs_[count_++];
        run.wanted = wanted;
        run.equal = equal;
        run.pixel = pixel;
        hn::Store(taps.x, DI{}, run.x);
        hn::Store(taps.y, DI{}, run.y);
        hn::Store(taps.fx, DI{}, run.fx);
        hn::Store(taps.fy, DI{}, run.fy);
        // Where a tile begins, no run above has asked for these.
        reader_.prefetch_run(hn::GetLane(taps.x), hn::GetLane(taps.y));
        if (count_ == kRuns) flush();
    }

    HWY_NOINLINE void flush() {
        for (std::size_t i = 0; i < count_; ++i) read(runs_[i]);
        for (std::size_t i = 0; i < count_; ++i) {
            const Run& run = runs_[i];
            const LinearColours linear{hn::Load(DU{}, run.red), hn::Load(DU{}, run.green), hn::Load(DU{}, run.blue)};
            auto colour = encoder_.encoded(linear);
            if (run.equal != 0) {
                const auto larger = hn::Max(colour, hn::LoadU(DU{}, colours_ + run.pixel));
                colour = hn::IfThenElse(lanes_of_bits(DU{}, run.equal), larger, colour);
            }
            hn::BlendedStore(colour, lanes_of_bits(DU{}, run.wanted), DU{}, colours_ + run.pixel);
        }
        count_ = 0;
    }

private:
    static constexpr std::size_t kRuns = 16;

    struct Run {
        HWY_ALIGN std::int32_t x[kMaxLanes];
        HWY_ALIGN std::int32_t y[kMaxLanes];
        HWY_ALIGN std::int32_t fx[kMaxLanes];
        HWY_ALIGN std::int32_t fy[kMaxLanes];
        HWY_ALIGN std::uint32_t red[kMaxLanes];
        HWY_ALIGN std::uint32_t green[kMaxLanes];
        HWY_ALIGN std::uint32_t blue[kMaxLanes];
        std::size_t pixel;
        std::uint32_t wanted;
        std::uint32_t equal;
    };

    HWY_INLINE void read(Run& run) const {
        const Taps taps{hn::Load(DI{}, run.x), hn::Load(DI{}, run.y), hn::Load(DI{}, run.fx), hn::Load(DI{}, run.fy)};
        const LinearColours linear = reader_.read_along(taps, run.wanted, run.x, run.y);
        hn::Store(linear.red, DU{}, run.red);
        hn::Store(linear.green, DU{}, run.green);
        hn::Store(linear.blue, DU{}, run.blue);
    }

    const SurfaceReader& reader_;
    const ColourEncoder& encoder_;
    std::uint32_t* colours_;
    std::size_t count_ = 0;
    Run runs_[kRuns];
};

/// Opaque pixels: shown where nothing nearer is.
class PixelQueue {
public:
    /// What is in `runs` is shown first.
    PixelQueue(const SurfaceReader& reader, const ColourEncoder& encoder, RunQueue& runs, DisplayFrame& out)
        : reader_{reader},
          encoder_{encoder},
          runs_{runs},
          depths_{out.depth.pixels().data()},
          colours_{reinterpret_cast<std::uint32_t*>(out.colour.pixels().data())} {}

    /// The lanes `wanted`: target pixel number `pixel` of depth `depth` shows the source at x, y, in pixels from the
    /// centre of its first one.
    template <class M>
    HWY_INLINE void push(M wanted, hn::VFromD<DI> pixel, VF depth, VF x, VF y) {
        // What flush() will touch is on its way by then: waiting for it was half of the time.
        // Lanes are in rows of one place, or in places near each other: two of them ask for most.
        prefetch<0>(pixel, x, y);
        prefetch<kMaxLanes / 2>(pixel, x, y);
        append_lanes(DI{}, pixel, wanted, pixel_ + count_);
        append_lanes(DF{}, depth, wanted, depth_ + count_);
        append_lanes(DF{}, x, wanted, x_ + count_);
        append_lanes(DF{}, y, wanted, y_ + count_);
        count_ += hn::CountTrue(DF{}, wanted);
        if (count_ >= kBatch) flush();
    }

    HWY_NOINLINE void flush() {
        runs_.flush();
        const std::size_t lanes = hn::Lanes(DF{});
        hn::StoreU(hn::Zero(DF{}), DF{}, x_ + count_);  // what a store left beyond the end may be no place at all
        hn::StoreU(hn::Zero(DF{}), DF{}, y_ + count_);
        HWY_ALIGN std::uint32_t colours[kMaxLanes];
        for (std::size_t i = 0; i < count_; i += lanes) {
            const Taps taps = reader_.taps_of(hn::Load(DF{}, x_ + i), hn::Load(DF{}, y_ + i));
            // Pixels that follow each other mostly come from one tile or one row of cells.
            const std::size_t end = std::min(lanes, count_ - i);
            hn::Store(encoder_.encoded(reader_.read_some(taps, end)), DU{}, colours);
            for (std::size_t lane = 0; lane < end; ++lane) {
                const auto pixel = static_cast<std::size_t>(pixel_[i + lane]);
                // Without branches, which nothing could predict.
                const std::int64_t shown = key_of(depths_[pixel], colours_[pixel]);
                const std::int64_t best = std::max(shown, key_of(depth_[i + lane], colours[lane]));
                depths_[pixel] = std::bit_cast<float>(static_cast<std::int32_t>(best >> 32));
                colours_[pixel] = static_cast<std::uint32_t>(best);
            }
        }
        count_ = 0;
    }

private:
    // What lane `kLane` shows, or would: any values.
    template <std::size_t kLane>
    HWY_INLINE void prefetch(hn::VFromD<DI> pixel, VF x, VF y) const {
        if (kLane >= hn::Lanes(DF{})) return;
        const std::ptrdiff_t at = hn::ExtractLane(pixel, kLane);
        __builtin_prefetch(depths_ + at, 1);
        __builtin_prefetch(colours_ + at, 1);
        reader_.prefetch(hn::ExtractLane(x, kLane), hn::ExtractLane(y, kLane));
    }

    // Grows with the depth, then with the colour. Depths are >= 0, or negative where nothing is shown; as whole numbers
    // they are in the same order, but for -0.
    [[nodiscard]] static HWY_INLINE std::int64_t key_of(float depth, std::uint32_t colour) {
        const auto high = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(depth + 0.0F));
        return static_cast<std::int64_t>(high << 32U | colour);
    }

    const SurfaceReader& reader_;
    const ColourEncoder& encoder_;
    RunQueue& runs_;
    float* depths_;
    std::uint32_t* colours_;
    std::size_t count_ = 0;
    HWY_ALIGN std::int32_t pixel_[kQueueRoom];
    HWY_ALIGN float depth_[kQueueRoom];
    HWY_ALIGN float x_[kQueueRoom];
    HWY_ALIGN float y_[kQueueRoom];
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
