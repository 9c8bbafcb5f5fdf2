#include "apps/stability/case_folder.h"

#include <fmt/format.h>

#include <glm/gtc/type_ptr.hpp>
#include <memory>
#include <span>

#include "core/image_io.h"
#include "frame_link/frame_folder.h"

namespace lw::stability {
namespace {

std::string json_of(const std::vector<ObjectTransform>& objects) {
    std::string text = "{\"objects\": [";
    for (std::size_t i = 0; i < objects.size(); ++i) {
        text += fmt::format("{}\n  {{\"id\": {}, \"world_from_object\": [", i == 0 ? "" : ",", objects[i].id);
        const std::span numbers{glm::value_ptr(objects[i].world_from_object), 16};
        for (std::size_t n = 0; n < numbers.size(); ++n) text += fmt::format("{}{}", n == 0 ? "" : ", ", numbers[n]);
        text += "]}";
    }
    return text + "\n]}\n";
}

}  // namespace

Result<std::string> save_case(std::uint64_t seed, CaseRange range, const std::filesystem::path& folder) {
    const StabilityCase made = make_case(seed, range);
    RenderedFrame frame;
    frame.layers.push_back(std::make_shared<const Layer>(layer_of(made, CasePattern::lattice)));
    const Status saved = save_frame_folder(frame, folder);
    if (!saved) return saved.error();
    const std::filesystem::path objects = folder / "objects.json";
    const std::string text = json_of(made.at_target);
    const Status written = write_file_atomically(objects, std::as_bytes(std::span{text}));
    if (!written) return written.error();
    const Pose& pose = made.target.world_from_eye;
    return fmt::format("latewarp warp {} --objects {} --pose {},{},{},{},{},{},{} --near {} --size {}x{} -o case.png",
                       folder.string(), objects.string(), pose.position_m.x, pose.position_m.y, pose.position_m.z,
                       pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w,
                       made.target.near_m, made.target.size_px.x, made.target.size_px.y);
}

}  // namespace lw::stability
