/// What the NMEA sentences of one epoch share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop::firmware {

/// Satellites that GSA, GSV and GRS report together.
struct NmeaGroup {
    NmeaSystem system;
    std::string talker;   ///< of GSV
    int first_signal_id;  ///< that it tracks of the system: of BeiDou B1I or B1C
};

/// The receiver's state as its configuration lets sentences tell it.
struct NmeaReport {
    const ReportContext& context;
    NmeaFormat format;
    NmeaNumbering numbering = NmeaNumbering::strict;
    std::string talker;  ///< of all sentences but GSV

    // RECEIVER.md 5.4
    bool valid = false;   ///< there is a fix within the limits
    bool status = false;  ///< A of RMC and GLL
    int quality = 0;      ///< of GGA
    int fix_mode = 1;     ///< of GSA
    NmeaMode mode = NmeaMode::none;
    NmeaMode course_mode = NmeaMode::none;  ///< of GLL and VTG, which know no RTK
    bool solved = false;                    ///< there is a solution, if one beyond the user's limits

    std::optional<NmeaTime> time{};
    std::optional<NmeaDate> date{};
    std::optional<NmeaPosition> position{};
    std::optional<MetresPerSecond> speed{};
    std::optional<Angle> course{};

    std::vector<NmeaGroup> groups{};            ///< of the systems that are enabled and let through
    std::vector<SatelliteStatus> satellites{};  ///< of these
    std::vector<SatelliteStatus> used{};        ///< of these
    int satellites_counted = 0;                 ///< in the solution

    [[nodiscard]] const Fix& fix() const { return context.state.epoch.fix; }
    /// Whether `satellite` is one of the group.
    [[nodiscard]] bool belongs(SatelliteId satellite, const NmeaGroup& group) const {
        return nmea_system(satellite.constellation, format.version) == group.system;
    }
};

NmeaReport nmea_report(const ReportContext& context);
/// The state that a sentence tells of: the context's, or one of before where the board is late with it. Null: there is
/// none yet.
const NavigationState* told_state(UbxMessageId message, const ReportContext& context);
/// nmea_signal_id() of what the receiver measures: where it takes B1C, that is what it calls BeiDou's first signal.
int tracked_signal_id(const NmeaReport& report, Constellation constellation, Signal signal);
/// DOPs of position as sentences show them: 99.99 where none was computed; nothing where the board leaves them out
/// then.
std::optional<Dop> shown_dops(const NmeaReport& report);
/// Sentences of the classes F0 (NMEA) and F1 (PUBX 00, 03, 04), as make_message() gives them.
std::vector<Bytes> make_nmea_message(UbxMessageId message, const NmeaReport& report);

/// Digits, version and forms of fields, from configuration and board.
NmeaFormat nmea_format(const BoardProfile& board, const ReceiverConfig& config);
/// The talker of all sentences but GSV: configured, the board's, or by the enabled systems (RECEIVER.md 5.2).
std::string nmea_talker(const BoardProfile& board, const ReceiverConfig& config);
/// UTC of the epoch as sentences write it, rounded once (RECEIVER.md 4.9).
UtcTime reported_utc(const ReportContext& context);

/// Satellites in use, one sentence for each group.
std::vector<Gsa> gsa_messages(const NmeaReport& report);
/// Satellites in view: since 4.10 a complete set of pages for each signal.
std::vector<Gsv> gsv_messages(const NmeaReport& report);
/// Residuals, in the order of GSA.
std::vector<Grs> grs_messages(const NmeaReport& report);

/// The sentence PUBX,00, 03 or 04; nothing for other numbers.
std::vector<Bytes> pubx_sentences(int number, const NmeaReport& report);

}  // namespace skyloop::firmware
