#pragma once
/// Boxes as a structure of arrays, tested against a view many at a time on wide vectors.

#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/frustum.h"
#include "scene/scene.h"

namespace lw {

/// Axis-aligned boxes in world space, single precision. Changes and tests are for one thread at a time.
class BoxList {
public:
    /// Empty boxes are never seen.
    void resize(std::size_t count);
    void set(std::size_t index, const scene::Bounds& bounds_world);

    [[nodiscard]] std::size_t size() const { return size_; }

    /// Appends the indices, ascending, of the boxes that are not wholly outside one of the frustum's half spaces. As
    /// may_see(): it may keep a box that is not in view, never leave out one that is.
    void append_seen(const Frustum& frustum, std::vector<std::uint32_t>& seen) const;

    /// Six arrays of padded size: centre x y z, half size x y z.
    [[nodiscard]] const float* row(int which) const { return rows_.data() + static_cast<std::size_t>(which) * stride_; }

private:
    std::size_t size_ = 0;
    std::size_t stride_ = 0;  ///< size rounded up to whole vectors
    std::vector<float> rows_;
};

}  // namespace lw
