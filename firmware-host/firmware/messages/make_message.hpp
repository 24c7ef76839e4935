/// From the receiver's state to the bytes of a message.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/messages/nmea_report.hpp"
#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// The whole frames or sentences of one message, most often one: GSV has pages, RXM-SFRBX one for each subframe. Empty
/// when there is nothing to say, or the message is not known. Classes F0, F1 and F5 are NMEA, PUBX and RTCM.
std::vector<Bytes> make_message(UbxMessageId message, const ReportContext& context);

/// The messages of one epoch: each is made once, however many ports send it, and what sentences share as well.
class EpochMessages {
public:
    /// @param context its parts must outlive this
    explicit EpochMessages(const ReportContext& context) : context_(context) {}
    /// What the port sends. RTCM and MON-COMMS alone differ by port: a frame of RTCM tells whether more of the epoch
    /// follow, MON-COMMS by which port it leaves.
    /// @param following as ReportContext::following; has to outlive this call alone
    const std::vector<Bytes>& of(UbxMessageId message, PortId port, std::span<const UbxMessageId> following);

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
/// Of the class F5: RTCM 1005 of a station in fixed mode, MSM4 and MSM7 of GPS, GLONASS, Galileo and BeiDou, and 1230.
/// Nothing before time is known, for a system without observations and for 1006, 4072.0 and 4072.1.
std::vector<Bytes> make_rtcm_message(UbxMessageId message, const ReportContext& context);

/// Levels of texts for people, as NMEA TXT numbers them; 3 are tests.
inline constexpr int text_error = 0, text_warning = 1, text_notice = 2, text_debug = 4, text_user = 7;
/// A text for people, as NMEA TXT and as UBX INF, by what the port's configuration lets through. One that begins with
/// "$" is a whole sentence, without checksum.
std::vector<Bytes> make_text_message(int level, const std::string& text, const ReportContext& context);

}  // namespace skyloop::firmware
