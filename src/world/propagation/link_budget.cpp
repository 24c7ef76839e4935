#include "world/propagation/link_budget.hpp"

namespace skyloop {

DecibelWatts received_power(const Arrival& arrival, const LinkBudgetParameters& link) {
    const double unobstructed = link.power_mode == PowerMode::eirp
                                    ? link.satellite_power.value() - arrival.free_space_loss.value()
                                    : link.specified_received_power.value();
    const Decibels losses =
        arrival.gas_loss + arrival.iono_loss + arrival.cloud_loss + arrival.rain_loss + arrival.reflection_loss;
    return DecibelWatts(unobstructed - losses.value());
}

LinkBudget::LinkBudget(const LinkBudgetParameters& link, Decibels environment_noise)
    : link_(link), environment_noise_(environment_noise) {}

double LinkBudget::noise_density_dbw_hz() const { return link_.thermal_noise_dbw_hz + environment_noise_.value(); }

void LinkBudget::apply(Arrivals& arrivals, const SkyView& /*sky*/, const TruthState& /*truth*/) {
    for (Arrival& arrival : arrivals.satellites) {
        arrival.reflection_loss = link_.reflection_loss * arrival.reflections;
        arrival.cn0.reset();
        if (arrival.paths > 0) arrival.cn0 = DbHz(received_power(arrival, link_).value() - noise_density_dbw_hz());
    }
}

}  // namespace skyloop
