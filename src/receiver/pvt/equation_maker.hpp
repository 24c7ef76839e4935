/// The ranges of an epoch, made ready to be solved.
#pragma once

#include <vector>

#include "receiver/pvt/augmentation.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/satellite_choice.hpp"
#include "receiver/pvt/single_point.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "receiver/pvt/two_band_ionosphere.hpp"

namespace skyloop::inline receiver {

/// One for each satellite.
struct EpochEquations {
    std::vector<RangeEquation> equations;
    std::vector<const Observation*> primaries;  ///< the observation behind each equation
};

/// Chooses the satellites, and takes off their ranges what SBAS and a second carrier say of them.
///
/// State: which satellites are used, what each showed of the ionosphere.
class EquationMaker {
public:
    /// @param augmentation begun for each epoch before its ranges are made; outlives this
    EquationMaker(const NavigationParameters& parameters, const Augmentation& augmentation)
        : parameters_(parameters),
          choice_(parameters.use),
          ionosphere_(parameters.corrections.ionosphere_memory),
          augmentation_(augmentation) {}

    /// @param corrected by a base station, so that nothing else is  @param observations outlive what is returned
    EpochEquations make(TransmitterSource& transmitters, const Observations& observations,
                        const ReceiverSettings& settings, bool corrected);
    /// The epoch has a sound fix in three dimensions, or none.
    void solved(bool soundly) { choice_.solved(soundly); }
    /// The receiver has started anew.
    void reset();

private:
    [[nodiscard]] bool takes(const Observation& observation, const ReceiverSettings& settings) const;
    void add(TransmitterSource& transmitters, const Observation& first, std::span<const Observation* const> others,
             GpsTime receive_time, EpochEquations& epoch);

    NavigationParameters parameters_;
    SatelliteChoice choice_;
    TwoBandIonosphere ionosphere_;
    const Augmentation& augmentation_;
    bool corrected_ = false;  // in this epoch
};

}  // namespace skyloop::inline receiver
