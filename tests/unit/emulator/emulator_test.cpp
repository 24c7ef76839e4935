// The loop: its epochs, its bytes and its ends.
#include "run/emulator/emulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <set>

#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::emulator_scenario;
using test::lines_of;
using test::memory_run;
using test::MemoryRun;
using test::MemoryRunParts;
using test::TemporaryFolder;

const std::atomic<bool> never_stop{false};

std::string at_noon(const std::string& rest) { return "[run]\nstart = 2024-03-05T12:00:00Z\n" + rest; }

std::vector<GpsTime> epochs_of(MemoryRun& run, Nanoseconds span) {
    std::vector<GpsTime> epochs;
    run.emulator->on_status([&](const Status& status) {
        epochs.push_back(status.now);
        EXPECT_EQ(status.trace->truth.time, status.now);
        EXPECT_EQ(status.trace->epoch.fix.time, status.now);
    });
    run.emulator->run_until(run.start + span, never_stop);
    run.emulator->on_status({});
    return epochs;
}

std::string wire_bytes(const Scenario& scenario, MemoryRunParts parts, Nanoseconds span) {
    MemoryRun run = memory_run(scenario, std::move(parts));
    run.emulator->run_until(run.start + span, never_stop);
    return to_string(ByteSpan(run.wire->written()));
}

TEST(Emulator, EpochsLieOnTheGridOfGpsTime) {
    MemoryRun run = memory_run(emulator_scenario("[run]\nstart = 2024-03-05T12:00:00.3Z\n[[receiver]]\nrate_hz = 4"));
    const auto epochs = epochs_of(run, 2s);
    ASSERT_EQ(epochs.size(), 8U);
    EXPECT_EQ(epochs.front() - run.start, 200ms);
    for (std::size_t i = 0; i < epochs.size(); ++i) {
        EXPECT_EQ(epochs[i].time_since_epoch() % 250ms, 0ns);
        EXPECT_EQ(epochs[i] - epochs[0], i * 250ms);
    }
    EXPECT_EQ(run.emulator->counts().epochs, 8U);
    EXPECT_EQ(run.emulator->now(), run.start + 2s);
}

TEST(Emulator, TheEndIsNotPartOfTheRun) {
    MemoryRun run = memory_run(emulator_scenario(at_noon("")));
    EXPECT_EQ(epochs_of(run, 3s).size(), 3U) << "epochs at 0, 1 and 2 s";
    run.emulator->run_until(run.start + 5s, never_stop);
    EXPECT_EQ(run.emulator->counts().epochs, 5U) << "a run goes on where it ended";
    EXPECT_EQ(run.emulator->counts().epochs_with_fix, 5U);
    EXPECT_EQ(run.emulator->receiver().counters().epochs, 5U);
}

TEST(Emulator, EachEpochIsHeardOnTheWire) {
    const std::string bytes = wire_bytes(emulator_scenario(at_noon("")), {}, 4s);
    StreamSplitter splitter;
    int positions = 0;
    for (const StreamPiece& piece : splitter.feed(to_bytes(bytes))) {
        const std::string line = to_string(piece.bytes);
        ASSERT_TRUE(decode_nmea(line)) << line;
        positions += line.find("RMC,12000") != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(positions, 4);
}

// How often the loop looks at the wire changes when bytes are handed over, never which.
TEST(Emulator, TheBytesDoNotDependOnHowOftenTheWireIsServed) {
    for (const char* receiver : {"", "rate_hz = 10", "baud = 115200\nrate_hz = 5",
                                 "board = \"nmea-generic\"\nbaud = 4800", "board = \"ublox-f9p\"\nrate_hz = 7"}) {
        const Scenario scenario = emulator_scenario(at_noon("[[receiver]]\n" + std::string(receiver)));
        const std::string per_epoch = wire_bytes(scenario, {}, 3s);
        EXPECT_GT(per_epoch.size(), 500U);
        for (const Nanoseconds tick : {Nanoseconds(1ms), Nanoseconds(7ms), Nanoseconds(333us), Nanoseconds(40s)})
            EXPECT_EQ(wire_bytes(scenario, {tick, std::nullopt, {true, std::nullopt}}, 3s), per_epoch)
                << receiver << ", every " << tick.count() << " ns";
    }
}

TEST(Emulator, GarbledBytesDoNotDependOnItEither) {
    // The line comes to rest within each epoch.
    const Scenario scenario = emulator_scenario(at_noon("[[receiver]]\nsentences = [\"RMC\", \"GGA\"]"));
    for (const std::uint32_t client : {4800U, 19200U, 9700U}) {
        const std::string per_epoch = wire_bytes(scenario, {0ns, std::nullopt, {true, client}}, 5s);
        EXPECT_GT(per_epoch.size(), 100U);
        EXPECT_EQ(wire_bytes(scenario, {1ms, std::nullopt, {true, client}}, 5s), per_epoch) << client;
    }
}

TEST(Emulator, AwaitsClientsWhereTimeNeverWaitsToo) {
    MemoryRun run = memory_run(emulator_scenario(at_noon("")), {0ns, std::nullopt, {false, std::nullopt}});
    int rests = 0;
    run.emulator->on_look([&](GpsTime now) {
        if (rests == 3) return;
        EXPECT_EQ(now, run.start);
        if (++rests == 3) run.wire->set_line({true, std::nullopt});
    });
    run.emulator->await_clients(never_stop);
    EXPECT_EQ(rests, 3);
    run.emulator->run_until(run.start + 2s, never_stop);
    EXPECT_EQ(run.emulator->wires().at(0).link.counters().bytes_unheard, 0U);
    EXPECT_GT(run.emulator->wires().at(0).link.counters().bytes_out, 0U);
}

TEST(Emulator, TheStopFlagEndsTheRun) {
    std::atomic<bool> stop{false};
    MemoryRun run = memory_run(emulator_scenario(at_noon("")));
    run.emulator->on_status([&](const Status& status) { stop = status.now >= run.start + 6s; });
    run.emulator->run_until(GpsTime::max(), stop);
    EXPECT_EQ(run.emulator->counts().epochs, 7U);
    EXPECT_EQ(run.emulator->now(), run.start + 6s);
    run.emulator->run_until(GpsTime::max(), stop);
    EXPECT_EQ(run.emulator->counts().epochs, 7U) << "nothing runs while it is set";
}

TEST(Emulator, ARecordingThatFailsEndsTheRun) {
    const TemporaryFolder folder;
    auto recorder = test::recorder_in(folder / "run");
    ASSERT_TRUE(recorder);
    MemoryRun run = memory_run(emulator_scenario(at_noon("")), {1ms, std::move(*recorder), {true, std::nullopt}});
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{100'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    run.emulator->run_until(run.start + 1h, never_stop);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    ASSERT_TRUE(run.emulator->recorder()->failure());
    EXPECT_LT(run.emulator->counts().epochs, 100U);
    EXPECT_GE(run.emulator->counts().epochs, 2U);
}

// A row of a port's times: when a part of its bytes left, by both clocks, in ns, and which.
struct WrittenPart {
    std::int64_t monotonic = 0, gps = 0;
    std::size_t at = 0, count = 0;
};

std::vector<WrittenPart> written_parts(const std::filesystem::path& times) {
    std::vector<WrittenPart> parts;
    for (const std::string& line : lines_of(content_of(times))) {
        WrittenPart& part = parts.emplace_back();
        std::istringstream(line) >> part.monotonic >> part.gps >> part.at >> part.count;
    }
    return parts;
}

TEST(Emulator, TheRecordingHoldsTheBytesOfTheWire) {
    const TemporaryFolder folder;
    auto recorder = test::recorder_in(folder / "run");
    MemoryRun run = memory_run(emulator_scenario(at_noon("")), {1ms, std::move(*recorder), {true, std::nullopt}});
    run.wire->feed(to_bytes("$PUBX,00*33\r\n"));
    run.emulator->run_until(run.start + 5s, never_stop);
    const std::string bytes = content_of(folder / "run/port0.out");
    EXPECT_EQ(bytes, to_string(ByteSpan(run.wire->written())));
    EXPECT_EQ(content_of(folder / "run/port0.in"), "$PUBX,00*33\r\n");
    EXPECT_EQ(run.emulator->receiver().counters().bytes_received, 13U);
    EXPECT_EQ(run.emulator->wires()[0].link.counters().bytes_out, bytes.size());
    std::size_t offset = 0;
    std::int64_t latest = 0;
    for (const auto& [monotonic, gps, at, count] : written_parts(folder / "run/port0.times")) {
        EXPECT_EQ(at, offset);
        EXPECT_GT(monotonic, latest);
        EXPECT_EQ(gps - run.start.time_since_epoch().count(), monotonic);
        EXPECT_LE(count, 2U) << "a millisecond has room for one byte at 9600 bit/s, and a part of the next";
        offset += count;
        latest = monotonic;
    }
    EXPECT_EQ(offset, bytes.size());
}

TEST(Emulator, KnowsInVirtualTimeWhenEachMessageLeft) {
    const TemporaryFolder folder;
    auto recorder = test::recorder_in(folder / "run");
    MemoryRun run = memory_run(emulator_scenario(at_noon("")), {Nanoseconds(0), std::move(*recorder), {true, {}}});
    run.emulator->run_until(run.start + 3s, never_stop);
    const std::string bytes = content_of(folder / "run/port0.out");
    constexpr double byte_ns = 1e10 / 9600;
    std::int64_t before = 0;
    std::size_t messages = 0;
    for (const auto& [monotonic, gps, at, count] : written_parts(folder / "run/port0.times")) {
        EXPECT_EQ(bytes.substr(at, 1), "$");
        EXPECT_EQ(bytes.find('\n', at), at + count - 1) << "a sentence by itself";
        if (messages > 0 && gps - before < 200'000'000) {
            EXPECT_NEAR(static_cast<double>(gps - before), byte_ns * static_cast<double>(count), 2)
                << "as long as the line takes for it";
        }
        before = gps;
        ++messages;
    }
    EXPECT_GT(messages, 12U);
}

// fixes.csv and satellites.csv of a minute.
std::pair<std::string, std::string> recorded_minute(const std::string& text) {
    const TemporaryFolder folder;
    auto recorder = test::recorder_in(folder / "run");
    MemoryRun run = memory_run(emulator_scenario(text), {0ns, std::move(*recorder), {true, std::nullopt}});
    run.emulator->run_until(run.start + 60s, never_stop);
    return {content_of(folder / "run/fixes.csv"), content_of(folder / "run/satellites.csv")};
}

TEST(Emulator, TheSameScenarioAndSeedGiveTheSameRows) {
    for (const std::string_view model : model_names()) {
        const std::string text = at_noon("seed = 5\n[model]\nname = \"" + std::string(model) + "\"");
        EXPECT_EQ(recorded_minute(text), recorded_minute(text)) << model;
    }
}

TEST(Emulator, AnotherSeedGivesOtherFixesOfTheSameSky) {
    const auto one = recorded_minute(at_noon("seed = 1\n[model]\nname = \"baseline\""));
    const auto two = recorded_minute(at_noon("seed = 2\n[model]\nname = \"baseline\""));
    EXPECT_EQ(one.second, two.second) << "satellites do not depend on the seed";
    const auto first = lines_of(one.first), second = lines_of(two.first);
    ASSERT_EQ(first.size(), 61U);
    ASSERT_EQ(second.size(), 61U);
    int same = 0;
    for (std::size_t i = 1; i < first.size(); ++i) {
        const auto a = test::cells_of(first[i]), b = test::cells_of(second[i]);
        same += a[6] == b[6] ? 1 : 0;
        EXPECT_EQ(a[3], b[3]) << "nor does the truth";
    }
    EXPECT_LT(same, 3);
}

// What a station sends over a wire of memory after it was handed this one epoch.
std::string sent_after(const Scenario& scenario, const Trace& trace) {
    const GpsTime now = trace.truth.time;
    Station::Parts parts = test::station_parts(scenario, 0, now);
    auto transport = std::make_unique<MemoryTransport>();
    MemoryTransport* wire = transport.get();
    parts.wires.push_back({firmware::PortId::uart1, Link(std::move(transport), 9600)});
    Station station(std::move(parts));
    station.start(now);
    station.report(trace, 0ns, false);
    station.carry_out({now + 10s, 0});
    station.take_in({now + 10s, 0});
    return to_string(ByteSpan(wire->written()));
}

// Two antennas with the same fix but different truths: the receiver is handed an Epoch, which holds none.
TEST(Emulator, TheReceiverIsNotShownTheTruth) {
    const Scenario scenario = emulator_scenario(at_noon(""));
    MemoryRun run = memory_run(scenario);
    Trace seen;
    run.emulator->on_status([&](const Status& status) { seen = *status.trace; });
    run.emulator->run_until(run.start + 1s, never_stop);
    const std::string bytes = sent_after(scenario, seen);
    EXPECT_GT(bytes.size(), 100U);
    EXPECT_EQ(to_string(ByteSpan(run.wire->written())).substr(0, bytes.size()),
              bytes.substr(0, run.wire->written().size()))
        << "what went over the wire is of this epoch alone";
    const GpsTime time = seen.truth.time;
    seen.truth = {};
    seen.truth.time = time;
    seen.sky = {};
    seen.arrivals = {};
    EXPECT_EQ(sent_after(scenario, seen), bytes);
}

}  // namespace
}  // namespace skyloop
