#pragma once
/// The display frame in a window. The only file with GLFW is its .cpp.

#include <atomic>
#include <memory>
#include <string>

#include "apps/user_head.h"
#include "core/result.h"
#include "warp_server/presenter.h"

namespace lw {

/// A window with a GL context of its own. The main thread makes it, asks it for input and destroys it; the server's
/// thread presents. The picture is stretched to the window.
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

    /// Server's thread, before the first and after the last picture. Refreshes count from `start`.
    virtual void attach(TimePoint start) = 0;
    virtual void detach() = 0;
};

}  // namespace lw
