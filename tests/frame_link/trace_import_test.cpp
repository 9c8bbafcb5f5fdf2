#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "frame_link/trace.h"
#include "frame_link/trace_formats.h"
#include "tests/frame_link/temporary_folder.h"

namespace lw {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kHeader = "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\n";

/// As load_trace(), without a file.
Result<Trace> read_from_memory(std::string_view bytes) {
    const TraceFile file{"user1_none.csv", bytes};
    for (const TraceFormat& format : trace_formats()) {
        if (format.recognises(bytes)) return format.read(file);
    }
    return Error{"unknown", "", ""};
}

class TraceImport : public testing::Test {
protected:
    Trace loaded(std::string_view bytes, const std::string& name = "trace") {
        auto trace = load_trace(folder_.file(name, bytes));
        EXPECT_TRUE(trace.ok()) << (trace.ok() ? "" : trace.error().message());
        return trace.ok() ? std::move(*trace) : Trace{"none", {{0.0, {}}}};
    }
    std::string refused(std::string_view bytes) {
        const std::string path = folder_.file("trace", bytes);
        const auto trace = load_trace(path);
        EXPECT_FALSE(trace.ok());
        if (trace.ok()) return "loaded";
        EXPECT_EQ(trace.error().where, path);
        EXPECT_FALSE(trace.error().mend.empty());
        EXPECT_EQ(trace.error().message().find('\n'), std::string::npos);
        return trace.error().what;
    }

    test::TemporaryFolder folder_;
};

TEST_F(TraceImport, OwnFormatReadsBackBitForBit) {
    const Trace trace = *load_trace("shake");
    const auto path = folder_.path() / "shake.csv";
    ASSERT_TRUE(save_trace(trace, path).ok());
    const auto again = load_trace(path.string());
    ASSERT_TRUE(again.ok());
    EXPECT_TRUE(again->warnings().empty());
    ASSERT_EQ(again->poses().size(), trace.poses().size());
    for (std::size_t i = 0; i < trace.poses().size(); ++i) {
        ASSERT_EQ(again->poses()[i].time_s, trace.poses()[i].time_s);
        ASSERT_EQ(again->poses()[i].world_from_head, trace.poses()[i].world_from_head) << i;
    }
}

TEST_F(TraceImport, SavingWhereNothingCanBeWrittenIsAnError) {
    EXPECT_FALSE(save_trace(*load_trace("still"), folder_.path() / "no" / "such" / "folder.csv").ok());
    EXPECT_FALSE(save_trace(*load_trace("still"), folder_.path()).ok());
}

TEST_F(TraceImport, OwnFormatTakesWindowsLineEndsBlanksAndByteOrderMarks) {
    const Trace trace =
        loaded("\xEF\xBB\xBFtime_s,px_m,py_m,pz_m,qx,qy,qz,qw\r\n0, 1,2 ,3,0,0,0,1\r\n\r\n1,1,2,3,0,0,0,1");
    EXPECT_EQ(trace.poses().size(), 2U);
    EXPECT_EQ(trace.poses()[0].world_from_head.position_m, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_THAT(trace.warnings(), IsEmpty());
}

TEST_F(TraceImport, MendsAndCountsBadRows) {
    std::string text = kHeader;
    for (int i = 0; i < 20; ++i) text += fmt::format("{},0,1.6,0,0,0,0,1\n", 0.01 * i);
    text += "0.21,nan,1.6,0,0,0,0,1\n";
    text += "0.22,0,inf,0,0,0,0,1\n";
    text += "0.23,0,1.6,0,0,0,0,0\n";
    text += "0.24,0,1.6,0,0,0,0,3\n";
    text += "0.20,0,1.6,0,0,0,0,1\n";
    text += "0.24,0,1.6,0,0,0,0,1\n";
    text += "0.25,0,1e30,0,0,0,0,1\n";
    text += "hello\n";
    text += "0.26,0,1.6,0,0,0,0,1,7\n";
    text += "0.75,0,1.6,0,0,0,0,1\n";
    text += "0.76,0,1.6,0,0,";
    const Trace trace = loaded(text);
    EXPECT_EQ(trace.poses().size(), 22U);
    EXPECT_THAT(
        trace.warnings(),
        ElementsAre("the last line is cut short: ignored", "2 of 30 rows dropped: a number is not finite",
                    "1 of 30 rows dropped: no orientation (zero quaternion)",
                    "2 of 30 rows dropped: time does not advance",
                    "1 of 30 rows dropped: a number is beyond all measure",
                    "2 of 30 rows dropped: not a row of numbers", "1 quaternions were not of unit length: normalised",
                    "1 gap without samples, the longest 0.510 s at 0.240 s: the pose glides across"));
    EXPECT_EQ(trace.at(0.24).orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST_F(TraceImport, RefusesWhatIsMostlyBad) {
    EXPECT_EQ(refused(kHeader), "no usable pose in the trace (it has no rows)");
    EXPECT_EQ(refused(kHeader + "0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0\n"),
              "no usable pose in the trace (no orientation (zero quaternion))");
    EXPECT_EQ(refused(kHeader + "9,0,0,0,0,0,0,1\n8,0,0,0,0,0,0,1\n7,0,0,0,0,0,0,1\n6,0,0,0,0,0,0,1\n"),
              "3 of 4 rows of the trace are unusable (first: time does not advance)");
}

TEST_F(TraceImport, RefusesWhatIsNoTrace) {
    EXPECT_EQ(refused(""), "the trace file is empty");
    EXPECT_EQ(refused("hello\n"), "not a head trace in a known format");
    EXPECT_EQ(refused(std::string(5000, '\0')), "not a head trace in a known format");
    EXPECT_EQ(refused("\x89PNG\r\n\x1a\n\x7f\x80\xff"), "not a head trace in a known format");
    EXPECT_EQ(refused("1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n"), "not a head trace in a known format");
    EXPECT_EQ(refused(std::string(100'000, ',')), "not a head trace in a known format");

    EXPECT_FALSE(load_trace(folder_.path().string()).ok()) << "a directory";
    const auto missing = load_trace("jog");
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().message(),
              "no such trace: jog: give a file or one of still, look-around, walk, shake, dive");
}

constexpr std::string_view kEyeHeader =
    "ViewIndex,FOV1,FOV2,FOV3,FOV4,PositionX,PositionY,PositionZ,QuaternionX,QuaternionY,QuaternionZ,QuaternionW,"
    "GazePosX,GazePosY,GazePosZ,GazeQX,GazeQY,GazeQZ,GazeQW,Timestamp\n";

std::string eye_row(int view, double x, double y, double z, const glm::dquat& q, int time_ms) {
    return fmt::format("{},-0.9,0.7,-0.9,0.7,{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},0,0,0,0,0,0,1,{}\n", view, x, y, z,
                       q.x, q.y, q.z, q.w, time_ms);
}

TEST_F(TraceImport, EyenavgsPairsBothEyesAndStandsTheSceneUpright) {
    const glm::dquat upright_from_scene = glm::angleAxis(-0.4, glm::dvec3{1.0, 0.0, 0.0});
    // A head that stands upright in the room, 1.5 m up, in a scene of half a unit per metre.
    const glm::dquat in_scene = glm::conjugate(upright_from_scene);
    const glm::dvec3 at = glm::conjugate(upright_from_scene) * glm::dvec3{0.0, 1.5, 0.0} * 0.5;
    const std::string rows =
        eye_row(0, at.x - 0.015, at.y, at.z, in_scene, 1000) + eye_row(1, at.x + 0.015, at.y, at.z, in_scene, 1004) +
        eye_row(0, at.x, at.y, at.z, in_scene, 1014) + eye_row(0, at.x - 0.015, at.y, at.z, in_scene, 1028) +
        eye_row(1, at.x + 0.015, at.y, at.z, in_scene, 1040);
    const std::string setting =
        fmt::format("\xEF\xBB\xBFScene_Name,Quaternion,Scale,Initial_Position\nlab,\"{}, 0, 0, {}\",0.5,\"0,1,2\"\n",
                    upright_from_scene.x, upright_from_scene.w);
    // The data set keeps its settings two folders above the recordings.
    (void)folder_.file("scene_setting.csv", setting);
    const Trace trace = loaded(std::string{kEyeHeader} + rows, "dataset/lab/user1_lab.csv");
    ASSERT_EQ(trace.poses().size(), 2U);
    EXPECT_THAT(trace.warnings(), ElementsAre("1 of 3 rows dropped: one eye without the other"));
    EXPECT_NEAR(trace.duration_s(), 0.028, 1e-12);
    // Numbers have six decimals in the file, and the scene doubles them.
    EXPECT_LE(glm::length(trace.at(0.0).position_m - glm::dvec3(0.0, 1.5, 0.0)), 4e-6);
    EXPECT_LE(angle_between_rad(trace.at(0.0).orientation, glm::dquat(1.0, 0.0, 0.0, 0.0)), 4e-6);
}

TEST_F(TraceImport, EyenavgsWithoutItsSceneIsUprightWithOneWarning) {
    const glm::dquat q{1.0, 0.0, 0.0, 0.0};
    const std::string text =
        std::string{kEyeHeader} + eye_row(0, -0.03, 1.0, 0.0, q, 0) + eye_row(1, 0.03, 1.0, 0.0, q, 4);
    EXPECT_THAT(loaded(text, "a/b/c/user1_moon.csv").warnings(),
                ElementsAre("no scene_setting.csv near the recording: taken as upright with scale 1"));
    for (const char* row : {"lab,\"0,0,0,1\",1,\"0,0,0\"\n", "moon,\"0,0,0,0\",1,\"0,0,0\"\n",
                            "moon,\"0,0,0,1\",0,\"\"\n", "moon,\"0,0,1\",1,\"\"\n", "moon\n", "moon,\"0,0,0,1"}) {
        (void)folder_.file("a/b/c/scene_setting.csv",
                           std::string{"Scene_Name,Quaternion,Scale,Initial_Position\n"} + row);
        const Trace trace = loaded(text, "a/b/c/user1_moon.csv");
        EXPECT_THAT(trace.warnings(),
                    ElementsAre("scene 'moon' is not in scene_setting.csv: taken as upright with scale 1"));
        EXPECT_EQ(trace.at(0.0).position_m, glm::dvec3(0.0, 1.0, 0.0));
    }
}

TEST_F(TraceImport, EyenavgsTellsWhatEachEyeSees) {
    const glm::dquat q{1.0, 0.0, 0.0, 0.0};
    const std::string both = eye_row(0, -0.03, 1.0, 0.0, q, 0) + eye_row(1, 0.03, 1.0, 0.0, q, 4);
    const Trace trace = loaded(std::string{kEyeHeader} + both, "user1_moon.csv");
    ASSERT_TRUE(trace.eye_fovs().has_value());
    for (const FovTangents& fov : *trace.eye_fovs()) {
        EXPECT_EQ(fov, (FovTangents{std::tan(-0.9), std::tan(0.7), std::tan(-0.9), std::tan(0.7)}));
    }
    EXPECT_EQ(trace.placed_at({}, 0.0).eye_fovs(), trace.eye_fovs());
}

TEST_F(TraceImport, EyenavgsWithoutUsableFieldsOfViewHasNone) {
    const std::string bad_rows[] = {"0,-0.9,0.7,-0.9,1.6,", "0,-0.9,0.7,x,0.7,", "0,0.9,-0.7,-0.9,0.7,"};
    for (const std::string& bad : bad_rows) {
        const std::string rest = "0,1,0,0,0,0,1,0,0,0,0,0,0,1,";
        const Trace trace =
            loaded(std::string{kEyeHeader} + bad + rest + "0\n1" + bad.substr(1) + rest + "4\n", "user1_moon.csv");
        EXPECT_EQ(trace.poses().size(), 1U) << bad;
        EXPECT_FALSE(trace.eye_fovs().has_value()) << bad;
    }
    EXPECT_FALSE(Trace("plain", {{0.0, {}}}).eye_fovs().has_value());
}

TEST_F(TraceImport, QuestsetFindsTheHeadByColumnNameWithWFirst) {
    const Trace trace = loaded(
        "Buttons,time,HeadPosX,HeadPosY,HeadPosZ,HeadOrientationW,HeadOrientationX,HeadOrientationY,"
        "HeadOrientationZ\r\n"
        "0,0.5,0.1,0.2,0.3,0.8,0.6,0,0\r\n0,0.6,0.1,0.2,0.4,0.8,0,0.6,0\r\n");
    ASSERT_EQ(trace.poses().size(), 2U);
    EXPECT_EQ(trace.at(0.0), (Pose{{0.1, 0.2, 0.3}, {0.8, 0.6, 0.0, 0.0}}));
}

// Unity looks along +Z and turns left-handed: forward, left and up must come out as they were felt.
TEST_F(TraceImport, UnityAxesAreMirrored) {
    const double s = std::sin(0.25);
    const double c = std::cos(0.25);
    const std::string stamp = "2024,1,31,13,54,56,574,";
    std::string text;
    // Turned right by 0.5 rad about Unity's +Y (left-handed: positive turns right), moved 1 m forward and 2 m right.
    text += fmt::format("638423096965740160,638423060965740250,{}2,1.7,1,0,{},0,{}\n", stamp, s, c);
    // Looking down by 0.5 rad: positive about Unity's +X.
    text += fmt::format("638423096965880660,638423060965880740,{}0,1.7,0,{},0,0,{}\n", stamp, s, c);
    text += "638423096965880660,638423060966000000,2024,1";
    const Trace trace = loaded(text);
    ASSERT_EQ(trace.poses().size(), 2U);
    EXPECT_THAT(trace.warnings(), ElementsAre("the last line is cut short: ignored"));
    EXPECT_NEAR(trace.duration_s(), 0.0140490, 1e-12) << "ticks of 100 ns";
    EXPECT_EQ(trace.poses()[0].world_from_head.position_m, glm::dvec3(2.0, 1.7, -1.0));
    const glm::dvec3 forward{0.0, 0.0, -1.0};
    EXPECT_NEAR(heading_rad(trace.poses()[0].world_from_head.orientation), -0.5, 1e-12) << "right is negative yaw";
    EXPECT_NEAR((trace.poses()[1].world_from_head.orientation * forward).y, -std::sin(0.5), 1e-12);
}

/// Builds bags of format 2.0, just enough of it.
class BagWriter {
public:
    static std::string field(const std::string& name, const std::string& value) { return counted(name + "=" + value); }
    static std::string record(const std::string& header, const std::string& data) {
        return counted(header) + counted(data);
    }
    static std::string connection(std::uint32_t id, const std::string& topic, const std::string& type) {
        return record(field("op", "\x07") + field("conn", raw(id)) + field("topic", topic),
                      field("topic", topic) + field("type", type));
    }
    static std::string pose_message(std::uint32_t connection_id, std::uint32_t seconds, std::uint32_t nanoseconds,
                                    double x) {
        std::string data = raw(std::uint32_t{7}) + raw(seconds) + raw(nanoseconds) + counted("world");
        for (const double v : {x, 1.7, 0.5, 0.0, 0.0, 0.0, 1.0}) data += raw(v);
        return record(field("op", "\x02") + field("conn", raw(connection_id)), data);
    }
    static std::string chunk(const std::string& records, const std::string& compression = "none") {
        return record(field("op", "\x05") + field("compression", compression), records);
    }
    template <class T>
    static std::string raw(T value) {
        std::string bytes(sizeof(T), '\0');
        std::memcpy(bytes.data(), &value, sizeof(T));
        return bytes;
    }
    static std::string counted(const std::string& bytes) {
        return raw(static_cast<std::uint32_t>(bytes.size())) + bytes;
    }
};

const std::string kMagic = "#ROSBAG V2.0\n";
const std::string kPose = "geometry_msgs/PoseStamped";

TEST_F(TraceImport, BagGivesTheFirstPoseTopic) {
    using B = BagWriter;
    const std::string bag =
        kMagic +
        B::chunk(B::connection(3, "/clock", "rosgraph_msgs/Clock") + B::connection(4, "/head", kPose) +
                 B::pose_message(4, 1705504375, 999999999, 0.25) + B::connection(5, "/hand", kPose) +
                 B::pose_message(5, 1705504376, 1, 9.0)) +
        B::chunk(B::pose_message(4, 1705504376, 8333333, 0.5)) + B::connection(4, "/head", kPose);
    const Trace trace = loaded(bag);
    ASSERT_EQ(trace.poses().size(), 2U);
    EXPECT_THAT(trace.warnings(), ElementsAre("topic /hand ignored, /head came first"));
    EXPECT_EQ(trace.poses()[1].time_s, 8333334e-9) << "no digit lost at 1.7e9 s";
    EXPECT_EQ(trace.poses()[1].world_from_head.position_m, glm::dvec3(0.5, 1.7, 0.5));
    // The marker body faces +Z.
    EXPECT_LE(glm::length(trace.at(0.0).orientation * glm::dvec3(0.0, 0.0, -1.0) - glm::dvec3(0.0, 0.0, 1.0)), 1e-15);
}

TEST_F(TraceImport, BagsThatCannotBeReadSayWhy) {
    using B = BagWriter;
    EXPECT_EQ(refused(kMagic), "the bag has no geometry_msgs/PoseStamped topic");
    EXPECT_EQ(refused(kMagic + B::chunk("xyz", "lz4")), "bag with lz4 compression");
    EXPECT_EQ(refused(kMagic + B::chunk(B::connection(1, "/head", kPose))),
              "no usable pose in the trace (it has no rows)");
    EXPECT_EQ(refused(kMagic + std::string(64, '\xFF')), "the bag has no geometry_msgs/PoseStamped topic");
}

TEST_F(TraceImport, CutBagsGiveWhatIsWhole) {
    using B = BagWriter;
    const std::string bag = kMagic + B::chunk(B::connection(1, "/head", kPose) + B::pose_message(1, 10, 0, 0.0)) +
                            B::chunk(B::pose_message(1, 11, 0, 1.0));
    for (std::size_t cut = kMagic.size(); cut < bag.size(); ++cut) {
        const auto trace = read_from_memory(std::string_view{bag}.substr(0, cut));
        if (trace.ok()) {
            EXPECT_EQ(trace->poses().size(), 1U) << cut;
        }
    }
}

TEST_F(TraceImport, ExtractedPosesKeepTheirNanoseconds) {
    const Trace trace = loaded(
        "t_s,x,y,z,qx,qy,qz,qw\n1705504375.999999999,0.25,1.7,0.5,0,0,0,1\n"
        "1705504376.008333333,0.5,1.7,0.5,0,0,0,1\n");
    ASSERT_EQ(trace.poses().size(), 2U);
    EXPECT_EQ(trace.poses()[1].time_s, 8333334e-9);
}

// Any byte of any format may be broken: whatever comes, it is a trace or one error, and nothing is read out of bounds
// (which the address sanitizer watches over).
TEST_F(TraceImport, SurvivesBrokenBytes) {
    using B = BagWriter;
    const glm::dquat q{1.0, 0.0, 0.0, 0.0};
    const std::string good[] = {
        kHeader + "0,0,1.6,0,0,0,0,1\n0.1,0,1.6,0,0,0,0,1\n",
        std::string{kEyeHeader} + eye_row(0, 0.0, 1.0, 0.0, q, 0) + eye_row(1, 0.06, 1.0, 0.0, q, 4),
        "638423096965740160,638423060965740250,2024,1,31,13,54,56,574,0,1.7,0,0,0,0,1\n",
        kMagic + B::chunk(B::connection(1, "/head", kPose) + B::pose_message(1, 10, 0, 0.0)),
    };
    for (const std::string& text : good) {
        for (std::size_t i = 0; i < text.size(); ++i) {
            for (const char broken : {'\0', '\xFF', '"', ',', '\n', '9'}) {
                std::string bytes = text;
                bytes[i] = broken;
                const auto trace = read_from_memory(bytes);
                EXPECT_TRUE(trace.ok() || !trace.error().what.empty());
            }
        }
    }
}

}  // namespace
}  // namespace lw
