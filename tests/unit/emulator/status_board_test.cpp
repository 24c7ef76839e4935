#include "run/emulator/status_board.hpp"

#include <gtest/gtest.h>

#include <string>

#include "base/geo/local_frame.hpp"

namespace skyloop::test {
namespace {

constexpr GpsTime board_start{Nanoseconds(1'400'000'000'000'000'000)};

/// A board with a clock that a test sets.
struct BoardRig {
    std::int64_t clock_ns = 10'000'000'000;
    double strength = 0.25;
    StatusBoard board;

    explicit BoardRig(std::vector<TimelineBar> timeline = {}, bool every_epoch = false)
        : board({"test", board_start, std::nullopt, std::move(timeline), every_epoch}, nullptr, sources()) {}
    StatusSources sources() {
        StatusSources made;
        made.clock = [this] { return clock_ns; };
        made.strength = [this](std::string_view, int, GpsTime) { return strength; };
        return made;
    }
    void epoch(int index, bool reported_by_it = true) { epoch(index, reported_by_it, {}, {}); }
    void epoch(int index, bool reported_by_it, const firmware::CorrectionStatus& corrections,
               const std::optional<RelativePosition>& vector) {
        Trace trace;
        trace.truth.geodetic = Geodetic::degrees(48, 11, 500);
        trace.sky.satellites.resize(1);
        trace.sky.satellites[0].id = {Constellation::gps, 7};
        trace.arrivals.satellites.resize(1);
        trace.arrivals.satellites[0].id = {Constellation::gps, 7};
        trace.arrivals.satellites[0].line_of_sight = false;
        trace.arrivals.satellites[0].reflections = 1;
        firmware::NavigationState reported;
        reported.epoch.fix.type = FixType::fix_3d;
        reported.epoch.fix.position = Geodetic::degrees(48, 11, 503);
        SatelliteStatus status;
        status.id = {Constellation::gps, 7};
        status.cn0 = DbHz(41);
        status.used = true;
        reported.epoch.fix.satellites = {status};
        reported.epoch.relative = vector;
        reported.corrections = corrections;
        const GpsTime now = board_start + std::chrono::milliseconds(100 * index);
        board.on_epoch({now, 0, trace, reported, Nanoseconds(5), reported_by_it ? std::optional(now) : std::nullopt});
    }
    [[nodiscard]] std::uint64_t sequence() const { return board.latest()->sequence; }
};

TEST(StatusBoard, ShowsAnEpoch) {
    BoardRig rig;
    rig.epoch(1);
    const auto snapshot = rig.board.latest();
    ASSERT_EQ(snapshot->receivers.size(), 1U);
    const ReceiverStatus& receiver = snapshot->receivers[0];
    ASSERT_TRUE(receiver.error);
    EXPECT_NEAR(receiver.error->up.value(), 3, 1e-6);
    EXPECT_NEAR(receiver.error->east.value(), 0, 1e-6);
    EXPECT_EQ(receiver.satellites_used, 1);
    ASSERT_EQ(receiver.satellites.size(), 1U);
    EXPECT_TRUE(receiver.satellites[0].used);
    EXPECT_EQ(receiver.satellites[0].state, Reception::reflected);
    ASSERT_EQ(receiver.satellites[0].signals.size(), 1U);
    EXPECT_EQ(receiver.satellites[0].signals[0].second.value(), 41);
}

TEST(StatusBoard, ShowsNoFixOfAReceiverThatHasFallenSilent) {
    BoardRig rig({}, true);
    rig.epoch(0);
    for (const auto& [index, type] : {std::pair(19, FixType::fix_3d), std::pair(20, FixType::none)}) {
        rig.epoch(index, false);
        rig.board.publish_now(board_start);
        const ReceiverStatus receiver = rig.board.latest()->receivers[0];
        EXPECT_EQ(receiver.fix.type, type);
        EXPECT_EQ(receiver.error.has_value(), type == FixType::fix_3d);
        EXPECT_EQ(receiver.epoch, board_start + std::chrono::milliseconds(100 * index));
    }
}

// A kilometre north of the tests' receiver.
Position<Ecef> told_base() { return LocalFrame(Geodetic::degrees(48, 11, 503)).to_ecef(Position<Enu>{0, 1000, 0}); }

TEST(StatusBoard, ShowsNoCorrectionsBeforeSomeHaveCome) {
    BoardRig rig;
    rig.epoch(1);
    EXPECT_FALSE(rig.board.latest()->receivers[0].corrections);
}

TEST(StatusBoard, ShowsTheVectorThatWasSolved) {
    BoardRig rig;
    RelativePosition vector;
    vector.north_m = -999;
    vector.base_station = 7;
    vector.ratio = 12.5;
    rig.epoch(1, true, {CorrectionState::rtk_fixed, Seconds(1.5), 7, told_base(), true}, vector);
    const auto& corrections = rig.board.latest()->receivers[0].corrections;
    ASSERT_TRUE(corrections);
    EXPECT_EQ(corrections->solution, CorrectionState::rtk_fixed);
    EXPECT_EQ(corrections->age, Seconds(1.5));
    EXPECT_EQ(corrections->station, 7);
    ASSERT_TRUE(corrections->base);
    EXPECT_NEAR(corrections->base->latitude.deg(), 48.00899, 1e-5);
    ASSERT_TRUE(corrections->baseline);
    EXPECT_EQ(corrections->baseline->north_m, -999);
    EXPECT_EQ(corrections->baseline->ratio, 12.5);
}

TEST(StatusBoard, ShowsTheWayFromTheBaseOfASolutionByCodes) {
    BoardRig rig;
    rig.epoch(1, true, {CorrectionState::differential, Seconds(2), 7, told_base(), true}, {});
    const auto& corrections = rig.board.latest()->receivers[0].corrections;
    ASSERT_TRUE(corrections);
    EXPECT_EQ(corrections->solution, CorrectionState::differential);
    ASSERT_TRUE(corrections->baseline);
    EXPECT_NEAR(corrections->baseline->north_m, -1000, 0.01);
    EXPECT_EQ(corrections->baseline->ratio, 0);
}

TEST(StatusBoard, ShowsThatCorrectionsAreOfNoUse) {
    BoardRig rig;
    rig.epoch(1, true, {CorrectionState::none, Seconds(90), 7, told_base(), false}, {});
    const auto& corrections = rig.board.latest()->receivers[0].corrections;
    ASSERT_TRUE(corrections);
    EXPECT_EQ(corrections->solution, CorrectionState::none);
    EXPECT_EQ(corrections->age, Seconds(90));
    EXPECT_TRUE(corrections->base);
    EXPECT_FALSE(corrections->baseline);
}

TEST(StatusBoard, ShowsTheVectorOfAPairThatNeedsNoMessages) {
    BoardRig rig;
    RelativePosition vector;
    vector.fixed = false;
    vector.base_station = 3;
    vector.age = Seconds(0.2);
    rig.epoch(1, true, {}, vector);
    const auto& corrections = rig.board.latest()->receivers[0].corrections;
    ASSERT_TRUE(corrections);
    EXPECT_EQ(corrections->solution, CorrectionState::rtk_float);
    EXPECT_EQ(corrections->age, Seconds(0.2));
    EXPECT_EQ(corrections->station, 3);
    EXPECT_FALSE(corrections->base);
    EXPECT_TRUE(corrections->baseline->base_moves);
}

TEST(StatusBoard, ShowsNoCorrectionsOfAReceiverThatHasFallenSilent) {
    BoardRig rig({}, true);
    rig.epoch(0, true, {CorrectionState::rtk_fixed, Seconds(1), 7, told_base(), true}, {});
    rig.epoch(20, false);
    rig.board.publish_now(board_start);
    EXPECT_FALSE(rig.board.latest()->receivers[0].corrections);
}

TEST(StatusBoard, PublishesOnceASecondAndTenTimesWhileWatched) {
    BoardRig rig;
    rig.epoch(0);
    const auto published_in_a_second = [&rig] {
        const std::uint64_t before = rig.sequence();
        for (int i = 0; i < 1000; ++i) {
            rig.clock_ns += 1'000'000;
            rig.epoch(i);
        }
        return rig.sequence() - before;
    };
    EXPECT_EQ(published_in_a_second(), 1U);
    rig.board.watch();
    EXPECT_EQ(published_in_a_second(), 10U);
    rig.board.unwatch();
    EXPECT_EQ(published_in_a_second(), 1U);
}

TEST(StatusBoard, ShowsNewsSoon) {
    BoardRig rig;
    rig.epoch(0);
    const std::uint64_t before = rig.sequence();
    rig.board.on_fault({board_start, "outage", "outage", 1, true});
    rig.clock_ns += 100'000'000;
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before + 1);
    rig.clock_ns += 100'000'000;
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before + 1);
}

TEST(StatusBoard, ShowsAPausedRunWhenItIsLookedAt) {
    BoardRig rig;
    rig.epoch(0);
    const std::uint64_t before = rig.sequence();
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before);
    rig.clock_ns += 1'000'000'000;
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before + 1);
}

TEST(StatusBoard, AnswersWhoAsksOnceTheLoopHasComeRound) {
    BoardRig rig;
    rig.epoch(0);
    rig.board.look(board_start);
    const std::uint64_t before = rig.sequence(), asked = rig.board.ask();
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before) << "what waits in the queue may have come behind this instant";
    rig.board.look(board_start + std::chrono::seconds(7));
    EXPECT_EQ(rig.sequence(), before + 1);
    EXPECT_EQ(rig.board.latest()->answers, asked);
    EXPECT_EQ(rig.board.latest()->time, board_start + std::chrono::seconds(7));
    rig.board.look(board_start);
    EXPECT_EQ(rig.sequence(), before + 1);
    const std::uint64_t at_the_end = rig.board.ask();
    rig.board.publish_now(board_start);
    EXPECT_EQ(rig.board.latest()->answers, at_the_end);
}

TEST(StatusBoard, FollowsForAWhileWhoHasAsked) {
    BoardRig rig;
    rig.epoch(0);
    (void)rig.board.ask();
    rig.board.look(board_start);
    rig.board.look(board_start);
    const auto published = [&rig](int tenths) {
        const std::uint64_t before = rig.sequence();
        for (int i = 0; i < tenths; ++i) {
            rig.clock_ns += 100'000'000;
            rig.board.look(board_start);
        }
        return rig.sequence() - before;
    };
    EXPECT_EQ(published(19), 19U);
    EXPECT_LE(published(30), 4U);
}

TEST(StatusBoard, ShowsTheEpochAtTheEndOfAStep) {
    for (const bool every_epoch : {false, true}) {
        BoardRig rig({}, every_epoch);
        rig.epoch(0);
        Command step;
        step.verb = every_epoch ? CommandVerb::note : CommandVerb::step;
        rig.board.on_command({board_start, "step", step, {}});
        for (int i = 1; i <= 50; ++i)
            rig.epoch(i);
        rig.board.publish_now(board_start);
        EXPECT_EQ(rig.board.latest()->receivers[0].epoch, board_start + std::chrono::seconds(5)) << every_epoch;
    }
}

TEST(StatusBoard, KeepsTheLastMessagesAndTheirNumbers) {
    BoardRig rig;
    const Bytes long_message(5000, 0x55);
    for (int i = 0; i < 2000; ++i)
        rig.board.on_message({board_start, 0, 0, false, StreamKind::noise, "noise", long_message});
    rig.board.publish_now(board_start);
    const auto snapshot = rig.board.latest();
    ASSERT_EQ(snapshot->dialogue.size(), StatusBoard::most_dialogue_lines);
    EXPECT_EQ(snapshot->dialogue.back()->sequence, 2000U);
    EXPECT_EQ(snapshot->dialogue.back()->size, 5000U);
    EXPECT_EQ(snapshot->dialogue.back()->bytes.size(), dialogue_bytes);
}

TEST(StatusBoard, CountsMessagesByWireWayAndName) {
    BoardRig rig;
    const Bytes bytes(8, 0x55);
    for (int i = 0; i < 1000; ++i)
        rig.board.on_message({board_start, 0, 0, false, StreamKind::ubx, "NAV-PVT", bytes});
    rig.board.on_message({board_start, 0, 0, true, StreamKind::ubx, "MON-VER", bytes});
    rig.board.on_message({board_start, 0, 1, false, StreamKind::ubx, "NAV-PVT", bytes});
    rig.board.on_message({board_start, 0, 0, false, StreamKind::ubx, "MON-VER", bytes});
    rig.board.publish_now(board_start);
    const auto snapshot = rig.board.latest();
    ASSERT_EQ(snapshot->messages.size(), 4U);
    const auto count = [&](std::size_t wire, bool from_client, std::string_view name) {
        for (const MessageCount& message : snapshot->messages)
            if (message.wire == wire && message.from_client == from_client && message.name == name)
                return message.count;
        return std::uint64_t{0};
    };
    EXPECT_EQ(count(0, false, "NAV-PVT"), 1000U) << "those that the dialogue has let go, too";
    EXPECT_EQ(count(0, true, "MON-VER"), 1U);
    EXPECT_EQ(count(0, false, "MON-VER"), 1U);
    EXPECT_EQ(count(1, false, "NAV-PVT"), 1U);
}

TEST(StatusBoard, CountsABoundedNumberOfNames) {
    BoardRig rig;
    const Bytes bytes(8, 0x55);
    for (std::size_t i = 0; i < StatusBoard::most_message_counts + 100; ++i)
        rig.board.on_message({board_start, 0, 0, true, StreamKind::nmea, std::to_string(i), bytes});
    rig.board.on_message({board_start, 0, 0, true, StreamKind::nmea, "0", bytes});
    rig.board.publish_now(board_start);
    const auto snapshot = rig.board.latest();
    const std::vector<MessageCount>& messages = snapshot->messages;
    ASSERT_EQ(messages.size(), StatusBoard::most_message_counts);
    EXPECT_EQ(messages.front().name, "0");
    EXPECT_EQ(messages.front().count, 2U);
}

TEST(StatusBoard, FollowsFaultsOnTheTimeline) {
    TimelineBar planned;
    planned.name = "outage";
    planned.kind = "outage";
    planned.begins = board_start + std::chrono::seconds(60);
    BoardRig rig({planned});
    rig.board.on_fault({board_start + std::chrono::seconds(61), "outage", "outage", 1, true});
    rig.board.on_fault({board_start + std::chrono::seconds(62), "plug", "byte_loss", 1, true});
    rig.board.on_fault({board_start + std::chrono::seconds(70), "outage", "outage", 1, false});
    rig.board.publish_now(board_start);
    const auto snapshot = rig.board.latest();
    ASSERT_EQ(snapshot->timeline.size(), 2U);
    EXPECT_FALSE(snapshot->timeline[0].active);
    EXPECT_FALSE(snapshot->timeline[0].live);
    EXPECT_EQ(snapshot->timeline[0].begins, board_start + std::chrono::seconds(61));
    EXPECT_EQ(snapshot->timeline[0].ends, board_start + std::chrono::seconds(70));
    EXPECT_TRUE(snapshot->timeline[1].active);
    EXPECT_TRUE(snapshot->timeline[1].live);
    EXPECT_EQ(snapshot->timeline[1].strength, 0.25);
    EXPECT_EQ(snapshot->timeline[0].strength, 0.25) << "it fades";
    EXPECT_EQ(snapshot->events.size(), 3U);
    rig.strength = 0;
    rig.board.publish_now(board_start);
    EXPECT_EQ(rig.board.latest()->timeline[0].strength, 0);
}

TEST(StatusBoard, ShowsTheVerdictsOfItsSource) {
    StatusSources sources;
    sources.verdicts = [] { return std::vector<VerdictStatus>{{"a", "fix always", "pending", ""}}; };
    StatusBoard board({"test", board_start, std::nullopt, {}}, nullptr, sources);
    board.publish_now(board_start);
    ASSERT_EQ(board.latest()->verdicts.size(), 1U);
    EXPECT_EQ(board.latest()->verdicts[0].state, "pending");
}

TEST(StatusBoard, StaysBoundedOverManyOccurrences) {
    BoardRig rig;
    for (int i = 1; i <= 1000; ++i)
        for (const bool begins : {true, false})
            rig.board.on_fault({board_start, "outage", "outage", i, begins});
    rig.board.publish_now(board_start);
    EXPECT_EQ(rig.board.latest()->timeline.size(), StatusBoard::most_live_bars);
    EXPECT_EQ(rig.board.latest()->timeline.back().occurrence, 1000);
    EXPECT_EQ(rig.board.latest()->events.size(), StatusBoard::most_events);
}

}  // namespace
}  // namespace skyloop::test
