#pragma once
/// GLSL text embedded at build time.

#include <string_view>

namespace lw {

struct EmbeddedShader {
    const char* name;  ///< path below shaders/, "points/points.vert"; null ends the table
    const char* text;  ///< includes expanded; starts with its #version line
};
extern const EmbeddedShader kEmbeddedShaders[];

/// The text of a shader file, or an empty view when there is no such file.
[[nodiscard]] std::string_view shader_source(std::string_view name);

}  // namespace lw
