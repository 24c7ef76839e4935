#include "run/fault/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/known_names.hpp"
#include "run/fault/timeline_keys.hpp"

namespace skyloop::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const GpsTime begin_of_run = to_gps_time(2300, 100'000.0);

struct Happening {
    std::string name;
    double at;
    bool begins;
    bool operator==(const Happening&) const = default;
};
void PrintTo(const Happening& h, std::ostream* out) { *out << h.name << (h.begins ? "+" : "-") << h.at; }

TimelineEntry entry(std::string name, double at, std::optional<double> length = std::nullopt) {
    TimelineEntry made;
    made.name = std::move(name);
    made.at = Seconds(at);
    if (length) made.length = Seconds(*length);
    return made;
}

GpsTime after(double seconds) { return advanced(begin_of_run, Seconds(seconds)); }

std::vector<Happening> happenings(Timeline& timeline, double until) {
    std::vector<Happening> all;
    for (const TimelineEvent& event : timeline.advance(after(until)))
        all.push_back({timeline.entries()[event.entry].name,
                       static_cast<double>((event.time - begin_of_run).count()) / 1e9, event.begins});
    return all;
}

std::vector<Happening> happenings(std::vector<TimelineEntry> entries, double until, std::uint64_t seed = 1) {
    Timeline timeline(std::move(entries), begin_of_run, seed);
    return happenings(timeline, until);
}

TEST(Timeline, BeginsAndEndsInTheOrderOfTime) {
    EXPECT_THAT(happenings({entry("b", 5, 10), entry("a", 1, 4)}, 100),
                ElementsAre(Happening{"a", 1, true}, Happening{"a", 5, false}, Happening{"b", 5, true},
                            Happening{"b", 15, false}));
}

TEST(Timeline, GivesTheSameHoweverOftenOneLooks) {
    TimelineEntry often = entry("often", 0.5, 0.2);
    often.every = Seconds(0.7);
    often.times = 5;
    const auto at_once = happenings({often, entry("a", 1, 2)}, 20);
    Timeline timeline({often, entry("a", 1, 2)}, begin_of_run, 1);
    std::vector<Happening> step_by_step;
    for (int i = 0; i <= 2000; ++i)
        for (const Happening& h : happenings(timeline, 0.01 * i))
            step_by_step.push_back(h);
    EXPECT_EQ(step_by_step, at_once);
    EXPECT_THAT(at_once, SizeIs(12));
}

TEST(Timeline, CountsFromOtherEntries) {
    TimelineEntry second = entry("second", 3, 1), third = entry("third", 0, 1);
    second.after = "first";
    third.after = "first";
    third.after_end = true;
    EXPECT_THAT(
        happenings({second, third, entry("first", 10, 20)}, 100),
        ElementsAre(Happening{"first", 10, true}, Happening{"second", 13, true}, Happening{"second", 14, false},
                    Happening{"first", 30, false}, Happening{"third", 30, true}, Happening{"third", 31, false}));
}

TEST(Timeline, DrawsTimesByTheSeed) {
    TimelineEntry random = entry("random", 0);
    random.at.reset();
    random.between = {10, 20};
    random.length_between = {1, 2};
    const auto one = happenings({random}, 100, 1), again = happenings({random, entry("other", 0)}, 100, 1),
               other = happenings({random}, 100, 2);
    ASSERT_THAT(one, SizeIs(2));
    EXPECT_GE(one[0].at, 10);
    EXPECT_LE(one[0].at, 20);
    EXPECT_GE(one[1].at - one[0].at, 1 - 1e-9);
    EXPECT_LE(one[1].at - one[0].at, 2 + 1e-9);
    EXPECT_EQ(one[0].at, again[1].at) << "an entry beside it changes nothing";
    EXPECT_NE(one[0].at, other[0].at);
}

TimelineEntry triggered(Trigger trigger) {
    TimelineEntry made;
    made.name = "triggered";
    made.when = std::move(trigger);
    made.length = Seconds(1);
    return made;
}

TriggerView at(double latitude, double longitude, double height) {
    return {Geodetic::degrees(latitude, longitude, height), MetresPerSecond(0), false};
}

TEST(Timeline, BeginsWhenAHeightIsReached) {
    Trigger high;
    high.height_above = Metres(100);
    TimelineEntry made = triggered(high);
    made.at = Seconds(2);
    Timeline timeline({made}, begin_of_run, 1);
    timeline.look(after(1), at(0, 0, 99));
    EXPECT_FALSE(timeline.next_event());
    timeline.look(after(2), at(0, 0, 101));
    timeline.look(after(3), at(0, 0, 99));
    timeline.look(after(4), at(0, 0, 101));
    EXPECT_THAT(happenings(timeline, 50),
                ElementsAre(Happening{"triggered", 4, true}, Happening{"triggered", 5, false}));
}

// The epoch that has shown it is over; the epochs of one second behind it are hit, as those of one second are.
TEST(Timeline, BeginsBehindTheEpochThatShowsIt) {
    Trigger high;
    high.height_above = Metres(100);
    TimelineEntry chained = entry("chained", 0, 1);
    chained.after = "triggered";
    Timeline timeline({triggered(high), chained}, begin_of_run, 1);
    (void)timeline.advance(after(2));
    timeline.look(after(2), at(0, 0, 101));
    const GpsTime behind = after(2) + Nanoseconds(1);
    EXPECT_EQ(timeline.next_event(), behind);
    EXPECT_THAT(timeline.advance(behind), SizeIs(2));
    EXPECT_THAT(timeline.advance(after(3)), IsEmpty()) << "it hits the epoch of 3 s";
    EXPECT_THAT(timeline.advance(behind + Nanoseconds(1'000'000'000)), SizeIs(2));
    timeline.look(after(5), at(0, 0, 99));
    EXPECT_TRUE(timeline.begin(0, after(5)));
    EXPECT_EQ(timeline.next_event(), after(5)) << "a command knows nothing of epochs";
}

TEST(Timeline, BeginsAgainWhereItIsToldTo) {
    Trigger low;
    low.height_below = Metres(10);
    TimelineEntry made = triggered(low);
    made.again = true;
    Timeline timeline({made}, begin_of_run, 1);
    for (int i = 0; i < 6; ++i)
        timeline.look(after(10 * i), at(0, 0, i % 2 == 0 ? 5 : 15));
    EXPECT_THAT(happenings(timeline, 100), SizeIs(6));
}

TEST(Timeline, KnowsWhatLiesInsideAPolygonAcrossTheDateLine) {
    Trigger inside;
    inside.inside = {{-1, 179}, {-1, -179}, {1, -179}, {1, 179}};
    for (const auto& [longitude, expected] : {std::pair{180.0, true}, {-179.5, true}, {178.0, false}, {0.0, false}}) {
        Timeline timeline({triggered(inside)}, begin_of_run, 1);
        timeline.look(after(1), at(0, longitude, 0));
        EXPECT_EQ(timeline.next_event().has_value(), expected) << longitude;
    }
}

TEST(Timeline, KnowsWhatLiesInsideAPolygonRoundAPole) {
    const auto holds = [](std::vector<std::array<double, 2>> polygon, double latitude, double longitude) {
        Trigger inside;
        inside.inside = std::move(polygon);
        Timeline timeline({triggered(inside)}, begin_of_run, 1);
        timeline.look(after(1), at(latitude, longitude, 0));
        return timeline.next_event().has_value();
    };
    const std::vector<std::array<double, 2>> north{{80, 0}, {80, 90}, {80, 180}, {80, -90}},
        west_about{{80, 0}, {80, -90}, {80, 180}, {80, 90}}, south{{-70, -120}, {-60, 0}, {-65, 120}};
    for (const double longitude : {0., 20., 90., 135., 180., -180., -179., -90., -1e-9}) {
        for (const auto& round : {north, west_about}) {
            EXPECT_TRUE(holds(round, 85, longitude)) << longitude;
            EXPECT_TRUE(holds(round, 90, longitude)) << longitude;
            EXPECT_FALSE(holds(round, 79, longitude)) << longitude;
            EXPECT_FALSE(holds(round, -85, longitude)) << longitude;
        }
        EXPECT_TRUE(holds(south, -75, longitude)) << longitude;
        EXPECT_FALSE(holds(south, -55, longitude)) << longitude;
        EXPECT_FALSE(holds(south, 75, longitude)) << longitude;
    }
    EXPECT_TRUE(holds(south, -61, 0));
    EXPECT_FALSE(holds(south, -61, 100));
    const std::vector<std::array<double, 2>> beside{{80, 0}, {80, 90}, {89, 45}};
    EXPECT_TRUE(holds(beside, 82, 45));
    EXPECT_FALSE(holds(beside, 89.5, 45));
    EXPECT_FALSE(holds(beside, 82, -135));
}

TEST(Timeline, WaitsForAFixWithoutGaps) {
    Trigger fix;
    fix.fix_for = Seconds(5);
    Timeline timeline({triggered(fix)}, begin_of_run, 1);
    for (int i = 0; i <= 20; ++i) {
        TriggerView view = at(0, 0, 0);
        view.has_fix = i != 4;
        timeline.look(after(i), view);
    }
    EXPECT_EQ(timeline.advance(after(100))[0].time, after(10) + Nanoseconds(1));
}

TEST(Timeline, HearsTheClient) {
    Trigger message;
    message.client_sends = "CFG-VALSET";
    Timeline timeline({triggered(message)}, begin_of_run, 1);
    timeline.hear(after(1), "CFG-PRT");
    EXPECT_FALSE(timeline.next_event());
    timeline.hear(after(2.5), "CFG-VALSET");
    EXPECT_THAT(happenings(timeline, 100)[0], (Happening{"triggered", 2.5, true}));
    for (const char* name : {"cfg-valset", "CFG-*", "anything"}) {
        message.client_sends = name;
        Timeline other({triggered(message)}, begin_of_run, 1);
        other.hear(after(2.5), "CFG-VALSET");
        EXPECT_TRUE(other.next_event()) << name;
    }
}

// Looks once a second from 1 s on, each time with the next state of the vehicle.
bool begins_with(const Trigger& trigger, const std::vector<VehicleState>& states) {
    Timeline timeline({triggered(trigger)}, begin_of_run, 1);
    for (std::size_t i = 0; i < states.size(); ++i) {
        timeline.tell(states[i]);
        EXPECT_FALSE(timeline.next_event()) << "not before the look";
        timeline.look(after(static_cast<double>(i + 1)), at(0, 0, 0));
    }
    return timeline.next_event().has_value();
}

TEST(Timeline, FollowsTheVehiclesMode) {
    Trigger automatic, number, armed, disarmed, both;
    automatic.vehicle_mode = "auto";
    number.custom_mode = 3;
    armed.armed = true;
    disarmed.armed = false;
    both.vehicle_mode = "AUTO";
    both.armed = true;
    for (const Trigger& trigger : {automatic, number, armed, disarmed, both})
        EXPECT_FALSE(begins_with(trigger, {VehicleState{}})) << "nothing is known";
    EXPECT_TRUE(begins_with(automatic, {{"LOITER", 5, true}, {"AUTO", 3, true}}));
    EXPECT_TRUE(begins_with(automatic, {{"AUTO.MISSION", 0x04040000, true}})) << "of PX4";
    EXPECT_FALSE(begins_with(automatic, {{"AUTOTUNE", 15, true}}));
    EXPECT_TRUE(begins_with(number, {{"", 3, false}}));
    EXPECT_FALSE(begins_with(number, {{"AUTO", 10, false}}));
    EXPECT_TRUE(begins_with(armed, {{"", std::nullopt, true}}));
    EXPECT_TRUE(begins_with(disarmed, {{"", std::nullopt, false}}));
    EXPECT_FALSE(begins_with(both, {{"LOITER", 5, true}, {"AUTO", 3, false}}));
    EXPECT_TRUE(begins_with(both, {{"AUTO", 3, false}, {"AUTO", 3, true}}));
}

TEST(Timeline, KeepsOfTheVehicleWhatACommandDoesNotName) {
    const auto told = [](const ParameterMap& members, const VehicleState& before) {
        ParameterMap all = members;
        all["command"] = std::string("vehicle_state");
        const auto command = checked_command(std::move(all), "test");
        EXPECT_TRUE(command);
        return command ? vehicle_state_of(command->parameters, before) : VehicleState{};
    };
    const VehicleState automatic = told({{"mode", std::string("AUTO")}}, {});
    EXPECT_EQ(automatic, (VehicleState{"AUTO", std::nullopt, std::nullopt}));
    const VehicleState armed = told({{"armed", true}}, automatic);
    EXPECT_EQ(armed, (VehicleState{"AUTO", std::nullopt, true}));
    EXPECT_EQ(told({{"custom_mode", 3.0}}, armed), (VehicleState{"AUTO", 3, true}));
    const Command unnamed = vehicle_state_command({"", 77, false}, "mavlink");
    EXPECT_EQ(vehicle_state_of(unnamed.parameters, armed), (VehicleState{"", 77, false})) << "a mode without a name";
}

TEST(Timeline, CountsOccurrencesAsTheyBegin) {
    TimelineEntry often = entry("often", 20, 2);
    often.every = Seconds(10);
    often.times = 4;
    Timeline timeline({often}, begin_of_run, 1);
    std::vector<std::pair<double, int>> begun;
    const auto advance_to = [&](double second) {
        for (const TimelineEvent& event : timeline.advance(after(second)))
            if (event.begins) begun.emplace_back(difference(event.time, begin_of_run).value(), event.occurrence);
    };
    EXPECT_TRUE(timeline.begin(0, after(8)));
    advance_to(25);
    EXPECT_TRUE(timeline.begin(0, after(26)));
    advance_to(100);
    EXPECT_THAT(begun, ElementsAre(std::pair(8.0, 1), std::pair(20.0, 2), std::pair(26.0, 3), std::pair(30.0, 4),
                                   std::pair(40.0, 5), std::pair(50.0, 6)))
        << "four by itself, whatever is asked for besides";
}

// What is there cannot come on top of itself: a step would be twice as large.
TEST(Timeline, BeginsAnewWhatIsUnderWay) {
    TimelineEntry often = entry("often", 5, 15), endless = entry("endless", 5);
    often.every = endless.every = Seconds(10);
    often.times = endless.times = 2;
    EXPECT_THAT(happenings({often}, 100), ElementsAre(Happening{"often", 5, true}, Happening{"often", 15, false},
                                                      Happening{"often", 15, true}, Happening{"often", 30, false}));
    EXPECT_THAT(happenings({endless}, 100), ElementsAre(Happening{"endless", 5, true}, Happening{"endless", 15, false},
                                                        Happening{"endless", 15, true}));
    TimelineEntry late = entry("late", 20, 10);
    Timeline timeline({late}, begin_of_run, 1);
    EXPECT_TRUE(timeline.begin(0, after(15), Seconds(10)));
    EXPECT_THAT(happenings(timeline, 100), ElementsAre(Happening{"late", 15, true}, Happening{"late", 20, false},
                                                       Happening{"late", 20, true}, Happening{"late", 30, false}));
}

TEST(Timeline, DrawsTheSameTimesWhateverIsBegunByHand) {
    TimelineEntry random = entry("random", 0, 1);
    random.at.reset();
    random.between = {10, 20};
    random.after = "first";
    TimelineEntry first = entry("first", 5, 1);
    Timeline alone({first, random}, begin_of_run, 1), steered({first, random}, begin_of_run, 1);
    EXPECT_TRUE(steered.begin(1, after(1)));
    const auto expected = happenings(alone, 100), seen = happenings(steered, 100);
    ASSERT_THAT(seen, SizeIs(expected.size() + 2));
    EXPECT_EQ(seen.back().at, expected.back().at);
}

TEST(Timeline, IsLedByHand) {
    TimelineEntry made = entry("by hand", 0, 100);
    made.by_hand = true;
    Timeline timeline({made}, begin_of_run, 1);
    EXPECT_FALSE(timeline.next_event());
    EXPECT_TRUE(timeline.begin(0, after(10), Seconds(3)));
    EXPECT_THAT(happenings(timeline, 11), ElementsAre(Happening{"by hand", 10, true}));
    EXPECT_FALSE(timeline.begin(0, after(12))) << "it is under way";
    EXPECT_TRUE(timeline.end(0, after(12)));
    EXPECT_THAT(happenings(timeline, 100), ElementsAre(Happening{"by hand", 12, false}));
    EXPECT_FALSE(timeline.end(0, after(101))) << "it is over";
}

Parameters keys(std::map<std::string, ParameterValue, std::less<>> given) {
    const CheckedParameters checked = check_parameters(timeline_keys(), given);
    EXPECT_THAT(checked.mistakes, SizeIs(0));
    return checked.parameters;
}

TEST(TimelineKeys, AreRead) {
    const TimelineReading reading = read_timeline_entry(
        keys({{"name", std::string("jam")}, {"at_s", 5.0}, {"for_s", 7.0}, {"ramp_in_s", 2.0}, {"every_s", 60.0}}));
    EXPECT_THAT(reading.mistakes, SizeIs(0));
    EXPECT_EQ(reading.entry.name, "jam");
    EXPECT_EQ(reading.entry.at, Seconds(5));
    EXPECT_EQ(reading.entry.length, Seconds(7));
    EXPECT_EQ(reading.entry.ramp_in, Seconds(2));
    EXPECT_EQ(reading.entry.every, Seconds(60));
}

TEST(TimelineKeys, MessagesAreThoseThatThereAre) {
    for (const char* name :
         {"MON-VER", "mon-ver", "CFG-*",   "anything", "GGA",       "gga",          "GPQ",       "HDT",
          "PUBX,41", "pubx,*",  "PMTK314", "PAIR*",    "UBX-0A-04", "ubx-0a-04",    "RTCM-1005", "SBF",
          "mavlink", "G*",      "*",       "sso",      "SSO",       "setSBFOutput", "lif",       "ss*"})
        EXPECT_FALSE(message_name_mistake(name)) << name;
    for (const char* name : {"NONSENSE", "FOO", "FOO*", "GPRT", "PUBX", "PUBX,ab", "PX", "MON-VRE", "CGF-*", "UBX-0A",
                             "PUBX-41", "", "two words", "sso,", "setNothing"})
        EXPECT_TRUE(message_name_mistake(name)) << name;
    EXPECT_THAT(message_name_mistake("mon-vre").value_or(""),
                HasSubstr("'mon-vre' is no message; did you mean 'MON-VER'?; expected a name like"));
    EXPECT_THAT(read_timeline_entry(keys({{"when_client_sends", std::string("NONSENSE")}})).mistakes, SizeIs(1));
}

TEST(TimelineKeys, ContradictionsAreTold) {
    const auto mistakes = [](std::map<std::string, ParameterValue, std::less<>> given) {
        const TimelineReading reading = read_timeline_entry(keys(std::move(given)));
        return reading.mistakes.empty() ? "" : reading.mistakes.front().name + " " + reading.mistakes.front().sentence;
    };
    EXPECT_THAT(mistakes({{"at_s", 5.0}, {"between_s", std::vector<double>{1, 2}}}), HasSubstr("beside 'at_s'"));
    EXPECT_THAT(mistakes({{"between_s", std::vector<double>{3, 2}}}), HasSubstr("the smaller one first"));
    EXPECT_THAT(mistakes({{"times", 3.0}}), HasSubstr("every_s"));
    EXPECT_THAT(mistakes({{"again", true}}), HasSubstr("when_"));
    EXPECT_THAT(mistakes({{"after", std::string("x")}, {"when_above_m", 3.0}}), HasSubstr("expected one of them"));
    EXPECT_THAT(mistakes({{"when_inside", std::vector<double>{1, 2, 3, 4, 5, 6, 7}}}), HasSubstr("three pairs"));
    EXPECT_THAT(mistakes({{"when_inside", std::vector<double>{91, 2, 3, 4, 5, 6}}}), HasSubstr("latitude"));
    EXPECT_THAT(mistakes({{"at_utc", std::string("noon")}}), HasSubstr("at_utc"));
    EXPECT_THAT(mistakes({{"name", std::string("run")}}), HasSubstr("the run itself"));
    EXPECT_THAT(mistakes({{"name", std::string("o#2")}}), HasSubstr("'#'"));
}

TEST(TimelineKeys, NoFaultOrCommandHasAParameterOfTheirNames) {
    std::set<std::string_view> taken{"kind", "receiver", "what"};
    for (const ParameterSpec& spec : timeline_keys())
        taken.insert(spec.name);
    for (const FaultKind& kind : fault_kinds())
        for (const ParameterSpec& spec : kind.parameters)
            EXPECT_FALSE(taken.contains(spec.name)) << kind.name << "." << spec.name;
    taken = {"kind", "receiver", "what"};
    for (const ParameterSpec& spec : timeline_keys_of_commands())
        taken.insert(spec.name);
    for (const CommandKind& kind : command_kinds())
        for (const ParameterSpec& spec : kind.parameters)
            EXPECT_FALSE(taken.contains(spec.name)) << kind.name << "." << spec.name;
}

TimelineReading reading_of(std::map<std::string, ParameterValue, std::less<>> given) {
    const CheckedParameters checked = check_parameters(timeline_keys(), given);
    EXPECT_THAT(checked.mistakes, SizeIs(0));
    return read_timeline_entry(checked.parameters);
}

TEST(TimelineKeys, AskForTheVehicle) {
    const TimelineReading good =
        reading_of({{"when_mavlink_mode", std::string("rtl")}, {"when_custom_mode", 6.0}, {"when_armed", false}});
    EXPECT_THAT(good.mistakes, SizeIs(0));
    ASSERT_TRUE(good.entry.when && good.entry.when->needs_vehicle());
    EXPECT_EQ(good.entry.when->vehicle_mode, "rtl");
    EXPECT_EQ(good.entry.when->custom_mode, 6u);
    EXPECT_EQ(good.entry.when->armed, false);
    EXPECT_FALSE(reading_of({}).entry.when) << "what is not given asks for nothing";
    const auto mode = reading_of({{"when_mavlink_mode", std::string("LOITRE")}}).mistakes;
    ASSERT_THAT(mode, SizeIs(1));
    EXPECT_THAT(mode[0].sentence, HasSubstr("did you mean 'LOITER'"));
}

TEST(Parameters, AreWholeWhereHalvesMeanNothing) {
    for (const char* name : {"when_custom_mode", "times"}) {
        const auto mistakes = check_parameters(timeline_keys(), {{name, 1.5}}).mistakes;
        ASSERT_THAT(mistakes, SizeIs(1)) << name;
        EXPECT_EQ(mistakes[0].name, name);
        EXPECT_THAT(mistakes[0].sentence, HasSubstr("is 1.5; expected a whole number"));
    }
    const std::pair<const char*, const char*> parameters[] = {
        {"changed_baud", "baud"},       {"leap_second_wrong", "error_s"}, {"satellites_misreported", "count"},
        {"week_rollover", "rollovers"}, {"speed_mismatch", "baud"},       {"inserted_garbage", "burst_bytes"}};
    for (const auto& [kind, name] : parameters) {
        const std::span<const ParameterSpec> specs = find_fault_kind(kind)->parameters;
        EXPECT_THAT(check_parameters(specs, {{name, 1.5}}).mistakes, SizeIs(1)) << kind;
        EXPECT_THAT(check_parameters(specs, {{name, 9600.0}}).mistakes.size() +
                        check_parameters(specs, {{name, 1.0}}).mistakes.size(),
                    testing::Le(1U))
            << kind;
    }
}

TEST(Parameters, SayWhatIsWrongWithALongNumberOrAList) {
    const auto said = [](std::span<const ParameterSpec> specs, const std::string& name, const ParameterValue& value) {
        const auto mistakes = check_parameters(specs, {{name, value}}).mistakes;
        return mistakes.empty() ? std::string() : mistakes[0].sentence;
    };
    const std::span<const ParameterSpec> loss = find_fault_kind("byte_loss")->parameters;
    EXPECT_EQ(said(loss, "probability", 1.0000001), "is 1.0000001; expected a number from 0 to 1");
    EXPECT_EQ(said(loss, "probability", 2.5), "is 2.5; expected a number from 0 to 1");
    EXPECT_THAT(said(timeline_keys(), "between_s", std::vector<double>{5, NAN}),
                testing::StartsWith("holds nan; expected a list of 2 numbers from 0 to"));
    EXPECT_THAT(said(timeline_keys(), "between_s", std::vector<double>{-1, 5}), HasSubstr("holds -1;"));
    EXPECT_THAT(said(timeline_keys(), "between_s", std::vector<double>{5}), HasSubstr("is a list of 1 numbers;"));
}

TEST(Parameters, AListNamesSomething) {
    const std::span<const ParameterSpec> outage = find_fault_kind("outage")->parameters;
    for (const ParameterValue& empty :
         {ParameterValue(std::vector<double>{}), ParameterValue(std::vector<std::string>{})})
        for (const char* name : {"satellites", "constellations", "signals"}) {
            const auto mistakes = check_parameters(outage, {{name, empty}}).mistakes;
            ASSERT_THAT(mistakes, SizeIs(1)) << name;
            EXPECT_EQ(mistakes[0].name, name);
            EXPECT_THAT(mistakes[0].sentence, testing::StartsWith("is an empty list; expected "));
        }
}

TEST(TimelineKeys, AnEmptyTextIsNotTakenForNone) {
    for (const char* name : {"at_utc", "after", "after_end_of", "when_client_sends", "when_mavlink_mode"}) {
        const auto mistakes = reading_of({{name, std::string()}}).mistakes;
        ASSERT_THAT(mistakes, SizeIs(1)) << name;
        EXPECT_EQ(mistakes[0].name, name);
        EXPECT_THAT(mistakes[0].sentence, testing::StartsWith("is empty; expected "));
    }
    EXPECT_THAT(reading_of({}).mistakes, SizeIs(0));
}

TEST(TimelineKeys, EntriesThatDoNotFitTogetherAreTold) {
    TimelineEntry a = entry("a", 0), b = entry("b", 0), c = entry("c", 0);
    a.after = "b";
    b.after = "a";
    c.after = "bb";
    const auto mistakes = timeline_mistakes({a, b, c, entry("c", 1)});
    ASSERT_THAT(mistakes, SizeIs(4));
    EXPECT_THAT(mistakes[0].second.sentence, HasSubstr("circle"));
    EXPECT_THAT(mistakes[1].second.sentence, HasSubstr("circle"));
    EXPECT_THAT(mistakes[2].second.sentence, HasSubstr("did you mean 'b'"));
    EXPECT_THAT(mistakes[3].second.sentence, HasSubstr("another entry"));
}

}  // namespace
}  // namespace skyloop::test
