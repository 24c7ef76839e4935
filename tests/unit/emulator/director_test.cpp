// Faults and commands in a run: their beginning, their effect on the wire, their end without residue.
#include "run/emulator/director.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "receiver/protocol/nmea_sentence.hpp"
#include "run/feed/mavlink_component.hpp"
#include "support/run_parts.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::atomic<bool> go_on{false};

// What observers are told, a word each.
class Witness : public RunObserver {
public:
    void on_epoch(const EpochSeen& seen) override {
        ++epochs;
        with_fix += seen.reported.fix_ok ? 1 : 0;
    }
    void on_fault(const FaultSeen& seen) override {
        happened.push_back(std::string(seen.name) + (seen.begins ? " begins" : " ends"));
    }
    void on_command(const CommandSeen& seen) override {
        happened.push_back("command " + std::string(seen.name));
        if (!seen.ignored.empty()) ignored.emplace_back(seen.ignored);
    }
    void on_message(const MessageSeen& seen) override {
        if (seen.from_client) heard.emplace_back(seen.name);
    }
    [[nodiscard]] bool wants_messages() const override { return curious; }
    bool curious = true;
    int epochs = 0, with_fix = 0;
    std::vector<std::string> happened, heard, ignored;
};

struct DirectedRun {
    MemoryRun run;
    Witness witness;
    CommandQueue live;
};

std::unique_ptr<DirectedRun> directed(const std::string& toml, Nanoseconds tick = 0ns,
                                      const std::string& keeps_speed = "") {
    const Scenario scenario =
        emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"ideal\"\n" + toml);
    auto made = std::make_unique<DirectedRun>();
    MemoryRunParts parts;
    parts.tick = tick;
    made->run = memory_run(scenario, std::move(parts));
    Director::Parts director;
    director.faults = scenario.faults;
    director.commands = scenario.commands;
    director.start = made->run.start;
    director.live = &made->live;
    director.keeps_speed = keeps_speed;
    made->run.emulator->replace_director(Director(std::move(director)));
    made->run.emulator->add_observer(&made->witness);
    return made;
}

void run_for(DirectedRun& directed, Nanoseconds span) {
    directed.run.emulator->run_until(directed.run.emulator->now() + span, go_on);
}

std::string written(const DirectedRun& directed) { return to_string(ByteSpan(directed.run.wire->written())); }

std::string sound_bytes(Nanoseconds span) {
    const auto sound = directed("");
    run_for(*sound, span);
    return written(*sound);
}

TEST(Director, TellsWhatBeginsAndEnds) {
    const auto run = directed(
        "[[fault]]\nkind = \"receiver_silent\"\nname = \"quiet\"\nat_s = 2.5\nfor_s = 3\n"
        "[[command]]\nkind = \"note\"\ntext = \"x\"\nafter_end_of = \"quiet\"\nat_s = 1\n");
    run_for(*run, 10s);
    EXPECT_THAT(run->witness.happened, ElementsAre("quiet begins", "quiet ends", "command note"));
    EXPECT_EQ(run->witness.epochs, 10);
}

TEST(Director, ASilentReceiverSpeaksAgainAsIfNothingHadBeen) {
    const auto run = directed("[[fault]]\nkind = \"receiver_silent\"\nat_s = 3.5\nfor_s = 4\n");
    run_for(*run, 6s);
    const std::size_t silent_from = written(*run).size();
    run_for(*run, 1s);
    EXPECT_EQ(written(*run).size(), silent_from);
    run_for(*run, 20s);
    const std::string sound = sound_bytes(27s), faulty = written(*run);
    ASSERT_LT(faulty.size(), sound.size());
    constexpr std::size_t tail = 2000;
    ASSERT_GT(faulty.size(), tail);
    EXPECT_EQ(faulty.substr(faulty.size() - tail), sound.substr(sound.size() - tail));
}

TEST(Director, AWireWithFaultsDamagesBytesAndNoOthers) {
    const auto run = directed("[[fault]]\nkind = \"byte_loss\"\nat_s = 3.5\nfor_s = 4\nprobability = 0.2\n");
    run_for(*run, 20s);
    const std::string sound = sound_bytes(20s), faulty = written(*run);
    EXPECT_LT(faulty.size(), sound.size());
    EXPECT_GT(faulty.size(), sound.size() / 2);
    EXPECT_EQ(faulty.substr(0, 400), sound.substr(0, 400));
    EXPECT_EQ(faulty.substr(faulty.size() - 400), sound.substr(sound.size() - 400));
}

TEST(Director, AFaultFromTheStartOnIsThereBeforeTheFirstByte) {
    const auto run = directed("[[fault]]\nkind = \"receiver_deaf\"\nat_s = 0\nfor_s = 3\n", 10ms);
    const Bytes poll{0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34};
    run->run.wire->feed(poll);
    run_for(*run, 5s);
    EXPECT_EQ(written(*run).find("\xB5\x62\x0A\x04"), std::string::npos);
    run->run.wire->feed(poll);
    run_for(*run, 1s);
    EXPECT_NE(written(*run).find("\xB5\x62\x0A\x04"), std::string::npos);
}

TEST(Director, AnUnpluggedWireCarriesNothing) {
    const auto run = directed("[[fault]]\nkind = \"unplugged\"\nat_s = 3.5\nfor_s = 4\n");
    run_for(*run, 5s);
    const std::size_t before = written(*run).size();
    run_for(*run, 2s);
    EXPECT_EQ(written(*run).size(), before);
    EXPECT_FALSE(run->run.emulator->wires().front().link.connected());
    run_for(*run, 3s);
    EXPECT_GT(written(*run).size(), before);
}

TEST(Director, ABreakIsOneZeroByte) {
    const auto run = directed("[[fault]]\nkind = \"line_break\"\nat_s = 3.5\nfor_s = 4\n");
    run_for(*run, 20s);
    const std::string bytes = written(*run);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), '\0'), 1);
}

TEST(Director, AWrongSpeedOfTheLineGarbles) {
    const auto run = directed(
        "[[receiver]]\nbaud = 38400\n[[fault]]\nkind = \"speed_mismatch\"\nat_s = 3.5\nfor_s = 4\n"
        "baud = 9600\n");
    run->run.wire->set_line({true, 38400});
    run_for(*run, 20s);
    EXPECT_GT(run->run.emulator->wires().front().link.counters().bytes_garbled, 0u);
    const std::string faulty = written(*run);
    EXPECT_TRUE(parse_sentence(faulty.substr(faulty.rfind('$'))).has_value());
}

TEST(Director, CarriesOutLiveCommands) {
    const auto run = directed("[[fault]]\nkind = \"receiver_silent\"\nname = \"quiet\"\nat_s = 1000\nfor_s = 5\n");
    run_for(*run, 3s);
    Command start{CommandVerb::start_fault, Parameters({{"fault", std::string("quiet")}}), {}, "http"};
    ASSERT_TRUE(run->live.push(start));
    run_for(*run, 2s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "quiet begins"));
    ASSERT_TRUE(run->live.push({CommandVerb::stop_fault, Parameters({{"fault", std::string("quiet")}}), {}, "http"}));
    run_for(*run, 2s);
    EXPECT_THAT(run->witness.happened,
                ElementsAre("command start_fault", "quiet begins", "command stop_fault", "quiet ends"));
}

TEST(Director, BeginsFaultsThatNoScenarioNames) {
    const auto run = directed("");
    run_for(*run, 3s);
    const FaultKind& kind = *find_fault_kind("receiver_silent");
    auto values = check_parameters(kind.parameters, {}).parameters.values();
    values.emplace("kind", std::string("receiver_silent"));
    values.emplace("name", std::string("live"));
    values.emplace("for_s", 2.0);
    ASSERT_TRUE(run->live.push({CommandVerb::start_fault, Parameters(values), {}, "http"}));
    run_for(*run, 10s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "live begins", "live ends"));
}

// As a client asks for it.
void begin_live(DirectedRun& run, const std::string& name) {
    auto values = check_parameters(find_fault_kind("receiver_silent")->parameters, {}).parameters.values();
    values.emplace("kind", std::string("receiver_silent"));
    values.emplace("name", name);
    ASSERT_TRUE(run.live.push({CommandVerb::start_fault, Parameters(values), {}, "http"}));
}

void stop_live(DirectedRun& run, const std::string& name) {
    ASSERT_TRUE(run.live.push({CommandVerb::stop_fault, Parameters({{"fault", name}}), {}, "http"}));
}

TEST(Director, StopsALiveFaultByTheNameItWasAskedForBy) {
    const auto run = directed("[[fault]]\nkind = \"receiver_silent\"\nname = \"quiet\"\nat_s = 1000\n");
    begin_live(*run, "quiet");
    run_for(*run, 3s);
    stop_live(*run, "quiet");
    run_for(*run, 3s);
    EXPECT_THAT(run->witness.happened,
                ElementsAre("command start_fault", "quiet 2 begins", "command stop_fault", "quiet 2 ends"));
}

TEST(Director, StopsWhatHasTheNameBeforeWhatWasAskedForByIt) {
    const auto run = directed("");
    begin_live(*run, "quiet");
    begin_live(*run, "quiet");
    run_for(*run, 3s);
    run->witness.happened.clear();
    stop_live(*run, "quiet");
    run_for(*run, 1s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command stop_fault", "quiet ends"));
    stop_live(*run, "quiet");
    run_for(*run, 1s);
    EXPECT_EQ(run->witness.happened.back(), "quiet 2 ends");
    EXPECT_THAT(run->witness.ignored, IsEmpty());
}

TEST(Director, SaysThatNothingIsThereToStop) {
    const auto run = directed("[[fault]]\nkind = \"receiver_silent\"\nname = \"quiet\"\nat_s = 1000\n");
    stop_live(*run, "quiet");
    stop_live(*run, "");
    run_for(*run, 3s);
    EXPECT_THAT(run->witness.ignored, ElementsAre("quiet is not under way", "no fault is under way"));
}

TEST(Director, SaysThatAFaultThatIsToBeginIsNotThere) {
    const auto run = directed("[[fault]]\nkind = \"receiver_silent\"\nname = \"quiet\"\nat_s = 1000\n");
    for (const std::string name : {"zz", "quiet"})
        ASSERT_TRUE(run->live.push({CommandVerb::start_fault, Parameters({{"fault", name}}), {}, "feed"}));
    run_for(*run, 3s);
    EXPECT_THAT(run->witness.ignored, ElementsAre("no fault is called zz"));
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "command start_fault", "quiet begins"));
}

// A command of MAVLink comes again where its acknowledgement was lost, or because somebody else has ended the fault.
TEST(Director, AFailureThatIsInjectedAgainIsThereOnce) {
    const auto run = directed("");
    FailureInjector injector({run->run.emulator->stations().at(0).name()},
                             [&](Command command) { return run->live.push(std::move(command)); });
    const auto inject_off = [&] { EXPECT_EQ(injector.inject(failure_unit_gps, 1, 0), MavlinkResult::accepted); };
    inject_off();
    inject_off();
    run_for(*run, 1s);
    inject_off();
    run_for(*run, 1s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "command start_fault", "mavlink off 1 begins",
                                                   "command start_fault"));
    EXPECT_THAT(run->witness.ignored, ElementsAre("mavlink off 1 is under way"));
    stop_live(*run, "mavlink off 1");
    run_for(*run, 1s);
    run->witness.happened.clear();
    inject_off();
    run_for(*run, 1s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "mavlink off 1 begins"));
}

TEST(Director, StopsWhatWasBegunAtTheSameInstant) {
    const auto run = directed("");
    begin_live(*run, "quiet");
    stop_live(*run, "quiet");
    run_for(*run, 3s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command start_fault", "command stop_fault"));
    EXPECT_THAT(run->witness.ignored, IsEmpty());
    EXPECT_EQ(written(*run), sound_bytes(3s));
}

TEST(Director, SaysThatVirtualTimeWaitsForNobody) {
    const std::string commands =
        "[[command]]\nkind = \"pause\"\nat_s = 1\n[[command]]\nkind = \"speed\"\nfactor = 2\nat_s = 2\n";
    const auto run = directed(commands);
    run_for(*run, 3s);
    EXPECT_THAT(run->witness.ignored,
                ElementsAre("time is virtual, and waits for nobody", "time is virtual, and waits for nobody"));
}

TEST(Director, SaysThatASourceKeepsTheSpeedOfTheRun) {
    const std::string commands =
        "[[command]]\nkind = \"speed\"\nfactor = 2\nat_s = 1\n[[command]]\nkind = \"speed\"\nfactor = 1\nat_s = 2\n";
    const std::string why = "the live source leads the run's time";
    const auto led = directed(commands, 10ms, why), own = directed(commands, 10ms);
    for (const auto* run : {&led, &own})
        run_for(**run, 1500ms);
    EXPECT_EQ(led->run.emulator->director().speed(), 1);
    EXPECT_EQ(own->run.emulator->director().speed(), 2);
    run_for(*led, 1s);
    EXPECT_THAT(led->witness.ignored, ElementsAre(why)) << "it runs at 1";
    EXPECT_THAT(own->witness.ignored, IsEmpty());
}

// Whether time passes after these, in real time.
bool goes_on_after(const std::vector<std::pair<CommandVerb, std::string_view>>& asked) {
    const auto run = directed("", 10ms);
    for (const auto& [verb, source] : asked)
        EXPECT_TRUE(run->live.push({verb, Parameters(), {}, std::string(source)}));
    std::atomic<bool> stop{false};
    int looks = 0;
    run->run.emulator->on_look([&](GpsTime) { stop = ++looks == 5; });
    run->run.emulator->run_until(run->run.start + 1s, stop);
    return run->run.emulator->now() > run->run.start;
}

TEST(Director, ARunStandsStillForItsSourceAndForWhoHasPausedIt) {
    constexpr auto pause = CommandVerb::pause, resume = CommandVerb::resume;
    EXPECT_FALSE(goes_on_after({{pause, silence_source}}));
    EXPECT_TRUE(goes_on_after({{pause, silence_source}, {resume, silence_source}}));
    EXPECT_FALSE(goes_on_after({{pause, "http"}, {resume, silence_source}}));
    EXPECT_FALSE(goes_on_after({{pause, silence_source}, {pause, "http"}, {resume, silence_source}}));
    EXPECT_FALSE(goes_on_after({{pause, "http"}, {pause, silence_source}, {resume, "http"}}));
    EXPECT_TRUE(goes_on_after({{pause, "http"}, {pause, silence_source}, {resume, "http"}, {resume, silence_source}}));
    EXPECT_TRUE(goes_on_after({{pause, silence_source}, {resume, "http"}})) << "without its source, who wants it";
}

TEST(Director, KnowsHowStrongAFaultIs) {
    const auto run = directed(
        "[[fault]]\nkind = \"position_step\"\nname = \"jump\"\nat_s = 2\nfor_s = 6\nramp_in_s = 4\nramp_out_s = 2\n");
    const auto strength = [&](int occurrence = 1) {
        const Emulator& emulator = *run->run.emulator;
        return emulator.director().strength("jump", occurrence, emulator.now(), emulator.stations());
    };
    const double expected[] = {0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1, 0.5, 0, 0};  // of each second
    for (const double wanted : expected) {
        EXPECT_NEAR(strength(), wanted, 1e-6) << difference(run->run.emulator->now(), run->run.start).value() << " s";
        EXPECT_EQ(strength(2), 0) << "it comes but once";
        run_for(*run, 1s);
    }
}

TEST(Director, MovesTheVehicle) {
    const auto run = directed(
        "[trajectory]\nkind = \"fixed\"\nat = [10, 20, 300]\n"
        "[[command]]\nkind = \"move_to\"\nat_s = 5\nat = [11, 21]\n");
    run_for(*run, 4s);
    const auto place = [&] { return run->run.emulator->simulation().truth_at(run->run.emulator->now()).geodetic; };
    EXPECT_NEAR(place().latitude.deg(), 10, 1e-9);
    run_for(*run, 4s);
    EXPECT_NEAR(place().latitude.deg(), 11, 1e-9);
    EXPECT_NEAR(place().longitude.deg(), 21, 1e-9);
    EXPECT_NEAR(place().height.above_ellipsoid.value(), 300, 1e-6);
}

TEST(Director, EndsARunThatIsToldTo) {
    const auto run = directed("[[command]]\nkind = \"stop\"\nat_s = 4.5\n");
    run_for(*run, 100s);
    EXPECT_EQ(run->witness.epochs, 5);
}

TEST(Director, TriggersHearTheClient) {
    const auto run =
        directed("[[fault]]\nkind = \"receiver_silent\"\nwhen_client_sends = \"MON-VER\"\nfor_s = 2\n", 10ms);
    run_for(*run, 2s);
    const Bytes poll{0xB5, 0x62, 0x0A, 0x04, 0x00, 0x00, 0x0E, 0x34};
    run->run.wire->feed(poll);
    run_for(*run, 5s);
    EXPECT_THAT(run->witness.heard, ElementsAre("MON-VER"));
    EXPECT_THAT(run->witness.happened, ElementsAre("receiver_silent begins", "receiver_silent ends"));
}

TEST(Director, TriggersTakeTheSpeedOverTheGround) {
    const auto happened = [](const std::string& goal) {
        const auto run = directed(
            "[trajectory]\nkind = \"waypoints\"\n[[trajectory.waypoint]]\nat = [46, 30, 0]\nspeed_mps = 20\n"
            "[[trajectory.waypoint]]\nat = " +
            goal + "\n[[fault]]\nkind = \"receiver_silent\"\nwhen_faster_mps = 4\n");
        run_for(*run, 5s);
        return run->witness.happened;
    };
    EXPECT_THAT(happened("[46, 30, 1000]"), IsEmpty()) << "it climbs on the spot";
    EXPECT_THAT(happened("[46.01, 30, 0]"), ElementsAre("receiver_silent begins"));
}

TEST(Director, TriggersFollowTheVehicle) {
    const auto run = directed(
        "[[fault]]\nkind = \"receiver_silent\"\nwhen_mavlink_mode = \"AUTO\"\nwhen_armed = true\nfor_s = 2\n"
        "[[command]]\nkind = \"vehicle_state\"\nat_s = 2.5\nmode = \"AUTO\"\narmed = false\n"
        "[[command]]\nkind = \"vehicle_state\"\nat_s = 4.5\nmode = \"AUTO\"\narmed = true\n");
    run_for(*run, 4900ms);
    EXPECT_THAT(run->witness.happened, ElementsAre("command vehicle_state", "command vehicle_state 2"));
    run_for(*run, 5s);
    EXPECT_THAT(run->witness.happened, ElementsAre("command vehicle_state", "command vehicle_state 2",
                                                   "receiver_silent begins", "receiver_silent ends"));
}

TEST(Director, WhatACommandStartsIsThereAtTheSameInstant) {
    const std::string step = "[[fault]]\nkind = \"position_step\"\nname = \"off\"\n";
    const auto started = directed(step + "at_s = 90\n[[command]]\nkind = \"start_fault\"\nfault = \"off\"\nat_s = 4\n");
    const auto planned = directed(step + "at_s = 4\n");
    run_for(*started, 7s);
    run_for(*planned, 7s);
    EXPECT_EQ(written(*started), written(*planned)) << "the epoch at 4 s is off in both";
    EXPECT_NE(written(*started), sound_bytes(7s));
}

TEST(Director, TheSameSeedGivesTheSameBytes) {
    const std::string toml =
        "[[fault]]\nkind = \"byte_loss\"\nbetween_s = [2, 6]\nfor_between_s = [1, 5]\nprobability = 0.3\n"
        "[[fault]]\nkind = \"bit_flips\"\nat_s = 10\nfor_s = 5\n";
    const auto one = directed(toml), often = directed(toml, 7ms);
    run_for(*one, 20s);
    run_for(*often, 20s);
    EXPECT_EQ(written(*one), written(*often));
    EXPECT_NE(written(*one), sound_bytes(20s));
}

}  // namespace
}  // namespace skyloop::test
