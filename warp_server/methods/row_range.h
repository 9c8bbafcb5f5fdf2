#pragma once
/// Bands of image rows, and the same of columns.

namespace lw {

/// Half-open range of image rows, or columns.
struct RowRange {
    int begin = 0;
    int end = 0;
};

}  // namespace lw
