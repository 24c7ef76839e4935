/// What satellites delay each of their codes by, against the clocks of precise products.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// One bias of a satellite, as an observation has it: of one code, or of one code less another.
struct CodeBias {
    std::string code;   ///< "C1C", by RINEX 3
    std::string other;  ///< that is taken off; empty: none
    GpsTime from;
    std::optional<GpsTime> until{};  ///< nothing: open
    double seconds = 0;
};

/// Code biases of many satellites.
class CodeBiases {
public:
    void add(SatelliteId satellite, CodeBias bias) { biases_[satellite].push_back(std::move(bias)); }
    void add(const CodeBiases& other) {
        for (const auto& [satellite, biases] : other.biases_)
            biases_[satellite].insert(biases_[satellite].end(), biases.begin(), biases.end());
    }
    [[nodiscard]] std::size_t size() const { return biases_.size(); }
    /// By how much an observation of the signal, of its first code in rinex_signal_codes() that has a bias, is late
    /// against the clock of the table. Biases of single codes count as they are. Those of differences are joined from
    /// code to code and set so that the combination without ionosphere of the clock's own pair has none: C1W and C2W of
    /// GPS, C1C (C1X) and C5Q (C5X) of Galileo, C2I and C6I of BeiDou, C1P and C2P (C1C, C2C) of GLONASS, C1C and C2L
    /// of QZSS (S. Schaer, SINEX_BIAS 1.00, with the usual references of IGS clocks). Nothing where they do not tell.
    [[nodiscard]] std::optional<Seconds> of(SatelliteId satellite, Signal signal, GpsTime time) const;

private:
    std::map<SatelliteId, std::vector<CodeBias>> biases_;
};

}  // namespace skyloop::inline world
