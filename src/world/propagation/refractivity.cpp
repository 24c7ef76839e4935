#include "world/propagation/refractivity.hpp"

namespace skyloop {

Refractivity refractivity_p453(double dry_pressure_hpa, Kelvin temperature, double vapour_pressure_hpa) {
    const double t = temperature.value();
    return {77.6 * dry_pressure_hpa / t, (72 + 3.75e5 / t) * vapour_pressure_hpa / t};
}

}  // namespace skyloop
