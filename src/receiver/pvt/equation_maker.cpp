#include "receiver/pvt/equation_maker.hpp"

#include <utility>

#include "receiver/pvt/observation_equations.hpp"

namespace skyloop::inline receiver {

void EquationMaker::reset() {
    choice_.reset();
    ionosphere_.reset();
}

bool EquationMaker::takes(const Observation& observation, const ReceiverSettings& settings) const {
    return observation.pseudorange && observation.cn0 >= settings.minimum_cn0;
}

void EquationMaker::add(TransmitterSource& transmitters, const Observation& first,
                        std::span<const Observation* const> others, GpsTime receive_time, EpochEquations& epoch) {
    const bool combined = parameters_.corrections.ionosphere_free && !corrected_;
    const auto none = std::span<const Observation* const>();
    auto made = range_equation(transmitters, first, combined ? others : none, receive_time);
    if (!made) return;
    made->selected = choice_.takes(first);
    // Asked at every epoch, as it averages.
    if (!corrected_ && !combined)
        made->ionosphere = ionosphere_.measure(transmitters, made->transmitter, first, others, receive_time);
    if (!corrected_ && made->carrier > Hertz(0) && parameters_.differential.kind == DifferentialKind::none)
        augmentation_.correct(*made);
    epoch.equations.push_back(*made);
    epoch.primaries.push_back(&first);
}

EpochEquations EquationMaker::make(TransmitterSource& transmitters, const Observations& observations,
                                   const ReceiverSettings& settings, bool corrected) {
    const std::vector<Observation>& all = observations.signals;
    EpochEquations epoch;
    corrected_ = corrected;
    choice_.begin(observations);
    for (std::size_t i = 0; i < all.size();) {
        // The signals of one satellite: its first one, or what there is, and the others.
        const Observation* first = nullptr;
        InplaceVector<const Observation*, most_signals> others;
        const SatelliteId id = all[i].satellite;
        for (; i < all.size() && all[i].satellite == id; ++i) {
            if (!takes(all[i], settings)) continue;
            const Observation* other = &all[i];
            if (first == nullptr || other->signal == first_signal(id.constellation)) std::swap(first, other);
            if (other != nullptr && others.size() < most_signals) others.push_back(other);
        }
        if (first == nullptr || (id.constellation == Constellation::sbas && !settings.sbas_ranging)) continue;
        add(transmitters, *first, others, observations.receive_time, epoch);
    }
    return epoch;
}

}  // namespace skyloop::inline receiver
