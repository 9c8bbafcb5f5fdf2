#include "warp_server/warp_method.h"

#include "core/check.h"

namespace lw {

void WarpMethod::warp_stack(std::span<const StackedLayer> /*layers*/, const WarpTarget& /*target*/, StackBase /*base*/,
                            DisplayFrame& /*out*/) {
    LW_CHECK(false, "a method that warps layers one by one: " + std::string{label()});
}

}  // namespace lw
