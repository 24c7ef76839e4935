#include "receiver/protocol/rtcm3_signals.hpp"

#include <array>
#include <span>

#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::inline receiver {
namespace {

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
    using enum Constellation;
    constexpr std::array systems{gps, glonass, galileo, sbas, qzss, beidou, navic};
    if (!msm_kind(number)) return std::nullopt;
    return systems[static_cast<std::size_t>((number - 1070) / 10)];
}

std::optional<Signal> msm_carrier(Constellation constellation, int number) {
    for (const MsmBand& band : bands_of(constellation))
        if (number >= band.first && number <= band.last) return band.signal;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
