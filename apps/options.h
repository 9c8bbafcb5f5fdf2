#pragma once
/// The command line as one plain struct. Parsing lives in options.cpp, the only file that sees the parser library.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/stereo_options.h"
#include "billboard_lod/billboard_settings.h"
#include "client_renderer/culling_settings.h"
#include "client_renderer/draw_order.h"
#include "client_renderer/shell_settings.h"
#include "client_renderer/source_camera.h"
#include "core/camera.h"
#include "core/pose.h"
#include "core/result.h"
#include "scene/built_in.h"

namespace lw {

inline constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;  ///< angles are degrees on the command line only

enum class Subcommand : std::uint8_t { demo, measure, replay, render, warp, compare, bench, generate, info };

/// Which head pose the client draws for (--source-pose).
enum class SourcePose : std::uint8_t {
    predicted,  ///< extrapolated to the middle of the frame's life on the display
    sampled,    ///< the newest sample at the start of drawing
};

/// --inject: delays that the latency harness has to find again, milliseconds in [0, 200]. What is empty is not
/// injected.
struct InjectedDelays {
    std::optional<double> tracker_ms;  ///< head samples reach both sides so much later
    std::optional<double> app_ms;      ///< rendered frames reach the server so much later
    std::optional<double> present_ms;  ///< the display's panel lights up so much after its scan-out

    [[nodiscard]] bool any() const { return tracker_ms || app_ms || present_ms; }
};

/// --load: what makes the app slower than it is.
struct AppLoad {
    double triangles = 0.0;  ///< drawn besides, at least so many per frame: the scene over and over
    double stall_ms = 0.0;   ///< it waits so long in every frame
};

/// Everything the user said, checked for range and for known names; defaults are filled in where they do not depend on
/// the subcommand. What is `optional` was not given.
struct Options {
    Subcommand subcommand = Subcommand::demo;

    std::string scene = "city";    ///< built-in name or path of a .gltf / .glb file (demo, measure, replay, render)
    scene::Parameters parameters;  ///< --param; holds --seed too, unless --param seed= was given
    std::filesystem::path input;   ///< first positional of warp, compare, info: frame folder, image or file
    std::filesystem::path other_input;  ///< second positional of compare
    std::string generated_name;         ///< positional of generate: a built-in scene

    glm::ivec2 size_px{1024, 1024};  ///< --size WxH, each side in [1, 8192]
    bool size_given = false;         ///< warp takes the size of the layer unless this is set
    double fov_deg = 90.0;           ///< --fov, vertical, degrees in [1, 170]
    bool fov_given = false;          ///< warp takes the field of view of the layer unless this is set
    double near_m = 0.05;            ///< --near, metres in [1e-4, 100]
    bool near_given = false;         ///< warp takes the near plane of the layer unless this is set

    std::string method;                  ///< --method, a warp method with settings; the best there is by default
    std::string fill;                    ///< --fill; by default the best that is fast enough
    bool fill_given = false;             ///< --method auto chooses the fill too unless this is set
    std::optional<double> error_cap;     ///< --error-cap of --method auto: mean FLIP, > 0
    std::optional<double> budget_ms;     ///< --budget-ms of --method auto, > 0
    std::filesystem::path bench_data;    ///< --bench-data of --method auto; empty: where bench keeps its own
    std::string chosen_because;          ///< why --method auto became what `method` says; empty: it was given
    std::vector<std::string> baselines;  ///< --baseline, in the order given, without repeats
    SourcePose source_pose = SourcePose::predicted;  ///< --source-pose
    /// --source-samples, --source-density and --guard-band; render has no guard band unless it is given.
    SourceSettings source{1, 1.0, std::nullopt};  // and --layers

    ShellSettings shells;                   ///< --shells, --shell-samples, --app-budget, --max-age
    bool layers_given = false;              ///< with shells the nearest has a hidden layer unless this is set
    CullingSettings culling;                ///< --no-skip
    DrawOrder draw_order;                   ///< --draw-order, --sorting-buffer
    std::optional<double> reveal_margin_m;  ///< --reveal-margin, metres; as the head moves unless given
    BillboardSettings billboards{};         ///< --billboards, --billboard-*

    StereoOptions stereo;  ///< --eyes, --stereo, --ipd, --eye-*, --stereo-output

    std::optional<double> app_hz;          ///< --app-hz; replay draws at 10 Hz unless given, live as fast as it can
    double display_hz = 90.0;              ///< --display-hz, [1, 1000]
    std::optional<std::string> predict;    ///< --predict; oracle in replay, adaptive live unless given
    double tracker_hz = 1000.0;            ///< --tracker-hz, [1, 10000]
    double lead_ms = 5.0;                  ///< --lead: latch this long before scan-out, milliseconds in [0, 1000]
    bool lead_given = false;               ///< live learns its lead unless this is set
    std::optional<double> app_latency_ms;  ///< --app-latency, milliseconds; one app period in replay unless given
    std::optional<int> strips;             ///< --strips: parts of a display frame with a pose of their own, [1, 64]
    InjectedDelays inject;                 ///< --inject, measure only
    AppLoad load;                          ///< --load, live only
    int truth_samples = 2;                 ///< --truth-samples: N x N samples per pixel; 1, 2 or 4
    double seconds = 10.0;                 ///< --seconds: length of the run, (0, 3600]

    std::string trace = "look-around";  ///< --trace, built-in name or file
    double trace_start_s = 0.0;         ///< --trace-start, seconds skipped, >= 0

    std::optional<Pose> pose;       ///< --pose, world_from_eye, unit quaternion
    double scene_time_s = 0.0;      ///< --time of render
    std::filesystem::path frame;    ///< --frame of render: folder for the frame the client would publish; may be empty
    std::filesystem::path objects;  ///< --objects of warp: movers at the target time; may be empty
    std::filesystem::path output;   ///< -o
    std::filesystem::path culling_map;  ///< --culling of info: a picture of what is skipped; may be empty

    std::filesystem::path out;        ///< --out, folder for reports and images; empty if not given
    std::filesystem::path report;     ///< --report, file for the JSON report; empty if not given
    bool save_frames = false;         ///< --save-frames
    double pixels_per_degree = 67.0;  ///< --ppd of compare

    std::string bench_suite = "warp";              ///< --suite of bench
    bool quick = false;                            ///< --quick of bench: at most three minutes
    std::string bench_part = "all";                ///< --part of bench: all, errors or times
    std::filesystem::path bench_merge;             ///< --merge of bench: what it has is not measured anew; may be empty
    double bench_most_s = 1e9;                     ///< --at-most of bench: no time is begun after so many seconds
    std::filesystem::path data{"../shared/data"};  ///< --data of bench: recorded traces and models; may be missing

    std::optional<std::uint64_t> seed;  ///< --seed
    int threads = 0;                    ///< --threads, [1, 256]; 0: as many as the machine has
    bool quiet = false;                 ///< --quiet: no progress, no summary

    /// The camera that --size, --fov and --near describe, at the origin.
    [[nodiscard]] Camera camera() const;
};

/// What main() is to do: run `options`, or print `text` (--help, --version) and end well.
struct CommandLine {
    Options options;
    std::optional<std::string> text;
};

/// Every error is a usage error. `arguments` without the program's name.
[[nodiscard]] Result<CommandLine> parse_command_line(const std::vector<std::string>& arguments);

/// "replay" and so on: the word on the command line and in report schemas.
[[nodiscard]] std::string_view name_of(Subcommand subcommand);

/// Baselines that are not warp methods: the client's own renderer at photon time.
[[nodiscard]] bool is_fresh_baseline(std::string_view label);

}  // namespace lw
