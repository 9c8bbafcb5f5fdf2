#pragma once
/// The interface of every warp method. To add one: a file in warp_server/methods/ and a line in methods/registry.cpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/pixel_rect.h"

namespace lw {

class TaskPool;

/// What became of a target pixel.
enum class Coverage : std::uint8_t {
    hole = 0,     ///< no source pixel reached it; colour and depth are unspecified until filled
    reached = 1,  ///< shows a source pixel (background counts as reached)
    filled = 2,   ///< was a hole; the fill invented it
};

/// A pixel of which surfaces cover only a part, with nothing known behind them.
struct PartlyCovered {
    std::uint32_t pixel = 0;  ///< number in the picture
    float share = 0.0F;       ///< in (0, 1)
    float depth = 0.0F;       ///< of the largest of them
    Rgba8 colour;             ///< of them alone
};

/// The picture of one display refresh. All images have the target's size.
struct DisplayFrame {
    ColourImage colour;  ///< opaque
    DepthImage depth;    ///< reversed infinite depth of the target camera
    Image<Coverage> coverage;
    /// Pixels along edges beside holes: those covered by half or more are `reached` and have the colour as it is here,
    /// the others are holes. What a fill makes of the hole belongs beside the surface (part_cover.h).
    std::vector<PartlyCovered> partly_covered;

    void resize(glm::ivec2 size_px) {
        colour.resize(size_px);
        depth.resize(size_px);
        coverage.resize(size_px);
        partly_covered.clear();
    }
};

/// Where and when the picture is shown.
struct WarpTarget {
    Camera camera;                            ///< predicted to photon time
    std::span<const ObjectTransform> movers;  ///< placements at photon time; a missing one holds its source placement
    /// Which of two eyes looks: layers drawn for the other one are passed over. Nothing: every layer is shown.
    std::optional<Eye> eye{};
};

/// One of several layers that are shown as one picture.
struct StackedLayer {
    const Layer* layer = nullptr;
    /// Its depths count as so much: of two pictures of one surface, at nearly the same depth, that with the larger
    /// share is seen.
    float depth_share = 1.0F;
    PixelRect reach;             ///< of the target: it shows nothing outside
    float nearest_depth = 1.0F;  ///< in the target; none of its surfaces is nearer
};

/// What a stack of layers is put on.
enum class StackBase {
    nothing,
    picture,  ///< what is there. Its depths say what may change: below 0 a pixel shows nothing yet, above 1 it stays
};

/// What one warp left out. Pixels that could not be used are skipped, never fatal; the rest was found not to be seen
/// before it was drawn. Methods that do not work by tiles leave their counts at 0.
struct WarpCounters {
    std::uint64_t bad_depth = 0;        ///< pixels: NaN, infinite or outside [0, 1]
    std::uint64_t unknown_object = 0;   ///< pixels: an id without a placement in the layer
    std::uint64_t tiles_empty = 0;      ///< of objects without a placement, or seen from behind or edge-on
    std::uint64_t tiles_outside = 0;    ///< land outside of the picture
    std::uint64_t tiles_hidden = 0;     ///< land behind what is there; counted by each thread that met it
    std::uint64_t pictures_reused = 0;  ///< 1: nothing had changed, the picture before is shown again

    WarpCounters& operator+=(const WarpCounters& other) {
        bad_depth += other.bad_depth;
        unknown_object += other.unknown_object;
        tiles_empty += other.tiles_empty;
        tiles_outside += other.tiles_outside;
        tiles_hidden += other.tiles_hidden;
        pictures_reused += other.pictures_reused;
        return *this;
    }
};

/// A warp method with its settings and scratch memory. One thread at a time calls warp(); prepare() may run on another
/// thread at the same time. No allocation in warp() once sizes are seen.
class WarpMethod {
public:
    virtual ~WarpMethod() = default;

    /// As given, with settings: "points:size_px=2".
    [[nodiscard]] virtual std::string_view label() const = 0;

    /// Work done once per layer, on the client's thread before the layer is published; null when there is none.
    /// Thread safe.
    [[nodiscard]] virtual std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const {
        (void)layer;
        return nullptr;
    }

    /// Moves every pixel of `layer` to where it belongs in `target`. Overwrites all of `out`, which is resized to the
    /// target. Nearest surface wins; samples nearer than the target's near plane are skipped. A method that needs
    /// prepare() runs it itself when the layer was not prepared for it.
    virtual void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) = 0;

    /// The threads it works on, lent to what comes after it in the same display frame; null: the caller's alone.
    [[nodiscard]] virtual TaskPool* threads() { return nullptr; }

    /// Whether it shows frames as they were drawn instead of where things are now.
    [[nodiscard]] virtual bool shows_frames_as_drawn() const { return false; }

    /// Whether it has warp_stack().
    [[nodiscard]] virtual bool can_stack() const { return false; }

    /// Moves several layers into one picture: each pixel shows the nearest of all, and along edges of one layer what
    /// another has behind. Layers that have nothing to show where they reach are passed over, so those that hide others
    /// should come first. Programmer error where can_stack() is false.
    /// @param out  overwritten on StackBase::nothing; else a picture of the target's size
    virtual void warp_stack(std::span<const StackedLayer> layers, const WarpTarget& target, StackBase base,
                            DisplayFrame& out);

    /// Of the last warp() or warp_stack().
    [[nodiscard]] const WarpCounters& counters() const { return counters_; }

protected:
    /// What prepare() returned for `layer`; made here and kept by `own` when the layer was not prepared for this
    /// method.
    template <class Prepared>
    [[nodiscard]] const Prepared& prepared_or_made(const Layer& layer,
                                                   std::shared_ptr<const PreparedLayer>& own) const {
        const PreparedLayer* prepared = layer.prepared_for(label());
        if (prepared == nullptr) {
            own = prepare(layer);
            prepared = own.get();
        }
        return static_cast<const Prepared&>(*prepared);
    }

    WarpCounters counters_;
};

}  // namespace lw
