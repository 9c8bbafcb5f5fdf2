#include "client_renderer/box_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/box_tree.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <array>
#include <bit>

#include "client_renderer/box_kernels.h"
#include "core/check.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// Deeper than any tree of 2^32 items that is halved at worst in places.
constexpr std::size_t kMostDepth = 256;

/// Bits of planes of `mask` that the box is not wholly inside of; kOutside when it is wholly outside one of them.
constexpr unsigned kOutside = 0xFFU;

HWY_INLINE unsigned planes_left(const scene::BvhNode& node, const FloatFrustum& frustum, unsigned mask) {
    const glm::vec3 centre = 0.5F * (node.min + node.max);
    const glm::vec3 half = 0.5F * (node.max - node.min);
    unsigned left = mask;
    const auto tests = [&](unsigned p) {
        const FloatFrustum::Plane& plane = frustum.planes[p];
        const float reach = std::abs(plane.x) * half.x + std::abs(plane.y) * half.y + std::abs(plane.z) * half.z;
        const float place = plane.x * centre.x + plane.y * centre.y + plane.z * centre.z + plane.w;
        const float size = std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z) + std::abs(plane.w) + reach;
        const float rounding = kFrustumRounding * size;
        if (place + reach < -rounding) return false;
        if (place - reach >= rounding) left &= ~(1U << p);
        return true;
    };
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        if (!tests(static_cast<unsigned>(std::countr_zero(rest)))) return kOutside;
    }
    return left;
}

/// A vector of boxes against a frustum.
struct InFrustum {
    std::uint32_t not_outside = 0;            ///< bits of boxes
    std::array<std::uint32_t, 5> crossing{};  ///< by plane: boxes that are not wholly inside

    /// The planes that are still to be tested inside a box.
    [[nodiscard]] unsigned planes_of(std::uint32_t box) const {
        unsigned planes = 0;
        for (unsigned p = 0; p < crossing.size(); ++p) planes |= (crossing[p] >> box & 1U) << p;
        return planes;
    }
};

HWY_INLINE InFrustum against(const BoxVector& boxes, const FloatFrustum& frustum, unsigned planes) {
    const DF d;
    InFrustum in;
    MF not_outside = hn::Ge(boxes.half_x, hn::Zero(d));
    for (; planes != 0; planes &= planes - 1) {
        const auto p = static_cast<std::size_t>(std::countr_zero(planes));
        const PlaneDistance distance = distance_of(boxes, frustum.planes[p]);
        not_outside = hn::And(not_outside, hn::Ge(hn::Add(distance.place, distance.reach), hn::Neg(distance.rounding)));
        in.crossing[p] = bits_of(hn::Lt(hn::Sub(distance.place, distance.reach), distance.rounding));
    }
    in.not_outside = bits_of(not_outside);
    return in;
}

class Walk {
public:
    Walk(const BoxTree& tree, const WalkQuery& query, WalkPart& part)
        : order_{tree.bvh().order()},
          wide_{tree.wide()},
          query_{query},
          seen_{part.seen},
          counters_{part.counters},
          open_{part.open},
          next_{part.next} {}

    /// Until all nodes have been looked into, or `most_open` wait.
    void run(std::size_t most_open) {
        // First come, first served: what is asked for when a node is found has come when its turn comes.
        const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
        while (next_ < open_.size() && open_.size() - next_ < most_open) {
            const OpenNode entry = open_[next_++];
            ++counters_.nodes;
            for (std::uint32_t i = 0; i < entry.node.slot_count; i += lanes) {
                visit(entry.node.first + i, lowest_bits(std::min(lanes, entry.node.slot_count - i)), entry.planes);
            }
        }
    }

private:
    /// A vector of slots.
    /// @param all  bits of those that there are
    void visit(std::uint32_t first, std::uint32_t all, unsigned planes) {
        const WideBvh::Block& block = wide_.block(first);
        const BoxVector boxes = load_boxes(block.boxes, first % WideBvh::kMostChildren);
        const InFrustum in = against(boxes, query_.frustum, planes);
        std::uint32_t bits = all & in.not_outside;
        if (bits != all) counters_.items_outside += items_of(first, all & ~bits);
        if (query_.occlusion != nullptr && bits != 0) bits = not_hidden(boxes, first, bits);
        const bool by_size = query_.least_size_per_distance > 0;
        const std::uint32_t large =
            by_size ? bits_of(large_enough(boxes, query_.eye_world, query_.least_size_per_distance)) : bits;
        for (; bits != 0; bits &= bits - 1) {
            const auto at = static_cast<std::uint32_t>(std::countr_zero(bits));
            const WideBvh::Child& child = block.children[first % WideBvh::kMostChildren + at];
            if (child.is_item()) {
                ++counters_.items;
                if ((large >> at & 1U) == 0) {
                    ++counters_.items_too_small;
                } else {
                    seen_.push_back(child.first);
                }
                continue;
            }
            const unsigned planes_left = in.planes_of(at);
            if (planes_left == 0 && query_.occlusion == nullptr && !by_size) {
                take(first + at);
            } else {
                push({child, planes_left});
            }
        }
    }

    void push(const OpenNode& entry) {
        wide_.fetch(entry.node);
        open_.push_back(entry);
    }

    void take(std::uint32_t slot) {
        const auto begin = order_.begin() + wide_.first_item(slot);
        seen_.insert(seen_.end(), begin, begin + wide_.item_count(slot));
    }

    /// Items in and under the slots whose bits are set.
    [[nodiscard]] std::uint64_t items_of(std::uint32_t first, std::uint32_t bits) const {
        std::uint64_t items = 0;
        for (; bits != 0; bits &= bits - 1) {
            items += wide_.item_count(first + static_cast<std::uint32_t>(std::countr_zero(bits)));
        }
        return items;
    }

    /// Those of the boxes whose bits are set that have a sample and are not hidden.
    std::uint32_t not_hidden(const BoxVector& boxes, std::uint32_t first, std::uint32_t bits) {
        const OcclusionBuffer& buffer = *query_.occlusion;
        const Projected projected = project(boxes, buffer.view(), bits);
        const std::uint32_t sampled = bits & bits_of(meets_sample(projected, buffer.view()));
        counters_.items_between_samples += items_of(first, bits & ~sampled);
        if (sampled == 0) return 0;
        const std::uint32_t hidden = hidden_of(buffer, projected, sampled);
        counters_.items_hidden += items_of(first, hidden);
        return sampled & ~hidden;
    }

    const std::vector<std::uint32_t>& order_;
    const WideBvh& wide_;
    const WalkQuery& query_;
    std::vector<std::uint32_t>& seen_;
    WalkCounters& counters_;
    std::vector<OpenNode>& open_;
    std::size_t& next_;
};

void walk_here(const BoxTree& tree, const WalkQuery& query, std::size_t most_open, WalkPart& part) {
    Walk{tree, query, part}.run(most_open);
}

/// One byte per frustum: planes still to be tested, or kOutside.
using PlaneBytes = std::array<std::uint8_t, BoxTree::kMostFrusta>;

class WalkOfSeveral {
public:
    WalkOfSeveral(BoxTree& tree, std::span<const FloatFrustum> frusta, std::vector<SeenItem>& seen,
                  WalkCounters& counters)
        : bvh_{tree.bvh()}, boxes_{tree.boxes()}, frusta_{frusta}, seen_{seen}, counters_{counters} {}

    void run() {
        PlaneBytes all{};
        all.fill(kOutside);
        for (std::size_t f = 0; f < frusta_.size(); ++f) all[f] = FloatFrustum::kAllPlanes;
        std::array<Entry, kMostDepth> stack;
        std::size_t depth = 0;
        stack[depth++] = {scene::Bvh::kRoot, all};
        while (depth > 0) {
            Entry entry = stack[--depth];
            const scene::BvhNode& node = bvh_.nodes()[entry.node];
            ++counters_.nodes;
            bool any = false;
            bool tests_left = false;
            for (std::size_t f = 0; f < frusta_.size(); ++f) {
                std::uint8_t& planes = entry.planes[f];
                if (planes == kOutside) continue;
                if (planes != 0) planes = static_cast<std::uint8_t>(planes_left(node, frusta_[f], planes));
                any = any || planes != kOutside;
                tests_left = tests_left || (planes != kOutside && planes != 0);
            }
            const std::uint32_t first = bvh_.first_item(entry.node);
            const std::uint32_t end = bvh_.end_item(entry.node);
            if (!any) {
                counters_.items_outside += end - first;
            } else if (!tests_left) {
                take(first, end, entry.planes);
            } else if (node.count > 0) {
                test(first, end, entry.planes);
            } else {
                stack[depth++] = {node.first + 1, entry.planes};
                stack[depth++] = {node.first, entry.planes};
            }
        }
    }

private:
    struct Entry {
        std::uint32_t node;
        PlaneBytes planes;
    };

    void take(std::uint32_t first, std::uint32_t end, const PlaneBytes& planes) {
        std::uint32_t frusta = 0;
        for (std::size_t f = 0; f < frusta_.size(); ++f) frusta |= (planes[f] != kOutside ? 1U : 0U) << f;
        for (std::uint32_t i = first; i < end; ++i) seen_.push_back({bvh_.order()[i], frusta});
    }

    void test(std::uint32_t first, std::uint32_t end, const PlaneBytes& planes) {
        const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
        for (std::uint32_t i = first; i < end; i += lanes) {
            const std::uint32_t count = std::min(lanes, end - i);
            const std::uint32_t all = lowest_bits(count);
            const BoxVector boxes = load_boxes(boxes_, i);
            std::array<std::uint32_t, BoxTree::kMostFrusta> bits{};
            std::uint32_t any = 0;
            for (std::size_t f = 0; f < frusta_.size(); ++f) {
                if (planes[f] == kOutside) continue;
                bits[f] = all;
                if (planes[f] != 0) bits[f] &= bits_of(in_frustum(boxes, frusta_[f], planes[f]));
                any |= bits[f];
            }
            counters_.items += count;
            counters_.items_outside += static_cast<std::uint64_t>(std::popcount(all & ~any));
            for (; any != 0; any &= any - 1) {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(any));
                std::uint32_t frusta = 0;
                for (std::size_t f = 0; f < frusta_.size(); ++f) frusta |= (bits[f] >> lane & 1U) << f;
                seen_.push_back({bvh_.order()[i + lane], frusta});
            }
        }
    }

    const scene::Bvh& bvh_;
    const BoxList& boxes_;
    std::span<const FloatFrustum> frusta_;
    std::vector<SeenItem>& seen_;
    WalkCounters& counters_;
};

void walk_several_here(BoxTree& tree, std::span<const FloatFrustum> frusta, std::vector<SeenItem>& seen,
                       WalkCounters& counters) {
    WalkOfSeveral{tree, frusta, seen, counters}.run();
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(walk_here);
HWY_EXPORT(walk_several_here);

namespace {

// A walk by several threads begins with one, until there are this many parts for each, of this many nodes. Subtrees
// differ in what is seen of them.
constexpr std::size_t kPartsPerThread = 4;
constexpr std::size_t kNodesPerPart = 16;
constexpr std::size_t kAll = ~std::size_t{0};

}  // namespace

WalkCounters& WalkCounters::operator+=(const WalkCounters& other) {
    nodes += other.nodes;
    items += other.items;
    items_outside += other.items_outside;
    items_hidden += other.items_hidden;
    items_too_small += other.items_too_small;
    items_between_samples += other.items_between_samples;
    return *this;
}

BoxTree::BoxTree(std::span<const scene::Bounds> boxes) : bvh_{boxes}, wide_{bvh_, boxes} {
    boxes_.resize(bvh_.order().size());
    for (std::size_t i = 0; i < bvh_.order().size(); ++i) boxes_.set(i, boxes[bvh_.order()[i]]);
}

void BoxTree::move(std::span<const std::uint32_t> moved, std::span<const scene::Bounds> boxes) {
    bvh_.refit(moved, boxes);
    wide_.move(bvh_, moved, boxes);
    for (const std::uint32_t item : moved) {
        const std::uint32_t place = bvh_.place_of(item);
        if (place != scene::Bvh::kNone) boxes_.set(place, boxes[item]);
    }
}

void BoxTree::append_seen(const WalkQuery& query, std::vector<std::uint32_t>& seen, TaskPool* threads) {
    counters_ = {};
    if (bvh_.empty()) return;
    const std::size_t parts = threads == nullptr || threads->threads() == 1
                                  ? 0
                                  : kPartsPerThread * static_cast<std::size_t>(threads->threads());
    begin_.open.assign(1, {wide_.root(), FloatFrustum::kAllPlanes});
    begin_.next = 0;
    begin_.counters = {};
    begin_.seen.swap(seen);
    HWY_DYNAMIC_DISPATCH(walk_here)(*this, query, parts == 0 ? kAll : kNodesPerPart * parts, begin_);
    begin_.seen.swap(seen);
    counters_ += begin_.counters;
    if (begin_.next == begin_.open.size()) return;
    share_out(parts);
    threads->run(static_cast<int>(parts), [this, &query](int part, int /*worker*/) {
        HWY_DYNAMIC_DISPATCH(walk_here)(*this, query, kAll, parts_[static_cast<std::size_t>(part)]);
    });
    for (const WalkPart& part : std::span{parts_}.first(parts)) {
        seen.insert(seen.end(), part.seen.begin(), part.seen.end());
        counters_ += part.counters;
    }
}

void BoxTree::share_out(std::size_t parts) {
    if (parts_.size() < parts) parts_.resize(parts);
    const std::span<const OpenNode> left = std::span{begin_.open}.subspan(begin_.next);
    for (std::size_t i = 0; i < parts; ++i) {
        const std::size_t first = left.size() * i / parts;
        const std::span<const OpenNode> nodes = left.subspan(first, left.size() * (i + 1) / parts - first);
        WalkPart& part = parts_[i];
        part.open.assign(nodes.begin(), nodes.end());
        part.next = 0;
        part.seen.clear();
        part.counters = {};
    }
}

void BoxTree::append_seen(std::span<const Frustum> frusta, std::vector<SeenItem>& seen) {
    LW_CHECK(frusta.size() <= kMostFrusta, "too many frusta for one walk");
    counters_ = {};
    if (bvh_.empty()) return;
    std::vector<FloatFrustum> single;
    for (const Frustum& frustum : frusta) single.push_back(rounded(frustum));
    HWY_DYNAMIC_DISPATCH(walk_several_here)(*this, single, seen, counters_);
}

}  // namespace lw
#endif
