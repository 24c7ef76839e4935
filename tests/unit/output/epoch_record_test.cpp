// A line of JSON for an epoch.
#include "run/output/epoch_messages.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "epochs.hpp"

namespace skyloop {
namespace {

using nlohmann::json;
using test::SampleEpoch;

json line_of(const SampleEpoch& epoch) {
    const std::string line = epoch_line(record_epoch(epoch.seen(), "rover", 3));
    EXPECT_EQ(line.find('\n'), line.size() - 1);
    return json::parse(line);
}

TEST(EpochLine, TellsTruthFixErrorAndSatellites) {
    const json line = line_of(SampleEpoch(Seconds(0.2)));
    EXPECT_EQ(line["schema"], "skyloop-epoch/1");
    EXPECT_EQ(line["receiver"], "rover");
    EXPECT_EQ(line["epoch"], 3);
    EXPECT_EQ(line["time_utc"], "2024-03-05T12:00:00.200Z");
    EXPECT_EQ(line["gps_week"], 2304);
    EXPECT_EQ(line["tow_s"], 216018.2);
    EXPECT_EQ(line["latency_s"], 0.05);
    const json truth = line["truth"], fix = line["fix"];
    EXPECT_EQ(truth["lat_deg"], 47);
    EXPECT_EQ(truth["height_m"], 500);
    EXPECT_EQ(truth["velocity_mps"], (json{{"north", 12.0}, {"east", 1.0}, {"down", 0.5}}));
    EXPECT_TRUE(truth["attitude"].is_null());
    EXPECT_EQ(fix["type"], "3d");
    EXPECT_EQ(fix["ok"], true);
    EXPECT_NEAR(fix["lat_deg"].get<double>(), 47 + 2 / 111176.0, 2e-8);
    EXPECT_EQ(fix["msl_m"], 452);
    EXPECT_EQ(fix["h_acc_m"], 1.25);
    EXPECT_EQ(fix["course_deg"], 4.76);
    EXPECT_EQ(fix["dop"]["h"], 0.8);
    EXPECT_EQ(fix["satellites_used"], 1);
    EXPECT_EQ(line["error"], (json{{"east_m", 0.0}, {"north_m", 2.0}, {"up_m", 0.0}}));
    ASSERT_EQ(line["satellites"].size(), 1U);
    const json satellite = line["satellites"][0];
    EXPECT_EQ(satellite["id"], "G07");
    EXPECT_EQ(satellite["az_deg"], 123.45);
    EXPECT_EQ(satellite["cn0_dbhz"], (json{{"1C", 44.5}}));
    EXPECT_EQ(satellite["used"], true);
}

// By its own leap second, which nobody has announced, as its messages do.
TEST(EpochLine, CountsTheLeapSecondOfAFault) {
    SampleEpoch epoch;
    const GpsTime midnight = to_gps_time(*parse_utc("2024-03-06T00:00:00Z"), LeapSeconds::announced());
    epoch.state.leap_event = firmware::LeapEvent{midnight + std::chrono::seconds(1), 18, 19};
    epoch.state.epoch.fix.time = midnight;
    EXPECT_EQ(line_of(epoch)["fix"]["time_utc"], "2024-03-05T23:59:60.000Z");
    epoch.state.epoch.fix.time += std::chrono::seconds(1);
    epoch.state.epoch.fix.leap_seconds = 19;
    EXPECT_EQ(line_of(epoch)["fix"]["time_utc"], "2024-03-06T00:00:00.000Z");
}

TEST(EpochLine, TellsHowTheVehicleStands) {
    SampleEpoch epoch;
    epoch.trace.truth.orientation =
        Orientation{Attitude::roll_pitch_yaw(Angle::degrees(10), Angle::degrees(-5), Angle::degrees(90)), {}};
    const json attitude = line_of(epoch)["truth"]["attitude"];
    EXPECT_EQ(attitude["roll_deg"], 10);
    EXPECT_EQ(attitude["pitch_deg"], -5);
    EXPECT_EQ(attitude["yaw_deg"], 90);
    double norm = 0;
    for (const json& part : attitude["q"])
        norm += part.get<double>() * part.get<double>();
    EXPECT_NEAR(norm, 1, 1e-6);
}

// Keys stay, so that readers need not ask for them.
TEST(EpochLine, WithoutAFixItsValuesAreNull) {
    SampleEpoch epoch;
    const json with = line_of(epoch)["fix"];
    epoch.state.epoch.fix.type = FixType::none;
    const json line = line_of(epoch);
    EXPECT_EQ(line["fix"]["type"], "none");
    EXPECT_TRUE(line["error"].is_null());
    for (const auto& [key, value] : with.items()) {
        ASSERT_TRUE(line["fix"].contains(key)) << key;
        if (key.ends_with("_m") || key.ends_with("_deg") || key.ends_with("_mps") || key == "dop") {
            EXPECT_TRUE(line["fix"][key].is_null()) << key;
        }
    }
    EXPECT_EQ(line["fix"].size(), with.size());
}

TEST(EpochLine, ASilentReceiverTellsNothing) {
    SampleEpoch epoch;
    epoch.leaves.reset();
    const json line = line_of(epoch);
    EXPECT_TRUE(line["fix"].is_null());
    EXPECT_TRUE(line["latency_s"].is_null());
    EXPECT_TRUE(line["error"].is_null());
    EXPECT_EQ(line["truth"]["lat_deg"], 47);
    EXPECT_EQ(line["satellites"][0]["used"], false);
}

TEST(EpochLine, WhatIsNotFiniteIsNull) {
    SampleEpoch epoch;
    epoch.state.epoch.fix.speed = MetresPerSecond(std::numeric_limits<double>::quiet_NaN());
    epoch.state.epoch.fix.dop.hdop = std::numeric_limits<double>::infinity();
    const json fix = line_of(epoch)["fix"];
    EXPECT_TRUE(fix["speed_mps"].is_null());
    EXPECT_TRUE(fix["dop"]["h"].is_null());
}

}  // namespace
}  // namespace skyloop
