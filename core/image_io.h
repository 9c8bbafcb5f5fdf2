#pragma once
/// PNG (8-bit colour, 16-bit ids) and PFM (32-bit float depth) files. Writers write to a temporary name beside the
/// target and rename, so a failed write leaves nothing half-written. Any thread; distinct paths do not interfere.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace lw {

/// Largest accepted side of an image from a file, pixels. Larger claims are refused before anything is allocated.
inline constexpr int kMaxImageSidePx = 16384;
/// Largest accepted number of pixels: decoding takes up to 8 bytes for each.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{8192} * 8192;

[[nodiscard]] Result<ColourImage> read_png(const std::filesystem::path& path);
/// Encoded image bytes (PNG or JPEG). `where` names them in errors.
[[nodiscard]] Result<ColourImage> decode_image(std::span<const std::uint8_t> bytes, const std::string& where);
[[nodiscard]] Status write_png(const std::filesystem::path& path, const ColourImage& image);

/// One-channel PNG with 16 bits.
[[nodiscard]] Result<ObjectIdImage> read_png16(const std::filesystem::path& path);
[[nodiscard]] Status write_png16(const std::filesystem::path& path, const ObjectIdImage& image);

/// One-channel PFM, written little-endian, read in either byte order; its rows are stored bottom first by definition,
/// in memory row 0 is the top.
[[nodiscard]] Result<DepthImage> read_pfm(const std::filesystem::path& path);
[[nodiscard]] Status write_pfm(const std::filesystem::path& path, const DepthImage& image);

/// Writes bytes to `path` through a temporary file and a rename. Creates no folders.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
/// Whole file; refuses directories and files above `max_bytes`.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                                          std::uint64_t max_bytes = std::uint64_t{4} << 30);

}  // namespace lw
