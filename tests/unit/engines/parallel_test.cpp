// The scripts for GNU parallel, run by it on this machine; skipped by name where it is absent.
#include <gmock/gmock.h>

#include "base/core/process.hpp"
#include "campaigns/engines/engine_scripts.hpp"
#include "engine_rig.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ParallelEngine : public test::EngineRig {
protected:
    ParallelEngine() {
        settings.hosts = "# here, twice\n\n2/:\n";
        settings.scenario_text = "[run]\n";
    }
    void make_files() {
        const auto scripts = parallel_scripts(task, settings);
        ASSERT_TRUE(scripts) << scripts.error().message;
        const auto written = write_parallel_files(task, *scripts);
        ASSERT_TRUE(written) << written.error().message;
    }
    std::optional<int> run() {
        ProcessRequest request;
        request.command = {"sh", (parallel_folder(task) / "campaign.sh").string()};
        request.environment = {"HOME=" + root.string()};
        request.timeout = Seconds(60);
        const auto outcome = run_process(request);
        if (!outcome) return std::nullopt;
        said = outcome->output + outcome->errors;
        return outcome->exit_code;
    }
    static bool has_parallel() {
        ProcessRequest request;
        request.command = {"parallel", "--version"};
        const auto outcome = run_process(request);
        return outcome && outcome->output.find("GNU parallel") != std::string::npos;
    }
    void shard_ends_with(int shard, const std::string& codes) {
        write(task.out / "shards" / ("code." + std::to_string(shard)), codes);
    }

    ParallelSettings settings;
    std::string said;
};

#define NEEDS_PARALLEL() \
    if (!has_parallel()) GTEST_SKIP() << "GNU parallel is absent: apt-get install parallel"

TEST_F(ParallelEngine, AFileWithoutAHostIsRefused) {
    for (const char* hosts : {"", "\n\n", "# node1\n", "node1\x01\n"}) {
        settings.hosts = hosts;
        EXPECT_FALSE(parallel_scripts(task, settings)) << hosts;
    }
}

TEST_F(ParallelEngine, RunsAndGathersWhateverTheNames) {
    NEEDS_PARALLEL();
    make_files();
    EXPECT_EQ(run(), 0) << said;
    EXPECT_EQ(text_of(task.out / "shards/3-of-4.csv"), "key,number\nrun,3\n");
    EXPECT_THAT(text_of(root / "words"), AllOf(HasSubstr("|--vary|world.name=\"a b\",'c'|--out|" + task.out.string() +
                                                         "|--jobs|1|--shard|0/4|\n"),
                                               HasSubstr("campaign|gather|" + task.out.string() + "|\n")));
    EXPECT_THAT(said, HasSubstr("gathered 4"));
}

TEST_F(ParallelEngine, WhatEndedWellIsNotRepeated) {
    NEEDS_PARALLEL();
    settings.retries = 0;
    shard_ends_with(0, "3\n");
    shard_ends_with(2, "1\n");
    make_files();
    EXPECT_EQ(run(), 1) << said;
    EXPECT_THAT(said, HasSubstr("shards failed"));
    EXPECT_EQ(lines_of(root / "words"), 5u);
    EXPECT_EQ(run(), 0) << said;
    EXPECT_EQ(lines_of(root / "words"), 7u);  // the one that failed, and the gathering
    EXPECT_EQ(text_of(task.out / "shards/2-of-4.csv"), "key,number\nrun,2\n");
}

TEST_F(ParallelEngine, AFaultIsTriedAgain) {
    NEEDS_PARALLEL();
    shard_ends_with(2, "137\n1\n");
    make_files();
    EXPECT_EQ(run(), 0) << said;
    EXPECT_EQ(lines_of(root / "words"), 7u);
}

TEST_F(ParallelEngine, ABadCampaignEndsAll) {
    NEEDS_PARALLEL();
    settings.hosts = "1/:\n";
    shard_ends_with(0, "2\n");
    make_files();
    EXPECT_EQ(run(), 2) << said;
    EXPECT_EQ(lines_of(root / "words"), 1u);
}

TEST_F(ParallelEngine, AnotherScenarioIsRunAgain) {
    NEEDS_PARALLEL();
    make_files();
    EXPECT_EQ(run(), 0) << said;
    settings.scenario_text = "[run]\nduration_s = 5\n";
    make_files();
    EXPECT_EQ(run(), 0) << said;
    EXPECT_EQ(lines_of(root / "words"), 10u);
}

}  // namespace
}  // namespace skyloop
