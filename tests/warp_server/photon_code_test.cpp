#include "warp_server/photon_code.h"

#include <gtest/gtest.h>

#include <random>

namespace lw {
namespace {

ColourImage grey(glm::ivec2 size_px) { return ColourImage{size_px, Rgba8{90, 120, 200, 255}}; }

TEST(PhotonCode, ComesBackFromThePicture) {
    for (const glm::ivec2& size_px :
         {glm::ivec2{1024, 1024}, glm::ivec2{64, 16}, glm::ivec2{40, 9}, glm::ivec2{16, 4}}) {
        ColourImage picture = grey(size_px);
        for (const PhotonCode code :
             {PhotonCode{}, PhotonCode{1, 2}, PhotonCode{0xFFFFFFFF, 0xFFFF}, PhotonCode{0x12345678, 0x9ABC}}) {
            ASSERT_TRUE(write_photon_code(picture, 0, size_px.y, code));
            EXPECT_EQ(read_photon_code(picture, 0, size_px.y), code);
        }
    }
}

TEST(PhotonCode, StripsHaveTheirOwn) {
    ColourImage picture = grey({256, 256});
    for (std::uint32_t strip = 0; strip < 8; ++strip) {
        ASSERT_TRUE(write_photon_code(picture, static_cast<int>(strip) * 32, 32, {100 + strip, 7}));
    }
    for (std::uint32_t strip = 0; strip < 8; ++strip) {
        EXPECT_EQ(read_photon_code(picture, static_cast<int>(strip) * 32, 32), (PhotonCode{100 + strip, 7}));
    }
}

TEST(PhotonCode, CoversItsCornerAndNoMore) {
    ColourImage picture = grey({128, 128});
    ASSERT_TRUE(write_photon_code(picture, 32, 96, {5, 5}));
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const bool inside = x < 64 && y >= 32 && y < 48;
            if (!inside) {
                ASSERT_EQ(picture.at(x, y), (Rgba8{90, 120, 200, 255}));
            }
        }
    }
}

TEST(PhotonCode, APictureWithoutOneHasNone) {
    EXPECT_FALSE(read_photon_code(grey({128, 128}), 0, 128));
    EXPECT_FALSE(read_photon_code(ColourImage({128, 128}, Rgba8{0, 0, 0, 255}), 0, 128));
    EXPECT_FALSE(read_photon_code(ColourImage({128, 128}, Rgba8{255, 255, 255, 255}), 0, 128));
    EXPECT_FALSE(read_photon_code(grey({8, 8}), 0, 8));
    ColourImage small = grey({15, 4});
    EXPECT_FALSE(write_photon_code(small, 0, 4, {1, 1}));
    EXPECT_EQ(small.at(0, 0), (Rgba8{90, 120, 200, 255}));
}

TEST(PhotonCode, AWrongCellIsNoticed) {
    for (int cell = 0; cell < 64; ++cell) {
        ColourImage picture = grey({64, 16});
        ASSERT_TRUE(write_photon_code(picture, 0, 16, {123456, 789}));
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 4; ++x) {
                Rgba8& pixel = picture.at(cell % 16 * 4 + x, cell / 16 * 4 + y);
                pixel.g = static_cast<std::uint8_t>(255 - pixel.g);
            }
        }
        EXPECT_FALSE(read_photon_code(picture, 0, 16)) << cell;
    }
}

// One in 65536 random pictures passes the check by chance.
TEST(PhotonCode, NoiseIsNoCode) {
    std::mt19937 random{1};
    int read = 0;
    for (int i = 0; i < 2000; ++i) {
        ColourImage picture{{16, 4}};
        for (Rgba8& pixel : picture.pixels()) pixel.g = static_cast<std::uint8_t>(random());
        if (read_photon_code(picture, 0, 4)) ++read;
    }
    EXPECT_LE(read, 1);
}

}  // namespace
}  // namespace lw
