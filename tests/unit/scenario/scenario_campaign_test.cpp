#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/scenario/scenario_file.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string campaign_mistake(const std::string& text) {
    const auto scenario = read_scenario("[campaign]\n" + text, "c.toml");
    return scenario ? "none" : scenario.error().message;
}
std::string parameter_mistake(const std::string& text) {
    return campaign_mistake("design = \"random\"\nsamples = 2\n[[campaign.parameter]]\nkey = \"run.speed\"\n" + text);
}

TEST(ScenarioCampaign, ReadsEveryKey) {
    const auto scenario = read_scenario(R"(
[campaign]
name = "night"
seeds = 20
first_seed = 5
design = "latin_hypercube"
samples = 30
design_seed = 9
metrics = ["fix_share"]
[[campaign.parameter]]
key = "run.speed"
log_uniform = [0.1, 10]
[[campaign.parameter]]
key = "model.name"
values = ["ideal", "modern"]
[campaign.vehicle]
command = "true {pty}"
files = ["sitl.parm"]
timeout_s = 3
)",
                                        "c.toml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    const CampaignSettings& campaign = scenario->campaign.value();
    EXPECT_EQ(campaign.seed_count, 20U);
    EXPECT_EQ(campaign.first_seed, 5U);
    EXPECT_EQ(campaign.samples, 30U);
    EXPECT_EQ(std::get<LogUniformSpread>(campaign.parameters.at(0).spread).most, 10);
    EXPECT_EQ(std::get<0>(campaign.parameters.at(1).spread).at(1).shown, "modern");
    EXPECT_EQ(campaign.vehicle.value().timeout, Seconds(3));
    EXPECT_EQ(campaign.vehicle->files, std::vector<std::string>{"sitl.parm"});
    EXPECT_FALSE(read_scenario("", "c.toml")->campaign);
}

TEST(ScenarioCampaign, SaysWhereAMistakeIs) {
    EXPECT_THAT(campaign_mistake("seeds = 0\n"), StartsWith("c.toml:2:9: campaign.seeds: is 0; expected"));
    EXPECT_THAT(campaign_mistake("seeds = 2000000\n"), HasSubstr("expected a whole number from 1 to 1000000"));
    EXPECT_THAT(campaign_mistake("sample = 2\n"), HasSubstr("did you mean 'samples'"));
    EXPECT_THAT(campaign_mistake("seed_list = [1, 1]\n"), HasSubstr("holds 1 twice"));
    EXPECT_THAT(campaign_mistake("seeds = 2\nseed_list = [1]\n"), HasSubstr("expected one of the two"));
    EXPECT_THAT(campaign_mistake("samples = 3\n"), HasSubstr("is of designs that draw"));
    EXPECT_THAT(campaign_mistake("design = \"random\"\n"), HasSubstr("expected samples = their number"));
    EXPECT_THAT(campaign_mistake("[[campaign.parameter]]\nkey = \"run.speed\"\nuniform = [1, 2]\n"),
                HasSubstr("'run.speed' has no end of values"));
    EXPECT_EQ(campaign_mistake("[[campaign.parameter]]\nkey = \"run.duration_s\"\nvalues = [1, 2]\n"
                               "[[campaign.parameter]]\nkey = \"run.speed\"\nuniform = [1, 2]\n"),
              "c.toml:7:11: campaign.parameter.uniform: 'run.speed' has no end of values; expected values or whole in "
              "a grid, or another design")
        << "at the entry that is wrong";
    EXPECT_THAT(campaign_mistake("[campaign.vehicle]\ntimeout_s = 3\n"), HasSubstr("names no command"));
    EXPECT_THAT(campaign_mistake("[campaign.vehicle]\ncommand = ' '\n"), HasSubstr("command: is empty"));
    EXPECT_THAT(campaign_mistake("[campaign.vehicle]\ncommand = []\n"), HasSubstr("command: is a list"));
}

TEST(ScenarioCampaign, SaysWhatIsWrongWithAParameter) {
    EXPECT_EQ(parameter_mistake("uniform = [1, 2]\n"), "none");
    EXPECT_THAT(parameter_mistake(""), HasSubstr("says nothing of its values"));
    EXPECT_THAT(parameter_mistake("values = []\n"), HasSubstr("expected at least one"));
    EXPECT_THAT(parameter_mistake("values = [1, 1]\n"), HasSubstr("holds 1 twice"));
    EXPECT_THAT(parameter_mistake("values = [2, 2.0]\n"), HasSubstr("holds 2.0 twice"));
    EXPECT_THAT(parameter_mistake("values = [[1, 2], [1.0, 2]]\n"), HasSubstr("holds [1.0, 2] twice"));
    EXPECT_EQ(parameter_mistake("values = [2, 2.5, \"2\", [2], [[2]], true]\n"), "none");
    EXPECT_THAT(parameter_mistake("values = [{a = 1}]\n"), HasSubstr("holds a table"));
    EXPECT_THAT(parameter_mistake("values = [1]\nuniform = [1, 2]\n"), HasSubstr("stands beside values"));
    EXPECT_THAT(parameter_mistake("uniform = [2, 1]\n"), HasSubstr("expected the least and the greatest"));
    EXPECT_THAT(parameter_mistake("uniform = [nan, 1]\n"), HasSubstr("holds nan"));
    EXPECT_THAT(parameter_mistake("uniform = [-1.7e308, 1.7e308]\n"), HasSubstr("the least and the greatest"));
    EXPECT_THAT(parameter_mistake("log_uniform = [0, 1]\n"), HasSubstr("expected ends above 0"));
    EXPECT_THAT(parameter_mistake("normal = [0, 0]\n"), HasSubstr("expected one above 0"));
    EXPECT_THAT(parameter_mistake("whole = [0, 1.5]\n"), HasSubstr("expected whole ones"));
    EXPECT_THAT(parameter_mistake("whole = [0, 1]\n[[campaign.parameter]]\nkey = \"run.speed\"\nvalues = [1]\n"),
                HasSubstr("is that of another parameter too"));
    EXPECT_THAT(campaign_mistake("[[campaign.parameter]]\nkey = \"run.seed\"\nvalues = [1]\n"),
                HasSubstr("expected the seeds in"));
    EXPECT_THAT(campaign_mistake("[[campaign.parameter]]\nkey = \"campaign.seeds\"\nvalues = [1]\n"),
                HasSubstr("outside of [campaign]"));
}

constexpr const char* base_text = R"(
[run]
duration_s = 10 # a comment
[trajectory]
kind = "fixed"
at = [50, 10, 5]
[[fault]]
name = "first"
kind = "outage"
at_s = 1
for_s = 2
[[fault]]
kind = "receiver_silent"
at_s = 5
for_s = 2
[campaign]
seeds = 4
[[campaign.parameter]]
key = "fault.first.for_s"
values = [1]
)";

Result<Scenario> changed(const std::string& key, const std::string& value) {
    const auto values = parse_campaign_values(value);
    const std::vector<ScenarioChange> changes{{key, values->at(0)}};
    return read_scenario(base_text, "c.toml", changes);
}
std::string change_mistake(const std::string& key, const std::string& value) {
    const auto scenario = changed(key, value);
    return scenario ? "none" : scenario.error().message;
}

std::vector<std::string> parsed(const std::string& text) {
    const auto values = parse_campaign_values(text);
    if (!values) return {values.error().message};
    std::vector<std::string> shown;
    for (const CampaignValue& value : *values)
        shown.push_back(value.shown);
    return shown;
}

TEST(CampaignValues, CommasWithinQuotesAndBracketsPartNothing) {
    using testing::ElementsAre;
    EXPECT_THAT(parsed(R"(take off,"climb, then turn")"), ElementsAre("take off", "climb, then turn"));
    EXPECT_THAT(parsed(R"("a \" b, c",'d, e',f)"), ElementsAre("a \" b, c", "d, e", "f"));
    EXPECT_THAT(parsed("[1, 2],x"), ElementsAre("[1, 2]", "x"));
    EXPECT_THAT(parsed("[[1, 2], [3, 4]],[]"), testing::SizeIs(2));
    EXPECT_THAT(parsed("1.5,2"), ElementsAre("1.5", "2"));
    EXPECT_THAT(parsed("don't,do"), ElementsAre("don't", "do"));
    for (const char* open : {"x,\"open", "x,[1,2", "'open,x", "x,\"a\"b"})
        EXPECT_THAT(parsed(open).front(), HasSubstr("expected its quotes and brackets closed")) << open;
}

TEST(ScenarioChanges, ReachEveryKindOfPlace) {
    EXPECT_EQ(changed("run.duration_s", "30")->run.duration, Seconds(30));
    EXPECT_EQ(changed("run.speed", "2.5")->run.speed, 2.5);
    EXPECT_NEAR(changed("sky.elevation_mask_deg", "15")->sky.elevation_mask->deg(), 15, 1e-9);
    EXPECT_EQ(std::get<FixedSettings>(changed("trajectory.at.2", "77.5")->trajectory).at.height.above_ellipsoid,
              Metres(77.5));
    EXPECT_EQ(changed("model.name", "ideal")->model.sensor_model, ErrorModelKind::ideal);
    const auto end_of = [](const Scenario& scenario, std::size_t i) { return scenario.faults.at(i).when.length; };
    const auto base = read_scenario(base_text, "c.toml").value();
    for (const auto& [key, place] :
         {std::pair{"fault.first.for_s", 0}, {"fault.0.for_s", 0}, {"fault.receiver_silent.for_s", 1}}) {
        const auto scenario = changed(key, "7");
        ASSERT_TRUE(scenario) << key << scenario.error().message;
        EXPECT_NE(end_of(*scenario, static_cast<std::size_t>(place)), end_of(base, static_cast<std::size_t>(place)));
        EXPECT_EQ(end_of(*scenario, static_cast<std::size_t>(1 - place)),
                  end_of(base, static_cast<std::size_t>(1 - place)));
    }
}

TEST(ScenarioChanges, EntriesHaveTheNamesThatMessagesCallThemBy) {
    const std::string silent = "[[fault]]\nkind = \"receiver_silent\"\nfor_s = 1\n";
    const std::string text = "[[receiver]]\n[[receiver]]\nname = \"rear\"\n[[receiver]]\n" + silent +
                             "[[fault]]\nkind = \"outage\"\n" + silent;
    const auto changed_to = [&](const std::string& key, const std::string& value) {
        const std::vector<ScenarioChange> changes{{key, parse_campaign_values(value)->at(0)}};
        return read_scenario(text, "c.toml", changes);
    };
    const auto rates = changed_to("receiver.receiver2.rate_hz", "5");
    ASSERT_TRUE(rates) << rates.error().message;
    EXPECT_FALSE(rates->receivers.at(0).rate_hz);
    EXPECT_FALSE(rates->receivers.at(1).rate_hz);
    EXPECT_EQ(rates->receivers.at(2).rate_hz, 5);
    EXPECT_FALSE(changed_to("receiver.receiver1.rate_hz", "5")) << "that one is called rear";
    const auto second = changed_to("fault.receiver_silent 2.for_s", "7");
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->faults.at(0).when.length, Seconds(1));
    EXPECT_EQ(second->faults.at(2).when.length, Seconds(7));
    EXPECT_EQ(changed_to("fault.receiver_silent.for_s", "7")->faults.at(0).when.length, Seconds(7));
}

TEST(ScenarioChanges, AListThatIsNotThereIsNotMade) {
    const std::vector<ScenarioChange> changes{{"fault.gap.for_s", parse_campaign_values("2")->at(0)}};
    const auto scenario = read_scenario("[run]\nduration_s = 10\n", "c.toml", changes);
    ASSERT_FALSE(scenario);
    EXPECT_THAT(scenario.error().message,
                StartsWith("c.toml:1:1: 'fault.gap.for_s' leads to no key: the scenario has no fault.gap; expected"));
    EXPECT_THAT(scenario.error().message, Not(HasSubstr("expected a list of tables")));
}

TEST(ScenarioChanges, TheOneReceiverNeedsNoTable) {
    for (const char* key : {"receiver.0.rate_hz", "receiver.receiver0.rate_hz"}) {
        const auto changed = read_scenario("", "c.toml", std::vector{*parse_change(key + std::string("=5"))});
        ASSERT_TRUE(changed) << changed.error().message;
        ASSERT_EQ(changed->receivers.size(), 1U);
        EXPECT_EQ(changed->receivers[0].rate_hz, 5);
    }
    EXPECT_FALSE(read_scenario("", "c.toml", std::vector{*parse_change("receiver.1.rate_hz=5")}));
}

TEST(ScenarioChanges, AreReadFromTheCommandLine) {
    const auto value = [](std::string_view text) { return parse_change(text).value().value.toml; };
    EXPECT_EQ(parse_change("receiver.0.port=pty:/tmp/a=b")->key, "receiver.0.port");
    EXPECT_EQ(value("receiver.0.port=pty:/tmp/a=b"), "\"pty:/tmp/a=b\"");
    EXPECT_EQ(value("run.seed=7"), "7");
    EXPECT_EQ(value("run.seed=\"7\""), "\"7\"");
    EXPECT_EQ(value("trajectory.at=[47, 8, 400.5]"), "[47, 8, 400.5]");
    EXPECT_EQ(value("sky.rebase_navigation=true"), "true");
    EXPECT_EQ(value("run.start=2026-03-01T00:00:00Z"), "2026-03-01T00:00:00Z");
    for (const char* wrong : {"", "run.seed", "=7", "run.seed=", "run.seed=1,2", "trajectory.at=[47, 8"})
        EXPECT_EQ(parse_change(wrong).error().code, ErrorCode::usage) << wrong;
}

TEST(ScenarioChanges, AKeyTooDeepForTheStackLeadsToNone) {
    std::string key = "run";
    for (int i = 0; i < 200000; ++i)
        key += ".a";
    const std::vector<ScenarioChange> changes{{key, parse_campaign_values("2")->at(0)}};
    const auto scenario = read_scenario("[run]\nduration_s = 10\n", "c.toml", changes);
    ASSERT_FALSE(scenario);
    EXPECT_THAT(scenario.error().message, StartsWith("c.toml:1:1: 'run.a.a.a."));
    EXPECT_EQ(place_of_key("[" + key + "]", "run.seed"), "run.seed");
    EXPECT_EQ(place_of_parameter("[" + key + "]", "c.toml", "run.seed"), "c.toml");
}

TEST(ScenarioChanges, AWrongValueIsToldWhereTheFileChangesIt) {
    EXPECT_THAT(change_mistake("fault.first.for_s", "-4"), StartsWith("c.toml:19:7: fault.first.for_s: "));
    EXPECT_THAT(change_mistake("fault.first.for_s", "-4"), HasSubstr("; with fault.first.for_s = -4"));
    EXPECT_THAT(change_mistake("run.duration_s", "x"), StartsWith("c.toml:1:1: run.duration_s: is a text"));
    EXPECT_THAT(change_mistake("run.duratoin_s", "1"), HasSubstr("did you mean 'duration_s'"));
    EXPECT_THAT(change_mistake("fault.7.for_s", "1"), HasSubstr("leads to no key: the scenario has no fault.7; "));
    EXPECT_THAT(change_mistake("output.0.to", "\"x\""), HasSubstr("the scenario has no output.0; "));
    EXPECT_THAT(change_mistake("fault.0.foo", "1"), HasSubstr("fault.0.foo: unknown key"));
    EXPECT_THAT(change_mistake("fault.none.for_s", "1"), HasSubstr("leads to no key"));
    EXPECT_THAT(change_mistake("run.duration_s.x", "1"), HasSubstr("leads to no key"));
    EXPECT_THAT(change_mistake("run.", "1"), HasSubstr("leads to no key"));
    EXPECT_THAT(change_mistake("..", "1"), HasSubstr("leads to no key"));
    EXPECT_THAT(change_mistake("run", "1"), HasSubstr("is a whole number; expected a table"));
}

TEST(ScenarioChanges, AnOptionStandsBeforeItsMistake) {
    const auto mistake_of = [](ScenarioChange change, std::string_view text) {
        change.option = "--rate";
        const auto scenario = read_scenario(text, "c.toml", std::vector{change});
        return scenario ? "none" : scenario.error().message;
    };
    EXPECT_EQ(mistake_of(*parse_change("receiver.0.rate_hz=0"), ""),
              "--rate: is 0; expected a number from 0.01 to 100");
    EXPECT_EQ(mistake_of(*parse_change("receiver.0.rate_hz=often"), "[[receiver]]\nbaud = 9600\n"),
              "--rate: is a text; expected a number from 0.01 to 100");
    EXPECT_EQ(mistake_of(*parse_change("receiver.0.rate_hz=[5]"), ""),
              "--rate: is a list; expected a number from 0.01 to 100");
    EXPECT_THAT(mistake_of(*parse_change("receiver.0.rate_zh=5"), ""),
                StartsWith("--rate: unknown key; did you mean 'rate_hz'?"));
    EXPECT_THAT(mistake_of(*parse_change("receiver.3.rate_hz=5"), ""),
                StartsWith("--rate: leads to no key: the scenario has no receiver.3"));
    EXPECT_THAT(mistake_of(*parse_change("receiver.0.rate_hz=5"), "[run]\nsede = 3\n"),
                StartsWith("c.toml:2:1: run.sede: unknown key"));
}

TEST(ScenarioChanges, AMistakeIsToldOnceAndAtTheParameterThatMadeIt) {
    const auto mistake_of = [](const std::string& key) {
        const std::string text =
            "[run]\nduration_s = 1\n[campaign]\n[[campaign.parameter]]\nkey = \"run.speed\"\n"
            "values = [1]\n[[campaign.parameter]]\nkey = \"" +
            key + "\"\nvalues = [1]\n";
        const auto one = parse_campaign_values("1")->at(0);
        const std::vector<ScenarioChange> changes{{"run.speed", one}, {key, one}};
        const auto scenario = read_scenario(text, "c.toml", changes);
        return scenario ? "none" : scenario.error().message;
    };
    EXPECT_THAT(mistake_of("trajectory.at.2"), StartsWith("c.toml:8:7: 'trajectory.at.2' leads to no key: "));
    EXPECT_THAT(mistake_of("trajectory.at.2"), Not(HasSubstr("\n")));
    EXPECT_THAT(mistake_of("foo.bar"), StartsWith("c.toml:8:7: foo: unknown key"));
    EXPECT_THAT(mistake_of("trajectory.smooth"), HasSubstr("c.toml:8:7: [trajectory] has no kind"));
}

TEST(ScenarioContent, IsTheSameWhateverTheLayout) {
    const auto keys = [](const std::string& text) { return scenario_content(text, "c.toml").value().keys; };
    EXPECT_EQ(keys("[run]\nspeed=1.50\nduration_s = 7 # long\n"), keys("run = {duration_s=7, speed=1.5}"));
    EXPECT_EQ(keys("[run]\nseed = 3\n[campaign]\nseeds = 3\n"), keys("[run]\n"));
    EXPECT_NE(keys("[run]\nduration_s = 7\n"), keys("[run]\nduration_s = 7.0\n"));
    EXPECT_NE(keys("a = [\"x\", \"y\"]"), keys("a = [\"x\"]"));
    EXPECT_THAT(keys("a = \"x\\nb = 1\""), Not(HasSubstr("\nb = 1")));
    EXPECT_THAT(scenario_content("a = ", "c.toml").error().message, StartsWith("c.toml:1:"));
}

}  // namespace
}  // namespace skyloop
