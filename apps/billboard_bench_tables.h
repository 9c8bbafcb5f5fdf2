#pragma once
/// The tables of the suite `billboards`.

#include <string>
#include <vector>

#include "apps/billboard_bench_figures.h"

namespace lw {

/// The first one holds the titles of the columns.
using TableRows = std::vector<std::vector<std::string>>;

struct BenchTable {
    std::string heading;
    TableRows rows;
};

/// Two columns: the name of a figure and its value. Pure.
[[nodiscard]] TableRows figure_rows(const BillboardFigures& figures);

/// All others, in their order on the page. Pure.
[[nodiscard]] std::vector<BenchTable> tables_of(const BillboardBench& bench);

}  // namespace lw
