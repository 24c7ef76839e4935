/// Items behind legacy messages that the receiver itself does not look at. Those of group FD are ours: no document
/// gives them an id, and VALGET does not know them. Bits 8 to 11 of such an item say to which section of CFG-CFG it
/// belongs.
#pragma once

#include <cstdint>

#include "firmware/core/port_id.hpp"

namespace skyloop::firmware::legacy_key {

/// The group of our own items, and that of the message rates which have no item of u-blox.
inline constexpr std::uint32_t own_group = 0xFD, own_rate_group = 0xFE;

inline constexpr std::uint32_t lock = 0x10F60009, unlocked_group_1 = 0x30F6000A, unlocked_group_2 = 0x30F6000B;

inline constexpr std::uint32_t i2c_address = 0x20510001, i2c_extended_timeout = 0x10510002, spi_max_ff = 0x20640001,
                               spi_polarity = 0x10640002, spi_phase = 0x10640003, spi_extended_timeout = 0x10640005,
                               usb_self_powered = 0x10650002;
/// Items of CFG-UART1 and CFG-UART2: 1 baud rate, 2 stop bits, 3 data bits, 4 parity.
constexpr std::uint32_t uart(PortId port, std::uint32_t size_and_item) {
    return size_and_item + (port == PortId::uart2 ? 0x0053'0000u : 0x0052'0000u);
}
constexpr std::uint32_t uart_baud(PortId port) { return uart(port, 0x4000'0001u); }
constexpr std::uint32_t uart_stop_bits(PortId port) { return uart(port, 0x2000'0002u); }
constexpr std::uint32_t uart_data_bits(PortId port) { return uart(port, 0x2000'0003u); }
constexpr std::uint32_t uart_parity(PortId port) { return uart(port, 0x2000'0004u); }

// Section 0, ioPort.
constexpr std::uint32_t tx_ready(PortId port) { return 0x30FD'0001u + static_cast<std::uint32_t>(port); }
/// Bit 4 of the mode, which means nothing, but which receivers give back.
constexpr std::uint32_t mode_bit_4(PortId port) { return 0x10FD'0010u + static_cast<std::uint32_t>(port); }
constexpr std::uint32_t rtcm2_in(PortId port) { return 0x10FD'0020u + static_cast<std::uint32_t>(port); }
inline constexpr std::uint32_t usb_vendor_id = 0x3065000A, usb_product_id = 0x3065000B, usb_power = 0x3065000C;
/// Four items of eight characters each.
inline constexpr std::uint32_t usb_vendor_string = 0x5065000D, usb_product_string = 0x50650011,
                               usb_serial_number = 0x50650015;

// Navigation; section 3, navConf.
inline constexpr std::uint32_t inifix3d = 0x10110013, ack_aiding = 0x10110025, use_ppp = 0x10110019,
                               sig_att_comp = 0x201100D6, use_ana = 0x10230001, ana_max_error = 0x30230002;
inline constexpr std::uint32_t dr_limit = 0x20FD0301, use_adr = 0x10FD0302, max_sbas = 0x20FD0303;
inline constexpr std::uint32_t odo_use = 0x10220001, odo_use_cog = 0x10220002, odo_out_lp_vel = 0x10220003,
                               odo_out_lp_cog = 0x10220004, odo_profile = 0x20220005, odo_cog_max_speed = 0x20220021,
                               odo_cog_max_pos_acc = 0x20220022, odo_vel_lp_gain = 0x20220031,
                               odo_cog_lp_gain = 0x20220032;
inline constexpr std::uint32_t tmode_pos_type = 0x20030002, tmode_ecef = 0x40030003, tmode_ecef_hp = 0x20030006,
                               tmode_geodetic = 0x40030009, tmode_geodetic_hp = 0x2003000C,
                               tmode_fixed_pos_acc = 0x4003000F, tmode_svin_min_dur = 0x40030010,
                               tmode_svin_acc_limit = 0x40030011;

// Signals, power, time pulses; section 4, rxmConf.
inline constexpr std::uint32_t sbas_enabled = 0x10310020, sbas_test_mode = 0x10360002, sbas_ranging = 0x10360003,
                               sbas_corrections = 0x10360004, sbas_integrity = 0x10360005, sbas_scan_mask = 0x50360006;
inline constexpr std::uint32_t gnss_channels_used = 0x20FD0401;  ///< 0: as the board has it
/// Of one system: bits 0-7 reserved channels, 8-15 the most, bit 31 that they were set.
constexpr std::uint32_t gnss_channels(std::uint8_t gnss_id) { return 0x40FD'0410u + gnss_id; }
inline constexpr std::uint32_t imes_enabled = 0x10FD0420, imes_l1 = 0x10FD0421;
inline constexpr std::uint32_t tp_ant_cable_delay = 0x30050001, tp_pulse_def = 0x20050023,
                               tp_pulse_length_def = 0x20050030;
/// By the number of the time pulse, 0 or 1.
constexpr std::uint32_t tp_rf_group_delay(unsigned index) { return 0x30FD'0430u + index; }
constexpr std::uint32_t tp_sync_mode(unsigned index) { return 0x20FD'0432u + index; }
/// How the second pulse of an M8 is given; later receivers have one definition for both.
inline constexpr std::uint32_t tp2_pulse_def = 0x20FD0434, tp2_pulse_length_def = 0x20FD0435;
inline constexpr std::uint32_t pms_setup = 0x20FD0440, pm_flags = 0x40FD0441, pm_update_rest = 0x30FD0442,
                               pm_search_rest = 0x30FD0443, pm_grid_rest = 0x30FD0444;
/// Of pm_flags, as of CFG-PM2: 0 on and off, 1 cyclic; of CFG-PM-OPERATEMODE one more, where 0 is full power.
inline constexpr unsigned power_mode_shift = 17;
inline constexpr std::uint32_t power_mode_mask = 3u << power_mode_shift;
inline constexpr std::uint32_t itfm_bb_threshold = 0x20410001, itfm_cw_threshold = 0x20410002,
                               itfm_antenna = 0x20410010, itfm_enable_aux = 0x10410013;

// Section 10, antConf; section 11, logConf.
inline constexpr std::uint32_t ant_switch_pin = 0x20A30036, ant_short_pin = 0x20A30037, ant_open_pin = 0x20A30038;
inline constexpr std::uint32_t log_record = 0x10DE0002, log_once_per_wake_up = 0x10DE0003, log_all_filters = 0x10DE0004,
                               log_min_interval = 0x30DE0005, log_time = 0x30DE0006, log_speed = 0x30DE0007,
                               log_position = 0x40DE0008;

}  // namespace skyloop::firmware::legacy_key
