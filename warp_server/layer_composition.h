#pragma once
/// Second and further layers of a frame, put behind and before what is already shown.

#include <optional>

#include "warp_server/layer_reach.h"
#include "warp_server/warp_method.h"

namespace lw {

/// What the view covers of a row of the target: the columns [first, end), of which so many show nothing.
struct ViewedRow {
    int first = 0;
    int end = 0;
    std::size_t holes = 0;
};

/// Keeps scratch memory. Server thread.
class LayerComposition {
public:
    /// Warps all layers of a frame into one picture. The first is the view; the others come nearest shell first. Of two
    /// surfaces at nearly the same depth that of the layer before is seen, which is the newer one.
    ///
    /// Layers of the nearest shell beside its view stand in for it past its edges: where the view covers the target
    /// they only fill holes, since they are older.
    ///
    /// A method that can, draws all layers into one picture, and what is hidden costs next to nothing; the others warp
    /// layer by layer. So do all for false colours, which say what layer a pixel is of.
    /// @param layers  at least one, all for the eye that looks
    /// @return what was left out of all layers that were warped
    WarpCounters show(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                      DisplayFrame& into);

    /// show() in steps, for a method that has them. After begin_steps() the method's bands are stepped until nothing is
    /// left, then next_stage() called, and both again as long as it returns true. `layers` and `target.movers` outlive
    /// all of it.
    void begin_steps(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target, int bands,
                     DisplayFrame& into);
    [[nodiscard]] bool next_stage();
    /// What was left out, after the last stage.
    [[nodiscard]] const WarpCounters& step_counters() const { return steps_.counters; }

    /// One layer more: warps `layer` and shows it in `into` where nothing is shown yet or where it is nearer. Only the
    /// part of the target is warped that the layer can reach and where something is missing.
    /// @param view  the frame's first layer
    /// @return what was left out of it; nothing when the layer has nothing to show in this frame, and was not warped
    std::optional<WarpCounters> add(WarpMethod& method, const Layer& layer, const Layer& view, const WarpTarget& target,
                                    DisplayFrame& into);

    /// Mixes every layer's colours with its shell's from now on.
    void set_false_colours(bool on) { false_colours_ = on; }
    [[nodiscard]] bool false_colours() const { return false_colours_; }
    /// Mixes a picture that is not composed, of a first layer.
    void tint(const Layer& layer, DisplayFrame& frame) const;

private:
    WarpCounters warp_into_scratch(WarpMethod& method, const Layer& layer, const WarpTarget& target);
    void find_sides(std::span<const Layer* const> layers);
    [[nodiscard]] const ViewCover& cover_of(const Layer& view, const Camera& target);
    WarpCounters show_found(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                            DisplayFrame& into);
    void show_stack(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                    DisplayFrame& into, WarpCounters& counters);
    [[nodiscard]] std::size_t look_where_view_looks(const Layer& view, const Camera& target, const DepthImage& shown);
    void hold_what_the_view_shows(float farthest, DisplayFrame& into);

    // The picture that is drawn in steps.
    struct Steps {
        WarpMethod* method = nullptr;
        const Layer* view = nullptr;
        WarpTarget target;
        int bands = 1;
        DisplayFrame* into = nullptr;
        WarpCounters counters;
        bool is_last = false;
    };

    void stack_all(std::span<const Layer* const> layers, const WarpTarget& target);
    [[nodiscard]] bool begin_beside_view(const Layer& view, const WarpTarget& target, DisplayFrame& into);
    void finish_beside_view(DisplayFrame& into) const;
    [[nodiscard]] WarpCounters counters_of_stack(const WarpMethod& method) const;

    Steps steps_;
    DisplayFrame scratch_;
    std::vector<StackedLayer> stack_;
    std::vector<const Layer*> beside_view_;
    std::vector<const Layer*> sides_;  ///< of the view, beside the first layer
    ViewCover cover_;
    std::vector<ViewedRow> viewed_rows_;
    DepthImage shown_depth_;  ///< of a picture whose pixels are held
    bool false_colours_ = false;
};

}  // namespace lw
