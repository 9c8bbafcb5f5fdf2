#include "apps/options.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "apps/option_declarer.h"
#include "apps/option_groups.h"
#include "apps/option_values.h"
#include "frame_link/prediction.h"
#include "frame_link/trace.h"
#include "warp_server/fill.h"
#include "warp_server/methods/registry.h"

namespace lw {

namespace {

using namespace option_values;

void declare_scene(Declarer& declare, bool required) {
    Options& options = declare.options();
    CLI::Option* scene = declare.value("SCENE", "", "built-in scene, or a .gltf or .glb file", [&](const auto& text) {
        if (text.empty()) usage_error("an empty scene name", "SCENE", "name a built-in scene or a file");
        options.scene = text;
    });
    if (required) scene->required();
}

void declare_parameters(Declarer& declare) {
    Options& options = declare.options();
    declare.repeated("--param", "KEY=NUMBER[,...]", "parameter of a built-in scene (repeatable)",
                     [&options](const std::string& text) { add_parameters(text, options.parameters); });
    declare.value("--seed", "N", "seed of whatever is random", [&options](const std::string& text) {
        options.seed = static_cast<std::uint64_t>(number_in("--seed", text, {0, 4294967295.0, true}));
    });
}

void declare_camera(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--size", "WxH", "size of the picture (1024x1024)", [&options](const std::string& text) {
        options.size_px = parsed_size(text);
        options.size_given = true;
    });
    declare.value("--fov", "DEG", "vertical field of view (90)", [&options](const std::string& text) {
        options.fov_deg = number_in("--fov", text, {1, 170});
        options.fov_given = true;
    });
    declare.value("--near", "M", "distance of the near plane (0.05)", [&options](const std::string& text) {
        options.near_m = number_in("--near", text, {1e-4, 100});
        options.near_given = true;
    });
}

void declare_method(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--method", "METHOD", "warp method, NAME or NAME:KEY=NUMBER,..., or auto; see below",
                  [&options](const std::string& text) {
                      if (text != "auto") check_method("--method", text, false);
                      options.method = text;
                  });
    declare.value("--fill", "FILL", "what is shown in holes (pyramid; live nearest-background, which is faster)",
                  [&options](const std::string& text) {
                      check_name("fill", "--fill", text, fill_names());
                      options.fill = text;
                      options.fill_given = true;
                  });
    declare_autotune(declare);
}

void declare_trace(Declarer& declare, bool required) {
    Options& options = declare.options();
    CLI::Option* trace =
        declare.value("--trace", "TRACE", "head trace, built-in or a recording", [&options](const std::string& text) {
            if (text.empty()) usage_error("an empty trace name", "--trace", "name a built-in trace or a file");
            options.trace = text;
        });
    if (required) trace->required();
    declare.number("--trace-start", "S", {0, 1e6}, options.trace_start_s, "skip into the trace (0)");
}

void declare_baselines(Declarer& declare) {
    Options& options = declare.options();
    declare.repeated("--baseline", "METHOD",
                     "method beside it, also fresh or fresh-same, with two eyes also a way to make stereo (repeatable)",
                     [&options](const std::string& text) {
                         if (!find_stereo_mode(text)) check_method("--baseline", text, true);
                         auto& known = options.baselines;
                         if (std::find(known.begin(), known.end(), text) == known.end()) known.push_back(text);
                     });
}

void declare_truth(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--truth-samples", "N", "NxN samples per pixel of the truth: 1, 2 or 4 (2)",
                  [&options](const std::string& text) {
                      check_name("number of samples", "--truth-samples", text, {"1", "2", "4"});
                      options.truth_samples = static_cast<int>(*parsed_number(text));
                  });
}

void declare_reports(Declarer& declare, bool frames) {
    Options& options = declare.options();
    declare.path("--out", "DIR", options.out, "folder for reports and images, made if missing");
    declare.path("--report", "FILE.json", options.report, "the JSON report");
    if (!frames) return;
    declare.app().add_flag("--save-frames", options.save_frames, "keep every image in the --out folder");
}

void declare_common(Declarer& declare) {
    Options& options = declare.options();
    declare.number("--threads", "N", {1, 256, true}, options.threads,
                   "threads for the error figures (all cores); a warp uses one");
    declare.app().add_flag("--quiet", options.quiet, "no progress bar, no summary");
}

void declare_live(Declarer declare) {
    declare_scene(declare, false);
    declare_trace(declare, false);
    declare_camera(declare);
    declare_source(declare);
    declare_guard_band(declare, true);
    declare_layers(declare);
    declare_shells(declare);
    declare_skip(declare);
    declare_billboards(declare);
    declare_stereo(declare);
    declare_method(declare);
    declare_timing(declare);
    declare_strips_and_load(declare);
    declare_truth(declare);
    declare_reports(declare, true);
    declare_parameters(declare);
    declare_common(declare);
}

void declare_measure(Declarer declare) {
    declare_live(declare);
    declare_inject(declare);
}

void declare_replay(Declarer declare) {
    declare_scene(declare, false);
    declare_trace(declare, true);
    declare_camera(declare);
    declare_source(declare);
    declare_guard_band(declare, true);
    declare_layers(declare);
    declare_shells(declare);
    declare_skip(declare);
    declare_billboards(declare);
    declare_stereo(declare);
    declare_method(declare);
    declare_baselines(declare);
    declare_timing(declare);
    declare_truth(declare);
    declare_reports(declare, true);
    declare_parameters(declare);
    declare_common(declare);
}

void declare_pose(Declarer& declare, const std::string& help) {
    Options& options = declare.options();
    declare.value("--pose", "px,py,pz,qx,qy,qz,qw", help,
                  [&options](const std::string& text) { options.pose = parsed_pose(text); });
}

void declare_render(Declarer declare) {
    Options& options = declare.options();
    declare_scene(declare, true);
    declare_pose(declare, "world_from_eye (the scene's start pose)");
    declare.path("-o", "FILE.png", options.output, "the truth image")->required();
    declare.number("--time", "S", {-1e6, 1e6}, options.scene_time_s, "scene time (0)");
    declare.path("--frame", "DIR", options.frame, "folder for the frame that the client would publish here");
    declare_camera(declare);
    declare_source(declare);
    declare_guard_band(declare, false);
    declare_layers(declare);
    declare_skip(declare);
    declare_truth(declare);
    declare_parameters(declare);
    declare_common(declare);
}

void declare_warp(Declarer declare) {
    Options& options = declare.options();
    declare.path("FRAMEDIR", "", options.input, "frame folder, as 'render --frame' writes it")->required();
    declare_pose(declare, "world_from_eye (the frame's own pose)");
    declare.path("-o", "FILE.png", options.output, "the warped image")->required();
    declare.path("--objects", "FILE.json", options.objects, "placements of the movers (the frame's own)");
    declare_camera(declare);
    declare_method(declare);
    declare_common(declare);
}

void declare_compare(Declarer declare) {
    Options& options = declare.options();
    declare.path("A.png", "", options.input, "the reference")->required();
    declare.path("B.png", "", options.other_input, "the image to judge")->required();
    declare.number("--ppd", "N", {1e-3, 1e5}, options.pixels_per_degree, "pixels per degree, for FLIP (67)");
    declare_common(declare);
}

void declare_generate(Declarer declare) {
    Options& options = declare.options();
    declare
        .value("NAME", "", "built-in scene",
               [&options](const std::string& text) {
                   std::vector<std::string_view> known;
                   for (const scene::BuiltInScene& entry : scene::built_in_scenes()) known.push_back(entry.name);
                   check_name("built-in scene", "generate", text, known);
                   options.generated_name = text;
               })
        ->required();
    declare.path("-o", "FILE.glb", options.output, "the file to write")->required();
    declare_parameters(declare);
    declare_common(declare);
}

void declare_bench(Declarer declare) {
    declare_bench_run(declare);
    declare_reports(declare, false);
    declare_common(declare);
}

void declare_info(Declarer declare) {
    Options& options = declare.options();
    declare.path("FILE", "", options.input, "scene, frame folder or trace")->required();
    declare.path("--culling", "FILE.png", options.culling_map, "a scene from above: what is drawn and what is skipped");
    declare_pose(declare, "world_from_eye for --culling (the scene's start pose)");
    declare_skip(declare);
    declare_parameters(declare);
    declare_common(declare);
}

struct SubcommandEntry {
    Subcommand subcommand;
    const char* name;
    const char* summary;
    void (*declare)(Declarer declare);
};
constexpr std::array kSubcommands = {
    SubcommandEntry{Subcommand::demo, "demo", "Live: a slow client and a fast warp server, in a window if there is one",
                    declare_live},
    SubcommandEntry{Subcommand::measure, "measure", "Live with the latency harness, JSON report", declare_measure},
    SubcommandEntry{Subcommand::replay, "replay", "A head trace on a virtual clock, every frame against the truth",
                    declare_replay},
    SubcommandEntry{Subcommand::render, "render", "The truth image at a pose, and the client's frame", declare_render},
    SubcommandEntry{Subcommand::warp, "warp", "A frame folder warped to a pose", declare_warp},
    SubcommandEntry{Subcommand::compare, "compare", "PSNR, SSIM and FLIP of two images, as JSON", declare_compare},
    SubcommandEntry{Subcommand::bench, "bench", "Run time against error, measured on this machine", declare_bench},
    SubcommandEntry{Subcommand::generate, "generate", "A built-in scene as a .glb file", declare_generate},
    SubcommandEntry{Subcommand::info, "info", "What is in a scene, a frame folder or a trace", declare_info},
};

std::string subcommand_list() {
    std::string list;
    for (const SubcommandEntry& entry : kSubcommands) {
        list += fmt::format("{}{}", list.empty() ? "" : ", ", entry.name);
    }
    return list;
}

/// What the registries hold, so that the help can never be out of date.
std::string footer() {
    std::string text = "warp methods:\n";
    for (const MethodEntry& entry : warp_methods()) {
        text += fmt::format("  {:<12} {}", entry.name, entry.summary);
        if (!entry.settings.empty()) text += fmt::format(" (settings: {})", entry.settings);
        text += "\n";
    }
    text += fmt::format("fills: {}\npredictors: {}\ntraces: {}, or a file\nscenes: ", joined(fill_names()),
                        joined(predictor_names()), joined(built_in_trace_names()));
    std::vector<std::string> scenes;
    for (const scene::BuiltInScene& entry : scene::built_in_scenes()) {
        scenes.push_back(fmt::format("{} (--param {})", entry.name, entry.parameters));
    }
    return text + fmt::format("{}, or a .gltf or .glb file\n", fmt::join(scenes, ", "));
}

/// The best method there is: the first of these that was built. Live it must leave time to spare in every refresh of
/// two busy cores: in the city at 1024x1024 splat was too late for 0.84-1.3 % of the refreshes of a turning head on one
/// thread and for 0.44-0.84 % on two (four runs each, 6 to 20 s); surface takes two to three times as long.
std::string default_method(Subcommand subcommand) {
    const bool live = subcommand == Subcommand::demo || subcommand == Subcommand::measure;
    for (const char* name : {live ? "splat:threads=2" : "surface", "splat", "reference"}) {
        if (find_warp_method(name) != nullptr) return name;
    }
    return std::string{warp_methods().front().name};
}

/// --seed is a scene parameter wherever the scene has one; --param seed= is the more exact word and wins.
void seed_the_scene(Options& options) {
    if (!options.seed) return;
    const std::string& name = options.subcommand == Subcommand::generate ? options.generated_name : options.scene;
    for (const scene::BuiltInScene& entry : scene::built_in_scenes()) {
        if (entry.name == name && entry.parameters.find("seed") != std::string_view::npos) {
            options.parameters.try_emplace("seed", static_cast<double>(*options.seed));
        }
    }
}

/// The library's own errors: options it does not know, missing values, missing arguments.
Error worded(const CLI::ParseError& error, const std::string& help) {
    const std::string text = error.what();
    const std::string mend = fmt::format("see '{} --help'", help);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
        const std::size_t colon = text.find(": ");
        const std::string names = colon == std::string::npos ? text : text.substr(colon + 2);
        return {names.rfind('-', 0) == 0 ? "unknown option" : "unexpected argument", names, mend};
    }
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        const std::size_t end = text.rfind(" is required");
        return {"missing", end == std::string::npos ? text : text.substr(0, end), mend};
    }
    const std::size_t colon = text.find(": ");
    if (colon == std::string::npos) return {"wrong usage", text, mend};
    return {text.substr(colon + 2), text.substr(0, colon), mend};
}

Result<CommandLine> parse(const std::vector<std::string>& arguments) {
    CommandLine command_line;
    Options& options = command_line.options;
    CLI::App app{"Latewarp shows a slow renderer at full display rate.", "latewarp"};
    app.set_version_flag("--version", "latewarp " LW_VERSION);
    app.footer(footer);
    std::string help_name = "latewarp";
    for (const SubcommandEntry& entry : kSubcommands) {
        CLI::App* sub = app.add_subcommand(entry.name, entry.summary);
        sub->footer(footer);
        entry.declare(Declarer{*sub, options});
        if (!arguments.empty() && arguments.front() == entry.name) {
            options.subcommand = entry.subcommand;
            help_name = fmt::format("latewarp {}", entry.name);
        }
    }
    app.require_subcommand(1);
    if (arguments.empty()) return Error{"missing subcommand", "latewarp", "one of " + subcommand_list()};
    if (help_name == "latewarp" && arguments.front().rfind('-', 0) != 0) {
        return Error{"unknown subcommand", arguments.front(), "one of " + subcommand_list()};
    }
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const UsageError& error) {
        return error.error;
    } catch (const CLI::Success& help_or_version) {
        std::ostringstream text;
        (void)app.exit(help_or_version, text, text);
        command_line.text = text.str();
        return command_line;
    } catch (const CLI::ParseError& error) {
        return worded(error, help_name);
    }
    return command_line;
}

}  // namespace

Camera Options::camera() const {
    const double aspect = static_cast<double>(size_px.x) / size_px.y;
    return {{}, FovTangents::symmetric(fov_deg * kRadPerDeg, aspect), near_m, size_px};
}

Result<CommandLine> parse_command_line(const std::vector<std::string>& arguments) {
    Result<CommandLine> command_line = parse(arguments);
    if (!command_line || command_line->text) return command_line;
    Options& options = command_line->options;
    if (options.method.empty()) options.method = default_method(options.subcommand);
    if (options.fill.empty()) options.fill = is_live(options) ? "nearest-background" : "pyramid";
    // A single frame tells nothing of the head's motion, and plain `warp` of its folder is to show the plain view.
    if (options.subcommand == Subcommand::render && !options.source.guard_band_rad) options.source.guard_band_rad = 0.0;
    if (options.shells.on && !options.layers_given) options.source.layers = 2;
    seed_the_scene(options);
    const Status together = check_together(options);
    if (!together) return together.error();
    return command_line;
}

std::string_view name_of(Subcommand subcommand) {
    for (const SubcommandEntry& entry : kSubcommands) {
        if (entry.subcommand == subcommand) return entry.name;
    }
    return "latewarp";
}

bool is_fresh_baseline(std::string_view label) { return label == "fresh" || label == "fresh-same"; }

}  // namespace lw
