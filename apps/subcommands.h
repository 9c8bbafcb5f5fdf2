#pragma once
/// One entry function per subcommand, each in the file of its name. An error is a world error (exit code 1); usage
/// errors were found while parsing. Results go to files and standard output, progress and summaries to standard error.

#include "apps/options.h"
#include "core/result.h"

namespace lw {

/// Live: client and server threads on a real or virtual display; ends by itself and writes a summary.
[[nodiscard]] Status run_demo(const Options& options);
/// Live with the latency harness; JSON report.
[[nodiscard]] Status run_measure(const Options& options);
/// A trace on the virtual clock, every display frame compared with the truth.
[[nodiscard]] Status run_replay(const Options& options);
/// The truth image at a pose, and the frame the client would publish there.
[[nodiscard]] Status run_render(const Options& options);
/// A frame folder warped to a pose.
[[nodiscard]] Status run_warp(const Options& options);
/// PSNR, SSIM and FLIP of two images, as JSON on standard output.
[[nodiscard]] Status run_compare(const Options& options);
/// One suite of measurements: JSON, CSV, plots and an HTML page.
[[nodiscard]] Status run_bench(const Options& options);
/// A built-in scene as a .glb file.
[[nodiscard]] Status run_generate(const Options& options);
/// Counts, bounds and ignored parts of a scene, a frame folder or a trace.
[[nodiscard]] Status run_info(const Options& options);

}  // namespace lw
