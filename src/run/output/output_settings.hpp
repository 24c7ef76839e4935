/// What a user types after --output.
///
/// The folder output is how other programs get what receivers report without a serial line: as messages of autopilots'
/// protocols and as JSON, over the network or into a file. It watches the run and never makes the loop wait.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline run {

/// As what an epoch is told.
enum class OutputFormat {
    gps_input,  ///< MAVLink GPS_INPUT, for ArduPilot
    hil_gps,    ///< MAVLink HIL_GPS, for PX4 on a simulator's link
    msp,        ///< MSP2_SENSOR_GPS, for iNav, Betaflight and ArduPilot
    json,       ///< a line of JSON: truth, report and satellites
    rtcm,       ///< RTCM 3: what a base station with this receiver sends
};
inline constexpr std::array<std::string_view, 5> output_format_names{"gps-input", "hil-gps", "msp", "json", "rtcm"};

enum class OutputWay { udp, tcp_server, tcp_client, file };

/// When an epoch is told.
enum class OutputMoment {
    report,  ///< when the receiver's own messages of it begin to leave
    epoch,   ///< as soon as it has been solved
};
inline constexpr std::array<std::string_view, 2> output_moment_names{"report", "epoch"};

/// What HIL_GPS carries in `eph` and `epv`.
enum class HilGpsAccuracy {
    px4_cm,  ///< the accuracies in centimetres, as PX4 reads them
    dop100,  ///< the dilutions of precision times 100, as common.xml says
};
inline constexpr std::array<std::string_view, 2> hil_gps_accuracy_names{"px4_cm", "dop100"};

/// One output as it was asked for, not opened.
struct OutputSettings {
    std::string uri;  ///< as it was written, without its options
    OutputFormat format = OutputFormat::json;
    OutputWay way = OutputWay::udp;
    TcpAddress address{};  ///< of udp, too
    std::string path;      ///< of a file; "-": standard output
    std::string receiver;  ///< its name; empty: JSON tells all, the others tell the first
    OutputMoment when = OutputMoment::report;
    std::uint8_t system = 1;       ///< of MAVLink, 1 … 255
    std::uint8_t component = 220;  ///< of MAVLink, 1 … 255; 220: MAV_COMP_ID_GPS
    std::uint8_t id = 0;           ///< which receiver of the vehicle: gps_id, id, instance
    HilGpsAccuracy eph = HilGpsAccuracy::px4_cm;
    std::uint16_t station = 0;         ///< of RTCM, 0 … 4095
    std::uint8_t msm = 7;              ///< kind of the observations, 4 … 7
    std::uint16_t every_s = 10;        ///< between places, antennas and receivers of RTCM; 1 … 3600
    std::uint16_t ephemerides_s = 30;  ///< between the records of satellites, 0 … 3600; 0: none are sent
};

/// Reads FORMAT[-WAY]:TARGET[,KEY=VALUE]…: the formats as above; `udp:HOST:PORT`, `tcp:[HOST:]PORT` (a server),
/// `tcp-to:HOST:PORT` (calls a server) or `file:PATH`, "-" for standard output. Without a way gps-input and hil-gps go
/// by udp. Keys: receiver, when, system, component, id, eph, station, msm, every_s, ephemerides_s, each once and where
/// foreign_option() has nothing against it. Fails with `usage` and a sentence that quotes the text.
Result<OutputSettings> parse_output_uri(std::string_view text);

/// What to say of an option that messages of this format have no place for; empty: they have one.
std::string foreign_option(OutputFormat format, std::string_view key);

/// Which of these receivers an output tells. Fails with `usage` when it names another.
Result<std::vector<bool>> told_receivers(const OutputSettings& settings, const std::vector<std::string>& names);

}  // namespace skyloop::inline run
