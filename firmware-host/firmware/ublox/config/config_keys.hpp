/// Every configuration item that an emulated receiver can have, and the firmware that has it (`firmware_lists`;
/// RECEIVER.md 3.5).
///
/// The parts of the list of configuration items; `config_keys` puts them together.
/// Names of messages, as board files write them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "firmware/core/port_id.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {

/// How a value is to be read: logical, unsigned, signed, bit field, enumeration, floating point; with its bytes.
enum class ConfigType : std::uint8_t { l, u1, i1, x1, e1, u2, i2, x2, u4, i4, x4, r4, u8, i8, x8, r8 };

/// Firmware, a bit each, whose list of items has an item.
using FirmwareLists = std::uint16_t;
namespace listed {
inline constexpr FirmwareLists m9 = 1, m10_510 = 2, m10_530 = 4, f10 = 8, f9p_113 = 16, f9p_132 = 32, f9p_150 = 64,
                               f9p_15b = 128, x20p = 256;
inline constexpr FirmwareLists m10 = m10_510 | m10_530, f9p = f9p_113 | f9p_132 | f9p_150, f9 = f9p | f9p_15b,
                               f9_new = f9 & ~f9p_113, all = m9 | m10 | f10 | f9 | x20p, none = 0;
/// Receivers that do not list it store it all the same, for their legacy messages; VALGET and VALSET do not know it.
inline constexpr FirmwareLists kept = 1 << 15;
}  // namespace listed

/// A list of items, as a board names it.
struct FirmwareList {
    FirmwareLists bit = 0;
    std::string_view name;    ///< of the firmware: "HPG 1.32"
    std::string_view source;  ///< u-blox's number of the interface description
};
std::span<const FirmwareList> firmware_lists();

/// One item.
struct ConfigKey {
    std::uint32_t id = 0;
    std::string_view name;  ///< "CFG-RATE-MEAS"
    ConfigType type = ConfigType::u1;
    std::uint64_t default_value = 0;  ///< of the NEO-M9N; a board says where its own differs
    FirmwareLists lists = listed::none;
};

/// All of them, ascending by group and item, the size bits left aside.
std::span<const ConfigKey> config_keys();
/// The item of exactly this id, size bits among it, or null.
const ConfigKey* find_config_key(std::uint32_t id);
/// The item of this name, or null.
const ConfigKey* find_config_key(std::string_view name);

/// Group and item of a key without its size bits: what wildcards and order go by.
constexpr std::uint32_t group_and_item(std::uint32_t key) { return key & 0x00FF'FFFFu; }

/// A message that can be sent periodically, and the key of its rate on I2C; that of port p is the key plus p.
struct OutputMessage {
    UbxMessageId id;        ///< NMEA sentences are class F0, PUBX F1, RTCM F5, as CFG-MSG numbers them
    std::string_view name;  ///< "NAV-PVT", "GGA", "PUBX-00", "RTCM-1005"
    std::uint32_t i2c_key = 0;
};
/// All of them, ascending by id.
std::span<const OutputMessage> output_messages();
const OutputMessage* find_output_message(UbxMessageId id);
const OutputMessage* find_output_message(std::string_view name);
/// The key of a message's rate on a port, or nothing for a message that is never sent periodically.
std::optional<std::uint32_t> rate_key(UbxMessageId message, PortId port);

/// Keys that the receiver itself looks at.
namespace key {
inline constexpr std::uint32_t navspg_fixmode = 0x20110011, navspg_dynmodel = 0x20110021,
                               navspg_utcstandard = 0x2011001C, navspg_wknrollover = 0x30110017,
                               navspg_min_svs = 0x201100A1, navspg_max_svs = 0x201100A2, navspg_min_cno = 0x201100A3,
                               navspg_min_elev = 0x201100A4, navspg_cno_count = 0x201100AA,
                               navspg_cno_threshold = 0x201100AB, navspg_pdop = 0x301100B1, navspg_tdop = 0x301100B2,
                               navspg_pacc = 0x301100B3, navspg_tacc = 0x301100B4, navspg_dgnss_timeout = 0x201100C4,
                               navspg_ackaiding = 0x10110025, navspg_constr_alt = 0x401100C1,
                               navspg_constr_altvar = 0x401100C2;
inline constexpr std::uint32_t navhpg_dgnssmode = 0x20140011;
inline constexpr std::uint32_t rate_meas = 0x30210001, rate_nav = 0x30210002, rate_timeref = 0x20210003;
inline constexpr std::uint32_t mot_speed_threshold = 0x20250038, mot_distance_threshold = 0x3025003B;
inline constexpr std::uint32_t odo_use_odo = 0x10220001, sbas_scan_mask = 0x50360006;
inline constexpr std::uint32_t itfm_enable = 0x1041000D;
inline constexpr std::uint32_t geofence_confidence = 0x20240011, geofence_use_pio = 0x10240012,
                               geofence_polarity = 0x20240013, geofence_pin = 0x20240014;
inline constexpr std::uint32_t uart1_baudrate = 0x40520001, uart2_baudrate = 0x40530001;
inline constexpr std::uint32_t i2c_enabled = 0x10510003, uart1_enabled = 0x10520005, uart2_enabled = 0x10530005,
                               usb_enabled = 0x10650001;
inline constexpr std::uint32_t nmea_protver = 0x20930001, nmea_maxsvs = 0x20930002, nmea_compat = 0x10930003,
                               nmea_consider = 0x10930004, nmea_limit82 = 0x10930005, nmea_highprec = 0x10930006,
                               nmea_svnumbering = 0x20930007, nmea_filt_gps = 0x10930011, nmea_filt_sbas = 0x10930012,
                               nmea_filt_gal = 0x10930013, nmea_filt_qzss = 0x10930015, nmea_filt_glo = 0x10930016,
                               nmea_filt_bds = 0x10930017, nmea_out_invfix = 0x10930021, nmea_out_mskfix = 0x10930022,
                               nmea_out_invtime = 0x10930023, nmea_out_invdate = 0x10930024,
                               nmea_out_onlygps = 0x10930025, nmea_out_frozencog = 0x10930026,
                               nmea_main_talker = 0x20930031, nmea_gsv_talker = 0x20930032,
                               nmea_bds_talker = 0x30930033;
inline constexpr std::uint32_t ant_voltage_control = 0x10A3002E, ant_short_detect = 0x10A3002F,
                               ant_open_detect = 0x10A30031, ant_power_down = 0x10A30033, ant_recover = 0x10A30035;
inline constexpr std::uint32_t tmode_mode = 0x20030001;
inline constexpr std::uint32_t health_l5 = 0x10320001;  ///< takes L5 of GPS for as healthy as its L1
inline constexpr std::uint32_t pm_operate_mode = 0x20D00001, pm_update_period = 0x40D00002,
                               pm_search_period = 0x40D00003, pm_grid_offset = 0x40D00004, pm_on_time = 0x30D00005,
                               pm_least_acquisition = 0x20D00006, pm_longest_acquisition = 0x20D00007,
                               pm_never_off = 0x10D00008, pm_wait_for_time = 0x10D00009,
                               pm_update_ephemerides = 0x10D0000A, pm_extint_select = 0x20D0000B,
                               pm_extint_wake = 0x10D0000C, pm_extint_backup = 0x10D0000D,
                               pm_extint_inactive = 0x10D0000E, pm_extint_inactivity = 0x40D0000F,
                               pm_limit_peak = 0x10D00010;
/// Groups in which the item is 1 UBX, 2 NMEA, 4 RTCM3, and the size one bit.
constexpr std::uint32_t in_protocol(PortId port, std::uint32_t item) {
    constexpr std::uint32_t groups[] = {0x71, 0x73, 0x75, 0x77, 0x79};
    return 0x1000'0000u | groups[static_cast<std::size_t>(port)] << 16 | item;
}
constexpr std::uint32_t out_protocol(PortId port, std::uint32_t item) { return in_protocol(port, item) + 0x1'0000u; }
/// INF levels of a port (bits 0 error, 1 warning, 2 notice, 3 test, 4 debug), as UBX or as NMEA TXT.
constexpr std::uint32_t inf_ubx(PortId port) { return 0x2092'0001u + static_cast<std::uint32_t>(port); }
constexpr std::uint32_t inf_nmea(PortId port) { return 0x2092'0006u + static_cast<std::uint32_t>(port); }
}  // namespace key

/// The items of a fence, CFG-GEOFENCE-USE_FENCE1 … RAD and so on. @param number 1 … most_fences
struct FenceKeys {
    explicit constexpr FenceKeys(std::uint32_t number)
        : use(0x1024'0010u + 0x10 * number),
          latitude(0x4024'0011u + 0x10 * number),
          longitude(0x4024'0012u + 0x10 * number),
          radius(0x4024'0013u + 0x10 * number) {}
    std::uint32_t use, latitude, longitude, radius;
};
inline constexpr std::uint32_t most_fences = 4;

/// Of what the navigation does: signals, filters, time pulse, corrections.
std::span<const ConfigKey> navigation_keys();
/// Of ports and of the protocols on them.
std::span<const ConfigKey> ports_keys();
/// Of texts, sentences, hardware, power and security.
std::span<const ConfigKey> system_keys();
/// Items that no document has: what legacy messages store besides. They are not on the wire.
std::span<const ConfigKey> private_keys();

/// A message and the middle of its items' names: "UBX_NAV_PVT" of CFG-MSGOUT-UBX_NAV_PVT_UART1.
struct RateKeys {
    OutputMessage message;
    std::string_view stem;
    FirmwareLists lists;
};
/// As these names end, in the order of PortId.
inline constexpr std::array<std::string_view, ublox_port_count> rate_key_endings{"_I2C", "_UART1", "_UART2", "_USB",
                                                                                 "_SPI"};
/// Ascending by message. A key of the group `private_message_group` is one of our own.
std::span<const RateKeys> rate_keys();

/// Groups that no interface description uses: rates of messages without a key, and what legacy messages store.
inline constexpr std::uint32_t private_message_group = 0xFE, private_item_group = 0xFD;
/// Whether an item is one of u-blox's. Receivers store the others for their legacy messages; VALGET and VALSET do not
/// know them.
constexpr bool is_of_ublox(std::uint32_t key) {
    const std::uint32_t group = key >> 16 & 0xFF;
    return group != private_message_group && group != private_item_group;
}

/// A message that is answered, or that configures, but is never sent periodically.
struct NamedMessage {
    UbxMessageId id;
    std::string_view name;  ///< "MON-VER", "CFG-PRT"
};

/// What a client can poll beside what is sent periodically: MON-VER, SEC-UNIQID, the sentences that poll others, …
std::span<const NamedMessage> polled_messages();
/// The legacy messages of class CFG (M8 interface description, section 32.11).
std::span<const NamedMessage> legacy_messages();

}  // namespace skyloop::firmware
