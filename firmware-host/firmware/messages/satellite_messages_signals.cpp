// NAV-SIG (RECEIVER.md 3.1, 5.6).
#include <algorithm>
#include <tuple>

#include "firmware/messages/satellite_parts.hpp"
#include "receiver/protocol/ubx_satellites.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t l5_as_healthy_as_l1 = 0x10320001;  // CFG-SIGNAL-HEALTH_L5

// One signal, from a measurement or from the satellite alone.
struct SignalReport {
    const SatelliteStatus* satellite = nullptr;
    const Observation* observation = nullptr;
    bool second_frequency = false;  // the satellite is measured on two
    bool unhealthy = false;         // though the satellite is not

    [[nodiscard]] bool is_used() const { return satellite->used && !unhealthy; }
};

// GPS says of its L5 that it is not in operation yet. Who wants it all the same overrides that (DAN-F10N integration
// manual, table 3; ArduPilot's driver option "override L5 health").
bool is_unhealthy_l5(const Observation& o, const ConfigStore& config) {
    return o.satellite.constellation == Constellation::gps && o.signal == Signal::l5 &&
           config.has(l5_as_healthy_as_l1) && !config.flag(l5_as_healthy_as_l1);
}

// Bits: 0-1 health, 3-5 range, carrier and Doppler used, 6-8 corrections of them. Captured: 0x29 used, 0x169 with SBAS,
// 0xF9 with carrier phases of a base.
std::uint16_t signal_flags(const SignalReport& signal, const NavigationState& state) {
    unsigned flags = signal.unhealthy ? 2 : satellite_health(*signal.satellite, state);
    const bool range = signal.observation == nullptr || signal.observation->pseudorange.has_value();
    if (!signal.is_used() || !range) return static_cast<std::uint16_t>(flags);
    flags |= 0x28;
    switch (corrections_in_use(state)) {
        case CorrectionOrigin::none:
            break;
        case CorrectionOrigin::sbas:
            flags |= 0x140;
            break;
        case CorrectionOrigin::rtcm3:
            flags |= carrier_solution(state.epoch.fix) != 0 ? 0xD0u : 0x40u;
            break;
    }
    return static_cast<std::uint16_t>(flags);
}

// 0 none, 1 SBAS, 4 RTCM 3 observations.
std::uint8_t correction_source(const SignalReport& signal, const NavigationState& state) {
    if (!signal.is_used()) return 0;
    constexpr std::uint8_t codes[] = {0, 1, 4};
    return codes[static_cast<std::size_t>(corrections_in_use(state))];
}

// 0 none, 1 Klobuchar of GPS, which comes in the page of the leap seconds, 2 SBAS, 8 two frequencies.
std::uint8_t ionosphere_model(const SignalReport& signal, const NavigationState& state) {
    if (!signal.is_used()) return 0;
    switch (corrections_in_use(state)) {
        case CorrectionOrigin::sbas:
            return 2;
        case CorrectionOrigin::rtcm3:
            return 0;
        case CorrectionOrigin::none:
            break;
    }
    if (signal.second_frequency) return 8;
    return almanac_known(state) ? 1 : 0;
}

NavSigItem signal_item(const SignalReport& report, const ReportContext& context) {
    const SatelliteStatus& s = *report.satellite;
    const Observation* o = report.observation;
    const Signal signal = o != nullptr ? o->signal : first_signal(s.id.constellation);
    NavSigItem item;
    item.gnss_id = gnss_id(s.id.constellation);
    item.sv_id = sv_id(s.id);
    item.sig_id = signal_id(s.id, signal, takes_b1c(context.config));
    item.freq_id = frequency_id(s.id, signal, o != nullptr ? o->carrier : carrier_frequency(signal));
    if (s.residual) item.pr_res = field<std::int16_t>(s.residual->value() * 10);
    item.cno = o != nullptr ? field<std::uint8_t>(o->cn0.value()) : cn0_field(s.cn0);
    item.quality = o != nullptr ? signal_quality(*o) : static_cast<std::uint8_t>(satellite_quality(s, context.state));
    item.corr_source = correction_source(report, context.state);
    item.iono_model = ionosphere_model(report, context.state);
    item.flags = signal_flags(report, context.state);
    return item;
}

}  // namespace

std::vector<Bytes> make_signal_message(const ReportContext& context) {
    NavSig m;
    m.i_tow = epoch_time(reported_time(context).time).i_tow;
    const auto& measured = context.state.epoch.observations.signals;
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        const auto of_it = [&](const Observation& o) { return o.satellite == s.id; };
        const auto usable = [&](const Observation& o) { return of_it(o) && !is_unhealthy_l5(o, context.config); };
        const bool two = std::count_if(measured.begin(), measured.end(), usable) > 1;
        if (std::none_of(measured.begin(), measured.end(), of_it)) m.signals.push_back(signal_item({&s}, context));
        for (const Observation& o : measured)
            if (of_it(o)) m.signals.push_back(signal_item({&s, &o, two, !usable(o)}, context));
    }
    std::stable_sort(m.signals.begin(), m.signals.end(), [](const NavSigItem& a, const NavSigItem& b) {
        return std::tie(a.gnss_id, a.sv_id, a.sig_id) < std::tie(b.gnss_id, b.sv_id, b.sig_id);
    });
    return ubx_frames_of(m);
}

}  // namespace skyloop::firmware
