/// glTF files, text and binary, from arbitrary bytes.

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/gltf.h"
#include "tests/fuzz/scratch_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const lw::test::ScratchFolder folder{"gltf"};
    const bool is_binary = size >= 4 && data[0] == 'g' && data[1] == 'l';
    const char* name = is_binary ? "scene.glb" : "scene.gltf";
    folder.write(name, std::span{data, size});
    (void)lw::scene::load_gltf(folder.path() / name);
    return 0;
}
