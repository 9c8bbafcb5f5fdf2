#include "apps/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace lw {

namespace {

std::string cpu_name() {
    std::ifstream file{"/proc/cpuinfo"};
    std::string line;
    while (std::getline(file, line)) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

}  // namespace

Machine machine_of(const gl::Context* context) {
    Machine machine{cpu_name(), static_cast<int>(std::thread::hardware_concurrency()), {}, {}};
    if (context == nullptr) return machine;
    machine.gl_renderer = context->renderer();
    machine.gl_version = context->version();
    return machine;
}

Machine this_machine() {
    const auto context = gl::Context::create();
    if (!context) return machine_of(nullptr);
    (*context)->make_current();
    Machine machine = machine_of(context->get());
    (*context)->release_current();
    return machine;
}

bool is_same_machine(const Machine& a, const Machine& b) {
    return a.cpu == b.cpu && a.cores == b.cores && a.gl_renderer == b.gl_renderer;
}

std::string text_of(const Machine& machine) {
    return fmt::format("{}, {} cores, {}", machine.cpu, machine.cores,
                       machine.gl_renderer.empty() ? "no GL" : machine.gl_renderer);
}

}  // namespace lw
