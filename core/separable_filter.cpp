#include "core/separable_filter.h"

#include <algorithm>

namespace lw {
namespace {

// out[x] = sum of weights[i] * in[x + i], the loops ordered so that the inner one vectorises.
void convolve(const float* in, std::span<const float> weights, std::size_t count, float* out) {
    for (std::size_t x = 0; x < count; ++x) out[x] = in[x] * weights[0];
    for (std::size_t i = 1; i < weights.size(); ++i) {
        const float weight = weights[i];
        const float* shifted = in + i;
        for (std::size_t x = 0; x < count; ++x) out[x] += shifted[x] * weight;
    }
}

}  // namespace

void filter_rows(const Image<float>& in, std::span<const float> horizontal, Image<float>& out) {
    out.resize(in.size_px());
    const std::size_t radius = horizontal.size() / 2;
    const auto width = static_cast<std::size_t>(in.width());
    std::vector<float> padded(width + 2 * radius);
    for (int y = 0; y < in.height(); ++y) {
        const auto row = in.row(y);
        std::fill_n(padded.begin(), radius, row.front());
        std::copy(row.begin(), row.end(), padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row.back());
        convolve(padded.data(), horizontal, width, out.row(y).data());
    }
}

void filter_columns(const Image<float>& in, std::span<const float> vertical, Image<float>& out) {
    out.resize(in.size_px());
    const int radius = static_cast<int>(vertical.size() / 2);
    const auto width = static_cast<std::size_t>(in.width());
    for (int y = 0; y < in.height(); ++y) {
        float* result = out.row(y).data();
        for (int i = -radius; i <= radius; ++i) {
            const float* row = in.row(std::clamp(y + i, 0, in.height() - 1)).data();
            const float weight = vertical[static_cast<std::size_t>(i + radius)];
            if (i == -radius) {
                for (std::size_t x = 0; x < width; ++x) result[x] = row[x] * weight;
            } else {
                for (std::size_t x = 0; x < width; ++x) result[x] += row[x] * weight;
            }
        }
    }
}

void filter_separable(const Image<float>& in, std::span<const float> horizontal, std::span<const float> vertical,
                      Image<float>& scratch, Image<float>& out) {
    filter_rows(in, horizontal, scratch);
    filter_columns(scratch, vertical, out);
}

}  // namespace lw
