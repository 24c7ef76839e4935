/// What several SBF blocks have in common.
/// SBF blocks of measurements and navigation messages, from what was measured and received.
/// SBF blocks of the solution in ECEF, and of the sky.
/// From the receiver's state to SBF blocks beside the solution.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/core/navigation_state.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/output_only/other_protocols.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/sbf_cartesian_blocks.hpp"
#include "receiver/protocol/sbf_raw_blocks.hpp"
#include "receiver/protocol/sbf_status_blocks.hpp"

namespace skyloop::firmware {

/// The stamp of what is reported.
inline SbfTime sbf_time(const NavigationState& state) {
    const WeekAndTow stamp = gps_stamp(state);
    SbfTime time;
    if (state.time.time) time.tow = whole_milliseconds(stamp);
    if (state.time.date) time.wnc = nearest<std::uint16_t>(static_cast<double>(stamp.week));
    return time;
}

/// A block that tells its stamp so far, and nothing else.
template <class Block>
Block sbf_block(const NavigationState& state) {
    Block block;
    block.time = sbf_time(state);
    return block;
}

/// PVT mode, bits 0-3 and 7 (PolaRx5TR reference guide, PVTGeodetic).
inline std::uint8_t sbf_mode(const NavigationState& state) {
    constexpr std::uint8_t fixed_location = 3;
    if (!has_solution(state)) return 0;
    if (state.place_given) return fixed_location;
    switch (state.epoch.fix.type) {
        case FixType::fix_2d:
            return 0x81;
        case FixType::dgnss:
            return state.corrections.state == CorrectionState::none ? 6 : 2;
        case FixType::rtk_fixed:
            return 4;
        case FixType::rtk_float:
            return 5;
        default:
            return 1;
    }
}

/// 1 too few measurements; of a solution that its user does not want: 8 too few corrections, 10 ambiguities not fixed.
inline std::uint8_t sbf_error(const NavigationState& state) {
    constexpr std::uint8_t measurements = 1, corrections = 8, not_fixed = 10;
    if (has_solution(state)) return 0;
    if (!state.kind_forbidden) return measurements;
    return state.epoch.fix.type == FixType::rtk_float ? not_fixed : corrections;
}

/// The number of a signal (section 4.1.10); nothing for one that has none below 31.
std::optional<std::uint8_t> sbf_signal_number(Constellation constellation, Signal signal);
/// Bits of the signals of the satellites used: those measured, or the first one of a model that measures nothing.
std::uint32_t sbf_signal_info(const NavigationState& state);
/// The channel by which a satellite is tracked, as ChannelStatus numbers them, from 1 on; 0 where it is not.
std::uint8_t sbf_channel_number(const NavigationState& state, SatelliteId satellite);
/// Of GLONASS, channel + 8, by what was measured of the satellite; of other systems, and where nothing was, 0.
std::uint8_t sbf_frequency_number(SatelliteId satellite, const Observations& observations);

/// What a receiver counts of its measurements from epoch to epoch.
class SbfMeasurementCounts {
public:
    /// Takes an epoch in; each once, in ascending time.
    void follow(const NavigationState& state);
    /// ms by which the clock was set since the start, modulo 256.
    [[nodiscard]] std::uint8_t clock_jumps() const { return clock_jumps_; }
    /// How often the phase of a signal began or broke, modulo 256.
    [[nodiscard]] std::uint8_t losses(const Observation& observation) const;

private:
    struct Phase {
        std::uint8_t losses = 0;
        bool locked = false;
    };
    std::map<std::pair<SatelliteId, Signal>, Phase> phases_;
    std::optional<double> clock_ms_;  // past the epoch, at the one before
    std::uint8_t clock_jumps_ = 0;
};

/// Everything that has a pseudorange and a Doppler, at the instant when the receiver's clock shows the epoch's whole
/// millisecond: measured up to half a millisecond beside it, ranges and phases are carried there by the Doppler. No
/// satellites before time and week are known, and of models that measure nothing.
SbfMeasEpoch sbf_measurements(const NavigationState& state, const SbfMeasurementCounts& counts);
SbfMeasExtra sbf_measurement_extra(const NavigationState& state, const SbfMeasurementCounts& counts);
SbfEndOfMeas sbf_end_of_measurements(const NavigationState& state);

/// The blocks of raw bits of one number that were received since the epoch before.
std::vector<Bytes> sbf_raw_pages(std::uint16_t number, const NavigationState& state);
/// The block of a record that is whole with a message, GPSNav and its like; empty for a system that has none here.
Bytes sbf_record_block(const Subframe& message, const NavigationState& state);

/// What PVTGeodetic and its like tell, turned to the axes of ECEF.
SbfPvtCartesian sbf_pvt_cartesian(const ReportContext& context);
/// Nothing of a solution whose height is held: along no axis is its variance known then.
SbfPosCovCartesian sbf_position_covariance_cartesian(const NavigationState& state);
SbfVelCovCartesian sbf_velocity_covariance_cartesian(const NavigationState& state);
SbfBaseVectorCart sbf_base_vector_cartesian(const NavigationState& state);
/// Satellites above the horizon whose place is known, by their almanac or their ephemeris.
SbfSatVisibility sbf_visible_satellites(const NavigationState& state);

/// Of a pair's vector; of the roll nothing is known. Without a pair error 1.
SbfAttCovEuler sbf_attitude_covariance(const NavigationState& state);
/// The vector of a pair, or, with corrections, from where their station says it stands; without either no base.
SbfBaseVectorGeod sbf_base_vector(const NavigationState& state);
SbfEndOfAtt sbf_end_of_attitude(const NavigationState& state);
/// By satellites and their C/N0, by interference and by the age of corrections; the maker's own rule is not published.
SbfQualityInd sbf_quality(const NavigationState& state);
/// A band where interference is noticed, and bit 0 of the flags where spoofing is.
SbfRfStatus sbf_radio_status(const NavigationState& state);
/// OSNMA is switched off.
SbfGalAuthStatus sbf_authentication(const NavigationState& state);
SbfReceiverTime sbf_receiver_time(const NavigationState& state);

}  // namespace skyloop::firmware
