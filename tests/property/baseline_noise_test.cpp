// Behaviours B-11 and B-16 of MODELS.md section 9: what the noise of the baseline looks like over an hour at rest.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "property/statistics.hpp"
#include "receiver/error_model/baseline.hpp"
#include "support/model_sky.hpp"

namespace skyloop {
namespace {

constexpr int hour_of_fixes = 3600;

// The ten satellites as they move on: PDOP and delays change slowly, as in a real hour.
SkyView drifting_sky(double seconds) {
    auto spots = test::ten_spots();
    for (std::size_t i = 0; i < spots.size(); ++i) {
        spots[i].azimuth_deg = std::fmod(spots[i].azimuth_deg + seconds * 0.002, 360.0);
        spots[i].elevation_deg += (i % 2 == 0 ? 1 : -1) * seconds * 0.0006;
    }
    return test::sky_of(spots);
}

struct HourAtRest {
    std::array<std::vector<double>, 3> errors;      // per axis of ECEF, m
    std::array<std::vector<double>, 3> normalised;  // by each epoch's own scale
    std::vector<double> lengths;                    // of the error, m
    std::vector<double> scales;                     // E, m
};

HourAtRest hour_at_rest(const ErrorModelSettings& settings) {
    test::ModelRun run(settings);
    HourAtRest hour;
    for (int second = 0; second < hour_of_fixes; ++second) {
        const Trace trace = run.epoch(drifting_sky(second), second);
        EXPECT_EQ(trace.epoch.fix.type, FixType::fix_3d);
        const double scale = uere_scale(trace.epoch.fix, trace.arrivals, settings.baseline).position_error.value();
        const Eigen::Vector3d error = test::position_error(trace);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double value = error[static_cast<Eigen::Index>(axis)];
            hour.errors[axis].push_back(value);
            hour.normalised[axis].push_back(value * std::sqrt(3.0) / scale);
        }
        hour.lengths.push_back(error.norm());
        hour.scales.push_back(scale);
    }
    return hour;
}

ErrorModelSettings preset(const BaselineParameters& parameters) {
    ErrorModelSettings settings;
    settings.baseline = parameters;
    return settings;
}

TEST(BaselineNoise, OfAnHourAtRestIsWhiteUnbiasedAndNormal) {
    for (const auto& parameters : {BaselineParameters::strict(), BaselineParameters::calibrated()}) {
        const HourAtRest hour = hour_at_rest(preset(parameters));
        const double mean_scale = test::mean(hour.scales);
        EXPECT_NEAR(test::rms(hour.lengths) / mean_scale, 1, 0.03);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE(axis);
            EXPECT_LT(std::abs(test::mean(hour.errors[axis])), 4 * mean_scale / std::sqrt(3.0 * hour_of_fixes));
            EXPECT_LT(std::abs(test::lag_one_autocorrelation(hour.errors[axis])), 0.05);
            EXPECT_GT(test::kolmogorov_smirnov_p(hour.normalised[axis], test::standard_normal_distribution), 0.01);
        }
    }
}

TEST(BaselineNoise, AxesAndSeedsAreUncorrelated) {
    ErrorModelSettings other = preset(BaselineParameters::strict());
    other.sensor.seed = 77;
    const HourAtRest a = hour_at_rest(preset(BaselineParameters::strict()));
    const HourAtRest b = hour_at_rest(other);
    const auto correlation = [](const std::vector<double>& x, const std::vector<double>& y) {
        double products = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            products += x[i] * y[i];
        return products / (static_cast<double>(x.size()) * test::rms(x) * test::rms(y));
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LT(std::abs(correlation(a.errors[axis], a.errors[(axis + 1) % 3])), 0.05);
        EXPECT_LT(std::abs(correlation(a.errors[axis], b.errors[axis])), 0.05);
    }
}

TEST(BaselineMotion, SpeedAtRestIsTheNoiseOverTheInterval) {
    const SkyView sky = test::sky_of(test::ten_spots());
    for (const double dt : {1.0, 0.2}) {
        SCOPED_TRACE(dt);
        test::ModelRun run({});
        std::array<std::vector<double>, 3> velocities;
        std::vector<double> headings;
        double scale = 0;
        for (int i = 0; i <= hour_of_fixes; ++i) {
            const Trace trace = run.epoch(sky, i * dt);
            const Fix& fix = trace.epoch.fix;
            if (i == 0) {
                scale = uere_scale(fix, trace.arrivals, {}).position_error.value();
                continue;
            }
            velocities[0].push_back(fix.velocity.north);
            velocities[1].push_back(fix.velocity.east);
            velocities[2].push_back(fix.velocity.down);
            // Neighbouring differences share a fix; every second one is independent.
            if (i % 2 == 1) headings.push_back(fix.course.deg());
        }
        const double expected = scale / std::sqrt(3.0) * std::sqrt(2.0) / dt;
        for (const auto& axis : velocities)
            EXPECT_NEAR(test::rms(axis) / expected, 1, 0.04);
        EXPECT_GT(test::kolmogorov_smirnov_p(headings, [](double degrees) { return degrees / 360; }), 0.01);
    }
}

// The judge must be able to say no.
TEST(KolmogorovSmirnov, TellsANormalSeriesFromAUniformOne) {
    std::mt19937_64 bits(5);
    std::vector<double> uniform;
    for (int i = 0; i < hour_of_fixes; ++i)
        uniform.push_back(std::sqrt(12.0) * (static_cast<double>(bits() >> 11) * 0x1p-53 - 0.5));
    EXPECT_LT(test::kolmogorov_smirnov_p(uniform, test::standard_normal_distribution), 1e-6);
}

}  // namespace
}  // namespace skyloop
