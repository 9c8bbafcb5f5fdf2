#include "scene/json_cost.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace lw::scene {
namespace {

using nlohmann::json;

// What nlohmann's tree costs on a 64-bit system: 16 bytes per value, doubled by growing arrays; every array or object
// has a container on the heap (a std::map is 48 bytes, 64 with the allocator's), an object's entry a map node with the
// key besides.
constexpr std::uint64_t kBytesPerValue = 32;
constexpr std::uint64_t kBytesPerContainer = 64;
constexpr std::uint64_t kBytesPerKey = 96;

/// One line and without the library's identifiers: "[json.exception.parse_error.101] parse error at ..." -> "parse
/// ...".
std::string parser_message(const nlohmann::detail::exception& exception) {
    std::string_view message = exception.what();
    const std::size_t bracket = message.find("] ");
    if (bracket != std::string_view::npos) message.remove_prefix(bracket + 2);
    return std::string{message.substr(0, 160)};
}

/// Counts what the parser meets. The library's own way to watch a parse, a callback, takes time quadratic in the
/// length of arrays.
class Counter final : public json::json_sax_t {
public:
    Counter(int max_depth, std::uint64_t max_bytes) : max_depth_{max_depth}, max_bytes_{max_bytes} {}

    [[nodiscard]] const JsonCost& cost() const { return cost_; }

    bool null() override { return add_value(); }
    bool boolean(bool) override { return add_value(); }
    bool number_integer(number_integer_t) override { return add_value(); }
    bool number_unsigned(number_unsigned_t) override { return add_value(); }
    bool number_float(number_float_t, const string_t&) override { return add_value(); }
    bool binary(binary_t&) override { return add_value(); }
    bool string(string_t& text) override {
        cost_.text_bytes += text.size();
        return add_value();
    }
    bool key(string_t& name) override {
        cost_.structure_bytes += kBytesPerKey + name.size();
        return true;
    }
    bool start_object(std::size_t) override { return open(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& exception) override {
        refuse("broken JSON: " + parser_message(exception), "");
    }

private:
    bool add_value() {
        cost_.structure_bytes += kBytesPerValue;
        if (cost_.bytes() > max_bytes_) {
            refuse("the JSON needs too much memory", "", "reduce the model or save it as .glb");
        }
        return true;
    }
    bool open() {
        if (++depth_ > max_depth_) refuse("JSON is nested too deep", "");
        cost_.structure_bytes += kBytesPerContainer;
        return add_value();
    }
    bool close() {
        --depth_;
        return true;
    }

    int max_depth_;
    std::uint64_t max_bytes_;
    int depth_ = 0;
    JsonCost cost_;
};

}  // namespace

JsonCost json_cost(std::span<const std::uint8_t> text, int max_depth, std::uint64_t max_bytes) {
    Counter counter{max_depth, max_bytes};
    (void)json::sax_parse(text.begin(), text.end(), &counter);
    return counter.cost();
}

}  // namespace lw::scene
