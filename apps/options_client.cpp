// --source-*, --guard-band, --no-skip and what else says how the client draws.

#include <algorithm>

#include "apps/option_declarer.h"
#include "apps/option_groups.h"
#include "apps/option_values.h"

namespace lw {

using namespace option_values;

void declare_source(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--source-samples", "N", "NxN samples per pixel of the client's frame: 1, 2 or 4 (1)",
                  [&options](const std::string& text) {
                      check_name("number of samples", "--source-samples", text, {"1", "2", "4"});
                      options.source.samples_per_axis = static_cast<int>(*parsed_number(text));
                  });
    declare.value("--source-density", "D", "pixels of the client's frame per pixel shown: 1, 1.5 or 2 (1)",
                  [&options](const std::string& text) {
                      check_name("density", "--source-density", text, {"1", "1.5", "2"});
                      options.source.density = *parsed_number(text);
                  });
}

void declare_guard_band(Declarer& declare, bool auto_allowed) {
    Options& options = declare.options();
    const auto degrees = [&options](const std::string& text) {
        options.source.guard_band_rad = number_in("--guard-band", text, {0, 45}) * kRadPerDeg;
    };
    if (auto_allowed) {
        declare.value("--guard-band", "auto|DEG",
                      "view drawn around the client's frame, per side; auto: as the head turns (auto)",
                      [&options, degrees](const std::string& text) {
                          options.source.guard_band_rad.reset();
                          if (text != "auto") degrees(text);
                      });
        return;
    }
    declare.value("--guard-band", "DEG", "view around the frame of --frame, per side (0)", degrees);
}

void declare_skip(Declarer& declare) {
    Options& options = declare.options();
    declare.app().add_flag_callback(
        "--no-skip", [&options] { options.culling.skip = false; }, "draw everything, whether it is needed or not");
    declare.value("--min-pixels", "N", "leave out what looks smaller than this while the viewer moves (0: nothing)",
                  [&options](const std::string& text) {
                      options.culling.min_pixels = number_in("--min-pixels", text, {0, 1000});
                  });
    declare.value("--cull-threads", "N",
                  "threads that decide what is drawn, 1 to 4 (2, where the machine has as many cores)",
                  [&options](const std::string& text) {
                      check_name("number of threads", "--cull-threads", text, {"1", "2", "3", "4"});
                      options.culling.threads = static_cast<int>(*parsed_number(text));
                  });
    declare.value("--draw-order", "ORDER",
                  "grouped: by distance zone and state; or by distance through a buffer: none, lru, bounded-waste, "
                  "random, round-robin (grouped)",
                  [&options](const std::string& text) {
                      static const std::vector<std::string_view> names{"none",   "lru",         "bounded-waste",
                                                                       "random", "round-robin", "grouped"};
                      options.draw_order.grouped = text == "grouped";
                      if (options.draw_order.grouped) return;
                      check_name("draw order", "--draw-order", text, names);
                      const auto place = std::ranges::find(names, text) - names.begin();
                      options.draw_order.strategy = static_cast<SortingStrategy>(place);
                  });
    declare.value("--sorting-buffer", "N", "draws that the buffer of --draw-order holds (32)",
                  [&options](const std::string& text) {
                      options.draw_order.capacity =
                          static_cast<std::size_t>(number_in("--sorting-buffer", text, {1, 4096, true}));
                  });
    declare.value("--reveal-margin", "auto|M",
                  "hidden objects must be so for eyes this far; auto: as the head moves (auto)",
                  [&options](const std::string& text) {
                      options.reveal_margin_m.reset();
                      if (text != "auto") options.reveal_margin_m = number_in("--reveal-margin", text, {0, 100});
                      options.culling.reveal_margin_m = options.reveal_margin_m.value_or(0.0);
                  });
}

}  // namespace lw
