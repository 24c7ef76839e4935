// Corrections for others, of a receiver that can be a base: RTCM 1005, observations, 1230 and 4072
// (ZED-F9P interface description HPG 1.32, section 4.2).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "firmware/core/base_station.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/messages/rtcm_observations.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"

namespace skyloop::firmware {
namespace {

// The ids in class F5 are what the numbers have beyond 1000.
int rtcm_number(UbxMessageId message) { return 1000 + message.id; }

RtcmEpoch rtcm_epoch(const ReportContext& context) {
    const Epoch& epoch = context.state.epoch;
    return {epoch.observations, epoch.fix.leap_seconds, epoch.fix.clock_drift, context.config.station};
}

// Of which system a message has observations; nothing for one that has none.
std::optional<Constellation> observed_by(UbxMessageId message) {
    if (message.message_class != class_rtcm) return std::nullopt;
    const int number = rtcm_number(message);
    if (is_legacy_observables(number)) return number < 1009 ? Constellation::gps : Constellation::glonass;
    return msm_constellation(number);
}

// Whether another message of observations leaves in this epoch: whoever collects them waits for the last one.
bool more_follow(const ReportContext& context) {
    return std::any_of(context.following.begin(), context.following.end(), [&](UbxMessageId other) {
        const auto constellation = observed_by(other);
        return constellation && has_msm_signals(rtcm_epoch(context), *constellation);
    });
}

std::vector<Bytes> observations_message(UbxMessageId message, const ReportContext& context) {
    const int number = rtcm_number(message);
    const RtcmEpoch epoch = rtcm_epoch(context);
    if (!is_legacy_observables(number)) return msm_frames(epoch, number, more_follow(context));
    Bytes frame = legacy_frame(epoch, number, more_follow(context));
    if (frame.empty()) return {};
    return {std::move(frame)};
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

Rtcm3UbloxHead ublox_head(const ReportContext& context, GpsTime time) {
    const auto whole = std::chrono::round<std::chrono::milliseconds>(time);
    Rtcm3UbloxHead head;
    head.station = context.config.station;
    head.epoch = static_cast<std::uint32_t>(week_and_tow(whole).tow / std::chrono::milliseconds(1));
    return head;
}

// Where a base is that moves, and how fast: 4072.0.
std::vector<Bytes> moving_station_message(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    if (!context.state.fix_ok || !fix.has_position()) return {};
    const auto whole = [](double value, double parts) { return std::llround(value * parts); };
    const auto metres = to_ecef(fix.position).vector();
    const Velocity<Enu> of_place(Eigen::Vector3d(fix.velocity.east, fix.velocity.north, -fix.velocity.down));
    const auto velocity = LocalFrame(fix.position).to_ecef(of_place).vector();
    Rtcm3MovingStation station;
    station.head = ublox_head(context, fix.time);
    for (std::size_t i = 0; i < 3; ++i) {
        station.position[i] = whole(metres[static_cast<Eigen::Index>(i)], 1e4);
        station.velocity[i] = static_cast<std::int32_t>(whole(velocity[static_cast<Eigen::Index>(i)], 1e3));
    }
    const double deviation = std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value());
    station.position_deviation_mm = static_cast<std::uint32_t>(whole(deviation, 1e3));
    station.velocity_deviation = static_cast<std::uint32_t>(whole(fix.speed_accuracy.value(), 1e3));
    return {encode(station)};
}

// The bands of the systems that are tracked, between which this receiver's hardware has no biases: 4072.1.
std::vector<Bytes> station_biases_message(const ReportContext& context) {
    const Observations& observations = context.state.epoch.observations;
    std::set<std::pair<std::uint8_t, std::uint8_t>> bands;
    for (const Observation& o : observations.signals)
        if (o.pseudorange)
            bands.emplace(gnss_id(o.satellite.constellation),
                          o.signal == first_signal(o.satellite.constellation) ? 0 : 1);
    Rtcm3StationBiases message;
    message.head = ublox_head(context, observations.receive_time);
    for (const auto& [system, band] : bands)
        message.biases.push_back({system, band, 0, 0});
    return {encode(message)};
}

}  // namespace

std::vector<Bytes> make_rtcm_message(UbxMessageId message, const ReportContext& context) {
    constexpr std::uint8_t id_1005 = 0x05, id_1230 = 0xE6, id_4072_1 = 0xFD, id_4072_0 = 0xFE;
    if (message.id == id_1005) return station_message(context);
    if (!context.state.time.time) return {};
    if (message.id == id_4072_0) return moving_station_message(context);
    if (context.state.epoch.observations.signals.empty()) return {};
    if (message.id == id_4072_1) return station_biases_message(context);
    if (message.id == id_1230) {
        // As a ZED-F9P sends it: the observations are aligned, and no bias is told.
        Rtcm3GlonassBiases biases;
        biases.station = context.config.station;
        biases.aligned = true;
        return {encode(biases)};
    }
    if (!observed_by(message)) return {};
    return observations_message(message, context);
}

}  // namespace skyloop::firmware
