#include "firmware/core/corrections.hpp"

#include <algorithm>
#include <array>

#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"
#include "receiver/protocol/ubx_raw.hpp"

namespace skyloop::firmware {
namespace {

constexpr Seconds silence_before_another{10};
// What RXM-RTCM and RXM-COR tell of messages without a station.
constexpr std::uint16_t no_station = 0xFFFF;

// Observations that a high-precision receiver takes (ZED-F9P interface description HPG 1.32, section 4.2.1).
bool is_observation(int number) {
    if ((number >= 1001 && number <= 1004) || (number >= 1009 && number <= 1012)) return true;
    const auto kind = msm_kind(number);
    return kind && (*kind == 4 || *kind == 5 || *kind == 7);
}

// What is taken and changes nothing here: antenna and receiver descriptions, u-blox's own.
bool is_description(int number) { return number == 1007 || number == 1008 || number == 1033 || number == 4072; }

// What has become of a frame.
enum class Use { damaged, not_used, used };

// Flags: bit 0 CRC failed, bits 1 and 2 (RECEIVER.md 3.2).
RxmRtcm rtcm_report(const Rtcm3Message& message, Use use) {
    RxmRtcm m;
    m.flags = use == Use::damaged ? 1 : use == Use::used ? 2 << 1 : 1 << 1;
    m.sub_type = static_cast<std::uint16_t>(message.subtype);
    m.ref_station = static_cast<std::uint16_t>(message.station.value_or(no_station));
    m.msg_type = static_cast<std::uint16_t>(message.number);
    return m;
}

// RTCM 3 is never encrypted; of a damaged frame nothing more is known than what it began like.
RxmCor correction_report(const Rtcm3Message& message, Use use, bool known) {
    constexpr std::uint32_t rtcm3 = 1, error_free = 1, erroneous = 2, unused = 1, in_use = 2, not_encrypted = 1;
    constexpr int with_subtype = 4072;
    RxmCor m;
    m.status_info = rtcm3 | (use == Use::damaged ? erroneous : error_free) << 5 |
                    (use == Use::used ? in_use : unused) << 7 |
                    static_cast<std::uint32_t>(message.station.value_or(no_station)) << 9;
    if (use == Use::damaged) return m;
    m.status_info |= not_encrypted << 28;
    if (message.number == 0) return m;  // too short to have a kind
    m.status_info |= 1u << 25 | (message.number == with_subtype ? 1u << 26 : 0u) | (known ? 1u << 27 : 0u);
    m.msg_type = static_cast<std::uint16_t>(message.number);
    m.msg_sub_type = static_cast<std::uint16_t>(message.subtype);
    return m;
}

CorrectionAnswer answer_of(const Rtcm3Message& message, Use use, bool known = true) {
    return {encode_frame(rtcm_report(message, use)), encode_frame(correction_report(message, use, known))};
}

// @param told ECEF, 0.1 mm
Position<Ecef> place_of(const std::array<std::int64_t, 3>& told) {
    constexpr double metres = 1e-4;
    const auto at = [&](std::size_t axis) { return metres * static_cast<double>(told[axis]); };
    return {at(0), at(1), at(2)};
}

}  // namespace

// Whether a station's messages count now.
bool CorrectionInput::follow(int station, GpsTime now) {
    if (station_ && station_->id == station) return true;
    const bool busy = station_ && station_->complete_since && station_->heard &&
                      difference(now, *station_->heard) <= silence_before_another;
    if (!busy) station_.emplace(station);
    return !busy;
}

CorrectionAnswer CorrectionInput::take(ByteSpan frame, GpsTime now, int leap_seconds) {
    const auto message = parse_rtcm3(frame);
    if (!message) return answer_of({}, Use::not_used, false);
    const auto position = decode_station(*message);
    const bool observations = is_observation(message->number);
    const bool biases = decode_glonass_biases(*message).has_value();
    const auto moving = decode_moving_station(*message);
    if (!position && !observations && !biases && !moving) {
        const bool known = is_description(message->number);
        return answer_of(*message, known ? Use::used : Use::not_used, known);
    }
    if (!message->station || !follow(*message->station, now)) return answer_of(*message, Use::not_used);
    Station& s = *station_;
    if (biases) s.data.take_glonass_biases();
    if (moving) {
        s.position = place_of(moving->position);
        s.data.take_moving(*s.position);
    }
    if (position) {
        s.position = place_of(position->position);
        s.data.take_position(*s.position);
    }
    if (observations) {
        if (s.heard && difference(now, *s.heard) > ability_.fixed_held) s.complete_since.reset();
        s.heard = now;
        if (const auto msm = decode_msm(*message)) s.data.take_observations(*msm, now, leap_seconds);
        if (const auto old = decode_legacy(*message)) s.data.take_observations(*old, now, leap_seconds);
    }
    if (s.position && s.heard && !s.complete_since) s.complete_since = now;
    return answer_of(*message, Use::used);
}

CorrectionAnswer CorrectionInput::answer_to_damaged() { return answer_of({}, Use::damaged, false); }

CorrectionStatus CorrectionInput::status(GpsTime now, const CorrectionLimits& limits) const {
    CorrectionStatus status;
    if (!station_ || !station_->heard) return status;
    const Station& s = *station_;
    // Of data the age, of messages that hold none the time since they came.
    const auto& data = s.data.station();
    const Seconds age = std::max(difference(now, data ? data->epoch.time : *s.heard), Seconds(0));
    status.age = age;
    status.station = s.id;
    status.base = s.position;
    if (!s.complete_since || now < *s.complete_since || age > limits.timeout) return status;

    status.state = CorrectionState::differential;
    const Seconds converged = difference(now, *s.complete_since);
    if (!ability_.rtk || converged < ability_.float_after) return status;
    status.state = CorrectionState::rtk_float;
    if (converged >= ability_.fixed_after && age <= ability_.fixed_held && !limits.float_only)
        status.state = CorrectionState::rtk_fixed;
    return status;
}

Corrections CorrectionInput::usable(GpsTime now, const CorrectionLimits& limits) const {
    Corrections corrections;
    if (!station_ || !station_->data.station() || now < station_->data.station()->epoch.time) return corrections;
    corrections.reference = station_->data.station();
    corrections.at_most = !ability_.rtk       ? CorrectionState::differential
                          : limits.float_only ? CorrectionState::rtk_float
                                              : CorrectionState::rtk_fixed;
    corrections.differential_timeout = limits.timeout;
    corrections.float_timeout = std::min(ability_.float_held, limits.timeout);
    corrections.fixed_timeout = std::min(ability_.fixed_held, limits.timeout);
    return corrections;
}

}  // namespace skyloop::firmware
