/// `latewarp generate`: a built-in scene as glTF.

#include "apps/report.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"
#include "scene/built_in.h"
#include "scene/gltf.h"

namespace lw {

Status run_generate(const Options& options) {
    const Status writable = check_output_file(options.output);
    if (!writable) return writable;
    const Result<scene::Scene> scene = scene::make_built_in(options.generated_name, options.parameters);
    if (!scene) return scene.error();
    print_warnings(scene->warnings, options.quiet);
    return scene::save_glb(*scene, options.output);
}

}  // namespace lw
