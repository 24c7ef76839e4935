#include "world/gnss/interference.hpp"

#include <cmath>

namespace skyloop {

double rejection_quality(JammerKind kind) {
    switch (kind) {
        case JammerKind::narrow_band:
            return 1;
        case JammerKind::wide_band:
            return 2.2;
        case JammerKind::matched:
            break;
    }
    return 1.5;
}

DbHz cn0_under_interference(DbHz cn0, Decibels jammer_to_signal, const InterferenceRejection& rejection) {
    const double noise = std::pow(10, -cn0.value() / 10);
    const double jammer =
        std::pow(10, jammer_to_signal.value() / 10) / (rejection.quality * rejection.chip_rate.value());
    return DbHz(-10 * std::log10(noise + jammer));
}

}  // namespace skyloop
