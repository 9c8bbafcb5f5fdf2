#pragma once
/// The parsers of single option values. Each takes the text as the user wrote it and throws UsageError when it is not
/// what the option takes; parse_command_line() catches it. Nothing here knows the command line parser. Pure.

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "scene/built_in.h"

namespace lw::option_values {

/// Longest side of a picture. A client frame of 8192 x 8192 takes 0.7 GB of colour, depth and ids; beyond it drivers
/// give up in their own ways.
inline constexpr int kMaxSidePx = 8192;

/// Thrown by every function here.
struct UsageError {
    Error error;
};

[[noreturn]] void usage_error(std::string what, std::string where, std::string mend);

/// What a number option accepts, ends included.
struct Range {
    double min;
    double max;
    bool whole = false;  ///< integers only
};

/// "a, b, c".
[[nodiscard]] std::string joined(const std::vector<std::string_view>& names);

/// "a|b|c", as the type of an option.
[[nodiscard]] std::string joined_by_bar(const std::vector<std::string_view>& names);

/// The whole of `text` as a finite number, or nothing.
[[nodiscard]] std::optional<double> parsed_number(std::string_view text);
[[nodiscard]] double number_in(const std::string& option, const std::string& text, const Range& range);

/// "WIDTHxHEIGHT" of --size, pixels.
[[nodiscard]] glm::ivec2 parsed_size(const std::string& text);
/// "px,py,pz,qx,qy,qz,qw" of --pose; the quaternion is normalised, a zero one is refused.
[[nodiscard]] Pose parsed_pose(const std::string& text);
/// "key=number,key=number" of --param, added to `parameters`.
void add_parameters(const std::string& text, scene::Parameters& parameters);
/// "name=number,name=number" with names from `known` and numbers in `range`; a number may end in "ms" where `in_ms`.
/// `store` is called for each.
void parse_named_numbers(const std::string& option, const std::string& text, const std::vector<std::string_view>& known,
                         const Range& range, bool in_ms, const std::function<void(std::string_view, double)>& store);
/// An empty path is refused, since it would mean "not given" further on.
[[nodiscard]] std::filesystem::path parsed_path(const std::string& option, const std::string& text);

/// `name` is one of `known`, or an error that lists them.
void check_name(const std::string& kind, const std::string& option, const std::string& name,
                const std::vector<std::string_view>& known);
/// A warp method with or without settings; `fresh` and `fresh-same` too where `fresh_allowed`.
void check_method(const std::string& option, const std::string& specification, bool fresh_allowed);

}  // namespace lw::option_values
