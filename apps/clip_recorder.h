#pragma once
/// Writes what a window shows to numbered PNG files, without making the server wait for the encoder.

#include <filesystem>
#include <mutex>
#include <optional>

#include "core/image.h"
#include "core/result.h"

namespace lw {

/// The server's thread offers every picture; the main thread writes the newest one it has time for. A picture that
/// comes while the one before is still being written is left out.
class ClipRecorder {
public:
    /// Pictures go to `folder`/NNNNNN.png, numbered by their refresh. The folder is made at the first.
    explicit ClipRecorder(std::filesystem::path folder) : folder_{std::move(folder)} {}

    /// Server's thread: copies the picture if there is room; never waits.
    void offer(const ColourImage& picture, std::uint64_t refresh);
    /// Main thread: writes what was offered since the last call, if anything. After an error nothing is written any
    /// more; the error is returned once.
    [[nodiscard]] Status write();
    [[nodiscard]] std::size_t written() const { return written_; }

private:
    std::filesystem::path folder_;
    std::mutex mutex_;  ///< held while copying; the server only tries it
    ColourImage waiting_;
    std::optional<std::uint64_t> waiting_refresh_;
    ColourImage writing_;
    std::size_t written_ = 0;
    bool failed_ = false;
};

}  // namespace lw
