#include "world/propagation/knife_edge.hpp"

#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop {

double knife_edge_parameter(Angle detour, Metres distance, Hertz carrier) {
    return detour.rad() * std::sqrt(2 * distance.value() * carrier.value() / speed_of_light);
}

Metres knife_edge_reach(Angle beside, Hertz carrier) {
    const double ratio = knife_edge_clear / beside.rad();
    return Metres(ratio * ratio * speed_of_light / (2 * carrier.value()));
}

Decibels knife_edge_loss(double v) {
    if (!(v > knife_edge_clear)) return Decibels(0);
    const double x = v - 0.1;
    return Decibels(6.9 + 20 * std::log10(std::sqrt(x * x + 1) + x));
}

}  // namespace skyloop
