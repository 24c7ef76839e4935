// Corrections of a caster at a port that a client writes to as well.
#include "run/emulator/corrections_wire.hpp"

#include <gtest/gtest.h>

#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "run/emulator/emulator.hpp"
#include "support/memory_transport.hpp"
#include "support/run_parts.hpp"
#include "unit/ntrip/ntrip_peers.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::comes_true;

const std::atomic<bool> corrections_never_stop{false};

struct SharedPort {
    SharedPort() {
        const Scenario scenario = test::emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z");
        start = *scenario.run.start;
        Station::Parts parts = test::station_parts(scenario, 0, start);
        for (const bool one_way : {false, true}) {
            auto transport = std::make_unique<MemoryTransport>();
            ends.push_back(transport.get());
            const PortSpeed speed = port_speed(parts.receiver, port);
            parts.wires.push_back(
                {port, Link(std::move(transport), speed, one_way ? InputPace::at_once : InputPace::line), one_way});
        }
        std::vector<Station> stations;
        stations.emplace_back(std::move(parts));
        stations.front().add_tap(
            port, [this](ByteSpan bytes, GpsTime) { tapped.insert(tapped.end(), bytes.begin(), bytes.end()); });
        emulator.emplace(Emulator::Parts{std::move(stations), std::make_unique<test::TickingPacer>(start, 1ms)}, start);
    }

    firmware::PortId port = firmware::PortId::uart1;
    GpsTime start;
    std::vector<MemoryTransport*> ends;  // the client's, the caster's
    Bytes tapped;
    std::optional<Emulator> emulator;
};

TEST(CorrectionsAtAPort, BreakNoMessageOfItsClient) {
    SharedPort shared;
    const Bytes poll = encode_frame({0x0A, 0x04}, {});
    shared.ends[0]->feed(poll);
    shared.ends[0]->feed(poll);
    shared.ends[1]->feed(encode_rtcm3(Bytes(200, 0x43)));
    shared.emulator->run_until(shared.start + 2s, corrections_never_stop);
    const firmware::PortStatus status = shared.emulator->receiver().port_status(shared.port);
    EXPECT_EQ(status.messages_in[0], 2);
    EXPECT_EQ(status.messages_in[2], 1);
    EXPECT_EQ(status.skipped, 0U);
}

TEST(CorrectionsAtAPort, HaveNothingSentAgainstThem) {
    SharedPort shared;
    shared.emulator->run_until(shared.start + 2s, corrections_never_stop);
    EXPECT_GT(shared.ends[0]->written().size(), 100U);
    EXPECT_TRUE(shared.ends[1]->written().empty());
    EXPECT_EQ(shared.tapped, shared.ends[0]->written());
}

TEST(CorrectionsAtAPort, NobodyWaitsForTheirCaster) {
    SharedPort shared;
    shared.ends[1]->set_line({false, std::nullopt});
    shared.emulator->await_clients(corrections_never_stop);  // comes back
    SUCCEED();
}

TEST(CorrectionsWire, BringsFramesWhole) {
    test::CasterBench bench;
    CorrectionsWire wire({parse_ntrip_uri(bench.uri("me:secret@/BASE")).value(), 10s, 1});
    EXPECT_EQ(wire.description(), bench.uri("/BASE") + " (ntrip)");
    EXPECT_EQ(wire.other_end(), "not connected yet");
    wire.begin();
    ASSERT_TRUE(comes_true([&] { return wire.line().connected; }));
    const std::string frame = to_string(encode_rtcm3(Bytes(100, 0x43)));
    bench.send(frame.substr(0, 50));
    ASSERT_TRUE(comes_true([&] { return wire.counts().bytes == 50; }));
    EXPECT_TRUE(wire.read().empty());
    bench.send(frame.substr(50));
    std::string heard;
    EXPECT_TRUE(comes_true([&] {
        heard += to_string(wire.read());
        return heard == frame;
    }));
    EXPECT_EQ(wire.messages(), 1U);
    EXPECT_EQ(wire.other_end().substr(0, 20), "NTRIP 2.0, connected");
}

}  // namespace
}  // namespace skyloop
