#pragma once
/// How a group of options is written down, for the files that declare some. Only they see the parser library.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/option_values.h"
#include "apps/options.h"

namespace lw {

/// Declares options of one subcommand. Values are parsed here and not by the library: one wording for all errors.
class Declarer {
public:
    Declarer(CLI::App& app, Options& options) : app_{app}, options_{options} {}

    /// `parse` takes the text as given and throws option_values::UsageError when it is wrong. Given twice, the last
    /// one counts.
    template <class Parse>
    CLI::Option* value(const std::string& names, const std::string& type, const std::string& help, Parse parse) {
        return app_.add_option_function<std::string>(names, parse, help)->type_name(type)->take_last();
    }
    template <class Target>
    void number(const std::string& name, const std::string& type, const option_values::Range& range, Target& target,
                const std::string& help) {
        value(name, type, help, [name, range, &target](const std::string& text) {
            if constexpr (std::is_same_v<Target, std::optional<double>>) {
                target = option_values::number_in(name, text, range);
            } else {
                target = static_cast<Target>(option_values::number_in(name, text, range));
            }
        });
    }
    /// `add` is called for each of the texts.
    template <class Add>
    void repeated(const std::string& name, const std::string& type, const std::string& help, Add add) {
        app_.add_option_function<std::vector<std::string>>(
                name,
                [add](const std::vector<std::string>& texts) {
                    for (const std::string& text : texts) add(text);
                },
                help)
            ->type_name(type)
            ->allow_extra_args(false);
    }
    CLI::Option* path(const std::string& name, const std::string& type, std::filesystem::path& target,
                      const std::string& help) {
        return value(name, type, help,
                     [name, &target](const std::string& text) { target = option_values::parsed_path(name, text); });
    }
    CLI::App& app() { return app_; }
    Options& options() { return options_; }

private:
    CLI::App& app_;
    Options& options_;
};

}  // namespace lw
