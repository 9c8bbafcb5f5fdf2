#include "scene/gltf_accessors.h"

#include <algorithm>
#include <cstring>

#include "scene/gltf_compression.h"

namespace lw::scene {
namespace {

const tinygltf::Accessor& accessor_at(const GltfSource& source, int accessor) {
    return source.model.accessors[static_cast<std::size_t>(accessor)];
}

std::size_t component_bytes(int component_type, const std::string& place) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            refuse(fmt::format("{} is not a component type", component_type), place + ".componentType");
    }
}

/// Elements in memory: `count` of `element_bytes`, `stride` apart, from `first`.
struct Strided {
    std::span<const std::uint8_t> bytes;
    std::size_t offset = 0;
    std::size_t stride = 0;
};

/// Checks that all elements lie inside the view. `stride` 0 means tightly packed.
Strided strided_view(GltfSource& source, int view, std::size_t offset, std::size_t stride, std::size_t count,
                     std::size_t element_bytes, const std::string& place) {
    const Strided result{view_bytes(source, view), offset, stride == 0 ? element_bytes : stride};
    if (result.stride < element_bytes) refuse("the byte stride is smaller than an element", place);
    if (count == 0) return result;
    // count and stride are below 2^31 each (gltf_schema.h), so this fits 64 bits.
    const std::uint64_t end = std::uint64_t{offset} + std::uint64_t{result.stride} * (count - 1) + element_bytes;
    if (end > result.bytes.size()) {
        refuse(fmt::format("reaches to byte {} of a buffer view with {}", end, result.bytes.size()), place);
    }
    return result;
}

void apply_sparse(GltfSource& source, int accessor, std::size_t element_bytes, std::vector<std::uint8_t>& elements) {
    const tinygltf::Accessor& access = accessor_at(source, accessor);
    const std::string place = accessor_place(accessor) + ".sparse";
    const auto count = static_cast<std::size_t>(access.sparse.count);
    if (count > access.count) refuse("more sparse elements than elements", place + ".count");
    const int type = access.sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        refuse("sparse indices are not unsigned integers", place + ".indices.componentType");
    }
    const std::size_t index_bytes = component_bytes(type, place);
    const Strided indices = strided_view(source, access.sparse.indices.bufferView,
                                         static_cast<std::size_t>(access.sparse.indices.byteOffset), 0, count,
                                         index_bytes, place + ".indices");
    const Strided values =
        strided_view(source, access.sparse.values.bufferView, static_cast<std::size_t>(access.sparse.values.byteOffset),
                     0, count, element_bytes, place + ".values");
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t index = 0;  // little-endian, as the machines we run on
        std::memcpy(&index, indices.bytes.data() + indices.offset + i * index_bytes, index_bytes);
        if (index >= access.count) refuse(fmt::format("index {} is out of range", index), place + ".indices");
        std::memcpy(elements.data() + index * element_bytes, values.bytes.data() + values.offset + i * element_bytes,
                    element_bytes);
    }
}

/// All elements without gaps, as bytes; zeros where there is no buffer view. The caller has charged them.
std::vector<std::uint8_t> gather(GltfSource& source, int accessor, std::size_t element_bytes) {
    const tinygltf::Accessor& access = accessor_at(source, accessor);
    const std::string place = accessor_place(accessor);
    std::vector<std::uint8_t> elements(access.count * element_bytes);
    if (access.bufferView >= 0 && source.accessors_without_view.count(accessor) == 0) {
        const std::size_t stride = source.model.bufferViews[static_cast<std::size_t>(access.bufferView)].byteStride;
        const Strided from =
            strided_view(source, access.bufferView, access.byteOffset, stride, access.count, element_bytes, place);
        for (std::size_t i = 0; i < access.count; ++i) {
            std::memcpy(elements.data() + i * element_bytes, from.bytes.data() + from.offset + i * from.stride,
                        element_bytes);
        }
    }
    if (access.sparse.isSparse) apply_sparse(source, accessor, element_bytes, elements);
    return elements;
}

/// @param largest  of the type, for normalised values; 0 keeps the number
template <class T>
void convert(const std::vector<std::uint8_t>& elements, float largest, std::vector<float>& floats) {
    for (std::size_t i = 0; i < floats.size(); ++i) {
        T value{};
        std::memcpy(&value, elements.data() + i * sizeof(T), sizeof(T));
        const auto number = static_cast<float>(value);
        floats[i] = largest == 0.0f ? number : std::max(number / largest, -1.0f);
    }
}

}  // namespace

std::string accessor_place(int accessor) { return fmt::format("accessors[{}]", accessor); }

std::size_t accessor_count(const GltfSource& source, int accessor) { return accessor_at(source, accessor).count; }

int accessor_components(const GltfSource& source, int accessor) {
    switch (accessor_at(source, accessor).type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            refuse("neither a scalar nor a vector", accessor_place(accessor) + ".type");
    }
}

std::vector<float> read_floats(GltfSource& source, int accessor, int components) {
    const tinygltf::Accessor& access = accessor_at(source, accessor);
    const std::string place = accessor_place(accessor);
    const int own_components = accessor_components(source, accessor);
    if (own_components != components) {
        refuse(fmt::format("has {} components where {} are needed", own_components, components), place + ".type");
    }
    const std::size_t element_bytes =
        component_bytes(access.componentType, place) * static_cast<std::size_t>(components);
    const TemporaryCharge raw{source.budget, access.count, element_bytes + 4 * static_cast<std::size_t>(components),
                              place};
    const std::vector<std::uint8_t> elements = gather(source, accessor, element_bytes);
    std::vector<float> floats(access.count * static_cast<std::size_t>(components));
    const auto scale = [&access](float largest) { return access.normalized ? largest : 0.0f; };
    switch (access.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            convert<std::int8_t>(elements, scale(127.0f), floats);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            convert<std::uint8_t>(elements, scale(255.0f), floats);
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            convert<std::int16_t>(elements, scale(32767.0f), floats);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            convert<std::uint16_t>(elements, scale(65535.0f), floats);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            convert<std::uint32_t>(elements, 0.0f, floats);
            break;
        default:
            convert<float>(elements, 0.0f, floats);
            break;
    }
    return floats;
}

std::vector<std::uint32_t> read_indices(GltfSource& source, int accessor) {
    const tinygltf::Accessor& access = accessor_at(source, accessor);
    const std::string place = accessor_place(accessor);
    if (accessor_components(source, accessor) != 1) refuse("indices are not scalars", place + ".type");
    const int type = access.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        refuse("indices are not unsigned integers", place + ".componentType");
    }
    const std::size_t index_bytes = component_bytes(type, place);
    const TemporaryCharge raw{source.budget, access.count, index_bytes + 4, place};
    const std::vector<std::uint8_t> elements = gather(source, accessor, index_bytes);
    std::vector<std::uint32_t> indices(access.count);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        std::memcpy(&indices[i], elements.data() + i * index_bytes, index_bytes);  // little-endian
    }
    return indices;
}

std::span<const std::uint8_t> buffer_bytes(const GltfSource& source, int buffer, std::uint64_t offset,
                                           std::uint64_t length, const std::string& place) {
    const std::span<const std::uint8_t> bytes = source.buffers[static_cast<std::size_t>(buffer)].view;
    if (bytes.data() == nullptr) refuse(fmt::format("buffer {} has no data", buffer), place);
    if (offset > bytes.size() || length > bytes.size() - offset) {
        refuse(fmt::format("bytes {} to {} lie outside of buffer {} with {} bytes", offset, offset + length, buffer,
                           bytes.size()),
               place);
    }
    return bytes.subspan(offset, length);
}

std::span<const std::uint8_t> view_bytes(GltfSource& source, int view) {
    const tinygltf::BufferView& buffer_view = source.model.bufferViews[static_cast<std::size_t>(view)];
    if (is_meshopt_compressed(buffer_view)) return meshopt_view_bytes(source, view);
    return buffer_bytes(source, buffer_view.buffer, buffer_view.byteOffset, buffer_view.byteLength,
                        fmt::format("bufferViews[{}]", view));
}

}  // namespace lw::scene
