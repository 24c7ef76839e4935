#include "receiver/error_model/fix_builder.hpp"

#include <gtest/gtest.h>

#include "support/model_sky.hpp"

namespace skyloop {
namespace {

// One satellite at 40° with 45 dB-Hz, which every rule below may use unless a test changes it.
struct OneChoice {
    SkyView sky = test::sky_of({{10, 40}});
    Arrivals arrivals = free_space(sky);
    SelectionRule rule{Angle::degrees(5), false, DbHz(5)};
    OneChoice() { arrival().cn0 = DbHz(45); }
    Arrival& arrival() { return arrivals.satellites.front(); }
    [[nodiscard]] SatelliteStatus status() const { return select_satellites(sky, arrivals, rule).front(); }
};

TEST(Selection, UsesAHealthySatelliteThatIsHeard) {
    const OneChoice choice;
    EXPECT_TRUE(choice.status().used);
    EXPECT_EQ(choice.status().cn0, DbHz(45));
    EXPECT_EQ(choice.status().id, choice.sky.satellites.front().id);
}

TEST(Selection, EveryLimitIsInclusive) {
    OneChoice choice;
    choice.sky.satellites.front().elevation = choice.rule.elevation_mask;
    choice.arrival().cn0 = DbHz(5);
    EXPECT_TRUE(choice.status().used);
    choice.sky.satellites.front().elevation = choice.rule.elevation_mask - Angle::degrees(1e-9);
    EXPECT_FALSE(choice.status().used);
}

TEST(Selection, RefusesWeakUnhealthyAndUnheard) {
    OneChoice weak;
    weak.arrival().cn0 = DbHz(4.999999);
    EXPECT_FALSE(weak.status().used);
    EXPECT_TRUE(weak.status().cn0);
    OneChoice unheard;
    unheard.arrival().cn0.reset();
    EXPECT_FALSE(unheard.status().used);
    OneChoice unhealthy;
    unhealthy.sky.satellites.front().healthy = false;
    EXPECT_FALSE(unhealthy.status().used);
    EXPECT_TRUE(unhealthy.status().cn0);
}

TEST(Selection, HiddenSatelliteIsUsedOnlyWhereTheRuleSaysSo) {
    OneChoice choice;
    choice.arrival().paths = 0;
    choice.arrival().cn0.reset();
    EXPECT_FALSE(choice.status().used);
    choice.rule = {.hidden_too = true};
    EXPECT_TRUE(choice.status().used);
}

}  // namespace
}  // namespace skyloop
