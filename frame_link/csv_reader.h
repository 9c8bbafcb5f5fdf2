#pragma once
/// Reads text tables of recordings: comma-separated lines, a byte-order mark and Windows line ends allowed.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lw {

/// The text without the UTF-8 byte-order mark it may begin with.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// A finite or non-finite number that fills the whole field but for blanks around it. No locale.
[[nodiscard]] std::optional<double> parse_number(std::string_view field);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view field);

/// Decimal seconds as whole nanoseconds, further digits cut off: an epoch stamp does not fit into a double without
/// losing some. |seconds| < 4e9, else nothing.
[[nodiscard]] std::optional<std::int64_t> parse_nanoseconds(std::string_view field);

/// Splits at commas; in a field in double quotes commas are plain text (the quotes are taken off). `fields` is
/// replaced and points into `line`.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

/// Goes through a text line by line. Keeps pointers into `text`, which must outlive it.
class CsvReader {
public:
    explicit CsvReader(std::string_view text) : rest_{without_byte_order_mark(text)} {}

    /// Moves to the next line that is not blank; false at the end.
    bool next();
    /// True when only blank lines follow the current one.
    [[nodiscard]] bool at_end() const { return rest_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

    [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
    /// The number in a column of the current line; nothing when it is no number or there is no such column.
    [[nodiscard]] std::optional<double> number(std::size_t column) const;
    /// The column of that name in the current line (the header), blanks around names ignored.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    /// The columns of all these names, or nothing when one is missing.
    [[nodiscard]] std::optional<std::vector<std::size_t>> columns(const std::vector<std::string_view>& names) const;

private:
    std::string_view rest_;
    std::vector<std::string_view> fields_;
};

}  // namespace lw
