// What the corrections of a base station are worth: code, phase, and who has neither, as it is seen in fixes.
#include <gtest/gtest.h>

#include "receiver/pvt/navigation_engine.hpp"
#include "support/flat_geoid.hpp"
#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using test::sample_time;
using test::SyntheticSky;
using test::TrueReceiver;

constexpr double code_correction_m = 31, phase_correction_m = -17;

// Each satellite's delays, which the corrections tell, and errors of the code, which nobody does.
double code_error_m(const Observation& o) { return 3.0 * (o.satellite.number % 5 - 2); }

Observations corrected_observations(const SyntheticSky& sky, const TrueReceiver& receiver) {
    Observations all = test::measure(sky, receiver);
    for (Observation& o : all.signals) {
        const double range = o.pseudorange->value(), each = o.satellite.number;
        o.correction = DifferentialCorrection{};
        o.correction->code = Metres(code_correction_m + each);
        o.correction->phase = Metres(phase_correction_m - each);
        o.carrier_phase = (range + phase_correction_m - each) * o.carrier.value() / speed_of_light;
        o.pseudorange = Metres(range + code_correction_m + each + code_error_m(o));
        o.lock_time = Seconds(10);
    }
    return all;
}

struct Outcome {
    FixType type;
    double error_m;
    int used;
};

Outcome outcome(const SyntheticSky& sky, const Observations& observations, const TrueReceiver& receiver,
                CorrectionState state) {
    NavigationParameters parameters;
    parameters.corrections.ionosphere = IonosphereCorrection::none;
    parameters.corrections.troposphere = TroposphereCorrection::none;
    parameters.filter.kind = FilterKind::none;
    ReceiverSettings settings;
    settings.corrections = state;
    const Fix fix = NavigationEngine(parameters, {&sky}).solve(observations, settings);
    return {fix.type, (to_ecef(fix.position).vector() - receiver.position).norm(), fix.satellites_used()};
}

class Differential : public testing::Test {
protected:
    const SyntheticSky sky_ = test::synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver_ = test::receiver_at(Geodetic::degrees(46.5, 30.7, 60), sample_time);
    Observations observations_ = corrected_observations(sky_, receiver_);
    [[nodiscard]] Outcome with(CorrectionState state) const { return outcome(sky_, observations_, receiver_, state); }
};

TEST_F(Differential, FixedAmbiguitiesAreAsGoodAsThePhase) {
    const Outcome fixed = with(CorrectionState::rtk_fixed);
    EXPECT_EQ(fixed.type, FixType::rtk_fixed);
    EXPECT_LT(fixed.error_m, 1e-5);
}

TEST_F(Differential, FloatOnesLeaveAShareOfTheCodesError) {
    const Outcome code = with(CorrectionState::differential), part = with(CorrectionState::rtk_float);
    EXPECT_EQ(code.type, FixType::dgnss);
    EXPECT_EQ(part.type, FixType::rtk_float);
    EXPECT_GT(code.error_m, 1);
    EXPECT_NEAR(part.error_m, 0.15 * code.error_m, 1e-3 * code.error_m);  // linear at these distances
}

TEST_F(Differential, WithoutCodeErrorsTheCodeAloneIsExact) {
    for (Observation& o : observations_.signals)
        o.pseudorange = *o.pseudorange - Metres(code_error_m(o));
    EXPECT_LT(with(CorrectionState::differential).error_m, 1e-5);
}

TEST_F(Differential, WhoHasNoCorrectionOrNoPhaseDoesNotServe) {
    const int all = with(CorrectionState::rtk_fixed).used;
    ASSERT_GE(all, 8);
    observations_.signals[0].correction.reset();
    observations_.signals[1].half_cycle_resolved = false;
    observations_.signals[2].lock_time = Seconds(2);
    const Outcome fixed = with(CorrectionState::rtk_fixed), code = with(CorrectionState::differential);
    EXPECT_EQ(fixed.used, all - 3);
    EXPECT_LT(fixed.error_m, 1e-5);
    EXPECT_EQ(code.used, all - 1) << "the code serves without a phase";
}

TEST_F(Differential, FewerThanFivePhasesAreNone) {
    for (std::size_t i = 4; i < observations_.signals.size(); ++i)
        observations_.signals[i].correction->phase.reset();
    EXPECT_EQ(with(CorrectionState::rtk_fixed).type, FixType::dgnss);
    observations_.signals[4].correction->phase = Metres(0);
    EXPECT_EQ(with(CorrectionState::rtk_fixed).type, FixType::rtk_fixed);
}

}  // namespace
}  // namespace skyloop
