#include "shaders/shader_source.h"

namespace lw {

std::string_view shader_source(std::string_view name) {
    for (const EmbeddedShader* shader = kEmbeddedShaders; shader->name != nullptr; ++shader) {
        if (name == shader->name) return shader->text;
    }
    return {};
}

}  // namespace lw
