#include "warp_server/methods/surface_split.h"

#include <cmath>

#include "warp_server/methods/surface_tolerances.h"

namespace lw {
namespace {

struct Span {
    float first;
    float last;
};

// Cells [0, cells) cut in the middle, the ends kept as they are.
Span part_of(float low, float high, float middle, bool second, float overlap) {
    return second ? Span{middle - overlap, high} : Span{low, middle + overlap};
}

}  // namespace

void split_patch(const PatchList& list, std::uint32_t index, PatchList& parts) {
    const float columns = std::ceil(list.right[index] - 0.5F);
    const float rows = std::ceil(list.bottom[index] - 0.5F);
    if (columns <= 1.0F && rows <= 1.0F) return;
    const float middle_x = std::floor(columns / 2.0F);
    const float middle_y = std::floor(rows / 2.0F);
    for (const bool lower : {false, true}) {
        if (lower && middle_y == 0.0F) continue;
        for (const bool right : {false, true}) {
            if (right && middle_x == 0.0F) continue;
            const Span x = middle_x == 0.0F
                               ? Span{list.left[index], list.right[index]}
                               : part_of(list.left[index], list.right[index], middle_x, right, kPatchOverlapPx);
            const Span y = middle_y == 0.0F
                               ? Span{list.top[index], list.bottom[index]}
                               : part_of(list.top[index], list.bottom[index], middle_y, lower, kPatchOverlapPx);
            const float from_x = right ? middle_x : 0.0F;
            const float from_y = lower ? middle_y : 0.0F;
            parts.x.push_back(list.x[index] + from_x);
            parts.y.push_back(list.y[index] + from_y);
            parts.depth.push_back(list.depth[index] + from_x * list.gradient_x[index] +
                                  from_y * list.gradient_y[index]);
            parts.gradient_x.push_back(list.gradient_x[index]);
            parts.gradient_y.push_back(list.gradient_y[index]);
            parts.left.push_back(x.first - from_x);
            parts.right.push_back(x.last - from_x);
            parts.top.push_back(y.first - from_y);
            parts.bottom.push_back(y.last - from_y);
            parts.object_id.push_back(list.object_id[index]);
            parts.corners.push_back(list.corners[index]);
        }
    }
}

}  // namespace lw
