// [scene]: which buildings stand around, and how they are read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ScenarioScene, WithoutATableNothingStandsAround) {
    const SceneEntry scene = scenario_of("").scene;
    EXPECT_FALSE(scene.given());
    EXPECT_EQ(scene.reading.material, "concrete");
    EXPECT_FALSE(scene.reflections) << "the model decides";
    EXPECT_FALSE(scene.ground_reflects) << "the model decides";
}

TEST(ScenarioScene, EveryKeyLandsInItsField) {
    const SceneEntry scene = scenario_of(test::every_key_text).scene;
    EXPECT_TRUE(scene.given());
    EXPECT_THAT(scene.buildings, ElementsAre("folder/a.obj", "demo")) << "demo is no file";
    EXPECT_EQ(scene.terrain, "folder/hills.asc");
    ASSERT_TRUE(scene.reading.origin);
    EXPECT_NEAR(scene.reading.origin->latitude.deg(), 48.5, 1e-12);
    EXPECT_EQ(scene.reading.origin->height.above_ellipsoid, Metres(520));
    EXPECT_EQ(scene.reading.file_origin, Eigen::Vector3d(100, -2.5, 3e6));
    EXPECT_EQ(scene.reading.file_crs, "EPSG:25832+7837");
    ASSERT_TRUE(scene.reading.axes);
    EXPECT_THAT(scene.reading.axes->axis, ElementsAre(1, 0, 2));
    EXPECT_EQ(scene.reading.heights, CityHeights::sea_level);
    EXPECT_EQ(scene.reading.metres_per_unit, 0.01);
    EXPECT_EQ(scene.reading.material, "brick");
    EXPECT_EQ(scene.reading.default_height, 12);
    EXPECT_EQ(scene.reading.metres_per_level, 3.5);
    EXPECT_EQ(scene.reflections, 5);
    EXPECT_TRUE(scene.roofs_reflect);
    EXPECT_EQ(scene.ground_reflects, false);
    EXPECT_FALSE(scene.diffraction);
    EXPECT_EQ(scene.scattering, 0.25);
    EXPECT_FALSE(scene.foliage);
    EXPECT_EQ(scene.rays, 4096);
    EXPECT_EQ(scene.threads, 0);
    EXPECT_EQ(scene.memory_limit_mb, 100U);
    EXPECT_FALSE(scene.cache);
}

TEST(ScenarioScene, AFileMayStandAlone) {
    EXPECT_THAT(scenario_of("[scene]\nbuildings = \"x.osm\"").scene.buildings, ElementsAre("folder/x.osm"));
    EXPECT_TRUE(scenario_of("[scene]\nterrain = \"x.asc\"").scene.given());
}

TEST(ScenarioScene, MistakesAreToldWithTheirPlace) {
    EXPECT_THAT(mistakes_of("[scene]\n"), HasSubstr("has neither buildings nor terrain"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = 3"),
                StartsWith("test.toml:2:13: scene.buildings: is a whole number"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"\""), HasSubstr("scene.buildings: is an empty text"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\naxes = \"x,y\""),
                StartsWith("test.toml:3:8: scene.axes: "));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\naxes = \"\""), StartsWith("test.toml:3:8: scene.axes: "));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nfile_crs = \"EPSG:99999\""),
                AllOf(StartsWith("test.toml:3:12: scene.file_crs: 'EPSG:99999' is no reference system that PROJ "),
                      HasSubstr("; expected one such as EPSG:25832")));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nfile_crs = \"EPSG:4978\""),
                HasSubstr("scene.file_crs: 'EPSG:4978' is of another kind"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nmaterial = \"bricks\""), HasSubstr("did you mean 'brick'"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nreflections = 17"),
                HasSubstr("scene.reflections: is 17; expected a whole number from 1 to 16"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nreflectoins = 2"), HasSubstr("did you mean 'reflections'"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\norigin = [91, 0, 0]"), HasSubstr("latitude is 91"));
    EXPECT_THAT(mistakes_of("[scene]\nbuildings = \"demo\"\nfile_origin = [1, 2]"),
                HasSubstr("scene.file_origin: has 2 numbers; expected 3"));
}

}  // namespace
}  // namespace skyloop
