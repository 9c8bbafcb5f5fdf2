#include "frame_link/frame_folder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "core/camera_check.h"
#include "core/check.h"
#include "core/image_io.h"
#include "frame_link/frame_description.h"

namespace lw {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxDescriptionBytes = std::uint64_t{64} << 20;  // 65535 movers in 256 bytes each are 16 MiB
// Of all layers together, 2.7 GB of pixels: a cube map of six 4096 px faces with two layers is 0.2e9.
constexpr std::int64_t kMaxPixels = std::int64_t{16384} * 16384;

struct LayerFiles {
    fs::path colour, depth, object_id, quarters;
};

LayerFiles files_of(const fs::path& folder, const std::string& layer) {
    return {folder / (layer + ".color.png"), folder / (layer + ".depth.pfm"), folder / (layer + ".id.png"),
            folder / (layer + ".quarters.png")};
}

std::string size_text(glm::ivec2 size_px) { return fmt::format("{}x{}", size_px.x, size_px.y); }

std::string_view as_text(const std::vector<std::uint8_t>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class T>
Status check_size(const Image<T>& image, glm::ivec2 size_px, const fs::path& file) {
    if (image.size_px() == size_px) return Done{};
    return Error{fmt::format("the image is {} and frame.json says {}", size_text(image.size_px()), size_text(size_px)),
                 file.string(), "make both equal"};
}

// A distance that is none becomes NaN, which every warp method counts and skips.
void convert_from_distance(DepthImage& depth, double near_m) {
    for (float& value : depth.pixels()) {
        const double distance_m = value;
        value = distance_m > 0.0 ? static_cast<float>(near_m / distance_m) : std::numeric_limits<float>::quiet_NaN();
    }
}

void warn_of_bad_depths(const Layer& layer, std::vector<std::string>& warnings) {
    std::size_t bad = 0;
    for (const float depth : layer.cpu().depth.pixels()) bad += depth >= 0.0F && depth <= 1.0F ? 0 : 1;
    bad -= layer.empty_pixels;
    if (bad == 0) return;
    warnings.push_back(
        fmt::format("layer {}: {} depth values are no depth (not finite, behind the eye or before the "
                    "near plane): the warp skips them",
                    layer.name, bad));
}

void warn_of_unknown_ids(const Layer& layer, std::vector<std::string>& warnings) {
    std::vector<bool> known(65536, false);
    known[0] = true;
    for (const ObjectTransform& mover : layer.movers) known[mover.id] = true;
    std::set<ObjectId> unknown;
    for (const ObjectId id : layer.cpu().object_id.pixels()) {
        if (!known[id]) unknown.insert(id);
    }
    if (unknown.empty()) return;
    warnings.push_back(
        fmt::format("layer {}: {} object ids (first {}) have no entry in objects: the warp skips their "
                    "pixels",
                    layer.name, unknown.size(), *unknown.begin()));
}

Result<CpuPixels> load_pixels(const LayerDescription& description, const LayerFiles& files) {
    auto colour = read_png(files.colour);
    if (!colour) return colour.error();
    auto depth = read_pfm(files.depth);
    if (!depth) return depth.error();
    auto object_id = read_png16(files.object_id);
    if (!object_id) return object_id.error();
    for (const Status& status : {check_size(*colour, description.camera.size_px, files.colour),
                                 check_size(*depth, description.camera.size_px, files.depth),
                                 check_size(*object_id, description.camera.size_px, files.object_id)}) {
        if (!status) return status.error();
    }
    if (description.depth_encoding == DepthEncoding::kDistanceM) {
        convert_from_distance(*depth, description.camera.near_m);
    }
    CpuPixels pixels{std::move(*colour), std::move(*depth), std::move(*object_id), description.alpha_is_share};
    if (!description.has_quarters) return pixels;
    auto quarters = read_png(files.quarters);
    if (!quarters) return quarters.error();
    if (auto status = check_size(*quarters, 2 * description.camera.size_px, files.quarters); !status) {
        return status.error();
    }
    pixels.quarters = std::move(*quarters);
    pixels.quarter_samples = description.quarter_samples;
    return pixels;
}

Status check_total_size(const FrameDescription& description, const fs::path& file) {
    std::int64_t pixels = 0;
    for (const LayerDescription& layer : description.layers) {
        pixels += std::int64_t{layer.camera.size_px.x} * layer.camera.size_px.y;
    }
    if (pixels <= kMaxPixels) return Done{};
    return Error{fmt::format("the layers have {} pixels in all", pixels), file.string(),
                 fmt::format("at most {} are read", kMaxPixels)};
}

// JSON has no NaN; and what is written must read back.
bool can_be_written(const Layer& layer) {
    ObjectId last = 0;
    for (const ObjectTransform& mover : layer.movers) {
        if (mover.id <= last) return false;
        last = mover.id;
        for (int column = 0; column < 4; ++column) {
            const glm::dvec4& v = mover.world_from_object[column];
            if (!std::isfinite(glm::dot(v, v)) || v.w != (column == 3 ? 1.0 : 0.0)) return false;
        }
    }
    return std::isfinite(layer.scene_time_s);
}

Status check_savable(const RenderedFrame& frame, const fs::path& folder) {
    const auto refuse = [&](const std::string& what) { return Error{what, folder.string(), "render the frame again"}; };
    if (frame.layers.empty()) return refuse("a frame without layers");
    std::set<std::string> names;
    for (const auto& layer : frame.layers) {
        const CpuPixels& pixels = layer->cpu();
        if (!is_layer_name(layer->name)) return refuse(fmt::format("'{}' is no layer name", layer->name));
        if (!names.insert(layer->name).second) return refuse(fmt::format("two layers are named {}", layer->name));
        if (const auto problem = problem_of(layer->camera); !problem.empty()) return refuse(std::string{problem});
        if (!can_be_written(*layer)) return refuse(fmt::format("layer {} has unusable movers or time", layer->name));
        const glm::ivec2 size_px = layer->camera.size_px;
        if (pixels.colour.size_px() != size_px || pixels.depth.size_px() != size_px ||
            pixels.object_id.size_px() != size_px) {
            return refuse(fmt::format("the images of layer {} are not all {}", layer->name, size_text(size_px)));
        }
        if (!pixels.quarters.empty() && pixels.quarters.size_px() != 2 * size_px) {
            return refuse(fmt::format("the quarters of layer {} are not {}", layer->name, size_text(2 * size_px)));
        }
    }
    return Done{};
}

Status save_pixels(const Layer& layer, const LayerFiles& files) {
    if (auto status = write_png(files.colour, layer.cpu().colour); !status) return status;
    if (auto status = write_pfm(files.depth, layer.cpu().depth); !status) return status;
    if (auto status = write_png16(files.object_id, layer.cpu().object_id); !status) return status;
    if (layer.cpu().quarters.empty()) return Done{};
    return write_png(files.quarters, layer.cpu().quarters);
}

Status save_files(const RenderedFrame& frame, const fs::path& folder) {
    for (const auto& layer : frame.layers) {
        if (auto status = save_pixels(*layer, files_of(folder, layer->name)); !status) return status;
    }
    const std::string text = frame_description_of(frame);
    return write_file_atomically(folder / "frame.json", std::as_bytes(std::span{text}));
}

void remove_files(const RenderedFrame& frame, const fs::path& folder) {
    std::error_code ignored;
    for (const auto& layer : frame.layers) {
        const LayerFiles files = files_of(folder, layer->name);
        for (const fs::path& file : {files.colour, files.depth, files.object_id, files.quarters})
            fs::remove(file, ignored);
    }
}

}  // namespace

Result<LoadedFrame> load_frame_folder(const fs::path& folder) {
    const fs::path description_file = folder / "frame.json";
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        return Error{"not a frame folder", folder.string(), "give a folder with a frame.json in it"};
    }
    const auto bytes = read_file(description_file, kMaxDescriptionBytes);
    if (!bytes) return bytes.error();
    auto description = parse_frame_description(as_text(*bytes), description_file.string());
    if (!description) return description.error();
    if (auto status = check_total_size(*description, description_file); !status) return status.error();

    auto frame = std::make_shared<RenderedFrame>();
    frame->index = description->index;
    LoadedFrame loaded{nullptr, std::move(description->warnings)};
    for (LayerDescription& from : description->layers) {
        auto pixels = load_pixels(from, files_of(folder, from.name));
        if (!pixels) return pixels.error();
        auto layer = std::make_shared<Layer>();
        layer->name = std::move(from.name);
        layer->camera = from.camera;
        layer->pose_sampled = at_seconds(from.pose_sampled_s);
        layer->scene_time_s = from.time_s;
        layer->pixels = std::move(*pixels);
        layer->movers = std::move(from.movers);
        layer->empty_pixels =
            static_cast<std::uint64_t>(std::ranges::count(layer->cpu().depth.pixels(), kNoSurfaceDepth));
        warn_of_bad_depths(*layer, loaded.warnings);
        warn_of_unknown_ids(*layer, loaded.warnings);
        frame->layers.push_back(std::move(layer));
    }
    frame->times.pose_sampled = frame->layers.front()->pose_sampled;
    loaded.frame = std::move(frame);
    return loaded;
}

Status save_frame_folder(const RenderedFrame& frame, const fs::path& folder) {
    if (auto status = check_savable(frame, folder); !status) return status;
    std::error_code problem;
    const bool is_new = fs::create_directories(folder, problem);
    if (!fs::is_directory(folder, problem)) {
        return Error{"cannot make the folder", folder.string(), "choose one that you may write"};
    }
    // An older frame in the folder stops being one before its images are replaced.
    fs::remove(folder / "frame.json", problem);
    Status status = save_files(frame, folder);
    if (!status) {
        remove_files(frame, folder);
        if (is_new) fs::remove(folder, problem);
    }
    return status;
}

Result<std::vector<ObjectTransform>> load_object_transforms(const fs::path& file) {
    const auto bytes = read_file(file, kMaxDescriptionBytes);
    if (!bytes) return bytes.error();
    return parse_objects(as_text(*bytes), file.string());
}

}  // namespace lw
