#pragma once
/// Tests that need GL derive their suite (named Gl...) from GlTest, or begin their body with LW_NEED_GL(). Without GL
/// they are skipped with the reason, and fail instead under LW_REQUIRE_GL=1.

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string_view>

#include "gl/context.h"

namespace lw::test {

inline bool gl_is_required() {
    const char* value = std::getenv("LW_REQUIRE_GL");
    return value != nullptr && *value != '\0' && std::string_view{value} != "0";
}

/// The test process's own surfaceless context, made at the first call.
inline Result<std::unique_ptr<gl::Context>>& shared_gl_context() {
    static Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    return context;
}

/// Makes the shared context current and, when it goes, fails the test if the driver had anything to say.
class GlScope {
public:
    GlScope() {
        if (shared_gl_context().ok()) {
            (*shared_gl_context())->make_current();
            (void)gl::take_debug_messages();
        }
    }
    GlScope(const GlScope&) = delete;
    GlScope& operator=(const GlScope&) = delete;
    ~GlScope() {
        if (!shared_gl_context().ok()) return;
        EXPECT_EQ(gl::take_debug_messages(), "");
        (*shared_gl_context())->release_current();
    }

    [[nodiscard]] gl::Context& context() { return **shared_gl_context(); }
};

/// A fixture around GlScope.
class GlTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (shared_gl_context().ok()) return;
        if (gl_is_required()) FAIL() << shared_gl_context().error().message();
        GTEST_SKIP() << shared_gl_context().error().message();
    }
    [[nodiscard]] gl::Context& context() { return scope_.context(); }

private:
    GlScope scope_;
};

}  // namespace lw::test

/// First line of a test body that needs GL; leaves the shared context current until the body ends.
#define LW_NEED_GL()                                                                                   \
    if (!::lw::test::shared_gl_context().ok()) {                                                       \
        if (::lw::test::gl_is_required()) FAIL() << ::lw::test::shared_gl_context().error().message(); \
        GTEST_SKIP() << ::lw::test::shared_gl_context().error().message();                             \
    }                                                                                                  \
    ::lw::test::GlScope lw_gl_scope
