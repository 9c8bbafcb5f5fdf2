#include "gl/handle.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

std::vector<GLuint> destroyed;

struct CountingTraits {
    static void destroy(GLuint id) { destroyed.push_back(id); }
};
using CountingHandle = lw::gl::Handle<CountingTraits>;

TEST(Handle, EmptyNeedsNoContext) {
    const lw::gl::Buffer buffer;
    EXPECT_EQ(buffer.id(), 0U);
    EXPECT_FALSE(static_cast<bool>(buffer));
}

TEST(Handle, MovedFromIsEmptyAndDestroysNothing) {
    destroyed.clear();
    {
        CountingHandle a{7};
        const CountingHandle b{std::move(a)};
        EXPECT_EQ(b.id(), 7U);
        EXPECT_EQ(a.id(), 0U);  // NOLINT(bugprone-use-after-move): that is what is tested
    }
    EXPECT_EQ(destroyed, std::vector<GLuint>{7});
}

TEST(Handle, AssignmentDestroysEachOnce) {
    destroyed.clear();
    {
        CountingHandle a{7};
        a = CountingHandle{8};
        EXPECT_EQ(a.id(), 8U);
        EXPECT_EQ(destroyed, std::vector<GLuint>{7});
    }
    EXPECT_EQ(destroyed, (std::vector<GLuint>{7, 8}));
}

TEST(Handle, SelfMoveKeepsTheObject) {
    destroyed.clear();
    {
        CountingHandle a{7};
        CountingHandle& same = a;
        a = std::move(same);
        EXPECT_EQ(a.id(), 7U);
    }
    EXPECT_EQ(destroyed, std::vector<GLuint>{7});
}

}  // namespace
