/// Navigation messages as they are received.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// One subframe, string or page of one signal, in words as a u-blox receiver hands them out (RXM-SFRBX).
struct Subframe {
    SatelliteId satellite;
    Signal signal = Signal::l1;
    GpsTime end;                ///< when its last bit was sent
    int frequency_channel = 0;  ///< of GLONASS
    std::vector<std::uint32_t> words;
    std::optional<Ephemeris> record{};  ///< that is whole with this part: the others were received before it
};

}  // namespace skyloop
