#pragma once
/// Image comparisons for tests: on failure the actual, the expected and their difference are written as PNG files.

#include <gtest/gtest.h>

#include <string>

#include "core/image.h"
#include "warp_server/warp_method.h"

namespace lw::test {

/// Every pixel of `actual` within `tolerance` per channel of `expected`, but for at most `allowed_share` of them.
[[nodiscard]] ::testing::AssertionResult images_agree(const std::string& name, const ColourImage& actual,
                                                      const ColourImage& expected, int tolerance,
                                                      double allowed_share = 0.0);

/// Bit for bit: colour, depth, and every pixel reached.
[[nodiscard]] ::testing::AssertionResult shows_source_exactly(const std::string& name, const DisplayFrame& frame,
                                                              const CpuPixels& source);

/// PSNR over the R, G, B sRGB values of the pixels whose mask is not 0, dB; 99 when they are equal.
[[nodiscard]] double masked_psnr_db(const ColourImage& a, const ColourImage& b, const Image<std::uint8_t>& mask);

}  // namespace lw::test
