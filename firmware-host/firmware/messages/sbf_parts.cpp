#include "firmware/messages/sbf_parts.hpp"

#include <array>

namespace skyloop::firmware {
namespace {

struct NumberedSignal {
    Constellation constellation;
    Signal signal;
    std::uint8_t number;
};
constexpr std::array numbered_signals{
    NumberedSignal{Constellation::gps, Signal::l1, 0},      NumberedSignal{Constellation::gps, Signal::l2, 3},
    NumberedSignal{Constellation::gps, Signal::l5, 4},      NumberedSignal{Constellation::qzss, Signal::l1, 6},
    NumberedSignal{Constellation::qzss, Signal::l2, 7},     NumberedSignal{Constellation::glonass, Signal::g1, 8},
    NumberedSignal{Constellation::glonass, Signal::g2, 11}, NumberedSignal{Constellation::beidou, Signal::l1, 13},
    NumberedSignal{Constellation::beidou, Signal::l5, 14},  NumberedSignal{Constellation::navic, Signal::l5, 15},
    NumberedSignal{Constellation::galileo, Signal::l1, 17}, NumberedSignal{Constellation::galileo, Signal::e6, 19},
    NumberedSignal{Constellation::galileo, Signal::l5, 20}, NumberedSignal{Constellation::galileo, Signal::e5b, 21},
    NumberedSignal{Constellation::sbas, Signal::l1, 24},    NumberedSignal{Constellation::sbas, Signal::l5, 25},
    NumberedSignal{Constellation::qzss, Signal::l5, 26},    NumberedSignal{Constellation::qzss, Signal::e6, 27},
    NumberedSignal{Constellation::beidou, Signal::b1i, 28}, NumberedSignal{Constellation::beidou, Signal::e5b, 29},
    NumberedSignal{Constellation::beidou, Signal::b3i, 30}};

std::uint32_t signal_bit(Constellation constellation, Signal signal) {
    const auto number = sbf_signal_number(constellation, signal);
    return number ? 1u << *number : 0;
}

}  // namespace

std::optional<std::uint8_t> sbf_signal_number(Constellation constellation, Signal signal) {
    for (const NumberedSignal& candidate : numbered_signals)
        if (candidate.constellation == constellation && candidate.signal == signal) return candidate.number;
    return std::nullopt;
}

std::uint32_t sbf_signal_info(const NavigationState& state) {
    std::uint32_t bits = 0;
    for (const SatelliteStatus& satellite : state.epoch.fix.satellites) {
        if (!satellite.used) continue;
        const Constellation system = satellite.id.constellation;
        std::uint32_t measured = 0;
        for (const Observation& o : state.epoch.observations.signals)
            if (o.satellite == satellite.id && o.pseudorange) measured |= signal_bit(system, o.signal);
        bits |= measured != 0 ? measured : signal_bit(system, first_signal(system));
    }
    return bits;
}

std::uint8_t sbf_channel_number(const NavigationState& state, SatelliteId satellite) {
    std::size_t number = 0;
    for (const SatelliteStatus& candidate : state.epoch.fix.satellites) {
        if (!candidate.cn0 || !sbf_svid(candidate.id) || number == most_items) continue;
        ++number;
        if (candidate.id == satellite) return static_cast<std::uint8_t>(number);
    }
    return 0;
}

std::uint8_t sbf_frequency_number(SatelliteId satellite, const Observations& observations) {
    if (satellite.constellation != Constellation::glonass) return 0;
    for (const Observation& o : observations.signals)
        if (o.satellite == satellite)
            return static_cast<std::uint8_t>(frequency_id(o.satellite, o.signal, o.carrier) + 1);
    return 0;
}

}  // namespace skyloop::firmware
