#include "world/propagation/ionosphere_truth.hpp"

#include <utility>

#include "detail/lowest_elevation.hpp"
#include "world/gnss/atmosphere.hpp"

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
        return shell_delay(maps_.shell, held_content(maps_, where, truth.time).value_or(Tecu(0)), satellite, truth,
                           carrier);
    }

private:
    IonosphereMaps maps_;
};

Result<std::unique_ptr<IonosphereTruth>> make_map_truth(const ModernContext& context) {
    if (!context.maps)
        return fail(ErrorCode::input, "the ionosphere is to come from maps and none are given; expected an IONEX file");
    if (const auto covered = check_coverage(*context.maps, context.run); !covered) return fail(covered.error());
    return std::make_unique<MapTruth>(context.maps->maps);
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
