#pragma once
/// Images in CPU memory. Row 0 is the top row; pixel (x, y) covers [x, x+1) x [y, y+1), its centre is at +0.5.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lw {

/// sRGB-encoded colour with straight alpha, as stored in files and frames.
struct Rgba8 {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
    std::uint8_t a = 255;

    friend bool operator==(const Rgba8&, const Rgba8&) = default;
};
static_assert(sizeof(Rgba8) == 4);

/// The same colour as a display shows it.
[[nodiscard]] inline Rgba8 opaque(Rgba8 colour) { return {colour.r, colour.g, colour.b, 255}; }

/// Row-major pixels without padding. Owns its memory; copying copies the pixels.
template <class T>
class Image {
public:
    Image() = default;
    /// Both sides of `size_px` >= 0.
    explicit Image(glm::ivec2 size_px, T value = T{})
        : size_px_{size_px},
          pixels_(static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y), value) {}

    [[nodiscard]] glm::ivec2 size_px() const { return size_px_; }
    [[nodiscard]] int width() const { return size_px_.x; }
    [[nodiscard]] int height() const { return size_px_.y; }
    [[nodiscard]] bool empty() const { return pixels_.empty(); }

    /// 0 <= x < width, 0 <= y < height; unchecked.
    [[nodiscard]] T& at(int x, int y) { return pixels_[index(x, y)]; }
    [[nodiscard]] const T& at(int x, int y) const { return pixels_[index(x, y)]; }

    [[nodiscard]] std::span<T> row(int y) { return {pixels_.data() + index(0, y), static_cast<std::size_t>(width())}; }
    [[nodiscard]] std::span<const T> row(int y) const {
        return {pixels_.data() + index(0, y), static_cast<std::size_t>(width())};
    }
    [[nodiscard]] std::span<T> pixels() { return pixels_; }
    [[nodiscard]] std::span<const T> pixels() const { return pixels_; }
    [[nodiscard]] std::size_t size_bytes() const { return pixels_.size() * sizeof(T); }

    /// Changes the size and keeps the memory where it suffices; the contents are unspecified afterwards.
    void resize(glm::ivec2 size_px) {
        size_px_ = size_px;
        pixels_.resize(static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y));
    }

    friend bool operator==(const Image&, const Image&) = default;

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px_.x) + static_cast<std::size_t>(x);
    }

    glm::ivec2 size_px_{0};
    std::vector<T> pixels_;
};

using ColourImage = Image<Rgba8>;
using DepthImage = Image<float>;             ///< reversed infinite depth, 0 = background
using ObjectIdImage = Image<std::uint16_t>;  ///< 0 = static world and sky

}  // namespace lw
