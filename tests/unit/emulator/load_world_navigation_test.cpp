#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/time/utc_time.hpp"
#include "run/emulator/assembly.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

Scenario with_navigation(const std::filesystem::path& file, std::vector<Constellation> constellations = {}) {
    Scenario scenario;
    scenario.sky.navigation = {file};
    scenario.sky.constellations = std::move(constellations);
    return scenario;
}

std::set<Constellation> systems_of(const NavigationSource& source) {
    std::set<Constellation> systems;
    for (const SatelliteId id : source.satellites())
        systems.insert(id.constellation);
    return systems;
}

TEST(LoadWorldNavigation, SensorModelsUseGpsAndQzssUnlessOthersAreNamed) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    Scenario baseline = with_navigation(nav);
    baseline.model.sensor_model = ErrorModelKind::baseline;
    const auto plain = load_navigation(baseline, {});
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_THAT(systems_of(*plain->source), ElementsAre(Constellation::gps, Constellation::qzss));
    const auto all = load_navigation(with_navigation(nav), {});
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_THAT(systems_of(*all->source), IsSupersetOf({Constellation::gps, Constellation::galileo,
                                                        Constellation::beidou, Constellation::glonass}))
        << "a receiver that measures chooses by itself";
    const auto asked = load_navigation(with_navigation(nav, {Constellation::galileo, Constellation::glonass}), {});
    ASSERT_TRUE(asked);
    EXPECT_THAT(systems_of(*asked->source), ElementsAre(Constellation::galileo, Constellation::glonass));
}

TEST(LoadWorldNavigation, SaysWhatTheDataHolds) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav/brdc0910.09g");
    Scenario baseline = with_navigation(nav);
    baseline.model.sensor_model = ErrorModelKind::baseline;
    const auto refused = load_navigation(baseline, {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                HasSubstr("brdc0910.09g: found records of glonass; expected some of gps, qzss"));
    EXPECT_TRUE(load_navigation(with_navigation(nav, {Constellation::glonass}), {}));
}

TEST(LoadWorldNavigation, ReadsAlmanacs) {
    SKYLOOP_REQUIRE_SHARED(folder, "nav/almanac");
    Scenario scenario = with_navigation(folder / "yuma.txt");
    scenario.run.start = to_gps_time(1024 + 862, 319488.0 + 86400);
    const auto loaded = load_navigation(scenario, {});
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(loaded->warnings.empty());
    EXPECT_EQ(loaded->source->satellites().size(), 31u);
    EXPECT_TRUE(loaded->source->ephemeris({Constellation::gps, 1}, *scenario.run.start));
    const auto wrong = load_navigation(with_navigation(folder / "wrong_sem.txt"), {});
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message, HasSubstr("wrong_sem.txt:9: found '0'"));
}

// Its week is 862 of 1024: 2016 or 2036.
TEST(LoadWorldNavigation, AnAlmanacIsNotOfTheFuture) {
    SKYLOOP_REQUIRE_SHARED(folder, "nav/almanac");
    SKYLOOP_REQUIRE_SHARED(nav, "nav/brdc0910.09g");
    const GpsTime late_2026 = to_gps_time(2447, 0.0);
    const auto alone = load_navigation(with_navigation(folder / "yuma.txt"), late_2026);
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_EQ(alone->start, to_gps_time(1024 + 862, 319488.0));
    Scenario scenario = with_navigation(folder / "yuma.txt");
    scenario.sky.navigation.push_back(nav);
    const auto beside = load_navigation(scenario, to_gps_time(3400, 0.0));
    ASSERT_TRUE(beside);
    EXPECT_EQ(week_and_tow(beside->source->span()->last).week, 1024 + 862 + 1) << "the one that is nearest to 2009";
}

}  // namespace
}  // namespace skyloop::test
