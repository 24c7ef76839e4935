/// A sky of ten satellites and a sensor model under it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/model_effects.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/ray_geometry.hpp"

namespace skyloop::test {

/// Azimuth and elevation, degrees.
struct SkySpot {
    double azimuth_deg, elevation_deg;
};

/// An open sky: ten satellites between 8° and 81°.
inline std::vector<SkySpot> ten_spots() {
    return {{12, 34}, {57, 8}, {95, 52}, {131, 21}, {168, 66}, {203, 13}, {241, 43}, {274, 81}, {309, 27}, {341, 17}};
}

/// Healthy GPS satellites G01, G02, … at these places of the sky.
inline SkyView sky_of(const std::vector<SkySpot>& spots) {
    SkyView sky;
    for (const SkySpot& spot : spots) {
        SatelliteInView satellite;
        satellite.id = {Constellation::gps, static_cast<int>(sky.satellites.size()) + 1};
        satellite.azimuth = Angle::degrees(spot.azimuth_deg);
        satellite.elevation = Angle::degrees(spot.elevation_deg);
        satellite.range = path_to_height({satellite.elevation, Metres(0)}, Metres(20180000));
        sky.satellites.push_back(satellite);
    }
    return sky;
}

inline TruthState truth_at(const Geodetic& place, GpsTime time) {
    TruthState truth;
    truth.time = time;
    truth.geodetic = place;
    truth.position = to_ecef(place);
    return truth;
}

/// A sensor model with its effects, at rest in Odessa from the start of a GPS week.
class ModelRun {
public:
    explicit ModelRun(const ErrorModelSettings& settings, const EffectSettings& effects = {})
        : model_(make_error_model(settings)) {
        auto made = effects_for(settings.kind, effects);
        EXPECT_TRUE(made) << (made ? "" : made.error().message);
        if (made) effects_ = std::move(*made);
    }

    /// The epoch `since_start` seconds after the start. @param change what else happens to the signals, before the
    /// budget
    template <class Change>
    Trace epoch(const SkyView& sky, double since_start, Change&& change) {
        Trace trace;
        trace.truth = truth_at(Geodetic::degrees(46.4774, 30.7326, 50), to_gps_time(2111, since_start));
        trace.sky = sky;
        trace.arrivals = free_space(sky);
        for (std::size_t i = 0; i < effects_.size(); ++i) {
            if (i + 1 == effects_.size()) change(trace.arrivals);
            effects_[i]->apply(trace.arrivals, trace.sky, trace.truth);
        }
        trace.epoch.fix = model_->fix(trace.truth, trace.sky, trace.arrivals);
        trace.error_scale = model_->last_scale();
        return trace;
    }
    Trace epoch(const SkyView& sky, double since_start) {
        return epoch(sky, since_start, [](Arrivals&) {});
    }

private:
    std::unique_ptr<ErrorModel> model_;
    std::vector<std::unique_ptr<PropagationEffect>> effects_;
};

/// Reported less true position, ECEF, m.
inline Eigen::Vector3d position_error(const Trace& trace) {
    return (to_ecef(trace.epoch.fix.position) - trace.truth.position).vector();
}

}  // namespace skyloop::test
