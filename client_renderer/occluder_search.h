#pragma once
/// The part of a best-first search for occluders that looks at many boxes: which children of a node are worth a look.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "client_renderer/frustum.h"
#include "client_renderer/occlusion_buffer.h"
#include "client_renderer/wide_bvh.h"

namespace lw {

struct OccluderQuery {
    FloatFrustum frustum;
    glm::vec3 eye_world{0.0F};
    float least_score = 0.0F;
    std::uint32_t end = 0;  ///< occluders before it
};

/// A slot of the hierarchy, for a heap: the best score on top, equal ones by slot.
class OccluderCandidate {
public:
    OccluderCandidate(float score, std::uint32_t slot);

    [[nodiscard]] std::uint32_t slot() const { return ~static_cast<std::uint32_t>(key_); }
    friend bool operator<(OccluderCandidate a, OccluderCandidate b) { return a.key_ < b.key_; }

private:
    std::uint64_t key_;
};

/// Appends the children of a node that are in view, look large enough and are not hidden by what the buffer holds. The
/// score is how large they look, roughly, at their nearest point: area over squared distance.
/// @param areas  by slot, square metres of the largest side of any occluder in it
void append_worth(const WideBvh& tree, const WideBvh::Child& node, const float* areas, const OccluderQuery& query,
                  const OcclusionBuffer& buffer, std::vector<OccluderCandidate>& candidates);

}  // namespace lw
