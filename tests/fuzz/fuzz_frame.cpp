/// Frame folders and object lists from arbitrary bytes. The input is the folder's four files one after the other, each
/// behind its length (32 bits, little-endian): frame.json, main.color.png, main.depth.pfm, main.id.png.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "frame_link/frame_description.h"
#include "frame_link/frame_folder.h"
#include "tests/fuzz/scratch_folder.h"

namespace {

constexpr std::array<const char*, 4> kFiles{"frame.json", "main.color.png", "main.depth.pfm", "main.id.png"};

// The next section; what is missing is empty.
std::span<const std::uint8_t> take_section(std::span<const std::uint8_t>& rest) {
    if (rest.size() < 4) return {};
    const std::size_t length = rest[0] | static_cast<std::size_t>(rest[1]) << 8U |
                               static_cast<std::size_t>(rest[2]) << 16U | static_cast<std::size_t>(rest[3]) << 24U;
    rest = rest.subspan(4);
    const auto section = rest.first(std::min(length, rest.size()));
    rest = rest.subspan(section.size());
    return section;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const lw::test::ScratchFolder folder{"frame"};
    std::span<const std::uint8_t> rest{data, size};
    for (const char* name : kFiles) {
        const auto section = take_section(rest);
        folder.write(name, section);
        const std::string_view text{reinterpret_cast<const char*>(section.data()), section.size()};
        if (name == kFiles[0]) (void)lw::parse_objects(text, "objects");
    }
    (void)lw::load_frame_folder(folder.path());
    return 0;
}
