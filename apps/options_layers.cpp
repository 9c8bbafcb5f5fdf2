// --layers: what a frame of the client consists of.

#include "apps/option_declarer.h"
#include "apps/option_groups.h"

namespace lw {

using namespace option_values;

void declare_layers(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--layers", "N",
                  "2: a second layer holds what the head may look at behind the first (1; with shells 2)",
                  [&options](const std::string& text) {
                      check_name("number of layers", "--layers", text, {"1", "2"});
                      options.source.layers = static_cast<int>(*parsed_number(text));
                      options.layers_given = true;
                  });
}

void declare_shells(Declarer& declare) {
    Options& options = declare.options();
    ShellSettings& shells = options.shells;
    declare.value("--shells", "auto|N|off",
                  "scene in 2 to 4 shells, drawn again only when they have become wrong (off)",
                  [&shells](const std::string& text) {
                      check_name("number of shells", "--shells", text, {"off", "auto", "2", "3", "4"});
                      shells.on = text != "off";
                      shells.shells = shells.on && text != "auto" ? static_cast<int>(*parsed_number(text)) : 0;
                  });
    declare.value("--shell-samples", "N",
                  "NxN samples per pixel of the outer shells, where the budget allows: 1, 2 or 4 (2)",
                  [&shells](const std::string& text) {
                      check_name("number of samples", "--shell-samples", text, {"1", "2", "4"});
                      shells.samples_per_axis = static_cast<int>(*parsed_number(text));
                  });
    declare.number("--shell-density", "D", {1.0, 2.0}, shells.density,
                   "pixels of the outer shells per display pixel and axis at the centre (1.5)");
    declare.value("--app-budget", "auto|MS", "shells: time to draw in per frame; auto: as one main view takes (auto)",
                  [&shells](const std::string& text) {
                      shells.budget_ms.reset();
                      if (text != "auto") shells.budget_ms = number_in("--app-budget", text, {0, 10000});
                  });
    declare.number("--max-age", "S", {0.01, 3600}, shells.max_age_s,
                   "shells: what has been wrong in view for longer goes first (4)");
    declare.repeated(
        "--shell-without", "PART", "leave out feedback, human-factors or parallax, to see what it is worth",
        [&shells](const std::string& text) {
            check_name("part of the schedule", "--shell-without", text, {"feedback", "human-factors", "parallax"});
            if (text == "feedback") shells.hole_feedback = false;
            if (text == "human-factors") shells.weights.human_factors = false;
            if (text == "parallax") shells.weights.parallax = 0.0;
        });
}

}  // namespace lw
