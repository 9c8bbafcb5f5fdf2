#pragma once
/// What the warp suite measures: a fraction of all methods x sizes x frame ages x sources x fills, chosen so that every
/// factor is varied around one base while the others stand still.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench_point.h"

namespace lw {

/// A scene and the trace that is walked through it.
struct SweepPair {
    std::string scene;  ///< built-in name or path
    std::string trace;  ///< built-in name or path
    double trace_start_s = 0.0;
    std::string scene_label;  ///< short names, for tables
    std::string trace_label;
};

struct WarpSetting {
    std::string method;
    std::string fill;

    friend bool operator==(const WarpSetting&, const WarpSetting&) = default;
};

/// Sources of one kind, and all that is done with them.
struct SweepCell {
    BenchConditions conditions;
    std::vector<WarpSetting> settings;
    std::size_t pairs = 0;   ///< the first so many of the plan's pairs
    std::size_t frames = 0;  ///< pictures per pair
};

struct SweepPlan {
    std::vector<SweepPair> pairs;  ///< scenes one after another cost least: a scene is loaded when it changes
    std::vector<SweepCell> cells;
    std::size_t core_pairs = 0;     ///< every cell has at least the first so many: what curves over cells are made of
    double frame_spacing_s = 0.45;  ///< between the pictures of a pair
    int truth_samples = 4;          ///< per axis
    std::vector<std::string> warnings;  ///< what is missing, one line each

    [[nodiscard]] std::size_t point_count() const;
    /// Pictures to judge, over all cells, settings and pairs.
    [[nodiscard]] std::size_t judgement_count() const;
};

/// The scenes and traces below `data` (`city` and two models, three recordings), or `city` along built-in traces and
/// one warning where `data` is not there. Pure but for looking at the folder.
[[nodiscard]] SweepPlan warp_sweep_plan(bool quick, const std::filesystem::path& data);

/// `specification` without what changes its run time only (threads): equal pictures have equal labels.
[[nodiscard]] std::string picture_label(const std::string& specification);

}  // namespace lw
