#pragma once
/// A display without hardware: refresh n begins to scan out at start + n * period of whatever clock the server uses,
/// the real one live, a virtual one in tests.

#include "warp_server/presenter.h"

namespace lw {

class VirtualDisplay final : public Presenter {
public:
    /// `hz` in [1, 1000]. The pictures' size may change from one to the next.
    VirtualDisplay(TimePoint start, double hz, glm::ivec2 size_px);

    [[nodiscard]] Refresh next_refresh(TimePoint now) const override;

    /// Copies the colour, as handing it to a real display would.
    void present(const DisplayFrame& frame, const Refresh& refresh) override;

    /// The last picture handed over, black before the first.
    [[nodiscard]] const ColourImage& picture() const { return picture_; }
    /// The refresh it was made for; its number is 0 before the first.
    [[nodiscard]] const Refresh& picture_refresh() const { return picture_refresh_; }

private:
    /// When refresh `number` begins; computed from the start, so that no rounding adds up.
    [[nodiscard]] TimePoint scanout_begin(std::uint64_t number) const;

    TimePoint start_;
    double hz_;
    ColourImage picture_;
    Refresh picture_refresh_;
};

}  // namespace lw
