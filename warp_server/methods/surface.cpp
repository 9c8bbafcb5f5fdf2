/// The default: the source is cut into pieces of plane (tiles, and single cells along edges); each piece is laid over
/// the target, where every pixel in it asks for its exact place in the source and reads the colour there.

#include <algorithm>
#include <cmath>

#include "core/colour.h"
#include "warp_server/methods/bilinear.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_cells.h"

namespace lw {
namespace {

// Pieces of one surface overlap by this much of a source pixel, so that rounding leaves no crack between them.
constexpr float kOverlapPx = 0.02F;
// Edge cells must not overlap: a pixel in two of them would count twice.
constexpr float kEdgeOverlapPx = 1e-4F;

// A rectangle of source places relative to a patch's origin.
struct PatchDomain {
    float left;
    float right;
    float top;
    float bottom;
};

class SurfaceMethod final : public WarpMethod {
public:
    explicit SurfaceMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return classify_surfaces(checked_cpu_pixels(layer));
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        pixels_ = &checked_cpu_pixels(layer);
        std::shared_ptr<const PreparedLayer> own;
        const PreparedLayer* prepared = layer.prepared_for(label_);
        if (prepared == nullptr) {
            own = prepare(layer);
            prepared = own.get();
        }
        prepared_ = static_cast<const PreparedSurface*>(prepared);
        matrices_.build(layer, target);
        out.resize(target.camera.size_px);
        count_bad_pixels();
        if (matrices_.all_identity()) {
            copy_source(out);
            return;
        }
        canvas_.begin(out);
        for (int row = 0; row < prepared_->tiles.y; ++row) {
            for (int column = 0; column < prepared_->tiles.x; ++column) draw_tile(column, row);
        }
        canvas_.finish();
    }

private:
    void count_bad_pixels() {
        const std::size_t count = pixels_->depth.pixels().size();
        for (std::size_t i = 0; i < count; ++i) {
            if (matrices_.find(pixels_->object_id.pixels()[i]) == nullptr) {
                ++counters_.unknown_object;
            } else if (!is_usable_depth(pixels_->depth.pixels()[i])) {
                ++counters_.bad_depth;
            }
        }
    }

    // Nothing moves: the source, bit for bit.
    void copy_source(DisplayFrame& out) const {
        const std::size_t count = pixels_->depth.pixels().size();
        for (std::size_t i = 0; i < count; ++i) {
            const float depth = pixels_->depth.pixels()[i];
            const bool usable = is_usable_depth(depth) && matrices_.find(pixels_->object_id.pixels()[i]) != nullptr;
            out.colour.pixels()[i] = pixels_->colour.pixels()[i];
            out.depth.pixels()[i] = depth;
            out.coverage.pixels()[i] = usable ? Coverage::reached : Coverage::hole;
        }
    }

    // Cells at the rim of the image reach half a pixel further, to the image's edge; the last ones half as far.
    [[nodiscard]] PatchDomain domain_of_cells(int x, int y, int columns, int rows, float overlap) const {
        const glm::ivec2 size_px = prepared_->size_px;
        PatchDomain domain{-overlap, static_cast<float>(columns) + overlap, -overlap,
                           static_cast<float>(rows) + overlap};
        if (x == 0) domain.left = -0.5F;
        if (y == 0) domain.top = -0.5F;
        if (x + columns == size_px.x) domain.right = static_cast<float>(columns) - 0.5F;
        if (y + rows == size_px.y) domain.bottom = static_cast<float>(rows) - 0.5F;
        return domain;
    }

    void draw_tile(int column, int row) {
        const SurfaceTile& tile = prepared_->tile_at(column, row);
        const int x0 = column * kTileCells;
        const int y0 = row * kTileCells;
        const int columns = std::min(kTileCells, prepared_->size_px.x - x0);
        const int rows = std::min(kTileCells, prepared_->size_px.y - y0);
        if (tile.kind == TileKind::plane && draw_plane(tile, x0, y0, columns, rows)) return;
        for (int y = y0; y < y0 + rows; ++y) {
            for (int x = x0; x < x0 + columns; ++x) draw_cell(x, y);
        }
    }

    // Target pixels whose centres lie in the box around the projected domain; false when a corner is behind the eye.
    bool target_box(const PatchDomain& domain, glm::ivec2& begin, glm::ivec2& end) const {
        glm::vec2 low{1e9F};
        glm::vec2 high{-1e9F};
        for (const float dx : {domain.left, domain.right}) {
            for (const float dy : {domain.top, domain.bottom}) {
                glm::vec2 corner{};
                if (!patch_.place(dx, dy, corner)) return false;
                low = glm::min(low, corner);
                high = glm::max(high, corner);
            }
        }
        const glm::vec2 size{canvas_.size_px()};
        begin = glm::ivec2{glm::clamp(glm::ceil(low - 0.5F), glm::vec2{0.0F}, size)};
        end = glm::ivec2{glm::clamp(glm::floor(high - 0.5F) + 1.0F, glm::vec2{0.0F}, size)};
        return true;
    }

    // False when it must be drawn cell by cell.
    bool draw_plane(const SurfaceTile& tile, int x0, int y0, int columns, int rows) {
        const PixelMatrix* matrix = matrices_.find(tile.object_id);
        if (matrix == nullptr) return true;
        const SourcePlane plane{static_cast<float>(x0) + 0.5F, static_cast<float>(y0) + 0.5F, tile.depth,
                                tile.gradient_x, tile.gradient_y};
        if (!patch_.set(*matrix, plane)) return false;
        const PatchDomain domain = domain_of_cells(x0, y0, columns, rows, kOverlapPx);
        glm::ivec2 begin{};
        glm::ivec2 end{};
        if (!target_box(domain, begin, end)) return false;
        for (int y = begin.y; y < end.y; ++y) {
            for (int x = begin.x; x < end.x; ++x) draw_opaque_pixel(x, y, domain, plane);
        }
        return true;
    }

    void draw_opaque_pixel(int x, int y, const PatchDomain& domain, const SourcePlane& plane) {
        SurfacePatch::Solution place;
        if (!patch_.solve(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, place)) return;
        const bool inside =
            place.dx >= domain.left && place.dx <= domain.right && place.dy >= domain.top && place.dy <= domain.bottom;
        if (!inside || place.depth > 1.0F || canvas_.shows_nearer(x, y, place.depth)) return;
        const BilinearTap tap =
            bilinear_tap(plane.origin_x_px + place.dx, plane.origin_y_px + place.dy, prepared_->size_px);
        canvas_.put_opaque(x, y, place.depth, sample_bilinear(pixels_->colour, tap));
    }

    void draw_cell(int x, int y) {
        const CornerGroups& groups = corner_groups(prepared_->cell_links.at(x, y));
        for (int i = 0; i < groups.count; ++i) {
            CellSurface surface;
            if (!cell_surface(*pixels_, *prepared_, x, y, groups.corners[static_cast<std::size_t>(i)], surface))
                continue;
            draw_cell_surface(x, y, surface);
        }
    }

    void draw_cell_surface(int x, int y, const CellSurface& surface) {
        const PixelMatrix* matrix = matrices_.find(surface.object_id);
        if (matrix == nullptr || !patch_.set(*matrix, surface.plane)) return;
        const bool is_whole = surface.corners == kAllCorners;
        PatchDomain domain = domain_of_cells(x, y, 1, 1, is_whole ? kOverlapPx : kEdgeOverlapPx);
        domain.left -= 0.5F;  // the plane's origin is the centre of the cell
        domain.right -= 0.5F;
        domain.top -= 0.5F;
        domain.bottom -= 0.5F;
        glm::ivec2 begin{};
        glm::ivec2 end{};
        if (!target_box(domain, begin, end)) return;
        for (int target_y = begin.y; target_y < end.y; ++target_y) {
            for (int target_x = begin.x; target_x < end.x; ++target_x) {
                if (is_whole) {
                    draw_opaque_pixel(target_x, target_y, domain, surface.plane);
                } else {
                    draw_edge_pixel(target_x, target_y, domain, x, y, surface);
                }
            }
        }
    }

    void draw_edge_pixel(int target_x, int target_y, const PatchDomain& domain, int x, int y,
                         const CellSurface& surface) {
        SurfacePatch::Solution place;
        if (!patch_.solve(static_cast<float>(target_x) + 0.5F, static_cast<float>(target_y) + 0.5F, place)) return;
        const bool inside =
            place.dx >= domain.left && place.dx < domain.right && place.dy >= domain.top && place.dy < domain.bottom;
        if (!inside || place.depth > 1.0F || canvas_.shows_nearer(target_x, target_y, place.depth)) return;
        const float u = std::clamp(place.dx + 0.5F, 0.0F, 1.0F);
        const float v = std::clamp(place.dy + 0.5F, 0.0F, 1.0F);
        const float weights[4] = {(1.0F - u) * (1.0F - v), u * (1.0F - v), (1.0F - u) * v, u * v};
        glm::vec3 linear{0.0F};
        float coverage = 0.0F;
        for (int corner = 0; corner < 4; ++corner) {
            if ((surface.corners >> corner & 1) == 0) continue;
            const int corner_x = std::min(x + (corner & 1), prepared_->size_px.x - 1);
            const int corner_y = std::min(y + (corner >> 1), prepared_->size_px.y - 1);
            coverage += weights[corner];
            linear += weights[corner] * linear_of(pixels_->colour.at(corner_x, corner_y));
        }
        if (coverage < kSmallestCoverage) return;
        canvas_.put_fragment(target_x, target_y, std::max(place.depth, 0.0F), coverage, linear / coverage);
    }

    static constexpr float kSmallestCoverage = 1.0F / 512.0F;  // less changes no 8-bit colour

    std::string label_;
    ObjectMatrices matrices_;
    SurfaceCanvas canvas_;
    SurfacePatch patch_;
    const CpuPixels* pixels_ = nullptr;
    const PreparedSurface* prepared_ = nullptr;
};

}  // namespace

MadeMethod make_surface_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<SurfaceMethod>(std::move(label))};
}

}  // namespace lw
