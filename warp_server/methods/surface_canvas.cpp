#include "warp_server/methods/surface_canvas.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

#include "core/colour.h"
#include "warp_server/methods/depth_rows.h"
#include "warp_server/methods/linear_colour.h"

namespace lw {

namespace {

constexpr float kCoveredEnough = 0.5F;  // to be shown without anything opaque behind; composite_fragments has it too

}  // namespace

void SurfaceCanvas::begin(DisplayFrame& out, RowRange band, StackBase base) {
    frame_ = &out;
    band_ = band;
    const auto width = static_cast<std::size_t>(out.depth.width());
    first_index_ = static_cast<std::size_t>(band.begin) * width;
    const std::size_t count = static_cast<std::size_t>(band.end - band.begin) * width;
    if (base == StackBase::nothing) {
        std::memset(out.depth.pixels().data() + first_index_, kNothingByte, count * sizeof(float));
    }
    fragment_count_ = 0;
    waiting_.clear();
    partly_covered_.clear();
    skips_ = {};
    newest_.fill(-1);
}

std::size_t SurfaceCanvas::pixel_count() const {
    return static_cast<std::size_t>(band_.end - band_.begin) * static_cast<std::size_t>(frame_->depth.width());
}

void SurfaceCanvas::composite_fragments_so_far(Uncovered uncovered) {
    if (fragment_count_ == 0) return;
    sort_fragments(pixel_count());
    fragment_count_ = 0;
    const std::size_t stretches = stretch_begin_.size() - 1;
    for (std::size_t i = 0; i < stretches; ++i) {
        if (i + 1 < stretches) {
            // The picture there was last used long ago. Not a function of its own: GCC drops calls of functions that do
            // nothing but this.
            for (std::size_t k = stretch_begin_[i + 1]; k < stretch_begin_[i + 2]; ++k) {
                __builtin_prefetch(frame_->depth.pixels().data() + sorted_[k].pixel, 1);
                __builtin_prefetch(frame_->colour.pixels().data() + sorted_[k].pixel, 1);
            }
        }
        composite_stretch(i, uncovered);
    }
}

void SurfaceCanvas::finish() {
    reserve_fragments(waiting_.size());
    std::copy(waiting_.begin(), waiting_.end(), fragments_.begin() + static_cast<std::ptrdiff_t>(fragment_count_));
    fragment_count_ += waiting_.size();
    waiting_.clear();
    composite_fragments_so_far(Uncovered::drop);
    mark_coverage(frame_->depth.pixels().data() + first_index_, pixel_count(),
                  frame_->coverage.pixels().data() + first_index_);
}

// By counting.
void SurfaceCanvas::sort_fragments(std::size_t pixel_count) {
    const std::size_t stretches = (pixel_count + kStretch - 1) >> kStretchBits;
    const auto stretch_of = [&](const SurfaceFragment& fragment) {
        return (fragment.pixel - first_index_) >> kStretchBits;
    };
    const std::span<const SurfaceFragment> fragments{fragments_.data(), fragment_count_};
    stretch_begin_.assign(stretches + 1, 0);
    for (const SurfaceFragment& fragment : fragments) ++stretch_begin_[stretch_of(fragment) + 1];
    for (std::size_t i = 1; i <= stretches; ++i) stretch_begin_[i] += stretch_begin_[i - 1];
    if (sorted_.size() < fragment_count_) sorted_.resize(fragments_.size());
    for (const SurfaceFragment& fragment : fragments) sorted_[stretch_begin_[stretch_of(fragment)]++] = fragment;
    // Each begin has moved on to its end, which is the next one's begin.
    for (std::size_t i = stretches; i > 0; --i) stretch_begin_[i] = stretch_begin_[i - 1];
    stretch_begin_[0] = 0;
}

void SurfaceCanvas::composite_stretch(std::size_t stretch, Uncovered uncovered) {
    const std::size_t first = first_index_ + (stretch << kStretchBits);
    touched_.clear();
    for (std::size_t i = stretch_begin_[stretch]; i < stretch_begin_[stretch + 1]; ++i) {
        const std::size_t pixel = sorted_[i].pixel - first;
        if (newest_[pixel] < 0) touched_.push_back(static_cast<std::uint32_t>(pixel));
        sorted_[i].next = newest_[pixel];
        newest_[pixel] = static_cast<std::int32_t>(i);
    }
    if (uncovered == Uncovered::wait) put_off_uncovered(first);
    const FragmentLists lists{sorted_,
                              newest_.data(),
                              frame_->depth.pixels().data() + first,
                              frame_->colour.pixels().data() + first,
                              static_cast<std::uint32_t>(first),
                              &partly_covered_};
    const std::size_t left = composite_fragments(lists, touched_);
    for (std::size_t i = 0; i < left; ++i) {
        composite(first + touched_[i]);
        newest_[touched_[i]] = -1;
    }
}

// Takes pixels out of the stretch from pixel `first` on of which too little is covered; their fragments wait.
void SurfaceCanvas::put_off_uncovered(std::size_t first) {
    std::erase_if(touched_, [&](std::uint32_t pixel) {
        if (frame_->depth.pixels()[first + pixel] >= 0.0F) return false;
        float covered = 0.0F;
        for (std::int32_t i = newest_[pixel]; i >= 0; i = sorted_[static_cast<std::size_t>(i)].next) {
            covered += sorted_[static_cast<std::size_t>(i)].coverage;
        }
        if (covered >= kCoveredEnough) return false;
        for (std::int32_t i = newest_[pixel]; i >= 0; i = sorted_[static_cast<std::size_t>(i)].next) {
            waiting_.push_back(sorted_[static_cast<std::size_t>(i)]);
        }
        newest_[pixel] = -1;
        return true;
    });
}

std::size_t SurfaceCanvas::count_fragments(std::int32_t newest, float opaque_depth) const {
    std::size_t count = 0;
    for (std::int32_t i = newest; i >= 0; i = sorted_[static_cast<std::size_t>(i)].next) {
        if (!(sorted_[static_cast<std::size_t>(i)].depth < opaque_depth)) ++count;
    }
    return count;
}

// Sorts by insertion: there are two or three.
void SurfaceCanvas::composite(std::size_t pixel) {
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const std::int32_t newest = newest_[(pixel - first_index_) & (kStretch - 1)];
    std::array<const SurfaceFragment*, kFewFragments> few_sorted;
    const SurfaceFragment** sorted = few_sorted.data();
    const std::size_t most = count_fragments(newest, opaque_depth);
    if (most > kFewFragments) {
        many_sorted_.resize(most);
        sorted = many_sorted_.data();
    }
    const auto goes_before = [](const SurfaceFragment& a, const SurfaceFragment& b) {
        if (a.depth != b.depth) return a.depth > b.depth;
        return std::tie(a.coverage, a.linear.x, a.linear.y, a.linear.z) >
               std::tie(b.coverage, b.linear.x, b.linear.y, b.linear.z);
    };
    std::size_t count = 0;
    for (std::int32_t i = newest; i >= 0; i = sorted_[static_cast<std::size_t>(i)].next) {
        const SurfaceFragment& fragment = sorted_[static_cast<std::size_t>(i)];
        if (fragment.depth < opaque_depth) continue;
        std::size_t at = count++;
        for (; at > 0 && goes_before(fragment, *sorted[at - 1]); --at) sorted[at] = sorted[at - 1];
        sorted[at] = &fragment;
    }
    if (count == 0) return;
    float covered = 0.0F;
    for (std::size_t i = 0; i < count; ++i) covered += sorted[i]->coverage;
    composite(pixel, {sorted, count}, covered);
}

// Nearest first, each over what is behind it; the farthest surface takes what is left, because the surfaces of one
// place fill it together.
void SurfaceCanvas::composite(std::size_t pixel, std::span<const SurfaceFragment* const> sorted, float covered) {
    const Rgba8 opaque_colour = frame_->colour.pixels()[pixel];
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const bool has_opaque = opaque_depth >= 0.0F;
    glm::vec3 sum{0.0F};
    float left = 1.0F;
    float largest_share = 0.0F;
    float shown_depth = opaque_depth;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const bool is_last = !has_opaque && i + 1 == sorted.size();
        const float share = is_last ? left : left * sorted[i]->coverage;
        sum += share * sorted[i]->linear;
        left -= share;
        if (share > largest_share) {
            largest_share = share;
            shown_depth = sorted[i]->depth;
        }
    }
    if (has_opaque) {
        const std::array<float, 256>& linear = linear_from_srgb8_table();
        sum += left * static_cast<float>(kLinearOne) *
               glm::vec3{linear[opaque_colour.r], linear[opaque_colour.g], linear[opaque_colour.b]};
        if (left >= largest_share) shown_depth = opaque_depth;
    }
    const SrgbParabolas& parabolas = srgb_parabolas();
    const auto encoded = [&](float linear) {
        const float bounded = std::clamp(linear + 0.5F, 0.0F, static_cast<float>(kLinearOne));
        return srgb8_from_linear15(static_cast<std::int32_t>(bounded), parabolas);
    };
    const Rgba8 colour{encoded(sum.x), encoded(sum.y), encoded(sum.z), 255};
    if (!has_opaque && covered < kWholeCover) {
        partly_covered_.push_back({static_cast<std::uint32_t>(pixel), covered, shown_depth, colour});
        if (covered < kCoveredEnough) return;
    }
    frame_->colour.pixels()[pixel] = colour;
    frame_->depth.pixels()[pixel] = shown_depth;
}

}  // namespace lw
