/// The absorption lines of oxygen and water vapour (ITU-R P.676-13, Annex 1, tables 1 and 2).
#pragma once

#include <array>

namespace skyloop {

/// A line at f0 GHz with the parameters a1 … a6 of table 1.
struct OxygenLine {
    double f0, a1, a2, a3, a4, a5, a6;
};
/// A line at f0 GHz with the parameters b1 … b6 of table 2.
struct VapourLine {
    double f0, b1, b2, b3, b4, b5, b6;
};

extern const std::array<OxygenLine, 44> oxygen_lines_p676;
extern const std::array<VapourLine, 35> vapour_lines_p676;

}  // namespace skyloop
