#include "receiver/protocol/rtcm3_signals.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::inline receiver {
namespace {

// By the tens of their numbers from 1070 on.
constexpr std::array msm_order{Constellation::gps,  Constellation::glonass, Constellation::galileo, Constellation::sbas,
                               Constellation::qzss, Constellation::beidou,  Constellation::navic};
constexpr int sbas_offset = 19;

struct MsmBand {
    int first, last;
    Signal signal;
};

constexpr std::array gps_bands{MsmBand{2, 4, Signal::l1}, MsmBand{8, 10, Signal::l2}, MsmBand{15, 17, Signal::l2},
                               MsmBand{22, 24, Signal::l5}, MsmBand{30, 32, Signal::l1}};
constexpr std::array galileo_bands{MsmBand{2, 6, Signal::l1}, MsmBand{8, 12, Signal::e6}, MsmBand{14, 16, Signal::e5b},
                                   MsmBand{22, 24, Signal::l5}};
constexpr std::array beidou_bands{MsmBand{2, 4, Signal::b1i}, MsmBand{8, 10, Signal::b3i}, MsmBand{14, 16, Signal::e5b},
                                  MsmBand{22, 24, Signal::l5}, MsmBand{30, 32, Signal::l1}};
constexpr std::array glonass_bands{MsmBand{2, 3, Signal::g1}, MsmBand{8, 9, Signal::g2}};
constexpr std::array navic_bands{MsmBand{22, 22, Signal::l5}};

std::span<const MsmBand> bands_of(Constellation constellation) {
    switch (constellation) {
        case Constellation::galileo:
            return galileo_bands;
        case Constellation::beidou:
            return beidou_bands;
        case Constellation::glonass:
            return glonass_bands;
        case Constellation::navic:
            return navic_bands;
        default:
            return gps_bands;
    }
}

}  // namespace

std::optional<Constellation> msm_constellation(int number) {
    if (!msm_kind(number)) return std::nullopt;
    return msm_order[static_cast<std::size_t>((number - 1070) / 10)];
}

int msm_number(Constellation constellation, int kind) {
    return 1070 + 10 * static_cast<int>(std::ranges::find(msm_order, constellation) - msm_order.begin()) + kind;
}

int msm_satellite(SatelliteId satellite) {
    return satellite.constellation == Constellation::sbas ? satellite.number - sbas_offset : satellite.number;
}

SatelliteId satellite_of_msm(Constellation constellation, int number) {
    return {constellation, constellation == Constellation::sbas ? number + sbas_offset : number};
}

int msm_signal(Constellation constellation, Signal signal) {
    switch (signal) {
        case Signal::l1:
        case Signal::g1:
        case Signal::b1i:
            return constellation == Constellation::beidou && signal == Signal::l1 ? 0 : 2;  // 1C 1C 2I
        case Signal::l2:
            return 16;  // 2L
        case Signal::g2:
        case Signal::b3i:
            return 8;  // 2C 6I
        case Signal::e5b:
            return constellation == Constellation::beidou ? 14 : 15;  // 7I 7Q
        case Signal::l5:
            // 5Q 5P; of SBAS 5I, of NavIC 5A
            return constellation == Constellation::sbas || constellation == Constellation::navic ? 22 : 23;
        default:
            return 0;
    }
}

std::optional<Signal> msm_carrier(Constellation constellation, int number) {
    for (const MsmBand& band : bands_of(constellation))
        if (number >= band.first && number <= band.last) return band.signal;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
