#pragma once
/// The one place where a frame changes threads.
///
/// Roles: exactly one producer thread calls publish(), exactly one consumer thread calls latest(). Latest wins: a frame
/// the consumer never asked for is dropped. Both calls are wait-free (one atomic exchange of a slot number), so the
/// server is never delayed by the client, and a frame is never seen half-written.
///
/// Ownership: three slots, one with the producer, one with the consumer, one between them. Publishing puts the new
/// frame in the producer's slot and swaps it with the middle one; what comes back is an older frame, and the producer
/// drops it there: last references, and with them pixel buffers and textures, die on the client's thread. The consumer
/// is handed a plain pointer, never a shared one, so it cannot end up with a last reference; it must not copy the
/// frame's `layers` pointers out for longer than the frame lives. At most three frames are alive in here: the one the
/// consumer shows, the newest, and between two publications one that the consumer has given back.
///
/// The end: when the producer stops publishing, the consumer goes on showing the newest frame. To end, first the
/// consumer stops calling latest() (its thread is joined, or has told the producer so with release and acquire), then
/// the producer calls drop_all() on its own thread, with its GL context current if the frames are textures; after that
/// the exchange may be destroyed anywhere. Destroyed earlier, it drops what it holds on the destroying thread, which is
/// only right for CPU frames.
///
/// Fences: the consumer takes CPU frames as they are; texture frames carry a `rendered` fence per layer, which the
/// consumer polls. Nothing in this class waits for a fence.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "frame_link/rendered_frame.h"

namespace lw {

class FrameExchange {
public:
    FrameExchange() = default;
    FrameExchange(const FrameExchange&) = delete;
    FrameExchange& operator=(const FrameExchange&) = delete;

    /// Producer only. `frame` is not null. Wait-free but for destroying the frame that fell out.
    void publish(std::shared_ptr<const RenderedFrame> frame);

    /// Consumer only. The newest published frame, or null before the first one. Wait-free. The frame stays valid until
    /// the consumer's next call.
    [[nodiscard]] const RenderedFrame* latest();

    /// Producer only, once the consumer has stopped for good (see "The end" above). Drops every frame held here, on
    /// the calling thread; pointers handed out by latest() die with them.
    void drop_all();

    /// Any thread: frames published so far, and frames the consumer took.
    [[nodiscard]] std::uint64_t published_count() const { return published_count_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t taken_count() const { return taken_count_.load(std::memory_order_relaxed); }

private:
    static constexpr std::uint8_t kSlotMask = 3;
    static constexpr std::uint8_t kFresh = 4;  ///< set while the middle slot holds a frame the consumer has not seen

    std::array<std::shared_ptr<const RenderedFrame>, 3> slots_;
    std::atomic<std::uint8_t> middle_{1};
    std::uint8_t producer_slot_ = 0;
    std::uint8_t consumer_slot_ = 2;
    std::atomic<std::uint64_t> published_count_{0};
    std::atomic<std::uint64_t> taken_count_{0};
};

}  // namespace lw
