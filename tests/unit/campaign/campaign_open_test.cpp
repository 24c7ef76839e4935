#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <future>

#include "campaigns/campaign/campaign_folder.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

constexpr const char* short_run = R"(
[run]
start = 2024-03-05T12:00:00Z
duration_s = 5
[model]
name = "ideal"
)";

std::string track_from(int latitude) {
    return "time_s,lat_deg,lon_deg,height_m\n0," + std::to_string(latitude) + ",8,400\n9," + std::to_string(latitude) +
           ".001,8,400\n";
}

// A folder with a scenario, two tracks beside it and a board of its own.
class CampaignOpen : public testing::Test {
protected:
    CampaignOpen() {
        write_scenario("");
        write_text(folder_ / "a.csv", track_from(47));
        write_text(folder_ / "b.csv", track_from(48));
        const auto boards = std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards" / "receivers";
        std::filesystem::create_directories(board().parent_path());
        std::filesystem::copy_file(boards / "ublox-m8.toml", board());
    }
    [[nodiscard]] std::filesystem::path board() const { return folder_ / "data/boards/receivers/mine.toml"; }
    void write_scenario(const std::string& more) const { write_text(folder_ / "c.toml", short_run + more); }
    [[nodiscard]] Result<OpenedCampaign> open(const std::vector<std::string>& vary) const {
        return open_campaign({folder_ / "c.toml", std::nullopt, vary, "1",
                              DataFolders{{folder_ / "data", std::filesystem::path(SKYLOOP_SOURCE_DIR)}}});
    }
    [[nodiscard]] std::vector<std::string> keys(const std::vector<std::string>& vary) const {
        const auto campaign = open(vary);
        if (!campaign) throw std::runtime_error(campaign.error().message);
        std::vector<std::string> keys;
        for (std::uint64_t i = 0; i < campaign->plan.size(); ++i)
            keys.push_back(campaign->plan.run(i).key);
        return keys;
    }

    test::TemporaryFolder folder_;
};

TEST_F(CampaignOpen, TheContentOfAFileThatAValueNamesIsInTheKeysOfItsRuns) {
    const std::vector<std::string> vary{"trajectory.kind=file", "trajectory.path=a.csv,b.csv"};
    const auto before = keys(vary);
    EXPECT_EQ(keys(vary), before);
    write_text(folder_ / "b.csv", track_from(50));
    const auto after = keys(vary);
    EXPECT_EQ(after.at(0), before.at(0));
    EXPECT_NE(after.at(1), before.at(1));
}

TEST_F(CampaignOpen, SoItIsOfAListAndOfTheScenariosOwnParameters) {
    const std::string list = "[[campaign.parameter]]\nkey = \"trajectory.kind\"\nvalues = [\"file\"]\n";
    write_scenario(list + "[[campaign.parameter]]\nkey = \"trajectory.path\"\nvalues = [\"b.csv\"]\n");
    const auto before = keys({});
    write_scenario(list + "[[campaign.parameter]]\nkey = \"trajectory.path\"\nvalues = [\"b.csv\", \"a.csv\"]\n");
    EXPECT_EQ(keys({}).at(0), before.at(0)) << "another value leaves the keys of what is there alone";
    write_text(folder_ / "b.csv", track_from(50));
    EXPECT_NE(keys({}).at(0), before.at(0));
    const auto listed = keys({"x.y=[\"b.csv\"]"});
    write_text(folder_ / "b.csv", track_from(51));
    EXPECT_NE(keys({"x.y=[\"b.csv\"]"}), listed);
}

TEST_F(CampaignOpen, TheContentOfABoardThatAValueNamesIsInTheKeysOfItsRuns) {
    write_scenario("[[receiver]]\n");
    const std::vector<std::string> by_name{"receiver.0.board=ublox-m8,mine"};
    const std::vector<std::string> by_path{"receiver.0.board=" + board().string()};
    const auto before = keys(by_name), path_before = keys(by_path);
    std::ofstream(board(), std::ios::app) << "# another\n";
    const auto after = keys(by_name);
    EXPECT_EQ(after.at(0), before.at(0));
    EXPECT_NE(after.at(1), before.at(1));
    EXPECT_NE(keys(by_path), path_before);
}

TEST_F(CampaignOpen, WhatIsInTheKeysIsLookedAfter) {
    write_text(folder_ / "sitl", "#!/bin/sh\n");
    write_text(folder_ / "p.parm", "GPS_TYPE 1\n");
    write_scenario(
        "[trajectory]\nkind = \"file\"\npath = \"a.csv\"\n[[receiver]]\nboard = \"mine\"\n"
        "[campaign.vehicle]\nfiles = [\"p.parm\"]\ncommand = \"" +
        (folder_ / "sitl").string() + "\"\n");
    auto campaign = open({"trajectory.path=a.csv,b.csv"});
    ASSERT_TRUE(campaign) << campaign.error().message;
    EXPECT_EQ(campaign->files.find_written(), std::nullopt);
    for (const auto& file : {folder_ / "a.csv", folder_ / "b.csv", board(), folder_ / "sitl", folder_ / "p.parm"}) {
        const auto size = std::filesystem::file_size(file);
        std::ofstream(file, std::ios::app) << "\n";
        const auto changed = campaign->files.find_written();
        ASSERT_FALSE(changed) << file;
        EXPECT_THAT(changed.error().message, testing::StartsWith(file.string() + ": has changed"));
        std::filesystem::resize_file(file, size);
    }
}

TEST_F(CampaignOpen, TheContentOfABoardThatTheScenarioNamesByItsPathIsInTheKeys) {
    const std::string beside = board().lexically_relative(folder_.path()).string();
    write_scenario("[[receiver]]\nboard = \"" + beside + "\"\n");
    const auto before = keys({});
    const auto varied_before = keys({"receiver.0.board=" + beside});
    std::ofstream(board(), std::ios::app) << "# another\n";
    EXPECT_NE(keys({}), before);
    EXPECT_NE(keys({"receiver.0.board=" + beside}), varied_before);
}

TEST_F(CampaignOpen, TheContentOfAVehicleAndOfWhatItLoadsIsInTheKeys) {
    const std::string program = (folder_ / "sitl").string();
    write_text(program, "#!one");
    write_text(folder_ / "sitl.parm", "1");
    write_scenario("[campaign.vehicle]\ncommand = \"" + program + " {pty}\"\nfiles = [\"sitl.parm\"]\n");
    const auto before = keys({});
    EXPECT_EQ(keys({}), before);
    write_text(program, "#!two");
    const auto rebuilt = keys({});
    EXPECT_NE(rebuilt, before);
    write_text(folder_ / "sitl.parm", "2");
    EXPECT_NE(keys({}), rebuilt);
    std::filesystem::remove(folder_ / "sitl.parm");
    const auto absent = open({});
    ASSERT_FALSE(absent);
    EXPECT_EQ(absent.error().code, ErrorCode::outside);
    EXPECT_THAT(absent.error().message, HasSubstr("sitl.parm: cannot be read: No such file"));
}

TEST_F(CampaignOpen, AMetricThatThereIsNotIsToldWhereItStands) {
    write_scenario("[campaign]\nmetrics = [\"fix_share\", \"fix_shard\"]\n");
    const auto refused = open({});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("/c.toml:8:11: campaign.metrics: 'fix_shard' is no metric; expected "
                                                   "some of"));
}

TEST_F(CampaignOpen, AFolderIsNotTakenFromAnotherCampaign) {
    const auto out = folder_ / "out";
    ASSERT_TRUE(keep_campaign(out, open({"trajectory.path=a.csv,b.csv"}).value()));
    const auto before = kept_campaign(out).value();
    for (const std::vector<std::string>& other : {std::vector<std::string>{}, {"run.speed=1,2"}}) {
        const auto kept = keep_campaign(out, open(other).value());
        ASSERT_FALSE(kept);
        EXPECT_EQ(kept.error().code, ErrorCode::input);
        EXPECT_THAT(kept.error().message, HasSubstr("campaign.json: is that of a campaign with other columns: it has "
                                                    "the parameters [trajectory.path], this one ["));
        EXPECT_EQ(kept_campaign(out)->runs, before.runs);
    }
    write_scenario("[[expect]]\nname = \"seen\"\nwhat = \"fix at 3 s\"\n");
    EXPECT_THAT(keep_campaign(out, open({"trajectory.path=a.csv"}).value()).error().message,
                HasSubstr("expectations [], this one [seen]"));
    write_scenario("");
    EXPECT_TRUE(keep_campaign(out, open({"trajectory.path=a.csv"}).value())) << "other values are the same campaign";
    EXPECT_EQ(kept_campaign(out)->runs.size(), 1U);
    write_text(out / "campaign.json", "mine");
    EXPECT_THAT(keep_campaign(out, open({}).value()).error().message, HasSubstr("or a folder without one"));
}

TEST_F(CampaignOpen, APlanThatIsInUseIsNotReplaced) {
    const auto out = folder_ / "out";
    write_scenario("[campaign]\nseeds = 3\n");
    const auto campaign = open({});
    auto first = keep_campaign(out, *campaign);
    ASSERT_TRUE(first) << first.error().message;
    auto second = keep_campaign(out, *campaign);
    EXPECT_TRUE(second) << "parts of it run beside each other";
    OpenedCampaign elsewhere = *campaign;
    elsewhere.setup.file = "/mnt/c.toml";
    EXPECT_TRUE(keep_campaign(out, elsewhere)) << "on another machine, too";
    EXPECT_EQ(kept_campaign(out)->scenario, campaign->setup.file.string());

    write_scenario("[campaign]\nseeds = 2\n");
    const auto fewer = open({});
    for (int holders = 2; holders > 0; --holders) {
        const auto refused = keep_campaign(out, *fewer);
        ASSERT_FALSE(refused) << holders;
        EXPECT_EQ(refused.error().code, ErrorCode::input);
        EXPECT_THAT(refused.error().message, HasSubstr("campaign.json: a campaign with another plan is running there"));
        EXPECT_EQ(kept_campaign(out)->runs.size(), 3U);
        (holders == 2 ? first : second) = FileDescriptor();
    }
    EXPECT_TRUE(keep_campaign(out, *fewer)) << "nobody is at it any more";
    EXPECT_EQ(kept_campaign(out)->runs.size(), 2U);
}

TEST_F(CampaignOpen, PartsThatBeginAtOnceAllKeepTheirPlan) {
    write_scenario("[campaign]\nseeds = 300\n");
    const auto campaign = open({});
    std::vector<std::future<bool>> parts;
    for (int i = 0; i < 8; ++i)
        parts.push_back(
            std::async(std::launch::async, [&] { return keep_campaign(folder_ / "out", *campaign).has_value(); }));
    for (auto& part : parts)
        EXPECT_TRUE(part.get());
    EXPECT_EQ(kept_campaign(folder_ / "out")->runs.size(), 300U);
}

std::string check_mistake(const Result<OpenedCampaign>& campaign) {
    if (!campaign) return campaign.error().message;
    std::vector<std::uint64_t> all;
    for (std::uint64_t i = 0; i < campaign->plan.size(); ++i)
        all.push_back(i);
    const auto checked = check_runs(*campaign, all, [] { return false; });
    if (checked) return checked->empty() ? "none" : checked->front();
    EXPECT_NE(checked.error().code, ErrorCode::outside);
    return checked.error().message;
}

TEST_F(CampaignOpen, WarnsOfValuesThatAreListed) {
    write_scenario(
        "[[fault]]\nname = \"gap\"\nkind = \"outage\"\nat_s = 3\nfor_s = 1\n"
        "[campaign]\nseeds = 3\n");
    EXPECT_EQ(check_mistake(open({"fault.gap.at_s=2,4"})), "none");
    EXPECT_THAT(check_mistake(open({"fault.gap.at_s=4,30"})),
                testing::AllOf(HasSubstr("'gap' will not begin"), testing::EndsWith("; with fault.gap.at_s = 30")));
}

TEST_F(CampaignOpen, WarnsOfPowerThatNoRunSwitches) {
    write_scenario("[[receiver]]\npower = \"command:true|true\"\n[campaign.vehicle]\ncommand = \"true\"\n");
    const auto campaign = open({});
    ASSERT_TRUE(campaign) << campaign.error().message;
    EXPECT_THAT(campaign->warnings,
                testing::Contains(HasSubstr("receiver0: power command:true|true: runs of a campaign switch nothing")));
}

TEST_F(CampaignOpen, StopsWhileItChecks) {
    write_scenario("[campaign]\nseeds = 3\n");
    const auto campaign = open({"run.duration_s=1,2,3"});
    int looks = 0;
    EXPECT_TRUE(check_runs(*campaign, {0, 1, 2, 3, 4, 5, 6, 7, 8}, [&] { return ++looks == 2; }));
    EXPECT_EQ(looks, 2);
}

TEST_F(CampaignOpen, AKeyIsVariedOnce) {
    write_scenario("[campaign]\nseeds = 3\n");
    const auto twice = open({"run.speed=1,2", "run.speed=3"});
    ASSERT_FALSE(twice);
    EXPECT_THAT(twice.error().message, HasSubstr("--vary run.speed: is given twice"));
}

TEST_F(CampaignOpen, NoTwoColumnsHaveOneTitle) {
    write_scenario(
        "[[expect]]\nname = \"vehicle\"\nwhat = \"fix at 3 s\"\n[[expect]]\n"
        "name = \"a\\nb\"\nwhat = \"fix at 4 s\"\n[[expect]]\nname = \"a b\"\nwhat = \"fix at 5 s\"\n"
        "[campaign]\nseeds = 1\n[campaign.vehicle]\ncommand = \"true\"\n");
    const auto campaign = open({});
    ASSERT_TRUE(campaign) << campaign.error().message;
    EXPECT_THAT(campaign->setup.columns.verdicts, testing::ElementsAre("vehicle", "a b", "a b (2)", "vehicle (2)"));
}

TEST_F(CampaignOpen, EachListedValueIsTriedBeforeAnythingIsRun) {
    write_scenario(
        "[[receiver]]\n[campaign]\nseeds = 2\n[[campaign.parameter]]\nkey = \"run.speed\"\nvalues = [1, 2]\n"
        "[[campaign.parameter]]\nkey = \"receiver.0.board\"\nvalues = [\"ublox-m8\", \"nope\"]\n");
    EXPECT_THAT(check_mistake(open({})), testing::MatchesRegex(".*/c.toml:14:7: board 'nope' is not known.*; with "
                                                               "receiver.0.board = \"nope\""));
    EXPECT_EQ(check_mistake(open({"receiver.0.board=ublox-m8,mine"})), "none");
    EXPECT_THAT(check_mistake(open({"receiver.0.board=mine,nope"})),
                testing::StartsWith("--vary receiver.0.board: board 'nope'"));
    EXPECT_THAT(check_mistake(open({"receiver.0.board=mine", "sky.rebase_navigation=false,true"})),
                testing::MatchesRegex("--vary sky.rebase_navigation: .*; with sky.rebase_navigation = true"));
}

TEST_F(CampaignOpen, AnOptionIsBlamedForItsValuesWhereTheFileHasOthers) {
    write_scenario(
        "[[fault]]\nname = \"gap\"\nkind = \"outage\"\nat_s = 1\nfor_s = 1\n[campaign]\n"
        "[[campaign.parameter]]\nkey = \"fault.gap.for_s\"\nvalues = [2]\n");
    EXPECT_THAT(check_mistake(open({"fault.gap.for_s=-1"})),
                testing::StartsWith("--vary fault.gap.for_s: fault.gap.for_s: is -1; expected a number"));
}

TEST_F(CampaignOpen, AnOptionIsBlamedForATableThatThereIsNot) {
    EXPECT_THAT(check_mistake(open({"run.speed=1", "foo.bar=1"})),
                testing::StartsWith("--vary foo.bar: foo: unknown key"));
}

TEST_F(CampaignOpen, TwoNamesOfOneKeyAreRefused) {
    const std::string faults =
        "[[fault]]\nname = \"gap\"\nkind = \"outage\"\nat_s = 1\nfor_s = 1\n[campaign]\n"
        "[[campaign.parameter]]\nkey = \"fault.gap.for_s\"\nvalues = [2]\n";
    write_scenario(faults);
    for (const std::string other : {"fault.0.for_s", "fault.outage.for_s", "fault.0"})
        EXPECT_THAT(check_mistake(open({other + "=3"})),
                    HasSubstr("--vary " + other + ": campaign parameter '" + other +
                              "' sets what 'fault.gap.for_s' "
                              "sets, too"));
    write_scenario(faults + "[[campaign.parameter]]\nkey = \"fault.0.for_s\"\nvalues = [3]\n");
    EXPECT_THAT(check_mistake(open({})), HasSubstr("c.toml:17:7: campaign parameter 'fault.0.for_s' sets what"));
    write_scenario(faults);
    EXPECT_EQ(check_mistake(open({"fault.0.at_s=2", "fault.gap.for_s=1,2"})), "none");
}

}  // namespace
}  // namespace skyloop
