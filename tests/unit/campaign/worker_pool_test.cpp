#include "campaigns/campaign/worker_pool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace skyloop {
namespace {

using testing::HasSubstr;

// Answers each job with its own line; "die" kills it.
PoolWork shell_work(const std::string& script, std::uint64_t jobs) {
    PoolWork work;
    work.command = {"/bin/sh", "-c", script};
    work.greeting = "hello";
    work.processes = 2;
    for (std::uint64_t i = 0; i < jobs; ++i)
        work.jobs.push_back(i);
    work.ask = [](std::uint64_t job) { return "job " + std::to_string(job); };
    return work;
}

constexpr const char* echo_script = "read greeting; while read line; do echo \"$greeting $line\"; done";

TEST(WorkerPool, AsksForEachJobOnce) {
    std::map<std::uint64_t, std::string> answers;
    const std::atomic<bool> go_on = false;
    const auto done = run_jobs(
        shell_work(echo_script, 40),
        [&](const JobOutcome& outcome) -> Result<JobFate> {
            EXPECT_TRUE(answers.emplace(outcome.job, outcome.answer).second);
            return JobFate::done;
        },
        [] {}, go_on);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(answers.size(), 40U);
    EXPECT_EQ(answers[17], "hello job 17");
}

TEST(WorkerPool, ADeathCostsOneAttempt) {
    // Of each worker the third job is its death.
    const std::string script =
        "read greeting; for i in 1 2; do read line || exit 0; echo $line; done; read line || exit "
        "0; kill -9 $$";
    int lost = 0, answered = 0;
    const std::atomic<bool> go_on = false;
    const auto done = run_jobs(
        shell_work(script, 20),
        [&](const JobOutcome& outcome) -> Result<JobFate> {
            if (outcome.answer.empty()) {
                EXPECT_EQ(outcome.death, "signal 9");
                return ++lost, JobFate::again;
            }
            return ++answered, JobFate::done;
        },
        [] {}, go_on);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(answered, 20);
    EXPECT_GT(lost, 3);
}

TEST(WorkerPool, RunsThatKillTheirWorkersDoNotHoldUpTheOthers) {
    // The first twenty in a row, on two workers.
    const std::string script =
        "read greeting; while read word number; do test $number -lt 20 && kill -9 $$; echo $number; done";
    int given_up = 0, answered = 0;
    const std::atomic<bool> go_on = false;
    const auto done = run_jobs(
        shell_work(script, 26),
        [&](const JobOutcome& outcome) -> Result<JobFate> {
            if (!outcome.answer.empty()) return ++answered, JobFate::done;
            return outcome.attempt < 2 ? JobFate::again : (++given_up, JobFate::given_up);
        },
        [] {}, go_on);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(answered, 6);
    EXPECT_EQ(given_up, 20);
}

TEST(WorkerPool, NoNumberOfDeathsEndsItOnceAWorkerHasAnswered) {
    const std::string script =
        "read greeting; while read word number; do test $number -gt 0 && kill -9 $$; echo $number; done";
    int given_up = 0, answered = 0;
    const std::atomic<bool> go_on = false;
    PoolWork work = shell_work(script, 121);
    work.processes = 1;
    const auto done = run_jobs(
        work,
        [&](const JobOutcome& outcome) -> Result<JobFate> {
            return outcome.answer.empty() ? (++given_up, JobFate::given_up) : (++answered, JobFate::done);
        },
        [] {}, go_on);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(answered, 1);
    EXPECT_EQ(given_up, 120);
}

TEST(WorkerPool, WorkersThatNeverAnswerEndIt) {
    const std::atomic<bool> go_on = false;
    const auto again = [](const JobOutcome&) -> Result<JobFate> { return JobFate::again; };
    const auto done = run_jobs(
        shell_work("exit 7", 3), again, [] {}, go_on);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("exit code 7"));
    PoolWork absent = shell_work("", 1);
    absent.command = {"/no/such/program"};
    EXPECT_THAT(run_jobs(
                    absent, again, [] {}, go_on)
                    .error()
                    .message,
                HasSubstr("/no/such/program"));
}

TEST(WorkerPool, AJobThatTakesTooLongCostsOneAttempt) {
    // Job 1 answers when it is asked to end, job 2 does not hear of it.
    PoolWork work = shell_work(
        "read greeting; while read line; do case $line in *1) trap 'echo stopped' TERM; sleep 15 & wait;; *2) trap '' "
        "TERM; sleep 15;; esac; "
        "echo $line; done",
        4);
    work.job_limit = std::chrono::seconds(1);
    std::map<std::uint64_t, JobOutcome> outcomes;
    const std::atomic<bool> go_on = false;
    const auto done = run_jobs(
        work,
        [&](const JobOutcome& outcome) -> Result<JobFate> {
            outcomes[outcome.job] = outcome;
            return !outcome.answer.empty() ? JobFate::done : outcome.attempt < 2 ? JobFate::again : JobFate::given_up;
        },
        [] {}, go_on);
    ASSERT_TRUE(done) << done.error().message;
    for (const std::uint64_t job : {1U, 2U}) {
        EXPECT_EQ(outcomes[job].attempt, 2) << job;
        EXPECT_EQ(outcomes[job].death, "it took more than 1 s") << job;
        EXPECT_LT(outcomes[job].seconds, 14) << job;
    }
    for (const std::uint64_t job : {0U, 3U})
        EXPECT_FALSE(outcomes[job].answer.empty()) << job;
}

TEST(WorkerPool, StopsWorkersThatAreBusy) {
    std::atomic<bool> stop = false;
    const auto done = run_jobs(
        shell_work("exec sleep 60", 3), [](const JobOutcome&) -> Result<JobFate> { return JobFate::done; },
        [&] { stop = true; }, stop);
    EXPECT_TRUE(done);
}

}  // namespace
}  // namespace skyloop
