// Sentences over runs made by hand: each subject, fulfilled and not.
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
using testing::HasSubstr;

Outcome after_one_epoch(std::string_view what, const SeenFix& fix) {
    return SeenRun(what).epoch(1, fix).end(2).outcome;
}

TEST(JudgeSubjects, FixesAreWhatIsReported) {
    SeenFix fix;
    EXPECT_EQ(after_one_epoch("fix", fix), passed);
    EXPECT_EQ(after_one_epoch("no fix", fix), failed);
    EXPECT_EQ(after_one_epoch("fix", no_fix), failed);
    EXPECT_EQ(after_one_epoch("no fix", no_fix), passed);
    EXPECT_EQ(after_one_epoch("3d fix", fix), passed);
    EXPECT_EQ(after_one_epoch("2d fix", fix), failed);
    fix.type = FixType::rtk_fixed;
    EXPECT_EQ(after_one_epoch("rtk fixed", fix), passed);
    EXPECT_EQ(after_one_epoch("3d fix", fix), passed) << "a fixed solution is three-dimensional";
    EXPECT_EQ(after_one_epoch("rtk float", fix), failed);
    fix.valid = false;
    EXPECT_EQ(after_one_epoch("fix", fix), failed);
    EXPECT_EQ(after_one_epoch("no fix", fix), passed);
    EXPECT_EQ(after_one_epoch("time only", {FixType::time_only}), passed);
    EXPECT_EQ(after_one_epoch("fix", {FixType::time_only}), failed);
    EXPECT_EQ(after_one_epoch("dead reckoning", {FixType::dead_reckoning}), passed);
}

TEST(JudgeSubjects, AnEpochThatIsNotToldIsNoneAfterTwoSeconds) {
    SeenFix untold;
    untold.told = false;
    EXPECT_EQ(SeenRun("fix always").epochs(0, 5).epoch(6, untold).epochs(7, 10).end(10).outcome, passed)
        << "one is missing, and the one before still counts";
    const Verdict lost = SeenRun("fix always").epochs(0, 5).epochs(6, 7, untold).epochs(8, 10).end(10);
    EXPECT_EQ(lost.outcome, failed);
    EXPECT_EQ(lost.run_time.value(), 7);
    EXPECT_THAT(lost.evidence, HasSubstr("nothing is reported"));
    EXPECT_EQ(
        SeenRun("no fix within 2 s of outage").epochs(0, 5).begins(5.5, "outage").epochs(6, 9, untold).end(10).outcome,
        passed);
    EXPECT_EQ(SeenRun("horizontal error below 5 m always").epochs(0, 5).epochs(6, 9, untold).end(10).outcome, failed);
    EXPECT_EQ(SeenRun("spoofing flagged within 5 s of run").epochs(0, 5, untold).end(6).outcome, failed);
}

TEST(JudgeSubjects, NumbersAreComparedInTheirUnits) {
    SeenFix fix;
    fix.east_error_m = 7;
    fix.up_error_m = -12;
    fix.speed_error_mps = 0.5;
    EXPECT_EQ(after_one_epoch("horizontal error above 6.9 m", fix), passed);
    EXPECT_EQ(after_one_epoch("horizontal error above 7.1 m", fix), failed);
    EXPECT_EQ(after_one_epoch("vertical error above 11.9 m", fix), passed);
    EXPECT_EQ(after_one_epoch("vertical error below 11.9 m", fix), failed);
    EXPECT_EQ(after_one_epoch("speed error at most 0.51 m/s", fix), passed);
    EXPECT_EQ(after_one_epoch("speed error at most 0.49 m/s", fix), failed);
    EXPECT_EQ(after_one_epoch("h_acc at least 3 m", fix), passed);
    EXPECT_EQ(after_one_epoch("h_acc above 3 m", fix), failed);
    EXPECT_EQ(after_one_epoch("v_acc above 5 m", fix), passed);
    EXPECT_EQ(after_one_epoch("HDOP above 1.1", fix), passed);
    EXPECT_EQ(after_one_epoch("HDOP above 1.3", fix), failed);
    EXPECT_EQ(after_one_epoch("VDOP above 1.5", fix), passed);
    EXPECT_EQ(after_one_epoch("PDOP at most 1.9", fix), failed);
    EXPECT_EQ(after_one_epoch("HDOP below 1.3", no_fix), failed);
    EXPECT_EQ(after_one_epoch("satellites at least 8", fix), passed);
    EXPECT_EQ(after_one_epoch("satellites at least 9", fix), failed);
    EXPECT_EQ(after_one_epoch("satellites at most 0", no_fix), passed);
    EXPECT_EQ(after_one_epoch("C/N0 above 49 dBHz", fix), passed) << "46 … 53: mean 49.5";
    EXPECT_EQ(after_one_epoch("C/N0 above 50 dBHz", fix), failed);
    EXPECT_EQ(after_one_epoch("C/N0 of G08 above 52 dBHz", fix), passed);
    EXPECT_EQ(after_one_epoch("C/N0 of E08 above 1 dBHz", fix), failed);
    EXPECT_EQ(after_one_epoch("horizontal error below 100 m", no_fix), failed) << "there is no error without a fix";
    EXPECT_THAT(SeenRun("horizontal error below 5 m always").epoch(1, fix).end(2).evidence, HasSubstr("7.00 m"));
}

TEST(JudgeSubjects, FlagsAreThoseOfTheMonitors) {
    EXPECT_EQ(after_one_epoch("jamming flagged", {}), failed);
    SeenFix fix;
    fix.jamming = 2;
    fix.spoofing = SpoofingIndication::indicated;
    EXPECT_EQ(after_one_epoch("jamming flagged", fix), passed);
    EXPECT_EQ(after_one_epoch("spoofing flagged", fix), passed);
    EXPECT_EQ(after_one_epoch("spoofing flagged", {}), failed);
    fix.jamming_hidden = true;
    EXPECT_EQ(after_one_epoch("jamming flagged", fix), failed) << "MON-HW says nothing, and there is no SEC-SIG";
    fix.jamming_told_elsewhere = true;
    EXPECT_EQ(after_one_epoch("jamming flagged", fix), passed);
}

TEST(JudgeSubjects, MessagesGoByDirectionAndName) {
    EXPECT_EQ(SeenRun("client sends CFG-VALSET").client(1, "CFG-VALSET").end(2).outcome, passed);
    EXPECT_EQ(SeenRun("client sends cfg-*").client(1, "CFG-VALSET").end(2).outcome, passed);
    EXPECT_EQ(SeenRun("client sends anything").client(1, "MON-VER").end(2).outcome, passed);
    EXPECT_EQ(SeenRun("client sends anything").noise(1).end(2).outcome, failed);
    EXPECT_EQ(SeenRun("client sends CFG-VALSET").client(1, "CFG-VALGET").end(2).outcome, failed);
    EXPECT_EQ(SeenRun("client sends NAV-PVT").receiver(1, "NAV-PVT").end(2).outcome, failed);
    EXPECT_EQ(SeenRun("receiver sends NAV-PVT").receiver(1, "NAV-PVT").end(2).outcome, passed);
    EXPECT_THAT(SeenRun("client reconfigures").end(2).evidence, HasSubstr("(seen: nothing)"));
}

TEST(JudgeSubjects, CommandsOfACommandLineAreMessages) {
    EXPECT_EQ(SeenRun("client sends sso").command_line(1, "sso").end(2).outcome, passed);
    EXPECT_EQ(SeenRun("client sends setSBFOutput").command_line(1, "sso").end(2).outcome, passed);
    EXPECT_EQ(SeenRun("client silent throughout outage")
                  .begins(5, "outage")
                  .command_line(6, "gri")
                  .ends(8, "outage")
                  .end(10)
                  .outcome,
              failed);
    for (const char* setting : {"sso", "scs", "eccf"})
        EXPECT_EQ(SeenRun("client reconfigures").command_line(1, setting).end(2).outcome, passed) << setting;
    for (const char* other : {"gso", "lif", "erst", "SSSSSSSSSS", "sfoo"})
        EXPECT_EQ(SeenRun("client reconfigures").command_line(1, other).end(2).outcome, failed) << other;
}

TEST(JudgeSubjects, APollIsNoReconfiguration) {
    const auto after = [](std::string_view name, std::size_t payload) {
        return SeenRun("client reconfigures").client(1, name, payload).end(2).outcome;
    };
    EXPECT_EQ(after("CFG-VALSET", 9), passed);
    EXPECT_EQ(after("CFG-PRT", 20), passed);
    EXPECT_EQ(after("CFG-PRT", 1), failed);
    EXPECT_EQ(after("CFG-RATE", 0), failed);
    EXPECT_EQ(after("CFG-VALGET", 8), failed);
    EXPECT_EQ(after("CFG-MSG", 2), failed);
    EXPECT_EQ(after("CFG-MSG", 3), passed);
    EXPECT_EQ(after("MON-VER", 0), failed);
    EXPECT_EQ(after("PUBX,41", 0), passed);
    EXPECT_EQ(after("PUBX,00", 0), failed);
    EXPECT_EQ(after("PMTK220", 0), passed);
    EXPECT_EQ(after("PMTK605", 0), failed);
    for (const char* setting : {"PAIR050", "PAIR080", "PAIR400", "PAIR410", "PAIR513"})
        EXPECT_EQ(after(setting, 0), passed) << setting;
    EXPECT_EQ(after("PAIR051", 0), failed);
}

TEST(JudgeSubjects, BeliefsLastUntilTheyChange) {
    EXPECT_EQ(SeenRun("client distrusts within 2 s of outage")
                  .belief(1, true)
                  .begins(5, "outage")
                  .belief(6.5, false)
                  .end(9)
                  .outcome,
              passed);
    EXPECT_EQ(SeenRun("client distrusts within 1 s of outage")
                  .belief(1, true)
                  .begins(5, "outage")
                  .belief(6.5, false)
                  .end(9)
                  .outcome,
              failed);
    EXPECT_EQ(SeenRun("client trusts within 1 s of outage").belief(1, true).begins(5, "outage").end(9).outcome, passed);
    EXPECT_EQ(SeenRun("client trusts throughout outage")
                  .belief(1, true)
                  .begins(5, "outage")
                  .ends(7, "outage")
                  .belief(8, false)
                  .end(9)
                  .outcome,
              passed);
    const Verdict none = SeenRun("client distrusts never").end(9);
    EXPECT_EQ(none.outcome, failed);
    EXPECT_THAT(none.evidence, HasSubstr("no client told"));
}

TEST(JudgeSubjects, SilenceComesTrueAfterAWhileAndBreaksAtTheFirstMessage) {
    EXPECT_EQ(SeenRun("receiver silent within 3 s of outage").receiver(4, "A").begins(5, "outage").end(9).outcome,
              passed);
    EXPECT_EQ(SeenRun("receiver silent within 1 s of outage").receiver(4.5, "A").begins(5, "outage").end(9).outcome,
              passed)
        << "it begins within a second, and lasts two";
    EXPECT_EQ(SeenRun("client silent throughout outage")
                  .client(4, "A")
                  .begins(5, "outage")
                  .ends(8, "outage")
                  .client(9, "A")
                  .end(10)
                  .outcome,
              passed);
    EXPECT_EQ(
        SeenRun("client silent throughout outage").begins(5, "outage").client(6, "A").ends(8, "outage").end(10).outcome,
        failed);
    SeenRun steady("receiver silent for 1.5 s never"), broken("receiver silent for 1.5 s never");
    for (int second = 0; second <= 10; ++second) {
        steady.receiver(second, "A");
        if (second != 5) broken.receiver(second, "A");
    }
    EXPECT_EQ(steady.end(10).outcome, passed);
    const Verdict gap = broken.end(10);
    EXPECT_EQ(gap.outcome, failed);
    EXPECT_EQ(gap.decided_at, test::at_second(5.5));
}

TEST(JudgeSubjects, RecurringMessagesMustNotPause) {
    const std::string_view what = "receiver sends NAV-PVT every 1 s throughout outage";
    SeenRun good(what), late(what);
    good.begins(0.5, "outage");
    late.begins(0.5, "outage");
    for (int second = 1; second <= 5; ++second) {
        good.receiver(second, "NAV-PVT");
        late.receiver(second + (second == 4 ? 0.5 : 0.0), second == 4 ? "NAV-PVT" : "NAV-PVT");
    }
    EXPECT_EQ(good.ends(5.5, "outage").end(20).outcome, passed);
    const Verdict verdict = late.ends(5.5, "outage").end(20);
    EXPECT_EQ(verdict.outcome, failed);
    EXPECT_NEAR(verdict.run_time.value(), 4, 1e-6);
}

}  // namespace
}  // namespace skyloop
