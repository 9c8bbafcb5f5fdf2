#pragma once
/// One measured point of the warp suite: a method under given conditions, its run time and its error. Written into
/// reports and read back from them, for merging and for choosing a method from measured data.

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/image_errors.h"
#include "apps/machine.h"
#include "apps/report.h"
#include "core/result.h"
#include "core/statistics.h"

namespace lw {

/// What a frame of the client is like, and how old. Points that share all of it compete on one Pareto front.
struct BenchConditions {
    glm::ivec2 size_px{512, 512};  ///< of the display
    double frame_age_ms = 100.0;   ///< photon time minus the time of the pose that the source was drawn at
    int source_samples = 1;        ///< per axis
    double source_density = 1.0;

    friend bool operator==(const BenchConditions&, const BenchConditions&) = default;
};

/// Mean errors over the frames of one scene along one trace.
struct PairErrors {
    std::string scene;
    std::string trace;
    ImageErrors mean;  ///< psnr_db: over the pictures that differ from the truth
};

struct BenchPoint {
    std::string method;  ///< as on the command line, settings included
    std::string fill;
    BenchConditions conditions;
    std::vector<PairErrors> pairs;        ///< empty: errors were not measured
    std::optional<Distribution> warp_ms;  ///< warp and fill, wall time; nothing: not measured
    std::optional<double> warp_cpu_ms;    ///< median of the processor time of all threads
    std::optional<double> prepare_ms;     ///< median per client frame; nothing where there is nothing to prepare
    std::optional<double> memcpy_ratio;   ///< median of warp_ms over the median of copying the source's bytes
    std::optional<bool> on_front;         ///< no point of equal conditions is both faster and closer to the truth

    /// Mean over the pairs; nothing if errors were not measured.
    [[nodiscard]] std::optional<ImageErrors> errors() const;
};

/// Same method, fill and conditions.
[[nodiscard]] bool is_same_setting(const BenchPoint& a, const BenchPoint& b);

/// All that was timed, from one point to another.
void copy_times(const BenchPoint& from, BenchPoint& to);

/// Marks each point that has a time and errors: on the front unless another of equal conditions is at most as slow
/// (median of warp_ms) and at most as wrong (FLIP), and better in one of both. Others keep no mark. Pure.
void mark_pareto_fronts(std::vector<BenchPoint>& points);

/// Appends every point to `points` of the report. Keys as in docs/benchmarks.md.
void add_points(Report& report, const std::vector<BenchPoint>& points);

/// What a machine of any speed without latency would show: the display's picture drawn at photon time, with one sample
/// per pixel (`fresh`) or with the source's (`fresh-same`).
struct FreshErrors {
    glm::ivec2 size_px{};
    int samples = 1;
    std::vector<PairErrors> pairs;
};

/// Appends all to `fresh` of the report.
void add_fresh(Report& report, const std::vector<FreshErrors>& fresh);

struct BenchData {
    Machine machine;
    std::vector<BenchPoint> points;
    std::vector<FreshErrors> fresh;            ///< may be empty
    std::optional<double> processor_per_wall;  ///< while the times were taken: 1 on a quiet machine
};

/// Reads a report of `bench --suite warp`. Anything else is an error whose mend is to run the suite.
[[nodiscard]] Result<BenchData> load_bench_data(const std::filesystem::path& path);

}  // namespace lw
