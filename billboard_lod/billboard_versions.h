#pragma once
/// The drawn versions of billboards, and the slots that they lie in.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "billboard_lod/atlas_layout.h"
#include "billboard_lod/update_criteria.h"

namespace lw {

/// A drawn billboard in its slot.
struct BillboardVersion {
    AtlasSlot slot;
    DrawnBillboard drawn;
    glm::dmat4 object_from_eye_drawn{1.0};
    glm::dvec3 horizontal_world{1.0, 0.0, 0.0};  ///< of the picture it was drawn for
    glm::dvec3 to_centre_world{0.0};             ///< from the eye that drew it
};

/// What a frame shows of an object.
struct BillboardLook {
    std::optional<BillboardVersion> current;
    std::optional<BillboardVersion> previous;  ///< while it fades out
    float fade = 1.0f;                         ///< 0: only `previous` shows, 1: only `current`
};

/// What is kept of an object's billboard.
struct BillboardVersions {
    std::optional<BillboardVersion> current;
    std::optional<BillboardVersion> previous;  ///< while it fades out
    BillboardLook before;                      ///< of the last frame, where replaced versions are kept
    int fade = 0;                              ///< frames since `current` was drawn
    std::uint64_t last_shown = 0;              ///< number of the last frame that showed `current`

    /// What is shown while a new version takes `fade_frames` frames to come in.
    [[nodiscard]] BillboardLook look(int fade_frames) const;
};

/// Gives slots to versions. One thread at a time.
class VersionSlots {
public:
    /// `keep_replaced`: slots that a frame gives up are free only after begin_frame() of the next.
    VersionSlots(const AtlasLayouts& layouts, bool keep_replaced) : slots_{layouts}, keep_replaced_{keep_replaced} {}

    /// `versions` may be pushed out by others. It outlives this.
    void add(BillboardVersions& versions) { all_.push_back(&versions); }

    void begin_frame();

    /// A slot of the wanted level where one is free or what nobody looked at for a frame gives way, the longest unseen
    /// first; else of another size; nothing when all are taken. `frame` is the number of this one.
    [[nodiscard]] std::optional<AtlasSlot> reserve(std::size_t level, std::uint64_t frame);

    /// Slots of one version, of the fading one, of all of an object.
    void release(AtlasSlot slot);
    void end_fade(BillboardVersions& versions);
    void forget(BillboardVersions& versions);

private:
    [[nodiscard]] bool evict(std::size_t level, std::uint64_t frame);

    SlotTable slots_;
    bool keep_replaced_;
    std::vector<BillboardVersions*> all_;
    std::vector<AtlasSlot> retired_;  ///< that the last frame showed and this one does not
};

}  // namespace lw
