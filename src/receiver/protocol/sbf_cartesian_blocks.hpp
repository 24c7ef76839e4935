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
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 mode error x_m!-2e10 y_m!-2e10 z_m!-2e10 undulation_m!-2e10 vx_mps!-2e10 "
        "vy_mps!-2e10 vz_mps!-2e10 course_deg!-2e10 clock_bias_ms!-2e10 clock_drift_ppm!-2e10 time_system!255 "
        "datum!255 satellites!255 wa_corr_info reference_id!65535 mean_corr_age_s*1e-2!65535 signal_info alert_flag "
        "bases ppp_info latency_s*1e-4!65535 h_accuracy_m*1e-2!65535 v_accuracy_m*1e-2!65535 misc -padding";
    SbfTime time;
    std::uint8_t mode = 0;
    std::uint8_t error = 1;
    double x = sbf_nothing, y = sbf_nothing, z = sbf_nothing;  ///< m
    float undulation = static_cast<float>(sbf_nothing);        ///< m
    float vx = static_cast<float>(sbf_nothing);                ///< m/s
    float vy = static_cast<float>(sbf_nothing);
    float vz = static_cast<float>(sbf_nothing);
    float course = static_cast<float>(sbf_nothing);       ///< deg
    double clock_bias = sbf_nothing;                      ///< ms
    float clock_drift = static_cast<float>(sbf_nothing);  ///< 1e-6
    std::uint8_t time_system = 0xFF;
    std::uint8_t datum = 0xFF;
    std::uint8_t num_sv = 0xFF;
    std::uint8_t wa_corr_info = 0;
    std::uint16_t reference_id = 0xFFFF;
    std::uint16_t mean_corr_age = 0xFFFF;  ///< 0.01 s
    std::uint32_t signal_info = 0;
    std::uint8_t alert_flag = 0;
    std::uint8_t num_bases = 0;
    std::uint16_t ppp_info = 0;
    SbfPvtAccuracy accuracy;
};

/// The base line to one base station in ECEF; the rest as in BaseVectorGeod.
struct SbfBaseVectorXyz {
    std::uint8_t num_sv = 255;
    std::uint8_t error = 0;
    std::uint8_t mode = 0;
    std::uint8_t misc = 0;
    double delta_x = sbf_nothing, delta_y = sbf_nothing, delta_z = sbf_nothing;  ///< m, from rover to base
    float vel_x = static_cast<float>(sbf_nothing);  ///< m/s, of the base with respect to the rover
    float vel_y = static_cast<float>(sbf_nothing);
    float vel_z = static_cast<float>(sbf_nothing);
    std::uint16_t azimuth = 0xFFFF;   ///< 0.01 deg, of the base
    std::int16_t elevation = -32768;  ///< 0.01 deg, of the base
    std::uint16_t reference_id = 0xFFFF;
    std::uint16_t corr_age = 0xFFFF;  ///< 0.01 s
    std::uint32_t signal_info = 0;
};

/// BaseVectorCart. Blocks of longer parts are not read.
struct SbfBaseVectorCart {
    static constexpr std::uint16_t block_number = 4043;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BaseVectorCart";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -base_bytes bases[num_sv!255 error mode misc delta_x_m!-2e10 "
        "delta_y_m!-2e10 delta_z_m!-2e10 vel_x_mps!-2e10 vel_y_mps!-2e10 vel_z_mps!-2e10 azimuth_deg*1e-2!65535 "
        "elevation_deg*1e-2!-32768 reference_id!65535 corr_age_s*1e-2!65535 signal_info]";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    std::vector<SbfBaseVectorXyz> bases;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.bases);
        v(m.sb_length);
        v.items(m.bases);
    }
};

/// A satellite above the horizon.
struct SbfVisibleSatellite {
    std::uint8_t svid = 0;
    std::uint8_t freq_nr = 0;         ///< of GLONASS: channel + 8
    std::uint16_t azimuth = 0xFFFF;   ///< 0.01 deg
    std::int16_t elevation = -32768;  ///< 0.01 deg
    std::uint8_t rise_set = 255;      ///< 0 setting, 1 rising, 255 unknown
    std::uint8_t known_by = 255;      ///< 1 almanac, 2 ephemeris, 255 unknown
};

/// SatVisibility: where the satellites above the horizon stand. Blocks of longer parts are not read.
struct SbfSatVisibility {
    static constexpr std::uint16_t block_number = 4012;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "SatVisibility";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -satellite_bytes satellites[svid freq_nr!0 azimuth_deg*1e-2!65535 "
        "elevation_deg*1e-2!-32768 rise_set!255 known_by!255]";
    static constexpr std::uint8_t part_bytes = 8;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    std::vector<SbfVisibleSatellite> satellites;

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
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -reserved marker_name marker_number observer agency rx_serial_number "
        "rx_name rx_version antenna_serial_number antenna_type delta_h_m delta_e_m delta_n_m marker_type "
        "gnss_fw_version product_name latitude_rad!-2e10 longitude_rad!-2e10 height_m!-2e10 station_code "
        "monument_index receiver_index country_code -reserved";
    SbfTime time;
    std::array<std::uint8_t, 2> reserved{};
    std::array<char, 60> marker_name{};
    std::array<char, 20> marker_number{};
    std::array<char, 20> observer{};
    std::array<char, 40> agency{};
    std::array<char, 20> rx_serial_number{};
    std::array<char, 20> rx_name{};
    std::array<char, 20> rx_version{};
    std::array<char, 20> antenna_serial_number{};
    std::array<char, 20> antenna_type{};
    float delta_h = 0, delta_e = 0, delta_n = 0;  ///< m, of the antenna above the marker
    std::array<char, 20> marker_type{};
    std::array<char, 40> gnss_fw_version{};
    std::array<char, 40> product_name{};
    double latitude = sbf_nothing, longitude = sbf_nothing;  ///< rad, of the reference position
    float height = static_cast<float>(sbf_nothing);          ///< m
    std::array<char, 10> station_code{};
    std::uint8_t monument_index = 0;
    std::uint8_t receiver_index = 0;
    std::array<char, 3> country_code{};
    std::array<char, 21> reserved2{};
};

}  // namespace skyloop::inline receiver
