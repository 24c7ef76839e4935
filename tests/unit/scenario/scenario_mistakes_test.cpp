// Every type of mistake in a scenario file, with its place and what was expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ScenarioMistakes, WrongTypesSayWhatWasFoundAndExpected) {
    EXPECT_EQ(mistakes_of("[run]\nduration_s = \"10\""),
              "test.toml:2:14: run.duration_s: is a text; expected a number above 0, up to 3162240000");
    EXPECT_EQ(mistakes_of("[run]\nspeed = true"),
              "test.toml:2:9: run.speed: is true or false; expected a number from 0.001 to 1000000");
    EXPECT_EQ(mistakes_of("[run]\nseed = 1.5"),
              "test.toml:2:8: run.seed: is a number; expected a whole number of 0 or more");
    EXPECT_EQ(mistakes_of("[sky]\nrebase_navigation = 1"),
              "test.toml:2:21: sky.rebase_navigation: is a whole number; expected true or false");
    EXPECT_EQ(mistakes_of("[[receiver]]\nboard = 8"),
              "test.toml:2:9: receiver.board: is a whole number; expected a text in quotes");
    EXPECT_EQ(mistakes_of("[[receiver]]\nsentences = \"RMC\""),
              "test.toml:2:13: receiver.sentences: is a text; expected a list of some of RMC VTG GGA GNS GSA GSV GLL "
              "GST ZDA GBS DTM GRS VLW THS HDT HDG ROT");
    EXPECT_EQ(mistakes_of("[[receiver]]\nport = [1]"),
              "test.toml:2:9: receiver.port: holds a whole number; expected a list of texts");
    EXPECT_EQ(mistakes_of("[model]\nname = 3"),
              "test.toml:2:8: model.name: is a whole number; expected a text in quotes")
        << "said once";
    EXPECT_EQ(mistakes_of("run = 3"), "test.toml:1:7: run: is a whole number; expected a table");
    EXPECT_EQ(mistakes_of("[receiver]\nboard = \"x\""),
              "test.toml:1:1: receiver: is a table; expected a list of tables, each headed [[receiver]]");
    EXPECT_EQ(mistakes_of("receiver = [1]"),
              "test.toml:1:12: receiver: holds a whole number; expected tables, each headed [[receiver]]");
    EXPECT_EQ(mistakes_of("[run]\nstart = 5"),
              "test.toml:2:9: run.start: is a whole number; expected a date with a time, in UTC");
    EXPECT_THAT(mistakes_of("[run]\nstart = 12:00:00"), HasSubstr("expected a date with a time"));
}

TEST(ScenarioMistakes, NumbersOutOfRangeSayTheRange) {
    EXPECT_EQ(mistakes_of("[sky]\nelevation_mask_deg = 91"),
              "test.toml:2:22: sky.elevation_mask_deg: is 91; expected a number from 0 to 90");
    EXPECT_EQ(mistakes_of("[run]\nseed = -1"), "test.toml:2:8: run.seed: is -1; expected a whole number of 0 or more");
    EXPECT_EQ(mistakes_of("[atmosphere]\ngravity_mps2 = 0"),
              "test.toml:2:16: atmosphere.gravity_mps2: is 0; expected a number from 0.1 to 100");
    EXPECT_THAT(mistakes_of("[frame]\norigin = [46, 30]\nreach_m = 0"), HasSubstr("is 0; expected a number above 0"));
    EXPECT_EQ(mistakes_of("[[receiver]]\nbaud = 100"),
              "test.toml:2:8: receiver.baud: is 100; expected a whole number from 300 to 4000000");
    EXPECT_THAT(mistakes_of("[run]\nduration_s = 0"), HasSubstr("run.duration_s: is 0; expected"));
    EXPECT_THAT(mistakes_of("[run]\nduration_s = 1e300"), HasSubstr("is 1e+300; expected"));
    EXPECT_THAT(mistakes_of("[run]\nspeed = 0"), HasSubstr("is 0; expected a number from 0.001"));
}

TEST(ScenarioMistakes, KeysOfOsnmaChangeOnce) {
    EXPECT_EQ(
        mistakes_of("[sky]\nosnma = true\nosnma_new_key_s = 60\nosnma_alert_s = 90"),
        "test.toml:4:17: sky.osnma_alert_s: is there beside osnma_new_key_s; expected one change of OSNMA's keys");
    const auto alerted = scenario_of("[sky]\nosnma = true\nosnma_alert_s = 90");
    EXPECT_EQ(alerted.sky.osnma_events.alert, Seconds(90));
    EXPECT_FALSE(alerted.sky.osnma_events.new_key);
    EXPECT_EQ(scenario_of("[sky]\nosnma = true\nosnma_revoked_chain_s = 5").sky.osnma_events.revoked_chain, Seconds(5));
    EXPECT_EQ(scenario_of("[sky]\nosnma = true\nosnma_revoked_key_s = 5").sky.osnma_events.revoked_key, Seconds(5));
    EXPECT_EQ(scenario_of("[sky]\nosnma = true\nosnma_new_chain_s = 5").sky.osnma_events.new_chain, Seconds(5));
}

TEST(ScenarioMistakes, NanAndInfinityAreNoNumbers) {
    EXPECT_THAT(mistakes_of("[sky]\nelevation_mask_deg = nan"), HasSubstr("is nan; expected a number from 0 to 90"));
    EXPECT_THAT(mistakes_of("[run]\nduration_s = inf"), HasSubstr("is inf; expected"));
    EXPECT_THAT(mistakes_of("[model.baseline]\nsnr_cutoff_dbhz = -inf"), HasSubstr("is -inf; expected"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"fixed\"\nat = [nan, 0, 0]"),
                HasSubstr("trajectory.at: holds nan; expected a list of 3 numbers"));
}

TEST(ScenarioMistakes, PlacesSayWhatIsWrongWithThem) {
    const auto place = [](const std::string& at) { return mistakes_of("[trajectory]\nkind = \"fixed\"\nat = " + at); };
    EXPECT_EQ(place("[91, 0, 0]"), "test.toml:3:6: trajectory.at: latitude is 91; expected -90 to 90 degrees");
    EXPECT_THAT(place("[0, 361, 0]"), HasSubstr("longitude is 361; expected -360 to 360 degrees"));
    EXPECT_THAT(place("[0, 0, 1e8]"), HasSubstr("height is 100000000; expected metres above the ellipsoid"));
    EXPECT_THAT(place("[0, 0, -1e5]"), HasSubstr("height is -100000"));
    EXPECT_THAT(place("[1]"), HasSubstr("has 1 numbers; expected latitude and longitude, or both and a height"));
    EXPECT_THAT(place("[1, 2, 3, 4]"), HasSubstr("has 4 numbers; expected latitude and longitude"));
    EXPECT_THAT(place("[1, \"2\", 3]"), HasSubstr("holds a text; expected a list of 3 numbers"));
    EXPECT_THAT(place("46.5"), HasSubstr("is a number; expected a list of 3 numbers"));
}

TEST(ScenarioMistakes, UnknownKeysSuggestTheNearestKnown) {
    EXPECT_EQ(mistakes_of("[run]\nsede = 1"), "test.toml:2:1: run.sede: unknown key; did you mean 'seed'?");
    EXPECT_EQ(mistakes_of("[trajectry]"), "test.toml:1:2: trajectry: unknown key; did you mean 'trajectory'?");
    EXPECT_EQ(mistakes_of("[model.basline]"), "test.toml:1:8: model.basline: unknown key; did you mean 'baseline'?");
    EXPECT_EQ(mistakes_of("[[atmosphere.cloud]]\nkind = \"fog\"\nbase = 3"),
              "test.toml:3:1: atmosphere.cloud.base: unknown key; did you mean 'base_m'?");
    EXPECT_EQ(mistakes_of("xyzzy = 1"), "test.toml:1:1: xyzzy: unknown key");
    // A key is known only where it belongs.
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"fixed\"\nat = [1, 2]\nradius_m = 5"),
                HasSubstr("test.toml:4:1: trajectory.radius_m: unknown key"));
    EXPECT_THAT(mistakes_of("[frame]\norigin = [1, 2]\n[trajectory]\nkind = \"fixed\"\nat_levl = [1, 2, 3]"),
                HasSubstr("did you mean 'at_level'?"));
}

TEST(ScenarioMistakes, UnknownWordsSuggestTheNearestKnown) {
    EXPECT_EQ(mistakes_of("[model]\nname = \"basline\""),
              "test.toml:2:8: model.name: is 'basline'; expected one of modern ideal constant-sigma satellite-count "
              "whole-path refraction baseline; did you mean 'baseline'?");
    EXPECT_EQ(mistakes_of("[sky]\nephemeris_rule = \"nearst\""),
              "test.toml:2:18: sky.ephemeris_rule: is 'nearst'; expected one of forward nearest; did you mean "
              "'nearest'?");
    EXPECT_EQ(mistakes_of("[sky]\nconstellations = [\"gps\", \"galilo\"]"),
              "test.toml:2:26: sky.constellations: holds 'galilo'; expected a list of some of gps sbas galileo beidou "
              "qzss glonass navic; did you mean 'galileo'?");
    EXPECT_EQ(
        mistakes_of("[[receiver]]\nsentences = [\"RMC\", \"GGGA\"]"),
        "test.toml:2:21: receiver.sentences: holds 'GGGA'; expected a list of some of RMC VTG GGA GNS GSA GSV GLL "
        "GST ZDA GBS DTM GRS VLW THS HDT HDG ROT; did you mean 'GGA'?");
    EXPECT_THAT(mistakes_of("[atmosphere]\nenvironment = \"citty\""), HasSubstr("did you mean 'city'?"));
    EXPECT_THAT(mistakes_of("[[atmosphere.cloud]]\nkind = \"cumulos\""), HasSubstr("did you mean 'cumulus'?"));
    EXPECT_THAT(mistakes_of("[model]\nname = \"moderne\""), HasSubstr("did you mean 'modern'?"));
}

TEST(ScenarioMistakes, EmptyTextsAndListsAreNotTakenForNothing) {
    EXPECT_THAT(mistakes_of("[model]\nname = \"\""), HasSubstr("model.name: is ''; expected one of"));
    EXPECT_THAT(mistakes_of("[atmosphere]\nrain_model = \"\""), HasSubstr("is ''; expected one of p838 as_vapour"));
    EXPECT_THAT(mistakes_of("[run]\nstart = \"\""), HasSubstr("run.start: '' is not a UTC time"));
    EXPECT_THAT(mistakes_of("[sky]\nconstellations = []"), HasSubstr("is an empty list; expected a list of some of"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nsentences = []"),
                HasSubstr("is an empty list; expected a list of some of RMC"));
    EXPECT_EQ(mistakes_of("[trajectory]\nkind = \"file\"\npath = \"\""),
              "test.toml:3:8: trajectory.path: is empty; expected the path of a file");
    EXPECT_EQ(mistakes_of("[sky]\nnavigation = [\"a.24n\", \"\"]"),
              "test.toml:2:14: sky.navigation: is empty; expected the path of a file");
}

TEST(ScenarioMistakes, KeysThatExcludeEachOtherAreRefused) {
    EXPECT_EQ(mistakes_of("[atmosphere]\nenvironment = \"city\"\nenvironment_noise_db = 3"),
              "test.toml:3:24: atmosphere.environment_noise_db: stands beside environment; expected one of the two");
}

TEST(ScenarioMistakes, AFixedConcentrationNeedsItsNumber) {
    const std::string wanted = "without a number; expected fixed_concentration, too";
    const std::string all = "[atmosphere]\nconcentration = \"fixed\"\n", number = "fixed_concentration = 0.5\n";
    const std::string layer = "[[atmosphere.layer]]\ntop_m = 50\n";
    EXPECT_EQ(mistakes_of(all), "test.toml:2:17: atmosphere.concentration: is 'fixed' " + wanted);
    EXPECT_EQ(mistakes_of(all + layer), "test.toml:3:1: atmosphere.layer.concentration: is 'fixed' " + wanted);
    EXPECT_EQ(mistakes_of(layer + "concentration = \"fixed\""),
              "test.toml:3:17: atmosphere.layer.concentration: is 'fixed' " + wanted);
    EXPECT_EQ(scenario_of(layer + number).atmosphere.layers.front().concentration, ConcentrationMode::fixed);
    for (const std::string& sound : {all + number, all + number + layer, all + layer + number})
        EXPECT_TRUE(read_scenario(sound, "test.toml")) << sound;
}

TEST(ScenarioMistakes, ElectronContentOfMapsNeedsThem) {
    EXPECT_EQ(mistakes_of("[atmosphere]\ntec_source = \"ionex\""),
              "test.toml:2:14: atmosphere.tec_source: is ionex, but tec_maps names no file; expected an IONEX file");
    EXPECT_EQ(mistakes_of("[atmosphere]\ntec_maps = \"\""),
              "test.toml:2:12: atmosphere.tec_maps: is empty; expected the path of a file");
}

TEST(ScenarioMistakes, StartsThatAreNoUtcAreRefused) {
    EXPECT_THAT(mistakes_of("[run]\nstart = \"yesterday\""),
                AllOf(HasSubstr("test.toml:2:9: run.start: 'yesterday' is not a UTC time"), HasSubstr("or \"now\"")));
    EXPECT_THAT(mistakes_of("[run]\nstart = 1979-12-31T00:00:00Z"), HasSubstr("is not a UTC time"));
}

TEST(ScenarioMistakes, TablesThatContradictThemselvesAreRefused) {
    EXPECT_THAT(mistakes_of("[[atmosphere.layer]]\nbase_m = 100\ntop_m = 50"),
                StartsWith("test.toml:1:1: [atmosphere.layer] top_m is 50; expected more than base_m, 100"));
    EXPECT_THAT(mistakes_of("[[atmosphere.cloud]]\nbase_m = 100"), HasSubstr("[atmosphere.cloud] has no kind"));
    EXPECT_THAT(mistakes_of("[model.satellite-count]\nsigma_m = [1, 2, 3, 4, 5, -6]"),
                HasSubstr("has a negative number"));
    EXPECT_THAT(mistakes_of("[model.satellite-count]\nsigma_m = [1, 2, 3]"), HasSubstr("has 3 numbers; expected 6"));
}

TEST(ScenarioMistakes, FaultsAndCommandsNeedAKind) {
    for (const char* entry : {"[[fault]]", "[[command]]"})
        EXPECT_THAT(mistakes_of(entry), AllOf(HasSubstr("has no kind; expected one of"), Not(HasSubstr("unknown key"))))
            << entry;
}

TEST(ScenarioMistakes, AllAreToldInTheOrderOfTheFile) {
    EXPECT_EQ(mistakes_of(R"toml(bad = 1
[atmosphere]
rain_mm_h = -1
[sky]
elevation_mask_deg = 100
maks = 5
[run]
seed = "x"
speed = 0
)toml"),
              "test.toml:1:1: bad: unknown key\n"
              "test.toml:3:13: atmosphere.rain_mm_h: is -1; expected a number from 0 to 500\n"
              "test.toml:5:22: sky.elevation_mask_deg: is 100; expected a number from 0 to 90\n"
              "test.toml:6:1: sky.maks: unknown key\n"
              "test.toml:8:8: run.seed: is a text; expected a whole number of 0 or more\n"
              "test.toml:9:9: run.speed: is 0; expected a number from 0.001 to 1000000");
}

TEST(ScenarioMistakes, AMistakeIsOneLineThatCanBeRead) {
    EXPECT_EQ(mistakes_of("\"a\\nb\\u001b[31m\" = 1"), "test.toml:1:1: a\\x0ab\\x1b[31m: unknown key");
    const std::string longest = mistakes_of("[model]\nname = \"" + std::string(100000, 'x') + "\"");
    EXPECT_LT(longest.size(), 700U);
    EXPECT_THAT(longest, StartsWith("test.toml:2:8: model.name: is 'xxxx"));
}

TEST(ScenarioMistakes, WhatIsNoTomlHasItsPlaceToo) {
    EXPECT_THAT(mistakes_of("[run\nseed = 1"), StartsWith("test.toml:1:"));
    EXPECT_THAT(mistakes_of("[run]\nseed = \n"), StartsWith("test.toml:2:"));
    EXPECT_THAT(mistakes_of("[run]\nseed = 1\nseed = 2"), StartsWith("test.toml:3:"));
    EXPECT_THAT(mistakes_of(std::string_view("\x00\x01", 2)), StartsWith("test.toml:1:"));
    // The library's own words quote the line's end as it is.
    EXPECT_EQ(mistakes_of("a = tru\n"), "test.toml:1:8: Error while parsing boolean: expected 'true', saw 'tru\\x0a'");
    EXPECT_THAT(mistakes_of("a = \"\xff\xfe\""), StartsWith("test.toml:1:"));
}

std::string dotted(std::size_t parts) {
    std::string key = "a";
    while (--parts > 0)
        key += ".a";
    return key;
}

TEST(ScenarioMistakes, KeysTooDeepForTheStackAreRefused) {
    const std::string told = "the key has more than 256 parts; expected at most 256";
    EXPECT_EQ(mistakes_of("[" + dotted(200000) + "]"), "test.toml:1:513: " + told);
    EXPECT_EQ(mistakes_of("# x\n" + dotted(200000) + " = 1"), "test.toml:2:512: " + told);
    EXPECT_EQ(mistakes_of("a = {" + dotted(200) + " = [{" + dotted(200) + " = 1}]}"), "test.toml:1:523: " + told);
    EXPECT_EQ(mistakes_of(dotted(256) + " = 1.5\n[b]\n" + dotted(256) + " = [1.5]\n"),
              "test.toml:1:1: a: unknown key\ntest.toml:2:2: b: unknown key");
}

TEST(ScenarioMistakes, DotsOfTextsNumbersAndCommentsAreNoKeys) {
    const std::string dots(1000, '.');
    std::string numbers = "1.5";
    for (int i = 0; i < 1000; ++i)
        numbers += ", [1.5, 2.5]";
    for (const std::string& value :
         {'"' + dots + '"', "'" + dots + "'", "\"\"\"\n" + dots + R"(\"""""")", "'''\n" + dots + "''''",
          "[" + numbers + "]", "1 # " + dots, "{\"" + dots + "\" = 1.5}"})
        EXPECT_EQ(mistakes_of("xyzzy = " + value), "test.toml:1:1: xyzzy: unknown key");
}

}  // namespace
}  // namespace skyloop
