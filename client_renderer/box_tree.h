#pragma once
/// The hierarchical test of many boxes: whole subtrees in or out of view, or hidden, at one test.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/box_list.h"
#include "client_renderer/frustum.h"
#include "client_renderer/occlusion_buffer.h"
#include "client_renderer/wide_bvh.h"
#include "core/task_pool.h"
#include "scene/bvh.h"

namespace lw {

/// An item and the frusta that may see it, one bit each.
struct SeenItem {
    std::uint32_t item = 0;
    std::uint32_t frusta = 0;
};

/// What a walk did.
struct WalkCounters {
    std::uint64_t nodes = 0;                  ///< visited
    std::uint64_t items = 0;                  ///< tested one by one
    std::uint64_t items_outside = 0;          ///< out of view, one by one or with their subtree
    std::uint64_t items_hidden = 0;           ///< behind occluders, one by one or with their subtree
    std::uint64_t items_too_small = 0;        ///< below the pixel size asked for
    std::uint64_t items_between_samples = 0;  ///< too thin to meet a sample of the picture; only with occlusion

    WalkCounters& operator+=(const WalkCounters& other);
    friend bool operator==(const WalkCounters&, const WalkCounters&) = default;
};

/// What a view needs of the boxes.
struct WalkQuery {
    FloatFrustum frustum;
    const OcclusionBuffer* occlusion = nullptr;  ///< null: nothing is hidden
    std::array<float, 3> eye_world{};            ///< for sizes
    /// Boxes whose bounding sphere looks smaller than this across are left out: metres per metre of distance. 0: none.
    float least_size_per_distance = 0.0F;
};

/// A node that a walk still has to look into, and the planes it is not inside of.
struct OpenNode {
    WideBvh::Child node;
    unsigned planes = 0;
};

/// A walk, or one thread's part of it, from some nodes on. Nothing of it lies in a cache line of another.
struct alignas(64) WalkPart {
    std::vector<OpenNode> open;       ///< in the order in which they were found
    std::size_t next = 0;             ///< of open, the first that was not looked into
    std::vector<std::uint32_t> seen;  ///< items
    WalkCounters counters;
};

/// Boxes in a hierarchy whose nodes have up to sixteen children, tested together on a wide vector. Plane masking: a
/// plane that a node lies inside is not tested again below it; what lies inside all of them is taken without tests
/// (seed 002, section 19.4). One thread at a time.
class BoxTree {
public:
    static constexpr std::size_t kMostFrusta = 8;

    explicit BoxTree(std::span<const scene::Bounds> boxes);

    /// Fits the hierarchy to items that moved; `boxes` are those of all items.
    void move(std::span<const std::uint32_t> moved, std::span<const scene::Bounds> boxes);

    /// Appends the items that may be seen, in no particular order. As may_see(), it may keep one that is not in view or
    /// is hidden, never leave out one that is seen.
    /// @param threads  that share the walk, for the same items and counters; null: the caller's alone
    void append_seen(const WalkQuery& query, std::vector<std::uint32_t>& seen, TaskPool* threads = nullptr);

    /// The same for up to kMostFrusta frusta in one walk: both eyes, the faces of a cube. An item appears once.
    void append_seen(std::span<const Frustum> frusta, std::vector<SeenItem>& seen);

    [[nodiscard]] const WalkCounters& counters() const { return counters_; }  ///< of the last walk
    [[nodiscard]] const scene::Bvh& bvh() const { return bvh_; }
    /// In the order of the hierarchy.
    [[nodiscard]] const BoxList& boxes() const { return boxes_; }
    [[nodiscard]] const WideBvh& wide() const { return wide_; }

private:
    /// Divides what is left of a walk among this many parts.
    void share_out(std::size_t parts);

    scene::Bvh bvh_;
    WideBvh wide_;    ///< for one view
    WalkPart begin_;  ///< of a walk; the whole for one thread
    std::vector<WalkPart> parts_;
    BoxList boxes_;  ///< for several
    WalkCounters counters_;
};

}  // namespace lw
