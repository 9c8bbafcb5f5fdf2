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
    fragments_.begin(count);
    waiting_.clear();
    partly_covered_.clear();
    skips_ = {};
    for (Stretch& stretch : stretches_) {
        stretch.newest.fill(-1);
        stretch.touched_count = 0;
    }
}

std::size_t SurfaceCanvas::pixel_count() const {
    return static_cast<std::size_t>(band_.end - band_.begin) * static_cast<std::size_t>(frame_->depth.width());
}

void SurfaceCanvas::composite_fragments_so_far(Uncovered uncovered) {
    if (fragments_.empty()) return;
    const std::size_t count = fragments_.stretches();
    list_fragments(0, stretches_[0]);
    for (std::size_t i = 0; i < count; ++i) {
        if (i + 1 < count) list_fragments(i + 1, stretches_[(i + 1) % 2]);
        composite_stretch(stretches_[i % 2], uncovered);
    }
    fragments_.begin(pixel_count());
}

void SurfaceCanvas::finish() {
    for (const auto& [pixel, fragment] : waiting_) put_fragment(pixel, fragment);
    waiting_.clear();
    composite_fragments_so_far(Uncovered::drop);
    mark_coverage(frame_->depth.pixels().data() + first_index_, pixel_count(),
                  frame_->coverage.pixels().data() + first_index_);
}

// Lists by pixel. The picture there was last used long ago: it is on its way while the stretch before is put together.
void SurfaceCanvas::list_fragments(std::size_t number, Stretch& stretch) {
    stretch.first_pixel = first_index_ + (number << SurfaceFragments::kStretchBits);
    const float* depths = frame_->depth.pixels().data() + stretch.first_pixel;
    const Rgba8* colours = frame_->colour.pixels().data() + stretch.first_pixel;
    std::size_t count = 0;
    fragments_.visit(number, [&](SurfaceFragment& fragment, std::uint32_t index) {
        const auto pixel = static_cast<std::size_t>(fragment.link);
        std::int32_t& newest = stretch.newest[pixel];
        __builtin_prefetch(depths + pixel, 1);
        __builtin_prefetch(colours + pixel, 1);
        // Without a branch, which nothing could predict.
        stretch.touched[count] = static_cast<std::uint32_t>(pixel);
        count += newest < 0 ? 1 : 0;
        fragment.link = newest;
        newest = static_cast<std::int32_t>(index);
    });
    stretch.touched_count = count;
}

// Leaves it without any.
void SurfaceCanvas::composite_stretch(Stretch& stretch, Uncovered uncovered) {
    if (uncovered == Uncovered::wait) put_off_uncovered(stretch);
    const FragmentLists lists{fragments_.all(),
                              stretch.newest.data(),
                              frame_->depth.pixels().data() + stretch.first_pixel,
                              frame_->colour.pixels().data() + stretch.first_pixel,
                              static_cast<std::uint32_t>(stretch.first_pixel),
                              &partly_covered_};
    const std::size_t left = composite_fragments(lists, {stretch.touched.data(), stretch.touched_count});
    for (std::size_t i = 0; i < left; ++i) {
        std::int32_t& newest = stretch.newest[stretch.touched[i]];
        composite(stretch.first_pixel + stretch.touched[i], newest);
        newest = -1;
    }
    stretch.touched_count = 0;
}

// Takes out pixels of which too little is covered; their fragments wait.
void SurfaceCanvas::put_off_uncovered(Stretch& stretch) {
    const auto is_put_off = [&](std::uint32_t pixel) {
        if (frame_->depth.pixels()[stretch.first_pixel + pixel] >= 0.0F) return false;
        std::int32_t& newest = stretch.newest[pixel];
        float covered = 0.0F;
        for (std::int32_t i = newest; i >= 0; i = fragment(i).link) covered += static_cast<float>(fragment(i).coverage);
        if (covered >= kCoveredEnough * static_cast<float>(kLinearOne)) return false;
        for (std::int32_t i = newest; i >= 0; i = fragment(i).link) {
            waiting_.push_back({stretch.first_pixel + pixel, fragment(i)});
        }
        newest = -1;
        return true;
    };
    std::uint32_t* begin = stretch.touched.data();
    stretch.touched_count =
        static_cast<std::size_t>(std::remove_if(begin, begin + stretch.touched_count, is_put_off) - begin);
}

std::size_t SurfaceCanvas::count_fragments(std::int32_t newest, float opaque_depth) const {
    std::size_t count = 0;
    for (std::int32_t i = newest; i >= 0; i = fragment(i).link) {
        if (!(fragment(i).depth < opaque_depth)) ++count;
    }
    return count;
}

// Sorts by insertion: there are a few.
void SurfaceCanvas::composite(std::size_t pixel, std::int32_t newest) {
    const float opaque_depth = frame_->depth.pixels()[pixel];
    std::array<const SurfaceFragment*, kFewFragments> few_sorted;
    const SurfaceFragment** sorted = few_sorted.data();
    const std::size_t most = count_fragments(newest, opaque_depth);
    if (most > kFewFragments) {
        many_sorted_.resize(most);
        sorted = many_sorted_.data();
    }
    const auto goes_before = [](const SurfaceFragment& a, const SurfaceFragment& b) {
        if (a.depth != b.depth) return a.depth > b.depth;
        return std::tie(a.coverage, a.red, a.green, a.blue) > std::tie(b.coverage, b.red, b.green, b.blue);
    };
    std::size_t count = 0;
    for (std::int32_t i = newest; i >= 0; i = fragment(i).link) {
        if (fragment(i).depth < opaque_depth) continue;
        std::size_t at = count++;
        for (; at > 0 && goes_before(fragment(i), *sorted[at - 1]); --at) sorted[at] = sorted[at - 1];
        sorted[at] = &fragment(i);
    }
    if (count > 0) composite(pixel, {sorted, count});
}

// Nearest first, each over what is behind it; the farthest surface takes what is left, because the surfaces of one
// place fill it together.
void SurfaceCanvas::composite(std::size_t pixel, std::span<const SurfaceFragment* const> sorted) {
    const Rgba8 opaque_colour = frame_->colour.pixels()[pixel];
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const bool has_opaque = opaque_depth >= 0.0F;
    glm::vec3 sum{0.0F};
    float left = 1.0F;
    float covered = 0.0F;
    float largest_share = 0.0F;
    float shown_depth = opaque_depth;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const bool is_last = !has_opaque && i + 1 == sorted.size();
        const float coverage = static_cast<float>(sorted[i]->coverage) * (1.0F / static_cast<float>(kLinearOne));
        const float share = is_last ? left : left * coverage;
        sum += share * glm::vec3{sorted[i]->red, sorted[i]->green, sorted[i]->blue};
        covered += coverage;
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
