#include "receiver/error_model/uere.hpp"

#include <cassert>
#include <cmath>

namespace skyloop {

Metres user_equivalent_range_error(const Arrival& arrival, const BaselineParameters& parameters) {
    return parameters.iono_fraction * arrival.iono_delay + parameters.tropo_fraction * arrival.tropo_delay +
           arrival.excess_path;
}

Metres uere_spread(std::span<const Metres> errors, UereStatistic statistic) {
    const auto n = static_cast<double>(errors.size());
    double centre = 0;
    double freedom = n;
    if (statistic == UereStatistic::sample_std) {
        for (const Metres error : errors)
            centre += error.value();
        centre /= n;
        freedom = n - 1;
    }
    if (freedom < 1) return Metres(0);
    double squares = 0;
    for (const Metres error : errors)
        squares += (error.value() - centre) * (error.value() - centre);
    return Metres(std::sqrt(squares / freedom));
}

UereScale uere_scale(const Fix& fix, const Arrivals& arrivals, const BaselineParameters& parameters) {
    assert(fix.satellites.size() == arrivals.satellites.size());
    std::vector<Metres> errors;
    for (std::size_t i = 0; i < fix.satellites.size(); ++i)
        if (fix.satellites[i].used) errors.push_back(user_equivalent_range_error(arrivals.satellites[i], parameters));
    const Metres sigma = uere_spread(errors, parameters.statistic);
    return {sigma, fix.dop.pdop * sigma};
}

}  // namespace skyloop
