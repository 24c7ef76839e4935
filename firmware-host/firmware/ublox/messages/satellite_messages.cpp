// NAV-SAT, NAV-SVINFO, NAV-ORB and NAV-SBAS (RECEIVER.md 3.1, 5.6).
// NAV-SIG (RECEIVER.md 3.1, 5.6).

#include <algorithm>
#include <cmath>
#include <tuple>

#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "world/gnss/sbas_service.hpp"

namespace skyloop::firmware {
namespace {

bool has_almanac(const SatelliteStatus& s, const NavigationState& state) {
    return s.id.constellation != Constellation::sbas && almanac_known(state);
}

// SBAS corrects some of the satellites. Sensor models, whose regime of SBAS has no messages, say it of all.
CorrectionOrigin corrections_of(const SatelliteStatus& s, const NavigationState& state) {
    const CorrectionOrigin origin = corrections_in_use(state);
    if (origin != CorrectionOrigin::sbas || !state.epoch.fix.sbas_source || s.sbas) return origin;
    return CorrectionOrigin::none;
}

// orbitSource: 0 none, 1 ephemeris, 2 almanac.
std::uint32_t orbit_source(const SatelliteStatus& s, const NavigationState& state) {
    if (s.has_ephemeris) return 1;
    return direction_known(s, state) || has_almanac(s, state) ? 2 : 0;
}

std::uint32_t satellite_flags(const SatelliteStatus& s, const ReportContext& context) {
    const NavigationState& state = context.state;
    std::uint32_t flags = satellite_quality(s, state) | (s.used ? 8u : 0u) | satellite_health(s, state) << 4 |
                          orbit_source(s, state) << 8 | (s.has_ephemeris ? 1u << 11 : 0u) |
                          (has_almanac(s, state) ? 1u << 12 : 0u);
    if (!s.used) return flags;
    switch (corrections_of(s, state)) {
        case CorrectionOrigin::none:
            break;
        case CorrectionOrigin::sbas:
            flags |= 1u << 6 | 1u << 16;
            break;
        case CorrectionOrigin::rtcm3:
            flags |= 1u << 6 | 1u << 17 | 1u << 20 | (carrier_solution(state.epoch.fix) != 0 ? 1u << 21 : 0u);
            break;
    }
    return flags;
}

NavSat satellites_in_view(const ReportContext& context) {
    auto m = stamped<NavSat>(context);
    m.version = 1;
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        const SkyFields sky = sky_fields(s, context.state);
        m.satellites.push_back({gnss_id(s.id.constellation), sv_id(s.id), cn0_field(s.cn0), sky.elevation, sky.azimuth,
                                0, satellite_flags(s, context)});
        if (s.residual) m.satellites.back().pr_res.set(s.residual->value());
    }
    return m;
}

// Bits: 0 used, 1 corrected, 2 orbit known, 3 by ephemeris, 4 unhealthy, 5 by almanac.
std::uint8_t channel_flags(const SatelliteStatus& s, const NavigationState& state) {
    const std::uint32_t source = orbit_source(s, state);
    const bool corrected = s.used && corrections_of(s, state) != CorrectionOrigin::none;
    return static_cast<std::uint8_t>((s.used ? 1 : 0) | (corrected ? 2 : 0) | (source != 0 ? 4 : 0) |
                                     (source == 1 ? 8 : 0) | (satellite_health(s, state) == 2 ? 0x10 : 0) |
                                     (source == 2 ? 0x20 : 0));
}

NavSvinfo channels(const ReportContext& context) {
    constexpr std::uint8_t no_channel = 255;
    const int generation = context.board.identity.generation;
    auto m = stamped<NavSvinfo>(context);
    m.global_flags = static_cast<std::uint8_t>(std::clamp(generation - 4, 0, 4));  // 4 of M8, 1 of u-blox 5
    std::uint8_t channel = 0;
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        const auto number = ubx_single_number(s.id);
        if (!number) continue;
        const SkyFields sky = sky_fields(s, context.state);
        const bool tracked = s.cn0.has_value() && channel < no_channel;
        m.channels.push_back({tracked ? channel++ : no_channel, *number, channel_flags(s, context.state),
                              static_cast<std::uint8_t>(satellite_quality(s, context.state)), cn0_field(s.cn0),
                              sky.elevation, sky.azimuth, 0});
        if (s.residual) m.channels.back().pr_res.set(s.residual->value());
    }
    return m;
}

// 0 unknown, 1 below the horizon, 2 above it, 3 above the elevation mask.
int visibility(const SatelliteStatus& s, const ReportContext& context) {
    if (!direction_known(s, context.state)) return 0;
    const double mask = context.config.elevation_mask.deg();
    return s.elevation.deg() < 0 ? 1 : s.elevation.deg() < mask ? 2 : 3;
}

NavOrb orbits(const ReportContext& context) {
    constexpr std::uint8_t from_sky_for_unknown_time = 1 << 5 | 31;
    auto m = stamped<NavOrb>(context);
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        if (orbit_source(s, context.state) == 0) continue;
        NavOrbItem item;
        item.gnss_id = gnss_id(s.id.constellation);
        item.sv_id = sv_id(s.id);
        item.sv_flag = static_cast<std::uint8_t>(satellite_health(s, context.state) |
                                                 static_cast<unsigned>(visibility(s, context)) << 2);
        item.eph = s.has_ephemeris ? from_sky_for_unknown_time : std::uint8_t{0};
        item.alm = has_almanac(s, context.state) ? from_sky_for_unknown_time : std::uint8_t{0};
        m.satellites.push_back(item);
    }
    return m;
}

// The satellite whose corrections are used, or the strongest one. Of each corrected satellite with the index of its
// bound (UDREI), and what was added for it and taken off.
NavSbas augmentation(const ReportContext& context) {
    const NavigationState& state = context.state;
    auto m = stamped<NavSbas>(context);
    const auto satellites = sorted_satellites(state.epoch.fix);
    const SatelliteStatus* source = nullptr;
    for (const SatelliteStatus& s : satellites)
        if (s.id.constellation == Constellation::sbas && s.cn0 && (source == nullptr || *s.cn0 > *source->cn0))
            source = &s;
    for (const SatelliteStatus& s : satellites)
        if (state.epoch.fix.sbas_source == s.id) source = &s;
    m.sys = -1;  // unknown
    if (source == nullptr) return m;
    m.geo = sv_id(source->id);
    m.mode = 1;
    if (const auto system = sbas_system(m.geo)) m.sys = static_cast<std::int8_t>(*system);
    const bool corrects = corrections_in_use(state) == CorrectionOrigin::sbas;
    m.service = corrects ? 3 : 1;
    for (const SatelliteStatus& s : satellites) {
        const auto number = ubx_single_number(s.id);
        if (!corrects || !s.used || !number || corrections_of(s, state) == CorrectionOrigin::none) continue;
        NavSbasItem item;
        item.sv_id = *number;
        item.flags = 1;
        if (s.sbas) {
            item.udre = static_cast<std::uint8_t>(s.sbas->udre_index);
            item.prc.set(s.sbas->range_correction.value());
            item.ic.set(s.sbas->ionosphere.value());
        }
        item.sv_sys = static_cast<std::uint8_t>(m.sys);
        item.sv_service = m.service;
        m.satellites.push_back(item);
    }
    return m;
}

}  // namespace

SkyFields sky_fields(const SatelliteStatus& s, const NavigationState& state) {
    if (!direction_known(s, state)) return {};
    return {nearest<std::int8_t>(s.elevation.deg()), static_cast<std::int16_t>(std::lround(s.azimuth.deg()) % 360)};
}

std::vector<SatelliteStatus> sorted_satellites(const Fix& fix) {
    std::vector<SatelliteStatus> list = fix.satellites;
    std::ranges::sort(list, [](const auto& a, const auto& b) { return a.id < b.id; });
    if (list.size() > ubx_most_items) list.resize(ubx_most_items);
    return list;
}

CorrectionOrigin corrections_in_use(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    if (!is_differential(fix)) return CorrectionOrigin::none;
    // SBAS tells nothing of carrier phases.
    const bool of_base = state.corrections.state != CorrectionState::none || carrier_solution(fix) != 0;
    return of_base ? CorrectionOrigin::rtcm3 : CorrectionOrigin::sbas;
}

std::uint32_t satellite_health(const SatelliteStatus& s, const NavigationState& state) {
    if (orbit_source(s, state) == 0) return 0;
    return s.healthy ? 1 : 2;
}

std::uint32_t satellite_quality(const SatelliteStatus& s, const NavigationState& state) {
    if (!s.cn0) return 1;
    const auto& signals = state.epoch.observations.signals;
    if (signals.empty()) return 7;
    const auto found = std::ranges::find_if(signals, [&](const auto& o) { return o.satellite == s.id; });
    return found == signals.end() ? 2 : signal_quality(*found);
}

std::uint8_t signal_quality(const Observation& observation) {
    if (!observation.pseudorange) return 3;
    if (!observation.carrier_phase) return 4;
    return observation.half_cycle_resolved ? 7 : 6;
}

namespace {

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
bool is_unhealthy_l5(const Observation& o, const ReceiverConfig& config) {
    return o.satellite.constellation == Constellation::gps && o.signal == Signal::l5 && !config.trusts_l5;
}

// Bits: 0-1 health, 3-5 range, carrier and Doppler used, 6-8 corrections of them. Captured: 0x29 used, 0x169 with SBAS,
// 0xF9 with carrier phases of a base.
std::uint16_t signal_flags(const SignalReport& signal, const NavigationState& state) {
    unsigned flags = signal.unhealthy ? 2 : satellite_health(*signal.satellite, state);
    const bool range = signal.observation == nullptr || signal.observation->pseudorange.has_value();
    if (!signal.is_used() || !range) return static_cast<std::uint16_t>(flags);
    flags |= 0x28;
    switch (corrections_of(*signal.satellite, state)) {
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
    return codes[static_cast<std::size_t>(corrections_of(*signal.satellite, state))];
}

// 0 none, 1 Klobuchar of GPS, which comes in the page of the leap seconds, 2 SBAS, 8 two frequencies.
std::uint8_t ionosphere_model(const SignalReport& signal, const NavigationState& state) {
    if (!signal.is_used()) return 0;
    // The grid serves for satellites of every system.
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
    item.sig_id = signal_id(s.id, signal, context.config.settings.beidou_b1c);
    item.freq_id = frequency_id(s.id, signal, o != nullptr ? o->carrier : carrier_frequency(signal));
    if (s.residual) item.pr_res.set(s.residual->value());
    item.cno = o != nullptr ? nearest<std::uint8_t>(o->cn0.value()) : cn0_field(s.cn0);
    item.quality = o != nullptr ? signal_quality(*o) : static_cast<std::uint8_t>(satellite_quality(s, context.state));
    item.corr_source = correction_source(report, context.state);
    item.iono_model = ionosphere_model(report, context.state);
    item.flags = signal_flags(report, context.state);
    return item;
}

NavSig signals(const ReportContext& context) {
    auto m = stamped<NavSig>(context);
    const auto& measured = context.state.epoch.observations.signals;
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        const auto of_it = [&](const Observation& o) { return o.satellite == s.id; };
        const auto usable = [&](const Observation& o) { return of_it(o) && !is_unhealthy_l5(o, context.config); };
        const bool two = std::ranges::count_if(measured, usable) > 1;
        if (std::ranges::none_of(measured, of_it)) m.signals.push_back(signal_item({&s}, context));
        for (const Observation& o : measured)
            if (of_it(o)) m.signals.push_back(signal_item({&s, &o, two, !usable(o)}, context));
    }
    std::ranges::stable_sort(m.signals, [](const NavSigItem& a, const NavSigItem& b) {
        return std::tie(a.gnss_id, a.sv_id, a.sig_id) < std::tie(b.gnss_id, b.sv_id, b.sig_id);
    });
    return m;
}

constexpr UbxMaker satellite_makers[] = {maker<satellites_in_view>, maker<channels>, maker<orbits>, maker<augmentation>,
                                         maker<signals>};

}  // namespace

std::vector<Bytes> make_satellite_message(UbxMessageId message, const ReportContext& context) {
    return made_by(satellite_makers, message, context);
}

}  // namespace skyloop::firmware
