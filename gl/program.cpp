#include "gl/program.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>

#include "shaders/shader_source.h"

namespace lw::gl {

namespace {

struct ShaderTraits {
    static void destroy(GLuint id) { glDeleteShader(id); }
};
using Shader = Handle<ShaderTraits>;

std::optional<GLenum> stage_of(std::string_view name) {
    const std::string_view ending = name.substr(name.rfind('.') == std::string_view::npos ? 0 : name.rfind('.'));
    if (ending == ".vert") return GL_VERTEX_SHADER;
    if (ending == ".frag") return GL_FRAGMENT_SHADER;
    if (ending == ".geom") return GL_GEOMETRY_SHADER;
    if (ending == ".comp") return GL_COMPUTE_SHADER;
    return std::nullopt;
}

std::string with_defines(std::string_view source, std::string_view defines) {
    if (defines.empty()) return std::string{source};
    const std::size_t end_of_version = source.find('\n') + 1;
    std::string text{source.substr(0, end_of_version)};
    text.append(defines).append("#line 2 0\n").append(source.substr(end_of_version));
    return text;
}

// Source string numbers to files: an included file begins with `#line 1 NUMBER // FILE` (cmake/EmbedShaders.cmake).
std::map<int, std::string> included_files(std::string_view source) {
    std::map<int, std::string> files;
    constexpr std::string_view kMark = "#line 1 ";
    for (std::size_t at = source.find(kMark); at != std::string_view::npos; at = source.find(kMark, at + 1)) {
        const std::string_view line = source.substr(at, source.find('\n', at) - at);
        int number = 0;
        std::from_chars(line.data() + kMark.size(), line.data() + line.size(), number);
        if (const std::size_t comment = line.find("// "); comment != std::string_view::npos) {
            files[number] = std::string{line.substr(comment + 3)};
        }
    }
    return files;
}

// Messages are one line: the first that speaks of an error.
std::string first_error_line(const std::string& log) {
    for (std::size_t begin = 0; begin < log.size();) {
        const std::size_t end = std::min(log.find('\n', begin), log.size());
        std::string line = log.substr(begin, end - begin);
        if (line.find("error") != std::string::npos) return line;
        begin = end + 1;
    }
    return log.substr(0, log.find('\n'));
}

// "0:12(5): error: ..." (Mesa) and "0(12) : error ..." (NVIDIA) become "FILE:12: ...".
std::string readable_log(const std::string& log, const std::string& name, std::string_view source) {
    const std::string line = first_error_line(log);
    const char* const last = line.data() + line.size();
    int string_number = 0;
    int line_number = 0;
    const auto [after_string, string_error] = std::from_chars(line.data(), last, string_number);
    if (string_error != std::errc{} || after_string == last) return fmt::format("{}: {}", name, line);
    const auto [after_line, line_error] = std::from_chars(after_string + 1, last, line_number);
    if (line_error != std::errc{}) return fmt::format("{}: {}", name, line);

    const auto files = included_files(source);
    const auto file = files.find(string_number);
    std::string_view rest{after_line, static_cast<std::size_t>(last - after_line)};
    if (const std::size_t colon = rest.find(": "); colon != std::string_view::npos) rest.remove_prefix(colon + 2);
    return fmt::format("{}:{}: {}", file == files.end() ? name : file->second, line_number, rest);
}

Result<Shader> compile(const std::string& name, std::string_view source) {
    const auto stage = stage_of(name);
    LW_CHECK(stage.has_value(), "the ending of " + name + " names no stage");
    Shader shader{glCreateShader(*stage)};
    const char* text = source.data();
    const auto length = static_cast<GLint>(source.size());
    glShaderSource(shader.id(), 1, &text, &length);
    glCompileShader(shader.id());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return shader;
    GLint log_size = 0;
    glGetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &log_size);
    std::string log(static_cast<std::size_t>(log_size) + 1, '\0');
    glGetShaderInfoLog(shader.id(), log_size, nullptr, log.data());
    return Error{"a shader does not compile", readable_log(log.c_str(), name, source), "report it with your driver"};
}

}  // namespace

Result<Program> Program::create_from_texts(std::span<const ShaderText> texts) {
    std::string names;
    Handle<ProgramTraits> program{glCreateProgram()};
    std::vector<Shader> shaders;
    for (const ShaderText& text : texts) {
        auto shader = compile(text.name, text.source);
        if (!shader.ok()) return shader.error();
        glAttachShader(program.id(), shader->id());
        shaders.push_back(std::move(*shader));
        names += (names.empty() ? "" : " + ") + text.name;
    }
    glLinkProgram(program.id());
    for (const Shader& shader : shaders) glDetachShader(program.id(), shader.id());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return Program{std::move(program), std::move(names)};
    std::array<char, 2048> log{};
    glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    std::string first_line{log.data()};
    first_line.resize(std::min(first_line.size(), first_line.find('\n')));
    return Error{"a shader program does not link", fmt::format("{}: {}", names, first_line),
                 "report it with your driver"};
}

Result<Program> Program::create(std::span<const std::string_view> shader_names, std::string_view defines) {
    std::vector<ShaderText> texts;
    for (const std::string_view name : shader_names) {
        const std::string_view source = shader_source(name);
        LW_CHECK(!source.empty(), fmt::format("no shader file {}", name));
        texts.push_back({std::string{name}, with_defines(source, defines)});
    }
    return create_from_texts(texts);
}

Result<Program> Program::create(std::initializer_list<std::string_view> shader_names, std::string_view defines) {
    return create(std::span<const std::string_view>{shader_names.begin(), shader_names.size()}, defines);
}

GLint Program::uniform(const char* uniform_name) const {
    const GLint location = glGetUniformLocation(id(), uniform_name);
    LW_CHECK(location >= 0, fmt::format("no uniform {} in {}", uniform_name, name_));
    return location;
}

namespace {
GLint checked(GLint location, const std::string& name) {
    LW_CHECK(location >= 0, "a uniform is set by a location that " + name + " does not have");
    return location;
}
}  // namespace

void Program::set(GLint location, int value) const { glProgramUniform1i(id(), checked(location, name_), value); }
void Program::set(GLint location, unsigned value) const { glProgramUniform1ui(id(), checked(location, name_), value); }
void Program::set(GLint location, float value) const { glProgramUniform1f(id(), checked(location, name_), value); }
void Program::set(GLint location, const glm::ivec2& value) const {
    glProgramUniform2i(id(), checked(location, name_), value.x, value.y);
}
void Program::set(GLint location, const glm::vec2& value) const {
    glProgramUniform2fv(id(), checked(location, name_), 1, &value[0]);
}
void Program::set(GLint location, const glm::vec3& value) const {
    glProgramUniform3fv(id(), checked(location, name_), 1, &value[0]);
}
void Program::set(GLint location, const glm::vec4& value) const {
    glProgramUniform4fv(id(), checked(location, name_), 1, &value[0]);
}
void Program::set(GLint location, const glm::mat3& value) const {
    glProgramUniformMatrix3fv(id(), checked(location, name_), 1, GL_FALSE, &value[0][0]);
}
void Program::set(GLint location, const glm::mat4& value) const {
    glProgramUniformMatrix4fv(id(), checked(location, name_), 1, GL_FALSE, &value[0][0]);
}

}  // namespace lw::gl
