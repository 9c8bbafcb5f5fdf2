#include <array>
#include <bit>
#include <cstring>
#include <map>

#include "frame_link/trace_formats.h"
#include "frame_link/trace_rows.h"

// Bag format 2.0: http://wiki.ros.org/Bags/Format/2.0. A magic line, then records of a header (fields NAME=VALUE, each
// with its length) and data (with its length), all little-endian. Messages lie in chunks, which are records in a row.
namespace lw {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in the file");

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::string_view kPoseType = "geometry_msgs/PoseStamped";

enum class Op : std::uint8_t { kMessage = 2, kChunk = 5, kConnection = 7 };

/// Takes numbers and byte ranges off the front of a range; once something did not fit, everything after it is empty.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : rest_{bytes} {}

    template <class T>
    T number() {
        T value{};
        const std::string_view raw = bytes(sizeof(T));
        if (failed_) return value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }
    std::string_view bytes(std::size_t count) {
        if (count > rest_.size()) failed_ = true;
        if (failed_) return {};
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }
    /// Bytes behind a 32-bit count of them.
    std::string_view counted_bytes() { return bytes(number<std::uint32_t>()); }

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] bool at_end() const { return failed_ || rest_.empty(); }

private:
    std::string_view rest_;
    bool failed_ = false;
};

struct Record {
    std::string_view header;
    std::string_view data;
};

std::string_view field(std::string_view header, std::string_view name) {
    ByteReader reader{header};
    while (!reader.at_end()) {
        const std::string_view pair = reader.counted_bytes();
        const std::size_t equals = pair.find('=');
        if (equals != std::string_view::npos && pair.substr(0, equals) == name) return pair.substr(equals + 1);
    }
    return {};
}

template <class T>
std::optional<T> number_field(std::string_view header, std::string_view name) {
    ByteReader reader{field(header, name)};
    const T value = reader.number<T>();
    return reader.failed() ? std::nullopt : std::optional{value};
}

// The tracked body is the markers on the headset, whose frame the motion-capture system sets up with +Z forward and +X
// to the left: in the recording it moves as a point 10 cm above and 7 cm along +Z of the joint the
// head turns on (least squares of velocity against turn rate), and eyes lie before that joint. So the head is the body
// turned about +Y.
Pose world_from_head(const Pose& world_from_body) {
    const glm::dquat body_from_head{0.0, 0.0, 1.0, 0.0};
    return {world_from_body.position_m, world_from_body.orientation * body_from_head};
}

struct StampedPose {
    std::int64_t stamp_ns = 0;
    Pose pose;
};

// std_msgs/Header {uint32 seq, time stamp {uint32 secs, nsecs}, string frame_id}, then position x y z and orientation
// x y z w as doubles.
std::optional<StampedPose> parse_pose_stamped(std::string_view message) {
    ByteReader reader{message};
    reader.number<std::uint32_t>();
    const auto seconds = reader.number<std::uint32_t>();
    const auto nanoseconds = reader.number<std::uint32_t>();
    reader.counted_bytes();
    std::array<double, 7> v{};
    for (double& value : v) value = reader.number<double>();
    if (reader.failed()) return std::nullopt;
    return StampedPose{std::int64_t{seconds} * 1'000'000'000 + nanoseconds,
                       Pose{{v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}}};
}

/// Walks through a bag and keeps the poses of its first PoseStamped topic.
class PoseBag {
public:
    /// What keeps the bag from being read, or nothing.
    std::optional<Error> read(std::string_view bag, const std::string& where) {
        ByteReader reader{bag.substr(kMagic.size())};
        while (!reader.at_end()) {
            const Record record{reader.counted_bytes(), reader.counted_bytes()};
            if (reader.failed()) {
                rows_.warn("the bag is cut short: its last record is ignored");
                break;
            }
            if (number_field<Op>(record.header, "op") != Op::kChunk) {
                take(record);
                continue;
            }
            const std::string_view compression = field(record.header, "compression");
            if (compression != "none") {
                return Error{fmt::format("bag with {} compression", compression.substr(0, 16)), where,
                             "run 'rosbag decompress' on it"};
            }
            take_chunk(record.data);
        }
        return std::nullopt;
    }

    TraceRows& rows() { return rows_; }
    [[nodiscard]] bool has_topic() const { return topic_.has_value(); }

private:
    void take_chunk(std::string_view chunk) {
        ByteReader reader{chunk};
        while (!reader.at_end()) {
            const Record record{reader.counted_bytes(), reader.counted_bytes()};
            if (reader.failed()) {
                rows_.warn("a chunk of the bag is cut short");
            } else {
                take(record);
            }
        }
    }

    void take(const Record& record) {
        const auto op = number_field<Op>(record.header, "op");
        const auto connection = number_field<std::uint32_t>(record.header, "conn");
        if (!op || !connection) return;
        if (*op == Op::kConnection) take_connection(*connection, record);
        if (*op == Op::kMessage && is_ours(*connection)) take_message(record.data);
    }

    // Connections are listed where they first appear and once more at the end of the bag.
    void take_connection(std::uint32_t connection, const Record& record) {
        if (field(record.data, "type") != kPoseType) return;
        const std::string topic{field(record.header, "topic")};
        if (!topic_) topic_ = topic;
        const bool is_new = topic_of_.emplace(connection, topic).second;
        if (is_new && topic != *topic_) {
            rows_.warn(fmt::format("topic {} ignored, {} came first", topic, *topic_));
        }
    }

    [[nodiscard]] bool is_ours(std::uint32_t connection) const {
        const auto found = topic_of_.find(connection);
        return found != topic_of_.end() && found->second == *topic_;
    }

    void take_message(std::string_view message) {
        const auto stamped = parse_pose_stamped(message);
        if (!stamped) return rows_.drop("not a PoseStamped message");
        if (!first_ns_) first_ns_ = stamped->stamp_ns;
        rows_.add(static_cast<double>(stamped->stamp_ns - *first_ns_) / 1e9, world_from_head(stamped->pose));
    }

    TraceRows rows_;
    std::optional<std::string> topic_;
    std::map<std::uint32_t, std::string> topic_of_;
    std::optional<std::int64_t> first_ns_;
};

}  // namespace

bool is_rosbag_trace(std::string_view text) { return text.substr(0, kMagic.size()) == kMagic; }

Result<Trace> read_rosbag_trace(const TraceFile& file) {
    PoseBag bag;
    if (auto error = bag.read(file.text, file.where())) return std::move(*error);
    if (!bag.has_topic()) {
        return Error{"the bag has no geometry_msgs/PoseStamped topic", file.where(), "record the head as one"};
    }
    return bag.rows().finish(file.name(), file.where());
}

bool is_pose_stamped_csv_trace(std::string_view text) {
    constexpr std::string_view kHeader = "t_s,x,y,z,qx,qy,qz,qw";
    return without_byte_order_mark(text).substr(0, kHeader.size()) == kHeader;
}

Result<Trace> read_pose_stamped_csv_trace(const TraceFile& file) {
    CsvReader csv{file.text};
    csv.next();
    TraceRows rows;
    std::optional<std::int64_t> first_ns;
    read_csv_rows(csv, rows, [&] {
        std::array<double, 8> v{};
        if (csv.fields().size() != v.size()) return false;
        for (std::size_t i = 0; i < v.size(); ++i) {
            const auto number = csv.number(i);
            if (!number) return false;
            v[i] = *number;
        }
        const auto stamp_ns = parse_nanoseconds(csv.fields()[0]);
        if (!stamp_ns) {
            rows.drop("a number is beyond all measure");
            return true;
        }
        if (!first_ns) first_ns = stamp_ns;
        const Pose world_from_body{{v[1], v[2], v[3]}, {v[7], v[4], v[5], v[6]}};
        rows.add(static_cast<double>(*stamp_ns - *first_ns) / 1e9, world_from_head(world_from_body));
        return true;
    });
    return rows.finish(file.name(), file.where());
}

}  // namespace lw
