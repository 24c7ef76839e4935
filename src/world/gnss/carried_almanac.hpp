/// Orbits of almanacs at another reference time.
#pragma once

#include "world/gnss/ephemeris.hpp"

namespace skyloop {

/// The same orbit and clock, told from another time of reference on: `toe` and `toc` become `time`, and what changes
/// with them is carried along (IS-GPS-200, 20.3.3.4.3.1). Of GPS and QZSS, without harmonic and quadratic terms.
KeplerEphemeris carried_almanac(const KeplerEphemeris& record, GpsTime time);

}  // namespace skyloop
