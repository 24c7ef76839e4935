// What a modern receiver's errors look like (MODELS.md, B-20 … B-23 and B-27 … B-29).
#include <gtest/gtest.h>

#include <cmath>

#include "property/statistics.hpp"
#include "support/modern_run.hpp"

namespace skyloop::test {
namespace {

const GpsTime profile_start = to_gps_time(2300, 259200.0);
const Geodetic profile_place = Geodetic::degrees(52.2, 13.4, 60);

struct Plan {
    ModernPreset preset = ModernPreset::survey;
    std::int64_t step_s = 30;
    int epochs = 2880;
    ReceiverSettings receiver = gps_alone();
    std::uint64_t seed = 1;
    bool ionosphere = true;
};

template <class Look>
void run_plan(const Plan& plan, Look&& look) {
    ModernSettings settings = ModernSettings::of(plan.preset);
    settings.propagation.ionosphere.enabled = plan.ionosphere;
    settings = effective(settings);
    const bool gps = plan.receiver.signals == gps_alone().signals;
    auto orbits = gps ? std::make_unique<FourSystems>(std::vector{Constellation::gps}) : nullptr;
    Simulation simulation =
        modern_run(settings, std::make_unique<FixedPoint>(profile_place), plan.seed, std::move(orbits));
    for (int k = 0; k < plan.epochs; ++k)
        look(simulation.run(profile_start + std::chrono::seconds(plan.step_s * k), plan.receiver));
}

ErrorSeries errors_of(const Plan& plan) {
    ErrorSeries errors;
    run_plan(plan, [&](const Trace& trace) { errors.add(trace); });
    EXPECT_EQ(errors.east.size(), static_cast<std::size_t>(plan.epochs)) << "a fix at every epoch";
    return errors;
}

double deviation(const std::vector<double>& series) {
    const double centre = mean(series);
    double squares = 0;
    for (const double value : series)
        squares += (value - centre) * (value - centre);
    return std::sqrt(squares / static_cast<double>(series.size()));
}

double horizontal_deviation(const ErrorSeries& e) { return std::hypot(deviation(e.east), deviation(e.north)); }

// B-20: a day under an open sky, GPS alone; the mean of three seeds.
TEST(ModernProfile, ADayScattersAsRealOnesDo) {
    const auto day = [](ModernPreset preset) {
        double horizontal = 0, vertical = 0;
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const ErrorSeries e = errors_of({preset, 30, 2880, gps_alone(), seed});
            horizontal += horizontal_deviation(e) / 3;
            vertical += deviation(e.up) / 3;
        }
        return std::pair{horizontal, vertical};
    };
    const auto [survey_h, survey_v] = day(ModernPreset::survey);
    EXPECT_GT(survey_h, 0.5);
    EXPECT_LT(survey_h, 1.2);
    EXPECT_GT(survey_v, 0.9);
    EXPECT_LT(survey_v, 2.0);
    const auto [consumer_h, consumer_v] = day(ModernPreset::consumer);
    EXPECT_GT(consumer_h, 0.8);
    EXPECT_LT(consumer_h, 2.0);
    EXPECT_GT(consumer_v, 1.3);
    EXPECT_LT(consumer_v, 3.0);
}

// B-20, B-21: an hour at 1 Hz wanders slowly and its epochs differ by little.
TEST(ModernProfile, AnHourWandersAndDoesNotJump) {
    for (const ModernPreset preset : {ModernPreset::survey, ModernPreset::consumer}) {
        double spread = 0, remembered = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const ErrorSeries e = errors_of({preset, 1, 3600, gps_alone(), seed});
            spread += horizontal_deviation(e) / 4;
            std::vector<double> steps;
            for (std::size_t i = 1; i < e.east.size(); ++i)
                steps.push_back((e.east[i] - e.east[i - 1]) / std::sqrt(2.0));
            EXPECT_LT(rms(steps), preset == ModernPreset::survey ? 0.15 : 0.5);
            // Autocorrelation after 20 s: white noise would have none.
            double products = 0, squares = 0;
            const double centre = mean(e.east);
            for (std::size_t i = 0; i < e.east.size(); ++i) {
                squares += (e.east[i] - centre) * (e.east[i] - centre);
                if (i >= 20) products += (e.east[i] - centre) * (e.east[i - 20] - centre);
            }
            remembered += products / squares / 4;
        }
        constexpr double unsure = 0.03;  // σ of the mean of four hours, about
        EXPECT_GT(remembered, 1 / std::exp(1.0) - unsure);
        EXPECT_GT(spread, 0.2);
        EXPECT_LT(spread, 1.5);
    }
}

// B-22
TEST(ModernProfile, SignalsAreAsStrongAsRealOnes) {
    double low = 0, high = 0;
    int lows = 0, highs = 0;
    run_plan({ModernPreset::consumer, 300, 288}, [&](const Trace& trace) {
        for (const SatelliteStatus& s : trace.epoch.fix.satellites) {
            if (!s.used) continue;
            EXPECT_GE(s.cn0->value(), 25);
            EXPECT_LE(s.cn0->value(), 53);
            if (s.elevation.deg() >= 5 && s.elevation.deg() < 15) low += s.cn0->value(), ++lows;
            if (s.elevation.deg() > 45) high += s.cn0->value(), ++highs;
        }
    });
    ASSERT_GT(lows, 100);
    ASSERT_GT(highs, 100);
    EXPECT_GT(low / lows, 30);
    EXPECT_LT(low / lows, 40);
    EXPECT_GT(high / highs, 42);
    EXPECT_LT(high / highs, 52);
}

// B-23
TEST(ModernProfile, VelocityComesFromDoppler) {
    for (const ModernPreset preset : {ModernPreset::survey, ModernPreset::consumer}) {
        std::vector<double> north, position;
        run_plan({preset, 1, 3600}, [&](const Trace& trace) {
            north.push_back(trace.epoch.fix.velocity.north);
            position.push_back(trace.epoch.fix.position.latitude.rad());
        });
        EXPECT_GT(deviation(north), 0.005);
        EXPECT_LT(deviation(north), 0.08);
        double products = 0;
        const double velocity_mean = mean(north), position_mean = mean(position);
        for (std::size_t i = 0; i < north.size(); ++i)
            products += (north[i] - velocity_mean) * (position[i] - position_mean);
        products /= static_cast<double>(north.size()) * deviation(north) * deviation(position);
        EXPECT_LT(std::abs(products), 0.25);
    }
}

// B-27
TEST(ModernProfile, MoreSystemsScatterLess) {
    double alone = 0, together = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        alone += horizontal_deviation(errors_of({ModernPreset::survey, 120, 720, gps_alone(), seed}));
        together += horizontal_deviation(errors_of({ModernPreset::survey, 120, 720, all_systems(), seed}));
    }
    // The air is the same for all of them.
    EXPECT_GT(1 - together / alone, 0.22);
    EXPECT_LT(1 - together / alone, 0.6);
}

// B-28, for the height too. GPS alone holds 60 %; many satellites average noise away, not what they share.
TEST(ModernProfile, ReportedAccuracyIsHonest) {
    for (const ReceiverSettings& receiver : {gps_alone(), all_systems()}) {
        for (const ModernPreset preset : {ModernPreset::survey, ModernPreset::consumer}) {
            int bounded = 0, above = 0, epochs = 0;
            for (std::uint64_t seed = 1; seed <= 6; ++seed)
                run_plan({preset, 120, 720, receiver, seed}, [&](const Trace& trace) {
                    const Fix& fix = trace.epoch.fix;
                    const Eigen::Vector3d e = LocalFrame(trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
                    bounded += std::hypot(e.x(), e.y()) <= fix.horizontal_accuracy.value() ? 1 : 0;
                    above += std::abs(e.z()) <= fix.vertical_accuracy.value() ? 1 : 0;
                    ++epochs;
                });
            const bool alone = !receiver.signals.empty();
            SCOPED_TRACE(testing::Message() << "preset " << static_cast<int>(preset) << (alone ? ", GPS alone" : ""));
            EXPECT_GT(bounded, (alone ? 0.6 : 0.5) * epochs);
            EXPECT_LT(bounded, 0.8 * epochs);
            EXPECT_GT(above, 0.6 * epochs);
            EXPECT_LT(above, 0.85 * epochs);
        }
    }
}

// B-29
TEST(ModernProfile, SeedsDecideEverything) {
    // Without the ionosphere: what its model has over the receiver's is the same for every seed.
    const Plan plan{ModernPreset::consumer, 60, 1440, gps_alone(), 5, false};
    const ErrorSeries one = errors_of(plan), same = errors_of(plan);
    EXPECT_EQ(one.east, same.east);
    EXPECT_EQ(one.up, same.up);
    Plan another = plan;
    another.seed = 6;
    const ErrorSeries other = errors_of(another);
    double products = 0;
    for (std::size_t i = 0; i < one.up.size(); ++i)
        products += (one.up[i] - mean(one.up)) * (other.up[i] - mean(other.up));
    products /= static_cast<double>(one.up.size()) * deviation(one.up) * deviation(other.up);
    EXPECT_LT(std::abs(products), 0.3);
}

// Each cause by itself: scaled to nothing it is gone, and the others stay what they were.
TEST(ModernProfile, EveryTermCanBeTakenOutByItself) {
    const auto arrivals_with = [](auto&& change) {
        ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
        change(settings);
        Simulation simulation = modern_run(effective(settings), std::make_unique<FixedPoint>(profile_place));
        return simulation.run(profile_start, all_systems());
    };
    const Trace all = arrivals_with([](ModernSettings&) {});
    const Trace without = arrivals_with([](ModernSettings& s) { s.propagation.signal_in_space.enabled = false; });
    ASSERT_EQ(all.arrivals.satellites.size(), without.arrivals.satellites.size());
    for (std::size_t i = 0; i < all.arrivals.satellites.size(); ++i) {
        const Arrival& a = all.arrivals.satellites[i];
        const Arrival& b = without.arrivals.satellites[i];
        EXPECT_NE(a.signal_in_space_error.value(), 0);
        EXPECT_EQ(b.signal_in_space_error.value(), 0);
        EXPECT_EQ(a.iono_delay.value(), b.iono_delay.value());
        EXPECT_EQ(a.tropo_delay.value(), b.tropo_delay.value());
        EXPECT_EQ(a.cn0->value(), b.cn0->value());
    }
}

// Corrections from outside make the measurements as good as the fix type says.
TEST(ModernProfile, CorrectionsFromOutsideScatterLess) {
    struct Regime {
        DifferentialKind kind;
        FixType type;
        double least, most;  // m, 3D rms over an hour
    };
    for (const Regime& r : {Regime{DifferentialKind::sbas, FixType::dgnss, 0.2, 1.3},
                            {DifferentialKind::rtk_float, FixType::rtk_float, 0.05, 0.5},
                            {DifferentialKind::rtk_fixed, FixType::rtk_fixed, 0.002, 0.05}}) {
        ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
        settings.navigation.differential.kind = r.kind;
        Simulation simulation = modern_run(effective(settings), std::make_unique<FixedPoint>(profile_place));
        double squares = 0;
        for (int k = 0; k < 360; ++k) {
            const Trace trace = simulation.run(profile_start + std::chrono::seconds(10 * k), all_systems());
            ASSERT_EQ(trace.epoch.fix.type, r.type);
            const double error = (to_ecef(trace.epoch.fix.position) - trace.truth.position).length().value();
            squares += error * error / 360;
        }
        EXPECT_GT(std::sqrt(squares), r.least) << fix_type_name(r.type);
        EXPECT_LT(std::sqrt(squares), r.most) << fix_type_name(r.type);
    }
}

}  // namespace
}  // namespace skyloop::test
