#include "gl/program.h"

#include <algorithm>
#include <array>
#include <utility>

#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "tests/support/gl_test.h"

namespace lw::gl {
namespace {

class GlProgram : public test::GlTest {};

const char* const kVertex = R"(#version 450 core
uniform vec4 u_offset;
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1) + u_offset; }
)";
const char* const kFragment = R"(#version 450 core
uniform float u_value;
uniform vec3 u_unused;
layout(location = 0) out float value;
void main() { value = u_value; }
)";

Result<Program> make(const std::string& vertex, const std::string& fragment) {
    const std::array<ShaderText, 2> texts{ShaderText{"test/a.vert", vertex}, ShaderText{"test/b.frag", fragment}};
    return Program::create_from_texts(texts);
}

TEST_F(GlProgram, UniformsAreCheckedAndReachTheShader) {
    auto program = make(kVertex, kFragment);
    ASSERT_TRUE(program.ok()) << program.error().message();
    program->set("u_offset", glm::vec4{0.0F});
    program->set("u_value", 0.75F);
    const Texture target{{2, 2}, GL_R32F};
    auto framebuffer = Framebuffer::create({&target}, nullptr);
    ASSERT_TRUE(framebuffer.ok());
    framebuffer->bind();
    program->use();
    const VertexArray no_attributes = make_vertex_array();
    glBindVertexArray(no_attributes.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::array<float, 4> pixels{};
    target.download(GL_RED, GL_FLOAT, sizeof pixels, pixels.data());
    EXPECT_EQ(pixels, (std::array<float, 4>{0.75F, 0.75F, 0.75F, 0.75F}));
    glBindVertexArray(0);
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// The style that starts anew: a forked child has no current context.
class GlProgramDeathTest : public GlProgram {
protected:
    GlProgramDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(GlProgramDeathTest, AMissingUniformEndsTheProgram) {
    auto program = make(kVertex, kFragment);
    ASSERT_TRUE(program.ok());
    EXPECT_DEATH((void)program->uniform("u_typo"), "no uniform u_typo in test/a.vert \\+ test/b.frag");
    EXPECT_DEATH((void)program->uniform("u_unused"), "no uniform u_unused");
    EXPECT_DEATH(program->set(-1, 1.0F), "does not have");
}

TEST_F(GlProgramDeathTest, AMissingShaderFileEndsTheProgram) {
    EXPECT_DEATH((void)Program::create({"nowhere/nothing.vert"}), "no shader file nowhere/nothing.vert");
}

TEST_F(GlProgram, CompileErrorsNameFileAndLine) {
    const auto program = make(kVertex, "#version 450 core\nout float value;\nvoid main() { value = undeclared; }\n");
    (void)take_debug_messages();  // Mesa says it there too
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().where.substr(0, 14), "test/b.frag:3:") << program.error().message();
    EXPECT_EQ(std::ranges::count(program.error().message(), '\n'), 0);
}

TEST_F(GlProgram, CompileErrorsNameTheIncludedFile) {
    const auto program =
        make(kVertex,
             "#version 450 core\n#line 1 1 // light/sun.glsl\nfloat sun() { return vec2(1); }\n#line 3 0\n"
             "out float value;\nvoid main() { value = sun(); }\n");
    (void)take_debug_messages();  // Mesa says it there too
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().where.substr(0, 17), "light/sun.glsl:1:") << program.error().message();
}

TEST_F(GlProgram, LinkErrorsNameTheFiles) {
    const auto program =
        make(kVertex, "#version 450 core\nin vec2 uv;\nout vec2 value;\nvoid main() { value = uv; }\n");
    (void)take_debug_messages();  // Mesa says it there too
    ASSERT_FALSE(program.ok());
    EXPECT_NE(program.error().where.find("test/a.vert + test/b.frag"), std::string::npos) << program.error().message();
}

TEST_F(GlProgram, MovesKeepTheProgram) {
    auto program = make(kVertex, kFragment);
    ASSERT_TRUE(program.ok());
    const GLuint id = program->id();
    const Program moved = std::move(*program);
    EXPECT_EQ(moved.id(), id);
    EXPECT_EQ(glIsProgram(id), GL_TRUE);
}

}  // namespace
}  // namespace lw::gl
