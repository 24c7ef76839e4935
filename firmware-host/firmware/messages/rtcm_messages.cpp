// Corrections for others, of a receiver that can be a base: RTCM 1005, MSM4, MSM7 and 1230 (RECEIVER.md 2.5, 4.2).
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "firmware/core/base_station.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// The messages of observations by their ids in class F5, which are what their numbers have beyond 1000.
struct MsmOutput {
    std::uint8_t id;
    Constellation constellation;
};
constexpr std::array msm_outputs{MsmOutput{0x4A, Constellation::gps},     MsmOutput{0x4D, Constellation::gps},
                                 MsmOutput{0x54, Constellation::glonass}, MsmOutput{0x57, Constellation::glonass},
                                 MsmOutput{0x5E, Constellation::galileo}, MsmOutput{0x61, Constellation::galileo},
                                 MsmOutput{0x7C, Constellation::beidou},  MsmOutput{0x7F, Constellation::beidou}};

// DF395: the code that a u-blox receiver tracks (RTCM 10403.3, tables 3.5-91, 3.5-96, 3.5-99, 3.5-108); 0 for none.
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
            return 23;  // 5Q 5P
        default:
            return 0;
    }
}

GpsTime msm_time(const ReportContext& context) {
    return std::chrono::round<std::chrono::milliseconds>(context.state.epoch.observations.receive_time);
}

std::uint32_t msm_epoch(Constellation constellation, const ReportContext& context) {
    const auto of_week = [](GpsTime time) { return static_cast<std::uint32_t>(week_and_tow(time).tow / 1ms); };
    const GpsTime time = msm_time(context);
    if (constellation == Constellation::beidou) return of_week(time - bdt_lag);
    if (constellation != Constellation::glonass) return of_week(time);
    constexpr std::uint32_t day_ms = 86'400'000;
    const std::uint32_t moscow = of_week(time + 3h - std::chrono::seconds(context.state.epoch.fix.leap_seconds));
    return moscow / day_ms << 27 | moscow % day_ms;
}

// What the receiver's clock is past a whole millisecond, and how fast that grows.
struct PastMillisecond {
    double m = 0;
    MetresPerSecond drift{0};
};

// Ranges are told for a whole millisecond, and with the clock's error its drift leaves them: the rate has to go with
// the phase that it is of.
Rtcm3MsmCell msm_cell(const Observation& o, const PastMillisecond& past) {
    Rtcm3MsmCell cell;
    cell.satellite = o.satellite.number;
    cell.signal = msm_signal(o.satellite.constellation, o.signal);
    cell.wavelength_m = speed_of_light / o.carrier.value();
    cell.range_m = o.pseudorange->value() - past.m;
    if (o.carrier_phase) cell.phase_range_m = *o.carrier_phase * cell.wavelength_m - past.m;
    if (o.doppler) cell.phase_range_rate = -o.doppler->value() * cell.wavelength_m - past.drift.value();
    cell.lock_s = o.carrier_phase ? o.lock_time.value() : 0;
    cell.half_cycle_unknown = !o.half_cycle_resolved;
    cell.cno_dbhz = o.cn0.value();
    if (o.satellite.constellation == Constellation::glonass)
        cell.satellite_info = frequency_id(o.satellite, o.signal, o.carrier);
    return cell;
}

std::vector<Rtcm3MsmCell> msm_cells(Constellation constellation, const ReportContext& context) {
    const Observations& observations = context.state.epoch.observations;
    const PastMillisecond past{difference(observations.receive_time, msm_time(context)).value() * speed_of_light,
                               context.state.epoch.fix.clock_drift};
    std::vector<Rtcm3MsmCell> cells;
    for (const Observation& o : observations.signals)
        if (o.satellite.constellation == constellation && o.pseudorange && msm_signal(constellation, o.signal) != 0)
            cells.push_back(msm_cell(o, past));
    return cells;
}

const MsmOutput* msm_output(UbxMessageId message) {
    if (message.message_class != class_rtcm) return nullptr;
    const auto found = std::find_if(msm_outputs.begin(), msm_outputs.end(),
                                    [&](const MsmOutput& candidate) { return candidate.id == message.id; });
    return found == msm_outputs.end() ? nullptr : &*found;
}

// Whether another message of observations leaves in this epoch: whoever collects them waits for the last one.
bool more_follow(const ReportContext& context) {
    return std::any_of(context.following.begin(), context.following.end(), [&](UbxMessageId other) {
        const MsmOutput* output = msm_output(other);
        return output != nullptr && !msm_cells(output->constellation, context).empty();
    });
}

Bytes observations_message(const MsmOutput& output, const ReportContext& context) {
    Rtcm3MsmObservations message;
    message.number = 1000 + output.id;
    message.station = context.config.station;
    message.epoch = msm_epoch(output.constellation, context);
    message.more = more_follow(context);
    message.cells = msm_cells(output.constellation, context);
    return encode(message);
}

// Only a receiver that knows where it stands says so (CFG-TMODE).
std::vector<Bytes> station_message(const ReportContext& context) {
    const auto place = base_place(context.config.place, context.state.survey);
    if (!place) return {};
    Rtcm3Station station;
    station.station = context.config.station;
    const auto metres = place->position.vector();
    for (std::size_t i = 0; i < 3; ++i)
        station.position[i] = std::llround(metres[static_cast<Eigen::Index>(i)] * 1e4);
    return {encode(station)};
}

}  // namespace

std::vector<Bytes> make_rtcm_message(UbxMessageId message, const ReportContext& context) {
    constexpr std::uint8_t id_1005 = 0x05, id_1230 = 0xE6;
    if (message.id == id_1005) return station_message(context);
    if (!context.state.time.time || context.state.epoch.observations.signals.empty()) return {};
    if (message.id == id_1230) {
        // As a ZED-F9P sends it: the observations are aligned, and no bias is told.
        Rtcm3GlonassBiases biases;
        biases.station = context.config.station;
        biases.aligned = true;
        return {encode(biases)};
    }
    const MsmOutput* output = msm_output(message);
    if (output == nullptr) return {};
    Bytes frame = observations_message(*output, context);
    if (frame.empty()) return {};
    return {std::move(frame)};
}

}  // namespace skyloop::firmware
