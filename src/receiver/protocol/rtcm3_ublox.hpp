/// RTCM 3 message 4072, which is u-blox's own: 4072.0, the PVT of a reference station that may move, and 4072.1, more
/// about its observations. Nobody has published their layouts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::inline receiver {

/// What 4072.1 begins with in captures of ZED-F9P and ZED-F9T, whose 1077 have the same time of week: number, subtype,
/// station, 12 bits of zero, 4 that are 1 or 2, 30 of time, 14 of zero. 4072.0 is written with it, too.
struct Rtcm3UbloxHead {
    int station = 0;          ///< DF003
    int kind = 1;             ///< 1, and 2 once; what it means is not known
    std::uint32_t epoch = 0;  ///< ms of the GPS week, as DF004
    bool operator==(const Rtcm3UbloxHead&) const = default;
};

/// 4072.0. Behind the head the layout is skyloop's own: no real receiver reads or writes it. Number, subtype and
/// station are as of real ones.
struct Rtcm3MovingStation {
    Rtcm3UbloxHead head;
    std::array<std::int64_t, 3> position{};   ///< ECEF, 0.1 mm; ±13 743 895 m fit
    std::array<std::int32_t, 3> velocity{};   ///< ECEF, mm/s; ±8388 m/s fit
    std::uint32_t position_deviation_mm = 0;  ///< 3D, 1 σ; 1 048 575 at most
    std::uint32_t velocity_deviation = 0;     ///< 3D, 1 σ, mm/s; 1 048 575 at most
    bool operator==(const Rtcm3MovingStation&) const = default;
};
std::optional<Rtcm3MovingStation> decode_moving_station(const Rtcm3Message& message);
Bytes encode(const Rtcm3MovingStation& station);

/// 4072.1, as captures have it: a count and, for each band of each system, a number and its deviation. The systems'
/// times against that of one of them, it seems: of one system and band they are zero.
struct Rtcm3StationBiases {
    struct Bias {
        std::uint8_t system = 0;      ///< u-blox's gnssId: 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
        std::uint8_t band = 0;        ///< 0 … 3
        std::int16_t offset = 0;      ///< its unit is not known
        std::uint16_t deviation = 0;  ///< of the same unit
        bool operator==(const Bias&) const = default;
    };
    Rtcm3UbloxHead head;
    std::vector<Bias> biases;  ///< 168 at most
    bool operator==(const Rtcm3StationBiases&) const = default;
};
/// Nothing for other messages, and ones whose length is not that of their count.
std::optional<Rtcm3StationBiases> decode_station_biases(const Rtcm3Message& message);
/// Those beyond the most are left out.
Bytes encode(const Rtcm3StationBiases& biases);

}  // namespace skyloop::inline receiver
