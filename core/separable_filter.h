#pragma once
/// Separable filters over float planes, for the image metrics.

#include <span>
#include <vector>

#include "core/image.h"

namespace lw {

/// An odd number of weights around its middle: weights[r + i] belongs to the pixel i to the right of (or below) the
/// middle one.
using Kernel = std::vector<float>;

/// `in` filtered with `horizontal` along rows and `vertical` along columns; pixels outside repeat the nearest one.
/// `scratch` and `out` are resized; none of the images may be the same object. Pure, any thread.
void filter_separable(const Image<float>& in, std::span<const float> horizontal, std::span<const float> vertical,
                      Image<float>& scratch, Image<float>& out);

/// The two halves of it, for filters that share one.
void filter_rows(const Image<float>& in, std::span<const float> horizontal, Image<float>& out);
void filter_columns(const Image<float>& in, std::span<const float> vertical, Image<float>& out);

}  // namespace lw
