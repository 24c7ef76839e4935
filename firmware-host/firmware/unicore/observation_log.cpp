// OBSVMA and OBSVMB.
#include <cmath>
#include <cstdint>
#include <optional>

#include "firmware/unicore/log_parts.hpp"
#include "firmware/unicore/logs.hpp"

namespace skyloop::firmware {
namespace {

// Numbers of signals in the tracking status (rtklibexplorer/RTKLIB, src/rcv/unicore.c, sig2code()).
std::uint32_t unicore_signal(Constellation system, Signal signal) {
    switch (signal) {
        case Signal::l1:
            return system == Constellation::galileo ? 2 : system == Constellation::beidou ? 8 : 0;
        case Signal::l2:
        case Signal::e5b:
            return 17;
        case Signal::l5:
            if (system == Constellation::gps || system == Constellation::qzss) return 14;
            return system == Constellation::navic ? 6 : 12;
        case Signal::e6:
            return 22;
        case Signal::b1i:
        case Signal::g1:
            return 0;
        case Signal::b3i:
            return 21;
        case Signal::g2:
            return 5;
    }
    return 0;
}

std::uint32_t unicore_system(Constellation system) {
    switch (system) {
        case Constellation::gps:
            return 0;
        case Constellation::glonass:
            return 1;
        case Constellation::sbas:
            return 2;
        case Constellation::galileo:
            return 3;
        case Constellation::beidou:
            return 4;
        case Constellation::qzss:
            return 5;
        case Constellation::navic:
            return 6;
    }
    return 0;
}

// As captured of signals that are locked: 1 of bits 10 to 12 and 29, 3 of bits 0 to 4 and 19 to 20.
std::uint32_t tracking_status(const Observation& o, std::uint32_t channel) {
    constexpr std::uint32_t always = 3u | 3u << 19, phase = 1u << 10 | 1u << 11 | 1u << 29, code = 1u << 12;
    std::uint32_t status = always | (channel & 31u) << 5 | unicore_system(o.satellite.constellation) << 16 |
                           unicore_signal(o.satellite.constellation, o.signal) << 21;
    if (o.carrier_phase) status |= phase;
    if (o.pseudorange) status |= code;
    return status;
}

UnicoreObservation unicore_observation(const Observation& o, std::uint32_t channel) {
    constexpr double unlocked_adr_std = 0.16;
    const bool glonass = o.satellite.constellation == Constellation::glonass;
    UnicoreObservation out;
    if (glonass) {
        const bool first = o.signal == Signal::g1;
        const double base = first ? 1602.0e6 : 1246.0e6, step = first ? 0.5625e6 : 0.4375e6;
        out.glonass_channel = nearest<std::uint16_t>((o.carrier.value() - base) / step + 7);
    }
    const bool offset =
        glonass || o.satellite.constellation == Constellation::qzss || o.satellite.constellation == Constellation::sbas;
    out.prn = offset ? unicore_prn(o.satellite) : static_cast<std::uint16_t>(o.satellite.number);
    if (o.pseudorange) out.pseudorange = o.pseudorange->value();
    if (o.carrier_phase) out.adr = -*o.carrier_phase;
    out.pseudorange_std.set(o.pseudorange_deviation.value());
    out.adr_std.set(o.carrier_phase ? o.carrier_phase_deviation : unlocked_adr_std);
    if (o.doppler) out.doppler = static_cast<float>(o.doppler->value());
    out.cn0.set(o.cn0.value());
    out.lock = o.carrier_phase ? static_cast<float>(o.lock_time.value()) : 0.0F;
    out.tracking = tracking_status(o, channel);
    return out;
}

}  // namespace

UnicoreObsVm unicore_obs_vm(const ReportContext& context) {
    UnicoreObsVm log;
    std::uint32_t channel = 0;
    std::optional<SatelliteId> last;
    for (const Observation& o : context.state.epoch.observations.signals) {
        if (last != o.satellite) ++channel;
        last = o.satellite;
        log.observations.push_back(unicore_observation(o, channel));
    }
    log.count = static_cast<std::uint32_t>(log.observations.size());
    return log;
}

}  // namespace skyloop::firmware
