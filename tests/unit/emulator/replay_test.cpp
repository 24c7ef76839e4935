#include "run/emulator/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"
#include "wire/transport/file.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

Result<RecordedPort> recorded(const std::string& times, const std::string& bytes) {
    return read_recorded_times(times, to_bytes(bytes), "port0.times");
}

std::string refused_times(const std::string& times) {
    const auto port = recorded(times, "abcdefghij");
    EXPECT_FALSE(port) << times;
    if (port) return {};
    EXPECT_EQ(port.error().code, ErrorCode::input);
    return port.error().message;
}

// 3 bytes at 1 s, 4 at 1.02 s, 3 at 1.05 s.
RecordedPort ten_bytes() { return *recorded("1000000000 5 0 3\n1020000000 6 3 4\n1050000000 7 7 3\n", "abcdefghij"); }

TEST(RecordedOutput, ReadsTimes) {
    const RecordedPort port = ten_bytes();
    ASSERT_EQ(port.writes.size(), 3U);
    EXPECT_EQ(port.writes[1].at, Nanoseconds(1'020'000'000));
    EXPECT_EQ(port.writes[2].offset, 7U);
    EXPECT_EQ(port.writes[2].length, 3U);
    EXPECT_EQ(port.warning, "");
}

TEST(RecordedOutput, PlaysWhatAKilledRunLeft) {
    const auto half = recorded("10 5 0 3\n20 6 3", "abcdefghij");
    ASSERT_TRUE(half);
    EXPECT_EQ(half->writes.size(), 1U);
    EXPECT_EQ(
        half->warning,
        "port0.times: the recording was cut short: its last line is not whole, 7 bytes without a time are left out");
    const auto nothing = recorded("", "");
    ASSERT_TRUE(nothing);
    EXPECT_EQ(nothing->warning, "");
}

TEST(RecordedOutput, RefusesWhatDoesNotFitTogether) {
    EXPECT_EQ(refused_times("10 5 0 3\n20 6 3\n"),
              "port0.times:2: expected monotonic nanoseconds, GPS nanoseconds, offset and length");
    EXPECT_THAT(refused_times("10 5 0 3 \n"), HasSubstr("port0.times:1: expected"));
    EXPECT_THAT(refused_times("\n"), HasSubstr(":1: expected"));
    EXPECT_THAT(refused_times("10 5 0 99999999999999999999\n"), HasSubstr(":1: expected"));
    EXPECT_EQ(refused_times("10 5 0 3\n9 6 3 2\n"),
              "port0.times:2: the time 9 ns is before the 10 ns of the line before");
    EXPECT_EQ(refused_times("10 5 0 3\n20 6 4 2\n"), "port0.times:2: found offset 4; expected 3, the next byte");
    EXPECT_EQ(refused_times("10 5 0 0\n"), "port0.times:1: found length 0; expected more than 0");
    EXPECT_EQ(refused_times("10 5 0 11\n"), "port0.times:1: tells of bytes up to 11, but only 10 were recorded");
    EXPECT_THAT(refused_times("-1 5 0 1\n"), HasSubstr("the time -1 ns is no time of a recording"));
}

TEST(RecordedOutput, ReadsAllPortsOfAFolder) {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder / "recording";
    std::filesystem::create_directory(recording);
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(recording / name) << text;
    };
    EXPECT_THAT(read_recorded_output(recording).error().message, HasSubstr("port0.times: No such file"));
    write("port0.times", "1 1 0 2\n");
    EXPECT_THAT(read_recorded_output(recording).error().message, HasSubstr("port0.out: No such file"));
    write("port0.out", "ab");
    write("port1.out", "cde");
    EXPECT_THAT(read_recorded_output(recording).error().message, HasSubstr("port1.times: No such file"));
    write("port1.times", "2 1 0 3\n");
    const auto ports = read_recorded_output(recording);
    ASSERT_TRUE(ports) << ports.error().message;
    ASSERT_EQ(ports->size(), 2U);
    EXPECT_EQ(to_string(ports->at(1).bytes), "cde");
}

TEST(RecordedOutput, PacesBytesWithoutTimes) {
    const RecordedPort port = paced_output(Bytes(960, 'x'), 9600);
    EXPECT_EQ(port.writes.front().length, 1U);
    EXPECT_EQ(port.writes.size(), 960U);
    EXPECT_EQ(port.writes.back().at, Nanoseconds(1'000'000'000)) << "ten bits a byte";
    EXPECT_EQ(paced_output(Bytes(960, 'x'), 921600).writes.front().length, 92U);
    EXPECT_TRUE(paced_output({}, 9600).writes.empty());
}

TEST(RecordedOutput, GivesAPart) {
    const auto part = part_of({ten_bytes()}, Nanoseconds(10'000'000), Nanoseconds(40'000'000));
    ASSERT_TRUE(part);
    ASSERT_EQ(part->front().writes.size(), 1U);
    EXPECT_EQ(part->front().writes[0].at, Nanoseconds(10'000'000)) << "20 ms after the first, 10 ms after the cut";
    EXPECT_EQ(part->front().writes[0].offset, 3U);
    EXPECT_EQ(part_of({ten_bytes()}, Nanoseconds(0), Nanoseconds::max())->front().writes.size(), 3U);
    EXPECT_EQ(part_of({ten_bytes()}, Nanoseconds(60'000'000), Nanoseconds::max()).error().message,
              "nothing was sent from 0.060 s on; the recording is 0.050 s long");
    EXPECT_EQ(part_of({RecordedPort{}}, Nanoseconds(0), Nanoseconds::max()).error().message,
              "nothing was sent in this recording");
}

TEST(Replay, WritesEachPortOnItsWireInItsTime) {
    auto first = std::make_unique<MemoryTransport>(), second = std::make_unique<MemoryTransport>();
    const MemoryTransport& heard = *first;
    const MemoryTransport& other = *second;
    Replay::Parts parts;
    parts.ports = *part_of({ten_bytes(), *recorded("1040000000 1 0 2\n", "xy")}, Nanoseconds(0), Nanoseconds::max());
    parts.wires.push_back(std::move(first));
    parts.wires.push_back(std::move(second));
    parts.speed = 2;
    Replay replay(std::move(parts));
    const auto never = [] { return false; };
    replay.await_clients(never);
    const std::int64_t began = steady_clock_ns();
    replay.play(never);
    EXPECT_GE(steady_clock_ns() - began, 525'000'000) << "50 ms at twice the speed, and half a second of grace";
    EXPECT_EQ(to_string(heard.written()), "abcdefghij");
    EXPECT_EQ(to_string(other.written()), "xy");
    EXPECT_EQ(replay.writes(), 4U);
}

// The second write is due after an hour.
TEST(Replay, EndsWithTheLastOfItsWires) {
    Replay::Parts parts;
    parts.ports = {*recorded("1000000000 5 0 3\n3601000000000 6 3 7\n", "abcdefghij")};
    parts.wires.push_back(FileTransport::open("/dev/full").value());
    Replay replay(std::move(parts));
    replay.play([] { return false; });
    EXPECT_EQ(replay.writes(), 1U);
    EXPECT_EQ(replay.links()[0].counters().bytes_out, 0U);
    EXPECT_EQ(replay.links()[0].counters().bytes_lost, 0U) << "nobody has read too slowly";
    EXPECT_EQ(replay.links()[0].counters().bytes_unheard, 3U);
}

TEST(Replay, WaitsForAClientUntilItIsToStop) {
    auto wire = std::make_unique<MemoryTransport>();
    wire->set_line({false, std::nullopt});
    const MemoryTransport& heard = *wire;
    Replay::Parts parts;
    parts.ports.push_back(ten_bytes());
    parts.wires.push_back(std::move(wire));
    Replay replay(std::move(parts));
    int asked = 0;
    replay.await_clients([&] { return ++asked > 3; });
    EXPECT_EQ(asked, 4);
    replay.play([&] { return true; });
    EXPECT_TRUE(heard.written().empty());
}

}  // namespace
}  // namespace skyloop
