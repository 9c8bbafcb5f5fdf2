#include "scene/built_in.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace lw::scene {
namespace {

using testing::HasSubstr;

std::string message_of(const Result<Scene>& result) { return result.ok() ? std::string{} : result.error().message(); }

TEST(BuiltInScenes, EveryListedSceneCanBeMade) {
    for (const BuiltInScene& scene : built_in_scenes()) {
        const Result<Scene> made = make_built_in(scene.name, {});
        ASSERT_TRUE(made.ok()) << message_of(made);
        EXPECT_EQ(made->name, scene.name);
        EXPECT_FALSE(made->bounds_world.empty());
        EXPECT_TRUE(made->start_pose.has_value());
        EXPECT_LE(made->point_lights.size(), static_cast<std::size_t>(kMaxPointLights));
    }
}

TEST(BuiltInScenes, UnknownNamesSayWhatThereIs) {
    for (const char* name : {"", "town", "city ", "../city", "scene.obj", "folder.d/"}) {
        const std::string message = message_of(load_scene(name, {}));
        EXPECT_THAT(message, HasSubstr("city")) << name;
        EXPECT_THAT(message, HasSubstr(".gltf or .glb")) << name;
    }
    EXPECT_THAT(message_of(make_built_in("town", {})), HasSubstr("city"));
}

TEST(BuiltInScenes, AMissingGltfFileIsAnError) {
    EXPECT_THAT(message_of(load_scene("no/such/file.glb", {})), HasSubstr("no/such/file.glb"));
}

TEST(BuiltInScenes, AGltfFileTakesNoParameters) {
    EXPECT_THAT(message_of(load_scene("no/such/file.glb", {{"seed", 1.0}})), HasSubstr("seed"));
}

TEST(BuiltInScenes, UnknownParametersSayWhichThereAre) {
    const std::string message = message_of(make_built_in("city", {{"houses", 10.0}}));
    EXPECT_THAT(message, HasSubstr("houses"));
    EXPECT_THAT(message, HasSubstr("buildings"));
    EXPECT_THAT(message, HasSubstr("movers"));
}

TEST(BuiltInScenes, ValuesOutsideTheirRangeAreErrors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const char* key : {"buildings", "seed", "movers"}) {
        for (const double value : {-1.0, 0.5, nan, infinity, -infinity, 1e15}) {
            EXPECT_THAT(message_of(make_built_in("city", {{key, value}})), HasSubstr(key)) << value;
        }
    }
    EXPECT_THAT(message_of(make_built_in("city", {{"buildings", 0.0}})), HasSubstr("from 1 to 100000"));
    EXPECT_TRUE(make_built_in("city", {{"movers", 0.0}, {"buildings", 1.0}}).ok());
}

TEST(BuiltInScenes, MoreCarsThanTheStreetsHoldIsAnError) {
    EXPECT_THAT(message_of(make_built_in("city", {{"movers", 60000.0}})), HasSubstr("at most"));
}

}  // namespace
}  // namespace lw::scene
