#pragma once
/// The display frame in a window. The only file with GLFW is its .cpp.

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/overlay.h"
#include "apps/user_head.h"
#include "core/result.h"
#include "warp_server/presenter.h"

namespace lw {

/// A window with a GL context of its own. The main thread makes it, asks it for input and destroys it; the server's
/// thread presents. The picture is stretched to the window; its size may change from one to the next.
///
/// Its refreshes are those of a clock at `hz`: a window system does not tell when it scans out, so latencies are
/// counted to the moment the picture is handed to it.
class WindowPresenter : public Presenter {
public:
    /// True when the environment names a display.
    [[nodiscard]] static bool is_display_present();

    /// Main thread. No display, no GL: an error.
    [[nodiscard]] static Result<std::unique_ptr<WindowPresenter>> create(const std::string& title, glm::ivec2 size_px,
                                                                         double hz);

    /// Main thread: waits up to `longest` for events and returns what mouse and keys ask for. Escape, Q and the close
    /// button close the window.
    [[nodiscard]] virtual HeadInput wait_for_input(Duration longest) = 0;

    /// Main thread: keys that were pressed since the last call, in order, as the capitals, digits and signs on them.
    [[nodiscard]] virtual std::string take_keys() = 0;

    /// Main thread: what is shown over the pictures from now on; panels that do not fit are cut off.
    virtual void set_overlay(std::vector<OverlayPanel> panels) = 0;

    /// Called with every picture on the server's thread; set before attach().
    std::function<void(const ColourImage&, const Refresh&)> on_picture;

    /// Server's thread, before the first and after the last picture. Refreshes count from `start`.
    virtual void attach(TimePoint start) = 0;
    virtual void detach() = 0;
};

}  // namespace lw
