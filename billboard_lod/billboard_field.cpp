#include "billboard_lod/billboard_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "billboard_lod/billboard_versions.h"
#include "billboard_lod/billboard_view.h"
#include "billboard_lod/bounded_queue.h"
#include "billboard_lod/object_groups.h"
#include "billboard_lod/object_score.h"
#include "billboard_lod/outline_points.h"
#include "billboard_lod/update_cost.h"
#include "core/check.h"

namespace lw {

namespace {

enum class Shown : std::uint8_t { nothing, mesh, billboard };

struct Entry {
    BillboardObject object;
    std::vector<glm::dvec3> outline;  ///< outline_points() of its instances, in the space of its bounds
    std::uint64_t triangles = 0;
    BillboardVersions versions;
    Shown shown = Shown::nothing;
    ProjectedBounds bounds;
    glm::dmat4 world_from_object{1.0};
};

glm::dvec3 right_of(const Camera& camera) { return camera.world_from_eye.orientation * glm::dvec3{1.0, 0.0, 0.0}; }

constexpr float kReplacesNearer = 0.002f;  ///< share of the depth; 0.0007 and 0.005 flicker more
/// What still fades in would jump if it was drawn anew; it may be off by so many times the cap.
constexpr double kDueWhileFading = 2.0;

bool finite(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) return false;
        }
    }
    return true;
}

class Field final : public BillboardField {
public:
    Field(const scene::Scene& scene, ObjectPainter& painter, const BillboardSettings& settings,
          const Clock* stage_clock, BillboardAtlas atlas, BillboardPass pass)
        : scene_{scene},
          painter_{painter},
          settings_{settings},
          stage_clock_{stage_clock},
          atlas_{std::move(atlas)},
          pass_{std::move(pass)},
          slots_{atlas_.layouts(), settings.keep_replaced},
          creations_{static_cast<std::size_t>(std::max(settings.max_creations, 0))},
          updates_{static_cast<std::size_t>(std::max(settings.max_updates, 0))},
          mesh_distance_m_{mesh_distance_m(scene.bounds_world, settings.mesh_distance_share)},
          replaced_(scene.instances.size(), 0) {
        scene::SceneState state{scene};
        state.set_time(0.0);
        std::vector<bool> eligible(scene.instances.size());
        for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
            eligible[i] = painter.triangles_of(i) >= std::max<std::uint64_t>(settings.min_triangles, 1);
        }
        for (BillboardObject& object : billboard_objects(scene, state, eligible, settings.group_touching)) {
            Entry entry;
            for (const std::uint32_t instance : object.instances) entry.triangles += painter.triangles_of(instance);
            entry.outline = outline_of(object, state);
            entry.object = std::move(object);
            entries_.push_back(std::move(entry));
        }
        for (Entry& entry : entries_) slots_.add(entry.versions);
    }

    void prepare(const Camera& camera, const scene::SceneState& state) override {
        if (settings_.keep_replaced) remember();
        slots_.begin_frame();
        ++frame_;
        counters_ = {};
        std::ranges::fill(replaced_, std::uint8_t{0});
        camera_ = camera;
        eye_from_world_ = inverse_matrix_of(camera.world_from_eye);
        foresee();
        begin_stage();
        classify(state);
        counters_.choose_ms = end_stage();
        create_new();
        update_due();
        finish();
    }

    [[nodiscard]] std::span<const std::uint8_t> replaced() const override { return replaced_; }

    void draw(const Camera& part) override {
        quads_.clear();
        fading_.clear();
        for (const Entry& entry : entries_) {
            if (entry.shown != Shown::billboard) continue;
            const BillboardVersions& versions = entry.versions;
            append(entry,
                   withholds_ && versions.before.current ? versions.before : versions.look(settings_.fade_frames),
                   part);
        }
        pass_.draw(quads_, atlas_, part);
    }

    [[nodiscard]] bool fades() const override { return !fading_.empty(); }

    void draw_fading(const Camera& part) override { pass_.draw_lit(fading_, atlas_, part); }

    void withhold_updates(bool withhold) override {
        LW_CHECK(!withhold || settings_.keep_replaced, "nothing was kept of the last frame");
        withholds_ = withhold;
    }

    [[nodiscard]] const BillboardCounters& counters() const override { return counters_; }
    [[nodiscard]] std::array<std::size_t, kBillboardDimensions.size()> bytes() const override {
        std::array<std::size_t, kBillboardDimensions.size()> all{};
        for (std::size_t level = 0; level < all.size(); ++level) all[level] = atlas_.bytes(level);
        return all;
    }
    [[nodiscard]] const BillboardSettings& settings() const override { return settings_; }

private:
    /// Before a frame: what the last one shows.
    void remember() {
        for (Entry& entry : entries_) {
            entry.versions.before =
                entry.shown == Shown::billboard ? entry.versions.look(settings_.fade_frames) : BillboardLook{};
        }
    }

    /// Where the eye will be at the next frame if it goes on as since the last.
    void foresee() {
        const Pose& now = camera_.world_from_eye;
        const Pose next = last_pose_ ? interpolate(*last_pose_, now, 2.0) : now;
        next_eye_from_world_ = inverse_matrix_of(next);
        last_pose_ = now;
    }

    void classify(const scene::SceneState& state) {
        for (std::uint32_t e = 0; e < entries_.size(); ++e) {
            Entry& entry = entries_[e];
            if (!entry.object.group()) {
                entry.world_from_object = state.world_from_object(scene_.instances[entry.object.instances.front()]);
            }
            entry.bounds = projected(entry.object.bounds, eye_from_world_ * entry.world_from_object, camera_);
            entry.shown = Shown::mesh;
            if (!entry.bounds.sound || !finite(glm::inverse(entry.world_from_object))) {
                ++counters_.bad_bounds;
                continue;
            }
            const double score = object_score(entry.bounds, mesh_distance_m_);
            if (score >= 0.0) counters_.triangles_in_view += entry.triangles;
            if (score > 0.0) counters_.triangles_replaceable += entry.triangles;
            if (score < 0.0) {
                entry.shown = Shown::nothing;
                ++counters_.out_of_view;
            } else if (score == 0.0) {
                ++counters_.near_meshes;
            } else if (!entry.versions.current) {
                queue(creations_, score, e);
            } else {
                const double due = update_priority(entry);
                if (due < (entry.versions.previous ? kDueWhileFading : 1.0)) {
                    entry.shown = Shown::billboard;
                } else {
                    queue(updates_, due, e);
                }
            }
        }
    }

    void queue(BoundedQueue<std::uint32_t>& into, double score, std::uint32_t e) {
        if (into.push(score, e)) ++counters_.queue_meshes;
    }

    [[nodiscard]] double update_priority(const Entry& entry) const {
        const BillboardVersion& version = *entry.versions.current;
        if (settings_.criterion == UpdateCriterion::angles) {
            const BillboardPlane plane = plane_of(version.drawn.grid.window(), version.drawn.plane_m);
            const glm::dvec3 centre_world{entry.world_from_object * version.object_from_eye_drawn *
                                          glm::dvec4{plane.centre_eye, 1.0}};
            const glm::dvec3 to_centre = centre_world - camera_.world_from_eye.position_m;
            const UpdateScores scores{view_angle_deg(version.horizontal_world, right_of(camera_)),
                                      lateral_angle_deg(version.to_centre_world, to_centre),
                                      distance_score(version.to_centre_world, to_centre)};
            return scores.weighted(settings_.thresholds);
        }
        const glm::dmat4 world_from_eye_drawn = entry.world_from_object * version.object_from_eye_drawn;
        return std::max(error_px(version, eye_from_world_ * world_from_eye_drawn),
                        error_px(version, next_eye_from_world_ * world_from_eye_drawn)) /
               settings_.error_cap_px;
    }

    [[nodiscard]] double error_px(const BillboardVersion& version, const glm::dmat4& eye_now_from_eye_drawn) const {
        const bool flat = settings_.mode == BillboardMode::flat && settings_.criterion == UpdateCriterion::error;
        return flat ? flat_error_px(version.drawn, eye_now_from_eye_drawn, camera_)
                    : warped_error_px(version.drawn, eye_now_from_eye_drawn, camera_);
    }

    void create_new() {
        creations_.drain(chosen_);
        begin_stage();
        jobs_.clear();
        for (const std::uint32_t e : chosen_) {
            const std::optional<AtlasSlot> slot = slots_.reserve(wanted_level(entries_[e]), frame_);
            if (!slot) {
                ++counters_.atlas_meshes;
                continue;
            }
            entries_[e].versions.current = drawn_now(entries_[e], *slot);
            entries_[e].versions.last_shown = frame_;  // so that the next one does not push it out
            jobs_.push_back(e);
        }
        counters_.created = paint_jobs();
        counters_.create_ms = end_stage();
    }

    void update_due() {
        updates_.drain(chosen_);
        begin_stage();
        jobs_.clear();
        const std::uint64_t painted_before = counters_.triangles_painted;
        double estimated_ms = 0.0;
        for (const std::uint32_t e : chosen_) {
            Entry& entry = entries_[e];
            estimated_ms += cost_.estimated_ms(entry.triangles);
            // The worst ones come first, and one always does, so that nothing waits forever.
            if (settings_.budget_ms > 0.0 && estimated_ms > settings_.budget_ms && !jobs_.empty()) {
                entry.shown = Shown::billboard;
                ++counters_.stale;
                continue;
            }
            renew(entry);
            jobs_.push_back(e);
        }
        counters_.updated = paint_jobs();
        counters_.update_ms = end_stage();
        if (stage_clock_ != nullptr) {
            cost_.observe(counters_.triangles_painted - painted_before, counters_.updated, counters_.update_ms);
        }
    }

    [[nodiscard]] std::vector<glm::dvec3> outline_of(const BillboardObject& object,
                                                     const scene::SceneState& state) const {
        std::vector<glm::dvec3> outline;
        for (const std::uint32_t index : object.instances) {
            const scene::Instance& instance = scene_.instances[index];
            std::vector<glm::dvec3> points = outline_points(scene_.meshes[static_cast<std::size_t>(instance.mesh)]);
            if (!object.group()) return points;
            const glm::dmat4 world_from_object = state.world_from_object(instance);
            for (const glm::dvec3& point : points) outline.emplace_back(world_from_object * glm::dvec4{point, 1.0});
        }
        return outline;
    }

    /// Closer than `bounds`: what is drawn anew covers fewer texels, and quads fewer pixels.
    [[nodiscard]] ProjectedBounds outline_bounds(const Entry& entry) const {
        return projected(entry.outline, eye_from_world_ * entry.world_from_object, camera_);
    }

    [[nodiscard]] std::size_t wanted_level(const Entry& entry) const {
        return covering_dimension(grid_on_pixels(outline_bounds(entry), camera_, settings_.texels_per_px).size);
    }

    /// Gives the entry a version of this frame: in its slot where the size is still right and nothing fades.
    void renew(Entry& entry) {
        const std::size_t level = wanted_level(entry);
        const bool fades = settings_.fade_frames > 0;
        AtlasSlot slot = entry.versions.current->slot;
        slots_.end_fade(entry.versions);
        if (fades || settings_.keep_replaced || slot.level != level) {
            if (const std::optional<AtlasSlot> other = slots_.reserve(level, frame_)) {
                if (fades) {
                    entry.versions.previous = entry.versions.current;
                } else {
                    slots_.release(slot);
                }
                slot = *other;
            }
        }
        entry.versions.fade = 0;
        entry.versions.current = drawn_now(entry, slot);
        entry.versions.last_shown = frame_;
    }

    [[nodiscard]] BillboardVersion drawn_now(const Entry& entry, AtlasSlot slot) const {
        BillboardVersion version;
        version.slot = slot;
        const ProjectedBounds bounds = outline_bounds(entry);
        version.drawn.grid = grid_in_slot(bounds, camera_, settings_.texels_per_px, kBillboardDimensions[slot.level]);
        version.drawn.nearest_m = bounds.nearest_m();
        version.drawn.farthest_m = bounds.farthest_m();
        version.drawn.plane_m = bounds.centre_m();
        const glm::dmat4 world_from_eye = matrix_of(camera_.world_from_eye);
        version.object_from_eye_drawn = glm::inverse(entry.world_from_object) * world_from_eye;
        version.horizontal_world = right_of(camera_);
        const BillboardPlane plane = plane_of(version.drawn.grid.window(), version.drawn.plane_m);
        version.to_centre_world = glm::dmat3{world_from_eye} * plane.centre_eye;
        return version;
    }

    /// Draws the entries of jobs_ into their slots. @return how many were drawn
    std::uint64_t paint_jobs() {
        const auto page_of_job = [&](std::uint32_t e) {
            return page_of(atlas_.layouts(), entries_[e].versions.current->slot);
        };
        std::ranges::stable_sort(jobs_, {}, page_of_job);
        std::uint64_t painted = 0;
        for (std::span<const std::uint32_t> rest{jobs_}; !rest.empty();) {
            const AtlasPage page = page_of_job(rest.front());
            const auto count =
                static_cast<std::size_t>(std::ranges::upper_bound(rest, page, {}, page_of_job) - rest.begin());
            painted += paint_page(page, rest.first(count));
            rest = rest.subspan(count);
        }
        return painted;
    }

    /// `jobs` have their slots on `page`. @return how many were drawn: all or, without memory for the page, none
    std::uint64_t paint_page(AtlasPage page, std::span<const std::uint32_t> jobs) {
        views_.clear();
        cleared_.clear();
        for (const std::uint32_t e : jobs) {
            const BillboardVersion& version = *entries_[e].versions.current;
            cleared_.push_back(version.slot.index);
            PaintedView view = painted_view(version.drawn, atlas_.layouts()[page.level], version.slot.index, camera_);
            for (const std::uint32_t instance : entries_[e].object.instances) {
                view.instance = instance;
                views_.push_back(view);
            }
        }
        const bool bound = atlas_.begin(page, cleared_);
        if (bound) counters_.triangles_painted += painter_.paint(views_, camera_.world_from_eye.position_m);
        settle(jobs, bound);
        return bound ? jobs.size() : 0;
    }

    /// What was to be painted is shown, or was not to be had.
    void settle(std::span<const std::uint32_t> jobs, bool painted) {
        for (const std::uint32_t e : jobs) {
            Entry& entry = entries_[e];
            if (painted) {
                entry.shown = Shown::billboard;
            } else {
                slots_.forget(entry.versions);
                ++counters_.atlas_meshes;
            }
        }
    }

    void finish() {
        for (Entry& entry : entries_) {
            if (entry.shown != Shown::billboard || entry.versions.fade >= settings_.fade_frames) {
                slots_.end_fade(entry.versions);
            }
            if (entry.shown != Shown::billboard) continue;
            if (!quad_of(entry, *entry.versions.current, camera_)) {
                // It crosses the near plane although it is not due: possible only with a cap that nothing reaches.
                entry.shown = Shown::mesh;
                ++counters_.near_meshes;
                continue;
            }
            ++entry.versions.fade;
            entry.versions.last_shown = frame_;
            ++counters_.active;
            ++counters_.active_by_dimension[entry.versions.current->slot.level];
            for (const std::uint32_t instance : entry.object.instances) replaced_[instance] = 1;
        }
    }

    [[nodiscard]] std::optional<shader::BillboardRecord> quad_of(const Entry& entry, const BillboardVersion& version,
                                                                 const Camera& camera) const {
        const glm::dmat4 eye_now_from_eye_drawn =
            inverse_matrix_of(camera.world_from_eye) * entry.world_from_object * version.object_from_eye_drawn;
        const AtlasLayout& layout = atlas_.layouts()[version.slot.level];
        if (settings_.mode == BillboardMode::warped) {
            return warped_record(version.drawn, layout, version.slot.index, eye_now_from_eye_drawn, camera);
        }
        auto record = flat_record(version.drawn, layout, version.slot.index, eye_now_from_eye_drawn, camera);
        if (record && version.drawn.nearest_m > settings_.depthless_beyond_m) leave_out_relief(version.drawn, *record);
        return record;
    }

    /// The new version comes in over the old one, and then the old one goes where the new one does not cover it:
    /// nowhere does what lies behind both shine through.
    void append(const Entry& entry, const BillboardLook& look, const Camera& part) {
        std::optional<DrawnQuad> now = drawn_quad(entry, *look.current, part);
        std::optional<DrawnQuad> before;
        if (look.previous) before = drawn_quad(entry, *look.previous, part);
        if (!now || !before) {
            if (now) quads_.push_back(*now);
            return;
        }
        // By more than two versions of a surface differ, so that the new one is seen.
        now->record.extent.y = 1.0f + kReplacesNearer;
        now->opacity = 2.0f * look.fade;
        before->opacity = 2.0f - 2.0f * look.fade;
        const bool comes_in = now->opacity < 1.0f;
        quads_.push_back(comes_in ? *before : *now);
        quads_.back().opacity = 1.0f;
        fading_.push_back(comes_in ? *now : *before);
    }

    [[nodiscard]] std::optional<DrawnQuad> drawn_quad(const Entry& entry, const BillboardVersion& version,
                                                      const Camera& part) const {
        std::optional<shader::BillboardRecord> record = quad_of(entry, version, part);
        if (!record) return std::nullopt;
        record->object.x = entry.object.id;
        return DrawnQuad{page_of(atlas_.layouts(), version.slot), *record, 1.0f};
    }

    void begin_stage() {
        if (stage_clock_ == nullptr) return;
        glFinish();
        stage_begin_ = stage_clock_->now();
    }
    double end_stage() {
        if (stage_clock_ == nullptr) return 0.0;
        glFinish();
        return to_ms(stage_clock_->now() - stage_begin_);
    }

    const scene::Scene& scene_;
    ObjectPainter& painter_;
    BillboardSettings settings_;
    const Clock* stage_clock_;
    BillboardAtlas atlas_;
    BillboardPass pass_;
    VersionSlots slots_;
    BoundedQueue<std::uint32_t> creations_;
    BoundedQueue<std::uint32_t> updates_;
    double mesh_distance_m_;
    std::vector<std::uint8_t> replaced_;
    std::vector<Entry> entries_;
    BillboardCounters counters_;
    UpdateCost cost_;
    std::uint64_t frame_ = 1;
    bool withholds_ = false;

    Camera camera_;  ///< of the frame
    glm::dmat4 eye_from_world_{1.0};
    glm::dmat4 next_eye_from_world_{1.0};
    std::optional<Pose> last_pose_;
    TimePoint stage_begin_;

    std::vector<std::uint32_t> chosen_;
    std::vector<std::uint32_t> jobs_;
    std::vector<PaintedView> views_;
    std::vector<int> cleared_;
    std::vector<DrawnQuad> quads_;
    std::vector<DrawnQuad> fading_;  ///< of the part drawn last
};

}  // namespace

Result<std::unique_ptr<BillboardField>> BillboardField::create(const scene::Scene& scene, ObjectPainter& painter,
                                                               const BillboardSettings& settings,
                                                               const Clock* stage_clock) {
    auto atlas = BillboardAtlas::create(settings.format, settings.capacities);
    if (!atlas.ok()) return atlas.error();
    BillboardPassSettings pass_settings;
    pass_settings.format = settings.format;
    pass_settings.expansion = settings.expansion;
    pass_settings.warped = settings.mode == BillboardMode::warped;
    pass_settings.blended = pass_settings.warped || settings.blend_flat;
    pass_settings.into_picture = settings.fade_frames > 0;
    pass_settings.point_lights = !scene.point_lights.empty();
    auto pass = BillboardPass::create(pass_settings);
    if (!pass.ok()) return pass.error();
    return std::unique_ptr<BillboardField>{
        std::make_unique<Field>(scene, painter, settings, stage_clock, std::move(*atlas), std::move(*pass))};
}

}  // namespace lw
