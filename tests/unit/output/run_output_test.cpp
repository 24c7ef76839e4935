// From epochs to messages: which, in which order, when, and what a bad other end changes.
#include "run/output/run_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/core/threads.hpp"
#include "epochs.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "receiver/protocol/msp.hpp"

namespace skyloop {
namespace {

using test::SampleEpoch;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// An output into a file, in time that does not wait.
class FileOutput : public testing::Test {
protected:
    FileOutput() {
        std::string name = (std::filesystem::temp_directory_path() / "skyloop-output-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
    }
    ~FileOutput() override { std::filesystem::remove_all(folder_); }

    std::unique_ptr<RunOutput> open(const std::string& format, const std::string& options = {},
                                    OutputParts parts = {{"front", "rear"}, {}, true}) {
        const auto settings = parse_output_uri(format + "-file:" + path() + options);
        EXPECT_TRUE(settings) << settings.error().message;
        auto output = RunOutput::open(*settings, std::move(parts));
        EXPECT_TRUE(output) << output.error().message;
        return std::move(*output);
    }
    [[nodiscard]] std::string path() const { return (folder_ / "out").string(); }
    [[nodiscard]] std::string written() const {
        std::ifstream file(path(), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] Bytes bytes() const { return to_bytes(written()); }

    std::filesystem::path folder_;
};

struct FrameSeen {
    std::uint32_t message;
    int sequence;
    bool operator==(const FrameSeen&) const = default;
};
std::ostream& operator<<(std::ostream& out, const FrameSeen& seen) {
    return out << seen.message << "#" << seen.sequence;
}

std::vector<FrameSeen> frames_of(const Bytes& bytes) {
    std::vector<FrameSeen> seen;
    for (const MavlinkFrameView& frame : mavlink_frames(bytes))
        seen.push_back({frame.message, frame.source.sequence});
    return seen;
}

TEST_F(FileOutput, GpsInputIsNumberedAndHasAHeartbeatASecond) {
    const auto output = open("gps-input", ",system=7,component=42,id=1");
    for (int i = 0; i < 7; ++i)
        output->on_epoch(SampleEpoch(Seconds(0.4 * i)).seen());
    output->finish();
    EXPECT_THAT(
        frames_of(bytes()),
        ElementsAre(FrameSeen{0, 0}, FrameSeen{232, 1}, FrameSeen{232, 2}, FrameSeen{232, 3}, FrameSeen{0, 4},
                    FrameSeen{232, 5}, FrameSeen{232, 6}, FrameSeen{232, 7}, FrameSeen{0, 8}, FrameSeen{232, 9}));
    const Bytes all = bytes();
    const auto frame = mavlink_frames(all).at(1);
    EXPECT_EQ(frame.source.system, 7);
    EXPECT_EQ(frame.source.component, 42);
    const auto input = decode_mavlink<MavlinkGpsInput>(frame.payload);
    EXPECT_EQ(input.gps_id, 1);
    EXPECT_EQ(input.time_week, 2304);
    EXPECT_EQ(input.time_week_ms, 216018000U);
    EXPECT_EQ(input.ignore_flags, 0);
    EXPECT_EQ(output->counts().sent.messages, 10U);
}

TEST_F(FileOutput, ASilentReceiverOfAnAliveComponentSendsHeartbeatsAlone) {
    const auto output = open("hil-gps");
    for (int i = 0; i < 3; ++i) {
        SampleEpoch epoch{Seconds(i)};
        if (i > 0) epoch.leaves.reset();
        output->on_epoch(epoch.seen());
    }
    output->finish();
    EXPECT_THAT(frames_of(bytes()), ElementsAre(FrameSeen{0, 0}, FrameSeen{113, 1}, FrameSeen{0, 2}, FrameSeen{0, 3}));
}

TEST_F(FileOutput, ReportsLeaveInTheOrderOfTheWire) {
    const auto output = open("gps-input");
    for (int i = 0; i < 4; ++i) {
        SampleEpoch epoch{Seconds(0.1 * i)};
        if (i == 1) epoch.leaves = advanced(epoch.seen().now, Seconds(0.17));  // overtaken by the next one
        output->on_epoch(epoch.seen());
    }
    output->finish();
    const Bytes all = bytes();
    std::vector<std::uint32_t> times;
    for (const MavlinkFrameView& frame : mavlink_frames(all))
        if (frame.message == 232) times.push_back(decode_mavlink<MavlinkGpsInput>(frame.payload).time_week_ms % 1000);
    EXPECT_THAT(times, ElementsAre(0, 200, 100, 300));
}

TEST_F(FileOutput, MspHasNoOtherNumberThanZeroForNoFix) {
    const auto output = open("msp", ",id=2");
    SampleEpoch none{Seconds(1)};
    none.state.epoch.fix.type = FixType::none;
    output->on_epoch(SampleEpoch().seen());
    output->on_epoch(none.seen());
    output->finish();
    const Bytes all = bytes();
    constexpr std::size_t frame_size = 61;
    ASSERT_EQ(all.size(), 2 * frame_size);
    const auto type_of = [&](std::size_t i) { return all.at(i * frame_size + 8 + 7); };
    EXPECT_EQ(all.at(8), 2) << "instance";
    EXPECT_EQ(type_of(0), 3);
    EXPECT_EQ(type_of(1), 0);
}

TEST_F(FileOutput, JsonTellsAllReceiversAndOthersOne) {
    const auto output = open("json");
    for (int i = 0; i < 3; ++i)
        for (const std::size_t station : {0U, 1U})
            output->on_epoch(SampleEpoch(Seconds(i)).seen(station));
    output->finish();
    std::istringstream lines(written());
    std::vector<std::pair<std::string, int>> told;
    for (std::string line; std::getline(lines, line);) {
        const auto one = nlohmann::json::parse(line);
        told.emplace_back(one["receiver"], one["epoch"]);
    }
    using Told = std::pair<std::string, int>;
    EXPECT_THAT(told, ElementsAre(Told{"front", 0}, Told{"rear", 0}, Told{"front", 1}, Told{"rear", 1},
                                  Told{"front", 2}, Told{"rear", 2}));
    const auto one = open("gps-input", ",receiver=rear");
    one->on_epoch(SampleEpoch().seen(0));
    one->on_epoch(SampleEpoch().seen(1));
    one->finish();
    EXPECT_EQ(one->counts().sent.messages, 2U);  // with the heartbeat
}

TEST_F(FileOutput, AReportIsToldAsOftenAsItIsSent) {
    const auto output = open("msp");
    SampleEpoch twice;
    twice.state.reports = 2;
    output->on_epoch(twice.seen());
    output->finish();
    EXPECT_EQ(output->counts().sent.messages, 2U);
}

// 20000 epochs as fast as they can be made: none is left out where the loop may wait.
TEST_F(FileOutput, NothingIsLeftOutInTimeThatDoesNotWait) {
    std::string first;
    for (int run = 0; run < 2; ++run) {
        const auto output = open("gps-input");
        for (int i = 0; i < 20000; ++i)
            output->on_epoch(SampleEpoch(Seconds(0.1 * i)).seen());
        output->finish();
        EXPECT_EQ(output->counts().left_out, 0U);
        EXPECT_EQ(output->counts().sent.lost, 0U);
        EXPECT_GT(output->counts().sent.messages, 20000U);
        if (run == 0) first = written();
    }
    EXPECT_EQ(written(), first) << "the same run, other bytes";
}

TEST_F(FileOutput, InLiveTimeAReportWaitsForItsInstantAndTheLoopForNothing) {
    const std::int64_t begin = steady_clock_ns();
    const GpsTime start = SampleEpoch().seen().now;
    OutputParts parts{{"only"}, [&](GpsTime time) { return begin + (time - start).count(); }, false};
    const auto output = open("gps-input", {}, std::move(parts));
    SampleEpoch late;
    late.leaves = advanced(start, Seconds(0.3));
    output->on_epoch(late.seen());
    while (output->counts().sent.messages == 0 && steady_clock_ns() < begin + 5'000'000'000)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GE(steady_clock_ns() - begin, 299'000'000);
    EXPECT_EQ(output->counts().sent.messages, 2U);
    // 5000 that are to leave in an hour: the first ones give way.
    late.leaves = advanced(start, Seconds(3600));
    for (int i = 0; i < 5000; ++i)
        output->on_epoch(late.seen());
    EXPECT_EQ(output->counts().left_out, 5000U - 4096U);
    output->finish();
    EXPECT_EQ(output->counts().sent.messages, 2U + 4096U);
}

TEST(RunOutput, AnEndThatRefusesIsToldOnceAndCounted) {
    const auto settings = parse_output_uri("gps-input:127.0.0.1:9");  // discard, where nobody listens
    auto output = RunOutput::open(*settings, {{"only"}, {}, true});
    ASSERT_TRUE(output) << output.error().message;
    EXPECT_EQ((*output)->description(), "gps-input: 127.0.0.1:9 (udp)");
    for (int i = 0; i < 100; ++i)
        (*output)->on_epoch(SampleEpoch(Seconds(i)).seen());
    (*output)->finish();
    const SinkCounts sent = (*output)->counts().sent;
    EXPECT_EQ(sent.messages, 200U);
    EXPECT_GT(sent.lost, 0U);
    EXPECT_THAT((*output)->take_news(), ElementsAre(HasSubstr("refused")));
    EXPECT_THAT((*output)->take_news(), IsEmpty());
}

TEST(RunOutput, SaysWhatCannotBeOpened) {
    const auto of = [](const std::string& uri) {
        const auto settings = parse_output_uri(uri);
        EXPECT_TRUE(settings) << uri;
        const auto output = RunOutput::open(*settings, {{"only"}, {}, true});
        EXPECT_FALSE(output) << uri;
        return output ? std::string() : output.error().message;
    };
    EXPECT_THAT(of("json-file:/no/such/folder/x"), HasSubstr("/no/such/folder/x: cannot be written"));
    EXPECT_THAT(of("json-tcp:1,receiver=other"), HasSubstr("'other' is no receiver"));
    EXPECT_THAT(of("gps-input:no.such.host.invalid:1"), HasSubstr("no.such.host.invalid:1"));
}

}  // namespace
}  // namespace skyloop
