#include "world/propagation/named_ionosphere_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/time/utc_time.hpp"

namespace skyloop::inline world {
namespace {

// A place without a value: a node of the grid, or one of those that a grid of less than the globe does not reach.
std::optional<PiercePoint> hole_in(const IonosphereMaps& maps, const IonosphereMap& map) {
    const GridAxis &latitude = maps.latitude, &longitude = maps.longitude;
    const auto line = [](const GridAxis& axis, std::size_t i) {
        return axis.first + axis.step * static_cast<double>(i);
    };
    for (std::size_t node = 0; node < map.content_tecu.size(); ++node)
        if (std::isnan(map.content_tecu[node]))
            return PiercePoint{line(latitude, node / longitude.count), line(longitude, node % longitude.count)};
    // Halfway on from the last meridian to the first, and there at the poles.
    const Angle once_around = Angle::degrees(std::copysign(360, longitude.step.rad()));
    const Angle between = (line(longitude, longitude.count - 1) + longitude.first + once_around) * 0.5;
    for (const Angle pole : {Angle::degrees(-90), Angle::degrees(90)})
        if (const PiercePoint where{pole, between}; !map_content(maps, map, where)) return where;
    return std::nullopt;
}

}  // namespace

Result<void> check_coverage(const NamedIonosphereMaps& maps, const TimeSpan& run) {
    const std::vector<IonosphereMap>& all = maps.maps.maps;
    if (all.empty()) return fail(ErrorCode::input, fmt::format("{}: holds no map of the ionosphere", maps.file));
    const GpsTime first = all.front().time, last = all.back().time;
    if (run.first < first || run.last > last)
        return fail(ErrorCode::input,
                    fmt::format("{}: its maps span {} to {}; the run lasts from {} to {}", maps.file, utc_text(first),
                                utc_text(last), utc_text(run.first), utc_text(run.last)));
    for (const IonosphereMap& map : all) {
        const auto hole = hole_in(maps.maps, map);
        if (hole)
            return fail(ErrorCode::input,
                        fmt::format("{}: the map of {} has no value at latitude {:.2f}°, longitude {:.2f}°; expected "
                                    "maps of the whole globe",
                                    maps.file, utc_text(map.time), hole->latitude.deg(), hole->longitude.deg()));
    }
    return {};
}

}  // namespace skyloop::inline world
