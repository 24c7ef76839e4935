// Commands that an expectation runs: how they are judged, tried again and killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/verdict/judge.hpp"
#include "seen_run.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

Verdict probe_verdict(const Probe& probe, bool live, double patience_s) {
    Expectation expectation;
    expectation.probe = probe;
    Judge judge({expectation}, {test::run_start, {"receiver0"}, live, {"SKYLOOP_WORD=moon"}});
    judge.advance(test::at_second(5));
    for (double waited = 0; live && waited < patience_s; waited += 0.05) {
        struct timespec pause {
            0, 50'000'000
        };
        ::nanosleep(&pause, nullptr);
        judge.advance(test::at_second(5 + waited));
    }
    return judge.finish(test::at_second(60)).front();
}

TEST(JudgeProbes, AreJudgedByExitCodeAndOutput) {
    EXPECT_EQ(probe_verdict({{"true"}}, true, 0.5).outcome, Outcome::passed);
    const Verdict wrong = probe_verdict({{"echo so >&2; exit 3"}}, true, 0.5);
    EXPECT_EQ(wrong.outcome, Outcome::failed);
    EXPECT_EQ(wrong.evidence, "the command ended with exit code 3; it printed: so");
    Probe probe{{"/bin/sh", "-c", "echo '{\"w\":\"'$SKYLOOP_WORD'\"}'; exit 3"}};
    probe.expect_exit = 3;
    probe.condition = *parse_json_condition("w == moon");
    EXPECT_EQ(probe_verdict(probe, true, 0.5).outcome, Outcome::passed);
    probe.condition = *parse_json_condition("w == sun");
    EXPECT_THAT(probe_verdict(probe, true, 0.5).evidence, HasSubstr("no line of it fulfilled the condition"));
}

TEST(JudgeProbes, AConditionEndsAnEndlessCommand) {
    Probe probe{{"while true; do echo '{\"mode\":3}'; sleep 0.02; done"}};
    probe.condition = *parse_json_condition("mode >= 3");
    const Verdict verdict = probe_verdict(probe, true, 1);
    EXPECT_EQ(verdict.outcome, Outcome::passed);
    EXPECT_TRUE(verdict.decided_at);
}

TEST(JudgeProbes, AreKilledWithTheRunAndRefusedInVirtualTime) {
    const Verdict killed = probe_verdict({{"sleep 100"}}, true, 0.2);
    EXPECT_EQ(killed.outcome, Outcome::undecided);
    EXPECT_THAT(killed.evidence, HasSubstr("killed as the run ended first"));
    const Verdict refused = probe_verdict({{"true"}}, false, 0);
    EXPECT_EQ(refused.outcome, Outcome::not_run);
    EXPECT_THAT(refused.evidence, HasSubstr("against the clock"));
    Probe late{{"true"}};
    late.at = Seconds(1000);
    EXPECT_EQ(probe_verdict(late, true, 0.1).outcome, Outcome::undecided);
}

TEST(JudgeProbes, ThatMayBeTriedAgainAreUndecidedAtTheEnd) {
    Probe probe{{"false"}};
    probe.within = Seconds(60);
    const Verdict verdict = probe_verdict(probe, true, 0.5);
    EXPECT_EQ(verdict.outcome, Outcome::undecided);
    EXPECT_THAT(verdict.evidence, HasSubstr("run ended"));
    probe.command = {"sleep 100"};
    EXPECT_EQ(probe_verdict(probe, true, 0.2).outcome, Outcome::undecided);
    probe.command = {"false"};
    probe.within = Seconds(0.1);
    EXPECT_EQ(probe_verdict(probe, true, 1.5).outcome, Outcome::failed) << "its time was over";
    probe.within.reset();
    EXPECT_EQ(probe_verdict(probe, true, 0.5).outcome, Outcome::failed);
}

TEST(JudgeProbes, ThatAreDueAtTheVeryEndAreUndecidedWhateverTheyDid) {
    for (const char* command : {"true", "false"}) {
        Expectation expectation;
        expectation.probe = Probe{{command}};
        expectation.probe->at = Seconds(60);
        Judge judge({expectation}, {test::run_start, {"receiver0"}, true});
        judge.advance(test::at_second(60));
        struct timespec pause {
            0, 300'000'000
        };
        ::nanosleep(&pause, nullptr);
        const Verdict verdict = judge.finish(test::at_second(60)).front();
        EXPECT_EQ(verdict.outcome, Outcome::undecided) << command;
        EXPECT_EQ(verdict.evidence, "the run ended after 60 s, before the command was due");
    }
}

}  // namespace
}  // namespace skyloop
