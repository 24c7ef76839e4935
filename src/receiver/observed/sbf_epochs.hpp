/// Epochs out of SBF blocks.
#pragma once

#include "receiver/observed/observed_log.hpp"
#include "receiver/protocol/sbf_frame.hpp"

namespace skyloop::inline receiver {

/// Takes blocks one after the other: PVTGeodetic or PVTCartesian for the solution, DOP, AttEuler, MeasEpoch for the
/// strengths of signals, ChannelStatus and SatVisibility for the elevations of satellites. Those of one time are one
/// epoch. Accuracies are 1 σ, half of what the blocks say.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), chapter 4. State: the epoch under way and the last
/// elevations.
class SbfEpochs {
public:
    struct Taken {
        bool is_senseless = false;           ///< of a wrong length or time
        std::optional<ObservedEpoch> ended;  ///< the epoch before, when another one begins
    };
    /// @param every_signal those of a satellite beyond its first are kept apart, instead of the strongest
    explicit SbfEpochs(bool every_signal = false) : every_signal_(every_signal) {}
    Taken take(const SbfBlockView& block);
    std::optional<ObservedEpoch> end();

private:
    template <class Block, class Taker>
    void with(const SbfBlockView& block, Taker&& taker);
    template <class Block>
    void take_solution(const Block& pvt);
    void take_satellites(const SbfBlockView& block);

    bool every_signal_;
    Taken taken_;
    std::optional<ObservedEpoch> under_way_;
    std::vector<std::pair<SatelliteId, int>> elevations_;  // degrees
};

}  // namespace skyloop::inline receiver
