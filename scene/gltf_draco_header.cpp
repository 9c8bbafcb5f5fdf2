#include "scene/gltf_draco_header.h"

#include <cstring>
#include <string_view>

#include "scene/gltf_refusal.h"

namespace lw::scene {
namespace {

constexpr std::uint8_t kTriangularMesh = 1;
constexpr std::uint8_t kSequential = 0;
constexpr std::uint8_t kEdgebreaker = 1;
constexpr std::uint16_t kHasMetadata = 0x8000;
constexpr int kMaxMetadataDepth = 16;

/// Reads little-endian numbers; refuses at the end of the data.
class Reader {
public:
    Reader(std::span<const std::uint8_t> bytes, const std::string& place) : bytes_{bytes}, place_{place} {}

    std::uint8_t u8() {
        need(1);
        return bytes_[offset_++];
    }
    std::uint16_t u16() {
        const std::uint16_t low = u8();
        return static_cast<std::uint16_t>(low | u8() << 8);
    }
    std::uint32_t u32() {
        const std::uint32_t low = u16();
        return low | static_cast<std::uint32_t>(u16()) << 16;
    }
    /// 7 bits per byte, lowest first.
    std::uint32_t varint() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const std::uint8_t byte = u8();
            value |= static_cast<std::uint32_t>(byte & 0x7F) << shift;
            if ((byte & 0x80) == 0) return value;
        }
        damaged();
    }
    void skip(std::size_t count) {
        need(count);
        offset_ += count;
    }
    [[noreturn]] void damaged() const { refuse("the Draco data is damaged", place_); }

private:
    void need(std::size_t count) const {
        if (count > bytes_.size() - offset_) damaged();
    }

    std::span<const std::uint8_t> bytes_;
    const std::string& place_;
    std::size_t offset_ = 0;
};

/// Entries (name, bytes) and metadata inside metadata.
void skip_metadata(Reader& reader, int depth) {
    if (depth > kMaxMetadataDepth) reader.damaged();
    const std::uint32_t entries = reader.varint();
    for (std::uint32_t i = 0; i < entries; ++i) {
        reader.skip(reader.u8());
        reader.skip(reader.varint());
    }
    const std::uint32_t inner = reader.varint();
    for (std::uint32_t i = 0; i < inner; ++i) {
        reader.skip(reader.u8());
        skip_metadata(reader, depth + 1);
    }
}

void skip_geometry_metadata(Reader& reader) {
    const std::uint32_t attributes = reader.varint();
    for (std::uint32_t i = 0; i < attributes; ++i) {
        (void)reader.varint();  // the attribute's id
        skip_metadata(reader, 0);
    }
    skip_metadata(reader, 0);
}

}  // namespace

DracoClaims read_draco_claims(std::span<const std::uint8_t> bytes, const std::string& place) {
    constexpr std::string_view kMagic = "DRACO";
    Reader reader{bytes, place};
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
        refuse("the data is not Draco data", place);
    }
    reader.skip(kMagic.size());
    const int major = reader.u8();
    const int version = major * 256 + reader.u8();
    const std::uint8_t type = reader.u8();
    const std::uint8_t method = reader.u8();
    const std::uint16_t flags = reader.u16();
    if (type != kTriangularMesh) refuse("the Draco data is not a triangle mesh", place);
    // Versions before 2.0 wrote fixed-size numbers and fields that have gone; glTF never had such data.
    if (version < 0x200) refuse("the Draco data is older than version 2.0", place);
    if ((flags & kHasMetadata) != 0) skip_geometry_metadata(reader);
    DracoClaims claims;
    if (method == kSequential) {
        const bool varints = version >= 0x202;
        claims.triangles = varints ? reader.varint() : reader.u32();
        claims.vertices = varints ? reader.varint() : reader.u32();
    } else if (method == kEdgebreaker) {
        (void)reader.u8();                           // kind of traversal
        if (version < 0x202) (void)reader.varint();  // vertices added while decoding
        claims.vertices = reader.varint();
        claims.triangles = reader.varint();
    } else {
        reader.damaged();
    }
    return claims;
}

}  // namespace lw::scene
