/// Head traces of every format from arbitrary bytes. Those that read are placed and played, too.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "frame_link/trace.h"
#include "frame_link/trace_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const lw::TraceFile file{"no-such-folder/trace", {reinterpret_cast<const char*>(data), size}};
    for (const lw::TraceFormat& format : lw::trace_formats()) {
        if (!format.recognises(file.text)) continue;
        const lw::Result<lw::Trace> trace = format.read(file);
        if (!trace) continue;
        const lw::Trace placed = trace->placed_at(lw::Pose{{1.0, 1.6, -2.0}, {1.0, 0.0, 0.0, 0.0}}, 0.1);
        const lw::Pose pose = placed.at(0.5 * placed.duration_s());
        if (!lw::sanitised(pose) || std::abs(glm::length(pose.orientation) - 1.0) > 1e-6) std::abort();
    }
    return 0;
}
