// The page, the numbers and the words of small campaigns.
#include "campaigns/campaign_report/campaign_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "unit/campaign_report/small_database.hpp"
#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

using test::SmallDatabase;
using ::testing::HasSubstr;
using ::testing::Not;

struct Written {
    std::string html, json, text;
};

Written written_with(const std::string& statements, std::size_t worst = 10) {
    const SmallDatabase database(test::campaign_schema + statements);
    const auto report = write_campaign_report(database.folder(), {{}, worst});
    EXPECT_TRUE(report) << report.error().message;
    if (!report) return {};
    EXPECT_EQ(report->html, database.folder() / "report.html");
    EXPECT_EQ(report->json, database.folder() / "report.json");
    return {test::bytes_of(report->html), test::bytes_of(report->json), report->text};
}

// The page without its first line, which is no XML of its own.
std::string page_fault(const std::string& html) { return test::xml_fault(html.substr(html.find('\n') + 1)); }

TEST(CampaignReport, IsTheSameBytesForTheSameDatabase) {
    const Written a = written_with(test::three_runs), b = written_with(test::three_runs);
    EXPECT_EQ(a.html, b.html);
    EXPECT_EQ(a.json, b.json);
    EXPECT_EQ(a.text, b.text);
    for (const std::string& text : {a.html, a.json, a.text})
        EXPECT_THAT(text, Not(HasSubstr("skyloop-report-")));  // the folder's name
}

TEST(CampaignReport, TellsWhatCameOut) {
    const Written report = written_with(test::three_runs);
    EXPECT_EQ(page_fault(report.html), "");
    const auto json = nlohmann::json::parse(report.json);
    EXPECT_EQ(json["runs"]["planned"], 4);
    EXPECT_EQ(json["runs"]["missing"], 1);
    EXPECT_EQ(json["verdicts"][0]["rate"]["passed"], 2);
    EXPECT_EQ(json["verdicts"][0]["rate"]["interval_kind"], "clopper_pearson");
    EXPECT_EQ(json["metrics"][0]["max"], 9.0);
    EXPECT_EQ(json["metrics"][0]["percentiles"][1]["value"], 2.0);
    EXPECT_TRUE(json["metrics"][0]["percentiles"][1]["interval"][0].is_null());
    EXPECT_EQ(json["metrics"][0]["worst"][0]["replay"], "skyloop campaign replay 'a b.toml' --number 2 --out run-2");
    EXPECT_EQ(json["failed_runs"][0]["failed_verdicts"][0]["detail"], "it was 9 m");
    EXPECT_THAT(report.html, HasSubstr("skyloop campaign replay &#39;a b.toml&#39; --number 2 --out run-2"));
    EXPECT_THAT(report.html, HasSubstr("near: it was 9 m"));
    EXPECT_THAT(report.html, HasSubstr("1 of 4 planned runs are missing"));
    EXPECT_THAT(report.text, HasSubstr("campaign three: 3 of 4 runs done, 2 passed, 1 failed, 0 errors"));
}

TEST(CampaignReport, ReplaysWithTheOptionsOfThePlan) {
    const Written report = written_with(std::string(test::three_runs) +
                                        R"(INSERT INTO meta VALUES ('options', '["--seeds","5-20","--vary",)"
                                        R"("model.name=a b,c --d"]');)");
    EXPECT_EQ(nlohmann::json::parse(report.json)["failed_runs"][0]["replay"],
              "skyloop campaign replay 'a b.toml' --seeds 5-20 --vary 'model.name=a b,c --d' --number 2 --out run-2");
}

TEST(CampaignReport, RunsWithAVehicleAreNotReplayed) {
    const Written report =
        written_with(std::string(test::three_runs) + "INSERT INTO meta VALUES ('vehicle', './sitl {pty}');");
    EXPECT_TRUE(nlohmann::json::parse(report.json)["failed_runs"][0]["replay"].is_null());
    EXPECT_THAT(report.text, HasSubstr("failed runs (with a vehicle; not replayed):\n  run 2 (seed 12): failed"));
    EXPECT_EQ(report.html.find("skyloop campaign replay"), std::string::npos);
}

TEST(CampaignReport, TellsABuildServerOfEachRun) {
    const SmallDatabase database(std::string(test::campaign_schema) + test::three_runs);
    const auto file = database.folder() / "junit.xml";
    ASSERT_TRUE(write_campaign_report(database.folder(), {{}, 1, file}));
    const std::string junit = test::bytes_of(file);
    EXPECT_EQ(page_fault(junit), "");
    EXPECT_THAT(junit, HasSubstr("<testsuite name=\"three\" tests=\"4\" failures=\"1\" errors=\"1\" "));
    EXPECT_THAT(junit, HasSubstr("<testcase classname=\"three\" name=\"run 0, seed 10, noise = 0.5\" time=\"0\"/>"));
    EXPECT_THAT(junit,
                HasSubstr("name=\"run 2, seed 12, noise = 1.5\" time=\"0\">\n"
                          "      <failure type=\"failed\" message=\"near: it was 9 m\">near: it was 9 m\n"
                          "replay: skyloop campaign replay &#39;a b.toml&#39; --number 2 --out run-2</failure>"));
    EXPECT_THAT(junit, HasSubstr("<error type=\"missing\" message=\"1 of 4 planned runs have no result\">"));
    EXPECT_THAT(junit, HasSubstr("<property name=\"runs_left_out\" value=\"0\"/>"));
}

TEST(CampaignReport, TellsABuildServerOfAnErrorWithoutMarkupOfItsOwn) {
    const SmallDatabase database(std::string(test::campaign_schema) +
                                 "CREATE TABLE error(key TEXT, message TEXT);"
                                 "INSERT INTO run VALUES ('a', 0, 1, 'error');"
                                 "INSERT INTO error VALUES ('a', ']]> <b> & \x1b \xEF\xBF\xBF');");
    const auto results = read_campaign_results(database.path());
    ASSERT_TRUE(results) << results.error().message;
    const std::string junit = campaign_report_junit(*results, summarise(*results, 0));
    EXPECT_EQ(page_fault(junit), "");
    EXPECT_THAT(junit, HasSubstr("<error type=\"error\" message=\"error: ]]&gt; &lt;b&gt; &amp; ? ?\">"));
    EXPECT_THAT(junit, HasSubstr(" tests=\"1\" failures=\"0\" errors=\"1\" "));
}

TEST(CampaignReport, TellsABuildServerFirstOfWhatFailedWhereThereIsTooMuch) {
    std::string statements = test::campaign_schema;
    for (std::size_t i = 0; i < most_junit_runs + 2; ++i) {
        const std::string n = std::to_string(i);
        statements += "INSERT INTO run VALUES ('k" + n + "', " + n + ", 1, '" +
                      (i < most_junit_runs ? "passed" : "failed") + "');";
    }
    const SmallDatabase database(statements);
    const auto results = read_campaign_results(database.path());
    ASSERT_TRUE(results) << results.error().message;
    const std::string junit = campaign_report_junit(*results, summarise(*results, 0));
    EXPECT_THAT(junit, HasSubstr("<property name=\"runs_left_out\" value=\"2\"/>"));
    EXPECT_THAT(junit, HasSubstr(" tests=\"10000\" failures=\"2\" errors=\"0\" "));
    EXPECT_THAT(junit, HasSubstr("name=\"run 10001, seed 1\""));
    EXPECT_THAT(junit, Not(HasSubstr("name=\"run 9998, seed 1\"")));
}

TEST(CampaignReport, NamesAsManyWorstRunsAsAreWanted) {
    EXPECT_EQ(nlohmann::json::parse(written_with(test::three_runs, 2).json)["metrics"][0]["worst"].size(), 2u);
    EXPECT_EQ(nlohmann::json::parse(written_with(test::three_runs, 0).json)["metrics"][0]["worst"].size(), 0u);
    EXPECT_EQ(nlohmann::json::parse(written_with(test::three_runs, 99).json)["metrics"][0]["worst"].size(), 3u);
}

// Everything that the database can say, said in the language of pages and of terminals.
TEST(CampaignReport, LetsNoTextOfTheDatabaseBecomeMarkup) {
    const std::string evil = "<script>alert(1)</script>\"''>&amp;<img src=x onerror=1>\x1b]0;x\x07\xff";
    const std::string hostile_word = R"(["<script>alert(1)</script>\"''\u001b]0;x\u0007"])";
    std::string statements = "INSERT INTO meta VALUES ('name', '" + evil + "'), ('scenario', '" + evil +
                             "'), ('scenario_digest', '" + evil + "'), ('program_version', '" + evil +
                             "'), ('campaign_file', '" + evil + "'), ('options', '" + hostile_word + "');";
    for (int i = 0; i < 30; ++i) {
        const std::string key = "'" + evil + std::to_string(i) + "', ";
        const std::string number = std::to_string(i);
        statements += "INSERT INTO run VALUES (" + key + number + ", 1, '" + (i % 2 ? "passed" : "failed") + "');" +
                      "INSERT INTO parameter VALUES (" + key + "'" + evil + "', '" + evil + std::to_string(i % 2) +
                      "'), (" + key + "'two" + evil + "', '" + number + "');" + "INSERT INTO metric VALUES (" + key +
                      "'" + evil + "_m', " + number + ");" + "INSERT INTO verdict VALUES (" + key + "'" + evil + "', " +
                      (i % 2 ? "1" : "0") + ", '" + evil + "');";
    }
    const Written report = written_with(statements);
    EXPECT_EQ(page_fault(report.html), "");
    for (const char* markup : {"<script", "<img", "\x1b", "\x07", "\xff"})
        EXPECT_THAT(report.html, Not(HasSubstr(markup)));
    for (const char* control : {"\x1b", "\x07", "\xff"})
        EXPECT_THAT(report.text, Not(HasSubstr(control)));
    EXPECT_TRUE(nlohmann::json::accept(report.json));
    // A name that a terminal would obey makes no command to copy.
    EXPECT_TRUE(nlohmann::json::parse(report.json)["failed_runs"][0]["replay"].is_null());
}

TEST(CampaignReport, IsHonestOfLittle) {
    const Written nothing = written_with("");
    EXPECT_EQ(page_fault(nothing.html), "");
    EXPECT_THAT(nothing.html, HasSubstr("No run is in the database"));
    EXPECT_THAT(nothing.html, HasSubstr("The runs gave no metrics."));
    EXPECT_THAT(nothing.text, HasSubstr("0 of an unknown number of runs done"));
    const Written one =
        written_with("INSERT INTO run VALUES ('a', 0, 1, 'passed'); INSERT INTO metric VALUES ('a', 'x_m', 5);");
    EXPECT_EQ(page_fault(one.html), "");
    EXPECT_THAT(one.html, HasSubstr("One value makes no distribution."));
    EXPECT_THAT(one.html, HasSubstr("p50 (6)"));  // ½^6 is the first power below 0.025
    const Written equal = written_with(
        "INSERT INTO run VALUES ('a', 0, 1, 'passed'), ('b', 1, 2, 'passed'), ('c', 2, 3, 'error');"
        "INSERT INTO metric VALUES ('a', 'x_m', 0.1), ('b', 'x_m', 0.1), ('a', 'y', NULL), ('b', 'y', 9e999);");
    EXPECT_EQ(page_fault(equal.html), "");
    EXPECT_THAT(equal.html, HasSubstr("All values are equal."));
    EXPECT_THAT(equal.html, HasSubstr("No run has a finite value."));
    EXPECT_THAT(equal.html, HasSubstr("came to no end (1) count in no rate"));
    const auto json = nlohmann::json::parse(equal.json);
    EXPECT_EQ(json["metrics"][0]["sd"], 0.0);
    EXPECT_EQ(json["metrics"][1]["infinite"], 1);
}

// Sums, squares and differences of such numbers leave the doubles; pictures have to do with them all the same.
TEST(CampaignReport, TakesNumbersOfAllSizes) {
    std::string statements;
    for (int i = 0; i < 40; ++i) {
        const std::string n = std::to_string(i);
        statements += "INSERT INTO run VALUES ('k" + n + "', " + n + ", 1, 'passed');";
        const std::string key = "'k" + n + "', ";
        for (const char* scale : {"1e308", "1e99", "1e-300", "1e-12", "-1e50", "1e15 + 1"})
            statements += "INSERT INTO metric VALUES (" + key + "'m " + scale + "', " + n + " * " + scale + ");";
        statements += "INSERT INTO parameter VALUES (" + key + "'p', '" + n + "e90'), (" + key + "'q', '" + n +
                      "e-310'), (" + key + "'r', '1e400'), (" + key + "'s', '');";
    }
    const Written report = written_with(statements);
    EXPECT_EQ(page_fault(report.html), "");
    EXPECT_THAT(report.html, Not(::testing::ContainsRegex("[>\" ]-?(nan|inf)[<\" ,]")));
}

TEST(CampaignReport, TakesNothingOfTheCampaignsPlace) {
    const SmallDatabase database(std::string(test::campaign_schema) + test::three_runs);
    const auto folder = database.folder();
    std::filesystem::create_directories(folder / "shards");
    for (const char* page : {"campaign.html", "campaign.sqlite", "shards/0-of-1.csv", "./shards/../campaign.x"}) {
        const auto refused = write_campaign_report(folder, {folder / page, 1});
        ASSERT_FALSE(refused) << page;
        EXPECT_EQ(refused.error().code, ErrorCode::usage);
        EXPECT_THAT(refused.error().message, HasSubstr("the campaign's own"));
    }
    for (const char* junit : {"campaign.sqlite", "shards/junit.xml", "report.html", "report.json"}) {
        const auto refused = write_campaign_report(folder, {{}, 1, folder / junit});
        ASSERT_FALSE(refused) << junit;
        EXPECT_EQ(refused.error().code, ErrorCode::usage);
        EXPECT_THAT(refused.error().message, testing::StartsWith("--junit "));
    }
    const auto taken = write_campaign_report(folder, {folder / "campaign-report.html", 1});
    ASSERT_TRUE(taken);
    EXPECT_FALSE(taken->outdated);
    std::ofstream(folder / "shards/0-of-2.csv") << "new\n";
    std::filesystem::last_write_time(
        folder / "shards/0-of-2.csv",
        std::filesystem::last_write_time(folder / "campaign.sqlite") + std::chrono::seconds(1));
    EXPECT_TRUE(write_campaign_report(folder, {{}, 1})->outdated);
}

TEST(CampaignReport, RefusesAPageThatIsItsOwnNumbersAndAFolderThatIsNotThere) {
    const SmallDatabase database(std::string(test::campaign_schema) + test::three_runs);
    EXPECT_EQ(write_campaign_report(database.folder(), {database.folder() / "a.json", 1}).error().code,
              ErrorCode::usage);
    const auto refused = write_campaign_report(database.folder(), {database.folder() / "no/such/a.html", 1});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::outside);
    EXPECT_THAT(refused.error().message, HasSubstr("a.html: cannot be written"));
    const auto elsewhere = write_campaign_report(database.folder(), {database.folder() / "b.html", 1});
    ASSERT_TRUE(elsewhere);
    EXPECT_EQ(elsewhere->json, database.folder() / "b.json");
    EXPECT_FALSE(std::filesystem::exists(database.folder() / "b.html.part"));
    for (const auto& entry : std::filesystem::directory_iterator(database.folder()))
        EXPECT_NE(entry.path().extension(), ".new") << "nothing is left beside it";
}

}  // namespace
}  // namespace skyloop
