/// What the user of a Unicore receiver has set.
///
/// Sources: sparkfun/SparkFun_Unicore_GNSS_Arduino_Library (its examples print the answer to CONFIG), captures of
/// jclark/satpulse (gps/testdata/packets/unicore), Stefal/rtkbase and ArduPilot's AP_GPS_NMEA.cpp for what clients say.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/core/board_profile.hpp"
#include "firmware/core/receiver_config.hpp"

namespace skyloop::firmware {

/// What a log is made as.
enum class UnicoreForm { sentence, text, binary, rtcm };

/// A log that the receiver can send.
struct UnicoreLogKind {
    UnicoreForm form = UnicoreForm::sentence;
    std::string name;      ///< "GGA", "BESTNAV", "RTCM1074"; as the tables of messages call it
    UbxMessageId id{};     ///< of sentences and RTCM
    std::size_t rank = 0;  ///< of its place within an epoch
    bool operator==(const UnicoreLogKind&) const = default;
};
/// By the name that clients ask for: GPGGA and GNGGA, BESTNAVA, UNIAGRICA, RTCM1074, in any letter case. Nothing for
/// one that the board does not send.
std::optional<UnicoreLogKind> unicore_log(const BoardProfile& board, std::string_view name);
/// Whether the board solves a heading between two antennas of its own.
bool has_two_antennas(const BoardProfile& board);

/// A log on a port.
struct UnicoreLog {
    PortId port = PortId::uart1;
    std::string name;  ///< as it was asked for, in capitals
    UnicoreLogKind kind;
    std::uint64_t period_ms = 1000;
    bool operator==(const UnicoreLog&) const = default;
};

/// "COM1" to "COM3"; empty for another port.
std::string_view com_name(PortId port);
/// Nothing for another word, and for a port that the board does not have. In any letter case.
std::optional<PortId> com_port(const BoardProfile& board, std::string_view word);

/// Where a base stands, or how it finds that, as MODE said.
struct UnicoreMode {
    std::string words = "ROVER SURVEY";    ///< behind MODE, in capitals
    std::optional<SurveyLimits> survey{};  ///< BASE TIME
    std::optional<BasePlace> place{};      ///< BASE x y z, metres, or degrees and metres above the ellipsoid
    int station = 0;
    std::optional<int> dynamic_model{};  ///< numbered as by dynamic_model_of()
};
/// Nothing for words that are no mode.
std::optional<UnicoreMode> unicore_mode(std::span<const std::string> words);

/// The settings, all of them. What is saved is a list of commands.
class UnicoreSettings {
public:
    explicit UnicoreSettings(const BoardProfile& board);

    UnicoreMode mode;
    std::map<PortId, std::uint32_t> bauds;
    std::vector<UnicoreLog> logs;
    double mask_deg = 5;
    std::optional<double> least_cn0;
    std::set<Constellation> masked;

    /// Puts a log in place of one of the same kind on the same port.
    void add(const UnicoreLog& log);
    /// Takes logs off. @param kind nothing: all of them
    void remove(std::optional<PortId> port, const std::optional<UnicoreLogKind>& kind);
    /// CONFIG TOPIC …; false for words that are none.
    bool set_topic(std::span<const std::string> words);
    /// "CONFIG RTK TIMEOUT 120" and so on, each with its topic.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> topic_lines() const;
    [[nodiscard]] std::optional<double> topic_number(std::string_view topic) const;
    /// The commands that make these settings from the factory's, a line each.
    [[nodiscard]] std::string text(const UnicoreSettings& factory) const;

private:
    std::map<std::string, std::string> topics_;  // "RTK TIMEOUT": "120"
};

/// The longest period at which each log finds its epochs, ms; nothing without a log.
std::optional<std::uint64_t> wanted_period_ms(const UnicoreSettings& settings);

/// Systems by the words that MASK has for them.
std::optional<Constellation> masked_system(std::string_view word);

}  // namespace skyloop::firmware
