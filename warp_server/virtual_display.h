#pragma once
/// A display without hardware: refresh n begins to scan out at start + n * period of whatever clock the server uses,
/// the real one live, a virtual one in tests.

#include <memory>

#include "warp_server/photon_watch.h"
#include "warp_server/presenter.h"

namespace lw {

class VirtualDisplay final : public Presenter {
public:
    /// `hz` in [1, 1000]. The pictures' size may change from one to the next.
    VirtualDisplay(TimePoint start, double hz, glm::ivec2 size_px);

    [[nodiscard]] Refresh next_refresh(TimePoint now) const override;

    /// Copies the colour, as handing it to a real display would.
    void present(const DisplayFrame& frame, const Refresh& refresh) override;
    void present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) override;

    /// From now on reads the code of every part that is scanned out, at the times of its own refreshes. `clock` is the
    /// one that the server uses and outlives the display. Once, before the first picture.
    void watch_photons(const Clock& clock, const PhotonWatchSettings& settings);
    /// What was scanned out until now; empty without watch_photons(). Server's thread.
    [[nodiscard]] std::span<const SeenPart> seen();

    /// The last picture handed over, black before the first.
    [[nodiscard]] const ColourImage& picture() const { return picture_; }
    /// The refresh it was made for; its number is 0 before the first.
    [[nodiscard]] const Refresh& picture_refresh() const { return picture_refresh_; }

private:
    SteadyRefreshes refreshes_;
    const Clock* clock_ = nullptr;
    std::unique_ptr<PhotonWatch> watch_;
    ColourImage picture_;
    Refresh picture_refresh_;
};

}  // namespace lw
