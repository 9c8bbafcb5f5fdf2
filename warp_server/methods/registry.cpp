#include "warp_server/methods/registry.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "warp_server/methods/factories.h"

namespace lw {

// The list of warp methods. To add one: a file with `MadeMethod make_ID_method(std::string, const MethodSettings&)`,
// and a line here:  ID, name, needs GL, settings, one line for --help.
#define LW_WARP_METHODS(METHOD)                                                                                   \
    METHOD(stale, "stale", false, "", "newest frame, unwarped")                                                   \
    METHOD(rotation, "rotation", false, "", "homography of the head's rotation, bilinear")                        \
    METHOD(points, "points", true, "size_px", "every pixel a GL point")                                           \
    METHOD(mesh, "mesh", true, "", "a vertex per pixel, triangles between neighbours")                            \
    METHOD(compute, "compute", true, "", "every pixel a point, in compute shaders")                               \
    METHOD(inverse_gl, "inverse-gl", true, "steps", "the inverse search in a compute shader")                     \
    METHOD(surface_gl, "surface-gl", true, "", "surface, drawn by GL")                                            \
    METHOD(splat, "splat", false, "threads", "every pixel a point, on the CPU")                                   \
    METHOD(inverse, "inverse", false, "steps,threads", "search in the source for every target pixel, on the CPU") \
    METHOD(surface, "surface", false, "threads,flatten",                                                          \
           "surfaces placed by their pieces, colour solved on each; the default")                                 \
    METHOD(reference, "reference", false, "", "double precision, slow and obvious: the oracle of the tests")

#define LW_DECLARE(id, ...) MadeMethod make_##id##_method(std::string label, const MethodSettings& settings);
LW_WARP_METHODS(LW_DECLARE)
#undef LW_DECLARE

namespace {

#define LW_ENTRY(id, name, needs_gl, settings, summary) {name, summary, needs_gl, settings, make_##id##_method},
constexpr MethodEntry kMethods[] = {LW_WARP_METHODS(LW_ENTRY)};
#undef LW_ENTRY

std::string_view name_of(std::string_view specification) { return specification.substr(0, specification.find(':')); }

bool takes_key(const MethodEntry& entry, std::string_view key) {
    std::string_view keys = entry.settings;
    while (!keys.empty()) {
        const std::size_t comma = keys.find(',');
        if (keys.substr(0, comma) == key) return true;
        keys = comma == std::string_view::npos ? std::string_view{} : keys.substr(comma + 1);
    }
    return false;
}

Error wrong_setting(std::string_view specification, const MethodEntry& entry, std::string what) {
    const std::string mend = entry.settings.empty()
                                 ? fmt::format("'{}' takes no settings", entry.name)
                                 : fmt::format("write {}:key=value, keys: {}", entry.name, entry.settings);
    return {std::move(what), std::string{specification}, mend};
}

// The part after the colon: "key=value,key=value".
Result<MethodSettings> parse_settings(std::string_view specification, const MethodEntry& entry) {
    MethodSettings settings;
    const std::size_t colon = specification.find(':');
    if (colon == std::string_view::npos) return settings;
    std::string_view rest = specification.substr(colon + 1);
    while (true) {
        const std::string_view item = rest.substr(0, rest.find(','));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos) {
            return wrong_setting(specification, entry, fmt::format("'{}' is not key=value", item));
        }
        const std::string_view key = item.substr(0, equals);
        const std::string_view text = item.substr(equals + 1);
        if (!takes_key(entry, key)) return wrong_setting(specification, entry, fmt::format("unknown key '{}'", key));
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
            return wrong_setting(specification, entry, fmt::format("'{}' is not a number", text));
        }
        if (!settings.emplace(std::string{key}, value).second) {
            return wrong_setting(specification, entry, fmt::format("key '{}' given twice", key));
        }
        if (item.size() == rest.size()) return settings;
        rest = rest.substr(item.size() + 1);
    }
}

}  // namespace

std::span<const MethodEntry> warp_methods() { return kMethods; }

const MethodEntry* find_warp_method(std::string_view specification) {
    for (const MethodEntry& entry : kMethods) {
        if (entry.name == name_of(specification)) return &entry;
    }
    return nullptr;
}

Result<std::unique_ptr<WarpMethod>> make_warp_method(std::string_view specification) {
    const MethodEntry* entry = find_warp_method(specification);
    if (entry == nullptr) {
        std::string names;
        for (const MethodEntry& known : kMethods) names += (names.empty() ? "" : ", ") + std::string{known.name};
        return Error{"unknown warp method", std::string{specification}, "one of: " + names};
    }
    Result<MethodSettings> settings = parse_settings(specification, *entry);
    if (!settings) return settings.error();
    return entry->make(std::string{specification}, *settings);
}

Result<int> whole_setting(const std::string& label, const MethodSettings& settings, std::string_view key, int fallback,
                          int lowest, int highest) {
    const auto found = settings.find(key);
    if (found == settings.end()) return fallback;
    const double value = found->second;
    if (value != std::floor(value) || value < lowest || value > highest) {
        return Error{fmt::format("'{}' out of range", key), label,
                     fmt::format("give a whole number from {} to {}", lowest, highest)};
    }
    return static_cast<int>(value);
}

}  // namespace lw
