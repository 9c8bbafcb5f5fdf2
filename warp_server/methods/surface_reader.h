/// Reading what lies inside of surfaces, at their exact places.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_READER_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_READER_H
#undef LW_WARP_SERVER_METHODS_SURFACE_READER_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_READER_H
#endif

#include <cstdint>
#include <optional>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_lattice_reader.h"
#include "warp_server/methods/surface_sampling.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Reads the lattice where there is one, else the pixels.
class SurfaceReader {
public:
    /// Both outlive this; `lattice` may be null.
    SurfaceReader(const LinearImage& image, const ColourLattice* lattice)
        : pixels_{image}, taps_{image.size_px(), lattice != nullptr ? kLatticeSteps : 1} {
        if (lattice != nullptr) lattice_.emplace(*lattice);
    }

    /// Taps at x, y: pixels from the centre of the first pixel; clamped to the image.
    [[nodiscard]] HWY_INLINE Taps taps_of(VF x_px, VF y_px) const { return taps_.at(x_px, y_px); }

    /// Asks for what a read at x, y touches, in pixels as above; any values.
    HWY_INLINE void prefetch(float x_px, float y_px) const {
        if (lattice_) {
            lattice_->prefetch(x_px, y_px);
        } else {
            pixels_.prefetch(x_px, y_px);
        }
    }

    /// Asks for what a run of taps wants soon that begins in this column and row.
    HWY_INLINE void prefetch_run(int column, int row) const {
        if (lattice_) {
            lattice_->prefetch_below(column, row);
        } else {
            pixels_.prefetch_row(column, row);
        }
    }

    /// ColourReader::read_along.
    [[nodiscard]] HWY_INLINE LinearColours read_along(const Taps& taps, std::uint32_t wanted, const std::int32_t* x,
                                                      const std::int32_t* y) const {
        return lattice_ ? lattice_->read(taps, wanted) : pixels_.read_along(taps, wanted, x, y);
    }

    /// Colours at the taps of the first `count` lanes, which mostly lie near each other, and anything at the others.
    [[nodiscard]] HWY_INLINE LinearColours read_some(const Taps& taps, std::size_t count) const {
        if (lattice_) return lattice_->read(taps, (1U << count) - 1U);
#if LW_HAS_WIDE_LOOKUPS
        LinearColours near;
        const auto all = hn::Eq(taps.x, taps.x);
        if (pixels_.read_near(taps, hn::RebindMask(DU{}, all), hn::GetLane(taps.x), hn::GetLane(taps.y), near)) {
            return near;
        }
#endif
        return pixels_.read(taps);
    }

    /// Of the pixels alone.
    [[nodiscard]] const ColourReader& pixels() const { return pixels_; }

private:
    ColourReader pixels_;
    std::optional<LatticeReader> lattice_;
    TapGrid taps_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
