#include "firmware/septentrio/station_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "base/core/number_text.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/messages/rtcm_observations.hpp"
#include "firmware/septentrio/rover_and_station.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"

namespace skyloop::firmware {
namespace {

constexpr int position_only = 1005, position_and_height = 1006;

// A message that is made here, and the name under which its interval is set.
struct StationMessage {
    std::string name, pace;
    int number;
    [[nodiscard]] UbxMessageId id() const { return {class_rtcm, static_cast<std::uint8_t>(number - 1000)}; }
};

// Those of two forms have one interval: RTCM1001|2.
std::string pace_of(int number) {
    if (const auto kind = msm_kind(number)) return fmt::format("MSM{}", *kind);
    const bool paired = (number >= 1001 && number <= 1008) || (number >= 1009 && number <= 1012);
    if (!paired) return fmt::format("RTCM{}", number);
    const int first = number - (number + 1) % 2;
    return fmt::format("RTCM{}|{}", first, first + 1 - 1000);
}

// In the order in which they leave: the place, who it is, observations by systems, the rest.
std::vector<StationMessage> listed_messages() {
    std::vector<int> numbers{position_only, position_and_height, 1007, 1008, 1033};
    for (const int first : {1001, 1009})
        for (int form = 0; form < 4; ++form)
            numbers.push_back(first + form);
    for (const Constellation system :
         {Constellation::gps, Constellation::glonass, Constellation::galileo, Constellation::sbas, Constellation::qzss,
          Constellation::beidou, Constellation::navic})
        for (int kind = 4; kind <= 7; ++kind)
            numbers.push_back(msm_number(system, kind));
    std::ranges::copy(std::array{1230, 1019, 1020, 1042, 1044, 1045, 1046}, std::back_inserter(numbers));
    std::vector<StationMessage> messages;
    for (const int number : numbers)
        messages.push_back({fmt::format("RTCM{}", number), pace_of(number), number});
    return messages;
}

std::span<const StationMessage> station_messages() {
    static const std::vector<StationMessage> messages = listed_messages();
    return messages;
}

constexpr std::array<PortId, 3> ports_with_commands{PortId::uart1, PortId::uart2, PortId::usb};

std::uint64_t period_of(const SeptentrioSettings& settings, const StationMessage& message) {
    const auto seconds = number_in<double>(settings.values("RTCMv3Interval", message.pace).front());
    return static_cast<std::uint64_t>(std::llround(seconds.value_or(1) * 1e3));
}

// Those that a port sends, whenever that is.
std::vector<const StationMessage*> sent_by(const SeptentrioSettings& settings, std::string_view port) {
    std::vector<const StationMessage*> sent;
    const auto& wanted = settings.values("RTCMv3Output", port);
    if (wanted.empty() || !lets_through(settings, port, "RTCMv3")) return sent;
    for (const StationMessage& message : station_messages())
        if (lists(wanted.front(), message.name)) sent.push_back(&message);
    return sent;
}

// 1006 is 1005 and the height of the antenna's reference point above the marker.
std::vector<Bytes> with_height(std::vector<Bytes> frames, const SeptentrioSettings& settings) {
    constexpr double most_m = 6.5535;
    const double height = number_in<double>(settings.values("AntennaOffset", "Main")[2]).value_or(0);
    for (Bytes& frame : frames) {
        auto station = decode_station(*parse_rtcm3(frame));
        station->antenna_height = static_cast<int>(std::lround(std::clamp(height, 0.0, most_m) * 1e4));
        frame = encode(*station);
    }
    return frames;
}

// Texts are kept with the quotation marks that they were given with.
std::string unquoted(const std::string& text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

Bytes descriptors(int number, const SeptentrioSettings& settings, const ReportContext& context) {
    const auto& antenna = settings.values("AntennaOffset", "Main");
    Rtcm3Descriptors told;
    told.number = number;
    told.station = context.config.station;
    told.antenna = unquoted(antenna[3]);
    told.antenna_serial = unquoted(antenna[4]);
    told.antenna_setup = std::clamp(number_in<int>(antenna[5]).value_or(0), 0, 255);
    told.receiver = context.board.identity.hardware;
    told.firmware = context.board.identity.software;
    if (context.board.usb) told.receiver_serial = context.board.usb->serial;
    return encode(told);
}

std::vector<Bytes> tracked_records(int number, const SeptentrioState& receiver, const NavigationState& state) {
    if (!state.time.time) return {};
    std::set<SatelliteId> tracked;
    for (const Observation& o : state.epoch.observations.signals)
        tracked.insert(o.satellite);
    std::vector<Bytes> frames;
    for (const auto& [of, record] : receiver.records)
        if (tracked.contains(of.first) && ephemeris_number(record) == number)
            frames.push_back(encode_ephemeris(record, state.epoch.fix.time, reported_leap_seconds(state)));
    return frames;
}

std::vector<Bytes> made(const StationMessage& message, const SeptentrioState& receiver, const ReportContext& context) {
    const int number = message.number;
    if (number == position_and_height)
        return with_height(make_rtcm_message({class_rtcm, position_only - 1000}, context), receiver.settings);
    if (number == 1007 || number == 1008 || number == 1033) return {descriptors(number, receiver.settings, context)};
    if (is_ephemeris_number(number)) return tracked_records(number, receiver, context.state);
    return make_rtcm_message(message.id(), context);
}

}  // namespace

std::vector<Bytes> station_output(const SeptentrioState& receiver, const ReportContext& context) {
    const std::uint32_t tow_ms = whole_milliseconds(gps_stamp(context.state.epoch.fix.time));
    std::vector<const StationMessage*> due;
    std::vector<UbxMessageId> ids;
    for (const StationMessage* message : sent_by(receiver.settings, descriptor_of(context.port))) {
        if (tow_ms % period_of(receiver.settings, *message) != 0) continue;
        due.push_back(message);
        ids.push_back(message->id());
    }
    std::vector<Bytes> frames;
    for (std::size_t i = 0; i < due.size(); ++i) {
        ReportContext one = context;
        one.following = std::span(ids).subspan(i + 1);
        std::ranges::move(made(*due[i], receiver, one), std::back_inserter(frames));
    }
    return frames;
}

std::uint64_t station_period_ms(const SeptentrioSettings& settings) {
    std::uint64_t common = 0;
    for (const PortId port : ports_with_commands)
        for (const StationMessage* message : sent_by(settings, descriptor_of(port)))
            common = std::gcd(common, period_of(settings, *message));
    return common;
}

bool station_wants_records(const SeptentrioSettings& settings) {
    return std::ranges::any_of(ports_with_commands, [&](PortId port) {
        return std::ranges::any_of(sent_by(settings, descriptor_of(port)),
                                   [](const StationMessage* message) { return is_ephemeris_number(message->number); });
    });
}

}  // namespace skyloop::firmware
