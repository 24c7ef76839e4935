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
    SbfTime time;
    std::uint8_t reserved = 0;
    U1<"error"> error = 1;  ///< as of AttEuler
    R4<"cov_heading!-2e10"> heading = sbf_nothing;
    R4<"cov_pitch!-2e10"> pitch = sbf_nothing;
    R4<"cov_roll!-2e10"> roll = sbf_nothing;
    R4<"cov_heading_pitch!-2e10"> heading_pitch = sbf_nothing;
    R4<"cov_heading_roll!-2e10"> heading_roll = sbf_nothing;
    R4<"cov_pitch_roll!-2e10"> pitch_roll = sbf_nothing;
};

/// The base line to one base station.
struct SbfBaseVector {
    U1<"satellites!255"> num_sv = 255;
    U1<"error"> error{};                                ///< as of PVTGeodetic
    U1<"mode"> mode{};                                  ///< the same
    U1<"misc"> misc{};                                  ///< bit 0: of antenna phase centres
    R8<"delta_east_m!-2e10"> delta_east = sbf_nothing;  ///< from rover to base
    R8<"delta_north_m!-2e10"> delta_north = sbf_nothing;
    R8<"delta_up_m!-2e10"> delta_up = sbf_nothing;
    R4<"vel_east_mps!-2e10"> vel_east = sbf_nothing;  ///< of the base with respect to the rover
    R4<"vel_north_mps!-2e10"> vel_north = sbf_nothing;
    R4<"vel_up_mps!-2e10"> vel_up = sbf_nothing;
    U2<"azimuth_deg*1e-2!65535"> azimuth = 0xFFFF;       ///< of the base
    I2<"elevation_deg*1e-2!-32768"> elevation = -32768;  ///< of the base
    U2<"reference_id!65535"> reference_id = 0xFFFF;
    U2<"corr_age_s*1e-2!65535"> corr_age = 0xFFFF;
    U4<"signal_info"> signal_info{};  ///< as of PVTGeodetic
};

/// BaseVectorGeod: base lines in east, north and up. Blocks of longer parts are not read.
struct SbfBaseVectorGeod {
    static constexpr std::uint16_t block_number = 4028;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BaseVectorGeod";
    static constexpr std::uint8_t part_bytes = 52;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    List<"bases", SbfBaseVector> bases;

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
    U2<"type_and_value"> value{};
};

/// QualityInd: how well it goes.
struct SbfQualityInd {
    static constexpr std::uint16_t block_number = 4082;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "QualityInd";
    SbfTime time;
    std::uint8_t reserved = 0;
    List<"indicators", SbfIndicator> indicators;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.indicators);
        v(m.reserved);
        v.items(m.indicators);
    }
};

/// A band in which something interferes.
struct SbfRfBand {
    U4<"frequency_hz"> frequency{};  ///< its middle
    U2<"bandwidth_khz"> bandwidth{};
    U1<"info"> info{};  ///< bits 0-3: 1 suppressed by the user, 2 mitigated, 8 interference; 6-7 antenna
    std::uint8_t padding = 0;
};

/// RFStatus: interference by band, and signs of spoofing. Blocks of longer parts are not read.
struct SbfRfStatus {
    static constexpr std::uint16_t block_number = 4092;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "RFStatus";
    static constexpr std::uint8_t part_bytes = 8;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    U1<"flags"> flags{};  ///< bits: 0 signals that are not authentic, 1 navigation messages
    std::array<std::uint8_t, 3> reserved{};
    List<"bands", SbfRfBand> bands;

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
    SbfTime time;
    U2<"osnma_status"> osnma_status{};  ///< bits 0-2: 0 disabled
    R4<"trusted_time_delta_s!-2e10"> trusted_time_delta = sbf_nothing;
    U8<"galileo_active"> galileo_active{};
    U8<"galileo_authentic"> galileo_authentic{};
    U8<"gps_active"> gps_active{};
    U8<"gps_authentic"> gps_authentic{};
};

/// ReceiverTime: UTC.
struct SbfReceiverTime {
    static constexpr std::uint16_t block_number = 5914;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "ReceiverTime";
    SbfTime time;
    I1<"year!-128"> year = -128;  ///< without its century
    I1<"month!-128"> month = -128;
    I1<"day!-128"> day = -128;
    I1<"hour!-128"> hour = -128;
    I1<"minute!-128"> minute = -128;
    I1<"second!-128"> second = -128;
    I1<"leap_seconds!-128"> leap_seconds = -128;  ///< GPS time minus UTC
    U1<"sync_level"> sync_level{};                ///< bits: 0 week, 1 time of week, 2 fine time
};

/// EndOfAtt: nothing more of an epoch's attitude follows.
struct SbfEndOfAtt {
    static constexpr std::uint16_t block_number = 5943;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "EndOfAtt";
    SbfTime time;
};

}  // namespace skyloop::inline receiver
