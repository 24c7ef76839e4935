// Messages that are found in what both ends of a wire say.
#include "run/emulator/dialogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "receiver/protocol/ubx_frame.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Names of what a client's bytes hold, as one piece after the other comes.
std::vector<std::string> names_in(const std::vector<std::string>& pieces, bool command_line) {
    std::vector<std::string> names;
    Dialogue dialogue(0, {[&](const MessageSeen& seen) { names.emplace_back(seen.name); }, [](const BeliefSeen&) {}},
                      command_line);
    for (const std::string& piece : pieces)
        dialogue.client_said(0, to_bytes(piece), GpsTime{});
    return names;
}

TEST(Dialogue, ALineOfACommandLineIsAMessage) {
    EXPECT_THAT(
        names_in({"sso, Stream1, COM1, DOP, sec1\r\nsetSBFOutput,Stream2\r\n", "SetCOMSett", "ings, COM1\n"}, true),
        ElementsAre("sso", "sso", "scs"));
    EXPECT_THAT(names_in({"SSSSSSSSSSSSSSSSSSSSSS\r\n"}, true), ElementsAre("SSSSSSSSSS"));
    EXPECT_THAT(names_in({"\r\n", " \n", "# comment\n"}, true), IsEmpty());
    EXPECT_THAT(names_in({"frob, COM1\n"}, true), ElementsAre("frob"));
}

TEST(Dialogue, LinesAreNoiseWhereNobodyTakesThem) {
    for (const std::string& name : names_in({"sso, Stream1, COM1\r\n" + std::string(300, 'x')}, false))
        EXPECT_EQ(name, "noise");
}

TEST(Dialogue, WhatIsNoTextOnACommandLineIsNoiseStill) {
    EXPECT_THAT(names_in({std::string(300, '\x80')}, true), testing::Contains("noise"));
}

TEST(Dialogue, AFrameThatHoldsAnotherIsOneMessageUnlessItEndsThere) {
    using namespace std::chrono_literals;
    std::vector<std::string> names;
    std::vector<GpsTime> times;
    Dialogue dialogue(0, {[&](const MessageSeen& seen) {
                              names.emplace_back(seen.name);
                              times.push_back(seen.now);
                          },
                          [](const BeliefSeen&) {}});
    const Bytes poll = encode_frame(UbxMessageId{0x0A, 0x04}, {}), outer = encode_frame(UbxMessageId{0x06, 0x3E}, poll);
    GpsTime now{1000s};
    const ByteSpan begun = ByteSpan(outer).first(outer.size() - 2), rest = ByteSpan(outer).last(2);
    dialogue.client_said(0, begun, now);
    dialogue.client_said(0, rest, now + 20ms);
    EXPECT_THAT(names, ElementsAre("CFG-GNSS"));
    names.clear();
    now += 1s;
    dialogue.client_said(0, begun, now);
    dialogue.receiver_said(0, to_bytes("x"), now + 50ms);
    EXPECT_THAT(names, IsEmpty());
    dialogue.receiver_said(0, to_bytes("x"), now + 120ms);
    EXPECT_THAT(names, testing::Contains("MON-VER"));
    EXPECT_EQ(times.back(), now + 100ms);
}

const std::atomic<bool> dialogue_never_stops{false};

// Keeps what the client is heard to send.
struct HeardCommands : RunObserver {
    void on_message(const MessageSeen& seen) override {
        if (seen.kind == StreamKind::command) names.emplace_back(seen.name);
    }
    [[nodiscard]] bool wants_messages() const override { return true; }
    std::vector<std::string> names;
};

TEST(Dialogue, ReceiversWithACommandLineAreListenedToByLines) {
    for (const bool septentrio : {true, false}) {
        auto run = test::memory_run(test::emulator_scenario(
            std::string("[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"ideal\"\n[[receiver]]\nboard = \"") +
            (septentrio ? "septentrio-sbf" : "ublox-m8") + "\"\n"));
        HeardCommands heard;
        run.emulator->add_observer(&heard);
        run.wire->feed(to_bytes("sso, Stream1, COM1, DOP, sec1\r\n"));
        run.emulator->run_until(advanced(run.start, Seconds(3)), dialogue_never_stops);
        if (septentrio)
            EXPECT_THAT(heard.names, ElementsAre("sso"));
        else
            EXPECT_THAT(heard.names, IsEmpty());
    }
}

}  // namespace
}  // namespace skyloop
