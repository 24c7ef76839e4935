// Batch scripts that run in a Slurm of four shell scripts, and who follows them there.
#include <gmock/gmock.h>

#include "base/core/process.hpp"
#include "campaigns/engines/engine_files.hpp"
#include "campaigns/engines/slurm_job.hpp"
#include "engine_rig.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SlurmEngine : public test::EngineRig {
protected:
    SlurmEngine() {
        settings.partition = "big ones";
        settings.time_limit = "1:00:00";
        settings.options = {"--account=it's"};
        follow.between_looks = Seconds(0.01);
        follow.file_patience = Seconds(0.05);
        follow.squeue_patience = Seconds(0.3);
        follow.say = [this](const std::string& line) { said += line + "\n"; };
    }
    void make_files() {
        const auto scripts = slurm_scripts(task, settings);
        ASSERT_TRUE(scripts) << scripts.error().message;
        ASSERT_TRUE(write_slurm_files(task, *scripts));
    }
    // The exit code of the follower, or what it says in vain.
    std::string follow_to_end() {
        make_files();
        const auto job = submit_slurm(task);
        if (!job) return job.error().message;
        const auto code = follow_slurm(task, *job, follow);
        return code ? std::to_string(*code) : code.error().message;
    }
    void shard_ends_with(int shard, const std::string& codes) {
        write(task.out / "shards" / ("code." + std::to_string(shard)), codes);
    }
    std::string calls() { return text_of(root / "calls"); }

    SlurmSettings settings;
    FollowOptions follow;
    std::string said;
};

TEST_F(SlurmEngine, ScriptsHaveTheKeysThatSurviveALostNode) {
    const auto scripts = slurm_scripts(task, settings);
    ASSERT_TRUE(scripts);
    EXPECT_THAT(scripts->shards,
                AllOf(HasSubstr("#SBATCH \"--array=0-3\"\n"), HasSubstr("#SBATCH \"--requeue\"\n"),
                      HasSubstr("#SBATCH \"--open-mode=append\"\n"), HasSubstr("#SBATCH \"--signal=B:USR1@45\"\n"),
                      HasSubstr("#SBATCH \"--partition=big ones\"\n"), HasSubstr("#SBATCH \"--time=1:00:00\"\n"),
                      HasSubstr("#SBATCH \"--account=it's\"\n"),
                      HasSubstr("100%% \\\"it's\\\" $HOME #1/slurm/log/%a.txt\"\n")));
    EXPECT_THAT(scripts->gather, AllOf(HasSubstr("#SBATCH \"--partition=big ones\"\n"), Not(HasSubstr("--time"))));
}

TEST_F(SlurmEngine, ShellsUnderstandTheScripts) {
    make_files();
    for (const char* name : {"campaign.sbatch", "gather.sbatch"}) {
        ProcessRequest request;
        request.command = {"bash", "-n", (slurm_folder(task) / name).string()};
        const auto outcome = run_process(request);
        ASSERT_TRUE(outcome);
        EXPECT_EQ(outcome->exit_code, 0) << outcome->errors;
    }
}

TEST_F(SlurmEngine, OptionsThatAreNoneOrTheScriptsOwnAreRefused) {
    for (const char* option : {"--array=1-9", "-a1-9", "--dependency=afterok:1", "-d", "--wrap=true", "account=lab",
                               "-", "", "--no-requeue", "--output=/dev/null", "--account=lab\n#SBATCH --wrap=x"}) {
        settings.options = {option};
        const auto scripts = slurm_scripts(task, settings);
        ASSERT_FALSE(scripts) << option;
        EXPECT_EQ(scripts.error().code, ErrorCode::usage);
        EXPECT_THAT(scripts.error().message, HasSubstr("--sbatch-option"));
    }
    for (const char* option : {"--array-inx=1", "-Alab", "--exclude=node[1-3]"}) {
        settings.options = {option};
        EXPECT_TRUE(slurm_scripts(task, settings)) << option;
    }
}

TEST_F(SlurmEngine, RunsAndGathersWhateverTheNames) {
    follow.runs = 4;
    EXPECT_EQ(follow_to_end(), "0");
    EXPECT_EQ(text_of(task.out / "shards/3-of-4.csv"), "key,number\nrun,3\n");
    const std::string words = text_of(root / "words");
    EXPECT_THAT(words, HasSubstr("campaign|" + task.scenario.string() + "|--vary|world.name=\"a b\",'c'|--out|" +
                                 task.out.string() + "|--jobs|1|--shard|2/4|\n"));
    EXPECT_THAT(words, HasSubstr("campaign|gather|" + task.out.string() + "|\n"));
    EXPECT_THAT(calls(), HasSubstr("--dependency=afterany:101 "));
    EXPECT_THAT(said, AllOf(HasSubstr("4 of 4 results"), HasSubstr("gathered 4")));
}

TEST_F(SlurmEngine, AFailedVerdictIsAResult) {
    shard_ends_with(1, "3\n");
    EXPECT_EQ(follow_to_end(), "0");
    EXPECT_EQ(whole_number_of(task.out / "slurm/exit/1"), 3);
    EXPECT_EQ(lines_of(root / "words"), 5u);  // nothing was done twice
}

TEST_F(SlurmEngine, AFaultIsTriedAgainByTheShardItself) {
    settings.retries = 2;
    shard_ends_with(1, "1\n137\n");
    EXPECT_EQ(follow_to_end(), "0");
    EXPECT_EQ(lines_of(root / "words"), 7u);
    EXPECT_EQ(lines_of(root / "calls"), 2u);
}

TEST_F(SlurmEngine, ABadCampaignIsNotTriedAgain) {
    shard_ends_with(2, "2\n2\n2\n");
    EXPECT_EQ(follow_to_end(), "2");
    EXPECT_EQ(lines_of(root / "words"), 5u);
    EXPECT_THAT(said, HasSubstr("shard 2 says that the campaign cannot be"));
}

TEST_F(SlurmEngine, WhatAMachineLostIsSubmittedAgainAlone) {
    write(root / "lost.0", "");
    write(root / "lost.2", "");
    write(root / "lost.3", "");
    EXPECT_EQ(follow_to_end(), "0");
    EXPECT_THAT(calls(), HasSubstr("--array=0,2-3 "));
    EXPECT_EQ(lines_of(root / "calls"), 4u);
    EXPECT_THAT(said, HasSubstr("3 shards were lost (0,2-3)"));
}

TEST_F(SlurmEngine, FaultsWithoutEndEnd) {
    settings.retries = 1;
    shard_ends_with(1, "1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n1\n");
    EXPECT_EQ(follow_to_end(), "1");
    EXPECT_EQ(lines_of(root / "words"), 3u + 3u * 2u + 3u);  // shards that are well, the one that is not, gatherings
    EXPECT_THAT(said, HasSubstr("1 shards are unfinished after 3 submissions (1)"));
}

TEST_F(SlurmEngine, CancelledTasksAreNotSubmittedAgain) {
    write(root / "lost.1", "");
    write(root / "states", "COMPLETED \nCANCELLED \nCOMPLETED \n");
    EXPECT_EQ(follow_to_end(), "75");
    EXPECT_EQ(lines_of(root / "calls"), 2u);
    EXPECT_THAT(said, HasSubstr("were cancelled, so 1 shards are unfinished"));
}

TEST_F(SlurmEngine, LeavingItLeavesTheJobs) {
    write(root / "states", "RUNNING\nPENDING\n");
    int looks = 0;
    follow.stopped = [&looks] { return ++looks > 3; };
    EXPECT_EQ(follow_to_end(), "75");
    EXPECT_THAT(said, HasSubstr("1 tasks running, 1 waiting"));
    // And what still runs is not submitted a second time.
    const auto again = submit_slurm(task);
    ASSERT_FALSE(again);
    EXPECT_THAT(again.error().message, HasSubstr("job 101 of this campaign is still in the queue"));
    const auto job = submitted_slurm(task);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->shards, "101");
    EXPECT_EQ(job->gather, "102");
}

TEST_F(SlurmEngine, WhatWasSubmittedIsReadBackWholeOrNotAtAll) {
    for (const char* line : {"", "101", "101 4", "101 0 102", "101 x 102", "101 4 x", "x 4 102", "101 4 102 103",
                             "101  102", "101 99999999999999999999 102"}) {
        write(task.out / "slurm/jobs", line);
        EXPECT_FALSE(submitted_slurm(task)) << line;
    }
    write(task.out / "slurm/jobs", "101 40 102\n");
    const auto job = submitted_slurm(task);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->count, 40u);
    write(task.out / "slurm/jobs", "101 40 \n");  // its gathering was refused
    ASSERT_TRUE(submitted_slurm(task));
    EXPECT_EQ(submitted_slurm(task)->gather, "");
}

TEST_F(SlurmEngine, FollowedLaterItIsCutAsItWas) {
    make_files();
    write(root / "lost.3", "");
    ASSERT_TRUE(submit_slurm(task));
    task.shards = 2;  // what a later call would have chosen
    const auto code = follow_slurm(task, *submitted_slurm(task), follow);
    ASSERT_TRUE(code);
    EXPECT_EQ(*code, 0);
    EXPECT_THAT(calls(), HasSubstr("--array=3 "));
    EXPECT_EQ(text_of(task.out / "shards/3-of-4.csv"), "key,number\nrun,3\n");
}

TEST_F(SlurmEngine, ARefusalOfSbatchIsTold) {
    write(root / "refuses", "");
    EXPECT_THAT(follow_to_end(),
                AllOf(HasSubstr("campaign.sbatch"), HasSubstr("invalid partition specified: nowhere")));
}

TEST_F(SlurmEngine, ASlurmThatDoesNotAnswerIsToldAtLast) {
    make_files();
    ASSERT_TRUE(submit_slurm(task));
    std::filesystem::create_directories(root / "bin");
    write(root / "bin/squeue", "#!/bin/sh\necho 'Unable to contact slurm controller' >&2\nexit 1\n");
    std::filesystem::permissions(root / "bin/squeue", std::filesystem::perms::owner_all);
    ::setenv("PATH", ((root / "bin").string() + ":" + ::getenv("PATH")).c_str(), 1);
    const auto code = follow_slurm(task, *submitted_slurm(task), follow);
    ASSERT_FALSE(code);
    EXPECT_THAT(code.error().message, HasSubstr("Unable to contact slurm controller"));
}

}  // namespace
}  // namespace skyloop
