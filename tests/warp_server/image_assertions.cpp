#include "tests/warp_server/image_assertions.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/image_io.h"

namespace lw::test {
namespace {

int largest_channel_difference(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(int{a.r} - int{b.r}), std::abs(int{a.g} - int{b.g}), std::abs(int{a.b} - int{b.b})});
}

// Eight times enlarged around mid grey, so that a difference of one step can be seen.
ColourImage difference_image(const ColourImage& a, const ColourImage& b) {
    ColourImage result{a.size_px()};
    const auto enlarged = [](int from, int to) {
        return static_cast<std::uint8_t>(std::clamp(128 + 8 * (from - to), 0, 255));
    };
    for (std::size_t i = 0; i < result.pixels().size(); ++i) {
        const Rgba8 pa = a.pixels()[i];
        const Rgba8 pb = b.pixels()[i];
        result.pixels()[i] = {enlarged(pa.r, pb.r), enlarged(pa.g, pb.g), enlarged(pa.b, pb.b), 255};
    }
    return result;
}

void write_pictures(const std::string& name, const ColourImage& actual, const ColourImage& expected) {
    const std::filesystem::path folder{LW_TEST_OUTPUT_DIR};
    std::filesystem::create_directories(folder);
    (void)write_png(folder / (name + ".actual.png"), actual);
    (void)write_png(folder / (name + ".expected.png"), expected);
    (void)write_png(folder / (name + ".difference.png"), difference_image(actual, expected));
}

}  // namespace

::testing::AssertionResult images_agree(const std::string& name, const ColourImage& actual, const ColourImage& expected,
                                        int tolerance, double allowed_share) {
    if (actual.size_px() != expected.size_px()) return ::testing::AssertionFailure() << name << ": sizes differ";
    std::size_t wrong = 0;
    std::size_t first_wrong = 0;
    for (std::size_t i = 0; i < actual.pixels().size(); ++i) {
        if (largest_channel_difference(actual.pixels()[i], expected.pixels()[i]) <= tolerance) continue;
        if (wrong++ == 0) first_wrong = i;
    }
    const double share =
        static_cast<double>(wrong) / static_cast<double>(std::max<std::size_t>(1, actual.pixels().size()));
    if (share <= allowed_share) return ::testing::AssertionSuccess();
    write_pictures(name, actual, expected);
    const auto width = static_cast<std::size_t>(actual.width());
    return ::testing::AssertionFailure() << name << ": " << wrong << " pixels (" << 100.0 * share
                                         << " %) differ by more than " << tolerance << ", first at ("
                                         << first_wrong % width << ", " << first_wrong / width << "); pictures in "
                                         << LW_TEST_OUTPUT_DIR;
}

::testing::AssertionResult shows_source_exactly(const std::string& name, const DisplayFrame& frame,
                                                const CpuPixels& source) {
    ::testing::AssertionResult colour = images_agree(name, frame.colour, source.colour, 0);
    if (!colour) return colour;
    for (std::size_t i = 0; i < source.depth.pixels().size(); ++i) {
        if (frame.depth.pixels()[i] != source.depth.pixels()[i] || frame.coverage.pixels()[i] != Coverage::reached) {
            return ::testing::AssertionFailure() << name << ": depth or coverage differs at pixel " << i << ": "
                                                 << frame.depth.pixels()[i] << " against " << source.depth.pixels()[i];
        }
    }
    return ::testing::AssertionSuccess();
}

double masked_psnr_db(const ColourImage& a, const ColourImage& b, const Image<std::uint8_t>& mask) {
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        if (mask.pixels()[i] == 0) continue;
        const Rgba8 pa = a.pixels()[i];
        const Rgba8 pb = b.pixels()[i];
        const double dr = pa.r - pb.r;
        const double dg = pa.g - pb.g;
        const double db = pa.b - pb.b;
        squares += dr * dr + dg * dg + db * db;
        count += 3.0;
    }
    if (squares == 0.0) return 99.0;
    return 10.0 * std::log10(255.0 * 255.0 * count / squares);
}

}  // namespace lw::test
