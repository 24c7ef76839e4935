/// RTCM 3 messages: corrections of a base station (RTCM 10403.3).
/// Observations as RTCM 3 multiple signal messages of kinds 4 to 7 (RTCM 10403.3, 3.5.16).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::inline receiver {

/// One checked message; the payload lives as long as the frame.
struct Rtcm3Message {
    int number = 0;              ///< DF002, 0 … 4095
    std::optional<int> station;  ///< DF003, of messages that begin with it and of 4072
    int subtype = 0;             ///< of u-blox's 4072
    ByteSpan payload;
};

/// Reads exactly one frame: 0xD3, six reserved bits, ten bits of length, payload, CRC-24Q (section 4). Nothing when
/// one of them does not hold or the payload has no room for a number and twelve bits more.
std::optional<Rtcm3Message> parse_rtcm3(ByteSpan frame);

/// The frame around a payload. Empty when the payload has more than 1023 bytes.
Bytes encode_rtcm3(ByteSpan payload);

/// Where the antenna of a base station stands: 1005, and 1006 with the antenna's height (tables 3.5-6, 3.5-7).
struct Rtcm3Station {
    int station = 0;
    std::array<std::int64_t, 3> position{};  ///< ECEF, 0.1 mm; ±13 743 895 m fit
    std::optional<int> antenna_height;       ///< 0.1 mm over the marker, 0 … 65535: of 1006 alone
    bool computed = false;                   ///< DF141: it is no real station
    bool operator==(const Rtcm3Station&) const = default;
};
std::optional<Rtcm3Station> decode_station(const Rtcm3Message& message);
Bytes encode(const Rtcm3Station& station);

/// The code-phase biases of GLONASS: 1230 (table 3.5-114).
struct Rtcm3GlonassBiases {
    int station = 0;
    bool aligned = false;                             ///< the observations have been corrected by them
    std::array<std::optional<std::int16_t>, 4> bias;  ///< L1 C/A, L1 P, L2 C/A, L2 P; 0.02 m
    bool operator==(const Rtcm3GlonassBiases&) const = default;
};
std::optional<Rtcm3GlonassBiases> decode_glonass_biases(const Rtcm3Message& message);
Bytes encode(const Rtcm3GlonassBiases& biases);

/// What all multiple signal messages begin with (table 3.5-78).
struct Rtcm3MsmHeader {
    int number = 0;
    int station = 0;
    std::uint32_t epoch = 0;       ///< ms of the system's week; of GLONASS day of week · 2^27 + ms of the Moscow day
    bool more = false;             ///< more messages of the same epoch follow
    int issue = 0;                 ///< DF409
    std::uint64_t satellites = 0;  ///< DF394, the first satellite in the highest bit
    std::uint32_t signals = 0;     ///< DF395
    std::vector<bool> cells;       ///< DF396: by satellite, then signal

    [[nodiscard]] int satellite_count() const;
    [[nodiscard]] int signal_count() const;
    bool operator==(const Rtcm3MsmHeader&) const = default;
};
/// Nothing for messages of other numbers, cut ones, and masks of more than 64 cells, which the standard forbids.
std::optional<Rtcm3MsmHeader> decode_msm_header(const Rtcm3Message& message);
/// The header alone, as a message that carries nothing more.
Bytes encode(const Rtcm3MsmHeader& header);

/// The kind 1 … 7 of a multiple signal message; nothing for other numbers.
std::optional<int> msm_kind(int number);

/// One signal of one satellite.
struct Rtcm3MsmCell {
    int satellite = 1;                       ///< DF394: 1 … 64
    int signal = 2;                          ///< DF395: 1 … 32
    double range_m = 0;                      ///< pseudorange
    std::optional<double> phase_range_m;     ///< carrier phase times its wavelength, growing with the range
    std::optional<double> phase_range_rate;  ///< m/s, positive when the range grows
    double wavelength_m = 0.19;
    double lock_s = 0;  ///< without a break of the phase
    bool half_cycle_unknown = false;
    double cno_dbhz = 0;
    int satellite_info = 0;  ///< DF419: of GLONASS the channel + 7; else 0
};

/// All that one message of a system tells.
struct Rtcm3MsmObservations {
    int number = 1077;                ///< of kind 4 to 7
    int station = 0;                  ///< DF003
    std::uint32_t epoch = 0;          ///< as Rtcm3MsmHeader::epoch
    bool more = false;                ///< more messages of the same epoch follow
    std::vector<Rtcm3MsmCell> cells;  ///< in any order
};

/// The frame. Phases that are further from the pseudorange than the fields reach are told whole kilometres of cycles
/// nearer, which only moves their unknown number of cycles. Satellites that would make more than 64 cells are left out,
/// those of the highest numbers first. Empty for other kinds and for no cells at all.
Bytes encode(const Rtcm3MsmObservations& observations);
/// Cells without a valid pseudorange are left out; wavelengths are not transmitted. Lock times are the least that the
/// indicators allow. Nothing for other kinds and cut messages.
std::optional<Rtcm3MsmObservations> decode_msm(const Rtcm3Message& message);

}  // namespace skyloop::inline receiver
