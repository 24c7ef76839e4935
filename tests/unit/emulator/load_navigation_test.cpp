// Broadcast orbits from files and from nowhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "base/time/utc_time.hpp"
#include "run/emulator/navigation_files.hpp"
#include "support/run_parts.hpp"
#include "unit/rinex/navigation_text.hpp"
#include "unit/transport/temporary_folder.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::emulator_scenario;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

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
        return loaded ? std::move(*loaded) : LoadedNavigation{std::make_unique<NominalConstellation>()};
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

// Those of the nominal constellation above ten degrees.
std::vector<int> visible_satellites(const Geodetic& place, GpsTime time) {
    std::vector<int> numbers;
    for (const SatelliteInView& s : observe_sky({time, to_ecef(place), {}, place}, NominalConstellation()).satellites)
        if (s.elevation > Angle::degrees(10)) numbers.push_back(s.id.number);
    return numbers;
}

// Four of QZSS that come before all others are enough for a receiver that tracks them.
TEST_F(LoadNavigation, BeginsWithSystemsThatItsReceiversSolveWith) {
    std::string text = nominal_records();
    const std::vector<int> visible = visible_satellites(FixedSettings().at, data_day - 8h);
    ASSERT_GE(visible.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        KeplerEphemeris early = NominalConstellation().record({Constellation::gps, visible[i]}, data_day - 8h).value();
        early.satellite = {Constellation::qzss, static_cast<int>(i) + 3};
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

// Satellites below the horizon are no beginning, wherever their orbits are known.
TEST_F(LoadNavigation, BeginsWhereItsSatellitesStandAboveTheMask) {
    const std::vector<int> hidden = visible_satellites(Geodetic::degrees(-46.5, -149.3, 0), data_day - 8h);
    ASSERT_GE(hidden.size(), 4u);
    std::string text = nominal_records();
    for (const int number : hidden)
        text += rinex_record(NominalConstellation().record({Constellation::gps, number}, data_day - 8h).value());
    std::ofstream(folder_ / "hidden.rnx") << text;
    const std::string sky = "[sky]\nnavigation = \"" + (folder_ / "hidden.rnx").string() + "\"\n";
    const auto place = [](double lat, double lon) {
        return fmt::format("[trajectory]\nkind = \"fixed\"\nat = [{}, {}, 0]\n", lat, lon);
    };
    EXPECT_GT(load(emulator_scenario(sky)).start, data_day - 8h);
    EXPECT_LE(load(emulator_scenario(sky)).start, data_day);
    EXPECT_EQ(load(emulator_scenario(sky + place(-46.5, -149.3))).start, data_day - 8h) << "on the other side";
    const LoadedNavigation never = load(emulator_scenario(sky + "elevation_mask_deg = 89\n"));
    EXPECT_EQ(never.start, data_day - 8h) << "as if all stood above the mask";
    ASSERT_THAT(never.warnings, SizeIs(1));
    EXPECT_THAT(never.warnings[0],
                StartsWith("no fix is to be expected: too few satellites of gps, galileo, beidou, qzss, glonass, navic "
                           "with orbits stand above 89 degrees at 46.4774, 30.7326 at any time of the navigation data; "
                           "--at moves the antenna"));
    const LoadedNavigation told = load(emulator_scenario(sky + "[run]\nstart = 2024-03-04T16:00:00Z\n"));
    ASSERT_THAT(told.warnings, SizeIs(1));
    EXPECT_THAT(told.warnings[0], StartsWith("no fix is to be expected at the start, 2024-03-04T16:00:00Z: too few "));
    EXPECT_THAT(told.warnings[0], HasSubstr("30.7326 then; --at moves the antenna, --start moves the run"));
    // The first row of a track counts as a place does.
    std::ofstream(folder_ / "track.csv") << "time_s,lat_deg,lon_deg,height_m\n0,-46.5,-149.3,10\n10,-46.5,-149.3,10\n";
    const std::string track = "[trajectory]\nkind = \"file\"\npath = \"" + (folder_ / "track.csv").string() + "\"\n";
    EXPECT_EQ(load(emulator_scenario(sky + track)).start, data_day - 8h);
}

TEST_F(LoadNavigation, TellsThatTooFewSatellitesHaveOrbitsAtItsStart) {
    const LoadedNavigation loaded = load(scenario("constellations = [\"qzss\"]", "[run]\nduration_s = 60"));
    ASSERT_THAT(loaded.warnings, SizeIs(1));
    EXPECT_THAT(loaded.warnings[0], StartsWith("no fix is to be expected: too few satellites of gps"));
    EXPECT_THAT(loaded.warnings[0], HasSubstr("have orbits at any time of the navigation data"));
    EXPECT_EQ(loaded.start, data_day + 2h);
}

TEST_F(LoadNavigation, TellsTheLastOrbitsOfARunThatOutlastsThem) {
    KeplerEphemeris late = NominalConstellation().record({Constellation::gps, 1}, data_day + 20h).value();
    std::ofstream(folder_ / "late.rnx") << nominal_records() << rinex_record(late);
    const auto loaded = load(emulator_scenario("[sky]\nnavigation = \"" + (folder_ / "late.rnx").string() +
                                               "\"\n[run]\nduration_s = 36000\n"));
    ASSERT_THAT(loaded.warnings, SizeIs(1));
    EXPECT_THAT(loaded.warnings[0], HasSubstr("the run outlasts the navigation data: after 2024-03-05T05:59:42Z, too "
                                              "few satellites of gps"));
}

TEST_F(LoadNavigation, TheNominalSkyStandsInForAnEmptyCache) {
    const auto automatic = [&](const std::string& more, const DataFolders& folders) {
        return load_navigation(emulator_scenario("[sky]\nnavigation = \"auto\"\n" + more), wall_now, folders);
    };
    const auto nominal = automatic("", {{}, folder_ / "cache"});
    ASSERT_TRUE(nominal);
    EXPECT_THAT(nominal->source->satellites(), SizeIs(146));
    EXPECT_EQ(nominal->start, wall_now);
    EXPECT_THAT(nominal->files, IsEmpty());
    ASSERT_THAT(nominal->warnings, SizeIs(1));
    EXPECT_THAT(nominal->warnings[0], HasSubstr("the sky is the nominal one: "));
    EXPECT_THAT(nominal->warnings[0], HasSubstr("skyloop fetch-nav --date 2026-01-04 gets it"));
    EXPECT_THAT(automatic("", {}).value().warnings[0], HasSubstr("no cache of navigation files"));
    std::filesystem::create_directories(folder_ / "cache/navigation");
    std::filesystem::copy_file(folder_ / "two.rnx", folder_ / "cache/navigation/BRDC_20240650000_01D_MN.rnx.gz");
    const auto cached = automatic("[run]\nstart = 2024-03-05T03:00:00Z\n", {{}, folder_ / "cache"});
    ASSERT_TRUE(cached);
    EXPECT_THAT(cached->files, SizeIs(1));
    EXPECT_THAT(cached->notes, testing::ElementsAre("navigation: BRDC_20240650000_01D_MN.rnx.gz, of the cache"));
    const auto late = automatic("[run]\nstart = 2024-03-05T16:00:00Z\n", {{}, folder_ / "cache"});
    EXPECT_THAT(late.value().warnings[0], HasSubstr("ends before the start of the run"));
    EXPECT_THAT(late.value().source->satellites(), SizeIs(146));
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
