#pragma once
/// Programs made from the embedded shader files.

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gl/handle.h"

namespace lw::gl {

struct ProgramTraits {
    static void destroy(GLuint id) { glDeleteProgram(id); }
};

/// One stage given as text: for tests, and for what is not a file.
struct ShaderText {
    std::string name;    ///< as in messages; its ending (.vert .frag .geom .comp) is the stage
    std::string source;  ///< starts with its #version line
};

/// Move-only. A uniform that does not exist is a programmer error wherever it is named or set, also one that the
/// compiler left out because nothing uses it: then the C++ side and the shader disagree.
class Program {
public:
    Program() noexcept = default;
    /// Compiles and links shader files named as in shader_source() ("points/points.vert"), one per stage. `defines`
    /// ("#define ALPHA_MASK\n") goes behind the #version line of each and leaves line numbers alone. A file that does
    /// not exist is a programmer error; a compile or link failure is an error that names the file and the line.
    [[nodiscard]] static Result<Program> create(std::span<const std::string_view> shader_names,
                                                std::string_view defines = {});
    [[nodiscard]] static Result<Program> create(std::initializer_list<std::string_view> shader_names,
                                                std::string_view defines = {});
    [[nodiscard]] static Result<Program> create_from_texts(std::span<const ShaderText> texts);

    [[nodiscard]] GLuint id() const noexcept { return handle_.id(); }
    explicit operator bool() const noexcept { return static_cast<bool>(handle_); }
    /// The file names, for messages.
    [[nodiscard]] const std::string& name() const noexcept { return name_; }

    void use() const { glUseProgram(id()); }

    /// Location of an active uniform. Look it up once; a set() by location is cheap.
    [[nodiscard]] GLint uniform(const char* uniform_name) const;

    // Setters work without use() (direct state access). The name forms look the uniform up each time.
    void set(GLint location, int value) const;
    void set(GLint location, unsigned value) const;
    void set(GLint location, float value) const;
    void set(GLint location, const glm::ivec2& value) const;
    void set(GLint location, const glm::vec2& value) const;
    void set(GLint location, const glm::vec3& value) const;
    void set(GLint location, const glm::vec4& value) const;
    void set(GLint location, const glm::mat3& value) const;
    void set(GLint location, const glm::mat4& value) const;
    template <class T>
    void set(const char* uniform_name, const T& value) const {
        set(uniform(uniform_name), value);
    }

private:
    Program(Handle<ProgramTraits> handle, std::string name) : handle_{std::move(handle)}, name_{std::move(name)} {}

    Handle<ProgramTraits> handle_;
    std::string name_;
};

}  // namespace lw::gl
