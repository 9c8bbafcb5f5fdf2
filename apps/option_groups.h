#pragma once
/// Groups of options that have a file of their own, apps/options_<subject>.cpp.

namespace lw {

class Declarer;

/// --suite, --quick, --data: what `bench` measures, and on what.
void declare_bench_run(Declarer& declare);

}  // namespace lw
