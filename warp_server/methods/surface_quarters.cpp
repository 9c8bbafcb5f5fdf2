#include "warp_server/methods/surface_quarters.h"

#include <algorithm>

#include "warp_server/methods/surface_lattice.h"

namespace lw {
namespace {

constexpr int kWholeShare = 255;

// A surface has a colour where none of its quarters shows it: 1/512 of a pixel, which is too little to be drawn.
constexpr int kLeastShareBits = 7;

}  // namespace

QuarterParts::QuarterParts(const SurfaceLinks& links, const LinearImage& linear, LinearImage& quarters)
    : links_{&links}, linear_{&linear}, quarters_{&quarters} {
    const ColourImage& colour = links.pixels().colour;
    number_.resize(colour.size_px());
    constexpr std::uint32_t kBothWhole = 0x7FFF7FFFU;
    shares_.push_back({{}, {kBothWhole, kBothWhole}});
    for (int y = 0; y < colour.height(); ++y) {
        const std::span<const Rgba8> row = colour.row(y);
        for (int x = 0; x < colour.width(); ++x) {
            if (row[static_cast<std::size_t>(x)].a == kWholeShare) continue;
            number_.at(x, y) = static_cast<std::uint32_t>(shares_.size());
            edge_pixels_.push_back({x, y});
            split({x, y}, shares_.emplace_back());
        }
    }
}

void QuarterParts::split(glm::ivec2 pixel, QuarterShares& shares) {
    const ColourImage& alphas = links_->pixels().quarters;
    for (int i = 0; i < 4; ++i) {
        const glm::ivec2 at = kLatticeSteps * pixel + glm::ivec2{i & 1, i >> 1};
        const auto keep = [&](QuarterValues& values, int value) {
            values[static_cast<std::size_t>(i >> 1)] |= static_cast<std::uint32_t>(value) << ((i & 1) != 0 ? 16U : 0U);
        };
        const int share = alphas.at(at.x, at.y).a;
        const int left = (kWholeShare - share) * kLinearOne / kWholeShare;
        keep(shares.own, share == 0 ? kLinearOne >> kLeastShareBits : kLinearOne - left);
        if (share == kWholeShare) continue;
        for (int channel = 0; channel < 3; ++channel) {
            std::uint16_t& shown = quarters_->row(at.y, channel)[at.x];
            const int mean = linear_->row(pixel.y, channel)[pixel.x];
            const int part = std::clamp(shown - mean * share / kWholeShare, 0, left);
            keep(shares.others[static_cast<std::size_t>(channel)], part);
            shown = static_cast<std::uint16_t>(share == 0 ? mean >> kLeastShareBits : shown - part);
        }
        keep(shares.others[3], left);
    }
}

bool QuarterParts::is_behind_others(glm::ivec2 pixel) const {
    const DepthImage& depth = links_->pixels().depth;
    const glm::ivec2 last = links_->size_px() - 1;
    const auto [x, y] = std::pair{pixel.x, pixel.y};
    const float own = depth.at(x, y);
    return (x > 0 && !links_->to_right(x - 1, y) && depth.at(x - 1, y) > own) ||
           (y > 0 && !links_->down(x, y - 1) && depth.at(x, y - 1) > own) ||
           (x < last.x && !links_->to_right(x, y) && depth.at(x + 1, y) > own) ||
           (y < last.y && !links_->down(x, y) && depth.at(x, y + 1) > own);
}

void QuarterParts::join_for_lattice() {
    const ColourImage& shares = links_->pixels().quarters;
    for (std::size_t number = 0; number < edge_pixels_.size(); ++number) {
        const glm::ivec2 pixel = edge_pixels_[number];
        const QuarterShares& parts = shares_[number + 1];
        const bool is_behind = is_behind_others(pixel);
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 at = kLatticeSteps * pixel + glm::ivec2{i & 1, i >> 1};
            const int share = shares.at(at.x, at.y).a;
            if (share == kWholeShare) continue;
            for (std::size_t channel = 0; channel < 3; ++channel) {
                std::uint16_t& value = quarters_->row(at.y, static_cast<int>(channel))[at.x];
                const std::uint32_t pair = parts.others[channel][static_cast<std::size_t>(i >> 1)];
                const std::uint32_t part = i & 1 ? pair >> 16U : pair & 0xFFFFU;
                const unsigned own = share == 0 ? 0U : value;
                value = is_behind ? linear_->row(pixel.y, static_cast<int>(channel))[pixel.x]
                                  : static_cast<std::uint16_t>(own + part);
            }
        }
    }
}

}  // namespace lw
