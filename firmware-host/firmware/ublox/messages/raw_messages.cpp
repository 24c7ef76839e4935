// Class RXM: RAWX, MEASX, SFRBX and SVSI (RECEIVER.md 3.2).
#include <algorithm>
#include <chrono>
#include <cmath>

#include "firmware/core/navigation_state.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr double longest_lock_s = 64.5;
constexpr std::uint8_t invalid_phase_deviation = 15;

// n of unit·2^n, 0 … 15.
std::uint8_t exponent_code(double deviation, double unit) {
    if (!(deviation > unit)) return 0;
    return static_cast<std::uint8_t>(std::min(15.0, std::round(std::log2(deviation / unit))));
}

// n of 0.004 cycles·n; 15 says that there is no phase.
std::uint8_t phase_deviation_code(const Observation& o, double scale) {
    if (!o.carrier_phase) return invalid_phase_deviation;
    return std::clamp(nearest<std::uint8_t>(scale * o.carrier_phase_deviation / 0.004), std::uint8_t{1},
                      std::uint8_t{14});
}

// Cycles. Those of geostationary BeiDou satellites lie half a cycle below the phase that RINEX means, as decoders of
// u-blox logs take for granted (RTKLIB 2.4.3, ublox.c, decode_rxmrawx).
double raw_phase(const Observation& o) {
    if (!o.carrier_phase) return 0;
    return is_beidou_geo(o.satellite) ? *o.carrier_phase - 0.5 : *o.carrier_phase;
}

RxmRawxItem raw_measurement(const Observation& o, const ReportContext& context) {
    RxmRawxItem item;
    item.pr_mes = o.pseudorange->value();
    item.cp_mes = raw_phase(o);
    item.do_mes.set(o.doppler ? o.doppler->value() : 0);
    item.gnss_id = gnss_id(o.satellite.constellation);
    item.sv_id = sv_id(o.satellite);
    item.sig_id = context.board.identity.generation <= 8
                      ? std::uint8_t{0}
                      : signal_id(o.satellite, o.signal, context.config.settings.beidou_b1c);
    item.freq_id = frequency_id(o.satellite, o.signal, o.carrier);
    if (o.carrier_phase) item.locktime.set(std::min(longest_lock_s, o.lock_time.value()));
    item.cno.set(o.cn0.value());
    item.pr_stdev = exponent_code(o.pseudorange_deviation.value(), 0.01);
    item.cp_stdev = phase_deviation_code(o, context.board.phase_deviation_scale);
    item.do_stdev = exponent_code(std::hypot(o.doppler_deviation.value(), context.board.doppler_deviation_hz), 0.002);
    item.trk_stat =
        static_cast<std::uint8_t>(1 | (o.carrier_phase ? 2 : 0) | (o.carrier_phase && o.half_cycle_resolved ? 4 : 0));
    return item;
}

// The receiver's own time of the measurements; of models that measure nothing that of the epoch.
GpsTime measurement_time(const ReportContext& context) {
    const Observations& observations = context.state.epoch.observations;
    return observations.signals.empty() ? reported_time(context).time : observations.receive_time;
}

// Pseudoranges need the time and the date: until both are known a captured ZED-F9P tells what it
// has counted since its start, week 0, and no measurement.
RxmRawx raw_measurements(const ReportContext& context) {
    const NavigationState& state = context.state;
    RxmRawx m;
    m.leap_s.set(state.epoch.fix.leap_seconds);
    m.rec_stat = state.time.leap_seconds ? 1 : 0;
    m.version = 1;
    if (!state.time.time || !state.time.date) {
        m.rcv_tow = state.since_start.value();
        return m;
    }
    const GpsTime measured = measurement_time(context), told = std::chrono::round<std::chrono::milliseconds>(measured);
    const WeekAndTow now = week_and_tow(told);
    m.rcv_tow = now.tow_seconds();
    m.week = week_field<std::uint16_t>(state, now);
    if (state.epoch.observations.clock_was_set) m.rec_stat |= 2;
    for (const Observation& o : state.epoch.observations.signals)
        if (o.pseudorange) m.measurements.push_back(raw_measurement(carried(o, difference(measured, told)), context));
    return m;
}

// The code on the signal: chips in a millisecond, and how many milliseconds it lasts (the systems' ICDs).
struct CodeShape {
    int chips_per_ms = 1023, milliseconds = 1;
};
CodeShape code_shape(const Observation& o, bool b1c) {
    switch (o.satellite.constellation) {
        case Constellation::glonass:
            return {511, 1};
        case Constellation::beidou:
            if (o.signal == Signal::b1i && b1c) return {1023, 10};
            return o.signal == Signal::l5 || o.signal == Signal::b3i ? CodeShape{10230, 1} : CodeShape{2046, 1};
        case Constellation::galileo:
            return o.signal == Signal::l1 ? CodeShape{1023, 4} : CodeShape{10230, 1};
        case Constellation::navic:
            return {1023, 1};
        default:
            return o.signal == Signal::l5 ? CodeShape{10230, 1} : CodeShape{1023, 1};
    }
}

// Index i = x + 8y of 0.5·(1 + x/8)·2^y m, the first that is not less (3GPP TS 44.031, table A.9).
std::uint8_t range_error_index(double deviation_m) {
    for (int i = 0; i < 63; ++i)
        if (deviation_m <= 0.5 * (1 + i % 8 / 8.0) * std::exp2(i / 8)) return static_cast<std::uint8_t>(i);
    return 63;
}

// 1 low, 2 medium, 3 high; low where the receiver looks for none. The steps are ours: an echo of −20 dB skews the peak
// by up to about 5 %, one of −10 dB by up to about 15 %.
std::uint8_t multipath_indicator(const Observation& o) {
    const double distortion = o.correlation_distortion.value_or(0);
    return distortion < 0.05 ? 1 : distortion < 0.15 ? 2 : 3;
}

// The code phase grows with the range, as the log of a ZED-F9P with MEASX and RAWX side by side shows.
RxmMeasxItem code_measurement(const Observation& o, bool b1c) {
    const CodeShape shape = code_shape(o, b1c);
    const double travel_ms = o.pseudorange->value() / speed_of_light * 1e3;
    const double in_code = travel_ms - std::floor(travel_ms / shape.milliseconds) * shape.milliseconds;
    const double whole_ms = std::floor(in_code), phase = in_code - whole_ms;
    const double chips = in_code * shape.chips_per_ms;
    RxmMeasxItem item;
    item.gnss_id = gnss_id(o.satellite.constellation);
    item.sv_id = sv_id(o.satellite);
    item.cno.set(o.cn0.value());
    item.mpath_indic = multipath_indicator(o);
    if (o.doppler) {
        item.doppler_hz.set(o.doppler->value());
        item.doppler_ms.set(o.doppler->value() * speed_of_light / o.carrier.value());
    }
    item.whole_chips.set(std::floor(chips));
    item.frac_chips = static_cast<std::uint16_t>(std::clamp((chips - std::floor(chips)) * 1024, 0.0, 1023.0));
    item.code_phase = nearest<std::uint32_t>(std::floor(phase * 2097152.0));
    item.int_code_phase.set(whole_ms);
    item.pseu_range_rms_err = range_error_index(o.pseudorange_deviation.value());
    return item;
}

std::uint32_t tow_ms(GpsTime time) { return static_cast<std::uint32_t>(week_and_tow(time).tow / 1ms); }

RxmMeasx code_measurements(const ReportContext& context) {
    const NavigationState& state = context.state;
    const GpsTime time = std::chrono::round<std::chrono::milliseconds>(measurement_time(context));
    RxmMeasx m;
    if (state.time.time) {
        m.gps_tow = m.qzss_tow = tow_ms(time);
        m.bds_tow = tow_ms(time - bdt_lag);
        if (context.board.identity.generation >= 9 && context.config.has_on(Constellation::galileo))
            m.gal_tow = m.gps_tow;
        m.glo_tow = tow_ms(time + 3h - std::chrono::seconds(state.epoch.fix.leap_seconds));
        m.gps_tow_acc.set(state.time.accuracy.value() * 1e3);
        m.glo_tow_acc = m.bds_tow_acc = m.qzss_tow_acc = m.gps_tow_acc.raw;
        m.flags = 2;
    }
    const bool b1c = context.config.settings.beidou_b1c;
    for (const Observation& o : state.epoch.observations.signals)
        if (o.pseudorange) m.satellites.push_back(code_measurement(o, b1c));
    return m;
}

// Channels are numbered as the satellites are listed.
std::uint8_t tracking_channel(SatelliteId id, const Fix& fix) {
    const auto found = std::ranges::find_if(fix.satellites, [&](const auto& s) { return s.id == id; });
    return found == fix.satellites.end() ? std::uint8_t{0}
                                         : nearest<std::uint8_t>(static_cast<double>(found - fix.satellites.begin()));
}

// Pilots carry no data: what is measured is called E1-C, E5b-Q, E5a-Q, L2CL and L5Q, and the messages come by E1-B,
// E5b-I, E5a-I, L2CM and L5I.
std::uint8_t data_signal_id(const Subframe& subframe, const ReportContext& context) {
    constexpr std::uint8_t e1_b = 1, e5a_i = 3, e5b_i = 5, l2_cm = 4, l5_i = 6, qzss_l5_i = 8;
    const bool gps = subframe.satellite.constellation == Constellation::gps;
    if (subframe.satellite.constellation == Constellation::galileo) {
        if (subframe.signal == Signal::l5) return e5a_i;
        return subframe.signal == Signal::e5b ? e5b_i : e1_b;
    }
    if (gps || subframe.satellite.constellation == Constellation::qzss) {
        if (subframe.signal == Signal::l2) return l2_cm;
        if (subframe.signal == Signal::l5) return gps ? l5_i : qzss_l5_i;
    }
    return signal_id(subframe.satellite, subframe.signal, context.config.settings.beidou_b1c);
}

std::vector<Bytes> received_subframes(const ReportContext& context) {
    std::vector<Bytes> frames;
    const bool b1c = context.config.settings.beidou_b1c;
    for (const Subframe& subframe : context.state.epoch.subframes) {
        // D1 and D2 come by B1I: on B1C there is B-CNAV1, which is not made.
        if (b1c && subframe.signal == Signal::b1i) continue;
        RxmSfrbx m;
        m.gnss_id = gnss_id(subframe.satellite.constellation);
        m.sv_id = sv_id(subframe.satellite);
        if (context.board.identity.generation > 8) m.sig_id = data_signal_id(subframe, context);
        if (subframe.satellite.constellation == Constellation::glonass) m.freq_id.set(subframe.frequency_channel + 7);
        m.chn = tracking_channel(subframe.satellite, context.state.epoch.fix);
        m.version = 2;
        m.words = subframe.words;
        // What a ninth word holds in captures is of the satellite's channel, not of its message.
        if (subframe.satellite.constellation == Constellation::galileo && subframe.signal != Signal::l5)
            m.words.resize(context.board.galileo_words);
        frames.push_back(encode_frame(m));
    }
    return frames;
}

// Flags: 0-3 accuracy index, 4 healthy, 5 ephemeris, 6 almanac, 7 not available.
RxmSvsiItem satellite_knowledge(std::uint8_t number, const SatelliteStatus& s, const NavigationState& state) {
    constexpr int no_accuracy = 15, no_age = 15, fresh = 4;
    const bool almanac = almanac_known(state) && s.id.constellation != Constellation::sbas;
    RxmSvsiItem item;
    item.sv_id = number;
    item.sv_flag =
        static_cast<std::uint8_t>((s.has_ephemeris ? 1 : no_accuracy) | (satellite_health(s, state) == 1 ? 0x10 : 0) |
                                  (s.has_ephemeris ? 0x20 : 0) | (almanac ? 0x40 : 0));
    const SkyFields sky = sky_fields(s, state);
    item.azim = sky.azimuth;
    item.elev = sky.elevation;
    item.age = static_cast<std::uint8_t>((almanac ? fresh : no_age) | (s.has_ephemeris ? fresh : no_age) << 4);
    return item;
}

RxmSvsi satellites_known(const ReportContext& context) {
    const EpochTime now = epoch_time(reported_time(context).time);
    RxmSvsi m;
    m.i_tow = now.i_tow;
    m.week = week_field<std::int16_t>(context.state, now.stamp());
    for (const SatelliteStatus& s : sorted_satellites(context.state.epoch.fix)) {
        const auto number = ubx_single_number(s.id);
        if (!number) continue;
        m.satellites.push_back(satellite_knowledge(*number, s, context.state));
        if (m.satellites.back().elev > 0) ++m.num_vis;
    }
    return m;
}

constexpr UbxMaker raw_makers[] = {maker<raw_measurements>,
                                   maker<code_measurements>,
                                   {RxmSfrbx::message_id, received_subframes},
                                   maker<satellites_known>};

}  // namespace

std::vector<Bytes> make_raw_message(UbxMessageId message, const ReportContext& context) {
    return made_by(raw_makers, message, context);
}

}  // namespace skyloop::firmware
