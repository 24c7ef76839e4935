// Sentences over runs made by hand: each time, fulfilled and not.
#include "run/verdict/judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "seen_run.hpp"

namespace skyloop {
namespace {

using test::expectation_of;
using test::no_fix;
using test::SeenFix;
using test::SeenRun;
using testing::HasSubstr;

using test::failed;
using test::passed;
using test::undecided;

TEST(JudgeTimes, WithinMustComeTrueInTime) {
    const auto lost_at = [](double second) {
        return SeenRun("no fix within 2 s of the outage")
            .epoch(9)
            .begins(10, "tunnel")
            .epoch(10.5)
            .epoch(second, no_fix)
            .end(20);
    };
    const Verdict good = lost_at(11.2);
    EXPECT_EQ(good.outcome, passed);
    EXPECT_EQ(good.evidence, "came true 1.2 s after outage began (seen: no fix)");
    EXPECT_EQ(good.decided_at, test::at_second(11.2));
    EXPECT_EQ(lost_at(12).outcome, passed) << "the deadline belongs to the window";
    const Verdict bad = lost_at(12.5);
    EXPECT_EQ(bad.outcome, failed);
    EXPECT_EQ(bad.evidence, "did not come true by 2 s after outage began (seen: 3d)");
    EXPECT_EQ(bad.decided_at, test::at_second(12));
}

TEST(JudgeTimes, AnEpochOfBeforeTheEventDoesNotFulfilIt) {
    EXPECT_EQ(SeenRun("fix within 2 s of reboot")
                  .epoch(9)
                  .command(9.5, "again", CommandVerb::reboot)
                  .epoch(10, no_fix)
                  .end(20)
                  .outcome,
              failed);
    EXPECT_EQ(SeenRun("fix within 2 s of again")
                  .epoch(9)
                  .command(9.5, "again", CommandVerb::reboot)
                  .epoch(11)
                  .end(20)
                  .outcome,
              passed);
}

TEST(JudgeTimes, WithinNeedsAnEpochInThatTime) {
    const Verdict none =
        SeenRun("fix within 0.5 s of outage").epochs(8, 10).begins(10.2, "outage").epochs(11, 14).end(20);
    EXPECT_EQ(none.outcome, failed);
    EXPECT_EQ(none.evidence, "did not come true by 0.5 s after outage began: no epoch came in that time");
    EXPECT_EQ(SeenRun("fix within 0.9 s of outage").epochs(8, 10).begins(10.2, "outage").epochs(11, 14).end(20).outcome,
              passed);
    EXPECT_EQ(SeenRun("fix 0.5 s after outage").epochs(8, 10).begins(10.2, "outage").epochs(11, 14).end(20).outcome,
              passed)
        << "an instant is as the last epoch was";
    EXPECT_EQ(SeenRun("no fix within 1 s of outage").epochs(1, 4).begins(12, "outage").end(20).outcome, passed)
        << "a receiver that tells of no epoch all that time has none";
    EXPECT_EQ(SeenRun("fix within 1 s of outage").epochs(1, 4).begins(12, "outage").end(20).outcome, failed);
}

TEST(JudgeTimes, EachOccurrenceHasToBeAnswered) {
    SeenRun run("client reconfigures within 1 s of outage");
    run.begins(10, "outage", 1).client(10.4, "CFG-RST").begins(20, "outage", 2).client(20.8, "CFG-RST");
    EXPECT_THAT(run.end(30).evidence,
                HasSubstr("came true 2 times, at the latest 0.8 s after outage began (seen: CFG-RST)"));
    SeenRun second("client reconfigures within 1 s of outage");
    EXPECT_EQ(second.begins(10, "outage", 1).client(10.4, "CFG-RST").begins(20, "outage", 2).end(30).outcome, failed);
    SeenRun only("client reconfigures within 1 s of outage#1");
    EXPECT_EQ(only.begins(10, "outage", 1).client(10.4, "CFG-RST").begins(20, "outage", 2).end(30).outcome, passed);
}

TEST(JudgeTimes, OccurrencesAreCountedOverAllThatTheNameFits) {
    const auto two_outages = [](std::string_view what) {
        return SeenRun(what)
            .begins(5, "tunnel")
            .epoch(6)
            .begins(10, "bridge")
            .epoch(11, no_fix)
            .ends(12, "bridge")
            .epoch(13)
            .ends(20, "tunnel")
            .epoch(21, no_fix)
            .end(30)
            .outcome;
    };
    EXPECT_EQ(two_outages("no fix within 2 s of outage#1"), failed);
    EXPECT_EQ(two_outages("no fix within 2 s of outage#2"), passed);
    EXPECT_EQ(two_outages("no fix within 2 s of outage#3"), failed) << "it never began";
    EXPECT_EQ(two_outages("no fix within 2 s of bridge#1"), passed);
    EXPECT_EQ(two_outages("no fix within 2 s of the end of outage#1"), passed);
    EXPECT_EQ(two_outages("no fix within 2 s of the end of outage#2"), failed);
    SeenRun again("fix within 2 s of reboot#2");
    again.command(5, "reboot", CommandVerb::reboot).epoch(6, no_fix).command(10, "reboot", CommandVerb::reboot);
    EXPECT_EQ(again.epoch(11).end(20).outcome, passed);
}

TEST(JudgeTimes, TheEndOfAnEventIsAnEventToo) {
    const std::string_view what = "fix within 3 s of the end of the outage";
    EXPECT_EQ(SeenRun(what).begins(5, "outage").epoch(6).ends(10, "outage").epoch(12).end(20).outcome, passed);
    EXPECT_EQ(SeenRun(what).begins(5, "outage").epoch(6).ends(10, "outage").epoch(14).end(20).outcome, failed);
    const Verdict never = SeenRun(what).begins(5, "outage").epoch(6).end(20);
    EXPECT_EQ(never.outcome, failed);
    EXPECT_EQ(never.evidence, "outage never ended");
}

TEST(JudgeTimes, ThroughoutHoldsFromStartToEnd) {
    const std::string_view what = "no fix throughout the outage";
    EXPECT_EQ(SeenRun(what)
                  .epochs(1, 4)
                  .begins(5, "outage")
                  .epochs(5, 9, no_fix)
                  .ends(9.5, "outage")
                  .epochs(10, 12)
                  .end(13)
                  .outcome,
              passed);
    const Verdict bad = SeenRun(what).begins(5, "outage").epochs(5, 7, no_fix).epoch(8).ends(9, "outage").end(13);
    EXPECT_EQ(bad.outcome, failed);
    EXPECT_EQ(bad.evidence, "did not hold 3 s after outage began (seen: 3d)");
    EXPECT_EQ(SeenRun(what).begins(5, "outage").epochs(5, 9, no_fix).end(10).outcome, passed)
        << "to the end of the run";
    EXPECT_EQ(SeenRun(what).epochs(1, 9, no_fix).end(10).outcome, failed) << "it never began";
    EXPECT_EQ(
        SeenRun("client sends X during outage").begins(5, "outage").client(6, "X").ends(7, "outage").end(10).outcome,
        passed);
    EXPECT_EQ(
        SeenRun("client sends X during outage").begins(5, "outage").ends(7, "outage").client(8, "X").end(10).outcome,
        failed);
}

TEST(JudgeTimes, AlwaysAndNeverAreOfTheWholeRun) {
    EXPECT_EQ(SeenRun("fix always").epochs(1, 9).end(10).outcome, passed);
    EXPECT_EQ(SeenRun("fix always").epochs(1, 4).epoch(5, no_fix).epochs(6, 9).end(10).outcome, failed);
    EXPECT_EQ(SeenRun("no fix never").epochs(1, 9).end(10).outcome, passed);
    const Verdict seen = SeenRun("no fix never").epochs(1, 4).epoch(5, no_fix).end(10);
    EXPECT_EQ(seen.evidence, "was true 5 s after the start of the run (seen: no fix)");
    EXPECT_EQ(SeenRun("client reconfigures never").client(3, "MON-VER").end(10).outcome, passed);
    EXPECT_EQ(SeenRun("client reconfigures never").client(3, "CFG-RST").end(10).outcome, failed);
    EXPECT_EQ(SeenRun("client reconfigures never during outage")
                  .client(3, "CFG-RST")
                  .begins(4, "outage")
                  .ends(5, "outage")
                  .end(10)
                  .outcome,
              passed);
    EXPECT_EQ(SeenRun("fix always").end(2).outcome, failed) << "nothing was seen";
}

TEST(JudgeTimes, WindowsAndInstantsByTheClock) {
    EXPECT_EQ(SeenRun("fix from 3 s to 6 s").epochs(1, 2, no_fix).epochs(3, 6).epochs(7, 9, no_fix).end(10).outcome,
              passed);
    EXPECT_EQ(SeenRun("fix from 3 s to 6 s").epochs(1, 5).epoch(6, no_fix).end(10).outcome, failed);
    EXPECT_EQ(SeenRun("client sends X from 3 s to 6 s").client(5, "X").end(10).outcome, passed);
    EXPECT_EQ(SeenRun("client sends X from 3 s to 6 s").client(2, "X").client(7, "X").end(10).outcome, failed);
    EXPECT_EQ(SeenRun("fix at 5 s").epochs(1, 4, no_fix).epoch(5).epochs(6, 9, no_fix).end(10).outcome, passed);
    EXPECT_EQ(SeenRun("fix at 5 s").epochs(1, 4).epochs(5, 9, no_fix).end(10).outcome, failed);
    EXPECT_EQ(SeenRun("fix at 5.5 s").epoch(5).epoch(6, no_fix).end(10).outcome, passed) << "as it last reported";
    EXPECT_EQ(SeenRun("fix at 10 s").epochs(1, 10).end(10).outcome, passed);
}

TEST(JudgeTimes, WindowsAndInstantsByAnEvent) {
    EXPECT_EQ(
        SeenRun("no fix 2 s after the outage").begins(5, "outage").epochs(5, 6).epochs(7, 8, no_fix).end(10).outcome,
        passed);
    EXPECT_EQ(SeenRun("no fix 2 s after the outage").begins(5, "outage").epochs(5, 7).epoch(8, no_fix).end(10).outcome,
              failed);
    EXPECT_EQ(SeenRun("fix until the outage").epochs(1, 4).begins(5, "outage").epochs(5, 8, no_fix).end(10).outcome,
              passed);
    EXPECT_EQ(SeenRun("fix until the outage").epoch(1).epoch(2, no_fix).begins(5, "outage").end(10).outcome, failed);
    EXPECT_EQ(SeenRun("fix until the outage").epochs(1, 9).end(10).evidence, "outage never began");
    EXPECT_EQ(SeenRun("no fix after the outage").begins(5, "outage").epochs(5, 9, no_fix).end(10).outcome, passed);
    EXPECT_EQ(SeenRun("no fix after the outage").begins(5, "outage").epochs(5, 8, no_fix).epoch(9).end(10).outcome,
              failed);
    EXPECT_EQ(
        SeenRun("no fix after the outage for 3 s").begins(5, "outage").epochs(5, 8, no_fix).epoch(9).end(10).outcome,
        passed);
    EXPECT_EQ(SeenRun("no fix from 1 s to 3 s after outage")
                  .begins(5, "outage")
                  .epoch(5)
                  .epochs(6, 8, no_fix)
                  .epoch(9)
                  .end(10)
                  .outcome,
              passed);
}

TEST(JudgeTimes, ARunThatEndsFirstLeavesItOpen) {
    const Verdict within = SeenRun("no fix within 9 s of outage").epochs(1, 4).begins(5, "outage").epochs(5, 9).end(10);
    EXPECT_EQ(within.outcome, undecided);
    EXPECT_EQ(within.evidence, "the run ended after 10 s, before the time was over; it had not come true (seen: 3d)");
    EXPECT_EQ(SeenRun("no fix within 9 s of outage")
                  .epochs(1, 4)
                  .begins(5, "outage")
                  .epochs(5, 9)
                  .epoch(9.5, no_fix)
                  .end(10)
                  .outcome,
              passed);
    EXPECT_EQ(SeenRun("receiver sends GGA within 9 s of outage")
                  .epochs(1, 4)
                  .begins(5, "outage")
                  .epochs(5, 9)
                  .end(10)
                  .outcome,
              undecided);
    EXPECT_EQ(SeenRun("no fix within 5 s of outage").epochs(1, 4).begins(5, "outage").epochs(5, 9).end(10).outcome,
              failed)
        << "its time was over";
    EXPECT_EQ(SeenRun("fix after the outage for 9 s").epochs(1, 4).begins(5, "outage").epochs(5, 9).end(10).outcome,
              undecided);
    EXPECT_EQ(SeenRun("fix at 30 s").epochs(1, 9).end(10).outcome, undecided);
    EXPECT_EQ(SeenRun("fix from 20 s to 30 s").epochs(1, 9).end(10).outcome, undecided);
}

TEST(JudgeTimes, ARunThatIsCutLeavesOpenWhatWasToLastToItsEnd) {
    const Verdict always = SeenRun("fix always").epochs(1, 9).cut(10);
    EXPECT_EQ(always.outcome, undecided);
    EXPECT_EQ(always.evidence, "the run ended after 10 s, before the time was over");
    EXPECT_EQ(SeenRun("no fix never").epochs(1, 9).cut(10).outcome, undecided);
    EXPECT_EQ(SeenRun("fix always").epochs(1, 4).epochs(5, 9, no_fix).cut(10).outcome, failed) << "whatever comes";
    EXPECT_EQ(SeenRun("fix within 5 s of the start of run").epochs(1, 9).cut(10).outcome, passed) << "for good";
    const Verdict outage = SeenRun("no fix within 5 s of the outage").epochs(1, 9).cut(10);
    EXPECT_EQ(outage.outcome, undecided);
    EXPECT_EQ(outage.evidence, "the run was stopped after 10 s; until then outage never began");
}

TEST(JudgeTimes, AReceiverThatMakesNoEpochsHasNoFix) {
    EXPECT_EQ(SeenRun("fix always").epochs(1, 4).end(20).outcome, failed);
    const Verdict lost = SeenRun("no fix within 6 s of outage").epochs(1, 4).begins(4.5, "outage").end(20);
    EXPECT_EQ(lost.outcome, passed);
    EXPECT_THAT(lost.evidence, HasSubstr("no epoch for 5 s"));
}

TEST(Judge, FollowsEachReceiverOrTheOneNamed) {
    const auto run = [](std::string receiver) {
        SeenRun seen({test::expectation_of("fix always", std::move(receiver))}, {"left", "right"});
        for (int second = 1; second < 5; ++second)
            seen.epoch(second, {}, 0).epoch(second, no_fix, 1);
        return seen.end(5);
    };
    EXPECT_EQ(run("left").outcome, passed);
    EXPECT_EQ(run("right").outcome, failed);
    EXPECT_THAT(run("").evidence, HasSubstr("right: did not hold"));
    EXPECT_THAT(run("middle").evidence, HasSubstr("no receiver is called 'middle'"));
}

TEST(Judge, KeepsABoundedNumberOfInstants) {
    SeenRun run("fix 1000 s after outage");
    for (int i = 1; i <= 2000; ++i)
        run.begins(i * 0.1, "outage", i).ends(i * 0.1, "outage", i);
    EXPECT_THAT(run.end(300).evidence, HasSubstr("more than 1024 instants"));
}

TEST(Judge, TimesThatGoBackCountAsNow) {
    EXPECT_EQ(SeenRun("client sends X from 3 s to 6 s").epoch(7).client(5, "X").end(10).outcome, failed);
}

TEST(JudgeTimes, CountEachOccurrenceThatIsAnsweredTogetherWithAnother) {
    SeenRun run("no fix within 8 s of outage");
    run.epochs(1, 5).begins(5.5, "outage").epochs(6, 9).begins(9.5, "outage", 2).epoch(10, no_fix).epochs(11, 13);
    run.begins(13.5, "outage", 3).epoch(14).epoch(15, no_fix);
    const Verdict verdict = run.end(30);
    EXPECT_EQ(verdict.outcome, passed);
    EXPECT_THAT(verdict.evidence, HasSubstr("came true 3 times, at the latest 4.5 s after outage began"));
}

TEST(JudgeSoFar, KnowsWhatNothingCanChangeAnyMore) {
    SeenRun lasting("fix always");
    EXPECT_EQ(lasting.so_far().outcome, undecided);
    lasting.epochs(1, 3);
    EXPECT_EQ(lasting.so_far().outcome, undecided) << "it may fail yet";
    EXPECT_EQ(lasting.so_far().evidence, "");
    lasting.epoch(4, no_fix);
    EXPECT_EQ(lasting.so_far().outcome, failed);
    EXPECT_EQ(lasting.so_far().run_time.value(), 4);
    const std::string evidence = lasting.so_far().evidence;
    EXPECT_NE(evidence, "");
    EXPECT_EQ(lasting.end(10).evidence, evidence) << "the end tells the same";
}

TEST(JudgeSoFar, PassesWhatEachOccurrenceSoFarFulfilled) {
    SeenRun run("fix within 3 s of outage");
    run.epochs(1, 9);
    EXPECT_EQ(run.so_far().outcome, undecided) << "no outage has come";
    run.begins(10, "outage").epoch(11, no_fix);
    EXPECT_EQ(run.so_far().outcome, undecided) << "there is time";
    run.epoch(12);
    EXPECT_EQ(run.so_far().outcome, passed);
    EXPECT_THAT(run.so_far().evidence, HasSubstr("2 s after outage began"));
    run.begins(20, "outage").epoch(24, no_fix);
    EXPECT_EQ(run.so_far().outcome, failed) << "the second one lasted too long";
}

TEST(JudgeSoFar, OfSeveralReceiversTheWorstSpeaks) {
    SeenRun run({expectation_of("fix always")}, {"front", "rear"});
    run.epoch(1).epoch(1, no_fix, 1);
    EXPECT_EQ(run.so_far().outcome, failed);
    EXPECT_THAT(run.so_far().evidence, testing::StartsWith("rear: "));
}

TEST(JudgeEvidence, OfAStretchIsWhatWasSeenInIt) {
    SeenFix small, large, largest;
    small.east_error_m = 2;
    large.east_error_m = 95;
    largest.east_error_m = 104.5;
    const Verdict error = SeenRun("horizontal error above 90 m throughout jump")
                              .epoch(1, small)
                              .begins(2, "jump")
                              .epoch(2.1, large)
                              .epoch(3, largest)
                              .epoch(4, large)
                              .ends(4.5, "jump")
                              .epochs(5, 9, small)
                              .end(10);
    EXPECT_EQ(error.outcome, passed);
    EXPECT_THAT(error.evidence, HasSubstr("held (seen: 95.00 to 104.50 m)"));
    const Verdict lost = SeenRun("no fix throughout stale")
                             .begins(2, "stale")
                             .epochs(2, 4, no_fix)
                             .ends(4.5, "stale")
                             .epochs(5, 9)
                             .end(10);
    EXPECT_EQ(lost.outcome, passed);
    EXPECT_THAT(lost.evidence, HasSubstr("held (seen: no fix)"));
    const Verdict avoided =
        SeenRun("horizontal error above 90 m never from 2 s to 4 s").epochs(1, 4, small).epochs(5, 9, large).end(10);
    EXPECT_EQ(avoided.outcome, passed);
    EXPECT_THAT(avoided.evidence, HasSubstr("was not true (seen: 2.00 m)"));
}

TEST(JudgeEvidence, OfAnInstantIsWhatWasSeenThen) {
    SeenFix then, later;
    then.east_error_m = 3;
    later.east_error_m = 70;
    const Verdict verdict = SeenRun("horizontal error below 5 m at 3 s").epochs(1, 3, then).epochs(4, 9, later).end(10);
    EXPECT_EQ(verdict.outcome, passed);
    EXPECT_THAT(verdict.evidence, HasSubstr("held (seen: 3.00 m)"));
}

TEST(JudgeEvidence, OfSilenceIsThatNothingCame) {
    const Verdict verdict = SeenRun("receiver silent throughout cut")
                                .receiver(1, "NAV-PVT")
                                .begins(2, "cut")
                                .ends(8, "cut")
                                .receiver(9, "NAV-PVT")
                                .end(10);
    EXPECT_EQ(verdict.outcome, passed);
    EXPECT_THAT(verdict.evidence, HasSubstr("held (seen: nothing sent)"));
}

}  // namespace
}  // namespace skyloop
