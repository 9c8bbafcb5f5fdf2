#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "warp_server/methods/registry.h"

namespace lw {
namespace {

TEST(MethodRegistry, EveryEntryCanBeFoundByItsName) {
    for (const MethodEntry& entry : warp_methods()) {
        EXPECT_EQ(find_warp_method(entry.name), &entry);
        EXPECT_FALSE(entry.summary.empty());
    }
    EXPECT_NE(find_warp_method("splat:anything=1"), nullptr);
    EXPECT_EQ(find_warp_method("magic"), nullptr);
    EXPECT_EQ(find_warp_method(""), nullptr);
}

TEST(MethodRegistry, LabelsRepeatTheSpecification) {
    const auto method = make_warp_method("splat");
    ASSERT_TRUE(method.ok());
    EXPECT_EQ((*method)->label(), "splat");
}

TEST(MethodRegistry, WrongSpecificationsSayWhatIsWrong) {
    const auto message = [](std::string_view specification) {
        const auto method = make_warp_method(specification);
        return method.ok() ? std::string{"accepted"} : method.error().message();
    };
    EXPECT_THAT(message("magic"), ::testing::HasSubstr("unknown warp method: magic: one of: stale, rotation"));
    EXPECT_THAT(message("splat:size=2"), ::testing::HasSubstr("unknown key 'size'"));
    EXPECT_THAT(message("splat:"), ::testing::HasSubstr("is not key=value"));
    EXPECT_THAT(message(""), ::testing::HasSubstr("unknown warp method"));
}

}  // namespace
}  // namespace lw
