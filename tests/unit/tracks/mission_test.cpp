// Plans of QGroundControl and missions as plain text.
#include <gmock/gmock.h>

#include <random>

#include "flown_route.hpp"
#include "motion/trajectory/route.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

using test::height_of;
using test::place_of;
using test::refusal_of_track;
using test::track_of;
using testing::Contains;
using testing::HasSubstr;

std::string simple(int command, int frame, std::string_view params) {
    return "{\"type\":\"SimpleItem\",\"autoContinue\":true,\"command\":" + std::to_string(command) +
           ",\"frame\":" + std::to_string(frame) + ",\"params\":[" + std::string(params) + "]}";
}

std::string plan(const std::string& items, std::string_view vehicle = "2") {
    return "{\"fileType\":\"Plan\",\"version\":1,\"groundStation\":\"QGroundControl\",\"mission\":{\"version\":2,"
           "\"firmwareType\":12,\"vehicleType\":" +
           std::string(vehicle) +
           ",\"cruiseSpeed\":17,\"hoverSpeed\":6,\"plannedHomePosition\":[47.0,8.0,500],\"items\":[" + items + "]}}";
}

const std::string whole_plan =
    plan(simple(22, 3, "0,0,0,null,47.0,8.0,30") + "," + simple(530, 2, "0,2,null,null,null,null,null") + "," +
         simple(16, 3, "5,0,0,null,47.001,8.0,40") + "," + simple(178, 2, "1,3,-1,0,0,0,0") + "," +
         simple(18, 0, "2,0,-25,null,47.001,8.002,545") + "," + simple(177, 2, "2,1,0,0,0,0,0") + "," +
         simple(20, 2, "0,0,0,0,0,0,0"));

TEST(QgcPlan, IsARouteOfItsItems) {
    const Track track = track_of(whole_plan, "t.plan");
    EXPECT_EQ(track.format, "QGroundControl plan");
    // Ground, above it, the place of the take-off, a waypoint, a circle, above home, home.
    ASSERT_EQ(track.points.size(), 7u);
    const double heights[] = {510, 540, 540, 550, 555, 555, 510};
    for (std::size_t i = 0; i < 7; ++i)
        EXPECT_NEAR(height_of(track, i), heights[i], 1e-4) << i;
    EXPECT_NEAR(place_of(track, 3).latitude.deg(), 47.001, 1e-9);
    EXPECT_NEAR(place_of(track, 6).longitude.deg(), 8.0, 1e-9);
    ASSERT_TRUE(track.route.has_value());
    EXPECT_EQ(track.route->vehicle, VehicleClass::multirotor);
    EXPECT_EQ(track.route->speed, 6.0);
    ASSERT_EQ(track.route->stops.size(), 7u);
    EXPECT_EQ(track.route->stops[3].hold, 5.0);
    EXPECT_EQ(track.route->stops[3].speed, 3.0);
    EXPECT_EQ(track.route->stops[4].turns, 2.0);
    EXPECT_EQ(track.route->stops[4].radius, -25.0);
    EXPECT_THAT(track.notes, Contains("1 items are not followed: the commands (MAV_CMD) 177"));
    test::expect_flown_route(track, {{}, {}, 30, 0});
}

TEST(QgcPlan, AnItemWithoutAHeightStaysAtThatOfTheOneBefore) {
    const Track track =
        track_of(plan(simple(22, 3, "0,0,0,null,47.0,8.0,30") + "," + simple(16, 3, "0,0,0,null,47.001,8.0,40") + "," +
                      simple(16, 3, "0,0,0,null,47.002,8.0,null")),
                 "t.plan");
    ASSERT_EQ(track.points.size(), 5u);
    EXPECT_NEAR(height_of(track, 4), 550, 1e-4);
}

TEST(QgcPlan, HoldsTheItemsOfSurveysAndLandings) {
    const std::string survey =
        "{\"type\":\"ComplexItem\",\"complexItemType\":\"survey\",\"TransectStyleComplexItem\":{\"Items\":[" +
        simple(16, 3, "0,0,0,null,47.002,8.0,60") + "," + simple(206, 2, "25,0,1,0,0,0,0") + "," +
        simple(16, 3, "0,0,0,null,47.004,8.0,60") + "]}}";
    const std::string landing =
        "{\"type\":\"ComplexItem\",\"complexItemType\":\"fwLandingPattern\",\"altitudesAreRelative\":true,"
        "\"landingApproachCoordinate\":[47.006,8,40],\"landCoordinate\":[47.01,8,0]}";
    const std::string other = "{\"type\":\"ComplexItem\",\"complexItemType\":\"StructureScan\",\"version\":3}";
    const Track track = track_of(plan(survey + "," + landing + "," + other, "1"), "t.plan");
    ASSERT_EQ(track.points.size(), 5u);
    EXPECT_NEAR(place_of(track, 1).latitude.deg(), 47.004, 1e-9);
    EXPECT_NEAR(height_of(track, 2), 550, 1e-4);
    EXPECT_NEAR(height_of(track, 4), 510, 1e-4);
    EXPECT_EQ(track.route->vehicle, VehicleClass::plane);
    EXPECT_EQ(track.route->speed, 17.0);
    EXPECT_THAT(track.notes, Contains("item 3 is not followed: a StructureScan"));
    test::expect_flown_route(track, {});
}

TEST(QgcPlan, RefusesWhatCannotBeFlownInOneLine) {
    EXPECT_THAT(refusal_of_track(plan(simple(16, 10, "0,0,0,0,47,8,50")), "t.plan"),
                HasSubstr("item 1 (command 16): its height is above the terrain (frame 10)"));
    EXPECT_THAT(refusal_of_track(plan(simple(16, 1, "0,0,0,0,47,8,50")), "t.plan"),
                HasSubstr("its place is in frame 1"));
    EXPECT_THAT(refusal_of_track(plan(simple(16, 3, "0,0,0,0,97,8,50")), "t.plan"), HasSubstr("latitude is 97"));
    EXPECT_THAT(refusal_of_track(plan(simple(16, 3, "-1,0,0,0,47,8,50")), "t.plan"),
                HasSubstr("parameter 1 is -1; expected 0 to"));
    EXPECT_THAT(refusal_of_track(plan(simple(18, 3, "1e9,0,0,0,47,8,50")), "t.plan"),
                HasSubstr("parameter 1 is 1e+09"));
    EXPECT_THAT(refusal_of_track(plan("{\"type\":\"SimpleItem\"}"), "t.plan"), HasSubstr("without a command"));
    EXPECT_THAT(refusal_of_track(plan("7"), "t.plan"), HasSubstr("item 1 is of the type ''"));
    EXPECT_THAT(refusal_of_track(plan(""), "t.plan"), HasSubstr("0 items, and no place among them"));
    EXPECT_THAT(refusal_of_track("{\"fileType\":\"Plan\"}", "t.plan"), HasSubstr("without mission.items"));
    EXPECT_THAT(refusal_of_track("{\"fileType\":\"Plan\",", "t.plan"), HasSubstr("no sound JSON"));
}

const std::string wpl_items =
    "1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t20\t1\r\n"
    "2\t0\t3\t16\t0\t0\t0\t0\t47.001\t8\t100\t1\r\n"
    "3\t0\t3\t19\t30\t0\t80\t0\t47.001\t8.01\t100\t1\r\n"
    "4\t0\t3\t21\t0\t0\t0\tnan\t47.003\t8.01\t0\t1\r\n";

TEST(QgcPlan, AVtolRisesAsAMultirotorAndFliesAtItsCruiseSpeed) {
    const std::string items = simple(84, 3, "0,0,0,null,47.0,8.0,30") + "," + simple(16, 3, "0,0,0,null,47.01,8.0,80");
    for (const std::string type : {"19", "20", "21", "22", "23", "24", "25"}) {
        const Track track = track_of(plan(items, type), "t.plan");
        EXPECT_EQ(track.route->vehicle, VehicleClass::multirotor);
        EXPECT_EQ(track.route->speed, 17.0);
        EXPECT_THAT(track.notes, Contains(HasSubstr("vehicleType " + type + ", a VTOL")));
    }
    const Track unknown = track_of(plan(items, "77"), "t.plan");
    EXPECT_FALSE(unknown.route->vehicle.has_value());
    EXPECT_THAT(unknown.notes, Contains(HasSubstr("vehicleType 77 is not known")));
}

TEST(QgcPlan, RefusesTextsInPlaceOfNumbers) {
    EXPECT_THAT(refusal_of_track(plan(simple(16, 3, "0,0,0,null,\"47,001\",8.0,40")), "t.plan"),
                HasSubstr("item 1: '47,001' in its params; expected a number or null"));
}

TEST(WplMission, IsARouteThatBeginsAtHome) {
    const Track track =
        track_of("QGC WPL 110\r\n0\t1\t0\t16\t0\t0\t0\t0\t47\t8\t500\t1\r\n" + wpl_items, "t.waypoints");
    EXPECT_EQ(track.format, "QGC WPL 110");
    ASSERT_EQ(track.points.size(), 7u);
    const double heights[] = {510, 530, 530, 610, 610, 610, 510};
    for (std::size_t i = 0; i < 7; ++i)
        EXPECT_NEAR(height_of(track, i), heights[i], 1e-4) << i;
    EXPECT_EQ(track.route->stops[4].hold, 30.0);
    EXPECT_EQ(track.route->stops[4].radius, 80.0);
    for (const VehicleClass vehicle : {VehicleClass::multirotor, VehicleClass::plane})
        test::expect_flown_route(track, {vehicle, {}, 30, 0});
}

// The corners of a circle are none of the plan's places, and notes call its places by their items.
TEST(WplMission, ItsNotesCountPlacesAndCallThemByTheirItems) {
    const Track track = track_of(
        "QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 500 1\n5 0 3 22 0 0 0 0 0 0 20 1\n7 0 3 18 2 0 25 0 47.001 8 "
        "60 1\n9 0 3 16 0 0 0 0 47.001 8.001 60 1\n11 0 3 16 0 0 0 0 47.0015 8.0003 60 1\n");
    const auto route = fly_route(track, {VehicleClass::multirotor, {}, 2, 0});
    ASSERT_TRUE(route.has_value()) << route.error().message;
    EXPECT_EQ(route->circles, 1u);
    EXPECT_EQ(route->corners, 33u);
    EXPECT_EQ(route->waypoints.size() - route->corners + route->circles, track.points.size());
    bool called = false;
    for (const std::string& note : route->notes) {
        called = called || note.find("item ") != std::string::npos;
        EXPECT_EQ(note.find("waypoint "), std::string::npos) << note;
    }
    EXPECT_TRUE(called);
}

// A take-off without a place, and one at another place than home.
TEST(WplMission, APlaneBeginsOnTheGroundAndClimbsOnItsWay) {
    const std::string home = "QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 500 1\n";
    for (const std::string take_off : {"1 0 3 22 15 0 0 0 0 0 50 1\n", "1 0 3 22 15 0 0 0 47.003 8 50 1\n"}) {
        const Track track =
            track_of(home + take_off + "2 0 3 16 0 0 0 0 47.005 8 100 1\n3 0 3 16 0 0 0 0 47.005 8.01 100 1\n");
        const auto route = fly_route(track, {VehicleClass::plane, {}, 2, 0});
        ASSERT_TRUE(route.has_value()) << route.error().message;
        EXPECT_NEAR(route->shape->at(0).position.z(), 510, 1e-3);
        EXPECT_NEAR(route->shape->at(1).position.z(), 510, 5) << "at rest it does not climb";
        EXPECT_NEAR(route->shape->at(1e9).position.z(), 610, 1e-3);
        EXPECT_THAT(route->notes, Contains(HasSubstr("up or down (1 places, up to 50.0 m): a plane climbs")));
        const auto copter = fly_route(track, {VehicleClass::multirotor, {}, 2, 0});
        ASSERT_TRUE(copter.has_value());
        EXPECT_GE(copter->waypoints.size(), 4u) << "what can stand goes straight up";
    }
}

// Home, a place 111 m off, a circle that is too tight, and home.
TEST(QgcPlan, APlaneTurnsBackAtTheFarthestPlaceWhereNoTurnIsLeft) {
    const std::string begin = simple(22, 3, "0,0,0,null,47.0,8.0,50") + "," + simple(16, 3, "0,0,0,null,47.001,8,50");
    const Track track = track_of(
        plan(begin + "," + simple(18, 3, "1,1,-30,1,47.002,8.0,60") + "," + simple(20, 2, "0,0,0,0,0,0,0"), "1"),
        "t.plan");
    const auto route = fly_route(track, {});
    ASSERT_TRUE(route.has_value()) << route.error().message;
    EXPECT_THAT(route->notes, Contains(HasSubstr("and turned back at by corners")));
    double farthest = 0;
    for (double t = 0; t < route->shape->duration(); t += 0.1)
        farthest = std::max(farthest, route->shape->at(t).position.y());
    EXPECT_NEAR(farthest, 222 + 30, 10);
    EXPECT_LT(route->shape->at(1e9).position.head<2>().norm(), 1e-3);

    const Track near =
        track_of(plan(simple(22, 3, "0,0,0,null,47.0,8.0,50") + "," + simple(16, 3, "0,0,0,null,47.0002,8,50") + "," +
                          simple(20, 2, "0,0,0,0,0,0,0"),
                      "1"),
                 "t.plan");
    const auto refused = fly_route(near, {});
    ASSERT_FALSE(refused.has_value());
    EXPECT_THAT(refused.error().message, HasSubstr("22.2 m from where it begins and ends, a plane does not turn back"));
    EXPECT_THAT(refused.error().message, HasSubstr("a radius of 14.7 m at its slowest, 12 m/s"));
}

TEST(WplMission, TakesTheHeightOfHomeFromTheOrigin) {
    const std::string homeless = "QGC WPL 110\n0 1 0 16 0 0 0 0 0 0 0 1\n2 0 3 16 0 0 0 0 47.001 8 100 1\n";
    EXPECT_THAT(refusal_of_track(homeless), HasSubstr("item 2 (command 16): its height is above home, whose height"));
    const Track track = track_of(homeless, "t.txt", Geodetic::degrees(47, 8, 321));
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_NEAR(height_of(track, 0), 421, 1e-4);
}

TEST(WplMission, RefusesWhatCannotBeReadInOneLine) {
    EXPECT_THAT(refusal_of_track("QGC WPL 100\n"), HasSubstr("t.txt:1: a mission of the version '100'"));
    EXPECT_THAT(refusal_of_track("QGC WPL 110\n1 2 3\n"), HasSubstr("t.txt:2: 3 columns; expected 12"));
    EXPECT_THAT(refusal_of_track("QGC WPL 110\n1 0 3 16 0 0 0 0 47,1 8 1 1\n"), HasSubstr("column 9 is '47,1'"));
    EXPECT_THAT(refusal_of_track("QGC WPL 110\n1 0 3 1e9 0 0 0 0 47 8 1 1\n"), HasSubstr("column 4 is '1e9'"));
    EXPECT_THAT(refusal_of_track("QGC WPL 110\n"), HasSubstr("0 items, and no place among them"));
}

// Cut anywhere and with bytes changed: a track that can be flown, or one clear line.
TEST(Missions, DamagedOnesNeverCrash) {
    const auto geoid = test::flat_geoid(10);
    std::mt19937_64 engine(5);
    const std::string wpl = "QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 500 1\n" + wpl_items;
    for (int round = 0; round < 3000; ++round) {
        std::string text = round % 2 == 0 ? whole_plan : wpl;
        if (round % 3 == 0) text.resize(engine() % text.size());
        for (int i = 0; i < round % 5 && !text.empty(); ++i)
            text[engine() % text.size()] = "0123456789-.,e\"[]{}\n x"[engine() % 22];
        const auto track = read_track(test::bytes_of(text), "t.plan", {&*geoid, {}});
        if (!track) {
            EXPECT_EQ(track.error().message.find('\n'), std::string::npos);
            continue;
        }
        if (!track->route) continue;
        const auto route = fly_route(*track, {});
        if (route) {
            EXPECT_TRUE(route->shape->at(10).position.allFinite());
        }
    }
}

}  // namespace
}  // namespace skyloop
