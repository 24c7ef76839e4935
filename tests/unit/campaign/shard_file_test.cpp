#include "campaigns/campaign/shard_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "campaigns/campaign/campaign_database.hpp"
#include "campaigns/campaign/campaign_folder.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

const ResultColumns example_columns{{"run.speed"}, {"fix_share", "horizontal_error_p95_m"}, {"a fix", "no, never"}};

RunResult example_result(std::uint64_t number) {
    RunResult result;
    result.key = std::string(28, 'a') + std::to_string(1000 + number);
    result.number = number;
    result.seed = number + 1;
    result.status = number % 2 == 0 ? "passed" : "failed";
    result.parameters = {"0.5"};
    result.metrics = {1.0, number == 3 ? std::nullopt : std::optional(2.25)};
    result.verdicts = {{"passed", "it came"}, {number % 2 == 0 ? "passed" : "failed", "said \"no\", at 3 s"}};
    return result;
}

std::vector<RunResult> stored_in(const std::filesystem::path& folder) {
    std::vector<RunResult> all;
    const auto read = for_each_result(folder, [&](const StoredResult& stored) -> Result<void> {
        EXPECT_EQ(stored.columns, example_columns);
        all.push_back(stored.result);
        return {};
    });
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return all;
}

std::string file_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

void add_results(const std::filesystem::path& folder, const Shard& shard, std::uint64_t count) {
    auto file = TableFile::open(shard_results(folder, shard), result_header(example_columns));
    ASSERT_TRUE(file) << file.error().message;
    for (std::uint64_t i = 0; i < count; ++i)
        if (shard.has(i)) {
            ASSERT_TRUE(file->append(result_row(example_result(i))));
        }
}

TEST(RunResultTable, RowsComeBackAsTheyWere) {
    for (std::uint64_t i = 0; i < 5; ++i) {
        std::string row = result_row(example_result(i));
        ASSERT_EQ(row.back(), '\n');
        row.pop_back();
        const auto result = parse_result_row(row, example_columns);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(*result, example_result(i));
    }
    std::string header = result_header(example_columns);
    header.pop_back();
    EXPECT_EQ(parse_result_header(header).value(), example_columns);
    RunResult lines = example_result(0);
    lines.verdicts[0].detail = "two\nlines";
    const std::string row = result_row(lines);
    EXPECT_EQ(std::count(row.begin(), row.end(), '\n'), 1);
}

TEST(RunResultTable, MutationsAreReadOrRefused) {
    const std::string row = result_row(example_result(1)), header = result_header(example_columns);
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
        std::string text = i % 2 == 0 ? row : header;
        for (int k = static_cast<int>(random() % 3); k >= 0; --k)
            text[random() % text.size()] = static_cast<char>("\",.-e09\n\r\0x"[random() % 11]);
        text.resize(random() % (text.size() + 1));
        if (i % 2 == 0) {
            const auto result = parse_result_row(text, example_columns);
            if (result) {
                EXPECT_EQ(result->verdicts.size(), 2U);
            }
        } else if (const auto columns = parse_result_header(text)) {
            EXPECT_EQ(parse_result_header(text.substr(0)).value(), *columns);
        }
    }
}

TEST(ShardFile, ATornLineIsDroppedAtEveryByte) {
    const TemporaryFolder folder;
    const Shard shard{0, 1};
    add_results(folder.path(), shard, 3);
    const std::string whole = file_text(shard_results(folder.path(), shard));
    const std::size_t third = whole.rfind('\n', whole.size() - 2) + 1;
    for (std::size_t cut = third; cut < whole.size(); ++cut) {
        write_file(shard_results(folder.path(), shard), whole.substr(0, cut));
        ASSERT_EQ(stored_in(folder.path()).size(), 2U) << "a reader passes over it";
        auto file = TableFile::open(shard_results(folder.path(), shard), result_header(example_columns));
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->append(result_row(example_result(2))));
        ASSERT_EQ(file_text(shard_results(folder.path(), shard)), whole) << cut;
    }
}

TEST(ShardFile, ATornHeaderIsWrittenAnew) {
    const TemporaryFolder folder;
    const Shard shard{0, 1};
    write_file(shard_results(folder.path(), shard), "key,num");
    EXPECT_EQ(stored_in(folder.path()).size(), 0U);
    add_results(folder.path(), shard, 2);
    EXPECT_EQ(stored_in(folder.path()).size(), 2U);
}

TEST(ShardFile, AFolderThatCannotBeMadeIsNamed) {
    const TemporaryFolder folder;
    write_file(folder / "results", "a file");
    const auto file = TableFile::open(shard_results(folder / "results", {0, 1}), result_header(example_columns));
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::outside);
    EXPECT_EQ(file.error().message,
              (folder / "results").string() + "/shards: cannot be made a folder: Not a directory");
}

TEST(ShardFile, OtherColumnsAreRefused) {
    const TemporaryFolder folder;
    add_results(folder.path(), {0, 1}, 2);
    const auto other = TableFile::open(shard_results(folder.path(), {0, 1}), result_header({{"model.name"}, {}, {}}));
    ASSERT_FALSE(other);
    EXPECT_THAT(other.error().message, AllOf(HasSubstr("0-of-1.csv:1:"), HasSubstr("other columns")));
}

TEST(ShardFile, DamageWithinATableIsToldByLine) {
    const TemporaryFolder folder;
    const auto path = shard_results(folder.path(), {0, 1});
    const auto said = [&](const std::string& text) {
        write_file(path, text);
        const auto read = for_each_result(folder.path(), [](const StoredResult&) -> Result<void> { return {}; });
        return read ? std::string("none") : read.error().message;
    };
    const std::string header = result_header(example_columns), row = result_row(example_result(1));
    EXPECT_EQ(said(header + row), "none");
    EXPECT_THAT(said("a,b\n" + row), HasSubstr("0-of-1.csv:1: is no header"));
    EXPECT_THAT(said(header + row + "x,1,1\n"), HasSubstr("0-of-1.csv:3: has 3 cells; expected 12"));
    EXPECT_THAT(said(header + "\"" + row), HasSubstr("quotation mark"));
    EXPECT_THAT(said(header + "Z" + row.substr(1)), HasSubstr("expected 32 hexadecimal digits"));
}

// A folder with a plan of `count` runs whose keys are those of the examples.
void write_plan(const std::filesystem::path& folder, std::uint64_t count) {
    std::string runs;
    for (std::uint64_t i = 0; i < count; ++i)
        runs += (i > 0 ? "," : "") + std::string("[") + std::to_string(i) + ",\"" + example_result(i).key + "\"," +
                std::to_string(i + 1) + ",[\"0.5\"]]";
    write_file(folder / "campaign.json",
               R"({"form":1,"name":"n","program_version":"1","scenario":"s.toml","scenario_digest":"d","options":[],)"
               R"("parameters":["run.speed"],"metrics":["fix_share","horizontal_error_p95_m"],)"
               R"("verdicts":["a fix","no, never"],"planned":)" +
                   std::to_string(count) + ",\"runs\":[" + runs + "]}");
}

TEST(CampaignDatabase, IsTheSameWhateverThePartsWere) {
    const TemporaryFolder one, other;
    for (const auto& folder : {one.path(), other.path()})
        write_plan(folder, 60);
    add_results(one.path(), {0, 1}, 60);
    for (std::uint64_t i = 0; i < 3; ++i)  // a part of three is there, then it goes on in five
        if (i != 1) add_results(other.path(), {i, 3}, 60);
    EXPECT_EQ(gather_campaign(other.path())->missing.size(), 20U);
    for (std::uint64_t i = 0; i < 5; ++i)
        add_results(other.path(), {i, 5}, 60);
    const auto counts = gather_campaign(one.path()), more = gather_campaign(other.path());
    ASSERT_TRUE(counts && more);
    EXPECT_EQ(counts->passed, 30U);
    EXPECT_EQ(counts->failed, 30U);
    EXPECT_EQ(counts->failed_verdicts.at("no, never"), 30U);
    EXPECT_EQ(counts->duplicates, 0U);
    EXPECT_EQ(more->duplicates, 40U);
    EXPECT_EQ(file_text(one.path() / "campaign.sqlite"), file_text(other.path() / "campaign.sqlite"));
}

TEST(CampaignDatabase, TwoResultsOfARunThatDifferAreAMistake) {
    const TemporaryFolder folder;
    write_plan(folder.path(), 2);
    add_results(folder.path(), {0, 1}, 2);
    RunResult other = example_result(1);
    other.metrics[0] = 0.5;
    auto file = TableFile::open(shard_results(folder.path(), {0, 2}), result_header(example_columns));
    ASSERT_TRUE(file && file->append(result_row(other)));
    const auto counts = gather_campaign(folder.path());
    ASSERT_FALSE(counts);
    EXPECT_THAT(counts.error().message,
                AllOf(HasSubstr("0-of-1.csv:3"), HasSubstr("0-of-2.csv:2"), HasSubstr("that differ")));
}

TEST(CampaignDatabase, NothingIsLeftOfOneThatCannotBePut) {
    const TemporaryFolder folder;
    write_plan(folder.path(), 2);
    add_results(folder.path(), {0, 1}, 2);
    std::filesystem::create_directories(folder / "campaign.sqlite/inside");
    EXPECT_THAT(gather_campaign(folder.path()).error().message, HasSubstr("campaign.sqlite: cannot be written"));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"campaign.json", "campaign.sqlite", "shards"}));
}

TEST(CampaignDatabase, CountsWhatThePlanDoesNotHave) {
    const TemporaryFolder folder;
    write_plan(folder.path(), 2);
    add_results(folder.path(), {0, 1}, 5);
    const auto counts = gather_campaign(folder.path());
    ASSERT_TRUE(counts);
    EXPECT_EQ(counts->foreign, 3U);
    EXPECT_TRUE(counts->missing.empty());
}

TEST(CampaignFolder, APlanCountsInWholeNumbers) {
    const std::string plan = R"({"form":1,"name":"n","program_version":"1","scenario":"s","scenario_digest":"d",)"
                             R"("options":[],"parameters":["a"],"metrics":[],"verdicts":[],"planned":1,)"
                             R"("runs":[[0,"k",7,["x"]]]})";
    ASSERT_TRUE(parse_kept_campaign(plan, "p"));
    for (const std::string wrong : {"1e99", "-1", "0.5", "true", "\"1\""})
        for (const std::string_view right : {"\"form\":1", "\"planned\":1", "[[0", "\"k\",7"}) {
            std::string text = plan;
            text.replace(text.find(right) + right.size() - 1, 1, wrong);
            const auto kept = parse_kept_campaign(text, "p");
            ASSERT_FALSE(kept) << text;
            EXPECT_THAT(kept.error().message, HasSubstr("expected a whole number")) << text;
        }
}

TEST(CampaignFolder, ADamagedPlanIsRefused) {
    const TemporaryFolder folder;
    EXPECT_THAT(gather_campaign(folder.path()).error().message, HasSubstr("campaign.json"));
    write_plan(folder.path(), 2);
    const std::string text = file_text(folder.path() / "campaign.json");
    ASSERT_TRUE(parse_kept_campaign(text, "p"));
    for (std::size_t cut = 0; cut < text.size(); ++cut)
        ASSERT_FALSE(parse_kept_campaign(text.substr(0, cut), "p")) << cut;
    std::mt19937 random(2);
    for (int i = 0; i < 5000; ++i) {
        std::string damaged = text;
        damaged[random() % damaged.size()] = static_cast<char>("\",[]{}-1e\0x"[random() % 11]);
        const auto kept = parse_kept_campaign(damaged, "p");
        if (!kept) {
            ASSERT_THAT(kept.error().message, HasSubstr("expected the plan"));
        }
    }
}

}  // namespace
}  // namespace skyloop
