#include "warp_server/png_presenter.h"

#include <fmt/format.h>

#include "core/image_io.h"

namespace lw {

PngPresenter::PngPresenter(Presenter& display, std::filesystem::path folder, std::uint64_t every)
    : display_{display}, folder_{std::move(folder)}, every_{every} {
    LW_CHECK(every >= 1, "every-th picture counts from 1");
}

void PngPresenter::present(const DisplayFrame& frame, const Refresh& refresh) {
    display_.present(frame, refresh);
    const bool chosen = presented_++ % every_ == 0;
    if (!chosen || error_) return;
    const Status status = write_png(folder_ / fmt::format("{:06}.png", refresh.number), frame.colour);
    if (!status) error_ = status.error();
}

}  // namespace lw
