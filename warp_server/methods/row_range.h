#pragma once
/// Bands of image rows.

namespace lw {

/// Half-open range of image rows.
struct RowRange {
    int begin = 0;
    int end = 0;
};

}  // namespace lw
