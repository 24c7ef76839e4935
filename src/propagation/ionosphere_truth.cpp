#include "skyloop/propagation/ionosphere_truth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "lowest_elevation.hpp"
#include "skyloop/gnss/atmosphere.hpp"

namespace skyloop {
namespace {

SkyDirection direction_of(const SatelliteInView& satellite) { return {satellite.azimuth, satellite.elevation}; }

bool stands_below(const ThinShell& shell, const TruthState& truth) {
    return truth.geodetic.height.above_ellipsoid < shell.height;
}

constexpr ThinShell klobuchar_shell{Metres(6371000), Metres(350000)};
constexpr ThinShell ntcm_g_shell{Metres(6371000), Metres(450000)};

class KlobucharTruth : public IonosphereTruth {
public:
    explicit KlobucharTruth(const KlobucharCoefficients& coefficients) : coefficients_(coefficients) {}
    Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) override {
        if (!stands_below(klobuchar_shell, truth)) return Metres(0);
        // The very numbers of a receiver that corrects with the same coefficients.
        const auto at_l1 = klobuchar_delay(coefficients_, truth.geodetic, direction_of(satellite), truth.time).slant;
        return ionosphere_delay_at(at_l1, carrier);
    }

private:
    KlobucharCoefficients coefficients_;
};

class NtcmGTruth : public IonosphereTruth {
public:
    NtcmGTruth(const EffectiveIonisation& ionisation, LeapSeconds leap_seconds)
        : ionisation_(ionisation), leap_seconds_(std::move(leap_seconds)) {}
    Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) override {
        if (!stands_below(ntcm_g_shell, truth)) return Metres(0);
        if (truth.time != time_) {
            time_ = truth.time;
            when_ = IonosphereTime::of(to_utc(time_, leap_seconds_));
        }
        const SkyDirection direction{satellite.azimuth, above_horizon(satellite.elevation)};
        return ionosphere_group_delay(ntcm_g_content(ionisation_, truth.geodetic, direction, when_).slant, carrier);
    }

private:
    EffectiveIonisation ionisation_;
    LeapSeconds leap_seconds_;
    GpsTime time_{Nanoseconds::min()};
    IonosphereTime when_;
};

// A vertical content over a shell, towards a satellite.
Metres shell_delay(const ThinShell& shell, Tecu vertical, const SatelliteInView& satellite, const TruthState& truth,
                   Hertz carrier) {
    const double mapping = single_layer_mapping(shell, satellite.elevation, truth.geodetic.height.above_ellipsoid);
    return ionosphere_group_delay(vertical * mapping, carrier);
}

class ConstantTruth : public IonosphereTruth {
public:
    explicit ConstantTruth(Tecu vertical) : vertical_(vertical) {}
    Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) override {
        if (!stands_below({}, truth)) return Metres(0);
        return shell_delay({}, vertical_, satellite, truth, carrier);
    }

private:
    Tecu vertical_;
};

class MapTruth : public IonosphereTruth {
public:
    explicit MapTruth(IonosphereMaps maps) : maps_(std::move(maps)) {}
    Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) override {
        if (!stands_below(maps_.shell, truth)) return Metres(0);
        const PiercePoint where = pierce_point(maps_.shell, truth.geodetic, direction_of(satellite));
        // From the run's start on and on the globe there is a value everywhere: the maps have been searched for holes.
        return shell_delay(maps_.shell, vertical(where, truth.time).value_or(Tecu(0)), satellite, truth, carrier);
    }

private:
    // A run without an end outlasts its maps: the last of them holds.
    [[nodiscard]] std::optional<Tecu> vertical(const PiercePoint& where, GpsTime time) const {
        const IonosphereMap& last = maps_.maps.back();
        return time > last.time ? turned_content(maps_, last, where, time) : vertical_content(maps_, where, time);
    }

    IonosphereMaps maps_;
};

std::string gps_day(GpsTime time) { return format_utc(to_utc(time, LeapSeconds::announced()), 0); }

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

Result<std::unique_ptr<IonosphereTruth>> make_map_truth(const ModernContext& context) {
    if (!context.maps || context.maps->maps.maps.empty())
        return fail(ErrorCode::input, "the ionosphere is to come from maps and none are given; expected an IONEX file");
    const auto& [file, maps] = *context.maps;
    const GpsTime first = maps.maps.front().time, last = maps.maps.back().time;
    if (context.run.first < first || context.run.last > last)
        return fail(ErrorCode::input,
                    fmt::format("{}: its maps span {} to {}; the run lasts from {} to {}", file, gps_day(first),
                                gps_day(last), gps_day(context.run.first), gps_day(context.run.last)));
    for (const IonosphereMap& map : maps.maps) {
        const auto hole = hole_in(maps, map);
        if (hole)
            return fail(ErrorCode::input,
                        fmt::format("{}: the map of {} has no value at latitude {:.2f}°, longitude {:.2f}°; expected "
                                    "maps of the whole globe",
                                    file, gps_day(map.time), hole->latitude.deg(), hole->longitude.deg()));
    }
    return std::make_unique<MapTruth>(maps);
}

EffectiveIonisation ionisation_of(const IonosphereParameters& parameters, const BroadcastIonosphere& broadcast) {
    if (!broadcast.galileo) return parameters.ionisation;
    const auto& [a0, a1, a2] = *broadcast.galileo;
    return {a0, a1, a2};
}

}  // namespace

Result<std::unique_ptr<IonosphereTruth>> make_ionosphere_truth(const IonosphereParameters& parameters,
                                                               const ModernContext& context) {
    switch (parameters.model) {
        case IonosphereModel::klobuchar:
            return std::make_unique<KlobucharTruth>(context.broadcast.gps.value_or(parameters.klobuchar));
        case IonosphereModel::nequick_g:
            return make_nequick_truth(ionisation_of(parameters, context.broadcast), context);
        case IonosphereModel::ionex:
            return make_map_truth(context);
        case IonosphereModel::constant:
            return std::make_unique<ConstantTruth>(parameters.constant_content);
        case IonosphereModel::ntcm_g:
            break;
    }
    return std::make_unique<NtcmGTruth>(ionisation_of(parameters, context.broadcast), context.leap_seconds);
}

}  // namespace skyloop
