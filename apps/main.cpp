/// The latewarp program: parse, dispatch, one line per error. Exit codes: 0 done, 1 failed, 2 wrong usage.

#include <cstdio>
#include <string>
#include <vector>

#include "apps/autotune.h"
#include "apps/options.h"
#include "apps/subcommands.h"

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

/// Errors are one line whatever went into them: a file name may hold a line break.
void print_error(const lw::Error& error) {
    std::string line = error.message();
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    std::fprintf(stderr, "latewarp: error: %s\n", line.c_str());
}

lw::Status run(const lw::Options& given) {
    const lw::Result<lw::Options> with_method = lw::with_chosen_method(given);
    if (!with_method) return with_method.error();
    const lw::Options& options = *with_method;
    switch (options.subcommand) {
        case lw::Subcommand::demo:
            return lw::run_demo(options);
        case lw::Subcommand::measure:
            return lw::run_measure(options);
        case lw::Subcommand::replay:
            return lw::run_replay(options);
        case lw::Subcommand::render:
            return lw::run_render(options);
        case lw::Subcommand::warp:
            return lw::run_warp(options);
        case lw::Subcommand::compare:
            return lw::run_compare(options);
        case lw::Subcommand::bench:
            return lw::run_bench(options);
        case lw::Subcommand::generate:
            return lw::run_generate(options);
        case lw::Subcommand::info:
            return lw::run_info(options);
    }
    return lw::Done{};
}

}  // namespace

int main(int argc, char** argv) {
    const auto command_line = lw::parse_command_line(std::vector<std::string>(argv + 1, argv + argc));
    if (!command_line) {
        print_error(command_line.error());
        return kWrongUsage;
    }
    if (command_line->text) {
        std::fputs(command_line->text->c_str(), stdout);
        return kDone;
    }
    const lw::Status status = run(command_line->options);
    if (!status) {
        print_error(status.error());
        return kFailed;
    }
    // A full disk shows only when the buffer is written: "compare > file" must not end well then.
    if (std::fflush(stdout) != 0) {
        print_error({"could not write", "standard output", "free space or close what reads it less early"});
        return kFailed;
    }
    return kDone;
}
