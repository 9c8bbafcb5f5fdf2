#include "warp_server/methods/key_ring.h"

#include <gtest/gtest.h>

#include "tests/warp_server/allocation_count.h"

namespace lw {
namespace {

TEST(KeyRing, AnyPartOfTheReservedSizeAllocatesNothing) {
    KeyRing keys;
    keys.reserve({300, 200});
    const std::size_t before = test::allocations_on_this_thread();
    for (const int rows : {1, 16, 65, 200}) {
        for (const RowRange columns : {RowRange{0, 300}, RowRange{64, 300}, RowRange{128, 131}}) {
            keys.reshape(columns, rows);
            EXPECT_LE(rows, keys.slots());
            EXPECT_LE(columns.end - columns.begin, keys.stride());
        }
    }
    EXPECT_EQ(test::allocations_on_this_thread(), before);
}

TEST(KeyRing, RowsInFlightDoNotMeet) {
    KeyRing keys;
    keys.reshape({10, 90}, 20);
    for (int y = 100; y < 120; ++y) {
        for (int x = 0; x < keys.width(); ++x) keys.row(y)[x] = static_cast<WinnerKey>(y);
    }
    for (int y = 100; y < 120; ++y) EXPECT_EQ(keys.row(y)[keys.width() - 1], static_cast<WinnerKey>(y));
}

}  // namespace
}  // namespace lw
