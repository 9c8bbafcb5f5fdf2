#pragma once
/// A progress bar on standard error; silent when that is no terminal, or when told to be quiet.

#include <cstdint>
#include <string>

namespace lw {

/// Clears its line when destroyed. One thread.
class Progress {
public:
    /// @param total  steps of the whole work, > 0
    Progress(std::string title, std::uint64_t total, bool quiet);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    /// `done` steps of the total are finished. Draws only when the shown percentage changes.
    void show(std::uint64_t done);

private:
    std::string title_;
    std::uint64_t total_;
    bool visible_;
    int shown_percent_ = -1;
};

}  // namespace lw
