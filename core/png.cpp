#include <fmt/format.h>
#include <stb_image.h>

#include <array>
#include <cstring>
#include <limits>
#include <memory>

#include "core/image_io.h"
#include "core/png_encoder.h"
#include "core/png_inflate_check.h"

namespace lw {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
// Largest file that is opened as an image: what kMaxImagePixels of incompressible RGBA need, and some.
constexpr std::uint64_t kMaxImageFileBytes = std::uint64_t{1} << 29;
// Deflate shrinks at most 1032 times, and a PNG byte holds at most 8 pixels.
constexpr std::int64_t kMaxPixelsPerByte = 1032 * 8;

struct FreeStb {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

bool is_png(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 33 && std::memcmp(bytes.data(), kPngSignature.data(), kPngSignature.size()) == 0;
}

bool is_jpeg(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

std::string stb_reason() {
    const char* reason = stbi_failure_reason();
    return reason != nullptr ? reason : "unknown reason";
}

Error damaged(const std::string& where) {
    return {fmt::format("the image cannot be decoded ({})", stb_reason()), where, "write or copy the file again"};
}

// Looks at the header only: everything is refused here before memory is taken for it.
Result<glm::ivec2> checked_size(std::span<const std::uint8_t> bytes, const std::string& where) {
    if (bytes.empty()) return Error{"the file is empty", where, "give a PNG or JPEG image"};
    if (bytes.size() > kMaxImageFileBytes) {
        return Error{"the image file is too large", where, "give a file of at most 512 MiB"};
    }
    glm::ivec2 size_px{0};
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size_px.x, &size_px.y, &channels) == 0) {
        return damaged(where);
    }
    const std::int64_t pixels = std::int64_t{size_px.x} * size_px.y;
    if (size_px.x < 1 || size_px.y < 1) return Error{"the image has no pixels", where, "give an image with an area"};
    if (size_px.x > kMaxImageSidePx || size_px.y > kMaxImageSidePx || pixels > kMaxImagePixels) {
        return Error{fmt::format("the image claims {}x{} pixels", size_px.x, size_px.y), where,
                     fmt::format("at most {} a side and {} in all are read", kMaxImageSidePx, kMaxImagePixels)};
    }
    if (pixels > static_cast<std::int64_t>(bytes.size()) * kMaxPixelsPerByte) {
        return Error{
            fmt::format("{} bytes cannot hold the {}x{} pixels they claim", bytes.size(), size_px.x, size_px.y), where,
            "write or copy the file again"};
    }
    return size_px;
}

Status write_encoded(const std::filesystem::path& path, const std::vector<std::uint8_t>& file) {
    if (file.empty()) {
        return Error{"the image cannot be encoded", path.string(), "write a smaller image or free some memory"};
    }
    return write_file_atomically(path, std::as_bytes(std::span{file}));
}

Status check_writable_size(const std::filesystem::path& path, glm::ivec2 size_px) {
    if (size_px.x >= 1 && size_px.y >= 1 && size_px.x <= kMaxImageSidePx && size_px.y <= kMaxImageSidePx) return Done{};
    return Error{fmt::format("an image of {}x{} pixels cannot be written", size_px.x, size_px.y), path.string(),
                 fmt::format("choose sides of 1 to {} pixels", kMaxImageSidePx)};
}

}  // namespace

Result<ColourImage> decode_image(std::span<const std::uint8_t> bytes, const std::string& where) {
    if (!bytes.empty() && !is_png(bytes) && !is_jpeg(bytes)) {
        return Error{"not a PNG or JPEG image", where, "convert it to PNG"};
    }
    const Result<glm::ivec2> size_px = checked_size(bytes, where);
    if (!size_px) return size_px.error();
    if (!png_data_fits(bytes, *size_px)) {
        return Error{"the image data is damaged, or larger than its picture", where, "write or copy the file again"};
    }
    glm::ivec2 decoded_px{0};
    int channels = 0;
    const std::unique_ptr<stbi_uc, FreeStb> decoded{stbi_load_from_memory(
        bytes.data(), static_cast<int>(bytes.size()), &decoded_px.x, &decoded_px.y, &channels, STBI_rgb_alpha)};
    if (!decoded || decoded_px != *size_px) return damaged(where);
    ColourImage image{*size_px};
    std::memcpy(image.pixels().data(), decoded.get(), image.size_bytes());
    return image;
}

Result<ColourImage> read_png(const std::filesystem::path& path) {
    const auto bytes = read_file(path, kMaxImageFileBytes);
    if (!bytes) return bytes.error();
    if (!bytes->empty() && !is_png(*bytes)) return Error{"not a PNG file", path.string(), "convert it to PNG"};
    return decode_image(*bytes, path.string());
}

Result<ObjectIdImage> read_png16(const std::filesystem::path& path) {
    const auto bytes = read_file(path, kMaxImageFileBytes);
    if (!bytes) return bytes.error();
    constexpr std::size_t kBitDepthAt = 24;  // after signature, chunk length and type, width and height
    constexpr std::size_t kColourTypeAt = 25;
    if (!bytes->empty() && !is_png(*bytes)) return Error{"not a PNG file", path.string(), "convert it to PNG"};
    const Result<glm::ivec2> size_px = checked_size(*bytes, path.string());
    if (!size_px) return size_px.error();
    if ((*bytes)[kBitDepthAt] != 16 || (*bytes)[kColourTypeAt] != static_cast<std::uint8_t>(PngColour::grey)) {
        return Error{"not a PNG of one channel with 16 bits", path.string(), "write ids as 16-bit greyscale"};
    }
    glm::ivec2 decoded_px{0};
    int channels = 0;
    const std::unique_ptr<stbi_us, FreeStb> decoded{stbi_load_16_from_memory(
        bytes->data(), static_cast<int>(bytes->size()), &decoded_px.x, &decoded_px.y, &channels, STBI_grey)};
    if (!decoded || decoded_px != *size_px) return damaged(path.string());
    ObjectIdImage image{*size_px};
    std::memcpy(image.pixels().data(), decoded.get(), image.size_bytes());
    return image;
}

Status write_png(const std::filesystem::path& path, const ColourImage& image) {
    if (const Status size = check_writable_size(path, image.size_px()); !size) return size;
    bool opaque = true;
    for (const Rgba8 pixel : image.pixels()) opaque = opaque && pixel.a == 255;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(image.pixels().size() * (opaque ? 3 : 4));
    for (const Rgba8 pixel : image.pixels()) {
        bytes.insert(bytes.end(), {pixel.r, pixel.g, pixel.b});
        if (!opaque) bytes.push_back(pixel.a);
    }
    return write_encoded(path, encode_png(image.size_px(), opaque ? PngColour::rgb : PngColour::rgba, 8, bytes));
}

Status write_png16(const std::filesystem::path& path, const ObjectIdImage& image) {
    if (const Status size = check_writable_size(path, image.size_px()); !size) return size;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(image.size_bytes());
    for (const std::uint16_t id : image.pixels()) {
        bytes.push_back(static_cast<std::uint8_t>(id >> 8U));
        bytes.push_back(static_cast<std::uint8_t>(id));
    }
    return write_encoded(path, encode_png(image.size_px(), PngColour::grey, 16, bytes));
}

}  // namespace lw
