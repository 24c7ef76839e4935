#include "campaigns/campaign/campaign_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "run/scenario/scenario_file.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CampaignSettings campaign_of(const std::string& text) {
    const auto scenario = read_scenario(text, "plan.toml");
    if (!scenario) throw std::runtime_error(scenario.error().message);
    return scenario->campaign.value();
}

CampaignPlan plan_of(const std::string& text, const std::string& base = "base") {
    return CampaignPlan::make(campaign_of(text), base).value();
}

std::vector<std::string> rows_of(const CampaignPlan& plan) {
    std::vector<std::string> rows;
    for (std::uint64_t i = 0; i < plan.size(); ++i) {
        const PlannedRun run = plan.run(i);
        rows.push_back(std::to_string(run.seed));
        for (const CampaignValue& value : run.values)
            rows.back() += " " + value.shown;
    }
    return rows;
}

constexpr const char* two_keys = R"(
[campaign]
seeds = 2
first_seed = 7
[[campaign.parameter]]
key = "model.name"
values = ["modern", "ideal"]
[[campaign.parameter]]
key = "run.speed"
whole = [1, 3]
)";

TEST(CampaignPlan, AGridTurnsItsLastParameterFirstAndTheSeedFastest) {
    EXPECT_THAT(rows_of(plan_of(two_keys)),
                ElementsAre("7 modern 1", "8 modern 1", "7 modern 2", "8 modern 2", "7 modern 3", "8 modern 3",
                            "7 ideal 1", "8 ideal 1", "7 ideal 2", "8 ideal 2", "7 ideal 3", "8 ideal 3"));
}

TEST(CampaignPlan, WithoutAnythingThereIsOneRun) {
    EXPECT_THAT(rows_of(plan_of("[campaign]\n")), ElementsAre("1"));
    EXPECT_THAT(rows_of(plan_of("[campaign]\nseed_list = [9, 3]\n")), ElementsAre("9", "3"));
}

TEST(CampaignPlan, SamplesHaveSeedsOfTheirOwnUnlessSeedsAreGiven) {
    const std::string drawn =
        "design = \"random\"\nsamples = 3\n[[campaign.parameter]]\nkey = \"run.speed\"\n"
        "values = [4]\n";
    EXPECT_THAT(rows_of(plan_of("[campaign]\n" + drawn)), ElementsAre("1 4", "2 4", "3 4"));
    const CampaignPlan two = plan_of("[campaign]\nseeds = 2\n" + drawn);
    EXPECT_THAT(rows_of(two), ElementsAre("1 4", "2 4", "1 4", "2 4", "1 4", "2 4"));
    std::set<std::string> keys;
    for (std::uint64_t i = 0; i < two.size(); ++i)
        keys.insert(two.run(i).key);
    EXPECT_EQ(keys.size(), 6U) << "samples that are alike are two";
}

TEST(CampaignPlan, KeysAreStableAndTellRunsApart) {
    const CampaignPlan plan = plan_of(two_keys);
    std::set<std::string> keys;
    for (std::uint64_t i = 0; i < plan.size(); ++i)
        keys.insert(plan.run(i).key);
    EXPECT_EQ(keys.size(), plan.size());
    // printf 'skyloop campaign run, form 1\nbase\nmodel.name = "modern"\nrun.speed = 1\nseed 7\n' | sha256sum
    EXPECT_EQ(plan.run(0).key, "c4f02775157a28bf75380ecd960cdf03");
    EXPECT_EQ(plan.run(5), plan_of(two_keys).run(5));
    EXPECT_NE(plan.run(0).key, plan_of(two_keys, "other base").run(0).key);
}

TEST(CampaignPlan, TheOrderOfParametersAndMoreSeedsLeaveKeysAlone) {
    const std::string one = "[[campaign.parameter]]\nkey = \"model.name\"\nvalues = [\"ideal\"]\n";
    const std::string other = "[[campaign.parameter]]\nkey = \"run.speed\"\nvalues = [2]\n";
    const std::string key = plan_of("[campaign]\n" + one + other).run(0).key;
    EXPECT_EQ(plan_of("[campaign]\n" + other + one).run(0).key, key);
    EXPECT_EQ(plan_of("[campaign]\nseeds = 50\n" + one + other).run(0).key, key);
}

TEST(CampaignPlan, TooManyRunsAreRefused) {
    CampaignSettings campaign = campaign_of("[campaign]\nseeds = 1000000\n");
    EXPECT_TRUE(CampaignPlan::make(campaign, ""));
    campaign.parameters.push_back({"run.speed", WholeSpread{1, 2}});
    EXPECT_THAT(CampaignPlan::make(campaign, "").error().message, HasSubstr("expected 1 to 1000000 runs"));
    campaign.parameters.push_back({"x", WholeSpread{-9007199254740992, 9007199254740992}});
    EXPECT_THAT(CampaignPlan::make(campaign, "").error().message, HasSubstr("more than 1000000 points"));
}

TEST(CampaignPlan, SeedsOfTheCommandLine) {
    const auto seeds = [](const std::string& text) {
        CampaignSettings campaign;
        const auto done = apply_seeds(text, campaign);
        if (!done) return done.error().message;
        std::string all;
        const CampaignPlan plan = CampaignPlan::make(campaign, "").value();
        for (std::uint64_t i = 0; i < plan.size(); ++i)
            all += std::to_string(plan.run(i).seed) + " ";
        return all;
    };
    EXPECT_EQ(seeds("3"), "1 2 3 ");
    EXPECT_EQ(seeds("5-7"), "5 6 7 ");
    EXPECT_EQ(seeds("9,1"), "9 1 ");
    for (const char* bad : {"", "0", "x", "-3", "7-5", "1,1", "1,", "1.5", "99999999999999999999"})
        EXPECT_THAT(seeds(bad), HasSubstr("expected a number of seeds")) << bad;
}

TEST(CampaignPlan, VaryOfTheCommandLine) {
    const auto values = [](const std::string& text) {
        CampaignSettings campaign;
        const auto done = apply_vary(text, campaign);
        if (!done) return done.error().message;
        std::string all = campaign.parameters.at(0).key;
        for (const CampaignValue& value : std::get<0>(campaign.parameters.at(0).spread))
            all += " " + value.toml;
        return all;
    };
    EXPECT_EQ(values("a.b=1,2.5"), "a.b 1 2.5");
    EXPECT_EQ(values("model.name=modern,ideal"), "model.name \"modern\" \"ideal\"");
    EXPECT_EQ(values("x=[1,2],[3,4]"), "x [1, 2] [3, 4]");
    EXPECT_EQ(values("x=true"), "x true");
    EXPECT_EQ(values("x=a\"b"), "x \"a\\\"b\"");
    for (const char* bad : {"", "x", "=1", "x=", "x=1,,2", "x=1,1", "x=2,2.0", "x=[0.0],[-0.0]", "run.seed=1",
                            "campaign.seeds=3", "x={a=1}"})
        EXPECT_THAT(values(bad), testing::AnyOf(HasSubstr("expected"), HasSubstr("x \"{a=1}\""))) << bad;
}

TEST(CampaignPlan, Shards) {
    EXPECT_EQ(parse_shard("2/5")->index, 2U);
    EXPECT_TRUE(parse_shard("2/5")->has(7));
    for (const char* bad : {"", "5/5", "1", "/", "1/", "-1/2", "0/0", "a/b", "0/2x"})
        EXPECT_THAT(parse_shard(bad).error().message, HasSubstr("expected I/N")) << bad;
}

}  // namespace
}  // namespace skyloop
