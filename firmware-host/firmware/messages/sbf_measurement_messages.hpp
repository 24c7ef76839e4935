/// SBF blocks of measurements and navigation messages, from what was measured and received.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/navigation_state.hpp"
#include "receiver/protocol/sbf_measurement_blocks.hpp"

namespace skyloop::firmware {

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

}  // namespace skyloop::firmware
