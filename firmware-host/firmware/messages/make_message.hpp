/// From the receiver's state to the bytes of a message.
/// The three parts in which NAV and TIM messages are made, and what they share.
/// What messages about satellites and about their signals share.
/// The parts in which MON and SEC messages are made.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/navigation_state.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/sentences/nmea_report.hpp"

namespace skyloop::firmware {

/// The whole frames or sentences of one message, most often one: GSV has pages, RXM-SFRBX one for each subframe. Empty
/// when there is nothing to say, or the message is not known. Classes F0, F1 and F5 are NMEA, PUBX and RTCM.
std::vector<Bytes> make_message(UbxMessageId message, const ReportContext& context);

/// Whether make_message() has nothing of a message that boards have a rate for: nothing that it would report happens
/// here.
bool makes_nothing_of(UbxMessageId message);

/// The messages of one epoch: each is made once, however many ports send it, and what sentences share as well.
class EpochMessages {
public:
    /// @param context its parts must outlive this
    explicit EpochMessages(const ReportContext& context) : context_(context) {}
    /// What the port sends. RTCM and MON-COMMS alone differ by port: a frame of RTCM tells whether more of the epoch
    /// follow, MON-COMMS by which port it leaves.
    /// @param following as ReportContext::following; has to outlive this call alone
    const std::vector<Bytes>& of(UbxMessageId message, PortId port, std::span<const UbxMessageId> following);
    [[nodiscard]] const NavigationState& state() const { return context_.state; }
    /// What other messages of the epoch are made from.
    [[nodiscard]] ReportContext context(PortId port) const {
        return {context_.board, context_.config, context_.state, context_.ports, port};
    }

private:
    ReportContext context_;
    std::optional<NmeaReport> report_;
    std::map<UbxMessageId, std::vector<Bytes>> made_;
};

/// Of the classes NAV and TIM.
std::vector<Bytes> make_navigation_message(UbxMessageId message, const ReportContext& context);
/// How many time pulses there have been by the epoch, counted from the origin of their grid: TIM-TP comes once for
/// each. Nothing: CFG-TP makes none.
std::optional<std::int64_t> pulses_until_epoch(const ReportContext& context);
/// NAV-SAT, NAV-SVINFO, NAV-SIG, NAV-ORB, NAV-SBAS.
std::vector<Bytes> make_satellite_message(UbxMessageId message, const ReportContext& context);
/// Of the class RXM.
std::vector<Bytes> make_raw_message(UbxMessageId message, const ReportContext& context);
/// Of the classes MON and SEC.
std::vector<Bytes> make_monitor_message(UbxMessageId message, const ReportContext& context);
/// Of the class F5, whose ids are what RTCM's numbers have beyond 1000: 1005 of a station in fixed mode, MSM4 to MSM7
/// of every system, 1001 to 1004, 1009 to 1012, and 1230. Nothing before time is known, for a system without
/// observations and for others.
std::vector<Bytes> make_rtcm_message(UbxMessageId message, const ReportContext& context);

/// Levels of texts for people, as NMEA TXT numbers them; 3 are tests.
inline constexpr int text_error = 0, text_warning = 1, text_notice = 2, text_debug = 4, text_user = 7;
/// A text for people, as NMEA TXT and as UBX INF, by what the port's configuration lets through. One that begins with
/// "$" is a whole sentence, without checksum.
std::vector<Bytes> make_text_message(int level, const std::string& text, const ReportContext& context);

/// NAV messages of position, velocity and quality. Empty for any other.
std::vector<Bytes> make_solution_message(UbxMessageId message, const ReportContext& context);
/// NAV-TIME…, NAV-CLOCK and class TIM. Empty for any other.
std::vector<Bytes> make_time_message(UbxMessageId message, const ReportContext& context);
/// The other NAV messages without satellites: covariances, odometer, base station, fences, end of the epoch. Empty for
/// any other.
std::vector<Bytes> make_service_message(UbxMessageId message, const ReportContext& context);

/// A DOP of a message: 99.99 at most and where it was not computed.
double reported_dop(double dop, bool computed);
/// Satellites in the solution; 0 without one.
std::uint8_t used_satellites(const Fix& fix);
/// The course, frozen at low speed, 1e-5 deg, 0 … 35 999 999.
std::int32_t course_field(const NavigationState& state);
/// 1 σ of it, 180° at most and while it is frozen.
double reported_course_accuracy_deg(const NavigationState& state);

/// Where a satellite stands, in whole degrees.
struct SkyFields {
    std::int8_t elevation = -91;  ///< −91: unknown
    std::int16_t azimuth = 0;
};
SkyFields sky_fields(const SatelliteStatus& s, const NavigationState& state);

/// Ascending by system and number, at most as many as a message can count.
std::vector<SatelliteStatus> sorted_satellites(const Fix& fix);

/// Where the corrections in the solution come from.
enum class CorrectionOrigin { none, sbas, rtcm3 };
CorrectionOrigin corrections_in_use(const NavigationState& state);

/// 0 unknown, 1 healthy, 2 unhealthy.
std::uint32_t satellite_health(const SatelliteStatus& s, const NavigationState& state);

/// qualityInd: 1 searched for, 2 acquired, 3 no range, 4 code locked, 6 and 7 carrier locked too. Models that measure
/// nothing track at 7.
std::uint32_t satellite_quality(const SatelliteStatus& s, const NavigationState& state);
std::uint8_t signal_quality(const Observation& observation);

/// MON-HW, HW2, HW3, RF and SPAN. Empty for any other.
std::vector<Bytes> make_hardware_message(UbxMessageId message, const ReportContext& context);

/// True for firmware of the high-precision line (FWVER=HPG): two front ends, and its own numbers for ports.
inline bool is_high_precision(const BoardProfile& board) {
    return std::any_of(board.identity.extensions.begin(), board.identity.extensions.end(),
                       [](const std::string& text) { return text.starts_with("FWVER=HPG"); });
}

/// A text filled up with zeros, or cut.
template <std::size_t Size>
std::array<char, Size> padded_text(std::string_view text) {
    std::array<char, Size> characters{};
    std::copy_n(text.begin(), std::min(Size, text.size()), characters.begin());
    return characters;
}

}  // namespace skyloop::firmware
