// Textures, framebuffers, the depth and row conventions, fences and timers, by what pixels say.
#include <array>
#include <vector>

#include "core/clock.h"
#include "gl/fence.h"
#include "gl/framebuffer.h"
#include "gl/gpu_timer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "tests/support/gl_test.h"

namespace lw::gl {
namespace {

class GlDrawing : public test::GlTest {
protected:
    void TearDown() override {
        glDisable(GL_DEPTH_TEST);
        glBindVertexArray(0);
        glUseProgram(0);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
};

TEST_F(GlDrawing, TexturesRoundTripTopRowFirst) {
    Texture texture{{3, 2}, GL_R16UI};
    const std::vector<std::uint16_t> written{1, 2, 3, 40'000, 50'000, 65'535};
    texture.upload(GL_RED_INTEGER, GL_UNSIGNED_SHORT, written.data());
    std::vector<std::uint16_t> read(6);
    texture.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, 12, read.data());
    EXPECT_EQ(read, written);
    EXPECT_EQ(texture.size_px(), glm::ivec2(3, 2));
}

// One triangle over the half y_ndc > 0 at clip coordinates (.., z, w): the top rows, by GL_UPPER_LEFT.
const std::array<ShaderText, 2> kHalfTriangle{ShaderText{"test/half.vert", R"(#version 450 core
uniform vec2 u_z_w;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 8 : -8, gl_VertexID == 2 ? 16 : 0);
    gl_Position = vec4(corner * u_z_w.y, u_z_w.x, u_z_w.y);
}
)"},
                                              ShaderText{"test/half.frag", R"(#version 450 core
uniform float u_value;
layout(location = 0) out float value;
void main() { value = u_value; }
)"}};

TEST_F(GlDrawing, RowZeroIsTheTopAndNearerIsGreater) {
    const Texture value{{4, 4}, GL_R32F};
    const Texture depth{{4, 4}, GL_DEPTH_COMPONENT32F};
    auto framebuffer = Framebuffer::create({&value}, &depth);
    ASSERT_TRUE(framebuffer.ok()) << framebuffer.error().message();
    auto program = Program::create_from_texts(kHalfTriangle);
    ASSERT_TRUE(program.ok()) << program.error().message();
    framebuffer->bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const VertexArray no_attributes = make_vertex_array();
    glBindVertexArray(no_attributes.id());
    program->use();
    const auto draw = [&](float near_m, float distance_m, float written) {
        program->set("u_z_w", glm::vec2{near_m, distance_m});
        program->set("u_value", written);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    };
    draw(0.05F, 2.0F, 2.0F);
    draw(0.05F, 3.0F, 3.0F);    // behind the first: hidden
    draw(0.05F, 0.04F, 0.04F);  // nearer than the near plane: clipped

    std::array<float, 16> values{};
    std::array<float, 16> depths{};
    value.download(GL_RED, GL_FLOAT, sizeof values, values.data());
    depth.download(GL_DEPTH_COMPONENT, GL_FLOAT, sizeof depths, depths.data());
    for (std::size_t i = 0; i < 16; ++i) {
        const bool top = i < 8;
        EXPECT_EQ(values[i], top ? 2.0F : 0.0F) << i;
        EXPECT_EQ(depths[i], top ? 0.025F : 0.0F) << i;  // near / distance, exactly
    }
}

TEST_F(GlDrawing, FarDepthsStayApart) {
    const Texture value{{4, 4}, GL_R32F};
    const Texture depth{{4, 4}, GL_DEPTH_COMPONENT32F};
    auto framebuffer = Framebuffer::create({&value}, &depth);
    auto program = Program::create_from_texts(kHalfTriangle);
    ASSERT_TRUE(framebuffer.ok() && program.ok());
    framebuffer->bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const VertexArray no_attributes = make_vertex_array();
    glBindVertexArray(no_attributes.id());
    program->use();
    for (const float distance_m : {50'000.0F, 50'001.0F, 50'002.0F}) {  // drawn front to back
        program->set("u_z_w", glm::vec2{0.05F, distance_m});
        program->set("u_value", distance_m);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    std::array<float, 16> values{};
    value.download(GL_RED, GL_FLOAT, sizeof values, values.data());
    EXPECT_EQ(values[0], 50'000.0F);
}

TEST_F(GlDrawing, AnImpossibleFramebufferIsAnError) {
    const Texture not_drawable{{4, 4}, GL_RGB9_E5};
    const auto framebuffer = Framebuffer::create({&not_drawable}, nullptr);
    ASSERT_FALSE(framebuffer.ok());
    EXPECT_NE(framebuffer.error().where.find("4x4"), std::string::npos);
    (void)take_debug_messages();
}

TEST_F(GlDrawing, FencesSignal) {
    EXPECT_TRUE(Fence{}.signalled());
    const Fence fence = Fence::insert();
    glFinish();
    EXPECT_TRUE(fence.signalled());
}

TEST_F(GlDrawing, TimersReportEachMeasurementOnce) {
    const VirtualClock clock;
    GpuTimer timer{clock, context().is_software()};
    EXPECT_FALSE(timer.take_ms().has_value());
    for (int i = 0; i < 2; ++i) {
        timer.begin();
        timer.end();
    }
    glFinish();
    int taken = 0;
    while (const auto ms = timer.take_ms()) {
        EXPECT_GE(*ms, 0.0);
        ++taken;
    }
    EXPECT_EQ(taken, 2);
}

TEST_F(GlDrawing, SoftwareTimersReadTheGivenClock) {
    VirtualClock clock;
    GpuTimer timer{clock, true};
    timer.begin();
    clock.advance(from_ms(3.0));
    timer.end();
    EXPECT_EQ(timer.take_ms(), 3.0);
    for (int i = 0; i < 20; ++i) {  // more than the ring holds: the oldest fall out
        timer.begin();
        clock.advance(from_ms(i));
        timer.end();
    }
    EXPECT_EQ(timer.take_ms(), 12.0);
}

}  // namespace
}  // namespace lw::gl
