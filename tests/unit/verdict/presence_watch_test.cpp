// Absences that nothing shows: what is true of a client or receiver that is not there is no evidence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/verdict/judge.hpp"
#include "seen_run.hpp"

namespace skyloop {
namespace {

using test::failed;
using test::no_fix;
using test::passed;
using test::SeenFix;
using test::SeenRun;
using test::undecided;
using testing::HasSubstr;

SeenFix untold() {
    SeenFix fix;
    fix.told = false;
    return fix;
}

TEST(JudgePresence, DistrustWithinATimeNeedsTrustBeforeIt) {
    const Verdict never =
        SeenRun("client distrusts within 5 s of freeze").belief(0, false).begins(5, "freeze").ends(9, "freeze").end(20);
    EXPECT_EQ(never.outcome, undecided);
    EXPECT_EQ(never.evidence, "the client never trusted the receiver, without which its distrust shows nothing");
    EXPECT_EQ(SeenRun("client distrusts").belief(0, false).end(20).outcome, undecided);
    EXPECT_EQ(SeenRun("client distrusts").belief(0, false).belief(3, true).end(20).outcome, failed);
    EXPECT_EQ(SeenRun("client distrusts").belief(0, false).belief(3, true).belief(4, false).end(20).outcome, passed);
    SeenRun late("client distrusts within 5 s of freeze");
    late.belief(0, false).begins(5, "freeze").belief(6, true).belief(7, false);
    EXPECT_EQ(late.end(20).evidence, "came true 2 s after freeze began (seen: no message for 2.0 s)");
    SeenRun second("client distrusts within 2 s of freeze");
    second.belief(0, false).begins(5, "freeze").belief(9, true).begins(12, "freeze", 2).belief(13, false);
    EXPECT_EQ(second.so_far().outcome, undecided);
    EXPECT_EQ(second.so_far().evidence, "") << "the first one is without evidence, whatever the second shows";
    EXPECT_EQ(second.end(20).outcome, undecided);
}

TEST(JudgePresence, DistrustThatLastsNeedsTrustSomeTimeInTheRun) {
    for (const char* what : {"client distrusts from 2 s to 8 s", "client trusts never from 2 s to 8 s"}) {
        EXPECT_EQ(SeenRun(what).belief(0, false).end(20).outcome, undecided) << what;
        EXPECT_EQ(SeenRun(what).belief(0, false).belief(9, true).end(20).outcome, passed) << what;
        EXPECT_EQ(SeenRun(what).belief(0, false).belief(1, true).belief(1.5, false).end(20).outcome, passed) << what;
        EXPECT_EQ(SeenRun(what).belief(0, false).belief(3, true).end(20).outcome, failed) << what;
    }
    EXPECT_EQ(SeenRun("client distrusts at 5 s").belief(0, false).end(20).outcome, undecided);
    SeenRun pending("client distrusts from 2 s to 8 s");
    pending.belief(0, false).epoch(9);
    EXPECT_EQ(pending.so_far().outcome, undecided) << "trust may still come";
    EXPECT_EQ(pending.belief(10, true).so_far().outcome, passed);
}

TEST(JudgePresence, SilenceNeedsSomethingSentInTheRun) {
    const std::string_view during = "receiver silent during outage";
    const Verdict never = SeenRun(during).begins(5, "outage").ends(8, "outage").end(20);
    EXPECT_EQ(never.outcome, undecided);
    EXPECT_EQ(never.evidence, "the receiver sent nothing in the whole run, so that its silence shows nothing");
    EXPECT_EQ(SeenRun(during).begins(5, "outage").ends(8, "outage").receiver(9, "GGA").end(20).outcome, passed);
    EXPECT_EQ(SeenRun("client silent during outage").begins(5, "outage").ends(8, "outage").end(20).evidence,
              "no client sent anything in the whole run, so that its silence shows nothing");
    const std::string_view within = "receiver silent within 1 s of outage";
    EXPECT_EQ(SeenRun(within).begins(5, "outage").end(20).outcome, undecided);
    EXPECT_EQ(SeenRun(within).begins(5, "outage").receiver(9, "GGA").end(20).outcome, undecided)
        << "nothing was lost by the outage";
    EXPECT_EQ(SeenRun("client silent for 3 s").end(20).outcome, undecided);
    EXPECT_EQ(SeenRun("client silent for 3 s").client(2, "MON-VER").end(20).outcome, passed);
}

TEST(JudgePresence, NeverAMessageNeedsOneOfTheSameSender) {
    EXPECT_EQ(SeenRun("client reconfigures never").end(10).outcome, undecided);
    EXPECT_EQ(SeenRun("client reconfigures never").receiver(1, "NAV-PVT").end(10).outcome, undecided);
    EXPECT_EQ(SeenRun("client reconfigures never").noise(1).end(10).outcome, undecided);
    EXPECT_EQ(SeenRun("client reconfigures never").client(1, "MON-VER").end(10).outcome, passed);
    EXPECT_EQ(SeenRun("client reconfigures never").belief(1, true).end(10).outcome, passed) << "one that only listens";
    EXPECT_EQ(SeenRun("receiver sends GGA never").end(10).outcome, undecided);
    EXPECT_EQ(SeenRun("receiver sends GGA never").receiver(1, "NAV-PVT").end(10).outcome, passed);
}

TEST(JudgePresence, AStretchShorterThanARecurringMessageNeedsOneInTheRun) {
    const std::string_view what = "receiver sends GGA every 5 s from 10 s to 12 s";
    const Verdict none = SeenRun(what).end(20);
    EXPECT_EQ(none.outcome, undecided);
    EXPECT_EQ(none.evidence, "no such message came in the whole run");
    EXPECT_EQ(SeenRun(what).receiver(8, "GGA").receiver(13, "GGA").end(20).outcome, passed);
}

TEST(JudgePresence, NoFixNeedsAReceiverThatReports) {
    EXPECT_EQ(SeenRun("no fix from 0 s to 9 s").end(20).outcome, undecided);
    EXPECT_EQ(SeenRun("no fix at 3 s").end(20).outcome, failed) << "nothing was reported by then";
    const Verdict none = SeenRun("no fix from 10 s to 19 s").epochs(0, 19, untold()).end(20);
    EXPECT_EQ(none.outcome, undecided);
    EXPECT_EQ(none.evidence, "the receiver never reported an epoch, without which a missing fix shows nothing");
    EXPECT_EQ(SeenRun("no fix within 8 s of outage").begins(10, "outage").end(20).outcome, undecided);
    EXPECT_EQ(SeenRun("no fix from 10 s to 19 s").epochs(0, 5).end(20).outcome, passed);
    EXPECT_EQ(SeenRun("no fix from 10 s to 19 s").epochs(0, 5, no_fix).end(20).outcome, passed);
}

TEST(JudgePresence, NeverNeedsSomethingComparedInItsTime) {
    for (const char* what : {"spoofing flagged never", "rtk fixed never", "satellites at most 3 never"}) {
        EXPECT_EQ(SeenRun(what).epochs(0, 9).end(10).outcome, passed) << what;
        EXPECT_EQ(SeenRun(what).epochs(0, 9, untold()).end(10).outcome, undecided) << what;
        EXPECT_EQ(SeenRun(what).end(10).outcome, undecided) << what;
    }
    const std::string_view error = "horizontal error above 50 m never";
    EXPECT_EQ(SeenRun(error).epochs(0, 9).end(10).outcome, passed);
    const Verdict none = SeenRun(error).epochs(0, 9, no_fix).end(10);
    EXPECT_EQ(none.outcome, undecided);
    EXPECT_EQ(none.evidence, "the receiver reported no such number in that time");
    EXPECT_EQ(SeenRun("horizontal error above 50 m never from 5 s to 8 s")
                  .epochs(0, 4)
                  .epochs(5, 8, no_fix)
                  .epochs(9, 10)
                  .end(11)
                  .outcome,
              undecided)
        << "there was a fix before and after alone";
    EXPECT_EQ(SeenRun("spoofing flagged never from 5.2 s to 5.4 s").epochs(0, 9).end(10).outcome, passed)
        << "as the epoch before it reported";
}

TEST(JudgeSilence, WithinATimeBeginsInThatTimeAndLasts) {
    const auto last_sent_at = [](double second) {
        return SeenRun("receiver silent within 1 s of power_cut")
            .receiver(4.9, "NAV-PVT")
            .begins(5, "power_cut")
            .receiver(second, "NAV-PVT")
            .end(20);
    };
    const Verdict good = last_sent_at(5.4);
    EXPECT_EQ(good.outcome, passed);
    EXPECT_EQ(good.evidence, "came true 0.4 s after power_cut began (seen: nothing sent)");
    EXPECT_EQ(good.decided_at, test::at_second(7.4)) << "a silence is two seconds";
    EXPECT_EQ(last_sent_at(6).outcome, passed) << "the deadline belongs to the window";
    const Verdict bad = last_sent_at(6.1);
    EXPECT_EQ(bad.outcome, failed);
    EXPECT_EQ(bad.evidence, "did not begin by 1 s after power_cut began (seen: NAV-PVT)");
    EXPECT_EQ(SeenRun("receiver silent within 1 s of power_cut")
                  .receiver(1, "NAV-PVT")
                  .begins(5, "power_cut")
                  .receiver(6.5, "NAV-PVT")
                  .end(20)
                  .outcome,
              failed)
        << "silence before the event is not of it";
}

TEST(JudgeSilence, DuringAndWithinAnEventAgree) {
    for (const double length : {3.0, 10.0})
        for (const char* what : {"receiver silent within 1 s of power_cut", "receiver silent during power_cut"})
            EXPECT_EQ(SeenRun(what)
                          .receiver(4.9, "NAV-PVT")
                          .begins(5, "power_cut")
                          .ends(5 + length, "power_cut")
                          .receiver(5.2 + length, "NAV-PVT")
                          .end(20)
                          .outcome,
                      passed)
                << what << ", " << length << " s";
}

TEST(JudgeSilence, WithinATimeIsUndecidedWhereTheRunEndsFirst) {
    EXPECT_EQ(SeenRun("receiver silent within 1 s of power_cut").receiver(4, "A").begins(5, "power_cut").end(6).outcome,
              undecided);
}

}  // namespace
}  // namespace skyloop
