// The blocks that C++ fills and shaders read lie at the same offsets on both sides.
#include <cstddef>
#include <string>

#include "client_renderer/surface_features.h"
#include "gl/program.h"
#include "shaders/client_blocks.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

class GlBlockLayout : public test::GlTest {
protected:
    static GLint query(const gl::Program& program, GLenum interface, const char* name, GLenum property) {
        const GLuint index = glGetProgramResourceIndex(program.id(), interface, name);
        if (index == GL_INVALID_INDEX) return -1;
        GLint value = -1;
        glGetProgramResourceiv(program.id(), interface, index, 1, &property, 1, nullptr, &value);
        return value;
    }
    static GLint offset(const gl::Program& program, const char* name) {
        return query(program, GL_UNIFORM, name, GL_OFFSET);
    }
    static GLint size(const gl::Program& program, const char* name) {
        return query(program, GL_UNIFORM_BLOCK, name, GL_BUFFER_DATA_SIZE);
    }
};

#define EXPECT_SAME_OFFSET(program, block, member) \
    EXPECT_EQ(offset(program, #block "." #member), static_cast<GLint>(offsetof(shader::block, member)))
#define EXPECT_SAME_ARRAY_OFFSET(program, block, member) \
    EXPECT_EQ(offset(program, #block "." #member "[0]"), static_cast<GLint>(offsetof(shader::block, member)))

TEST_F(GlBlockLayout, TheGBufferPassReadsWhatItIsGiven) {
    auto program = gl::Program::create({"client/gbuffer.vert", "client/gbuffer.frag"},
                                       "#define TEXTURED\n#define BASE_COLOUR_TEXTURE\n#define ALPHA_MASK\n");
    ASSERT_TRUE(program.ok()) << program.error().message();
    EXPECT_EQ(size(*program, "FrameBlock"), static_cast<GLint>(sizeof(shader::FrameBlock)));
    EXPECT_EQ(size(*program, "MaterialBlock"), static_cast<GLint>(sizeof(shader::MaterialBlock)));
    EXPECT_SAME_OFFSET(*program, FrameBlock, clip_x);
    EXPECT_SAME_OFFSET(*program, FrameBlock, clip_y);
    EXPECT_SAME_OFFSET(*program, FrameBlock, clip_w);
    EXPECT_SAME_OFFSET(*program, FrameBlock, near_m);
    EXPECT_SAME_OFFSET(*program, MaterialBlock, base_colour);
    EXPECT_SAME_OFFSET(*program, MaterialBlock, emissive);
    EXPECT_SAME_OFFSET(*program, MaterialBlock, factors);
    EXPECT_SAME_ARRAY_OFFSET(*program, MaterialBlock, uv_rows);
}

TEST_F(GlBlockLayout, TheLightingPassReadsWhatItIsGiven) {
    auto program = gl::Program::create({"client/fullscreen.vert", "client/lighting.frag"}, "#define POINT_LIGHTS\n");
    ASSERT_TRUE(program.ok()) << program.error().message();
    EXPECT_EQ(size(*program, "FrameBlock"), static_cast<GLint>(sizeof(shader::FrameBlock)));
    EXPECT_EQ(size(*program, "LightsBlock"), static_cast<GLint>(sizeof(shader::LightsBlock)));
    EXPECT_SAME_OFFSET(*program, FrameBlock, ray_origin);
    EXPECT_SAME_OFFSET(*program, FrameBlock, ray_per_px_x);
    EXPECT_SAME_OFFSET(*program, FrameBlock, ray_per_px_y);
    EXPECT_SAME_OFFSET(*program, FrameBlock, sun_direction);
    EXPECT_SAME_OFFSET(*program, FrameBlock, sun_irradiance);
    EXPECT_SAME_OFFSET(*program, FrameBlock, tiles);
    EXPECT_SAME_ARRAY_OFFSET(*program, LightsBlock, position_range);
    EXPECT_SAME_ARRAY_OFFSET(*program, LightsBlock, intensity);
}

TEST_F(GlBlockLayout, EveryVariantOfTheGBufferPassCompiles) {
    for (unsigned bits = 0; bits < 256; ++bits) {
        const auto has = [&](unsigned bit) { return (bits >> bit & 1U) != 0; };
        const SurfaceFeatures features{has(0), has(1), has(2), has(3), has(4), has(5), has(6), has(7)};
        const auto program = gl::Program::create({"client/gbuffer.vert", "client/gbuffer.frag"}, defines_of(features));
        ASSERT_TRUE(program.ok()) << program.error().message() << "\n" << defines_of(features);
    }
}

}  // namespace
}  // namespace lw
