#include "frame_link/csv_reader.h"

#include <charconv>
#include <cmath>

namespace lw {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

template <class Number>
std::optional<Number> parse_whole(std::string_view field) {
    const std::string_view text = trimmed(field);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

// Where the first field of `text` ends: at a comma outside of quotes, or at the end.
std::size_t end_of_field(std::string_view text) {
    const bool quoted = !text.empty() && text.front() == '"';
    const std::size_t closing_quote = quoted ? text.find('"', 1) : std::string_view::npos;
    const std::size_t comma = text.find(',', closing_quote == std::string_view::npos ? 0 : closing_quote);
    return comma == std::string_view::npos ? text.size() : comma;
}

std::string_view without_quotes(std::string_view field) {
    const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
    return quoted ? field.substr(1, field.size() - 2) : field;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

std::optional<double> parse_number(std::string_view field) { return parse_whole<double>(field); }
std::optional<std::int64_t> parse_integer(std::string_view field) { return parse_whole<std::int64_t>(field); }

std::optional<std::int64_t> parse_nanoseconds(std::string_view field) {
    std::string_view text = trimmed(field);
    const bool negative = !text.empty() && text.front() == '-';
    if (negative) text.remove_prefix(1);
    const std::size_t point = text.find('.');
    const auto seconds = parse_whole<std::uint32_t>(text.substr(0, point));
    if (!seconds || *seconds >= 4'000'000'000U) return std::nullopt;
    std::int64_t nanoseconds = 0;
    std::int64_t place = 100'000'000;
    const std::string_view decimals = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
    for (const char digit : decimals) {
        if (digit < '0' || digit > '9') return std::nullopt;
        nanoseconds += (digit - '0') * place;
        place /= 10;
    }
    nanoseconds += std::int64_t{*seconds} * 1'000'000'000;
    return negative ? -nanoseconds : nanoseconds;
}

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    std::string_view rest = line;
    while (true) {
        const std::size_t end = end_of_field(rest);
        fields.push_back(without_quotes(rest.substr(0, end)));
        if (end == rest.size()) return;
        rest.remove_prefix(end + 1);
    }
}

bool CsvReader::next() {
    while (!rest_.empty()) {
        const std::size_t end = rest_.find('\n');
        const std::string_view line = trimmed(rest_.substr(0, end));
        rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
        if (line.empty()) continue;
        split_fields(line, fields_);
        return true;
    }
    return false;
}

std::optional<double> CsvReader::number(std::size_t column) const {
    return column < fields_.size() ? parse_number(fields_[column]) : std::nullopt;
}

std::optional<std::size_t> CsvReader::column(std::string_view name) const {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        if (trimmed(fields_[i]) == name) return i;
    }
    return std::nullopt;
}

std::optional<std::vector<std::size_t>> CsvReader::columns(const std::vector<std::string_view>& names) const {
    std::vector<std::size_t> found;
    for (const std::string_view name : names) {
        const auto index = column(name);
        if (!index) return std::nullopt;
        found.push_back(*index);
    }
    return found;
}

}  // namespace lw
