/// Same input, same bytes: with every instruction set the kernels are built for, with any number of threads, in every
/// run. The bound between instruction sets is 0.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstring>

#include "apps/stability/stability_case.h"
#include "apps/stability/sweep.h"
#include "core/check.h"
#include "warp_server/frame_warper.h"

namespace lw::stability {
namespace {

constexpr std::uint64_t kCases = 40;

// Colour, depth and coverage of a case after warp and fill.
DisplayFrame picture_of(const std::string& method, std::uint64_t seed, CaseRange range) {
    Result<FrameWarper> warper = FrameWarper::create(method, "nearest-background");
    LW_CHECK(warper.ok(), method);
    const StabilityCase made = make_case(seed, range);
    Layer layer = layer_of(made, CasePattern::lattice);
    warper->prepare(layer);  // with the same instructions as the warp
    RenderedFrame frame;
    frame.layers.push_back(std::make_shared<const Layer>(std::move(layer)));
    return warper->warp(frame, {made.target, made.at_target});
}

bool same_bytes(const DisplayFrame& a, const DisplayFrame& b) {
    return a.colour == b.colour && a.coverage == b.coverage && a.depth.size_px() == b.depth.size_px() &&
           std::memcmp(a.depth.pixels().data(), b.depth.pixels().data(), a.depth.size_bytes()) == 0;
}

class SameBytes : public ::testing::TestWithParam<std::string> {
protected:
    void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};
INSTANTIATE_TEST_SUITE_P(All, SameBytes, ::testing::ValuesIn(cpu_methods()));

TEST_P(SameBytes, WithEveryInstructionSet) {
    const std::vector<std::int64_t> sets = hwy::SupportedAndGeneratedTargets();
    for (const CaseRange range : {CaseRange::promised, CaseRange::beyond}) {
        for (std::uint64_t seed = 0; seed < kCases; ++seed) {
            hwy::SetSupportedTargetsForTest(0);
            const DisplayFrame best = picture_of(GetParam(), seed, range);
            for (const std::int64_t set : sets) {
                hwy::SetSupportedTargetsForTest(set);
                ASSERT_TRUE(same_bytes(picture_of(GetParam(), seed, range), best))
                    << hwy::TargetName(set) << ", case " << seed;
            }
        }
    }
}

TEST_P(SameBytes, WithAnyNumberOfThreadsAndInEveryRun) {
    const bool has_threads = GetParam() == "splat" || GetParam() == "surface";
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        const DisplayFrame once = picture_of(GetParam(), seed, CaseRange::promised);
        EXPECT_TRUE(same_bytes(picture_of(GetParam(), seed, CaseRange::promised), once)) << "again, case " << seed;
        if (!has_threads) continue;
        for (const char* threads : {":threads=2", ":threads=3", ":threads=7"}) {
            ASSERT_TRUE(same_bytes(picture_of(GetParam() + threads, seed, CaseRange::promised), once))
                << threads << ", case " << seed;
        }
    }
}

}  // namespace
}  // namespace lw::stability
