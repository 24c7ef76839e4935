/// SBF blocks of the solution in ECEF, and of the receiver's setup and sky.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), sections 4.2.10, 4.2.15 and 4.2.16.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "receiver/protocol/sbf_blocks.hpp"

namespace skyloop::inline receiver {

/// PVTCartesian: position, velocity, time. Its fields are those of PVTGeodetic, but for the axes.
struct SbfPvtCartesian {
    static constexpr std::uint16_t block_number = 4006;
    static constexpr std::uint8_t block_revision = 2;
    static constexpr std::string_view message_name = "PVTCartesian";
    SbfTime time;
    U1<"mode"> mode{};
    U1<"error"> error = 1;
    R8<"x_m!-2e10"> x = sbf_nothing;
    R8<"y_m!-2e10"> y = sbf_nothing;
    R8<"z_m!-2e10"> z = sbf_nothing;
    R4<"undulation_m!-2e10"> undulation = sbf_nothing;
    R4<"vx_mps!-2e10"> vx = sbf_nothing;
    R4<"vy_mps!-2e10"> vy = sbf_nothing;
    R4<"vz_mps!-2e10"> vz = sbf_nothing;
    R4<"course_deg!-2e10"> course = sbf_nothing;
    R8<"clock_bias_ms!-2e10"> clock_bias = sbf_nothing;
    R4<"clock_drift_ppm!-2e10"> clock_drift = sbf_nothing;  ///< 1e-6
    U1<"time_system!255"> time_system = 0xFF;
    U1<"datum!255"> datum = 0xFF;
    U1<"satellites!255"> num_sv = 0xFF;
    U1<"wa_corr_info"> wa_corr_info{};
    U2<"reference_id!65535"> reference_id = 0xFFFF;
    U2<"mean_corr_age_s*1e-2!65535"> mean_corr_age = 0xFFFF;
    U4<"signal_info"> signal_info{};
    U1<"alert_flag"> alert_flag{};
    U1<"bases"> num_bases{};
    U2<"ppp_info"> ppp_info{};
    SbfPvtAccuracy accuracy;
};

/// The base line to one base station in ECEF; the rest as in BaseVectorGeod.
struct SbfBaseVectorXyz {
    U1<"num_sv!255"> num_sv = 255;
    U1<"error"> error{};
    U1<"mode"> mode{};
    U1<"misc"> misc{};
    R8<"delta_x_m!-2e10"> delta_x = sbf_nothing;  ///< from rover to base
    R8<"delta_y_m!-2e10"> delta_y = sbf_nothing;
    R8<"delta_z_m!-2e10"> delta_z = sbf_nothing;
    R4<"vel_x_mps!-2e10"> vel_x = sbf_nothing;  ///< of the base with respect to the rover
    R4<"vel_y_mps!-2e10"> vel_y = sbf_nothing;
    R4<"vel_z_mps!-2e10"> vel_z = sbf_nothing;
    U2<"azimuth_deg*1e-2!65535"> azimuth = 0xFFFF;       ///< of the base
    I2<"elevation_deg*1e-2!-32768"> elevation = -32768;  ///< of the base
    U2<"reference_id!65535"> reference_id = 0xFFFF;
    U2<"corr_age_s*1e-2!65535"> corr_age = 0xFFFF;
    U4<"signal_info"> signal_info{};
};

/// BaseVectorCart. Blocks of longer parts are not read.
struct SbfBaseVectorCart {
    static constexpr std::uint16_t block_number = 4043;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BaseVectorCart";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    List<"bases", SbfBaseVectorXyz> bases;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.bases);
        v(m.sb_length);
        v.items(m.bases);
    }
};

/// A satellite above the horizon.
struct SbfVisibleSatellite {
    U1<"svid"> svid{};
    U1<"freq_nr!0"> freq_nr{};  ///< of GLONASS: channel + 8
    U2<"azimuth_deg*1e-2!65535"> azimuth = 0xFFFF;
    I2<"elevation_deg*1e-2!-32768"> elevation = -32768;
    U1<"rise_set!255"> rise_set = 255;  ///< 0 setting, 1 rising, 255 unknown
    U1<"known_by!255"> known_by = 255;  ///< 1 almanac, 2 ephemeris, 255 unknown
};

/// SatVisibility: where the satellites above the horizon stand. Blocks of longer parts are not read.
struct SbfSatVisibility {
    static constexpr std::uint16_t block_number = 4012;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "SatVisibility";
    static constexpr std::uint8_t part_bytes = 8;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    List<"satellites", SbfVisibleSatellite> satellites;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.satellites);
        v(m.sb_length);
        v.items(m.satellites);
    }
};

/// ReceiverSetup: what stands in the head of a RINEX file. Texts end at their first zero, or fill their field.
struct SbfReceiverSetup {
    static constexpr std::uint16_t block_number = 5902;
    static constexpr std::uint8_t block_revision = 4;
    static constexpr std::string_view message_name = "ReceiverSetup";
    SbfTime time;
    std::array<std::uint8_t, 2> reserved{};
    Text<"marker_name", 60> marker_name{};
    Text<"marker_number", 20> marker_number{};
    Text<"observer", 20> observer{};
    Text<"agency", 40> agency{};
    Text<"rx_serial_number", 20> rx_serial_number{};
    Text<"rx_name", 20> rx_name{};
    Text<"rx_version", 20> rx_version{};
    Text<"antenna_serial_number", 20> antenna_serial_number{};
    Text<"antenna_type", 20> antenna_type{};
    R4<"delta_h_m"> delta_h{};  ///< of the antenna above the marker
    R4<"delta_e_m"> delta_e{};
    R4<"delta_n_m"> delta_n{};
    Text<"marker_type", 20> marker_type{};
    Text<"gnss_fw_version", 40> gnss_fw_version{};
    Text<"product_name", 40> product_name{};
    R8<"latitude_rad!-2e10"> latitude = sbf_nothing;  ///< of the reference position
    R8<"longitude_rad!-2e10"> longitude = sbf_nothing;
    R4<"height_m!-2e10"> height = sbf_nothing;
    Text<"station_code", 10> station_code{};
    U1<"monument_index"> monument_index{};
    U1<"receiver_index"> receiver_index{};
    Text<"country_code", 3> country_code{};
    std::array<char, 21> reserved2{};
};

}  // namespace skyloop::inline receiver
