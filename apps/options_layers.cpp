// --layers: what a frame of the client consists of.

#include "apps/option_declarer.h"
#include "apps/option_groups.h"

namespace lw {

using namespace option_values;

void declare_layers(Declarer& declare) {
    Options& options = declare.options();
    declare.value("--layers", "N", "2: a second layer holds what the head may look at behind the first (1)",
                  [&options](const std::string& text) {
                      check_name("number of layers", "--layers", text, {"1", "2"});
                      options.source.layers = static_cast<int>(*parsed_number(text));
                  });
}

}  // namespace lw
