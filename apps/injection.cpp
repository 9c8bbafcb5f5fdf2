#include "apps/injection.h"

#include <deque>

#include "apps/thread_priority.h"

namespace lw {
namespace {

// How often the line looks for frames. It waits for half of this with and without a delay, so that only its trembling
// counts.
constexpr Duration kLook = std::chrono::microseconds{500};

}  // namespace

InjectionPlan::InjectionPlan(const InjectedDelays& delays, TimePoint start) : delays_{delays}, start_{start} {
    if (delays.tracker_ms) turns_.push_back(Injected::tracker);
    if (delays.app_ms) turns_.push_back(Injected::app);
    if (delays.present_ms) turns_.push_back(Injected::present);
}

Injected InjectionPlan::at(TimePoint time) const {
    if (time < start_) return Injected::nothing;
    return turns_[static_cast<std::size_t>((time - start_) / kSegment) % turns_.size()];
}

std::optional<Injected> InjectionPlan::settled_at(TimePoint time) const {
    if (!any()) return Injected::nothing;
    if (time < start_ || (time - start_) % kSegment < kSettling) return std::nullopt;
    return at(time);
}

Duration InjectionPlan::size_of(Injected what) const {
    switch (what) {
        case Injected::tracker:
            return from_ms(delays_.tracker_ms.value_or(0.0));
        case Injected::app:
            return from_ms(delays_.app_ms.value_or(0.0));
        case Injected::present:
            return from_ms(delays_.present_ms.value_or(0.0));
        case Injected::nothing:
            break;
    }
    return Duration::zero();
}

FrameDelayLine::FrameDelayLine(Clock& clock, FrameExchange& in, FrameExchange& out, const InjectionPlan& plan)
    : clock_{clock}, in_{in}, out_{out}, plan_{plan}, thread_{[this] { run(); }} {}

FrameDelayLine::~FrameDelayLine() { stop(); }

void FrameDelayLine::stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void FrameDelayLine::run() {
    name_thread("lw-delay");
    // Not behind the client's GL threads, which would add a delay of their own.
    const bool realtime = take_realtime_priority();
    (void)realtime;  // it is only a little late without
    wake_exactly();
    struct Waiting {
        std::shared_ptr<const RenderedFrame> frame;
        TimePoint due;
    };
    std::deque<Waiting> line;
    std::uint64_t newest = 0;
    while (!stop_) {
        if (const RenderedFrame* frame = in_.latest(); frame != nullptr && frame->index != newest) {
            newest = frame->index;
            const TimePoint published = frame->times.published;
            line.push_back(
                {std::make_shared<RenderedFrame>(*frame), published + plan_.delay(Injected::app, published)});
        }
        const TimePoint now = clock_.now();
        while (!line.empty() && line.front().due <= now) {
            out_.publish(std::move(line.front().frame));
            line.pop_front();
        }
        clock_.sleep_until(now + kLook);
    }
}

}  // namespace lw
