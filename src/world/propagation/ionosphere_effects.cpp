#include "world/propagation/ionosphere_effects.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/time/knotted_process.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/nequick_g.hpp"
#include "world/gnss/shell_ionosphere.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/ray_geometry.hpp"

namespace skyloop::inline world {
namespace {

bool stands_below(const ThinShell& shell, const TruthState& truth) {
    return truth.geodetic.height.above_ellipsoid < shell.height;
}

constexpr ThinShell klobuchar_shell{Metres(6371000), Metres(350000)};
constexpr ThinShell ntcm_g_shell{Metres(6371000), Metres(450000)};

IonosphereTruth klobuchar_truth(const KlobucharCoefficients& coefficients) {
    return [coefficients](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        if (!stands_below(klobuchar_shell, truth)) return Metres(0);
        // The very numbers of a receiver that corrects with the same coefficients.
        const auto at_l1 = klobuchar_delay(coefficients, truth.geodetic, direction_of(satellite), truth.time).slant;
        return ionosphere_delay_at(at_l1, carrier);
    };
}

IonosphereTruth ntcm_g_truth(const EffectiveIonisation& ionisation, const LeapSeconds& leap_seconds) {
    return [ionisation, leap_seconds, time = GpsTime(Nanoseconds::min()), when = IonosphereTime{}](
               const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) mutable {
        if (!stands_below(ntcm_g_shell, truth)) return Metres(0);
        if (truth.time != time) {
            time = truth.time;
            when = IonosphereTime::of(to_utc(time, leap_seconds));
        }
        const SkyDirection direction{satellite.azimuth, above_horizon(satellite.elevation)};
        const Geodetic ground{truth.geodetic.latitude, truth.geodetic.longitude, {}};
        const PiercePoint where = pierce_point(ntcm_g_shell, ground, direction);
        return ionosphere_group_delay(ntcm_g_content(ionisation, where, direction.elevation, when), carrier);
    };
}

// A vertical content over a shell, towards a satellite.
Metres shell_delay(const ThinShell& shell, Tecu vertical, const SatelliteInView& satellite, const TruthState& truth,
                   Hertz carrier) {
    const double mapping = single_layer_mapping(shell, satellite.elevation, truth.geodetic.height.above_ellipsoid);
    return ionosphere_group_delay(vertical * mapping, carrier);
}

IonosphereTruth constant_truth(Tecu vertical) {
    return [vertical](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        return stands_below({}, truth) ? shell_delay({}, vertical, satellite, truth, carrier) : Metres(0);
    };
}

Result<IonosphereTruth> map_truth(const ModernContext& context) {
    if (!context.maps)
        return fail(ErrorCode::input, "the ionosphere is to come from maps and none are given; expected an IONEX file");
    if (const auto covered = check_coverage(*context.maps, context.run); !covered) return fail(covered.error());
    return [maps = context.maps->maps](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        if (!stands_below(maps.shell, truth)) return Metres(0);
        const PiercePoint where = pierce_point(maps.shell, truth.geodetic, direction_of(satellite));
        // From the run's start on and on the globe there is a value everywhere: the maps have been searched for holes.
        const Tecu vertical = held_content(maps, where, truth.time).value_or(Tecu(0));
        return shell_delay(maps.shell, vertical, satellite, truth, carrier);
    };
}

EffectiveIonisation ionisation_of(const IonosphereParameters& parameters, const BroadcastIonosphere& broadcast) {
    if (!broadcast.galileo) return parameters.ionisation;
    const auto& [a0, a1, a2] = *broadcast.galileo;
    return {a0, a1, a2};
}

}  // namespace

Result<IonosphereTruth> make_ionosphere_truth(const IonosphereParameters& parameters, const ModernContext& context) {
    switch (parameters.model) {
        case IonosphereModel::klobuchar:
            return klobuchar_truth(context.broadcast.gps.value_or(parameters.klobuchar));
        case IonosphereModel::nequick_g:
            return make_nequick_truth(ionisation_of(parameters, context.broadcast), context);
        case IonosphereModel::ionex:
            return map_truth(context);
        case IonosphereModel::constant:
            return constant_truth(parameters.constant_content);
        case IonosphereModel::ntcm_g:
            break;
    }
    return ntcm_g_truth(ionisation_of(parameters, context.broadcast), context.leap_seconds);
}

namespace {

constexpr Nanoseconds nequick_spacing = std::chrono::seconds(30);

Position<Ecef> carried_ahead(const SatelliteInView& satellite, Seconds dt) {
    const Eigen::Vector3d p = satellite.position_at_transmission.vector();
    const Eigen::Vector3d v = satellite.velocity_at_transmission.vector();
    const Eigen::Vector3d turn(0, 0, earth_rotation_rate);
    const double r = p.norm();
    const Eigen::Vector3d acceleration =
        -gravitational_constant_gps / (r * r * r) * p - 2 * turn.cross(v) - turn.cross(turn.cross(p));
    return Position<Ecef>(p + dt.value() * v + dt.value() * dt.value() / 2 * acceleration);
}

class NequickTruth {
public:
    NequickTruth(std::vector<NequickTables> months, const EffectiveIonisation& ionisation, LeapSeconds leap_seconds)
        : months_(std::move(months)), ionisation_(ionisation), leap_seconds_(std::move(leap_seconds)) {}

    Metres operator()(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        Content& content = contents_.of(satellite.id, [](SatelliteId) { return Content{}; });
        const std::int64_t knot = truth.time.time_since_epoch() / nequick_spacing;
        if (content.knot != knot) {
            content.from = content.knot + 1 == knot ? content.to : at(knot, satellite, truth);
            content.to = at(knot + 1, satellite, truth);
            content.knot = knot;
        }
        const double fraction =
            difference(truth.time, GpsTime(knot * nequick_spacing)).value() / to_seconds(nequick_spacing).value();
        return ionosphere_group_delay(content.from * (1 - fraction) + content.to * fraction, carrier);
    }

private:
    // At the two knots around the present.
    struct Content {
        std::int64_t knot = -2;
        Tecu from, to;
    };

    [[nodiscard]] Tecu at(std::int64_t knot, const SatelliteInView& satellite, const TruthState& truth) const {
        const GpsTime time(knot * nequick_spacing);
        const UtcTime utc = to_utc(time, leap_seconds_);
        const Geodetic there = to_geodetic(carried_ahead(satellite, difference(time, truth.time)));
        return nequick_slant_content(months_[utc.month - 1], ionisation_, truth.geodetic, there,
                                     utc.seconds_of_day() / 3600);
    }

    std::vector<NequickTables> months_;  // of the year, January first
    EffectiveIonisation ionisation_;
    LeapSeconds leap_seconds_;
    PerSatellite<Content> contents_;
};

constexpr std::array<const char*, 12> month_names{"January",   "February", "March",    "April",
                                                  "May",       "June",     "July",     "August",
                                                  "September", "October",  "November", "December"};

}  // namespace

Result<IonosphereTruth> make_nequick_truth(const EffectiveIonisation& ionisation, const ModernContext& context) {
    // All of the year, for a run need not have an end.
    std::vector<NequickTables> months;
    for (const char* name : month_names) {
        auto read = read_nequick_tables(context.nequick_folder, static_cast<int>(months.size()) + 1);
        if (!read)
            return fail(read.error().code,
                        fmt::format("NeQuick-G has no tables for {}: {}", name, read.error().message));
        months.push_back(std::move(*read));
    }
    return NequickTruth(std::move(months), ionisation, context.leap_seconds);
}

namespace {

constexpr Nanoseconds ionosphere_spacing = std::chrono::seconds(60);
}  // namespace

IonosphereResidual::IonosphereResidual(const IonosphereParameters& parameters, const ErrorTerm& term,
                                       std::uint64_t seed)
    : parameters_(parameters),
      term_(term),
      seed_(seed),
      vertical_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.vertical")),
      north_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.north")),
      east_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.east")) {}

double IonosphereResidual::share(SatelliteId satellite, const SkyDirection& direction, const Geodetic& antenna,
                                 GpsTime time) {
    KnottedProcess& single = singles_.of(satellite, [this](SatelliteId id) {
        return KnottedProcess({1, parameters_.single_time}, ionosphere_spacing,
                              term_.stream(seed_, "ionosphere_residual." + to_string(id)));
    });
    const double away = gradient_arm(direction.elevation, antenna.height.above_ellipsoid);
    const double slope =
        north_.at(time) * std::cos(direction.azimuth.rad()) + east_.at(time) * std::sin(direction.azimuth.rad());
    return parameters_.common * vertical_.at(time) + parameters_.gradient * away * slope +
           parameters_.single * single.at(time);
}

IonosphereDelay::IonosphereDelay(IonosphereTruth model, const ModernPropagationParameters& parameters,
                                 const ResidualReach& residual, std::uint64_t seed)
    : model_(std::move(model)),
      residual_(parameters.ionosphere_model, parameters.ionosphere_residual, seed),
      waves_(parameters.ionosphere_model.waves,
             noise_key(parameters.ionosphere_residual.seed.value_or(seed), "ionosphere_residual.waves")),
      calm_(parameters.ionosphere_model.waves.content == Tecu(0)),
      reach_(residual),
      factor_(parameters.ionosphere.factor()),
      residual_factor_(parameters.ionosphere_residual.factor()) {}

void IonosphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Hertz carrier = first_carrier(arrival);
        const Metres model = model_(satellite, truth, carrier) * factor_;
        arrival.iono_delay = model;
        if (residual_factor_ == 0 || model == Metres(0)) return;
        double departure = 0;
        if (satellite.id.constellation == Constellation::galileo ? reach_.galileo : reach_.others)
            departure = residual_.share(satellite.id, direction_of(satellite), truth.geodetic, truth.time);
        Metres delay = model * (1 + residual_factor_ * departure);
        if (!calm_ && stands_below({}, truth))
            delay += ionosphere_group_delay(waves_.slant(satellite, truth), carrier) * (factor_ * residual_factor_);
        // However the day departs from the model, electrons never speed the code up.
        arrival.iono_delay = std::max(delay, Metres(0));
    });
}

namespace {

constexpr ThinShell scintillation_shell{Metres(6371000), Metres(350000)};

double bell(double distance, double width) { return std::exp(-distance * distance / (2 * width * width)); }

}  // namespace

Angle dipole_modified_dip(const Geodetic& place) {
    const Angle pole_latitude = Angle::degrees(79.74), pole_longitude = Angle::degrees(-71.78);
    const double latitude = place.latitude.rad();
    const double sine =
        std::sin(latitude) * std::sin(pole_latitude.rad()) +
        std::cos(latitude) * std::cos(pole_latitude.rad()) * std::cos((place.longitude - pole_longitude).rad());
    const double dip = std::atan(2 * std::tan(std::asin(std::clamp(sine, -1.0, 1.0))));
    return Angle::radians(std::atan2(dip, std::sqrt(std::max(std::cos(latitude), 0.0))));
}

double evening_share(const ScintillationParameters& parameters, const Geodetic& place, double hours) {
    if (!parameters.equatorial_evening) return 1;
    const double local = hours + place.longitude.deg() / 15;
    const double from_peak = std::remainder(local - parameters.evening_peak_h, 24.0);
    const double from_crest = std::abs(dipole_modified_dip(place).deg()) - parameters.crest.deg();
    double crest = bell(from_crest, parameters.crest_width.deg());
    if (from_crest < 0) crest = (1 + crest) / 2;  // half of it is left between the crests
    return bell(from_peak, parameters.evening_width_h) * crest;
}

ScintillationIndices::ScintillationIndices(const ScintillationParameters& parameters, const ErrorTerm& term,
                                           LeapSeconds leap_seconds)
    : parameters_(parameters), factor_(term.factor()), leap_seconds_(std::move(leap_seconds)) {}

void ScintillationIndices::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0 || (parameters_.s4 == 0 && parameters_.sigma_phi.rad() == 0)) return;
    if (truth.geodetic.height.above_ellipsoid >= scintillation_shell.height) return;
    const double hours = to_utc(truth.time, leap_seconds_).seconds_of_day() / 3600;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const SkyDirection direction = direction_of(satellite);
        const PiercePoint pierce = pierce_point(scintillation_shell, truth.geodetic, direction);
        const double share = factor_ * evening_share(parameters_, {pierce.latitude, pierce.longitude, {}}, hours);
        const double slant =
            single_layer_mapping(scintillation_shell, direction.elevation, truth.geodetic.height.above_ellipsoid);
        const double wavelength = carrier_frequency_l1 / first_carrier(arrival).value();  // over that of L1
        arrival.amplitude_scintillation =
            std::min(parameters_.s4 * share * std::pow(slant, 0.9) * std::pow(wavelength, 1.5), strongest_s4);
        arrival.phase_scintillation = parameters_.sigma_phi * (share * std::sqrt(slant) * wavelength);
    });
}

}  // namespace skyloop::inline world
