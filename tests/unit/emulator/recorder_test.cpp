// What a run leaves behind: tables whose columns hold what their header says.
#include "run/emulator/recorder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/geo/local_frame.hpp"
#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::cells_of;
using test::content_of;
using test::lines_of;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::SizeIs;

// One satellite, and a fix 1 m east, 2 m north and 3 m above of where the antenna is.
Trace recorded_trace() {
    Trace trace;
    trace.truth.time = to_gps_time(2304, 172818.25);
    trace.truth.geodetic = Geodetic::degrees(46.5, 30.75, 77);
    trace.truth.position = to_ecef(trace.truth.geodetic);
    SatelliteInView satellite;
    satellite.id = {Constellation::gps, 5};
    satellite.azimuth = Angle::degrees(123.5);
    satellite.elevation = Angle::degrees(45.25);
    satellite.range = Metres(21'000'000);
    satellite.clock_bias = Seconds(1e-6);
    satellite.signals.push_back({Signal::l1, Hertz(carrier_frequency_l1), Seconds(1e-8)});
    trace.sky.satellites = {satellite, satellite};
    trace.sky.satellites[1].id.number = 7;
    Arrival arrival;
    arrival.id = satellite.id;
    arrival.excess_path = Metres(1);
    arrival.iono_delay = Metres(4.5);
    arrival.tropo_delay = Metres(2.5);
    arrival.gas_loss = Decibels(0.25);
    arrival.cloud_loss = Decibels(0.125);
    arrival.rain_loss = Decibels(0.0625);
    arrival.cn0 = DbHz(41.25);
    arrival.free_space_loss = Decibels(182.5);
    arrival.iono_loss = Decibels(0.375);
    arrival.reflection_loss = Decibels(3.0103);
    arrival.received_power = DecibelWatts(-159.5);
    trace.arrivals.satellites = {arrival, arrival};
    trace.arrivals.satellites[1].paths = 0;
    trace.arrivals.satellites[1].line_of_sight = false;
    trace.arrivals.satellites[1].cn0.reset();
    Fix& fix = trace.epoch.fix;
    fix.time = trace.truth.time;
    fix.type = FixType::fix_3d;
    fix.position = to_geodetic(LocalFrame(trace.truth.geodetic).to_ecef(Position<Enu>(1, 2, 3)));
    fix.velocity = {0.5, -0.25, 0.125};
    fix.speed = MetresPerSecond(0.559);
    fix.course = Angle::degrees(333.435);
    fix.dop = {1.9, 1.7, 0.9, 1.4, 0.8};
    fix.horizontal_accuracy = Metres(2.25);
    fix.vertical_accuracy = Metres(3.5);
    fix.satellites = {{satellite.id, satellite.azimuth, satellite.elevation, DbHz(41.25), true},
                      {{Constellation::gps, 7}, satellite.azimuth, satellite.elevation, std::nullopt, false}};
    return trace;
}

std::map<std::string, std::string> row_of(const std::string& table, std::size_t row) {
    const auto lines = lines_of(table);
    const auto names = cells_of(lines.at(0));
    const auto cells = cells_of(lines.at(row));
    EXPECT_EQ(names.size(), cells.size());
    std::map<std::string, std::string> result;
    for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i)
        result[names[i]] = cells[i];
    return result;
}

// fixes.csv and satellites.csv of these epochs.
std::pair<std::string, std::string> tables_of(const std::vector<Trace>& traces) {
    const TemporaryFolder folder;
    {
        auto recorder = test::recorder_in(folder / "run");
        EXPECT_TRUE(recorder);
        for (const Trace& trace : traces)
            recorder->record(trace, NominalConstellation());
    }
    return {content_of(folder / "run/fixes.csv"), content_of(folder / "run/satellites.csv")};
}

TEST(Recorder, AFixHasAllItsColumns) {
    auto row = row_of(tables_of({recorded_trace()}).first, 1);
    EXPECT_EQ(row["time_utc"], "2024-03-05T00:00:00.250Z");
    EXPECT_EQ(row["gps_week"], "2304");
    EXPECT_EQ(row["tow_s"], "172818.250");
    EXPECT_EQ(row["true_lat_deg"], "46.500000000");
    EXPECT_EQ(row["true_lon_deg"], "30.750000000");
    EXPECT_EQ(row["true_height_m"], "77.0000");
    EXPECT_EQ(row["east_error_m"], "1.0000");
    EXPECT_EQ(row["north_error_m"], "2.0000");
    EXPECT_EQ(row["up_error_m"], "3.0000");
    EXPECT_EQ(row["height_m"], "80.0000");
    EXPECT_EQ(row["lat_deg"].substr(0, 8), "46.50001");
    EXPECT_EQ(row["vel_north_mps"], "0.5000");
    EXPECT_EQ(row["vel_east_mps"], "-0.2500");
    EXPECT_EQ(row["vel_down_mps"], "0.1250");
    EXPECT_EQ(row["speed_mps"], "0.5590");
    EXPECT_EQ(row["course_deg"], "333.4350");
    EXPECT_EQ(row["fix_type"], "3d");
    EXPECT_EQ(row["satellites_used"], "1");
    EXPECT_EQ(row["satellites_visible"], "2");
    EXPECT_EQ(row["gdop"], "1.900");
    EXPECT_EQ(row["tdop"], "0.800");
    EXPECT_EQ(row["h_acc_m"], "2.250");
    EXPECT_EQ(row["v_acc_m"], "3.500");
    EXPECT_EQ(row["sigma_uere_m"], "");
    EXPECT_THAT(row, SizeIs(33));
}

TEST(Recorder, AFixOfASensorModelHasTheScaleOfItsError) {
    Trace trace = recorded_trace();
    trace.error_scale = {Metres(3.25), Metres(5.525)};
    auto row = row_of(tables_of({trace}).first, 1);
    EXPECT_EQ(row["sigma_uere_m"], "3.2500");
    EXPECT_EQ(row["error_scale_m"], "5.5250");
    trace.epoch.fix.type = FixType::none;
    row = row_of(tables_of({trace}).first, 1);
    EXPECT_EQ(row["sigma_uere_m"], "") << "of a receiver that is stopped";
    EXPECT_EQ(row["error_scale_m"], "");
}

TEST(Recorder, WhatRoundsToNothingHasNoSign) {
    Trace trace = recorded_trace();
    trace.epoch.fix.velocity = {-4e-5, -6e-5, -0.0};
    auto row = row_of(tables_of({trace}).first, 1);
    EXPECT_EQ(row["vel_north_mps"], "0.0000");
    EXPECT_EQ(row["vel_east_mps"], "-0.0001");
    EXPECT_EQ(row["vel_down_mps"], "0.0000");
}

TEST(Recorder, DopsThatNobodyKnowsAreEmpty) {
    Trace trace = recorded_trace();
    Dop& dop = trace.epoch.fix.dop;
    dop.gdop = dop.pdop = dop.vdop = std::numeric_limits<double>::quiet_NaN();
    auto row = row_of(tables_of({trace}).first, 1);
    for (const char* name : {"gdop", "pdop", "vdop"})
        EXPECT_EQ(row[name], "") << name;
    EXPECT_EQ(row["tdop"], "0.800");
    EXPECT_THAT(row, SizeIs(33));
}

TEST(Recorder, WithoutAFixItsColumnsAreEmpty) {
    for (const FixType type : {FixType::none, FixType::time_only}) {
        Trace trace = recorded_trace();
        trace.epoch.fix.type = type;
        auto row = row_of(tables_of({trace}).first, 1);
        EXPECT_THAT(row, SizeIs(33));
        for (const char* name : {"lat_deg", "lon_deg", "height_m", "east_error_m", "north_error_m", "up_error_m",
                                 "vel_north_mps", "vel_east_mps", "vel_down_mps", "speed_mps", "course_deg", "gdop",
                                 "pdop", "hdop", "vdop", "tdop", "h_acc_m", "v_acc_m"})
            EXPECT_EQ(row[name], "") << name;
        EXPECT_EQ(row["fix_type"], fix_type_name(type));
        EXPECT_EQ(row["true_lat_deg"], "46.500000000");
        EXPECT_EQ(row["satellites_visible"], "2");
    }
}

TEST(Recorder, EachSatelliteHasARow) {
    const std::string table = tables_of({recorded_trace()}).second;
    EXPECT_THAT(lines_of(table), SizeIs(3));
    auto row = row_of(table, 1);
    EXPECT_EQ(row["satellite"], "G05");
    EXPECT_EQ(row["azimuth_deg"], "123.5000");
    EXPECT_EQ(row["elevation_deg"], "45.2500");
    EXPECT_EQ(row["range_m"], "21000000.0000");
    EXPECT_EQ(row["line_of_sight"], "1");
    EXPECT_EQ(row["paths"], "1");
    EXPECT_EQ(row["excess_path_m"], "1.0000");
    EXPECT_EQ(row["iono_delay_m"], "4.5000");
    EXPECT_EQ(row["tropo_delay_m"], "2.5000");
    EXPECT_EQ(row["gas_loss_db"], "0.25000");
    EXPECT_EQ(row["cloud_loss_db"], "0.12500");
    EXPECT_EQ(row["rain_loss_db"], "0.06250");
    EXPECT_EQ(row["cn0_dbhz"], "41.25");
    EXPECT_EQ(row["free_space_loss_db"], "182.50000");
    EXPECT_EQ(row["iono_loss_db"], "0.37500");
    EXPECT_EQ(row["reflection_loss_db"], "3.01030");
    EXPECT_EQ(row["received_power_dbw"], "-159.50000");
    EXPECT_EQ(row["used"], "1");
    EXPECT_NEAR(std::stod(row["pseudorange_m"]), 21'000'008 - speed_of_light * 0.99e-6, 1e-4);
    auto hidden = row_of(table, 2);
    EXPECT_EQ(hidden["satellite"], "G07");
    EXPECT_EQ(hidden["cn0_dbhz"], "");
    EXPECT_EQ(hidden["pseudorange_m"], "") << "nothing arrives that could be measured";
    EXPECT_EQ(hidden["received_power_dbw"], "");
    EXPECT_EQ(hidden["used"], "0");
}

TEST(Recorder, AReceiverThatMeasuresHasNoPseudorangeOfWhatItDoesNotTrack) {
    Trace trace = recorded_trace();
    trace.measures = true;
    EXPECT_EQ(row_of(tables_of({trace}).second, 1)["pseudorange_m"], "");
}

TEST(Recorder, WhatASensorModelDoesNotReportHasNoPseudorange) {
    Trace trace = recorded_trace();
    trace.epoch.fix.satellites[0].cn0.reset();
    auto row = row_of(tables_of({trace}).second, 1);
    EXPECT_EQ(row["cn0_dbhz"], "41.25") << "it arrives all the same";
    EXPECT_EQ(row["pseudorange_m"], "");
}

TEST(Recorder, TheTimesOfBytesFollowTheBytes) {
    const TemporaryFolder folder;
    const GpsTime start = to_gps_time(2304, 0);
    {
        auto recorder = test::recorder_in(folder / "run");
        recorder->record_output(to_bytes("abc"), {start, 100});
        recorder->record_output({}, {start, 150});
        recorder->record_output(to_bytes("de"), {start + std::chrono::milliseconds(1), 200});
        recorder->record_input(to_bytes("in"), {});
    }
    EXPECT_EQ(content_of(folder / "run/port0.out"), "abcde");
    EXPECT_EQ(content_of(folder / "run/port0.in"), "in");
    EXPECT_EQ(content_of(folder / "run/port0.times"),
              fmt::format("100 {} 0 3\n200 {} 3 2\n", start.time_since_epoch().count(),
                          start.time_since_epoch().count() + 1'000'000));
}

TEST(Recorder, AFolderThatCannotBeMadeIsNamed) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "x";
    const auto in_file = test::recorder_in(folder / "file/run");
    ASSERT_FALSE(in_file);
    EXPECT_EQ(in_file.error().code, ErrorCode::outside);
    EXPECT_THAT(in_file.error().message, HasSubstr("file/run: cannot be made a folder: Not a directory"));
    std::filesystem::create_directories(folder / "run/fixes.csv");
    EXPECT_THAT(test::recorder_in(folder / "run").error().message, HasSubstr("fixes.csv: cannot be written"));
}

TEST(Recorder, ReplacesAFormerRunAndTellsFailures) {
    const TemporaryFolder folder;
    { test::recorder_in(folder / "run")->record_output(to_bytes("old"), {}); }
    auto recorder = test::recorder_in(folder / "run");
    recorder->flush();
    EXPECT_EQ(content_of(folder / "run/port0.out"), "");
    EXPECT_FALSE(recorder->failure());
    recorder->record_summary("{}\n");
    EXPECT_EQ(content_of(folder / "run/run.json"), "{}\n");
    std::filesystem::remove_all(folder / "run");
    recorder->record_summary("{}\n");
    ASSERT_TRUE(recorder->failure());
    EXPECT_THAT(recorder->failure()->message, HasSubstr("run.json: cannot be written"));
}

TEST(Recorder, WhatIsThereStaysUntilTheRecordingBegins) {
    const TemporaryFolder folder;
    { test::recorder_in(folder / "run")->record_output(to_bytes("old"), {}); }
    auto recorder = Recorder::claim(folder / "run");
    ASSERT_TRUE(recorder);
    EXPECT_EQ(content_of(folder / "run/port0.out"), "old");
    ASSERT_TRUE(recorder->begin({1}));
    EXPECT_EQ(content_of(folder / "run/port0.out"), "");
}

TEST(Recorder, WhatNoRunHasLeftIsTheUsers) {
    const TemporaryFolder folder;
    for (const bool former : {false, true}) {
        auto recorder = Recorder::claim(folder / "run");
        const std::string others[] = {"navigation.rnx", "observations.rnx", "junit.xml",   "verdicts.json",
                                      "port1.out",      "port1.in",         "port1.times", "port1.in_times"};
        for (const std::string& name : others)
            std::ofstream(folder / "run" / name) << "downloaded";
        ASSERT_TRUE(recorder->begin({1, former}));
        for (const std::string& name : others)
            EXPECT_EQ(std::filesystem::exists(folder / "run" / name), !former) << name;
    }
}

TEST(Recorder, TwoDoNotRecordIntoOneFolder) {
    const TemporaryFolder folder;
    auto first = test::recorder_in(folder / "run");
    first->record_output(to_bytes("first"), {});
    first->flush();
    const auto second = Recorder::claim(folder / "run");
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::outside);
    EXPECT_THAT(second.error().message, HasSubstr("run: another run is recording there"));
    EXPECT_EQ(content_of(folder / "run/port0.out"), "first");
}

TEST(RunSummary, CountsWhatWasRecorded) {
    const TemporaryFolder folder;
    const Scenario scenario = test::emulator_scenario(
        "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 10\nseed = 9\n[model]\nname = \"ideal\"");
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.record = folder / "run";
    auto assembly = assemble(scenario, test::emulator_data(), mode);
    ASSERT_TRUE(assembly) << assembly.error().message;
    ASSERT_TRUE(assembly->emulator->begin());
    assembly->emulator->run_until(*assembly->end, false);
    const auto summary = nlohmann::json::parse(run_summary(scenario, *assembly, "1.2.3"));
    EXPECT_EQ(summary["version"], "1.2.3");
    EXPECT_EQ(summary["seed"], 9);
    EXPECT_EQ(summary["ended"], true);
    EXPECT_EQ(summary["cut"], false);
    EXPECT_EQ(nlohmann::json::parse(run_summary(scenario, *assembly, "1", SummaryOf::cut_end))["cut"], true);
    EXPECT_EQ(nlohmann::json::parse(run_summary(scenario, *assembly, "1", SummaryOf::beginning))["ended"], false);
    EXPECT_EQ(summary["model"], "ideal");
    EXPECT_EQ(summary["board"], "ublox-m8");
    EXPECT_EQ(summary["start_utc"], "2024-03-05T12:00:00.000Z");
    EXPECT_EQ(summary["simulated_s"], 10);
    EXPECT_EQ(summary["epochs"], 10);
    EXPECT_EQ(summary["epochs_with_fix"], 10);
    EXPECT_EQ(summary["navigation"], "nominal GPS constellation");
    EXPECT_EQ(summary["scenario_digest"], assembly->digest);
    EXPECT_THAT(lines_of(content_of(folder / "run/fixes.csv")), SizeIs(11));
    EXPECT_EQ(summary["lateness"]["histogram"][0]["epochs"], 10);
}

}  // namespace
}  // namespace skyloop
