/// SBF blocks of a solution and its satellites.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), sections 4.2.10, 4.2.11 and 4.2.15. Every block begins
/// with the time of week and the week; both have all bits set while the receiver does not know them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "receiver/protocol/field_list.hpp"
#include "receiver/protocol/sbf_frame.hpp"

namespace skyloop::inline receiver {

/// The stamp of every block.
struct SbfTime {
    std::uint32_t tow = 0xFFFFFFFF;  ///< ms, GPS time of week
    std::uint16_t wnc = 0xFFFF;      ///< GPS week, not wrapped
};

/// What revision 1 (latency, accuracies) and 2 (misc) added to PVTGeodetic, with the padding.
struct SbfPvtAccuracy {
    std::uint16_t latency = 0xFFFF;     ///< 0.1 ms from the epoch to the block
    std::uint16_t h_accuracy = 0xFFFF;  ///< 0.01 m, twice the root mean square of the horizontal distance
    std::uint16_t v_accuracy = 0xFFFF;  ///< 0.01 m, 2 σ
    std::uint8_t misc = 0;
    std::uint8_t padding = 0;
};

/// PVTGeodetic: position, velocity, time.
struct SbfPvtGeodetic {
    static constexpr std::uint16_t block_number = 4007;
    static constexpr std::uint8_t block_revision = 2;
    static constexpr std::string_view message_name = "PVTGeodetic";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 mode error latitude_rad!-2e10 longitude_rad!-2e10 height_m!-2e10 "
        "undulation_m!-2e10 vel_north_mps!-2e10 vel_east_mps!-2e10 vel_up_mps!-2e10 course_deg!-2e10 "
        "clock_bias_ms!-2e10 clock_drift_ppm!-2e10 time_system!255 datum!255 satellites!255 wa_corr_info "
        "reference_id!65535 mean_corr_age_s*1e-2!65535 signal_info alert_flag bases ppp_info "
        "latency_s*1e-4!65535 h_accuracy_m*1e-2!65535 v_accuracy_m*1e-2!65535 misc -padding";
    SbfTime time;
    std::uint8_t mode = 0;   ///< bits: 0-3 0 none, 1 alone, 2 differential, 4 RTK fixed, 5 RTK float, 6 SBAS; 7: 2D
    std::uint8_t error = 1;  ///< 0 none, 1 too few measurements, 2 too few ephemerides, …
    double latitude = sbf_nothing;                        ///< rad
    double longitude = sbf_nothing;                       ///< rad
    double height = sbf_nothing;                          ///< m above the ellipsoid
    float undulation = static_cast<float>(sbf_nothing);   ///< m, of the geoid above the ellipsoid
    float vel_north = static_cast<float>(sbf_nothing);    ///< m/s
    float vel_east = static_cast<float>(sbf_nothing);     ///< m/s
    float vel_up = static_cast<float>(sbf_nothing);       ///< m/s
    float course = static_cast<float>(sbf_nothing);       ///< deg; nothing below 0.1 m/s
    double clock_bias = sbf_nothing;                      ///< ms, receiver minus system time
    float clock_drift = static_cast<float>(sbf_nothing);  ///< 1e-6
    std::uint8_t time_system = 0xFF;                      ///< 0 GPS
    std::uint8_t datum = 0xFF;                            ///< 0 WGS-84
    std::uint8_t num_sv = 0xFF;                           ///< satellites used
    std::uint8_t wa_corr_info = 0;
    std::uint16_t reference_id = 0xFFFF;
    std::uint16_t mean_corr_age = 0xFFFF;  ///< 0.01 s
    std::uint32_t signal_info = 0;         ///< bits of the signal types used: 0 GPS L1CA, 8 GLONASS L1CA, 17 Galileo E1
    std::uint8_t alert_flag = 0;
    std::uint8_t num_bases = 0;
    std::uint16_t ppp_info = 0;
    std::optional<SbfPvtAccuracy> accuracy;  ///< since revision 1

    static void fields(auto& m, auto& v) {
        v(m.time, m.mode, m.error, m.latitude, m.longitude, m.height, m.undulation, m.vel_north, m.vel_east, m.vel_up,
          m.course, m.clock_bias, m.clock_drift, m.time_system, m.datum, m.num_sv, m.wa_corr_info, m.reference_id,
          m.mean_corr_age, m.signal_info, m.alert_flag, m.num_bases, m.ppp_info);
        v.if_present(m.accuracy);
    }
};

/// A symmetric matrix of four as the covariance blocks write it: 00 11 22 33 01 02 03 12 13 23.
using SbfCovariance = std::array<float, 10>;
/// One without content.
inline constexpr SbfCovariance no_sbf_covariance = [] {
    SbfCovariance empty{};
    for (float& element : empty)
        element = static_cast<float>(sbf_nothing);
    return empty;
}();

/// Of the four blocks of covariances, the first being 5905.
inline constexpr std::array<std::string_view, 4> sbf_covariance_names{"PosCovCartesian", "PosCovGeodetic",
                                                                      "VelCovCartesian", "VelCovGeodetic"};

/// The covariance of a position and the clock, or of a velocity and the clock's drift.
template <std::uint16_t Number>
struct SbfCovarianceBlock {
    static constexpr std::uint16_t block_number = Number;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = sbf_covariance_names[Number - 5905];
    static constexpr std::string_view field_names =
        message_name.starts_with("Pos") ? "tow_s*1e-3!4294967295 week!65535 mode error covariance_m2!-2e10"
                                        : "tow_s*1e-3!4294967295 week!65535 mode error covariance_m2ps2!-2e10";
    SbfTime time;
    std::uint8_t mode = 0;
    std::uint8_t error = 1;
    SbfCovariance covariance = no_sbf_covariance;  ///< m² or m²/s²
};
using SbfPosCovCartesian = SbfCovarianceBlock<5905>;  ///< x, y, z, clock
using SbfPosCovGeodetic = SbfCovarianceBlock<5906>;   ///< north, east, up, clock
using SbfVelCovCartesian = SbfCovarianceBlock<5907>;
using SbfVelCovGeodetic = SbfCovarianceBlock<5908>;

/// DOP and protection levels. A DOP of 0 is none.
struct SbfDop {
    static constexpr std::uint16_t block_number = 4001;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "DOP";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 satellites -reserved pdop*1e-2!0 tdop*1e-2!0 hdop*1e-2!0 vdop*1e-2!0 "
        "hpl_m!-2e10 vpl_m!-2e10";
    SbfTime time;
    std::uint8_t num_sv = 0;
    std::uint8_t reserved = 0;
    std::uint16_t pdop = 0;  ///< 0.01
    std::uint16_t tdop = 0;
    std::uint16_t hdop = 0;
    std::uint16_t vdop = 0;
    float hpl = static_cast<float>(sbf_nothing);  ///< m, horizontal protection level
    float vpl = static_cast<float>(sbf_nothing);
};

/// AttEuler: attitude from several antennas.
struct SbfAttEuler {
    static constexpr std::uint16_t block_number = 5938;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "AttEuler";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 satellites!255 error mode -reserved heading_deg!-2e10 pitch_deg!-2e10 "
        "roll_deg!-2e10 pitch_rate_degps!-2e10 roll_rate_degps!-2e10 heading_rate_degps!-2e10";
    SbfTime time;
    std::uint8_t num_sv = 0xFF;
    std::uint8_t error = 1;  ///< bits: 0-1 baseline 1, 2-3 baseline 2: 0 none, 1 too few measurements; 7 not asked for
    std::uint16_t mode = 0;  ///< 0 none, 1 heading and pitch float, 2 fixed, 3 all float, 4 all fixed
    std::uint16_t reserved = 0;
    float heading = static_cast<float>(sbf_nothing);  ///< deg
    float pitch = static_cast<float>(sbf_nothing);    ///< deg
    float roll = static_cast<float>(sbf_nothing);     ///< deg
    float pitch_rate = static_cast<float>(sbf_nothing);
    float roll_rate = static_cast<float>(sbf_nothing);
    float heading_rate = static_cast<float>(sbf_nothing);
};

/// One satellite of ChannelStatus with its one antenna. The statuses are two bits for each signal of its system.
struct SbfChannel {
    std::uint8_t svid = 0;
    std::uint8_t freq_nr = 0;  ///< of GLONASS: channel + 8
    std::array<std::uint8_t, 2> reserved1{};
    std::uint16_t azimuth = 511;      ///< bits: 0-8 deg, 511 unknown; 14-15: 0 setting, 1 rising, 3 unknown
    std::uint16_t health_status = 0;  ///< of a signal: 0 unknown, 1 healthy, 3 unhealthy
    std::int8_t elevation = -128;     ///< deg, -128 unknown
    std::uint8_t antennas = 1;        ///< that follow
    std::uint8_t rx_channel = 0;
    std::uint8_t reserved2 = 0;
    std::uint8_t antenna = 0;
    std::uint8_t reserved3 = 0;
    std::uint16_t tracking_status = 0;  ///< of a signal: 0 idle, 1 search, 2 sync, 3 tracking
    std::uint16_t pvt_status = 0;       ///< of a signal: 0 not used, 1 waits for its ephemeris, 2 used, 3 rejected
    std::uint16_t pvt_info = 0;
};

/// ChannelStatus: the satellites of a receiver with one antenna. Blocks whose channels have none or several, or longer
/// parts, are not read.
struct SbfChannelStatus {
    static constexpr std::uint16_t block_number = 4013;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "ChannelStatus";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -channel_bytes -state_bytes -reserved channels[svid freq_nr!0 -reserved "
        "azimuth_and_trend health_status elevation_deg!-128 antennas rx_channel -reserved antenna -reserved "
        "tracking_status pvt_status -pvt_info]";
    static constexpr std::uint8_t satellite_bytes = 12, antenna_bytes = 8;
    SbfTime time;
    std::uint8_t sb1_length = satellite_bytes;
    std::uint8_t sb2_length = antenna_bytes;
    std::array<std::uint8_t, 3> reserved{};
    std::vector<SbfChannel> channels;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.channels);
        v(m.sb1_length, m.sb2_length, m.reserved);
        v.items(m.channels);
    }
};

/// One front end of ReceiverStatus.
struct SbfFrontEnd {
    std::uint8_t id = 0;
    std::int8_t gain = -128;  ///< dB, -128 unknown
    std::uint8_t sample_variance = 0;
    std::uint8_t blanking = 0;
};

/// ReceiverStatus: load, state and errors.
struct SbfReceiverStatus {
    static constexpr std::uint16_t block_number = 4014;
    static constexpr std::uint8_t block_revision = 1;
    static constexpr std::string_view message_name = "ReceiverStatus";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 cpu_load_percent!255 ext_error up_time_s rx_state rx_error -part_bytes "
        "command_count!0 temperature!0 front_ends[id gain_db!-128 sample_variance!0 blanking]";
    SbfTime time;
    std::uint8_t cpu_load = 0xFF;  ///< percent
    std::uint8_t ext_error = 0;
    std::uint32_t up_time = 0;   ///< s
    std::uint32_t rx_state = 0;  ///< bits: 1 antenna draws current, 4 week set, 5 time of week set, 6 fine time
    std::uint32_t rx_error = 0;  ///< bit 5: antenna over-current
    std::uint8_t sb_length = 4;
    std::uint8_t command_count = 0;
    std::uint8_t temperature = 0;  ///< deg C + 100, 0 unknown
    std::vector<SbfFrontEnd> front_ends;

    static void fields(auto& m, auto& v) {
        v(m.time, m.cpu_load, m.ext_error, m.up_time, m.rx_state, m.rx_error);
        v.count(m.front_ends);
        v(m.sb_length, m.command_count, m.temperature);
        v.items(m.front_ends);
    }
};

/// The vector from the main antenna to another one.
struct SbfAuxAntenna {
    std::uint8_t num_sv = 255;
    std::uint8_t error = 0;           ///< 0 none
    std::uint8_t ambiguity_type = 0;  ///< 0 fixed, 1 floating
    std::uint8_t antenna = 1;
    double delta_east = sbf_nothing, delta_north = sbf_nothing, delta_up = sbf_nothing;  ///< m
    double vel_east = sbf_nothing, vel_north = sbf_nothing, vel_up = sbf_nothing;        ///< m/s
};

/// AuxAntPositions: where the other antennas of an attitude are. Blocks of longer parts are not read.
struct SbfAuxAntPositions {
    static constexpr std::uint16_t block_number = 5942;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "AuxAntPositions";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -antenna_bytes antennas[num_sv!255 error ambiguity_type antenna "
        "delta_east_m!-2e10 delta_north_m!-2e10 delta_up_m!-2e10 vel_east_mps!-2e10 vel_north_mps!-2e10 "
        "vel_up_mps!-2e10]";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    std::vector<SbfAuxAntenna> antennas;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.antennas);
        v(m.sb_length);
        v.items(m.antennas);
    }
};

/// EndOfPVT: nothing more of an epoch's PVT blocks follows (PolaRx5TR reference guide, section 4.2).
struct SbfEndOfPvt {
    static constexpr std::uint16_t block_number = 5921;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "EndOfPVT";
    static constexpr std::string_view field_names = "tow_s*1e-3!4294967295 week!65535";
    SbfTime time;
};

/// The whole block of a message.
template <class Message>
Bytes encode_sbf(const Message& message) {
    return encode_sbf_block(Message::block_number, Message::block_revision, encode_payload(message));
}

/// Whether the parts of a ChannelStatus are as SbfChannel says.
inline bool has_known_parts(const SbfChannelStatus& message) {
    for (const SbfChannel& channel : message.channels)
        if (channel.antennas != 1) return false;
    return message.sb1_length == SbfChannelStatus::satellite_bytes &&
           message.sb2_length == SbfChannelStatus::antenna_bytes;
}

/// The message of a block's body; padding and what later revisions added behind are ignored. Nothing when it is too
/// short or its parts have other sizes than those known here.
template <class Message>
std::optional<Message> decode_sbf(ByteSpan body) {
    auto message = decode_front<Message>(body);
    if constexpr (requires(Message m) { m.sb1_length; })
        if (message && !has_known_parts(*message)) return std::nullopt;
    if constexpr (requires { Message::part_bytes; })
        if (message && message->sb_length != Message::part_bytes) return std::nullopt;
    return message;
}

}  // namespace skyloop::inline receiver
