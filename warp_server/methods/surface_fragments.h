#pragma once
/// Surfaces that cover a share of a pixel, kept by stretches of the picture as they are drawn: what is put together at
/// the end is a stretch at a time, whose lists and picture fit a cache.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lw {

/// A surface that covers a share of a pixel. Two fields make a 32-bit word whose top bit is 0, so that the words, as
/// whole numbers, are in the order of their second fields.
struct alignas(16) SurfaceFragment {
    float depth;
    std::uint16_t red;       ///< linear light, 0 to kLinearOne
    std::uint16_t coverage;  ///< in (0, kLinearOne]
    std::uint16_t blue;
    std::uint16_t green;
    std::int32_t link;  ///< the pixel's number in its stretch; in a list the index of the next fragment, or -1
};
static_assert(sizeof(SurfaceFragment) == 16);

/// Fragments of a band of pixels, by stretches of kStretch pixels. They lie in chunks of one stretch each, so that each
/// is written once, where it stays.
class SurfaceFragments {
public:
    static constexpr unsigned kStretchBits = 10;
    static constexpr std::size_t kStretch = std::size_t{1} << kStretchBits;

    /// Forgets all, and makes ready for `pixels` of them.
    void begin(std::size_t pixels);

    /// @param pixel  below the number of begin()
    /// `fragment.link` is overwritten.
    void put(std::size_t pixel, const SurfaceFragment& fragment) {
        std::uint32_t& end = ends_[pixel >> kStretchBits];
        if (end % kChunk == 0) end = begin_chunk(end);
        SurfaceFragment& placed = fragments_[end++];
        placed = fragment;
        placed.link = static_cast<std::int32_t>(pixel & (kStretch - 1));
    }

    [[nodiscard]] bool empty() const { return chunks_ == 1; }
    [[nodiscard]] std::size_t stretches() const { return ends_.size(); }

    /// By index.
    [[nodiscard]] std::span<const SurfaceFragment> all() const { return fragments_; }

    /// Calls `visit(fragment, index)` for those of a stretch, last chunk first.
    template <class Visit>
    void visit(std::size_t stretch, const Visit& visit) {
        for (std::uint32_t end = ends_[stretch]; end != 0; end = ends_before_[(end - 1) / kChunk]) {
            for (std::uint32_t i = (end - 1) / kChunk * kChunk; i < end; ++i) visit(fragments_[i], i);
        }
    }

private:
    static constexpr std::uint32_t kChunk = 16;

    [[nodiscard]] std::uint32_t begin_chunk(std::uint32_t end_before);

    std::vector<SurfaceFragment> fragments_;
    std::uint32_t chunks_ = 1;                // in use; the first is nobody's, as end 0 says that there are none
    std::vector<std::uint32_t> ends_;         // by stretch: behind its last fragment, 0 without any
    std::vector<std::uint32_t> ends_before_;  // by chunk: behind the last fragment of its stretch's chunk before, or 0
};

}  // namespace lw
