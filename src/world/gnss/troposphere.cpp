#include "world/gnss/troposphere.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {

SurfaceWeather standard_weather(MslHeight height, double relative_humidity) {
    // Above 40 km the power law would leave the reals; there is no weather there.
    const double h = std::clamp(height.above_sea_level.value(), 0.0, 40000.0);
    SurfaceWeather weather;
    weather.pressure_hpa = 1013.25 * std::pow(1 - 2.2557e-5 * h, 5.2568);
    const double t = 288.16 - 6.5e-3 * h;
    weather.temperature = Kelvin(t);
    // The saturation formula has its pole at 38.45 K; cold air holds nothing long before.
    weather.vapour_pressure_hpa = t > 100 ? 6.108 * relative_humidity * std::exp((17.15 * t - 4684) / (t - 38.45)) : 0;
    return weather;
}

Metres zenith_hydrostatic_delay(double pressure_hpa, Angle latitude, MslHeight height) {
    const double height_km = std::max(height.above_sea_level.value(), 0.0) / 1000;
    return Metres(0.0022768 * pressure_hpa / (1 - 0.00266 * std::cos(2 * latitude.rad()) - 0.00028 * height_km));
}

Metres zenith_wet_delay(const SurfaceWeather& weather) {
    return Metres(0.002277 * (1255 / weather.temperature.value() + 0.05) * weather.vapour_pressure_hpa);
}

ZenithDelay saastamoinen_zenith_delay(const SurfaceWeather& weather, Angle latitude, MslHeight height) {
    return {zenith_hydrostatic_delay(weather.pressure_hpa, latitude, height), zenith_wet_delay(weather)};
}

Metres saastamoinen_delay(Angle latitude, MslHeight height, Angle elevation, double relative_humidity) {
    const ZenithDelay zenith = saastamoinen_zenith_delay(standard_weather(height, relative_humidity), latitude, height);
    return zenith.total() / std::sin(elevation.rad());
}

}  // namespace skyloop
