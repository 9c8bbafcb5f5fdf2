#pragma once
/// What is shown where no source pixel arrived. The same fill runs after every method.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "warp_server/fill_guide.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Owns its scratch memory; one thread at a time.
class Fill {
public:
    virtual ~Fill() = default;
    [[nodiscard]] virtual std::string_view name() const = 0;
    /// Gives every hole a colour and a depth and marks it Coverage::filled. Reached pixels stay as they are.
    /// No allocation once sizes are seen.
    /// @param guide  of the motion from the layer to the frame
    virtual void apply(DisplayFrame& frame, const FillGuide& guide) = 0;

    /// From now on apply() may use these threads too; null: the caller's alone. The pool outlives this, and is idle
    /// while apply() runs. The picture is the same on any number of them.
    virtual void work_on(TaskPool* /*threads*/) {}
};

/// Shown where nothing at all is known.
inline constexpr Rgba8 kNothingColour{128, 128, 128, 255};

/// none (holes become opaque mid grey, depth 0), nearest-background, pyramid.
[[nodiscard]] std::vector<std::string_view> fill_names();
[[nodiscard]] Result<std::unique_ptr<Fill>> make_fill(std::string_view name);

/// Share of pixels that no source pixel reached, before or after fill. In [0, 1]; 0 for an empty frame.
[[nodiscard]] double hole_fraction(const DisplayFrame& frame);

}  // namespace lw
