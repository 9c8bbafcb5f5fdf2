// --app-hz, --display-hz, --predict, --lead and what else says when things happen.

#include "apps/option_declarer.h"
#include "apps/option_groups.h"
#include "apps/option_values.h"
#include "frame_link/prediction.h"

namespace lw {

using namespace option_values;

void declare_timing(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--source-pose", "predicted|sampled", "head pose the client draws for (predicted)",
                  [&options](const std::string& text) {
                      check_name("source pose", "--source-pose", text, {"predicted", "sampled"});
                      options.source_pose = text == "sampled" ? SourcePose::sampled : SourcePose::predicted;
                  });
    declare.number("--app-hz", "HZ", {0.1, 1000}, options.app_hz,
                   "rate of the client (10 in replay; live as fast as it can)");
    declare.number("--display-hz", "HZ", {1, 1000}, options.display_hz, "rate of the display (90)");
    declare.value("--predict", "PREDICTOR", "head pose prediction of the server (oracle in replay)",
                  [&options](const std::string& text) {
                      check_name("predictor", "--predict", text, predictor_names());
                      options.predict = text;
                  });
    declare.number("--tracker-hz", "HZ", {1, 10000}, options.tracker_hz, "rate of the head tracker (1000)");
    declare.value("--lead", "MS", "latch this long before scan-out (5 in replay; live learns it)",
                  [&options](const std::string& text) {
                      options.lead_ms = number_in("--lead", text, {0, 1000});
                      options.lead_given = true;
                  });
    declare.number("--app-latency", "MS", {0, 10000}, options.app_latency_ms,
                   "replay: from sampling to publishing (one client period)");
    declare.number("--seconds", "S", {1e-3, 3600}, options.seconds, "length of the run (10)");
}

void declare_strips_and_load(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--strips", "auto|N",
                  "warp each picture in N strips, each just before it is scanned out; auto: 2 where that helps",
                  [&options](const std::string& text) {
                      options.strips.reset();
                      if (text != "auto") options.strips = static_cast<int>(number_in("--strips", text, {1, 64, true}));
                  });
    declare.value("--load", "triangles=N,stall=MS", "make the client slower: more to draw, a wait in every frame",
                  [&options](const std::string& text) {
                      parse_named_numbers("--load", text, {"triangles", "stall"}, {0, 1e9}, true,
                                          [&](std::string_view name, double number) {
                                              (name == "stall" ? options.load.stall_ms : options.load.triangles) =
                                                  number;
                                          });
                  });
}

void declare_inject(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--inject", "tracker=MS,app=MS,present=MS",
                  "delays for the harness to find again, by turns in one run", [&options](const std::string& text) {
                      parse_named_numbers("--inject", text, {"tracker", "app", "present"}, {0, 200}, true,
                                          [&](std::string_view name, double ms) {
                                              if (name == "tracker") options.inject.tracker_ms = ms;
                                              if (name == "app") options.inject.app_ms = ms;
                                              if (name == "present") options.inject.present_ms = ms;
                                          });
                  });
}

}  // namespace lw
