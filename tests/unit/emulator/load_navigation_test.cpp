// Broadcast orbits from files and from nowhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "base/time/utc_time.hpp"
#include "run/emulator/navigation_files.hpp"
#include "support/run_parts.hpp"
#include "unit/rinex/navigation_text.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::emulator_scenario;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const GpsTime data_day = to_gps_time(2304, 2 * 86400);  // 2024-03-05, GPST
const GpsTime wall_now = to_gps_time(2400, 3 * 3600.0);

// One record as RINEX 3 writes it.
std::string rinex_record(const KeplerEphemeris& e) {
    const UtcTime t = gps_calendar(e.toc);
    const auto line = [](std::initializer_list<double> values) {
        std::string text(4, ' ');
        for (const double v : values)
            text += test::field(v);
        return text + "\n";
    };
    const WeekAndTow toe = week_and_tow(e.toe);
    return fmt::format("{} {:04} {:02} {:02} {:02} {:02} {:02}", to_string(e.satellite), t.year, t.month, t.day, t.hour,
                       t.minute, t.second) +
           test::field(e.af0) + test::field(e.af1) + test::field(e.af2) + "\n" +
           line({double(e.iode), e.crs, e.delta_n, e.m0}) + line({e.cuc, e.e, e.cus, e.sqrt_a}) +
           line({toe.tow_seconds(), e.cic, e.omega0, e.cis}) + line({e.i0, e.crc, e.omega, e.omega_dot}) +
           line({e.idot, 1, double(toe.week), 0}) + line({2.4, double(e.health), e.tgd, double(e.iodc)}) +
           line({toe.tow_seconds() - 3600, 4});
}

constexpr const char* baseline = "[model]\nname = \"baseline\"\n";

// Records of the nominal constellation at 02:00 and 04:00 of data_day; satellites 30 and 31 as QZSS J01 and J02.
std::string nominal_records() {
    std::string text = test::header_v3("3.04");
    for (const auto hour : {2h, 4h})
        for (const SatelliteId satellite : NominalConstellation().satellites()) {
            KeplerEphemeris record = NominalConstellation().record(satellite, data_day + hour).value();
            if (satellite.number >= 30) record.satellite = {Constellation::qzss, satellite.number - 29};
            text += rinex_record(record);
        }
    return text;
}

class LoadNavigation : public testing::Test {
protected:
    LoadNavigation() { std::ofstream(folder_ / "two.rnx") << nominal_records(); }
    [[nodiscard]] Scenario scenario(const std::string& sky, const std::string& rest = "") const {
        return emulator_scenario("[sky]\nnavigation = \"" + (folder_ / "two.rnx").string() + "\"\n" + sky + "\n" +
                                 rest);
    }
    static LoadedNavigation load(const Scenario& scenario) {
        auto loaded = load_navigation(scenario, wall_now);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? std::move(*loaded) : LoadedNavigation{std::make_unique<NominalConstellation>(), {}, {}};
    }
    // The time of day of the record that serves G01 at 03:30.
    static Nanoseconds record_at_half_past_three(const Scenario& scenario) {
        const auto record = load(scenario).source->ephemeris({Constellation::gps, 1}, data_day + 3h + 30min);
        return record ? toe_of(*record) - data_day : Nanoseconds(-1);
    }

    TemporaryFolder folder_;
};

TEST_F(LoadNavigation, WithoutAFileTheNominalConstellationServesFromNow) {
    const LoadedNavigation loaded = load(emulator_scenario(""));
    EXPECT_THAT(loaded.source->satellites(), SizeIs(146));
    EXPECT_EQ(loaded.start, wall_now);
    EXPECT_THAT(loaded.warnings, IsEmpty());
    const GpsTime asked = load(emulator_scenario("[run]\nstart = 2024-03-05T00:00:00Z")).start;
    EXPECT_EQ(asked, data_day + 18s);
}

TEST_F(LoadNavigation, TheNominalSkyHasTheSystemsThatAreAskedFor) {
    const auto satellites = [](const std::string& text) {
        return load_navigation(emulator_scenario(text), wall_now).value().source->satellites();
    };
    EXPECT_THAT(satellites("[sky]\nconstellations = [\"galileo\"]"), SizeIs(24));
    // The article's reference system is GPS.
    EXPECT_THAT(satellites("[model]\nname = \"baseline\""), SizeIs(31));
    EXPECT_THAT(satellites("[model]\nname = \"baseline\"\n[sky]\nconstellations = [\"gps\", \"glonass\"]"), SizeIs(55));
    const auto refused = [](const std::string& sky) {
        const auto loaded = load_navigation(emulator_scenario("[sky]\n" + sky), wall_now);
        return loaded ? "accepted" : loaded.error().message;
    };
    EXPECT_THAT(refused("rebase_navigation = true"), HasSubstr("there is none"));
}

TEST_F(LoadNavigation, AMissingOrBrokenFileIsNamed) {
    const auto missing = load_navigation(emulator_scenario("[sky]\nnavigation = \"none.rnx\""), wall_now);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_THAT(missing.error().message, HasSubstr("none.rnx"));
    std::ofstream(folder_ / "two.rnx") << "no navigation file\n";
    const auto broken = load_navigation(scenario(""), wall_now);
    ASSERT_FALSE(broken);
    EXPECT_EQ(broken.error().code, ErrorCode::input);
    EXPECT_THAT(broken.error().message, HasSubstr("two.rnx:1"));
}

TEST_F(LoadNavigation, ARunBeginsWithTheDataUnlessToldOtherwise) {
    const LoadedNavigation loaded = load(scenario("", baseline));
    EXPECT_EQ(loaded.start, data_day + 2h);
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_EQ(loaded.source->description(), "two.rnx");
    EXPECT_EQ(load(scenario("")).start, data_day + 2h) << "though the nearest record serves before its time, too";
    EXPECT_EQ(load(scenario("", "[run]\nstart = \"now\"")).start, wall_now);
}

TEST_F(LoadNavigation, TheBaselineLooksBackAndTheOthersLookNear) {
    EXPECT_EQ(record_at_half_past_three(scenario("", baseline)), 2h);
    for (const char* model : {"modern", "ideal", "constant-sigma", "satellite-count", "whole-path", "refraction"})
        EXPECT_EQ(record_at_half_past_three(scenario("", std::string("[model]\nname = \"") + model + "\"")), 4h)
            << model;
    EXPECT_EQ(record_at_half_past_three(scenario("ephemeris_rule = \"nearest\"")), 4h);
    EXPECT_EQ(record_at_half_past_three(scenario("ephemeris_rule = \"forward\"", "[model]\nname = \"ideal\"")), 2h);
    EXPECT_EQ(record_at_half_past_three(scenario("ephemeris_validity_s = 3600", baseline)), -1ns)
        << "too old by half an hour";
}

TEST_F(LoadNavigation, KeepsTheWantedConstellations) {
    EXPECT_THAT(load(scenario("")).source->satellites(), SizeIs(31));
    EXPECT_THAT(load(scenario("constellations = [\"gps\"]")).source->satellites(), SizeIs(29));
    const auto qzss = load(scenario("constellations = [\"qzss\"]")).source->satellites();
    ASSERT_THAT(qzss, SizeIs(2));
    EXPECT_EQ(to_string(qzss[0]), "J01");
    const auto none = load_navigation(scenario("constellations = [\"galileo\"]"), wall_now);
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, HasSubstr("two.rnx: found records of gps, qzss; expected some of galileo"));
}

TEST_F(LoadNavigation, WarnsOnceOfARunOutsideItsData) {
    const auto warnings = [&](const std::string& run) {
        return load(scenario("", baseline + ("[run]\n" + run))).warnings;
    };
    const auto outside = warnings("start = 2024-03-07T00:00:00Z\nduration_s = 86400");
    ASSERT_THAT(outside, SizeIs(1));
    EXPECT_THAT(outside[0], HasSubstr("the run starts outside the navigation data, which spans 2024-03-05T01:59:42Z to "
                                      "2024-03-05T05:59:42Z"));
    const auto outlasts = warnings("duration_s = 20000");
    ASSERT_THAT(outlasts, SizeIs(1));
    EXPECT_THAT(outlasts[0], HasSubstr("the run outlasts the navigation data"));
    EXPECT_THAT(warnings("duration_s = 14400"), IsEmpty());
}

TEST_F(LoadNavigation, BeginsWhereFourSatellitesFirstHaveOrbits) {
    KeplerEphemeris early = NominalConstellation().record({Constellation::gps, 1}, data_day - 8h).value();
    early.satellite.number = 32;
    std::ofstream(folder_ / "early.rnx") << nominal_records() << rinex_record(early);
    const auto loaded = [&](const std::string& more) {
        return load(emulator_scenario("[sky]\nnavigation = \"" + (folder_ / "early.rnx").string() + "\"\n" + more));
    };
    const LoadedNavigation first = loaded("");
    EXPECT_EQ(first.start, data_day) << "two hours before the records of 02:00, as long as they serve";
    EXPECT_THAT(first.warnings, IsEmpty());
    EXPECT_EQ(loaded(baseline).start, data_day + 2h) << "by the rule that looks back";
    EXPECT_EQ(loaded("[run]\nstart = 2024-03-04T16:00:00Z\n").start, data_day - 8h + 18s);
    std::vector<std::string> of_files;
    Scenario no_run;
    no_run.sky.navigation = {folder_ / "early.rnx"};
    const auto data = read_navigation_files(no_run, data_day, of_files);
    ASSERT_TRUE(data);
    EXPECT_EQ(data->first_epoch(), data_day - 8h);
    EXPECT_THAT(of_files, IsEmpty());
}

// Four of QZSS that come before all others are enough for a receiver that tracks them.
TEST_F(LoadNavigation, BeginsWithSystemsThatItsReceiversSolveWith) {
    std::string text = nominal_records();
    for (const int number : {3, 4, 5, 6}) {
        KeplerEphemeris early = NominalConstellation().record({Constellation::gps, number}, data_day - 8h).value();
        early.satellite = {Constellation::qzss, number};
        text += rinex_record(early);
    }
    std::ofstream(folder_ / "early.rnx") << text;
    const auto start = [&](const std::string& more, const DataFolders& folders = {}) {
        const auto loaded = load_navigation(
            emulator_scenario("[sky]\nnavigation = \"" + (folder_ / "early.rnx").string() + "\"\n" + more), wall_now,
            folders);
        return loaded ? loaded->start : GpsTime{};
    };
    EXPECT_EQ(start(""), data_day - 8h);
    EXPECT_EQ(start("[[receiver]]\nconstellations = [\"gps\", \"qzss\"]\n"), data_day - 8h);
    EXPECT_EQ(start("[[receiver]]\nconstellations = [\"gps\"]\n"), data_day);
    EXPECT_EQ(start("[[receiver]]\nconstellations = [\"galileo\"]\n"), data_day - 8h) << "four never have orbits";
    EXPECT_EQ(start("[[receiver]]\nboard = \"mtk3339\"\n", test::emulator_data()), data_day);
}

TEST_F(LoadNavigation, RebasingMovesTheDataByWholeDays) {
    const LoadedNavigation moved =
        load(scenario("rebase_navigation = true", std::string(baseline) + "[run]\nstart = 2026-07-08T03:00:00Z"));
    EXPECT_THAT(moved.warnings, IsEmpty());
    const auto record = moved.source->ephemeris({Constellation::gps, 1}, moved.start);
    ASSERT_TRUE(record);
    EXPECT_EQ((toe_of(*record) - data_day) % 24h, 2h);
    EXPECT_EQ(load(scenario("rebase_navigation = true", "[run]\nstart = \"now\"")).start, wall_now);
    const auto no_data =
        load_navigation(scenario("rebase_navigation = true", "[run]\nstart = 2026-07-08T13:00:00Z"), wall_now);
    EXPECT_FALSE(no_data) << "there is nothing for this time of day";
}

TEST_F(LoadNavigation, RefusesARunThatOutlastsItsClock) {
    const auto nominal =
        load_navigation(emulator_scenario("[run]\nstart = 2199-01-01T00:00:00Z\nduration_s = 3e9"), wall_now);
    ASSERT_FALSE(nominal);
    EXPECT_EQ(nominal.error().code, ErrorCode::usage);
    EXPECT_EQ(nominal.error().message,
              "a run of 3e+09 s from 2199-01-01T00:00:00Z ends after 2269; expected a shorter one");
    EXPECT_FALSE(load_navigation(scenario("", "[run]\nstart = 2199-01-01T00:00:00Z\nduration_s = 3e9"), wall_now));
}

}  // namespace
}  // namespace skyloop
