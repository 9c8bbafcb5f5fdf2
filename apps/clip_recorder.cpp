#include "apps/clip_recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/report.h"
#include "core/image_io.h"

namespace lw {

void ClipRecorder::offer(const ColourImage& picture, std::uint64_t refresh) {
    const std::unique_lock lock{mutex_, std::try_to_lock};
    if (!lock.owns_lock() || waiting_refresh_) return;
    waiting_.resize(picture.size_px());
    std::ranges::copy(picture.pixels(), waiting_.pixels().begin());
    waiting_refresh_ = refresh;
}

Status ClipRecorder::write() {
    std::uint64_t refresh = 0;
    {
        const std::lock_guard lock{mutex_};
        if (!waiting_refresh_) return Done{};
        refresh = *waiting_refresh_;
        std::swap(waiting_, writing_);
        waiting_refresh_.reset();
    }
    if (failed_) return Done{};
    Status status = make_output_folder(folder_);
    if (status) status = write_png(folder_ / fmt::format("{:06}.png", refresh), writing_);
    if (status) {
        ++written_;
    } else {
        failed_ = true;
    }
    return status;
}

}  // namespace lw
