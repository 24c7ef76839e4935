/// Messages and services of DroneCAN that a GNSS node sends or takes.
///
/// Layouts: the DSDL of dronecan/DSDL (folders uavcan and ardupilot), in classic CAN's form. Signatures follow from the
/// DSDL by its rules (CRC-64-WE of the normalised definition).
#pragma once

#include <cstdint>
#include <string_view>

#include "receiver/protocol/dronecan_fields.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline receiver {

/// Messages are broadcast; requests and responses go from one node to another.
enum class DronecanKind : std::uint8_t { message, request, response };

/// A data type of DSDL, or half a service.
struct DronecanType {
    std::string_view name;  ///< "Fix2"; of halves of a service that of the service
    DronecanKind kind = DronecanKind::message;
    std::uint16_t id = 0;         ///< of messages 0 … 65535, of services 0 … 255
    std::uint64_t signature = 0;  ///< that the CRC of a long transfer begins with
};

// uavcan.equipment.gnss and ardupilot.gnss

/// uavcan.equipment.gnss.Fix2.
struct DronecanFix2 {
    static constexpr DronecanType type{"Fix2", DronecanKind::message, 1063, 0xCA41E7000F37435F};
    Unsigned<"timestamp_s*1e-6!0", 56> timestamp;            ///< of the message, by the network's clock
    Unsigned<"gnss_timestamp_s*1e-6!0", 56> gnss_timestamp;  ///< of the solution, by `time_standard`; of UTC since 1970
    Unsigned<"time_standard", 3> time_standard;              ///< 0 none, 1 TAI, 2 UTC, 3 GPS
    Void<13> reserved{};
    Unsigned<"leap_seconds!0", 8> leap_seconds;
    Signed<"longitude_deg*1e-8", 37> longitude;
    Signed<"latitude_deg*1e-8", 37> latitude;
    Signed<"height_m*1e-3", 27> height;          ///< above the ellipsoid
    Signed<"msl_height_m*1e-3", 27> msl_height;  ///< above mean sea level
    Single<"velocity_ned_mps", 3> velocity{};
    Unsigned<"satellites", 6> satellites;
    Unsigned<"status", 2> status;      ///< 0 no fix, 1 time only, 2 2D, 3 3D
    Unsigned<"mode", 4> mode;          ///< 0 single, 1 DGPS, 2 RTK, 3 PPP
    Unsigned<"sub_mode", 6> sub_mode;  ///< of DGPS 0 other, 1 SBAS; of RTK 0 float, 1 fixed
    /// m², (m/s)²: the diagonal (6), or the matrix' upper triangle (21) or all of it (36); north, east, down of both.
    BitList<"covariance", HalfBits, 36> covariance;
    Half<"pdop"> pdop;
    TailList<"ecef_position_velocity", ByteBits, 99> ecef;  ///< at most one ECEFPositionVelocity, as its bytes
};

/// uavcan.equipment.gnss.Auxiliary.
struct DronecanAuxiliary {
    static constexpr DronecanType type{"Auxiliary", DronecanKind::message, 1061, 0x9BE8BDC4C3DBBFD2};
    Half<"gdop"> gdop;
    Half<"pdop"> pdop;
    Half<"hdop"> hdop;
    Half<"vdop"> vdop;
    Half<"tdop"> tdop;
    Half<"ndop"> ndop;
    Half<"edop"> edop;
    Unsigned<"visible", 7> visible;
    Unsigned<"used", 6> used;
};

/// uavcan.equipment.gnss.RTCMStream.
struct DronecanRtcmStream {
    static constexpr DronecanType type{"RTCMStream", DronecanKind::message, 1062, 0x1F56030ECB171501};
    Unsigned<"protocol", 8> protocol = 3;  ///< 0 not known, 2 RTCM 2, 3 RTCM 3
    TailList<"data", ByteBits, 128> data;
};

/// ardupilot.gnss.Heading.
struct DronecanHeading {
    static constexpr DronecanType type{"Heading", DronecanKind::message, 20002, 0x315CAE39ECED3412};
    Flag<"heading_valid"> heading_valid;
    Flag<"accuracy_valid"> accuracy_valid;
    Half<"heading_rad"> heading;
    Half<"accuracy_rad"> accuracy;
};

/// ardupilot.gnss.Status.
struct DronecanGnssStatus {
    static constexpr DronecanType type{"Status", DronecanKind::message, 20003, 0xBA3CB4ABBB007F69};
    Unsigned<"error_codes", 32> error_codes;
    Flag<"healthy"> healthy;
    Unsigned<"status", 23> status;  ///< bits: 0 it logs, 1 the autopilot may arm
};

/// ardupilot.gnss.MovingBaselineData: RTCM of a moving base.
struct DronecanMovingBaselineData {
    static constexpr DronecanType type{"MovingBaselineData", DronecanKind::message, 20005, 0x09F323748C32133A};
    TailList<"data", ByteBits, 300> data;
};

/// ardupilot.gnss.RelPosHeading.
struct DronecanRelPosHeading {
    static constexpr DronecanType type{"RelPosHeading", DronecanKind::message, 20006, 0xA1727AF295F94478};
    Unsigned<"timestamp_s*1e-6!0", 56> timestamp;
    Flag<"accuracy_available"> accuracy_available;
    Single<"heading_deg"> heading;
    Single<"accuracy_deg"> accuracy;
    Half<"distance_m"> distance;
    Half<"down_m"> down;
};

// uavcan.protocol

/// uavcan.protocol.NodeStatus.
struct DronecanNodeStatus {
    static constexpr DronecanType type{"NodeStatus", DronecanKind::message, 341, 0x0F0868D0C1A7C6F1};
    Unsigned<"uptime_s", 32> uptime;
    Unsigned<"health", 2> health;  ///< 0 OK, 1 warning, 2 error, 3 critical
    Unsigned<"mode", 3> mode;      ///< 0 operational, 1 initialization, 2 maintenance, 3 software update, 7 offline
    Unsigned<"sub_mode", 3> sub_mode;
    Unsigned<"vendor_code", 16> vendor_code;
};

/// uavcan.protocol.dynamic_node_id.Allocation.
struct DronecanAllocation {
    static constexpr DronecanType type{"Allocation", DronecanKind::message, 1, 0x0B2A812620A11D40};
    Unsigned<"node_id", 7> node_id;  ///< that is wanted, or given; 0: any, or none
    Flag<"first_part"> first_part;
    TailList<"unique_id", ByteBits, 16> unique_id;
};

struct DronecanGetNodeInfoRequest {
    static constexpr DronecanType type{"GetNodeInfo", DronecanKind::request, 1, 0xEE468A8121C46A9E};
    static void fields(auto&, auto&) {}
};
/// uavcan.protocol.GetNodeInfo, with SoftwareVersion and HardwareVersion.
struct DronecanGetNodeInfoResponse {
    static constexpr DronecanType type{"GetNodeInfo", DronecanKind::response, 1, 0xEE468A8121C46A9E};
    DronecanNodeStatus status;
    Unsigned<"software_major", 8> software_major;
    Unsigned<"software_minor", 8> software_minor;
    Unsigned<"software_flags", 8> software_flags;  ///< bits: 0 the commit is known, 1 the CRC is
    Unsigned<"software_commit", 32> software_commit;
    Unsigned<"image_crc", 64> image_crc;
    Unsigned<"hardware_major", 8> hardware_major;
    Unsigned<"hardware_minor", 8> hardware_minor;
    BitField<"unique_id", 8, std::uint8_t, 16> unique_id{};
    BitList<"certificate", ByteBits, 255> certificate;
    TailList<"name", CharacterBits, 80> name;
};

struct DronecanRestartNodeRequest {
    static constexpr DronecanType type{"RestartNode", DronecanKind::request, 5, 0x569E05394A3017F0};
    static constexpr std::uint64_t magic = 0xACCE551B1E;
    Unsigned<"magic_number", 40> magic_number;
};
struct DronecanRestartNodeResponse {
    static constexpr DronecanType type{"RestartNode", DronecanKind::response, 5, 0x569E05394A3017F0};
    Flag<"ok"> ok;
};

struct DronecanExecuteOpcodeRequest {
    static constexpr DronecanType type{"ExecuteOpcode", DronecanKind::request, 10, 0x3B131AC5EB69D2CD};
    static constexpr std::uint64_t save = 0, erase = 1;
    Unsigned<"opcode", 8> opcode;
    Signed<"argument", 48> argument;
};
struct DronecanExecuteOpcodeResponse {
    static constexpr DronecanType type{"ExecuteOpcode", DronecanKind::response, 10, 0x3B131AC5EB69D2CD};
    Signed<"argument", 48> argument;
    Flag<"ok"> ok;
};

/// uavcan.protocol.param.Value: one of these, or none.
struct DronecanValue {
    enum Tag : std::uint64_t { empty, integer_value, real_value, boolean_value, string_value };
    Unsigned<"kind", 3> tag = empty;
    Signed<"integer", 64> integer;
    Single<"real"> real;
    Unsigned<"boolean", 8> boolean;
    BitList<"text", CharacterBits, 128> text;
    static void fields(auto& m, auto& v) {
        v(m.tag);
        if (m.tag == integer_value) v(m.integer);
        if (m.tag == real_value) v(m.real);
        if (m.tag == boolean_value) v(m.boolean);
        if (m.tag == string_value) v(m.text);
    }
};
/// uavcan.protocol.param.NumericValue.
struct DronecanNumber {
    Unsigned<"kind", 2> tag = DronecanValue::empty;
    Signed<"integer", 64> integer;
    Single<"real"> real;
    static void fields(auto& m, auto& v) {
        v(m.tag);
        if (m.tag == DronecanValue::integer_value) v(m.integer);
        if (m.tag == DronecanValue::real_value) v(m.real);
    }
};

struct DronecanGetSetRequest {
    static constexpr DronecanType type{"GetSet", DronecanKind::request, 11, 0xA7B622F939D1A4D5};
    Unsigned<"index", 13> index;
    DronecanValue value;                       ///< empty: the parameter is asked for, not set
    TailList<"name", CharacterBits, 92> name;  ///< empty: `index` says which
};
/// uavcan.protocol.param.GetSet; without a name there is no such parameter.
struct DronecanGetSetResponse {
    static constexpr DronecanType type{"GetSet", DronecanKind::response, 11, 0xA7B622F939D1A4D5};
    Void<5> before_value{};
    DronecanValue value;
    Void<5> before_default{};
    DronecanValue default_value;
    Void<6> before_most{};
    DronecanNumber most;
    Void<6> before_least{};
    DronecanNumber least;
    TailList<"name", CharacterBits, 92> name;
};

struct DronecanBeginFirmwareUpdateRequest {
    static constexpr DronecanType type{"BeginFirmwareUpdate", DronecanKind::request, 40, 0xB7D725DF72724126};
    Unsigned<"source_node_id", 8> source_node_id;
    TailList<"path", CharacterBits, 200> path;
};
/// uavcan.protocol.file.BeginFirmwareUpdate.
struct DronecanBeginFirmwareUpdateResponse {
    static constexpr DronecanType type{"BeginFirmwareUpdate", DronecanKind::response, 40, 0xB7D725DF72724126};
    static constexpr std::uint64_t invalid_mode = 1;
    Unsigned<"error", 8> error;  ///< 0 none, 1 not in this mode, 2 in progress, 255 not known
    TailList<"message", CharacterBits, 127> message;
};

/// All of them.
using KnownDronecanTypes =
    MessageTypes<DronecanFix2, DronecanAuxiliary, DronecanRtcmStream, DronecanHeading, DronecanGnssStatus,
                 DronecanMovingBaselineData, DronecanRelPosHeading, DronecanNodeStatus, DronecanAllocation,
                 DronecanGetNodeInfoRequest, DronecanGetNodeInfoResponse, DronecanRestartNodeRequest,
                 DronecanRestartNodeResponse, DronecanExecuteOpcodeRequest, DronecanExecuteOpcodeResponse,
                 DronecanGetSetRequest, DronecanGetSetResponse, DronecanBeginFirmwareUpdateRequest,
                 DronecanBeginFirmwareUpdateResponse>;

/// Of the known type of that kind and id; null: it is not known.
const DronecanType* find_dronecan_type(DronecanKind kind, std::uint16_t id);

}  // namespace skyloop::inline receiver
