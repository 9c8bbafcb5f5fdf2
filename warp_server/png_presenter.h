#pragma once
/// Writes chosen pictures to PNG files on their way to another display.

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "warp_server/presenter.h"

namespace lw {

/// Encoding takes tens of milliseconds on the server's thread: under a virtual clock, or where a missed refresh does
/// not matter.
class PngPresenter final : public Presenter {
public:
    /// Writes every `every`-th picture (>= 1) to `folder`/NNNNNN.png by its refresh number; `display` outlives this.
    /// The folder exists.
    PngPresenter(Presenter& display, std::filesystem::path folder, std::uint64_t every = 1);

    [[nodiscard]] Refresh next_refresh(TimePoint now) const override { return display_.next_refresh(now); }
    void present(const DisplayFrame& frame, const Refresh& refresh) override;
    /// Handed on; strips are not written.
    void present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) override {
        display_.present_strip(strip, slot, place);
    }
    [[nodiscard]] bool closed() const override { return display_.closed(); }

    /// The first error of writing; nothing is written after it.
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    Presenter& display_;
    std::filesystem::path folder_;
    std::uint64_t every_;
    std::uint64_t presented_ = 0;
    std::optional<Error> error_;
};

}  // namespace lw
