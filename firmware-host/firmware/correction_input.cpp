#include "firmware/correction_input.hpp"

#include <algorithm>

#include "skyloop/protocol/rtcm3.hpp"
#include "skyloop/protocol/ubx_frame.hpp"

namespace skyloop::firmware {
namespace {

constexpr UbxMessageId rxm_rtcm{0x02, 0x32};
constexpr Seconds silence_before_another{10};

// Observations that a high-precision receiver takes (ZED-F9P interface description HPG 1.32, section 4.2.1).
bool is_observation(int number) {
    if ((number >= 1001 && number <= 1004) || (number >= 1009 && number <= 1012)) return true;
    const auto kind = msm_kind(number);
    return kind && (*kind == 4 || *kind == 5 || *kind == 7);
}

// What is taken and changes nothing here: antenna and receiver descriptions, GLONASS biases, u-blox's own.
bool is_description(int number) { return number == 1007 || number == 1033 || number == 1230 || number == 4072; }

// Flags of RXM-RTCM version 2: bit 0, bits 1 and 2 (RECEIVER.md 3.2).
enum RtcmUse : std::uint8_t { crc_failed = 1, not_used = 1 << 1, used = 2 << 1 };

Bytes rtcm_answer(const Rtcm3Message& message, RtcmUse flags) {
    const auto subtype = static_cast<std::uint16_t>(message.subtype);
    const auto station = static_cast<std::uint16_t>(message.station.value_or(0));
    const auto number = static_cast<std::uint16_t>(message.number);
    constexpr std::uint8_t version = 2;
    const auto low = [](std::uint16_t v) { return static_cast<std::uint8_t>(v & 0xFF); };
    const auto high = [](std::uint16_t v) { return static_cast<std::uint8_t>(v >> 8); };
    const Bytes payload{version,      flags,         low(subtype), high(subtype),
                        low(station), high(station), low(number),  high(number)};
    return encode_frame(rxm_rtcm, payload);
}

Position<Ecef> place_of(const Rtcm3Station& station) {
    constexpr double metres = 1e-4;
    const auto at = [&](std::size_t axis) { return metres * static_cast<double>(station.position[axis]); };
    return {at(0), at(1), at(2)};
}

}  // namespace

// Whether a station's messages count now.
bool CorrectionInput::follow(int station, GpsTime now) {
    if (station_ && station_->id == station) return true;
    const bool busy = station_ && station_->complete_since && station_->observations &&
                      difference(now, *station_->observations) <= silence_before_another;
    if (busy) return false;
    station_ = Station{};
    station_->id = station;
    return true;
}

// Fixed ambiguities outlive a short silence, floating ones a longer one. After one that was too long even for
// differential corrections everything begins anew.
void CorrectionInput::take_observations(GpsTime now, const CorrectionLimits& limits) {
    Station& s = *station_;
    const Seconds silence = s.observations ? difference(now, *s.observations) : Seconds(0);
    s.observations = now;
    if (silence > limits.timeout) {
        s.complete_since.reset();
        s.resumed.reset();
    } else if (silence > ability_.fixed_held) {
        s.resumed = now;
    }
}

Bytes CorrectionInput::take(ByteSpan frame, GpsTime now, const CorrectionLimits& limits) {
    const auto message = parse_rtcm3(frame);
    if (!message) return rtcm_answer({}, not_used);
    const auto position = decode_station(*message);
    const bool observations = is_observation(message->number);
    if (!position && !observations) return rtcm_answer(*message, is_description(message->number) ? used : not_used);
    if (!message->station || !follow(*message->station, now)) return rtcm_answer(*message, not_used);
    if (position) station_->position = place_of(*position);
    if (observations) take_observations(now, limits);
    if (station_->position && station_->observations && !station_->complete_since) station_->complete_since = now;
    return rtcm_answer(*message, used);
}

Bytes CorrectionInput::answer_to_damaged() { return rtcm_answer({}, crc_failed); }

CorrectionStatus CorrectionInput::status(GpsTime now, const CorrectionLimits& limits) const {
    CorrectionStatus status;
    if (!station_ || !station_->observations) return status;
    const Station& s = *station_;
    const Seconds age = std::max(difference(now, *s.observations), Seconds(0));
    status.age = age;
    status.station = s.id;
    status.base = s.position;
    if (!s.complete_since || now < *s.complete_since || age > limits.timeout) return status;

    status.state = CorrectionState::differential;
    if (!ability_.rtk) return status;
    const GpsTime begun = s.resumed && *s.resumed > *s.complete_since ? *s.resumed : *s.complete_since;
    const bool resumed = begun != *s.complete_since;
    const Seconds converged = difference(now, begun);
    if (!resumed && converged < ability_.float_after) return status;
    status.state = CorrectionState::rtk_float;
    const Seconds fixing = resumed ? ability_.fixed_after - ability_.float_after : ability_.fixed_after;
    if (converged >= fixing && age <= ability_.fixed_held && !limits.float_only)
        status.state = CorrectionState::rtk_fixed;
    return status;
}

}  // namespace skyloop::firmware
