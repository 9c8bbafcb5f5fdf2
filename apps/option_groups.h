#pragma once
/// Groups of options that have a file of their own, apps/options_<subject>.cpp, and checks over all of them.

#include "core/result.h"

namespace lw {

struct Options;

class Declarer;

/// --source-samples, --source-density: how finely the client draws.
void declare_source(Declarer& declare);
/// --guard-band: what it draws around the picture.
void declare_guard_band(Declarer& declare, bool auto_allowed);
/// --no-skip, --min-pixels, --draw-order, --sorting-buffer, --reveal-margin: what it draws, in which order.
void declare_skip(Declarer& declare);

/// --source-pose, --app-hz, --display-hz, --predict, --tracker-hz, --lead, --app-latency, --seconds.
void declare_timing(Declarer& declare);
/// --strips, --load.
void declare_strips_and_load(Declarer& declare);
/// --inject: delays for the harness.
void declare_inject(Declarer& declare);

/// --suite, --quick, --data, --part, --merge: what `bench` measures, and on what.
void declare_bench_run(Declarer& declare);

/// --error-cap, --budget-ms, --bench-data: what `--method auto` chooses by.
void declare_autotune(Declarer& declare);

/// --layers: what a frame of the client consists of.
void declare_layers(Declarer& declare);

/// --shells, --shell-samples, --app-budget, --max-age: the client's frames as shells around the viewer.
void declare_shells(Declarer& declare);

/// --billboards and --billboard-*: which objects the client draws as billboards, and how.
void declare_billboards(Declarer& declare);

/// --eyes, --stereo, --ipd, --eye-fov, --eye-turn, --stereo-output: the viewer's eyes, and how both get a picture.
void declare_stereo(Declarer& declare);
/// What of them does not go together.
[[nodiscard]] Status check_stereo(const Options& options);

/// What of all of them does not go together, and limits that concern two at once.
[[nodiscard]] Status check_together(const Options& options);

/// Of a subcommand that runs client, server and display at once.
[[nodiscard]] bool is_live(const Options& options);

}  // namespace lw
