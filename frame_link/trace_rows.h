#pragma once
/// What every reader of recordings does with its rows: keep the good ones, count the others, say so in warnings.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"
#include "frame_link/csv_reader.h"
#include "frame_link/trace.h"

namespace lw {

/// Collects the rows of one recording in file order. Poses are right-handed, +Y up, in metres, times in seconds.
class TraceRows {
public:
    /// A row as read. It is dropped and counted when a number is not finite or absurd (beyond 1e6 m or 9e9 s), its
    /// quaternion is zero, or its time is not after the row before. Other quaternions are normalised.
    void add(double time_s, const Pose& world_from_head);

    /// A row that the reader itself has to drop; `why` completes "12 of 300 rows dropped: ".
    void drop(std::string_view why);

    /// One more line for the trace's warnings.
    void warn(std::string line) { warnings_.push_back(std::move(line)); }

    /// The trace; an error when no row is left or more than half were dropped. `where` names the file.
    [[nodiscard]] Result<Trace> finish(std::string name, const std::string& where);

private:
    void warn_of_dropped_rows();
    void warn_of_gaps();

    std::vector<TimedPose> poses_;
    std::vector<std::pair<std::string, std::size_t>> dropped_;  ///< reason, count; in order of appearance
    std::size_t row_count_ = 0;
    std::size_t dropped_count_ = 0;
    std::size_t not_unit_count_ = 0;
    std::vector<std::string> warnings_;
};

/// Hands every further line of `csv` to `read_row()` -> bool; a line it refuses is dropped, the last one as cut short
/// (loggers that are killed leave half a line).
template <class ReadRow>
void read_csv_rows(CsvReader& csv, TraceRows& rows, ReadRow read_row) {
    while (csv.next()) {
        if (read_row()) continue;
        if (csv.at_end()) {
            rows.warn("the last line is cut short: ignored");
        } else {
            rows.drop("not a row of numbers");
        }
    }
}

}  // namespace lw
