#pragma once
/// A warp that is drawn bit by bit. Two eyes that take turns with the bits of one source find each in the processor's
/// cache.

#include <span>

#include "warp_server/warp_method.h"

namespace lw {

/// What a WarpMethod may be besides. A picture is begin_stack(), step() of every band until it returns false, and
/// finish_stack(); that is the same picture as warp_stack()'s.
class SteppedWarp {
public:
    virtual ~SteppedWarp() = default;

    /// @param bands  parts of the target, by rows, that are drawn apart, >= 1; shared out so that they cost the same
    virtual void begin_stack(std::span<const StackedLayer> layers, const WarpTarget& target, StackBase base, int bands,
                             DisplayFrame& out) = 0;
    /// Draws one region of the source into a band. Each band may have a thread of its own. False: nothing was left.
    virtual bool step(int band) = 0;
    virtual void finish_stack() = 0;
};

}  // namespace lw
