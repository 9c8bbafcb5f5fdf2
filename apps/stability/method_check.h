#pragma once
/// Compares the picture of a warp method with what it must show.

#include <cstdint>
#include <string>
#include <string_view>

#include "apps/stability/picture_oracle.h"
#include "warp_server/warp_method.h"

namespace lw::stability {

/// The largest error of one kind and where it was.
struct WorstError {
    double value = 0.0;
    std::uint64_t seed = 0;
    int x = 0;
    int y = 0;

    void take(double error, std::uint64_t of_seed, int at_x, int at_y) {
        if (error <= value) return;
        *this = {error, of_seed, at_x, at_y};
    }
    void take(const WorstError& other) {
        if (other.value > value) *this = other;
    }
};

/// What was found wrong, over any number of pictures.
struct MethodErrors {
    std::uint64_t cases = 0;
    std::uint64_t faulty_cases = 0;  ///< with a pixel that one of the four counts below counted
    std::uint64_t pixels = 0;        ///< compared
    WorstError place_px;             ///< distance from where it belongs, target pixels, beyond what the pixel can tell
    WorstError depth;                ///< relative
    std::uint64_t wrong_surface = 0;
    std::uint64_t missing = 0;   ///< holes where a surface must be
    std::uint64_t invented = 0;  ///< shown where nothing is
    std::uint64_t unusable = 0;  ///< depth that is no depth, in a reached pixel
    WorstError first_fault;      ///< value 1: a pixel that one of the four counts above counted

    [[nodiscard]] std::uint64_t faults() const { return wrong_surface + missing + invented + unusable; }
    void add(const MethodErrors& other);
};

/// How a method shows its source, and so what its pictures can be asked.
enum class MethodKind : std::uint8_t {
    points,      ///< source pixels as they are: a point must touch the pixel that shows it
    squares,     ///< the same with GL's points: as high as wide, and clipped with their centres
    lattice,     ///< bilinear reads at an exact place: the colour tells the place
    turned,      ///< the same, blind to translation and movers
    unturned,    ///< the same, blind to rotation too
    sheets,      ///< as lattice, but with rubber sheets between surfaces, which hide what they please
    fixed_point  ///< a search of some steps, which the check repeats exactly
};
/// Kind of a method by its name in the registry, without settings.
[[nodiscard]] MethodKind kind_of(std::string_view method);

[[nodiscard]] OracleMotion motion_of(MethodKind kind);
[[nodiscard]] CasePattern pattern_of(MethodKind kind);

/// Which samples count: a stretch above this, in target pixels per source pixel, is beyond the promise.
inline constexpr double kLargestStretch = 4.0;
/// And one below this: of 16 x 16 source pixels a target pixel shows one.
inline constexpr double kSmallestStretch = 1.0 / 16.0;

/// `frame` is what a method of that kind made of layer_of(case, pattern_of(kind)), without fill.
[[nodiscard]] MethodErrors check_picture(const PictureOracle& oracle, const Layer& layer, MethodKind kind,
                                         const DisplayFrame& frame);

}  // namespace lw::stability
