// What buildings a scenario names become in a run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::emulator_data;
using test::emulator_scenario;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

RunMode scene_mode() {
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.now = to_gps_time(2400, 0);
    return mode;
}

Result<Assembly> with_scene(const std::string& text) {
    return assemble(emulator_scenario(text), emulator_data(), scene_mode());
}

constexpr const char* demo_text = "[run]\nduration_s = 3\n[scene]\nbuildings = \"demo\"\nrays = 2048\n";

TEST(SceneAssembly, TheDemoStandsBelowTheStartOfTheTrajectory) {
    const auto assembly = with_scene(std::string(demo_text) + "[trajectory]\nkind = \"fixed\"\nat = [48, 11, 500]\n");
    ASSERT_TRUE(assembly) << assembly.error().message;
    ASSERT_TRUE(assembly->scene.scene);
    const Geodetic origin = assembly->scene.scene->frame().origin();
    EXPECT_NEAR(origin.latitude.deg(), 48, 1e-12);
    EXPECT_NEAR(origin.height.above_ellipsoid.value(), 498.5, 1e-9);
    EXPECT_THAT(assembly->details, Contains(HasSubstr("scene: demo, ")));
}

TEST(SceneAssembly, EveryModelHasItsBuildings) {
    for (const std::string_view name : model_names()) {
        auto assembly = with_scene(std::string(demo_text) + "[model]\nname = \"" + std::string(name) + "\"\n");
        ASSERT_TRUE(assembly) << assembly.error().message;
        const RayTracedScene* city = assembly->emulator->simulation().city();
        ASSERT_NE(city, nullptr) << name;
        const std::atomic<bool> stop{false};
        assembly->emulator->run_until(*assembly->end, stop);
        EXPECT_FALSE(city->paths().empty()) << name;
        EXPECT_EQ(city->counters().epochs, 3U) << name;
    }
}

TEST(SceneAssembly, ReceiversShareTheSceneAndNothingElse) {
    const auto assembly = with_scene(std::string(demo_text) + "[[receiver]]\n[[receiver]]\n");
    ASSERT_TRUE(assembly) << assembly.error().message;
    const RayTracedScene* first = assembly->emulator->stations()[0].simulation().city();
    const RayTracedScene* second = assembly->emulator->stations()[1].simulation().city();
    EXPECT_NE(first, second);
    EXPECT_EQ(&first->scene(), &second->scene());
}

TEST(SceneAssembly, WithoutErrorsTheBuildingsAreLeftOutWithAWarning) {
    const auto assembly = with_scene(std::string(demo_text) + "[model]\nerrors = \"none\"\n");
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_EQ(assembly->emulator->simulation().city(), nullptr);
    EXPECT_THAT(assembly->warnings, Contains(HasSubstr("leaves the buildings out")));
}

TEST(SceneAssembly, TheProfileIsThatOfTheModel) {
    Scenario scenario = emulator_scenario(demo_text);
    const RayTracedSceneSettings modern = scene_effect_settings(scenario, 10);
    EXPECT_EQ(modern.profile, SceneProfile::modern);
    EXPECT_EQ(modern.search.most_reflections, 3);
    EXPECT_TRUE(modern.search.ground_reflects);
    EXPECT_EQ(modern.epochs_per_second, 10);
    choose_model(scenario.model, "baseline");
    const RayTracedSceneSettings article = scene_effect_settings(scenario, 1);
    EXPECT_EQ(article.profile, SceneProfile::baseline);
    EXPECT_EQ(article.search.most_reflections, 16);
    EXPECT_FALSE(article.search.ground_reflects);
    EXPECT_TRUE(article.search.blocked_only);
}

TEST(SceneAssembly, CrownsOfTheSceneFollowTheKeysOfTrees) {
    Scenario scenario = emulator_scenario(std::string(demo_text) +
                                          "[model.modern.losses]\nmost_foliage_db = 5\ncanopy_db_per_m = 0.1\n"
                                          "[model.modern.terms.foliage]\nscale = 0.5\n");
    const CrownLoss crowns = scene_effect_settings(scenario, 1).crowns;
    EXPECT_EQ(crowns.db_per_m, 0.1);
    EXPECT_EQ(crowns.most.value(), 5);
    EXPECT_EQ(crowns.factor, 0.5);
    scenario.scene.foliage = false;
    EXPECT_EQ(scene_effect_settings(scenario, 1).crowns.factor, 0);
}

TEST(SceneAssembly, TheAntennaHearsAllRaysByTheScaleOfItsTerm) {
    const auto gain_with = [](const std::string& term) {
        const Scenario scenario =
            emulator_scenario(std::string(demo_text) + "[model.modern.terms.antenna]\n" + term + "\n");
        return scene_effect_settings(scenario, 1).antenna.gain({Angle::degrees(10), Angle::degrees(5)}).value();
    };
    const double whole = gain_with("scale = 1");
    EXPECT_LT(whole, -5);
    EXPECT_NEAR(gain_with("scale = 0.5"), whole / 2, 1e-12);
    EXPECT_EQ(gain_with("scale = 0"), 0);
    EXPECT_EQ(gain_with("enabled = false"), 0);
}

TEST(SceneAssembly, MissingAndDamagedFilesAreNamed) {
    const test::TemporaryFolder folder;
    const auto missing = with_scene("[scene]\nbuildings = \"/no/such/city.obj\"");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_THAT(missing.error().message, HasSubstr("/no/such/city.obj"));
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nf 1 2 3\n";
    const auto damaged = with_scene("[scene]\nbuildings = \"" + (folder / "bad.obj").string() + "\"");
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().code, ErrorCode::input);
    EXPECT_THAT(damaged.error().message, HasSubstr("bad.obj"));
}

/// A roof of 20 m about a place of a reference system, as CityGML.
std::string roof_of(std::string_view system, double east, double north) {
    return fmt::format(
        "<CityModel><Envelope srsName='{0}'/><Building><lod2MultiSurface><Polygon><exterior><LinearRing><posList>"
        "{1} {3} 5 {2} {3} 5 {2} {4} 5 {1} {4} 5 {1} {3} 5</posList></LinearRing></exterior></Polygon>"
        "</lod2MultiSurface></Building></CityModel>",
        system, east - 10, east + 10, north - 10, north + 10);
}

TEST(SceneAssembly, ACityOfAnotherPlaceOrOfNoneIsRefused) {
    const test::TemporaryFolder folder;
    const auto refused = [&](std::string_view system, double east, double north, const std::string& keys = "") {
        std::ofstream(folder / "town.gml") << roof_of(system, east, north);
        const auto assembly = with_scene(
            fmt::format("[scene]\nbuildings = \"{}\"\n{}[trajectory]\nkind = \"fixed\"\nat = [52.01, 4.36, 50]\n",
                        (folder / "town.gml").string(), keys));
        return assembly ? std::string() : assembly.error().message;
    };
    EXPECT_EQ(refused("EPSG:28992", 84878, 447586), "") << "at the start of the run";
    EXPECT_THAT(refused("EPSG:25832", 691603, 5334780),
                AllOf(HasSubstr("town.gml: EPSG:25832: lies at 48.1374, 11.5755"),
                      HasSubstr("from the start of the run"), HasSubstr("set scene.file_crs")));
    EXPECT_THAT(refused("EPSG:99999", 84878, 447586),
                AllOf(HasSubstr("town.gml: EPSG:99999: is no reference system"), HasSubstr("set scene.file_crs"),
                      HasSubstr("scene.origin")));
    EXPECT_THAT(refused("", 84878, 447586),
                HasSubstr("town.gml: unnamed: names no reference system; set scene.file_crs"));
    EXPECT_EQ(refused("EPSG:99999", 84878, 447586, "file_crs = \"EPSG:28992\"\n"), "");
    EXPECT_EQ(refused("EPSG:99999", 84878, 447586, "origin = [52.01, 4.36, 45]\n"), "");
    EXPECT_EQ(refused("", 84878, 447586, "file_crs = \"local\"\n"), "");
}

TEST(SceneAssembly, AnAntennaFarBelowOrAboveTheSceneIsAWarning) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << "v 0 0 503\nv 50 0 503\nv 0 0 523\nf 1 2 3\n";
    const auto warnings = [&](double height) {
        const auto assembly =
            with_scene(fmt::format("[scene]\nbuildings = \"{}\"\norigin = [48, 11, 0]\n[trajectory]\n"
                                   "kind = \"fixed\"\nat = [48, 11, {:.1f}]\n",
                                   (folder / "a.obj").string(), height));
        EXPECT_TRUE(assembly) << assembly.error().message;
        return assembly ? assembly->warnings : std::vector<std::string>();
    };
    EXPECT_THAT(warnings(0), Contains(HasSubstr("503 m below the lowest point of the scene")));
    EXPECT_THAT(warnings(900), Contains(HasSubstr("377 m above the highest point of the scene")));
    for (const double height : {490, 510, 800})
        EXPECT_THAT(warnings(height), Not(Contains(HasSubstr("point of the scene"))));
}

constexpr const char* house_on_a_hill = R"({"type":"FeatureCollection","features":[{"type":"Feature",
    "properties":{"building":"yes","height":12},"geometry":{"type":"Polygon","coordinates":
    [[[11.0002,48],[11.0004,48],[11.0004,48.0002],[11.0002,48.0002],[11.0002,48]]]}}]})";

TEST(SceneAssembly, OutlinesStandOnTheTerrain) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "town.geojson") << house_on_a_hill;
    std::ofstream(folder / "hill.asc")
        << "ncols 2\nnrows 2\nxllcorner 10.99\nyllcorner 47.99\ncellsize 0.01\n542 542\n542 542\n";
    const std::string town = fmt::format(
        "[scene]\nbuildings = \"{}\"\nterrain = \"{}\"\norigin = [48, 11, 510]\n"
        "[trajectory]\nkind = \"fixed\"\nat = [48, 11, 543.5]\n",
        (folder / "town.geojson").string(), (folder / "hill.asc").string());
    const auto assembly = with_scene(town);
    ASSERT_TRUE(assembly) << assembly.error().message;
    const UrbanScene& scene = *assembly->scene.scene;
    EXPECT_NEAR(scene.top_at(22, 10).value(), 44, 0.05);
    EXPECT_NEAR(scene.ground_at(0, 0).value(), 32, 0.05);
    EXPECT_NEAR(scene.statistics().lowest.z(), 32, 0.2) << "no wall begins at the origin's height";
    const auto written_over = with_scene(town + "[[receiver]]\nport = \"file:" + (folder / "hill.asc").string() + "\"");
    ASSERT_FALSE(written_over);
    EXPECT_THAT(written_over.error().message, HasSubstr("this file is read, too, and would be lost"));
}

// A check opens no source.
Result<Assembly> checked_live(const std::string& text, const std::string& at = "") {
    RunMode mode = scene_mode();
    mode.only_checked = true;
    return assemble(
        emulator_scenario("[trajectory]\nkind = \"live\"\nsource = \"udp-json:29990\"\n" + at + "[scene]\n" + text),
        emulator_data(), mode);
}

TEST(SceneAssembly, ALiveVehicleThatStartsAnywhereNeedsAnOrigin) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << "v 0 0 0\nv 50 0 0\nv 0 0 20\nf 1 2 3\n";
    std::ofstream(folder / "town.geojson") << house_on_a_hill;
    const auto refused = [](const std::string& text) {
        const auto assembly = checked_live(text);
        EXPECT_FALSE(assembly) << text;
        return assembly ? "" : assembly.error().message;
    };
    EXPECT_THAT(refused("buildings = \"demo\"\n"),
                HasSubstr("test.toml:4:1: scene.origin: is missing; demo does not say where it lies"));
    EXPECT_THAT(refused("buildings = \"" + (folder / "a.obj").string() + "\"\n"),
                HasSubstr("a.obj does not say where it lies"));
    EXPECT_THAT(refused("buildings = \"" + (folder / "town.geojson").string() + "\"\n"),
                HasSubstr("town.geojson does not say how high its ground lies"));
    const auto placed = checked_live("buildings = \"demo\"\norigin = [47.4, 8.5, 400]\n");
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_NEAR(placed->scene.scene->frame().origin().latitude.deg(), 47.4, 1e-12);
    EXPECT_THAT(placed->warnings, Not(Contains(HasSubstr("the antenna starts"))));
    const auto known = checked_live("buildings = \"demo\"\n", "at = [48, 11, 500]\n");
    ASSERT_TRUE(known) << known.error().message;
    EXPECT_NEAR(known->scene.scene->frame().origin().height.above_ellipsoid.value(), 498.5, 1e-9);
}

TEST(SceneAssembly, WhatLiesOnTheEarthStaysThereForALiveVehicle) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "town.geojson") << house_on_a_hill;
    std::ofstream(folder / "hill.asc")
        << "ncols 2\nnrows 2\nxllcorner 10.99\nyllcorner 47.99\ncellsize 0.01\n542 542\n542 542\n";
    const auto assembly = checked_live(fmt::format("buildings = \"{}\"\nterrain = \"{}\"\n",
                                                   (folder / "town.geojson").string(), (folder / "hill.asc").string()));
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_NEAR(assembly->scene.scene->frame().origin().latitude.deg(), 48.0001, 1e-4);
    EXPECT_NEAR(assembly->scene.scene->frame().origin().longitude.deg(), 11.0003, 1e-4);
    EXPECT_THAT(assembly->warnings, Not(Contains(HasSubstr("the antenna starts"))));
}

TEST(SceneAssembly, AFleetHasItsSceneWhereTheFirstReceiverStarts) {
    const std::string fleet =
        "[[receiver]]\n[receiver.trajectory]\nkind = \"fixed\"\nat = [47.4, 8.5, 500]\n"
        "[[receiver]]\n[receiver.trajectory]\nkind = \"fixed\"\nat = [47.4, 8.501, 500]\n";
    const auto assembly = with_scene(demo_text + fleet);
    ASSERT_TRUE(assembly) << assembly.error().message;
    EXPECT_NEAR(assembly->scene.scene->frame().origin().latitude.deg(), 47.4, 1e-12);
    EXPECT_THAT(assembly->warnings, Not(Contains(HasSubstr("away from the scene"))));
    // Whoever has no way of its own rides on the scenario's.
    const auto mixed = with_scene(demo_text + fleet + "[[receiver]]\n");
    ASSERT_TRUE(mixed) << mixed.error().message;
    EXPECT_NEAR(mixed->scene.scene->frame().origin().latitude.deg(), FixedSettings().at.latitude.deg(), 1e-12);
}

TEST(SceneAssembly, TheDigestCoversTheFiles) {
    const test::TemporaryFolder folder;
    const auto digest = [&](const char* top) {
        std::ofstream(folder / "a.obj") << "v 0 0 0\nv 50 0 0\nv 0 0 " << top << "\nf 1 2 3\n";
        const auto assembly = with_scene("[scene]\nbuildings = \"" + (folder / "a.obj").string() + "\"");
        EXPECT_TRUE(assembly) << assembly.error().message;
        return assembly ? assembly->digest : "";
    };
    const std::string first = digest("20");
    EXPECT_EQ(digest("20"), first);
    EXPECT_NE(digest("21"), first);
}

TEST(SceneAssembly, TheSummaryTellsOfTheScene) {
    const Scenario scenario = emulator_scenario(demo_text);
    const auto assembly = assemble(scenario, emulator_data(), scene_mode());
    ASSERT_TRUE(assembly) << assembly.error().message;
    const std::string summary = run_summary(scenario, *assembly, "test");
    for (const char* part : {"\"scene\"", "\"triangles\"", "\"path_search\"", "\"rays_per_epoch\""})
        EXPECT_THAT(summary, HasSubstr(part));
}

}  // namespace
}  // namespace skyloop
