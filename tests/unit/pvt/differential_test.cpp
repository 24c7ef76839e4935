// What a reference station's measurements are worth to a receiver: codes, phases, and who has neither.
#include <gtest/gtest.h>

#include <memory>

#include "base/core/random.hpp"
#include "receiver/pvt/corrections.hpp"
#include "receiver/pvt/navigation_engine.hpp"
#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using test::sample_time;

constexpr double code_noise_m = 0.3, phase_noise_m = 0.003;
const Geodetic base_place = Geodetic::degrees(46.5, 30.7, 60);

// A rover and a base some kilometres away, with noise of their own under one sky and a standard air.
class Pair {
public:
    explicit Pair(double apart_km, std::vector<Constellation> systems = test::four_systems, bool fixes_any = false)
        : sky_(test::synthetic_sky(sample_time, std::move(systems))) {
        parameters_.corrections.ionosphere = IonosphereCorrection::none;
        parameters_.corrections.relative_humidity = 0.5;
        parameters_.filter.kind = FilterKind::none;
        if (fixes_any) parameters_.carrier.least_success = parameters_.carrier.least_gap = 0;
        parameters_.ephemeris_collection = Seconds(0);
        const auto at = LocalFrame(base_place).to_ecef(Position<Enu>(1000 * apart_km, 0, 20));
        rover_ = test::receiver_at(to_geodetic(at), sample_time);
        base_ = test::receiver_at(base_place, sample_time);
        base_.clock_bias_m = -4321;
        settings_.corrections.at_most = CorrectionState::rtk_fixed;
        settings_.elevation_mask = Angle::degrees(10);
        told_ = Position<Ecef>(base_.position);
        engine_.emplace(parameters_, NavigationKnowledge{&sky_});
    }

    // The next second. @param edit changes what was measured, of the rover and of the base
    using Edit = std::function<void(std::vector<Observation>&, std::vector<Observation>&)>;
    Fix next(const Edit& edit = nullptr) {
        ++second_;
        for (test::TrueReceiver* r : {&rover_, &base_})
            r->time = advanced(sample_time, Seconds(second_));
        Observations own = measured(rover_, own_dice_, 7);
        if (base_heard) {
            Observations others = measured(base_, base_dice_, 11);
            if (edit) edit(own.signals, others.signals);
            auto station = std::make_shared<ReferenceStation>();
            station->position = told_;
            station->glonass_biases_known = glonass_biases_known;
            station->epoch = {others.receive_time, std::move(others.signals)};
            settings_.corrections.reference = std::move(station);
        } else if (edit) {
            std::vector<Observation> nothing;
            edit(own.signals, nothing);
        }
        return engine_->solve(own, settings_);
    }
    Fix after(int seconds, const Edit& edit = nullptr) {
        for (int i = 1; i < seconds; ++i)
            next(edit);
        return next(edit);
    }
    [[nodiscard]] Eigen::Vector3d error(const Fix& fix) const {
        return to_ecef(fix.position).vector() - rover_.position;
    }
    [[nodiscard]] const std::optional<RelativePosition>& relative() const { return engine_->relative(); }
    void tell_base_at(const Position<Ecef>& place) { told_ = place; }
    Corrections& corrections() { return settings_.corrections; }

    bool base_heard = true, glonass_biases_known = true;

private:
    Observations measured(const test::TrueReceiver& receiver, RandomStream& dice, int cycles) const {
        const Geodetic place = to_geodetic(Position<Ecef>(receiver.position));
        const RangeCorrections air(parameters_.corrections, {});
        const SiteCorrections site = air.at(place, receiver.time);
        test::MeasureOptions options;
        options.all_signals = true;
        Observations all = test::measure(sky_, receiver, options, [&](SatelliteId, const SkyDirection& d, Hertz) {
            return site.troposphere(d.elevation).value();
        });
        for (Observation& o : all.signals) {
            const double wave = speed_of_light / o.carrier.value();
            o.carrier_phase =
                o.pseudorange->value() / wave + cycles * o.satellite.number + phase_noise_m / wave * dice.normal();
            o.pseudorange = *o.pseudorange + Metres(code_noise_m * dice.normal());
            o.lock_time = Seconds(second_ + 100);
        }
        return all;
    }

    test::SyntheticSky sky_;
    NavigationParameters parameters_;
    test::TrueReceiver rover_, base_;
    ReceiverSettings settings_;
    Position<Ecef> told_;
    std::optional<NavigationEngine> engine_;
    RandomStream own_dice_{1, "rover"}, base_dice_{1, "base"};
    int second_ = 0;
};

void take_phases(std::vector<Observation>& own, std::vector<Observation>&) {
    for (Observation& o : own)
        o.carrier_phase.reset();
}

TEST(Differential, WholeAmbiguitiesMakeItExactToThePhase) {
    for (const double apart_km : {0.001, 1.0, 10.0}) {
        Pair pair(apart_km);
        const Fix fix = pair.after(10);
        EXPECT_EQ(fix.type, FixType::rtk_fixed) << apart_km;
        EXPECT_LT(pair.error(fix).norm(), 0.03) << apart_km;
        EXPECT_LT(fix.horizontal_accuracy, Metres(0.03)) << apart_km;
        EXPECT_GE(pair.relative()->ratio, 3);
        EXPECT_NEAR(pair.relative()->east_m, 1000 * apart_km, 0.05 + 1e-5 * apart_km * apart_km);
        EXPECT_NEAR(pair.relative()->down_m, -20, 0.1 + 0.08 * apart_km * apart_km);
    }
}

TEST(Differential, StandsWhereTheBaseIsToldToStand) {
    Pair pair(5);
    const Displacement<Ecef> off = LocalFrame(base_place).to_ecef(Displacement<Enu>(0, 111, 0));
    pair.tell_base_at(to_ecef(base_place) + off);
    const Fix fix = pair.after(10);
    EXPECT_EQ(fix.type, FixType::rtk_fixed);
    EXPECT_LT((pair.error(fix) - off.vector()).norm(), 0.05);
}

TEST(Differential, CodesAloneMakeItDifferential) {
    Pair pair(5);
    const Fix fix = pair.after(3, take_phases);
    EXPECT_EQ(fix.type, FixType::dgnss);
    EXPECT_LT(pair.error(fix).norm(), 3);
    EXPECT_GT(fix.horizontal_accuracy, Metres(0.1));
    EXPECT_FALSE(pair.relative());
    pair.corrections().at_most = CorrectionState::differential;
    EXPECT_EQ(pair.after(5).type, FixType::dgnss) << "a receiver without RTK";
}

TEST(Differential, SatellitesThatTheBaseDoesNotSeeAreNotUsed) {
    Pair pair(5, {Constellation::gps});
    const auto without = [](std::vector<Observation>&, std::vector<Observation>& others) {
        std::erase_if(others, [&](const Observation& o) { return o.satellite == others.front().satellite; });
    };
    const int all = Pair(5, {Constellation::gps}).next().satellites_used();
    EXPECT_EQ(pair.next(without).satellites_used(), all - 1);
    const auto few = [](std::vector<Observation>&, std::vector<Observation>& others) {
        const SatelliteId third = others[4].satellite;
        std::erase_if(others, [&](const Observation& o) { return o.satellite > third; });
    };
    const Fix alone = pair.next(few);
    EXPECT_EQ(alone.type, FixType::fix_3d) << "of three satellites nothing can be made";
    EXPECT_EQ(alone.satellites_used(), all);
}

TEST(Differential, AgesToFloatToDifferentialAndToNothing) {
    Pair pair(5);
    pair.corrections().fixed_timeout = Seconds(10);
    pair.corrections().float_timeout = Seconds(20);
    pair.corrections().differential_timeout = Seconds(30);
    Metres last = pair.after(10).horizontal_accuracy;
    pair.base_heard = false;
    for (int age = 1; age <= 40; ++age) {
        const Fix fix = pair.next();
        const FixType expected = age <= 10   ? FixType::rtk_fixed
                                 : age <= 20 ? FixType::rtk_float
                                 : age <= 30 ? FixType::dgnss
                                             : FixType::fix_3d;
        ASSERT_EQ(fix.type, expected) << age;
        if (age <= 10) {
            EXPECT_GT(fix.horizontal_accuracy, last);
            EXPECT_LT(pair.error(fix).norm(), 0.1) << age;
        }
        last = fix.horizontal_accuracy;
    }
    pair.base_heard = true;
    EXPECT_EQ(pair.after(10).type, FixType::rtk_fixed);
}

TEST(Differential, MayBeKeptFloating) {
    Pair pair(1);
    pair.corrections().at_most = CorrectionState::rtk_float;
    const Fix fix = pair.after(20);
    EXPECT_EQ(fix.type, FixType::rtk_float);
    EXPECT_LT(pair.error(fix).norm(), 1);
    EXPECT_GT(fix.horizontal_accuracy, Metres(0.03));
}

// Told or not, a slip costs its own ambiguity and no more.
TEST(Differential, SlipsAreFoundAndMended) {
    for (const bool told : {true, false}) {
        Pair pair(2);
        pair.after(20);
        int lost = 0;
        const auto slip = [&](std::vector<Observation>& own, std::vector<Observation>&) {
            *own[2].carrier_phase += lost;
            if (told) own[2].lock_time = Seconds(lost > 0 ? 1 : 1000);
        };
        lost = 1;
        for (int i = 0; i < 5; ++i) {
            const Fix fix = pair.next(slip);
            EXPECT_EQ(fix.type, FixType::rtk_fixed) << i;
            EXPECT_LT(pair.error(fix).norm(), 0.04) << i;
        }
    }
}

// Loops that have just locked are off by metres, and average that away: ambiguities are not led astray by their first
// codes.
TEST(Differential, FirstCodesAfterAnOutageDoNotMislead) {
    Pair pair(1, {Constellation::gps});
    pair.after(20);
    pair.after(10, [](std::vector<Observation>& own, std::vector<Observation>&) { own.clear(); });
    double age = 0;
    const auto young = [&](std::vector<Observation>& own, std::vector<Observation>&) {
        RandomStream off(1, "first codes");
        for (Observation& o : own) {
            o.pseudorange = *o.pseudorange + Metres(6 * off.normal() / std::sqrt(1 + age));
            o.lock_time = Seconds(age);
        }
        ++age;
    };
    EXPECT_EQ(pair.after(10, young).type, FixType::rtk_fixed);
}

// A base whose antenna is moved at once, and does not say so: its phases jump by metres and go on.
TEST(Differential, ABaseThatHasBeenMovedMovesTheRover) {
    Pair pair(2);
    pair.after(20);
    const Displacement<Ecef> off = LocalFrame(base_place).to_ecef(Displacement<Enu>(10, 0, 0));
    pair.tell_base_at(to_ecef(base_place) + off);
    const Fix fix = pair.after(10);
    EXPECT_EQ(fix.type, FixType::rtk_fixed);
    EXPECT_LT((pair.error(fix) - off.vector()).norm(), 0.05);
}

TEST(Differential, WithoutTheBiasesOfGlonassItsAmbiguitiesFloat) {
    constexpr bool any = true;  // GLONASS alone is seldom sure
    Pair pair(1, {Constellation::glonass}, any);
    EXPECT_EQ(pair.after(60).type, FixType::rtk_fixed);
    Pair without(1, {Constellation::glonass}, any);
    without.glonass_biases_known = false;
    EXPECT_EQ(without.after(60).type, FixType::rtk_float);
}

}  // namespace
}  // namespace skyloop
