// Keys of what stands around the antenna: its channel, and [[surroundings]] along the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenario_text.hpp"
#include "world/propagation/surroundings.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::HasSubstr;

ModernSettings modern_with(const std::string& keys) { return scenario_of(keys).model.modern; }

// A key of the channel beside an environment, without which none of them acts.
double channel_number(const std::string& key, const std::string& value, double (*found)(const ChannelParameters&)) {
    const ModernSettings read = modern_with("[model.modern.channel]\nenvironment = \"urban\"\n" + key + " = " + value);
    EXPECT_TRUE(read.idle_keys.empty()) << key;
    EXPECT_EQ(modern_with("[model.modern.channel]\n" + key + " = " + value).idle_keys.size(), 1u) << key;
    return found(read.propagation.channel_model);
}

TEST(SurroundingsKeys, OfTheChannel) {
    using P = const ChannelParameters&;
    EXPECT_EQ(channel_number("distance_scale", "2.5", [](P p) { return p.distance_scale; }), 2.5);
    EXPECT_EQ(channel_number("bad_odds", "2.5", [](P p) { return p.bad_odds; }), 2.5);
    EXPECT_EQ(channel_number("good_loss_db", "2.5", [](P p) { return p.good_loss.value(); }), 2.5);
    EXPECT_EQ(channel_number("bad_loss_db", "2.5", [](P p) { return p.bad_loss.value(); }), 2.5);
    EXPECT_EQ(channel_number("shadowing_scale", "2.5", [](P p) { return p.shadowing_scale; }), 2.5);
    EXPECT_EQ(channel_number("diffuse_db", "2.5", [](P p) { return p.diffuse.value(); }), 2.5);
    EXPECT_NEAR(channel_number("reach_deg", "25", [](P p) { return p.reach.deg(); }), 25, 1e-12);
    EXPECT_EQ(channel_number("creep_mps", "0.25", [](P p) { return p.creep.value(); }), 0.25);
    EXPECT_EQ(channel_number("beat_hz", "2.5", [](P p) { return p.beat.value(); }), 2.5);
    EXPECT_EQ(channel_number("averaging_s", "2.5", [](P p) { return p.averaging.value(); }), 2.5);
    EXPECT_EQ(channel_number("echo_delay_m", "2.5", [](P p) { return p.echo_delay.value(); }), 2.5);
    EXPECT_EQ(channel_number("echo_length_m", "2.5", [](P p) { return p.echo_length.value(); }), 2.5);
    EXPECT_NEAR(channel_number("wall_deg", "25", [](P p) { return p.wall.deg(); }), 25, 1e-12);
    EXPECT_NEAR(channel_number("wall_spread_deg", "25", [](P p) { return p.wall_spread.deg(); }), 25, 1e-12);
    EXPECT_NEAR(channel_number("street_deg", "25", [](P p) { return p.street->deg(); }), 25, 1e-12);
    EXPECT_EQ(channel_number("roof_db", "2.5", [](P p) { return p.roof.value(); }), 2.5);
}

TEST(SurroundingsKeys, ACarHasARoofWhereThereIsAChannel) {
    const ModernSettings car = modern_with("[model.modern]\nsurroundings = \"urban\"\ncar = true");
    EXPECT_GT(car.propagation.channel_model.roof, Decibels(0));
    EXPECT_TRUE(car.idle_keys.empty());
    EXPECT_EQ(modern_with("[model.modern]\nsurroundings = \"urban\"").propagation.channel_model.roof, Decibels(0));
    EXPECT_EQ(modern_with("[model.modern]\ncar = true").idle_keys.size(), 1u);
}

TEST(SurroundingsKeys, AnOpenSkyHasNoChannel) {
    EXPECT_FALSE(modern_with("").propagation.channel_model.environment);
    EXPECT_TRUE(modern_with("[model.modern]\nsurroundings = \"forest\"").propagation.channel_model.environment);
    EXPECT_FALSE(modern_with("[model.modern]\nsurroundings = \"forest\"\nchannel = { environment = \"none\" }")
                     .propagation.channel_model.environment);
}

const SurroundingsStretch& only_stretch(const ModernSettings& settings) {
    EXPECT_EQ(settings.propagation.stretches.size(), 1u);
    return settings.propagation.stretches.front();
}

TEST(SurroundingsKeys, AlongTheWay) {
    const ModernSettings read = modern_with(
        "[[surroundings]]\nkind = \"forest\"\nfrom_m = 100\nto_m = 250\nramp_m = 5\nchannel = { bad_odds = 7 }");
    const SurroundingsStretch& stretch = only_stretch(read);
    EXPECT_EQ(stretch.channel.environment, P681Environment::wooded);
    EXPECT_EQ(stretch.channel.bad_odds, 7);
    EXPECT_EQ(stretch.ramp, 5);
    const auto& way = std::get<StretchOfWay>(stretch.extent);
    EXPECT_EQ(way.from, Metres(100));
    EXPECT_EQ(way.to, Metres(250));
    EXPECT_FALSE(read.propagation.channel_model.environment);
}

TEST(SurroundingsKeys, OverTimeAndToTheEnd) {
    const ModernSettings read = modern_with(
        "[[surroundings]]\nkind = \"tunnel\"\nfrom_s = 30\nramp_s = 1\n"
        "channel = { cover_db = 30, opening_side_m = 3, opening_height_m = 2 }");
    const SurroundingsStretch& stretch = only_stretch(read);
    EXPECT_FALSE(stretch.channel.environment);
    EXPECT_EQ(stretch.channel.cover, Decibels(30));
    EXPECT_EQ(stretch.channel.opening_side, Metres(3));
    EXPECT_EQ(stretch.channel.opening_height, Metres(2));
    const auto& time = std::get<StretchOfTime>(stretch.extent);
    EXPECT_EQ(time.from, Seconds(30));
    EXPECT_FALSE(std::isfinite(time.to.value()));
    EXPECT_EQ(stretch.ramp, 1);
}

TEST(SurroundingsKeys, InsideAPolygon) {
    const ModernSettings read =
        modern_with("[[surroundings]]\nkind = \"urban\"\ninside = [[48.1, 11.5], [48.2, 11.5], [48.2, 11.7]]");
    EXPECT_EQ(std::get<StretchOfPlace>(only_stretch(read).extent).polygons.front().outer().size(), 3u);
    EXPECT_EQ(only_stretch(read).ramp, 20);
}

// A wood around a lake beside houses: a stretch for each word, woods before lakes.
TEST(SurroundingsKeys, ByTheUseOfLand) {
    const std::string path = testing::TempDir() + "land_use.osm";
    std::ofstream(path) << R"(<osm version="0.6">
<node id="1" lat="50" lon="10"/><node id="2" lat="50" lon="10.001"/><node id="3" lat="50.001" lon="10.001"/>
<node id="4" lat="50.001" lon="10"/><node id="5" lat="50.0002" lon="10.0002"/><node id="6" lat="50.0002" lon="10.0007"/>
<node id="7" lat="50.0007" lon="10.0007"/><node id="8" lat="50.0007" lon="10.0002"/><node id="9" lat="50.002" lon="10"/>
<way id="1"><nd ref="5"/><nd ref="6"/><nd ref="7"/><nd ref="8"/><nd ref="5"/><tag k="natural" v="water"/></way>
<way id="2"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="landuse" v="forest"/></way>
<way id="3"><nd ref="4"/><nd ref="3"/><nd ref="9"/><nd ref="4"/><tag k="landuse" v="residential"/></way>
<way id="4"><nd ref="4"/><nd ref="3"/><nd ref="77"/><nd ref="4"/><tag k="landuse" v="meadow"/></way></osm>)";
    const Scenario scenario = scenario_of("[[surroundings]]\nland_use = \"" + path + "\"\nramp_m = 7");
    const ModernSettings& read = scenario.model.modern;
    ASSERT_EQ(scenario.warnings.size(), 1u);
    EXPECT_THAT(scenario.warnings[0],
                HasSubstr("test.toml:2:12: surroundings.land_use: 1 of 4 areas end outside of the file: left out"));
    ASSERT_EQ(read.tables, std::vector<std::filesystem::path>{path});
    const auto& stretches = read.propagation.stretches;
    ASSERT_EQ(stretches.size(), 3u);
    EXPECT_EQ(stretches[0].channel.environment, channel_of(Surroundings::residential).environment);
    EXPECT_EQ(stretches[1].channel.environment, P681Environment::wooded);
    EXPECT_FALSE(stretches[2].channel.environment);
    EXPECT_EQ(stretches[2].ramp, 7);
    const auto& lake = std::get<StretchOfPlace>(stretches[2].extent).polygons;
    ASSERT_EQ(lake.size(), 1u);
    ASSERT_EQ(lake[0].outer().size(), 4u);
    EXPECT_NEAR(lake[0].outer()[1].longitude.deg(), 10.0007, 1e-9);
    EXPECT_NEAR(lake[0].outer()[2].latitude.deg(), 50.0007, 1e-9);
}

TEST(SurroundingsKeys, SayWhatIsWrong) {
    const auto wrong = [](const std::string& keys) { return mistakes_of("[[surroundings]]\n" + keys); };
    EXPECT_THAT(wrong("kind = \"forrest\"\nto_m = 5"),
                HasSubstr("test.toml:2:8: surroundings.kind: is 'forrest'; expected one of "
                          "open-sky rural"));
    EXPECT_THAT(wrong("kind = \"forrest\"\nto_m = 5"), HasSubstr("'forest'"));
    EXPECT_THAT(wrong("to_m = 5"), HasSubstr("has neither kind nor land_use; expected what is around the antenna"));
    EXPECT_THAT(
        wrong("land_use = \"town.geojson\""),
        HasSubstr("test.toml:2:12: surroundings.land_use: town.geojson: is no file of OpenStreetMap by its name"));
    EXPECT_THAT(wrong("land_use = \"missing.osm\""), HasSubstr("missing.osm"));
    EXPECT_EQ(wrong("kind = \"urban\"\nland_use = \"missing.osm\"\nto_m = 5"),
              "test.toml:2:8: surroundings.kind: stands beside land_use; expected one of the two\n"
              "test.toml:3:12: surroundings.land_use: missing.osm: No such file or directory\n"
              "test.toml:4:8: surroundings.to_m: stands beside land_use; expected one of the two");
    EXPECT_THAT(wrong("kind = \"urban\""), HasSubstr("has neither from_m, to_m, from_s, to_s nor inside"));
    EXPECT_THAT(wrong("kind = \"urban\"\nfrom_m = 9\nto_m = 5"),
                HasSubstr("test.toml:4:8: surroundings.to_m: is 5; expected more than 9, where they begin"));
    EXPECT_THAT(wrong("kind = \"urban\"\nfrom_m = 9\nto_s = 5"), HasSubstr("expected one of the two"));
    EXPECT_THAT(wrong("kind = \"urban\"\ninside = [[48, 11], [49, 11]]"),
                HasSubstr("holds 4 numbers; expected at least three pairs"));
    EXPECT_THAT(wrong("kind = \"urban\"\ninside = [[48, 11], [49, 12], [49, 11], [48, 12]]"),
                HasSubstr("has edges that cross"));
    EXPECT_THAT(mistakes_of("[model]\nname = \"baseline\"\n[[surroundings]]\nkind = \"urban\"\nto_m = 5"),
                HasSubstr("surroundings: have no effect on a sensor model"));
}

TEST(SurroundingsKeys, ARampOfTheOtherUnitIsIdle) {
    EXPECT_EQ(modern_with("[[surroundings]]\nkind = \"urban\"\nto_s = 5\nramp_m = 3").idle_keys.size(), 1u);
    EXPECT_EQ(modern_with("[[surroundings]]\nkind = \"urban\"\nto_m = 5\nramp_s = 3").idle_keys.size(), 1u);
}

}  // namespace
}  // namespace skyloop
