#include "frame_link/frame_exchange.h"

#include <utility>

#include "core/check.h"

namespace lw {

static_assert(std::atomic<std::uint8_t>::is_always_lock_free && std::atomic<std::uint64_t>::is_always_lock_free);

// acq_rel on both sides: release hands over what was written to the slot that goes in (by the consumer: that it is done
// reading), acquire takes over what the other side did to the slot that comes out.
void FrameExchange::publish(std::shared_ptr<const RenderedFrame> frame) {
    LW_CHECK(frame != nullptr, "a published frame is not null");
    slots_[producer_slot_] = std::move(frame);
    const auto given = static_cast<std::uint8_t>(producer_slot_ | kFresh);
    producer_slot_ = middle_.exchange(given, std::memory_order_acq_rel) & kSlotMask;
    published_count_.fetch_add(1, std::memory_order_relaxed);
    slots_[producer_slot_].reset();
}

const RenderedFrame* FrameExchange::latest() {
    // Only this thread clears the flag, so a slot seen fresh is still fresh (perhaps newer) at the exchange.
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
        consumer_slot_ = middle_.exchange(consumer_slot_, std::memory_order_acq_rel) & kSlotMask;
        taken_count_.fetch_add(1, std::memory_order_relaxed);
    }
    return slots_[consumer_slot_].get();
}

void FrameExchange::drop_all() {
    for (auto& slot : slots_) slot.reset();
    middle_.store(middle_.load(std::memory_order_acquire) & kSlotMask, std::memory_order_release);
}

}  // namespace lw
