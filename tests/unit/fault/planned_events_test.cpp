#include "run/fault/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

namespace skyloop::test {
namespace {

using ::testing::ElementsAre;

const GpsTime begin_of_plan = to_gps_time(2300, 100'000.0);

TimelineEntry planned(std::string name, double at, std::optional<double> length = std::nullopt) {
    TimelineEntry made;
    made.name = std::move(name);
    made.at = Seconds(at);
    if (length) made.length = Seconds(*length);
    return made;
}

TimelineEntry commanded(double at, TimelineOrder order) {
    TimelineEntry made = planned(order.begins ? "start" : "stop", at, 0);
    made.once = true;
    made.order = std::move(order);
    return made;
}

TimelineEntry behind(TimelineEntry entry, const std::string& other) {
    entry.after = other;
    entry.after_end = true;
    return entry;
}

// "gap+10" begins, "gap-30" ends.
std::vector<std::string> plan(const std::vector<TimelineEntry>& entries, double until) {
    std::vector<std::string> told;
    for (const TimelineEvent& event :
         planned_events(entries, {begin_of_plan, advanced(begin_of_plan, Seconds(until)), 1}, 100))
        told.push_back(fmt::format("{}{}{:g}", entries[event.entry].name, event.begins ? "+" : "-",
                                   difference(event.time, begin_of_plan).value()));
    return told;
}

TEST(PlannedEvents, EndWhereACommandStopsThem) {
    EXPECT_THAT(plan({planned("gap", 10, 20), behind(planned("next", 1, 2), "gap"), commanded(15, {"gap", false})}, 60),
                ElementsAre("gap+10", "stop+15", "gap-15", "next+16", "next-18"));
    EXPECT_THAT(plan({planned("gap", 10), planned("other", 12, 5), commanded(14, {"", false})}, 60),
                ElementsAre("gap+10", "other+12", "stop+14", "gap-14", "other-14"));
}

TEST(PlannedEvents, BeginWhereACommandStartsThem) {
    TimelineEntry made = planned("made", 0, 50);
    made.by_hand = true;
    EXPECT_THAT(plan({made, commanded(5, {"made", true, Seconds(3)})}, 60), ElementsAre("start+5", "made+5", "made-8"));
    EXPECT_THAT(plan({planned("gap", 4, 10), commanded(5, {"gap", true})}, 60),
                ElementsAre("gap+4", "start+5", "gap-14"))
        << "what is under way does not begin a second time";
}

TEST(PlannedEvents, AreNoMoreThanAskedFor) {
    TimelineEntry often = planned("often", 0, 0.1);
    often.every = Seconds(1);
    EXPECT_EQ(planned_events({often}, {begin_of_plan, advanced(begin_of_plan, Seconds(1e6)), 1}, 10).size(), 10U);
}

TEST(PlannedEvents, HangOnTriggersAlongWhatTheyComeAfterAndByCommands) {
    TimelineEntry triggered = planned("triggered", 0, 5);
    triggered.when = Trigger{};
    const std::vector<TimelineEntry> entries{triggered, behind(planned("second", 1, 1), "triggered"),
                                             behind(commanded(0, {"third", false}), "second"), planned("third", 1, 9),
                                             planned("sound", 2, 3)};
    EXPECT_THAT(hang_on_the_run(entries), ElementsAre(true, true, true, true, false));
    EXPECT_THAT(hang_on_the_run({planned("sound", 2, 3), behind(planned("last", 1, 1), "second"),
                                 behind(planned("second", 1, 1), "triggered"), triggered}),
                ElementsAre(false, true, true, true))
        << "in whichever order they stand";
    triggered.name.clear();
    EXPECT_THAT(hang_on_the_run({triggered, planned("sound", 2, 3)}), ElementsAre(true, false))
        << "who comes after nothing does not come after what has no name";
}

TEST(TimelineText, ListsWhatHangsOnACondition) {
    TimelineEntry a = planned("a", 0, 5), loss = planned("loss", 2, 5), note = planned("note", 0);
    a.when = Trigger{};
    a.when->fix_for = Seconds(3);
    loss.after = "a";
    loss.after_end = true;
    note.after = "loss";
    note.at.reset();
    note.between = {1, 4};
    EXPECT_THAT(
        timeline_text({a, loss, note, planned("b", 1, 1)}, {begin_of_plan, advanced(begin_of_plan, Seconds(60)), 1}),
        ElementsAre("       1.000 s  b begins", "       2.000 s  b ends", "          when  a: after a fix for 3 s",
                    "          then  loss: 2 s after the end of a", "          then  note: 1 to 4 s after loss"));
}

}  // namespace
}  // namespace skyloop::test
