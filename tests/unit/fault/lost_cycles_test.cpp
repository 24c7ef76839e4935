#include "run/fault/fault_kind.hpp"

#include <gtest/gtest.h>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

constexpr double wave_m = speed_of_light / carrier_frequency_l1;

Observations corrected_epoch() {
    Observations epoch;
    Observation& o = epoch.signals.emplace_back();
    o.satellite = *parse_satellite("G07");
    o.carrier = Hertz(carrier_frequency_l1);
    o.carrier_phase = 1000;
    o.lock_time = Seconds(100);
    o.correction = DifferentialCorrection{Metres(0), Metres(5)};
    return epoch;
}

GpsTime lost_cycles_time(double s) { return advanced(to_gps_time(2300, 0), Seconds(s)); }

TEST(LostCycles, StayUntilTheSignalIsCountedAnew) {
    for (const bool lost_at_all : {true, false}) {
        LostCycles lost;
        Observations epoch = corrected_epoch();
        lost.slip(epoch.signals[0], lost_cycles_time(0), 7, true);
        epoch = corrected_epoch();
        lost.follow(epoch);
        lost.apply(epoch, lost_cycles_time(10));
        EXPECT_EQ(epoch.signals[0].carrier_phase, 1007);
        EXPECT_EQ(epoch.signals[0].lock_time, Seconds(10));
        epoch = corrected_epoch();
        if (lost_at_all)
            epoch.signals.clear();
        else
            epoch.signals[0].slipped = true;
        lost.follow(epoch);
        EXPECT_TRUE(lost.empty());
    }
}

// A slip that is seen costs the ambiguity, which is found anew with it; one that nobody sees makes fixed ranges wrong
// for as long as it is hidden.
TEST(LostCycles, FallOutOfTheAmbiguityOnceTheyAreKnown) {
    LostCycles lost;
    const auto phase_range = [&](double t, bool hidden) {
        Observations epoch = corrected_epoch();
        lost.follow(epoch);
        if (t == 0) lost.slip(epoch.signals[0], lost_cycles_time(t), 7, false);
        if (hidden) lost.hide(epoch.signals[0]);
        lost.apply(epoch, lost_cycles_time(t));
        const Observation& o = epoch.signals[0];
        EXPECT_EQ(o.lock_time, Seconds(100)) << "it goes on";
        return *o.carrier_phase * wave_m - o.correction->phase->value();
    };
    const double sound = 1000 * wave_m - 5;
    EXPECT_NEAR(phase_range(0, true), sound + 7 * wave_m, 1e-9);
    EXPECT_NEAR(phase_range(1, true), sound + 7 * wave_m, 1e-9);
    EXPECT_NEAR(phase_range(2, false), sound, 1e-9);
    EXPECT_NEAR(phase_range(3, true), sound, 1e-9);
}

}  // namespace
}  // namespace skyloop
