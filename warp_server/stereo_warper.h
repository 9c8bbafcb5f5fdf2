#pragma once
/// The picture of a refresh for two eyes: one rendered frame and one head pose, warped once per eye.

#include <array>
#include <atomic>
#include <memory>
#include <string_view>

#include "core/result.h"
#include "core/stereo_rig.h"
#include "core/task_pool.h"
#include "frame_link/drawn_view.h"
#include "warp_server/eye_layout.h"
#include "warp_server/frame_warper.h"

namespace lw {

struct StereoSettings {
    StereoRig rig;
    EyeLayout layout = EyeLayout::side_by_side;
    /// On two threads: half of both eyes each where the method has steps, else an eye each. Not for GL methods, whose
    /// context has one thread.
    bool parallel = false;
};

/// Both eyes always come from the same frame, the same head pose and the same placements: warp() gets each of them
/// once. What methods prepared for a layer serves both eyes, and both draw each region of it in turn where the method
/// has steps. Not movable once threads run: it is handed out by pointer.
class StereoWarper final : public PictureMaker {
public:
    /// Warpers of the same method, left and right.
    StereoWarper(FrameWarper left, FrameWarper right, const StereoSettings& settings);
    ~StereoWarper() override;

    /// From specifications as FrameWarper's. In scanline mode `method` is not used: the right eye sees the newest frame
    /// as it is, the left one its rows shifted.
    /// @param display  size and near plane of an eye's picture
    [[nodiscard]] static Result<std::unique_ptr<StereoWarper>> create(std::string_view method, std::string_view fill,
                                                                      StereoMode mode, const Camera& display,
                                                                      const StereoSettings& settings);

    void prepare(Layer& layer) const override;

    /// `target.camera` is the head's: its pose, and each eye's size and near plane. Returns both pictures packed, with
    /// colours only. Server thread.
    const DisplayFrame& warp(const RenderedFrame& frame, const WarpTarget& target) override;

    /// warp() without packing: what eye() returns afterwards.
    void warp_eyes(const RenderedFrame& frame, const WarpTarget& target);
    [[nodiscard]] const FrameWarper& eye(Eye eye) const { return warpers_[static_cast<std::size_t>(eye)]; }

    [[nodiscard]] const StereoRig& rig() const { return settings_.rig; }
    [[nodiscard]] const WarpCounters& counters() const override { return counters_; }
    [[nodiscard]] const HeldInput& held() const override { return held_; }
    [[nodiscard]] const DisplayFrame& display_frame() const override { return packed_; }
    [[nodiscard]] DisplayFrame& display_frame_to_write_over() override { return packed_; }

    void report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const override;

    /// Any thread: how the next pictures are packed. Layouts of another size than the display's are for presenters that
    /// take any size.
    void set_layout(EyeLayout layout) { layout_.store(layout, std::memory_order_relaxed); }

private:
    void warp_eye(Eye eye);
    void warp_in_turns();
    void step_band(int band);
    void run(int tasks, const TaskPool::Work& work);
    [[nodiscard]] WarpTarget target_of(Eye eye) const;

    StereoSettings settings_;
    std::atomic<EyeLayout> layout_;
    std::array<FrameWarper, 2> warpers_;
    std::unique_ptr<TaskPool> pool_;  ///< null: one eye after the other
    DisplayFrame packed_;
    WarpCounters counters_;
    HeldInput held_;

    // Of the warp under way, for the threads of the pool.
    const RenderedFrame* frame_ = nullptr;
    const WarpTarget* head_ = nullptr;
    TaskPool::Work warp_eye_ = [this](int index, int /*worker*/) { warp_eye(static_cast<Eye>(index)); };
    TaskPool::Work step_band_ = [this](int band, int /*worker*/) { step_band(band); };
    TaskPool::Work finish_eye_ = [this](int index, int /*worker*/) {
        warpers_[static_cast<std::size_t>(index)].finish_steps();
    };
};

}  // namespace lw
