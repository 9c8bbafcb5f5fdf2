#include "apps/option_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "apps/options.h"
#include "warp_server/methods/registry.h"

namespace lw::option_values {

namespace {

std::vector<std::string_view> method_names() {
    std::vector<std::string_view> names;
    for (const MethodEntry& entry : warp_methods()) names.push_back(entry.name);
    return names;
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string::npos) return parts;
        begin = end + 1;
    }
}

}  // namespace

[[noreturn]] void usage_error(std::string what, std::string where, std::string mend) {
    throw UsageError{{std::move(what), std::move(where), std::move(mend)}};
}

std::string joined(const std::vector<std::string_view>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::string joined_by_bar(const std::vector<std::string_view>& names) {
    return fmt::format("{}", fmt::join(names, "|"));
}

std::optional<double> parsed_number(std::string_view text) {
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, trouble] = std::from_chars(text.data(), end, number);
    if (trouble != std::errc{} || rest != end || !std::isfinite(number)) return std::nullopt;
    return number;
}

double number_in(const std::string& option, const std::string& text, const Range& range) {
    const std::optional<double> number = parsed_number(text);
    const bool fits = number && *number >= range.min && *number <= range.max;
    if (!fits || (range.whole && *number != std::floor(*number))) {
        usage_error(range.whole ? "not a whole number in range" : "not a number in range",
                    fmt::format("{} {}", option, text), fmt::format("give {} to {}", range.min, range.max));
    }
    return *number;
}

glm::ivec2 parsed_size(const std::string& text) {
    const auto parts = split(text, 'x');
    const std::string where = "--size " + text;
    if (parts.size() != 2) usage_error("not a size", where, "give WIDTHxHEIGHT, as 1024x1024");
    std::array<int, 2> sides{};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::optional<double> side = parsed_number(parts[i]);
        if (!side || *side < 1 || *side > kMaxSidePx || *side != std::floor(*side)) {
            usage_error("not a usable size", where, fmt::format("give whole sides of 1 to {} pixels", kMaxSidePx));
        }
        sides[i] = static_cast<int>(*side);
    }
    return {sides[0], sides[1]};
}

Pose parsed_pose(const std::string& text) {
    const auto parts = split(text, ',');
    const std::string where = "--pose " + text;
    std::array<double, 7> v{};
    if (parts.size() != v.size()) usage_error("not a pose", where, "give px,py,pz,qx,qy,qz,qw");
    for (std::size_t i = 0; i < v.size(); ++i) {
        const std::optional<double> number = parsed_number(parts[i]);
        if (!number) usage_error("not a pose", where, "give seven finite numbers px,py,pz,qx,qy,qz,qw");
        v[i] = *number;
    }
    const std::optional<Pose> pose = sanitised({{v[0], v[1], v[2]}, glm::dquat{v[6], v[3], v[4], v[5]}});
    if (!pose) usage_error("not a rotation", where, "give a unit quaternion qx,qy,qz,qw, as 0,0,0,1");
    return *pose;
}

void add_parameters(const std::string& text, scene::Parameters& parameters) {
    for (const std::string& pair : split(text, ',')) {
        const std::size_t equals = pair.find('=');
        const auto value = equals == std::string::npos ? std::nullopt : parsed_number(pair.substr(equals + 1));
        if (equals == 0 || !value) usage_error("not a parameter", "--param " + text, "give key=number");
        parameters[pair.substr(0, equals)] = *value;
    }
}

void check_method(const std::string& option, const std::string& specification, bool fresh_allowed) {
    if (fresh_allowed && is_fresh_baseline(specification)) return;
    if (find_warp_method(specification) != nullptr) return;
    usage_error("unknown warp method", option + " " + specification, "one of " + joined(method_names()));
}

void check_name(const std::string& kind, const std::string& option, const std::string& name,
                const std::vector<std::string_view>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    usage_error("unknown " + kind, option + " " + name, "one of " + joined(known));
}

void parse_named_numbers(const std::string& option, const std::string& text, const std::vector<std::string_view>& known,
                         const Range& range, bool in_ms, const std::function<void(std::string_view, double)>& store) {
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string entry = text.substr(begin, end - begin);
        begin = end + 1;
        const std::size_t equals = entry.find('=');
        if (equals == std::string::npos) {
            usage_error("not NAME=NUMBER", option + " " + text, "name one of " + joined(known));
        }
        const std::string name = entry.substr(0, equals);
        check_name("name", option, name, known);
        std::string number = entry.substr(equals + 1);
        if (in_ms && number.size() > 2 && number.ends_with("ms")) number.resize(number.size() - 2);
        store(name, number_in(option + " " + name, number, range));
    }
}

std::filesystem::path parsed_path(const std::string& option, const std::string& text) {
    if (text.empty()) usage_error("an empty path", option, "name a file or folder");
    return text;
}

}  // namespace lw::option_values
