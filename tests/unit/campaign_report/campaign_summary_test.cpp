// The statistics of campaigns whose truth is known.
#include "campaigns/campaign_report/campaign_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using ::testing::ElementsAre;

CampaignResults empty_campaign(std::size_t runs) {
    CampaignResults results;
    for (std::size_t i = 0; i < runs; ++i)
        results.runs.push_back({"k" + std::to_string(i), static_cast<std::int64_t>(i), i, RunStatus::passed, ""});
    return results;
}

ReportedParameter parameter_of(const std::string& name, std::size_t runs,
                               const std::function<std::string(std::size_t)>& value) {
    ReportedParameter parameter{name, {}};
    for (std::size_t i = 0; i < runs; ++i)
        parameter.values.emplace_back(value(i));
    return parameter;
}

TEST(ParameterLevels, FewNumbersAreLevelsInTheirOrder) {
    const auto levels = levels_of(parameter_of("p", 30, [](std::size_t i) {
        return i % 3 == 0 ? "10" : i % 3 == 1 ? "9.5" : "-1e1";
    }));
    EXPECT_TRUE(levels.numeric);
    EXPECT_FALSE(levels.binned);
    ASSERT_EQ(levels.levels.size(), 3u);
    EXPECT_EQ(levels.levels[0].label, "-10");
    EXPECT_EQ(levels.levels[1].label, "9.5");
    EXPECT_EQ(levels.levels[2].runs, 10u);
    EXPECT_EQ(levels.of_run[0], 2u);
}

TEST(ParameterLevels, ManyNumbersAreBinsOfLikeCounts) {
    const auto levels = levels_of(parameter_of("p", 800, [](std::size_t i) { return std::to_string(i * 7 % 800); }));
    EXPECT_TRUE(levels.binned);
    ASSERT_EQ(levels.levels.size(), number_bins);
    for (const ParameterLevel& level : levels.levels)
        EXPECT_EQ(level.runs, 100u);
    EXPECT_EQ(levels.distinct, 800u);
}

TEST(ParameterLevels, EqualNumbersShareABin) {
    const auto levels =
        levels_of(parameter_of("p", 400, [](std::size_t i) { return i < 300 ? std::string("5") : std::to_string(i); }));
    std::size_t runs = 0;
    for (const ParameterLevel& level : levels.levels)
        runs += level.runs;
    EXPECT_EQ(runs, 400u);
    EXPECT_EQ(levels.levels.front().runs, 300u);
}

TEST(ParameterLevels, OneWordAmongNumbersMakesWordsOfAll) {
    const auto levels = levels_of(parameter_of("p", 4, [](std::size_t i) { return i == 2 ? "nan" : "1"; }));
    EXPECT_FALSE(levels.numeric);
    EXPECT_EQ(levels.levels.size(), 2u);
    const auto many = levels_of(parameter_of("p", 90, [](std::size_t i) { return "file" + std::to_string(i % 30); }));
    EXPECT_EQ(many.levels.size(), most_word_levels);
    EXPECT_EQ(many.not_shown, 30u);
    EXPECT_EQ(many.distinct, 30u);
}

TEST(CampaignSummary, CountsWhatWasRunAndWhatIsMissing) {
    CampaignResults results = empty_campaign(10);
    results.planned = 12;
    results.runs[3].status = RunStatus::failed;
    results.runs[4].status = RunStatus::error;
    const CampaignSummary summary = summarise(results, 5);
    EXPECT_EQ(summary.passed, 8u);
    EXPECT_EQ(summary.failed, 1u);
    EXPECT_EQ(summary.errors, 1u);
    EXPECT_EQ(summary.missing, 2u);
    EXPECT_THAT(summary.failed_runs, ElementsAre(3, 4));
    // A run without an end counts in no rate.
    EXPECT_EQ(summary.verdicts[0].rate.count.passed, 8u);
    EXPECT_EQ(summary.verdicts[0].rate.count.trials, 9u);
}

TEST(CampaignSummary, TellsTheFiguresOfAMetric) {
    CampaignResults results = empty_campaign(13);
    results.runs[11].status = RunStatus::error;
    // 10, 9 … 1, infinite, error, none
    ReportedMetric metric{"error_m", {}};
    for (int i = 0; i < 10; ++i)
        metric.values.push_back(10 - i);
    metric.values.push_back(std::numeric_limits<double>::infinity());
    metric.values.push_back(std::numeric_limits<double>::quiet_NaN());
    metric.values.push_back(std::numeric_limits<double>::quiet_NaN());
    results.metrics.push_back(metric);
    const MetricSummary summary = summarise(results, 3).metrics[0];
    EXPECT_EQ(summary.sorted.size(), 10u);
    EXPECT_DOUBLE_EQ(*summary.mean, 5.5);
    EXPECT_NEAR(*summary.sd, 3.0276503540974917, 1e-12);     // numpy 1.24: std(ddof=1)
    EXPECT_NEAR(summary.percentiles[2].value, 9.55, 1e-12);  // numpy 1.24: percentile(…, 95)
    EXPECT_EQ(summary.infinite, 1u);
    EXPECT_EQ(summary.without, 1u);
    EXPECT_THAT(summary.valueless, ElementsAre(10, 12));
    EXPECT_THAT(summary.worst, ElementsAre(0, 1, 2));
}

TEST(CampaignSummary, FindsTheWorstEndByTheName) {
    CampaignResults results = empty_campaign(4);
    results.metrics = {{"horizontal_error_p95_m", {1, 2, 3, 3}},
                       {"fix_share", {0.5, 1, 0.9, 1}},
                       {"time_to_first_fix_s", {20, 30, 25, 1}},
                       {"mean_east_m", {-5, 4, 1, 0}}};
    const CampaignSummary summary = summarise(results, 2);
    EXPECT_THAT(summary.metrics[0].worst, ElementsAre(2, 3));
    EXPECT_THAT(summary.metrics[1].worst, ElementsAre(0, 2));
    EXPECT_THAT(summary.metrics[2].worst, ElementsAre(1, 2));
    EXPECT_THAT(summary.metrics[3].worst, ElementsAre(0, 1));
}

// A metric that one parameter moves up, one down, one in the middle only, and one not at all.
CampaignResults moved_campaign(std::size_t runs) {
    RandomStream random(5, "moved");
    CampaignResults results = empty_campaign(runs);
    results.parameters = {{"up", {}}, {"down", {}}, {"middle", {}}, {"nothing", {}}, {"same", {}}};
    results.metrics = {{"error_m", {}}, {"constant", std::vector<double>(runs, 0.1)}};
    results.verdicts = {{"small", {}, std::vector<std::string>(runs)}};
    for (std::size_t i = 0; i < runs; ++i) {
        const double up = random.uniform(), down = random.uniform();
        const std::size_t middle = random.bits() % 3;
        const double error = 3 * up - 2 * down + (middle == 1 ? 1.5 : 0) + 0.3 * random.normal();
        results.metrics[0].values.push_back(error);
        results.verdicts[0].passed.emplace_back(error < 2);
        results.runs[i].status = error < 2 ? RunStatus::passed : RunStatus::failed;
        results.parameters[0].values.emplace_back(std::to_string(up));
        results.parameters[1].values.emplace_back(std::to_string(down));
        results.parameters[2].values.emplace_back(std::to_string(middle));
        results.parameters[3].values.emplace_back(std::to_string(random.uniform()));
        results.parameters[4].values.emplace_back("4");
    }
    return results;
}

TEST(CampaignSummary, SaysWhatMovesAMetric) {
    const CampaignResults results = moved_campaign(500);
    const CampaignSummary summary = summarise(results, 5);
    const std::vector<Effect>& effects = summary.metrics[0].effects;
    EXPECT_EQ(effects[0].kind, Effect::Kind::rising);
    EXPECT_EQ(effect_words(effects[0], "up"), "rises strongly with up");
    EXPECT_EQ(effects[1].kind, Effect::Kind::falling);
    EXPECT_EQ(effects[2].kind, Effect::Kind::differing);
    EXPECT_EQ(effects[3].kind, Effect::Kind::unseen);
    EXPECT_EQ(effects[4].kind, Effect::Kind::constant);
    for (const Effect& effect : summary.metrics[1].effects)
        EXPECT_EQ(effect.kind, Effect::Kind::constant);
    const VerdictSummary& small = summary.verdicts[1];
    EXPECT_EQ(small.effects[0].kind, Effect::Kind::falling);
    EXPECT_GT(small.by_level[0].front().share(), small.by_level[0].back().share() + 0.2);
    std::size_t trials = 0;
    for (const Rate& rate : small.by_level[0])
        trials += rate.count.trials;
    EXPECT_EQ(trials, 500u);
}

TEST(CampaignSummary, SaysNothingOfFewRuns) {
    const CampaignSummary summary = summarise(moved_campaign(fewest_runs_for_effects - 1), 5);
    for (const Effect& effect : summary.metrics[0].effects)
        EXPECT_EQ(effect.kind, Effect::Kind::too_few);
    EXPECT_EQ(summary.tests, 0u);
}

// 12 unrelated metrics and 6 parameters, over and over: one report in twenty may cry wolf, by Bonferroni's inequality.
TEST(CampaignSummary, SeldomSeesWhatIsNotThere) {
    RandomStream random(9, "false alarms");
    int alarms = 0;
    constexpr int reports = 120;
    for (int report = 0; report < reports; ++report) {
        CampaignResults results = empty_campaign(60);
        for (int k = 0; k < 6; ++k)
            results.parameters.push_back(parameter_of("p" + std::to_string(k), 60,
                                                      [&](std::size_t) { return std::to_string(random.uniform()); }));
        for (int k = 0; k < 12; ++k) {
            results.metrics.push_back({"m" + std::to_string(k), {}});
            for (int i = 0; i < 60; ++i)
                results.metrics.back().values.push_back(random.normal());
        }
        bool any = false;
        for (const MetricSummary& metric : summarise(results, 1).metrics)
            for (const Effect& effect : metric.effects)
                any = any || effect.seen();
        alarms += any ? 1 : 0;
    }
    EXPECT_LE(alarms, 13);  // more have a chance of 0.3 %: scipy 1.10.1, 1 − binom.cdf(13, 120, 0.05)
}

}  // namespace
}  // namespace skyloop
