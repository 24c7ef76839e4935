// What is read of a database, and what is refused.
#include "campaigns/campaign_report/campaign_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"
#include "unit/campaign_report/small_database.hpp"

namespace skyloop {
namespace {

using test::SmallDatabase;
using ::testing::HasSubstr;

Result<CampaignResults> read_with(const std::string& more) {
    const SmallDatabase database(std::string(test::campaign_schema) + test::three_runs + more);
    return read_campaign_results(database.path());
}

std::string refusal(const std::string& more) {
    const auto results = read_with(more);
    EXPECT_FALSE(results) << more;
    if (results) return "";
    EXPECT_EQ(results.error().code, ErrorCode::input);
    EXPECT_EQ(results.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(results.error().message, HasSubstr("campaign.sqlite: "));
    return results.error().message;
}

TEST(CampaignResults, AreReadInTheOrderOfThePlan) {
    const auto results = read_with("INSERT INTO metric VALUES ('k0', 'ttff_s', NULL), ('k1', 'ttff_s', 9e999);");
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_EQ(results->name, "three");
    EXPECT_EQ(results->planned, 4u);
    ASSERT_EQ(results->runs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(results->runs[i].number, static_cast<std::int64_t>(i));
        EXPECT_EQ(results->runs[i].seed, 10 + i);
        EXPECT_EQ(results->runs[i].key, "k" + std::to_string(i));
    }
    EXPECT_EQ(results->runs[2].status, RunStatus::failed);
    EXPECT_EQ(results->parameters[0].values[2], "1.5");
    EXPECT_EQ(results->metrics[0].values, (std::vector<double>{1, 2, 9}));
    EXPECT_TRUE(std::isnan(results->metrics[1].values[0]));
    EXPECT_TRUE(std::isinf(results->metrics[1].values[1]));
    EXPECT_TRUE(std::isnan(results->metrics[1].values[2]));
    EXPECT_EQ(results->verdicts[0].passed, (std::vector<std::optional<bool>>{true, true, false}));
    EXPECT_EQ(results->verdicts[0].details[2], "it was 9 m");
}

TEST(CampaignResults, TakeSeedsOfAllBitsAndVerdictsThatWereNotRun) {
    const auto results = read_with(
        "INSERT INTO run VALUES ('k3', 3, -1, 'error'); INSERT INTO verdict VALUES ('k3', 'near', NULL, '');"
        "CREATE TABLE error(key TEXT, message TEXT); INSERT INTO error VALUES ('k3', 'no such file');");
    ASSERT_TRUE(results) << results.error().message;
    EXPECT_EQ(results->runs[3].seed, 18446744073709551615u);
    EXPECT_EQ(results->runs[3].error, "no such file");
    EXPECT_FALSE(results->verdicts[0].passed[3]);
}

TEST(CampaignResults, NameTheTableAndTheRowOfWhatIsWrong) {
    EXPECT_THAT(refusal("INSERT INTO metric VALUES ('k0', 'x', 'abc');"),
                HasSubstr("table 'metric', row 4: value is not a number"));
    EXPECT_THAT(refusal("INSERT INTO metric VALUES ('k0', 'error_m', 3);"),
                HasSubstr("'error_m' of run 0 stands there twice"));
    EXPECT_THAT(refusal("INSERT INTO metric VALUES ('k9', 'error_m', 3);"),
                HasSubstr("key 'k9' is not in table 'run'"));
    EXPECT_THAT(refusal("INSERT INTO metric VALUES ('k0', NULL, 3);"), HasSubstr("is not a text"));
    EXPECT_THAT(refusal("INSERT INTO parameter VALUES ('k0', 'p', NULL);"), HasSubstr("value is not a text"));
    EXPECT_THAT(refusal("INSERT INTO run VALUES ('k3', 3, 4, 'fine\x1b[2J');"),
                HasSubstr("status is 'fine?[2J'; expected passed, failed or error"));
    EXPECT_THAT(refusal("INSERT INTO run VALUES ('k3', -3, 4, 'passed');"), HasSubstr("number is not a count"));
    EXPECT_THAT(refusal("INSERT INTO run VALUES ('k3', 3, 0.5, 'passed');"), HasSubstr("seed is not a whole number"));
    EXPECT_THAT(refusal("INSERT INTO verdict VALUES ('k0', 'v', 2, '');"), HasSubstr("passed is not 0, 1 or null"));
    EXPECT_THAT(refusal("UPDATE meta SET value = '-4' WHERE name = 'planned';"), HasSubstr("planned is not a count"));
}

TEST(CampaignResults, RefuseWhatIsNoSuchDatabase) {
    EXPECT_THAT(refusal("DROP TABLE verdict;"), HasSubstr("has no table 'verdict'"));
    EXPECT_THAT(refusal("ALTER TABLE run RENAME COLUMN seed TO sead;"), HasSubstr("no such column: seed"));
    // A view of that name could count for ever.
    EXPECT_THAT(
        refusal("DROP TABLE metric; CREATE VIEW metric AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 "
                "FROM n) SELECT 'k0' AS key, i AS name, i AS value FROM n;"),
        HasSubstr("has no table 'metric'"));
    const SmallDatabase text("");
    std::ofstream(text.path()) << "run,seed\n0,1\n" << std::string(4000, 'x');
    EXPECT_THAT(read_campaign_results(text.path()).error().message, HasSubstr("is not an SQLite database"));
    const auto nothing = read_campaign_results(text.folder() / "campaign.db");
    EXPECT_EQ(nothing.error().code, ErrorCode::outside);
    EXPECT_THAT(nothing.error().message, HasSubstr("no such file; 'skyloop campaign gather' makes it"));
    EXPECT_FALSE(read_campaign_results(text.folder()));
}

TEST(CampaignResults, RefuseMoreNamesThanAPageShows) {
    EXPECT_THAT(refusal("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT 600) "
                        "INSERT INTO metric SELECT 'k0', 'm' || i, i FROM n;"),
                HasSubstr("more than 500 different names of metrics"));
}

// Whatever happens to the bytes: an answer or one line, and no crash.
TEST(CampaignResults, SurviveDamage) {
    const SmallDatabase whole(std::string(test::campaign_schema) + test::three_runs);
    const std::string good = test::bytes_of(whole.path());
    RandomStream random(1, "damaged databases");
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string bytes = good;
        if (i % 4 == 0) bytes.resize(random.bits() % bytes.size());
        for (std::uint64_t k = random.bits() % 12; k > 0 && !bytes.empty(); --k)
            bytes[random.bits() % bytes.size()] = static_cast<char>(random.bits() & 0xFF);
        std::ofstream(whole.path(), std::ios::binary | std::ios::trunc) << bytes;
        const auto results = read_campaign_results(whole.path());
        if (!results) {
            ++refused;
            EXPECT_FALSE(results.error().message.empty());
            continue;
        }
        const CampaignSummary summary = summarise(*results, 3);
        EXPECT_FALSE(campaign_report_html(*results, summary).empty());
        EXPECT_FALSE(campaign_report_json(*results, summary).empty());
    }
    EXPECT_GT(refused, 100);
    EXPECT_LT(refused, 400);
}

}  // namespace
}  // namespace skyloop
