#include "run/control/status_json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "snapshots.hpp"

namespace skyloop::test {
namespace {

TEST(StatusJson, TellsTimesPlacesSatellitesAndWires) {
    const auto json = nlohmann::json::parse(status_json(small_snapshot()));
    EXPECT_EQ(json["elapsed_s"], 12.0);
    EXPECT_EQ(json["gps_week"], 2314);
    EXPECT_EQ(json["gps_tow_s"], 492812.0);
    EXPECT_EQ(json["title"], "hangar \"three\"");
    EXPECT_TRUE(json["span_s"].is_null());
    const auto& receiver = json["receivers"][0];
    EXPECT_EQ(receiver["fix"]["type"], "3d");
    EXPECT_NEAR(receiver["fix"]["place"]["height_m"].get<double>(), 502, 1e-9);
    EXPECT_EQ(receiver["epoch_s"], 11.0);
    EXPECT_EQ(receiver["error"]["up_m"], 2.0);
    EXPECT_EQ(receiver["satellites"][0]["id"], "G07");
    EXPECT_EQ(receiver["satellites"][0]["cn0_dbhz"]["1C"], 44.5);
    EXPECT_EQ(receiver["satellites"][0]["state"], "reflected");
    EXPECT_EQ(receiver["wires"][0]["bytes_out"], 1234);
    EXPECT_EQ(receiver["wires"][0]["baud"], 9600);
    EXPECT_EQ(json["timeline"][0]["begins_s"], 10.0);
    EXPECT_TRUE(json["timeline"][0]["ends_s"].is_null());
    EXPECT_EQ(json["verdicts"][0]["state"], "pending");
    EXPECT_EQ(json["events"][0]["seq"], 3);
}

TEST(StatusJson, TellsOfCorrectionsWhereSomeHaveCome) {
    StatusSnapshot snapshot = small_snapshot();
    EXPECT_FALSE(nlohmann::json::parse(status_json(snapshot))["receivers"][0].contains("corrections"));
    CorrectionsStatus& corrections = snapshot.receivers[0].corrections.emplace();
    corrections.age = Seconds(1.5);
    corrections.station = 1234;
    const auto told = [&snapshot] {
        return nlohmann::json::parse(status_json(snapshot))["receivers"][0]["corrections"];
    };
    EXPECT_EQ(told(),
              nlohmann::json(
                  {{"solution", "none"}, {"age_s", 1.5}, {"station", 1234}, {"base", nullptr}, {"baseline", nullptr}}));
    corrections.solution = CorrectionState::rtk_fixed;
    corrections.base = Geodetic::degrees(47, 11, 503);
    RelativePosition& vector = corrections.baseline.emplace();
    vector.north_m = 3;
    vector.east_m = 4;
    vector.down_m = -12;
    vector.base_moves = false;
    vector.ratio = 8;
    EXPECT_EQ(told()["solution"], "fixed");
    EXPECT_NEAR(told()["base"]["lat_deg"].get<double>(), 47, 1e-12);
    EXPECT_NEAR(told()["base"]["height_m"].get<double>(), 503, 1e-9);
    EXPECT_EQ(told()["baseline"], nlohmann::json({{"length_m", 13.0},
                                                  {"north_m", 3.0},
                                                  {"east_m", 4.0},
                                                  {"down_m", -12.0},
                                                  {"base_moves", false},
                                                  {"ratio", 8.0}}));
    corrections.solution = CorrectionState::rtk_float;
    vector.ratio = 0;
    EXPECT_EQ(told()["solution"], "float");
    EXPECT_TRUE(told()["baseline"]["ratio"].is_null());
    corrections.solution = CorrectionState::differential;
    EXPECT_EQ(told()["solution"], "differential");
}

TEST(StatusJson, TellsEachLineOnce) {
    const StatusSnapshot snapshot = small_snapshot();
    EXPECT_EQ(nlohmann::json::parse(status_json(snapshot))["dialogue"].size(), 100U);
    const auto later = nlohmann::json::parse(status_json(snapshot, {98, 3}));
    ASSERT_EQ(later["dialogue"].size(), 2U);
    EXPECT_EQ(later["dialogue"][0]["seq"], 99);
    EXPECT_EQ(later["dialogue"][0]["name"], "PUBX,41");
    EXPECT_EQ(later["dialogue"][0]["from"], "client");
    EXPECT_NE(later["dialogue"][0]["text"].get<std::string>().find("PUBX"), std::string::npos);
    EXPECT_TRUE(later["events"].empty());
    EXPECT_EQ(last_lines(snapshot).dialogue, 100U);
    EXPECT_EQ(nlohmann::json::parse(recent_status_json(snapshot))["dialogue"].size(), 64U);
}

TEST(StatusJson, TellsHowManyMessagesThereWereWhateverWasSeen) {
    const auto json = nlohmann::json::parse(status_json(small_snapshot(), {100, 3}));
    EXPECT_TRUE(json["dialogue"].empty());
    ASSERT_EQ(json["messages"].size(), 1U);
    EXPECT_EQ(json["messages"][0], nlohmann::json({{"receiver", 0},
                                                   {"wire", 0},
                                                   {"from", "client"},
                                                   {"protocol", "nmea"},
                                                   {"name", "PUBX,41"},
                                                   {"count", 100}}));
}

TEST(StatusJson, WritesNullForWhatIsNoNumberAndCannotBeBroken) {
    StatusSnapshot snapshot = small_snapshot();
    snapshot.title = "\xFF\xFE";
    snapshot.receivers[0].true_speed = MetresPerSecond(std::nan(""));
    const auto json = nlohmann::json::parse(status_json(snapshot));
    EXPECT_TRUE(json["receivers"][0]["true_speed_mps"].is_null());
}

TEST(StatusJson, TellsTheTimeline) {
    const auto json = nlohmann::json::parse(timeline_json(small_snapshot()));
    EXPECT_EQ(json["now_s"], 12.0);
    EXPECT_EQ(json["entries"][0]["name"], "wet plug");
    EXPECT_EQ(json["entries"][0]["strength"], 0.5);
}

TEST(StatusJson, DrawsRoofsFromAbove) {
    CityModel city;
    city.origin = Geodetic::degrees(48, 11, 500);
    city.add_quad({{{0, 0, 10}, {20, 0, 10}, {20, 10, 10}, {0, 10, 10}}}, SurfaceKind::roof);
    city.add_quad({{{0, 0, 0}, {20, 0, 0}, {20, 0, 10}, {0, 0, 10}}}, SurfaceKind::wall);
    const auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    const auto json = nlohmann::json::parse(scene_json(**scene));
    ASSERT_EQ(json["roofs"].size(), 2U);
    ASSERT_EQ(json["roofs"][0].size(), 7U);
    EXPECT_EQ(json["roofs"][0][6], 10.0);
    EXPECT_EQ(nlohmann::json::parse(scene_json(**scene, 1))["roofs"].size(), 1U);
}

}  // namespace
}  // namespace skyloop::test
