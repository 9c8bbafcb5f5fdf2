#include "billboard_lod/billboard_versions.h"

namespace lw {

BillboardLook BillboardVersions::look(int fade_frames) const {
    if (!previous) return {current, std::nullopt, 1.0f};
    return {current, previous, static_cast<float>(fade) / static_cast<float>(fade_frames + 1)};
}

void VersionSlots::begin_frame() {
    for (const AtlasSlot slot : retired_) slots_.release(slot);
    retired_.clear();
}

std::optional<AtlasSlot> VersionSlots::reserve(std::size_t level, std::uint64_t frame) {
    std::optional<AtlasSlot> slot = slots_.reserve(level);
    if (slot && slot->level == level) return slot;
    // A billboard that nobody looks at gives way before another size is taken.
    if (!evict(level, frame)) return slot;
    if (slot) slots_.release(*slot);
    return slots_.reserve(level);
}

bool VersionSlots::evict(std::size_t level, std::uint64_t frame) {
    BillboardVersions* oldest = nullptr;
    for (BillboardVersions* versions : all_) {
        if (!versions->current || versions->current->slot.level != level || versions->last_shown + 1 >= frame) continue;
        if (oldest == nullptr || versions->last_shown < oldest->last_shown) oldest = versions;
    }
    if (oldest == nullptr) return false;
    forget(*oldest);
    return true;
}

void VersionSlots::release(AtlasSlot slot) {
    if (keep_replaced_) {
        retired_.push_back(slot);
    } else {
        slots_.release(slot);
    }
}

void VersionSlots::end_fade(BillboardVersions& versions) {
    if (versions.previous) release(versions.previous->slot);
    versions.previous.reset();
}

void VersionSlots::forget(BillboardVersions& versions) {
    end_fade(versions);
    if (versions.current) release(versions.current->slot);
    versions.current.reset();
}

}  // namespace lw
