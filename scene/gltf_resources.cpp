#include "scene/gltf_resources.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/image_io.h"

namespace lw::scene {
namespace {

namespace fs = std::filesystem;

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// "%20" -> " "; a percent sign without two hex digits stays as it is.
std::string percent_decoded(std::string_view uri) {
    std::string result;
    result.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size()) {
            const std::optional<int> high = hex_digit(uri[i + 1]);
            const std::optional<int> low = hex_digit(uri[i + 2]);
            if (high && low) {
                result.push_back(static_cast<char>(*high * 16 + *low));
                i += 2;
                continue;
            }
        }
        result.push_back(uri[i]);
    }
    return result;
}

/// "http:", "file:", and drive letters.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && uri.find('/') > colon;
}

[[noreturn]] void refuse_path(std::string_view uri, const std::string& place) {
    refuse(fmt::format("\"{}\" is not a file beside the model", uri.substr(0, 100)), place,
           "put every file the model uses into its folder");
}

fs::path path_inside(const std::string& uri, const fs::path& folder, const std::string& place) {
    const std::string decoded = percent_decoded(uri);
    const bool odd = std::any_of(decoded.begin(), decoded.end(),
                                 [](char c) { return static_cast<unsigned char>(c) < 32 || c == '\\'; });
    const fs::path relative{decoded};
    if (decoded.empty() || decoded.size() > 1024 || odd || has_scheme(decoded) || relative.is_absolute()) {
        refuse_path(uri, place);
    }
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    if (error) refuse("the model's folder cannot be read", place);
    const fs::path target = fs::weakly_canonical(root / relative, error);
    if (error) refuse_path(uri, place);
    const auto differs = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    if (differs.first != root.end()) refuse_path(uri, place);
    return target;
}

/// "data:[media type][;base64],DATA"; without base64 the data is percent-encoded.
std::vector<std::uint8_t> read_data_uri(const std::string& uri, MemoryBudget& budget, const std::string& place) {
    const std::size_t comma = uri.substr(0, 256).find(',');
    if (comma == std::string::npos) refuse("a data URI without data", place);
    const std::string_view head = std::string_view{uri}.substr(0, comma);
    const std::string_view text = std::string_view{uri}.substr(comma + 1);
    budget.charge(text.size(), place);
    constexpr std::string_view kMarker = ";base64";
    if (head.size() >= kMarker.size() && head.substr(head.size() - kMarker.size()) == kMarker) {
        return decode_base64(text, place);
    }
    const std::string decoded = percent_decoded(text);
    return {decoded.begin(), decoded.end()};
}

}  // namespace

std::vector<std::uint8_t> decode_base64(std::string_view text, const std::string& place) {
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> value_of{};
    value_of.fill(0xFF);
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
        value_of[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
    }
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<std::uint8_t> result;
    result.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const std::uint8_t value = value_of[static_cast<unsigned char>(c)];
        if (value == 0xFF) refuse("broken base64", place);
        bits = bits << 6 | value;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            result.push_back(static_cast<std::uint8_t>(bits >> bit_count & 0xFF));
        }
    }
    return result;
}

std::vector<std::uint8_t> read_uri(const std::string& uri, const fs::path& folder, MemoryBudget& budget,
                                   const std::string& place) {
    if (uri.rfind("data:", 0) == 0) return read_data_uri(uri, budget, place);
    const fs::path path = path_inside(uri, folder, place);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        refuse(fmt::format("the file \"{}\" is missing", uri.substr(0, 100)), place, "put it beside the model");
    }
    const std::uint64_t size = fs::file_size(path, error);
    if (error) refuse(fmt::format("the file \"{}\" cannot be read", uri.substr(0, 100)), place);
    budget.charge(size, place);
    auto bytes = read_file(path, size);
    if (!bytes.ok()) refuse(bytes.error().what, place, bytes.error().mend);
    return std::move(*bytes);
}

std::vector<GltfBytes> read_buffers(const nlohmann::json& buffers, bool has_binary_chunk,
                                    std::span<const std::uint8_t> binary_chunk, const fs::path& folder,
                                    MemoryBudget& budget) {
    std::vector<GltfBytes> result(buffers.size());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string place = fmt::format("buffers[{}]", i);
        const auto claimed = buffers[i].at("byteLength").get<std::size_t>();
        GltfBytes& bytes = result[i];
        if (buffers[i].contains("uri")) {
            bytes.owned = read_uri(buffers[i]["uri"].get_ref<const std::string&>(), folder, budget, place + ".uri");
            bytes.view = bytes.owned;
        } else if (i == 0 && has_binary_chunk) {
            bytes.view = binary_chunk;
        } else {
            continue;
        }
        if (claimed > bytes.view.size()) {
            refuse(fmt::format("the buffer claims {} bytes, there are {}", claimed, bytes.view.size()),
                   place + ".byteLength");
        }
        bytes.view = bytes.view.first(claimed);
    }
    return result;
}

}  // namespace lw::scene
