#pragma once
/// A client whose frames consist of shells: the scene in distance ranges around the viewer, each an image or more of
/// its own, drawn again only when it has become wrong (--shells). docs/shells.md explains it with a figure.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_renderer/layer_pool.h"
#include "client_renderer/main_view_cost.h"
#include "client_renderer/scene_renderer.h"
#include "client_renderer/shell_budget.h"
#include "client_renderer/shell_item.h"
#include "client_renderer/shell_moment.h"
#include "client_renderer/shell_priority.h"
#include "client_renderer/shell_ranges.h"
#include "client_renderer/shell_settings.h"
#include "client_renderer/shell_tiles.h"
#include "client_renderer/shell_view.h"
#include "client_renderer/source_camera.h"
#include "client_renderer/tile_savings.h"
#include "frame_link/hole_feedback.h"

namespace lw {

/// One item drawn: a row of the time line.
struct ShellDraw {
    std::uint32_t item = 0;
    std::string name;
    const char* reason = "";
    double error_px = 0.0;  ///< predicted, as weighted
    double cost_ms = 0.0;   ///< measured or modelled
    double age_s = 0.0;     ///< of what it replaces; 0 for a first draw
};

/// What one frame drew.
struct ShellFrameRecord {
    double now_s = 0.0;
    double budget_ms = 0.0;
    double spent_ms = 0.0;
    double all_ms = 0.0;        ///< what drawing every item that exists would cost
    std::uint32_t invalid = 0;  ///< items that were wrong
    std::vector<ShellDraw> draws;
};

/// Belongs to the renderer's thread. Equal calls in equal order give equal frames where costs are modelled.
class ShellClient {
public:
    /// @param display  what is seen at once: of two eyes the view that holds what both see (DrawnView::camera). Its
    ///                 pose is not looked at
    /// @param prepare  runs on every layer before it is first published; may be empty
    ShellClient(SceneRenderer& renderer, const Camera& display, const SourceSettings& source,
                const ShellSettings& settings, std::function<void(const std::shared_ptr<Layer>&)> prepare);

    /// Draws everything there is around `moment`'s middle pose, whatever it costs: what a viewer who has just put the
    /// display on waits for.
    void warm_up(const ShellMoment& moment);

    /// What the server reported since the last call.
    void take(const HoleFeedback& feedback);

    /// Draws what is worth it. The frame's layers, nearest shell first; those that were not drawn are the same objects
    /// as before.
    [[nodiscard]] std::vector<std::shared_ptr<const Layer>> draw(const ShellMoment& moment);

    [[nodiscard]] const std::vector<ShellFrameRecord>& records() const { return records_; }
    [[nodiscard]] std::span<const ShellRange> ranges() const { return ranges_; }
    /// Counters of all draws of the last frame, added up.
    [[nodiscard]] const DrawCounters& counters() const { return counters_; }

private:
    static constexpr std::size_t kView = 0;

    [[nodiscard]] std::size_t item_count() const {
        return 1 + ranges_.size() * static_cast<std::size_t>(tiles_.count());
    }
    /// As it was drawn last; of the view, the newest picture.
    [[nodiscard]] const ShellItem& item(std::size_t item) const;
    [[nodiscard]] ShellItem& tile(std::size_t item);
    [[nodiscard]] std::size_t shell_of(std::size_t item) const;
    [[nodiscard]] int tile_of(std::size_t item) const;
    [[nodiscard]] std::string name_of(std::size_t item) const;
    [[nodiscard]] ScenePart part_of(std::size_t item) const;
    [[nodiscard]] Camera camera_of(std::size_t item, const ShellMoment& moment) const;
    [[nodiscard]] int samples_of(std::size_t item) const;

    void choose_outer_quality(double budget_ms);
    [[nodiscard]] double expected_ms(std::size_t item) const;
    [[nodiscard]] double guessed_cost_ms(std::size_t item) const;

    void set_ranges(std::span<const double> distances_m, const ShellMoment& moment);
    void reconsider_ranges(const ShellMoment& moment);
    [[nodiscard]] double budget_ms(const ShellMoment& moment) const;
    [[nodiscard]] std::vector<double> distances_around(const ShellMoment& moment);

    [[nodiscard]] ItemOutlook outlook(std::size_t item, const ShellMoment& moment) const;
    [[nodiscard]] ItemOutlook outlook_of(const ShellItem& drawn, std::size_t item, const ShellMoment& moment) const;
    void judge_visibility(std::size_t item, const ShellMoment& moment, ItemOutlook& outlook) const;

    double draw_item(std::size_t item, const ShellMoment& moment);
    std::shared_ptr<Layer> draw_layer(std::size_t item, const ShellMoment& moment);
    std::shared_ptr<Layer> draw_hidden(const Layer& first, const ShellMoment& moment);
    /// The view, what it hides, the outer shells, and the nearest shell's tiles last: they fill what is left.
    [[nodiscard]] std::vector<std::shared_ptr<const Layer>> layers() const;

    SceneRenderer& renderer_;
    Camera display_;
    SourceSettings source_;
    ShellSettings settings_;
    std::function<void(const std::shared_ptr<Layer>&)> prepare_;
    ShellTiles tiles_;
    ShellTiles outer_tiles_;  ///< the same tiles as finely as the outer shells have them
    LayerPool pool_;
    std::vector<ShellRange> ranges_;
    glm::dvec3 ranges_from_{0.0};  ///< where the eye was when they were last thought over
    int outer_samples_ = 1;        ///< per axis
    bool outer_dense_ = true;      ///< whether outer tiles are those of outer_tiles_
    ShellView view_;
    std::vector<ShellItem> drawn_tiles_;  ///< by item, without the view
    CostBook costs_;                      ///< of tiles
    TileSavings savings_;
    MainViewCost main_view_;
    DrawCounters counters_;
    std::vector<ShellFrameRecord> records_;
};

}  // namespace lw
