/// SBF blocks beside the solution: attitude's covariance, base line, quality, radio bands, authentication and time.
///
/// Layouts: Septentrio mosaic-X5 reference guide (firmware 4.14), section 4.2.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "receiver/protocol/sbf_blocks.hpp"

namespace skyloop::inline receiver {

/// AttCovEuler: the covariance of AttEuler, deg².
struct SbfAttCovEuler {
    static constexpr std::uint16_t block_number = 5939;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "AttCovEuler";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -reserved error cov_heading!-2e10 cov_pitch!-2e10 cov_roll!-2e10 "
        "cov_heading_pitch!-2e10 cov_heading_roll!-2e10 cov_pitch_roll!-2e10";
    SbfTime time;
    std::uint8_t reserved = 0;
    std::uint8_t error = 1;  ///< as of AttEuler
    float heading = static_cast<float>(sbf_nothing);
    float pitch = static_cast<float>(sbf_nothing);
    float roll = static_cast<float>(sbf_nothing);
    float heading_pitch = static_cast<float>(sbf_nothing);
    float heading_roll = static_cast<float>(sbf_nothing);
    float pitch_roll = static_cast<float>(sbf_nothing);
};

/// The base line to one base station.
struct SbfBaseVector {
    std::uint8_t num_sv = 255;
    std::uint8_t error = 0;  ///< as of PVTGeodetic
    std::uint8_t mode = 0;   ///< the same
    std::uint8_t misc = 0;   ///< bit 0: of antenna phase centres
    double delta_east = sbf_nothing, delta_north = sbf_nothing, delta_up = sbf_nothing;  ///< m, from rover to base
    float vel_east = static_cast<float>(sbf_nothing);  ///< m/s, of the base with respect to the rover
    float vel_north = static_cast<float>(sbf_nothing);
    float vel_up = static_cast<float>(sbf_nothing);
    std::uint16_t azimuth = 0xFFFF;   ///< 0.01 deg, of the base
    std::int16_t elevation = -32768;  ///< 0.01 deg, of the base
    std::uint16_t reference_id = 0xFFFF;
    std::uint16_t corr_age = 0xFFFF;  ///< 0.01 s
    std::uint32_t signal_info = 0;    ///< as of PVTGeodetic
};

/// BaseVectorGeod: base lines in east, north and up. Blocks of longer parts are not read.
struct SbfBaseVectorGeod {
    static constexpr std::uint16_t block_number = 4028;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BaseVectorGeod";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -part_bytes bases[satellites!255 error mode misc delta_east_m!-2e10 "
        "delta_north_m!-2e10 delta_up_m!-2e10 vel_east_mps!-2e10 vel_north_mps!-2e10 vel_up_mps!-2e10 "
        "azimuth_deg*1e-2!65535 elevation_deg*1e-2!-32768 reference_id!65535 corr_age_s*1e-2!65535 signal_info]";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    std::vector<SbfBaseVector> bases;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.bases);
        v(m.sb_length);
        v.items(m.bases);
    }
};

/// One indicator of QualityInd.
struct SbfIndicator {
    /// Bits 0-7: 0 overall, 1 signals of the main antenna, 11 its radio power, 21 head room of the processor, 30 the
    /// base station's measurements; 8-11: 0 bad … 10 good.
    std::uint16_t value = 0;
};

/// QualityInd: how well it goes.
struct SbfQualityInd {
    static constexpr std::uint16_t block_number = 4082;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "QualityInd";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -reserved indicators[type_and_value]";
    SbfTime time;
    std::uint8_t reserved = 0;
    std::vector<SbfIndicator> indicators;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.indicators);
        v(m.reserved);
        v.items(m.indicators);
    }
};

/// A band in which something interferes.
struct SbfRfBand {
    std::uint32_t frequency = 0;  ///< Hz, its middle
    std::uint16_t bandwidth = 0;  ///< kHz
    std::uint8_t info = 0;        ///< bits 0-3: 1 suppressed by the user, 2 mitigated, 8 interference; 6-7 antenna
    std::uint8_t padding = 0;
};

/// RFStatus: interference by band, and signs of spoofing. Blocks of longer parts are not read.
struct SbfRfStatus {
    static constexpr std::uint16_t block_number = 4092;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "RFStatus";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -part_bytes flags -reserved bands[frequency_hz bandwidth_khz info -padding]";
    static constexpr std::uint8_t part_bytes = 8;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    std::uint8_t flags = 0;  ///< bits: 0 signals that are not authentic, 1 navigation messages
    std::array<std::uint8_t, 3> reserved{};
    std::vector<SbfRfBand> bands;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.bands);
        v(m.sb_length, m.flags, m.reserved);
        v.items(m.bands);
    }
};

/// GALAuthStatus: Galileo's OSNMA.
struct SbfGalAuthStatus {
    static constexpr std::uint16_t block_number = 4245;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "GALAuthStatus";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 osnma_status trusted_time_delta_s!-2e10 galileo_active galileo_authentic "
        "gps_active gps_authentic";
    SbfTime time;
    std::uint16_t osnma_status = 0;  ///< bits 0-2: 0 disabled
    float trusted_time_delta = static_cast<float>(sbf_nothing);
    std::uint64_t galileo_active = 0, galileo_authentic = 0, gps_active = 0, gps_authentic = 0;
};

/// ReceiverTime: UTC.
struct SbfReceiverTime {
    static constexpr std::uint16_t block_number = 5914;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "ReceiverTime";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 year!-128 month!-128 day!-128 hour!-128 minute!-128 second!-128 "
        "leap_seconds!-128 sync_level";
    SbfTime time;
    std::int8_t year = -128;  ///< without its century
    std::int8_t month = -128, day = -128, hour = -128, minute = -128, second = -128;
    std::int8_t leap_seconds = -128;  ///< GPS time minus UTC
    std::uint8_t sync_level = 0;      ///< bits: 0 week, 1 time of week, 2 fine time
};

/// EndOfAtt: nothing more of an epoch's attitude follows.
struct SbfEndOfAtt {
    static constexpr std::uint16_t block_number = 5943;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "EndOfAtt";
    static constexpr std::string_view field_names = "tow_s*1e-3!4294967295 week!65535";
    SbfTime time;
};

}  // namespace skyloop::inline receiver
