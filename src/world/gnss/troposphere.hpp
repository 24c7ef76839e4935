/// The delay of the neutral air by Saastamoinen's formulas, and the weather that they need.
#pragma once

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop {

/// The air at an antenna.
struct SurfaceWeather {
    double pressure_hpa = 1013.25;  ///< total
    Kelvin temperature{288.16};
    double vapour_pressure_hpa = 0;
};

/// The standard atmosphere that receivers assume: 1013.25 hPa and 15 °C at sea level, 6.5 K less per kilometre, vapour
/// from the relative humidity; constant below sea level (Saastamoinen 1972; MODELS.md 7.3; RTKLIB's constants).
/// @param relative_humidity 0 … 1
SurfaceWeather standard_weather(MslHeight height, double relative_humidity);

/// Zenith hydrostatic delay 0.0022768 P/(1 − 0.00266 cos 2φ − 0.00028 h_km) (Saastamoinen 1972; Davis et al. 1985).
Metres zenith_hydrostatic_delay(double pressure_hpa, Angle latitude, MslHeight height);
/// Zenith wet delay 0.002277 (1255/T + 0.05) e (Saastamoinen 1972).
Metres zenith_wet_delay(const SurfaceWeather& weather);

/// Zenith delays of both parts.
struct ZenithDelay {
    Metres hydrostatic;
    Metres wet;
    [[nodiscard]] Metres total() const { return hydrostatic + wet; }
};
ZenithDelay saastamoinen_zenith_delay(const SurfaceWeather& weather, Angle latitude, MslHeight height);

/// Slant delay in the standard atmosphere, mapped by 1/sin e as the simplest receivers do.
/// @param elevation above 0°
Metres saastamoinen_delay(Angle latitude, MslHeight height, Angle elevation, double relative_humidity);

}  // namespace skyloop
