// [[fault]] and [[command]].
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "run/scenario/scenario_file.hpp"
#include "run/scenario/timeline_check.hpp"
#include "scenario_text.hpp"

namespace skyloop::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ScenarioTimeline, FaultsAreReadWithTheirStandards) {
    const Scenario scenario = scenario_of(R"toml(
[[receiver]]
name = "left"
[[receiver]]
name = "right"
[[fault]]
kind = "byte_loss"
at_s = 5
for_s = 2.5
ramp_in_s = 1
probability = 0.25
receiver = "right"
[[fault]]
kind = "byte_loss"
when_inside = [[47, 8], [47, 9], [48, 9]]
probability = 0.5
)toml");
    ASSERT_THAT(scenario.faults, SizeIs(2));
    const FaultEntry& first = scenario.faults[0];
    EXPECT_EQ(first.when.name, "byte_loss");
    EXPECT_EQ(first.when.at, Seconds(5));
    EXPECT_EQ(first.when.length, Seconds(2.5));
    EXPECT_EQ(first.when.ramp_in, Seconds(1));
    EXPECT_EQ(first.parameters.number("probability"), 0.25);
    EXPECT_EQ(first.parameters.text("direction"), "to_client");
    EXPECT_THAT(first.receivers, ElementsAre(1));
    const FaultEntry& second = scenario.faults[1];
    EXPECT_EQ(second.when.name, "byte_loss 2");
    ASSERT_TRUE(second.when.when);
    EXPECT_THAT(second.when.when->inside, SizeIs(3));
    EXPECT_THAT(second.receivers, ElementsAre(0, 1));
}

TEST(ScenarioTimeline, CommandsAreRead) {
    const Scenario scenario = scenario_of(R"toml(
[[command]]
kind = "set_baud"
baud = 9600
at_utc = 2024-03-05T12:00:00Z
receiver = "receiver0"
)toml");
    ASSERT_THAT(scenario.commands, SizeIs(1));
    const CommandEntry& entry = scenario.commands[0];
    EXPECT_EQ(entry.command.verb, CommandVerb::set_baud);
    EXPECT_EQ(entry.command.parameters.number("baud"), 9600);
    EXPECT_THAT(entry.command.receivers, ElementsAre("receiver0"));
    EXPECT_EQ(entry.command.source, "scenario");
    EXPECT_TRUE(entry.when.once);
    ASSERT_TRUE(entry.when.at_time);
    EXPECT_THAT(timeline_of(scenario), SizeIs(1));
}

TEST(ScenarioTimeline, MistakesAreToldWhereTheyStand) {
    const auto mistakes = [](std::string_view text) {
        const auto scenario = read_scenario(text, "test.toml");
        return scenario ? std::string() : scenario.error().message;
    };
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nazimuth_from_deg = 400\n"),
                HasSubstr("test.toml:3:20: fault.azimuth_from_deg: is 400; expected a number from -360 to 360"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsignals = [\"L1\", 7]\n"),
                HasSubstr("fault.signals: is a list"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"jamming\"\njammer_at = [47, 8, [\"high\"]]\neirp_dbw = 3\n"),
                HasSubstr("test.toml:3:13: fault.jammer_at: is a list; expected"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nname = \"a\"\n[[command]]\nkind = \"note\"\nname = \"a\"\n"),
                HasSubstr("test.toml:6:8: command.name: is that of another entry"));
    EXPECT_THAT(
        mistakes("[[fault]]\nkind = \"outage\"\nname = \"a\"\nafter = \"b\"\n[[fault]]\nkind = \"outage\"\nname "
                 "= \"b\"\nafter = \"a\"\n"),
        HasSubstr("in a circle"));
    EXPECT_THAT(mistakes("[[command]]\nkind = \"pause\"\nreceiver = \"receiver0\"\n"),
                HasSubstr("not for one receiver alone"));
    EXPECT_THAT(mistakes("[[receiver]]\n[[receiver]]\n[[receiver]]\n[[command]]\nkind = \"reboot\"\n"
                         "receiver = [\"receiver0\", \"receiver1\"]\n"),
                HasSubstr("test.toml:6:12: command.receiver: names 2 receivers"));
    EXPECT_THAT(mistakes("[[command]]\nkind = \"move_to\"\nat = [91, 0]\n"),
                HasSubstr("test.toml:3:6: command.at: latitude is 91"));
    EXPECT_EQ(
        mistakes("[[fault]]\nkind = \"spoof_takeover\"\noffset_m = [1, 2]\n"),
        "test.toml:3:12: fault.offset_m: is a list of 2 numbers; expected a list of 3 numbers from -100000 to 100000")
        << "that nothing is told follows from it";
    EXPECT_THAT(mistakes("[[receiver]]\nname = \"a\"\n[[receiver]]\nname = \"b\"\n[[fault]]\nreceiver = \"a\"\n"
                         "kind = \"clock_drift\"\n"),
                HasSubstr("test.toml:6:12: fault.receiver: stands beside kind = \"clock_drift\""));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nname = \"\"\n"),
                HasSubstr("test.toml:3:8: fault.name: is empty"));
    EXPECT_EQ(mistakes("[[fault]]\nkind = \"outage\"\nafter = \"\"\n"),
              "test.toml:3:9: fault.after: is empty; expected the name of an entry, or no such key");
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsatellites = []\n"),
                HasSubstr("test.toml:3:14: fault.satellites: is an empty list; expected a text or a list of texts"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"receiver_silent\"\nramp_out_s = 10\n"),
                HasSubstr(":3:14: fault.ramp_out_s: is 10, and receiver_silent is there or is not"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"saturated_uart\"\nbytes_per_s = 10\nbaud = 9600\n"),
                HasSubstr("test.toml:1:1: [fault]"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"refuses_keys\"\nkeys = \"CFG-RATE-MESA\"\n"), HasSubstr("CFG-RATE-MEAS"));
}

TEST(ScenarioTimeline, CornersOfAnAreaArePairs) {
    const auto mistakes = [](const std::string& area) {
        const auto scenario = read_scenario("[[fault]]\nkind = \"outage\"\nwhen_inside = " + area + "\n", "test.toml");
        return scenario ? std::string() : scenario.error().message;
    };
    EXPECT_THAT(mistakes("[[47, 8], [47, 9], [48, 9]]"), IsEmpty());
    EXPECT_THAT(mistakes("[47, 8, 47, 9, 48, 9]"), IsEmpty());
    EXPECT_EQ(
        mistakes("[[47, 8, 0], [47, 9, 0], [48, 9, 0], [48, 8, 0]]"),
        "test.toml:3:16: fault.when_inside: holds a group of 3; expected numbers alone, or pairs [latitude, longitude]")
        << "a height is no longitude of the next corner";
    EXPECT_THAT(mistakes("[[47, 8], [47, 9, 48, 9]]"),
                HasSubstr("test.toml:3:25: fault.when_inside: holds a group of 4"));
    EXPECT_THAT(mistakes("[[47, 8], [47, 9], 48, 9]"), HasSubstr("holds a single number"));
}

TEST(ScenarioTimeline, SatellitesAndMessagesThatThereCannotBeAreRefused) {
    const auto mistakes = [](std::string_view text) {
        const auto scenario = read_scenario(text, "test.toml");
        return scenario ? std::string() : scenario.error().message;
    };
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsatellites = [\"G07\", \"G99\"]\n"),
                HasSubstr("test.toml:3:14: fault.satellites: 'G99' is no satellite; expected G01 to G63 of GPS"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsatellites = [\"X1\"]\n"),
                HasSubstr("test.toml:3:14: fault.satellites: has 'X1'; expected a system's letter and two digits"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"jamming\"\n"), HasSubstr("test.toml:1:1: [fault] no jammer is told"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsatellites = [\"S19\"]\n"), HasSubstr("S20 to S58 of SBAS"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nsatellites = [\"R24\", \"E36\", \"C63\"]\n"), IsEmpty());
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nwhen_client_sends = \"NONSENSE\"\n"),
                HasSubstr("test.toml:3:21: fault.when_client_sends: 'NONSENSE' is no message; expected a name like"));
    EXPECT_THAT(mistakes("[[fault]]\nkind = \"outage\"\nwhen_client_sends = \"mon-ver\"\n"), IsEmpty());
}

std::string refusal_of(std::string_view text, GpsTime start) {
    const auto checked = check_timeline(scenario_of(text), start);
    return checked ? std::string() : checked.error().message;
}

TEST(ScenarioTimeline, WhatNeverHappensInThisRunIsRefused) {
    const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    const std::string slips = "[[fault]]\nkind = \"cycle_slips\"\n[model]\nname = ";
    EXPECT_THAT(refusal_of(slips + "\"baseline\"\n", start),
                HasSubstr("[[fault]] 'cycle_slips': kind = \"cycle_slips\" spoils measurements, and model.name = "
                          "\"baseline\" makes none; expected model.name = \"modern\""));
    EXPECT_THAT(refusal_of(slips + "\"modern\"\n", start), IsEmpty());
    const std::string weeks = "[[fault]]\nkind = \"week_rollover\"\nrollovers = ";
    const GpsTime early = to_gps_time(1600, 0);
    EXPECT_THAT(refusal_of(weeks + "2\n", start), IsEmpty());
    EXPECT_THAT(refusal_of(weeks + "1\n", early), IsEmpty());
    EXPECT_THAT(
        refusal_of(weeks + "2\n", early),
        HasSubstr("'week_rollover': rollovers = 2 leads to before 1980-01-06; expected fewer, or a beginning at "
                  "2019-04-06T23:59:42.000Z or later"));
    const std::string note = "[[command]]\nkind = \"note\"\nat_utc = ";
    EXPECT_THAT(
        refusal_of(note + "2024-03-05T11:00:00Z\n", start),
        HasSubstr("[[command]] 'note': at_utc is 2024-03-05T11:00:00.000Z, before the start of the run; expected "
                  "2024-03-05T12:00:00.000Z or later"));
    EXPECT_THAT(refusal_of(note + "2024-03-05T12:00:00Z\n", start), IsEmpty());
    EXPECT_THAT(refusal_of(note + "2024-03-05T14:00:00+02:00\n", start), IsEmpty());
    EXPECT_THAT(refusal_of(note + "2024-03-05T13:30:00+02:00\n", start), HasSubstr("2024-03-05T11:30:00.000Z, before"));
    EXPECT_THAT(refusal_of(note + "\"2024-03-05T14:00:00+02:00\"\n", start), IsEmpty());
}

TEST(ScenarioTimeline, WhatIsDueAfterTheEndIsWarnedOf) {
    const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    const Scenario scenario = scenario_of(R"toml(
[[fault]]
kind = "outage"
at_s = 60
[[fault]]
kind = "outage"
name = "late"
at_s = 61
[[fault]]
kind = "freeze"
after = "late"
[[fault]]
kind = "stall"
when_fix_for_s = 100
[[command]]
kind = "note"
between_s = [70, 80]
)toml");
    const std::vector<std::string> warnings = timeline_warnings(scenario, start, advanced(start, Seconds(60)));
    ASSERT_THAT(warnings, SizeIs(2));
    EXPECT_EQ(warnings[0],
              "[[fault]] 'late' will not begin: it is due 61 s after the start of the run, which ends after 60 s");
    EXPECT_THAT(warnings[1], HasSubstr("[[command]] 'note' will not begin"));
}

TEST(ScenarioTimeline, WhatACommandBeginsIsNotWarnedOf) {
    const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    const auto warnings_of = [&](const std::string& command) {
        const Scenario scenario = scenario_of(
            "[[fault]]\nkind = \"outage\"\nname = \"later\"\nat_s = 100\n[[command]]\nkind = \"start_fault\"\n"
            "fault = \"later\"\n" +
            command);
        return timeline_warnings(scenario, start, advanced(start, Seconds(60)));
    };
    EXPECT_THAT(warnings_of("at_s = 20\n"), IsEmpty());
    EXPECT_THAT(warnings_of("when_client_sends = \"MON-VER\"\n"), IsEmpty()) << "it may come";
    EXPECT_THAT(warnings_of("at_s = 70\n"), ElementsAre(HasSubstr("'later' will not"), HasSubstr("[[command]]")));
}

TEST(ScenarioTimeline, WhatCannotBeMetBeforeTheEndIsWarnedOf) {
    const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    const auto warnings_of = [&](const std::string& expectation) {
        const Scenario scenario = scenario_of(R"toml(
[[fault]]
kind = "outage"
at_s = 20
[[fault]]
kind = "freeze"
at_s = 90
[[fault]]
kind = "stall"
when_fix_for_s = 10
[[fault]]
kind = "byte_loss"
name = "hangs"
after = "stall"
)toml" + ("[[expect]]\n" + expectation));
        std::vector<std::string> warnings;
        for (const std::string& warning : timeline_warnings(scenario, start, advanced(start, Seconds(60))))
            if (warning.starts_with("[[expect]]")) warnings.push_back(warning);
        return warnings;
    };
    EXPECT_THAT(
        warnings_of("what = \"fix at 300 s\""),
        ElementsAre("[[expect]] 'fix at 300 s' cannot be met: it is due 300 s after the start of the run, which "
                    "ends after 60 s"));
    EXPECT_THAT(warnings_of("what = \"fix from 50 s to 200 s\""), ElementsAre(HasSubstr("it lasts until 200 s after")));
    EXPECT_THAT(warnings_of("what = \"no fix within 2 s of freeze\""),
                ElementsAre(HasSubstr("'freeze' does not begin before the run ends")));
    EXPECT_THAT(warnings_of("what = \"no fix within 2 s of outage#2\""),
                ElementsAre(HasSubstr("'outage#2' does not begin")));
    EXPECT_THAT(warnings_of("what = \"fix within 2 s of the end of outage\""),
                ElementsAre(HasSubstr("'outage' does not end before the run does")));
    EXPECT_THAT(warnings_of("what = \"fix 50 s after outage\""), ElementsAre(HasSubstr("it is due 70 s after")));
    EXPECT_THAT(warnings_of("command = \"true\"\nat_s = 70"), ElementsAre(HasSubstr("it is asked 70 s after")));
    EXPECT_THAT(warnings_of("command = \"true\"\nat_s = 60"), ElementsAre(HasSubstr("it is asked 60 s after")));
    EXPECT_THAT(warnings_of("command = \"true\"\nat_s = 50\ntimeout_s = 20"),
                ElementsAre("[[expect]] 'command 'true' exits 0' may stay undecided: it has until 70 s after the start "
                            "of the run, which ends after 60 s"));
    EXPECT_THAT(warnings_of("command = \"true\"\nat_s = 1\nwithin_s = 60"), ElementsAre(HasSubstr("until 61 s")));
    EXPECT_THAT(warnings_of("command = \"true\"\nat_s = 50\ntimeout_s = 20\nwithin_s = 10"), IsEmpty());
    EXPECT_THAT(warnings_of("what = \"fix within 300 s of outage\""),
                ElementsAre("[[expect]] 'fix within 300 s of outage' may stay undecided: it has until 320 s after the "
                            "start of the run, which ends after 60 s"));
    EXPECT_THAT(warnings_of("what = \"receiver silent within 39 s of outage\""),
                ElementsAre(HasSubstr("it has until 61 s after")));
    for (const char* met : {"fix at 60 s", "fix from 50 s to 60 s", "no fix throughout outage",
                            "fix within 40 s of outage", "no fix within 2 s of stall",
                            "no fix within 2 s of the end of hangs", "fix always", "fix until outage", "no fix never"})
        EXPECT_THAT(warnings_of(fmt::format("what = \"{}\"", met)), IsEmpty()) << met;
}

// As the judge does.
TEST(ScenarioTimeline, EventsOfExpectationsAreCountedOverAllThatTheirNameFits) {
    const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    const auto warnings_of = [&](const std::string& what) {
        const Scenario scenario = scenario_of(R"toml(
[[fault]]
kind = "outage"
name = "tunnel"
at_s = 5
for_s = 3
[[fault]]
kind = "outage"
name = "bridge"
at_s = 15
[[fault]]
kind = "freeze"
at_s = 90
[[command]]
kind = "reboot"
at_s = 5
[[expect]]
what = ")toml" + what + "\"\n");
        std::vector<std::string> warnings;
        for (const std::string& warning : timeline_warnings(scenario, start, advanced(start, Seconds(60))))
            if (warning.starts_with("[[expect]]")) warnings.push_back(warning);
        return warnings;
    };
    for (const char* met : {"no fix within 2 s of outage#2", "fix within 2 s of the end of outage#1",
                            "3d fix within 8 s of the end of reboot", "fix until the end of tunnel"})
        EXPECT_THAT(warnings_of(met), IsEmpty()) << met;
    EXPECT_THAT(warnings_of("no fix within 2 s of outage#3"), ElementsAre(HasSubstr("'outage#3' does not begin")));
    EXPECT_THAT(warnings_of("fix within 2 s of the end of outage#2"),
                ElementsAre(HasSubstr("'outage#2' does not end before the run does")));
    EXPECT_THAT(warnings_of("fix within 50 s of outage#2"), ElementsAre(HasSubstr("it has until 65 s after")));
    EXPECT_THAT(warnings_of("fix until the end of bridge"), ElementsAre(HasSubstr("'bridge' does not end")));
    EXPECT_THAT(warnings_of("fix until freeze"), ElementsAre(HasSubstr("'freeze' does not begin")));
}

TEST(ScenarioTimeline, CommandsFindTheFaultsThatTheyName) {
    const auto commanded = [](std::string_view command) {
        return mistakes_of(fmt::format("[[fault]]\nkind = \"jamming\"\nj_to_s_db = 30\n[[command]]\n{}", command));
    };
    for (const std::string_view verb : {"start_fault", "stop_fault"}) {
        EXPECT_EQ(commanded(fmt::format("kind = \"{}\"\nfault = \"jamming\"\n", verb)), "accepted");
        EXPECT_THAT(
            commanded(fmt::format("kind = \"{}\"\nfault = \"jaming\"\n", verb)),
            HasSubstr("test.toml:6:9: command.fault: is 'jaming'; no fault of this scenario has this name; did you "
                      "mean 'jamming'?"));
    }
    EXPECT_EQ(commanded("kind = \"stop_fault\"\n"), "accepted") << "it stops all";
    EXPECT_EQ(commanded("kind = \"note\"\ntext = \"jaming\"\n"), "accepted");
}

}  // namespace
}  // namespace skyloop::test
