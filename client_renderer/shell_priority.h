#pragma once
/// What makes it urgent to draw a part of the world again: all formulas and weights of the shell schedule are here.
///
///     priority = (missing + parallax + torn + resampled + movers + holes) * visible * attention
///
/// The six terms are display pixels that will be visibly wrong at the next chance to draw the item, each predicted from
/// what is known of the item's picture; `visible` is the share of the item that will be in view, and `attention` says
/// how much a wrong pixel matters there. An item is worth priority / cost (client_renderer/shell_budget.h).
///
/// | term | display pixels |
/// |---|---|
/// | missing | all of them, where the item was never drawn, or for the view: those beyond its picture's edge |
/// | parallax | px * (1 - exp(-gap_px_per_m * eye_moved_m / px)), px all of them: what opens behind the silhouettes of
/// its picture as the eye moves; gaps that grow meet other silhouettes |
/// | torn | all of them * (eye_moved_m / overlap_m - 1), from 0 to 1: the overlap with the next shell is used up |
/// | resampled | all of them * kResampled * eye_moved_m / typical_m: stretched pixels, and shading that depends on the
/// view | | movers | mover_px * kMovers * seconds since drawn: faces of movers that turn into view, what they uncover |
/// | holes | measured_holes_px * kMeasured: what the server could not explain there, mean per display frame |
///
/// Attention is the lecture's (seed 004): a head does not turn round at once, so what is behind it is drawn rarely
/// (p. 6); the periphery is drawn less often (p. 15, 16): k1 = exp(-(angle - b1) / c1) beyond b1 = 15 degrees, since
/// eyes stay within 15 degrees of the head's direction; objects being manipulated come first (p. 6).
/// c1: visual acuity falls with eccentricity e as 1 / (1 + e / 2.3 degrees) (Strasburger, Rentschler and Juettner,
/// "Peripheral vision and pattern recognition", Journal of Vision 11(5):13, 2011, for letter acuity). From 15 to 30
/// degrees that is a factor of 0.54, which exp(-15 / c1) meets at c1 = 24 degrees.

namespace lw {

struct PriorityWeights {
    double resampled = 0.15;       ///< kResampled
    double movers = 0.2;           ///< kMovers, per second
    double measured = 1.0;         ///< kMeasured; 0: without hole feedback
    double parallax = 1.0;         ///< 0: without the parallax term, torn included
    bool human_factors = true;     ///< false: attention is 1 in view, and the same behind the head
    double out_of_view = 0.02;     ///< of an item that is not expected in view
    double view = 4.0;             ///< of the nearest shell where the head looks: what is near is looked at
    double manipulated = 8.0;      ///< of an item that holds an object being manipulated
    double b1_rad = 0.2617993878;  ///< 15 degrees
    double c1_rad = 0.4188790205;  ///< 24 degrees
};

/// What is known of an item when priorities are computed.
struct ItemOutlook {
    bool drawn = false;
    double display_px = 0.0;         ///< that it covers when it is wholly in view
    double visible_share = 0.0;      ///< of it, expected in view until the next chance, 0 to 1
    double off_axis_rad = 0.0;       ///< angle between the head's direction and the item's nearest visible part
    double beyond_edge_share = 0.0;  ///< of the display's pixels, that the view's picture will not cover; 0 for tiles
    double eye_moved_m = 0.0;        ///< from where it was drawn to where the eye is expected at the next chance
    double gap_px_per_m = 0.0;       ///< LayerStatistics, in display pixels
    double overlap_m = 0.0;          ///< ShellRange; 0: the item needs none
    double typical_m = 0.0;          ///< distance of its content, > 0; infinity for sky
    double mover_px = 0.0;           ///< display pixels of movers in it
    double age_s = 0.0;              ///< since it was drawn
    double measured_holes_px = 0.0;  ///< mean per display frame, since it was drawn
    bool manipulated = false;
    bool is_view = false;  ///< the nearest shell where the head looks
};

/// The terms in display pixels, before visibility and attention.
struct PredictedError {
    double missing = 0.0;
    double parallax = 0.0;
    double torn = 0.0;
    double resampled = 0.0;
    double movers = 0.0;
    double holes = 0.0;

    [[nodiscard]] double sum() const { return missing + parallax + torn + resampled + movers + holes; }
    /// Name of the largest term: why an item is drawn. "" when all are zero.
    [[nodiscard]] const char* reason() const;
};

[[nodiscard]] PredictedError predicted_error(const ItemOutlook& item, const PriorityWeights& weights);

/// k1 of the lecture, 1 within b1.
[[nodiscard]] double periphery_falloff(double off_axis_rad, const PriorityWeights& weights);

/// By what the error counts: visibility and attention.
[[nodiscard]] double error_weight(const ItemOutlook& item, const PriorityWeights& weights);

}  // namespace lw
