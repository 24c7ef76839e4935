// How good the solutions are that a receiver makes with the corrections of a base station.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/modern_run.hpp"

namespace skyloop {
namespace {

struct CorrectedErrors {
    double horizontal_rms = 0, vertical_rms = 0, horizontal_95 = 0;
    int of_type = 0, epochs = 0;
};

double rms_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values)
        sum += v * v;
    return std::sqrt(sum / static_cast<double>(values.size()));
}

CorrectedErrors errors_with(CorrectionState state, FixType expected, std::uint64_t seed = 3) {
    const ModernSettings modern = effective(ModernSettings::of(ModernPreset::consumer));
    const Geodetic place{Angle::degrees(47.4), Angle::degrees(8.5), EllipsoidalHeight{Metres(450)}};
    Simulation run = test::modern_run(modern, std::make_unique<FixedPoint>(place), seed);
    ReceiverSettings settings = test::all_systems();
    test::ErrorSeries errors;
    CorrectedErrors result;
    // Between two changes of the GLONASS records, whose orbits lie tens of metres apart in this sky: there counts
    // break.
    const GpsTime start = to_gps_time(2300, 200700.0);
    for (int i = 0; i < 900; ++i) {
        settings.corrections = i < 20 ? CorrectionState::none : state;
        const Trace trace = run.run(start + std::chrono::seconds(i), settings);
        if (i < 25) continue;
        errors.add(trace);
        ++result.epochs;
        result.of_type += trace.epoch.fix.type == expected ? 1 : 0;
    }
    result.horizontal_rms = rms_of(errors.horizontal);
    result.vertical_rms = rms_of(errors.up);
    std::sort(errors.horizontal.begin(), errors.horizontal.end());
    result.horizontal_95 = errors.horizontal[errors.horizontal.size() * 95 / 100];
    return result;
}

TEST(CorrectedSolution, DifferentialIsBetterThanAMetre) {
    const CorrectedErrors alone = errors_with(CorrectionState::none, FixType::fix_3d);
    const CorrectedErrors corrected = errors_with(CorrectionState::differential, FixType::dgnss);
    EXPECT_EQ(corrected.of_type, corrected.epochs);
    EXPECT_LT(corrected.horizontal_95, 1.0);
    EXPECT_GT(corrected.horizontal_rms, 0.05);
    EXPECT_LT(corrected.vertical_rms, alone.vertical_rms);
    EXPECT_EQ(alone.of_type, alone.epochs);
}

TEST(CorrectedSolution, FloatIsGoodToDecimetres) {
    const CorrectedErrors corrected = errors_with(CorrectionState::rtk_float, FixType::rtk_float);
    EXPECT_EQ(corrected.of_type, corrected.epochs);
    EXPECT_GT(corrected.horizontal_rms, 0.03);
    EXPECT_LT(corrected.horizontal_95, 0.6);
}

TEST(CorrectedSolution, FixedIsGoodToCentimetres) {
    const CorrectedErrors corrected = errors_with(CorrectionState::rtk_fixed, FixType::rtk_fixed);
    EXPECT_EQ(corrected.of_type, corrected.epochs);
    EXPECT_GT(corrected.horizontal_rms, 0.001);
    EXPECT_LT(corrected.horizontal_95, 0.02);
    EXPECT_LT(corrected.vertical_rms, 0.03);
}

// A receiver that was corrected begins anew without: nothing of the corrections stays.
TEST(CorrectedSolution, EndsWithTheCorrections) {
    const ModernSettings modern = effective(ModernSettings::of(ModernPreset::consumer));
    const Geodetic place{Angle::degrees(47.4), Angle::degrees(8.5), EllipsoidalHeight{Metres(450)}};
    Simulation run = test::modern_run(modern, std::make_unique<FixedPoint>(place), 5);
    ReceiverSettings settings = test::all_systems();
    for (int i = 0; i < 60; ++i) {
        settings.corrections = i >= 20 && i < 40 ? CorrectionState::rtk_fixed : CorrectionState::none;
        const Trace trace = run.run(to_gps_time(2300, 1000.0 + i), settings);
        for (const Observation& o : trace.epoch.observations.signals)
            EXPECT_EQ(o.correction.has_value(), settings.corrections != CorrectionState::none);
        const FixType expected = i >= 20 && i < 40 ? FixType::rtk_fixed : FixType::fix_3d;
        EXPECT_EQ(trace.epoch.fix.type, expected) << i;
        if (expected == FixType::rtk_fixed)
            EXPECT_LT(trace.epoch.fix.horizontal_accuracy, Metres(0.03));
        else
            EXPECT_GT(trace.epoch.fix.horizontal_accuracy, Metres(0.1));
    }
}

}  // namespace
}  // namespace skyloop
