#include "detail/false_place.hpp"

#include <algorithm>
#include <cmath>

#include "world/gnss/constants.hpp"
#include "world/gnss/earth_turn.hpp"

namespace skyloop {

RangeAndRate light_time_range(const SatelliteInView& satellite, const AntennaMotion& antenna) {
    const Eigen::Vector3d& sent_from = satellite.position_at_transmission.vector();
    const Eigen::Vector3d& sent_with = satellite.velocity_at_transmission.vector();
    constexpr int rounds = 5;  // each leaves a hundred-thousandth of the error
    double travel = satellite.travel_time.value();
    Eigen::Vector3d place = sent_from;
    for (int i = 0; i < rounds; ++i) {
        const double earlier = travel - satellite.travel_time.value();
        place = turned_by(Eigen::Vector3d(sent_from - earlier * sent_with), travel);
        travel = (place - antenna.position.vector()).norm() / speed_of_light;
    }
    const Eigen::Vector3d line = place - antenna.position.vector();
    const Eigen::Vector3d direction = line.normalized();
    const Eigen::Vector3d velocity = turned_by(sent_with, travel);
    const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(place.y(), -place.x(), 0);
    const double own = direction.dot(velocity - antenna.velocity.vector());
    return {Metres(line.norm()), MetresPerSecond(own / (1 + direction.dot(velocity - turn) / speed_of_light))};
}

RangeAndRate false_range(const SatelliteInView& satellite, const AntennaMotion& told, const TruthState& truth) {
    const RangeAndRate there = light_time_range(satellite, told);
    const RangeAndRate here = light_time_range(satellite, {truth.position, truth.velocity});
    return {there.range - here.range, there.rate - here.rate};
}

Metres SmoothWay::after(Seconds time) const {
    const double whole = distance.value(), a = acceleration, t = time.value();
    if (!(whole > 0) || t <= 0) return Metres(0);
    const double v = std::min(speed.value(), std::sqrt(whole * a));
    const double speeding = v / a, steady = whole / v - speeding, end = steady + 2 * speeding;
    if (t >= end) return distance;
    if (t < speeding) return Metres(a * t * t / 2);
    if (t < speeding + steady) return Metres(v * speeding / 2 + v * (t - speeding));
    return Metres(whole - a * (end - t) * (end - t) / 2);
}

MetresPerSecond RateOfChange::of(SatelliteId satellite, Metres value, GpsTime now) {
    const auto [place, is_new] = last_.try_emplace(satellite, Last{value, now});
    const double passed = difference(now, place->second.at).value();
    if (is_new || passed <= 0) return MetresPerSecond(0);
    const MetresPerSecond rate((value - place->second.value).value() / passed);
    place->second = {value, now};
    return rate;
}

}  // namespace skyloop
