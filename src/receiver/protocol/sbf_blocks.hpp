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
    U4<"tow_s*1e-3!4294967295"> tow = 0xFFFFFFFF;  ///< GPS time of week
    U2<"week!65535"> wnc = 0xFFFF;                 ///< GPS week, not wrapped
};

/// What revision 1 (latency, accuracies) and 2 (misc) added to PVTGeodetic, with the padding.
struct SbfPvtAccuracy {
    U2<"latency_s*1e-4!65535"> latency = 0xFFFF;        ///< from the epoch to the block
    U2<"h_accuracy_m*1e-2!65535"> h_accuracy = 0xFFFF;  ///< twice the root mean square of the horizontal distance
    U2<"v_accuracy_m*1e-2!65535"> v_accuracy = 0xFFFF;  ///< 2 σ
    U1<"misc"> misc{};
    std::uint8_t padding = 0;
};

/// PVTGeodetic: position, velocity, time.
struct SbfPvtGeodetic {
    static constexpr std::uint16_t block_number = 4007;
    static constexpr std::uint8_t block_revision = 2;
    static constexpr std::string_view message_name = "PVTGeodetic";
    SbfTime time;
    U1<"mode"> mode{};      ///< bits: 0-3 0 none, 1 alone, 2 differential, 4 RTK fixed, 5 RTK float, 6 SBAS; 7: 2D
    U1<"error"> error = 1;  ///< 0 none, 1 too few measurements, 2 too few ephemerides, …
    R8<"latitude_rad!-2e10"> latitude = sbf_nothing;
    R8<"longitude_rad!-2e10"> longitude = sbf_nothing;
    R8<"height_m!-2e10"> height = sbf_nothing;          ///< above the ellipsoid
    R4<"undulation_m!-2e10"> undulation = sbf_nothing;  ///< of the geoid above the ellipsoid
    R4<"vel_north_mps!-2e10"> vel_north = sbf_nothing;
    R4<"vel_east_mps!-2e10"> vel_east = sbf_nothing;
    R4<"vel_up_mps!-2e10"> vel_up = sbf_nothing;
    R4<"course_deg!-2e10"> course = sbf_nothing;            ///< nothing below 0.1 m/s
    R8<"clock_bias_ms!-2e10"> clock_bias = sbf_nothing;     ///< receiver minus system time
    R4<"clock_drift_ppm!-2e10"> clock_drift = sbf_nothing;  ///< 1e-6
    U1<"time_system!255"> time_system = 0xFF;               ///< 0 GPS
    U1<"datum!255"> datum = 0xFF;                           ///< 0 WGS-84
    U1<"satellites!255"> num_sv = 0xFF;                     ///< satellites used
    U1<"wa_corr_info"> wa_corr_info{};
    U2<"reference_id!65535"> reference_id = 0xFFFF;
    U2<"mean_corr_age_s*1e-2!65535"> mean_corr_age = 0xFFFF;
    U4<"signal_info"> signal_info{};  ///< bits of the signal types used: 0 GPS L1CA, 8 GLONASS L1CA, 17 Galileo E1
    U1<"alert_flag"> alert_flag{};
    U1<"bases"> num_bases{};
    U2<"ppp_info"> ppp_info{};
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
        element = sbf_nothing;
    return empty;
}();

/// Of the four blocks of covariances, the first being 5905.
inline constexpr std::array<std::string_view, 4> sbf_covariance_names{"PosCovCartesian", "PosCovGeodetic",
                                                                      "VelCovCartesian", "VelCovGeodetic"};

/// The covariance of a position and the clock, or of a velocity and the clock's drift.
template <std::uint16_t Number, FieldText Elements>
struct SbfCovarianceBlock {
    static constexpr std::uint16_t block_number = Number;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = sbf_covariance_names[Number - 5905];
    SbfTime time;
    U1<"mode"> mode{};
    U1<"error"> error = 1;
    R4<Elements, 10> covariance = no_sbf_covariance;
};
using SbfPosCovCartesian = SbfCovarianceBlock<5905, "covariance_m2!-2e10">;  ///< x, y, z, clock
using SbfPosCovGeodetic = SbfCovarianceBlock<5906, "covariance_m2!-2e10">;   ///< north, east, up, clock
using SbfVelCovCartesian = SbfCovarianceBlock<5907, "covariance_m2ps2!-2e10">;
using SbfVelCovGeodetic = SbfCovarianceBlock<5908, "covariance_m2ps2!-2e10">;

/// DOP and protection levels. A DOP of 0 is none.
struct SbfDop {
    static constexpr std::uint16_t block_number = 4001;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "DOP";
    SbfTime time;
    U1<"satellites"> num_sv{};
    std::uint8_t reserved = 0;
    U2<"pdop*1e-2!0"> pdop{};
    U2<"tdop*1e-2!0"> tdop{};
    U2<"hdop*1e-2!0"> hdop{};
    U2<"vdop*1e-2!0"> vdop{};
    R4<"hpl_m!-2e10"> hpl = sbf_nothing;  ///< horizontal protection level
    R4<"vpl_m!-2e10"> vpl = sbf_nothing;
};

/// AttEuler: attitude from several antennas.
struct SbfAttEuler {
    static constexpr std::uint16_t block_number = 5938;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "AttEuler";
    SbfTime time;
    U1<"satellites!255"> num_sv = 0xFF;
    U1<"error"> error = 1;  ///< bits: 0-1 baseline 1, 2-3 baseline 2: 0 none, 1 too few measurements; 7 not asked for
    U2<"mode"> mode{};      ///< 0 none, 1 heading and pitch float, 2 fixed, 3 all float, 4 all fixed
    std::uint16_t reserved = 0;
    R4<"heading_deg!-2e10"> heading = sbf_nothing;
    R4<"pitch_deg!-2e10"> pitch = sbf_nothing;
    R4<"roll_deg!-2e10"> roll = sbf_nothing;
    R4<"pitch_rate_degps!-2e10"> pitch_rate = sbf_nothing;
    R4<"roll_rate_degps!-2e10"> roll_rate = sbf_nothing;
    R4<"heading_rate_degps!-2e10"> heading_rate = sbf_nothing;
};

/// One satellite of ChannelStatus with its one antenna. The statuses are two bits for each signal of its system.
struct SbfChannel {
    U1<"svid"> svid{};
    U1<"freq_nr!0"> freq_nr{};  ///< of GLONASS: channel + 8
    std::array<std::uint8_t, 2> reserved1{};
    U2<"azimuth_and_trend"> azimuth = 511;      ///< bits: 0-8 deg, 511 unknown; 14-15: 0 setting, 1 rising, 3 unknown
    U2<"health_status"> health_status{};        ///< of a signal: 0 unknown, 1 healthy, 3 unhealthy
    I1<"elevation_deg!-128"> elevation = -128;  ///< -128 unknown
    U1<"antennas"> antennas = 1;                ///< that follow
    U1<"rx_channel"> rx_channel{};
    std::uint8_t reserved2 = 0;
    U1<"antenna"> antenna{};
    std::uint8_t reserved3 = 0;
    U2<"tracking_status"> tracking_status{};  ///< of a signal: 0 idle, 1 search, 2 sync, 3 tracking
    U2<"pvt_status"> pvt_status{};  ///< of a signal: 0 not used, 1 waits for its ephemeris, 2 used, 3 rejected
    std::uint16_t pvt_info = 0;
};

/// ChannelStatus: the satellites of a receiver with one antenna. Blocks whose channels have none or several, or longer
/// parts, are not read.
struct SbfChannelStatus {
    static constexpr std::uint16_t block_number = 4013;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "ChannelStatus";
    static constexpr std::uint8_t satellite_bytes = 12, antenna_bytes = 8;
    SbfTime time;
    std::uint8_t sb1_length = satellite_bytes;
    std::uint8_t sb2_length = antenna_bytes;
    std::array<std::uint8_t, 3> reserved{};
    List<"channels", SbfChannel> channels;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.channels);
        v(m.sb1_length, m.sb2_length, m.reserved);
        v.items(m.channels);
    }
};

/// One front end of ReceiverStatus.
struct SbfFrontEnd {
    U1<"id"> id{};
    I1<"gain_db!-128"> gain = -128;  ///< -128 unknown
    U1<"sample_variance!0"> sample_variance{};
    U1<"blanking"> blanking{};
};

/// ReceiverStatus: load, state and errors.
struct SbfReceiverStatus {
    static constexpr std::uint16_t block_number = 4014;
    static constexpr std::uint8_t block_revision = 1;
    static constexpr std::string_view message_name = "ReceiverStatus";
    SbfTime time;
    U1<"cpu_load_percent!255"> cpu_load = 0xFF;
    U1<"ext_error"> ext_error{};
    U4<"up_time_s"> up_time{};
    U4<"rx_state"> rx_state{};  ///< bits: 1 antenna draws current, 4 week set, 5 time of week set, 6 fine time
    U4<"rx_error"> rx_error{};  ///< bit 5: antenna over-current
    std::uint8_t sb_length = 4;
    U1<"command_count!0"> command_count{};
    U1<"temperature!0"> temperature{};  ///< deg C + 100, 0 unknown
    List<"front_ends", SbfFrontEnd> front_ends;

    static void fields(auto& m, auto& v) {
        v(m.time, m.cpu_load, m.ext_error, m.up_time, m.rx_state, m.rx_error);
        v.count(m.front_ends);
        v(m.sb_length, m.command_count, m.temperature);
        v.items(m.front_ends);
    }
};

/// The vector from the main antenna to another one.
struct SbfAuxAntenna {
    U1<"num_sv!255"> num_sv = 255;
    U1<"error"> error{};                    ///< 0 none
    U1<"ambiguity_type"> ambiguity_type{};  ///< 0 fixed, 1 floating
    U1<"antenna"> antenna = 1;
    R8<"delta_east_m!-2e10"> delta_east = sbf_nothing;
    R8<"delta_north_m!-2e10"> delta_north = sbf_nothing;
    R8<"delta_up_m!-2e10"> delta_up = sbf_nothing;
    R8<"vel_east_mps!-2e10"> vel_east = sbf_nothing;
    R8<"vel_north_mps!-2e10"> vel_north = sbf_nothing;
    R8<"vel_up_mps!-2e10"> vel_up = sbf_nothing;
};

/// AuxAntPositions: where the other antennas of an attitude are. Blocks of longer parts are not read.
struct SbfAuxAntPositions {
    static constexpr std::uint16_t block_number = 5942;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "AuxAntPositions";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    List<"antennas", SbfAuxAntenna> antennas;

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
