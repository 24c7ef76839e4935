#include "firmware/septentrio/station_output.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "base/core/number_in.hpp"
#include "firmware/message_class.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/messages/reported_fix.hpp"
#include "firmware/septentrio/modes.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::firmware {
namespace {

// A message that is made here, and the name under which its interval is set.
struct StationMessage {
    std::string_view name, pace;
    std::uint8_t id;  // in class F5
};
constexpr std::uint8_t position_only = 0x05, position_and_height = 0x06;
constexpr std::array station_messages{
    StationMessage{"RTCM1005", "RTCM1005|6", position_only},
    StationMessage{"RTCM1006", "RTCM1005|6", position_and_height},
    StationMessage{"RTCM1074", "MSM4", 0x4A},
    StationMessage{"RTCM1077", "MSM7", 0x4D},
    StationMessage{"RTCM1084", "MSM4", 0x54},
    StationMessage{"RTCM1087", "MSM7", 0x57},
    StationMessage{"RTCM1094", "MSM4", 0x5E},
    StationMessage{"RTCM1097", "MSM7", 0x61},
    StationMessage{"RTCM1124", "MSM4", 0x7C},
    StationMessage{"RTCM1127", "MSM7", 0x7F},
    StationMessage{"RTCM1230", "RTCM1230", 0xE6},
};
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
    for (const StationMessage& message : station_messages)
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

}  // namespace

std::vector<Bytes> station_output(const SeptentrioSettings& settings, const ReportContext& context) {
    const std::uint32_t tow_ms = whole_milliseconds(gps_stamp(context.state.epoch.fix.time));
    std::vector<UbxMessageId> due;
    for (const StationMessage* message : sent_by(settings, descriptor_of(context.port)))
        if (tow_ms % period_of(settings, *message) == 0) due.push_back({class_rtcm, message->id});
    std::vector<Bytes> frames;
    for (std::size_t i = 0; i < due.size(); ++i) {
        ReportContext one = context;
        one.following = std::span(due).subspan(i + 1);
        const bool height = due[i].id == position_and_height;
        auto made = make_rtcm_message(height ? UbxMessageId{class_rtcm, position_only} : due[i], one);
        if (height) made = with_height(std::move(made), settings);
        std::move(made.begin(), made.end(), std::back_inserter(frames));
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

bool lets_through(const SeptentrioSettings& settings, std::string_view port, std::string_view protocol) {
    const auto& directions = settings.values("DataInOut", port);
    if (directions.size() < 2) return true;
    const auto outputs = split_words(directions[1], '+');
    return std::any_of(outputs.begin(), outputs.end(), [&](const auto& word) { return same_word(word, protocol); });
}

std::optional<Position<Ecef>> told_place(const SeptentrioSettings& settings) {
    const auto& mode = settings.values("PVTMode");
    if (mode[0] != "Static") return std::nullopt;
    const bool geodetic = mode[2].starts_with("Geodetic");
    const auto& place = settings.values(geodetic ? "StaticPosGeodetic" : "StaticPosCartesian", mode[2]);
    if (place.empty()) return std::nullopt;
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = number_in<double>(place[i]).value_or(0);
    if (numbers == std::array<double, 3>{}) return std::nullopt;
    if (geodetic) return to_ecef(Geodetic::degrees(numbers[0], numbers[1], numbers[2]));
    return Position<Ecef>(numbers[0], numbers[1], numbers[2]);
}

}  // namespace skyloop::firmware
