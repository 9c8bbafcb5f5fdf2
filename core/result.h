#pragma once
/// World errors (file, driver, argument): a value or what went wrong, where, and how to mend it.

#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>

#include "core/check.h"

namespace lw {

/// Shown to the user as one line: "WHAT: WHERE: MEND".
struct Error {
    std::string what;   ///< what is wrong: "not a PNG file"
    std::string where;  ///< the file, option or object it is about: "city/main.color.png"
    std::string mend;   ///< what the user can do: "write it with 'latewarp render --frame'"

    [[nodiscard]] std::string message() const { return fmt::format("{}: {}: {}", what, where, mend); }
};

template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_{std::in_place_index<0>, std::move(value)} {}      // NOLINT(google-explicit-constructor)
    Result(Error error) : state_{std::in_place_index<1>, std::move(error)} {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    /// Programmer error when !ok().
    [[nodiscard]] T& value() & {
        LW_CHECK(ok(), error_or_empty());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] const T& value() const& {
        LW_CHECK(ok(), error_or_empty());
        return *std::get_if<0>(&state_);
    }
    [[nodiscard]] T&& value() && {
        LW_CHECK(ok(), error_or_empty());
        return std::move(*std::get_if<0>(&state_));
    }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Programmer error when ok().
    [[nodiscard]] const Error& error() const {
        LW_CHECK(!ok(), "the result holds a value");
        return *std::get_if<1>(&state_);
    }

private:
    [[nodiscard]] std::string error_or_empty() const { return ok() ? std::string{} : error().message(); }

    std::variant<T, Error> state_;
};

/// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace lw
