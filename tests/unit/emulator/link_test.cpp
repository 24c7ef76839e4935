#include "run/emulator/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/memory_transport.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t receiver_baud = 9600;
const Bytes sentence_bytes = to_bytes("$GPRMC,120000.00,V,,,,,,,010710,,,N*7D\r\n");

struct JoinedLink {
    MemoryTransport* wire;
    Link link;
};

JoinedLink joined_link(std::optional<std::uint32_t> client_baud, bool connected = true) {
    auto transport = std::make_unique<MemoryTransport>();
    MemoryTransport* wire = transport.get();
    wire->set_line({connected, client_baud});
    return {wire, Link(std::move(transport), receiver_baud)};
}

// One look at the wire, and all that the receiver has heard by then.
Bytes all_heard(Link& link, PortSpeed speed, GpsTime now = {}) {
    link.look(now);
    Bytes all;
    while (const auto heard = link.receive(speed, now))
        all.insert(all.end(), heard->begin(), heard->end());
    return all;
}

// A link whose client's bytes take their time.
JoinedLink paced_link(PortSpeed speed, std::optional<std::uint32_t> client_baud) {
    auto transport = std::make_unique<MemoryTransport>();
    MemoryTransport* wire = transport.get();
    wire->set_line({true, client_baud});
    return {wire, Link(std::move(transport), speed, InputPace::line)};
}

TEST(Link, TellsTheWireTheReceiversSpeed) { EXPECT_EQ(joined_link(std::nullopt).wire->receiver_baud(), receiver_baud); }

TEST(Link, EqualSpeedsAndWiresWithoutSpeedPassBytesAsTheyAre) {
    for (const std::optional<std::uint32_t> baud : {std::optional<std::uint32_t>(), std::optional(receiver_baud)}) {
        JoinedLink joined = joined_link(baud);
        joined.link.send(sentence_bytes, receiver_baud, false);
        joined.link.send(sentence_bytes, receiver_baud, true);
        EXPECT_EQ(to_string(joined.wire->written()), to_string(sentence_bytes) + to_string(sentence_bytes));
        EXPECT_EQ(joined.link.counters().bytes_out, 2 * sentence_bytes.size());
        EXPECT_EQ(joined.link.counters().bytes_garbled, 0U);
        EXPECT_EQ(joined.link.counters().bytes_lost, 0U);
        EXPECT_TRUE(joined.link.connected());
    }
}

TEST(Link, AnotherSpeedGarbles) {
    JoinedLink joined = joined_link(38400);
    joined.link.send(sentence_bytes, receiver_baud, true);
    const LinkCounters& counters = joined.link.counters();
    EXPECT_GT(joined.wire->written().size(), 0U);
    EXPECT_NE(joined.wire->written(), sentence_bytes);
    EXPECT_EQ(counters.bytes_garbled, joined.wire->written().size());
    EXPECT_EQ(counters.bytes_out, joined.wire->written().size());

    // The client finds the right speed: from the next sentence on it hears.
    joined.wire->set_line({true, receiver_baud});
    const std::size_t before = joined.wire->written().size();
    joined.link.send(sentence_bytes, receiver_baud, true);
    const Bytes after(joined.wire->written().begin() + static_cast<std::ptrdiff_t>(before),
                      joined.wire->written().end());
    EXPECT_EQ(after, sentence_bytes);
    EXPECT_EQ(joined.link.counters().bytes_garbled, before);
}

TEST(Link, WhatNobodyHearsIsCountedAndGone) {
    JoinedLink joined = joined_link(std::nullopt, false);
    joined.link.send(sentence_bytes, receiver_baud, true);
    EXPECT_TRUE(joined.wire->written().empty());
    EXPECT_EQ(joined.link.counters().bytes_unheard, sentence_bytes.size());
    EXPECT_EQ(joined.link.counters().bytes_out, 0U);
    EXPECT_FALSE(joined.link.connected());
    joined.wire->set_line({true, std::nullopt});
    joined.link.send(to_bytes("now"), receiver_baud, true);
    EXPECT_EQ(to_string(joined.wire->written()), "now") << "nothing of before is kept for a late client";
    EXPECT_EQ(joined.link.counters().bytes_unheard, sentence_bytes.size());
}

struct PluggableWire : MemoryTransport {
    void set_plugged(bool plugged) override { seen.push_back(plugged); }
    std::vector<bool> seen;
};

TEST(Link, AWireSeesItsPlugPulledOnce) {
    auto transport = std::make_unique<PluggableWire>();
    const PluggableWire& wire = *transport;
    Link link(std::move(transport), receiver_baud);
    for (const bool plugged : {true, false, false, true, true})
        link.set_plugged(plugged);
    EXPECT_EQ(wire.seen, (std::vector<bool>{false, true}));
}

TEST(Link, ASlowClientLosesBytes) {
    JoinedLink joined = joined_link(std::nullopt);
    joined.wire->set_room(10);
    joined.link.send(sentence_bytes, receiver_baud, true);
    EXPECT_EQ(to_string(joined.wire->written()), "$GPRMC,120");
    EXPECT_EQ(joined.link.counters().bytes_out, 10U);
    EXPECT_EQ(joined.link.counters().bytes_lost, sentence_bytes.size() - 10);
}

TEST(Link, BytesOfTheClientReachTheReceiver) {
    JoinedLink joined = joined_link(receiver_baud);
    EXPECT_TRUE(all_heard(joined.link, receiver_baud).empty());
    joined.wire->feed(sentence_bytes);
    EXPECT_EQ(all_heard(joined.link, receiver_baud), sentence_bytes);
    EXPECT_EQ(joined.link.counters().bytes_in, sentence_bytes.size());
    EXPECT_TRUE(all_heard(joined.link, receiver_baud).empty());
}

TEST(Link, BytesOfAClientAtAnotherSpeedReachTheReceiverGarbled) {
    JoinedLink joined = joined_link(4800);
    joined.wire->feed(sentence_bytes);
    Bytes heard = all_heard(joined.link, receiver_baud);
    const Bytes rest = all_heard(joined.link, receiver_baud);
    heard.insert(heard.end(), rest.begin(), rest.end());
    EXPECT_GT(heard.size(), sentence_bytes.size()) << "twice as many bits fit into the time";
    EXPECT_EQ(to_string(heard).find("GPRMC"), std::string::npos);
    EXPECT_EQ(joined.link.counters().bytes_in, heard.size());
}

TEST(Link, AWriteTakesTheTimeOfItsBits) {
    for (const std::optional<std::uint32_t> client : {std::optional<std::uint32_t>(), std::optional(receiver_baud)}) {
        JoinedLink joined = paced_link(receiver_baud, client);
        const GpsTime start = to_gps_time(2400, 0);
        joined.wire->feed(Bytes(96, 0x55));
        EXPECT_TRUE(all_heard(joined.link, receiver_baud, start).empty());
        EXPECT_TRUE(joined.link.input_pending());
        std::size_t heard = 0;
        for (const int ms : {1, 2, 3, 50, 99, 100, 101}) {
            heard += all_heard(joined.link, receiver_baud, start + ms * 1ms).size();
            EXPECT_EQ(heard, std::min<std::size_t>(96, static_cast<std::size_t>(ms * 1e6 / 1'041'667))) << ms << " ms";
        }
        EXPECT_EQ(heard, 96U) << "96 bytes of ten bits are a tenth of a second";
        EXPECT_FALSE(joined.link.input_pending());
    }
}

TEST(Link, HowOftenOneLooksMakesNoDifference) {
    JoinedLink often = paced_link(receiver_baud, receiver_baud), once = paced_link(receiver_baud, receiver_baud);
    const GpsTime start = to_gps_time(2400, 0);
    for (JoinedLink* joined : {&often, &once}) {
        joined->wire->feed(Bytes(500, 1));
        joined->link.look(start);
    }
    std::size_t heard = 0;
    for (Nanoseconds t = 0ns; t <= 300ms; t += 700us)
        heard += all_heard(often.link, receiver_baud, start + t).size();
    heard += all_heard(often.link, receiver_baud, start + 300ms).size();
    EXPECT_EQ(heard, all_heard(once.link, receiver_baud, start + 300ms).size());
    EXPECT_EQ(heard, 287U);
}

// Steps from arrival to arrival, as a loop in simulated time does.
std::vector<Nanoseconds> arrivals(Link& link, GpsTime start) {
    std::vector<Nanoseconds> times;
    link.look(start);
    for (auto next = link.next_arrival(receiver_baud); next; next = link.next_arrival(receiver_baud)) {
        times.push_back(*next - start);
        link.look(*next);
        while (link.receive(receiver_baud, *next)) {
        }
    }
    return times;
}

TEST(Link, TellsWhenTheNextByteArrives) {
    const GpsTime start = to_gps_time(2400, 0);
    JoinedLink same = paced_link(receiver_baud, receiver_baud);
    same.wire->feed(to_bytes("abc"));
    EXPECT_EQ(arrivals(same.link, start), (std::vector<Nanoseconds>{1'041'667ns, 2 * 1'041'667ns, 3 * 1'041'667ns}));
    EXPECT_EQ(same.link.counters().bytes_in, 3U);
    // At half the speed; what the receiver still waits for after the last byte ends when the line has rested for one
    // more.
    JoinedLink slow = paced_link(receiver_baud, 4800);
    slow.wire->feed(to_bytes("ab"));
    const std::vector<Nanoseconds> times = arrivals(slow.link, start);
    ASSERT_GE(times.size(), 2U);
    EXPECT_EQ(times[1], 2 * 2'083'334ns);
    EXPECT_LE(times.back(), 3 * 2'083'334ns);
    EXPECT_EQ(joined_link(receiver_baud).link.next_arrival(receiver_baud), std::nullopt);
}

TEST(Link, ASpeedChangeInTheMiddleOfAWriteActsOnTheNextByte) {
    for (const InputPace pace : {InputPace::line, InputPace::at_once}) {
        auto transport = std::make_unique<MemoryTransport>();
        transport->set_line({true, receiver_baud});
        transport->feed(to_bytes("$PUBX,41*00\r\nthis comes too early"));
        Link link(std::move(transport), receiver_baud, pace);
        const GpsTime start = to_gps_time(2400, 0);
        link.look(start);
        std::uint32_t baud = receiver_baud;
        Bytes all;
        while (const auto heard = link.receive(baud, start + 1s)) {
            all.insert(all.end(), heard->begin(), heard->end());
            if (!all.empty() && all.back() == '\n') baud = 38400;
        }
        EXPECT_EQ(to_string(all).substr(0, 13), "$PUBX,41*00\r\n");
        EXPECT_GT(all.size(), 13U);
        EXPECT_EQ(to_string(all).find('t', 13), std::string::npos) << "not a letter of it is understood";
    }
}

TEST(Link, BytesThatWereReadKeepTheirSpeedWhenTheClientChangesItsOwn) {
    JoinedLink joined = paced_link(receiver_baud, receiver_baud);
    const GpsTime start = to_gps_time(2400, 0);
    joined.wire->feed(to_bytes("slow"));
    joined.link.look(start);
    joined.wire->set_line({true, 115200});
    joined.wire->feed(to_bytes("quick"));
    EXPECT_EQ(to_string(all_heard(joined.link, receiver_baud, start + 4 * 1'041'667ns)), "slow");
    EXPECT_EQ(to_string(all_heard(joined.link, 115200, start + 4 * 1'041'667ns + 5 * 86'806ns)), "quick")
        << "five bytes more at twelve times the speed";
}

TEST(Link, AClientThatWritesWithoutEndHasToWait) {
    JoinedLink joined = paced_link(receiver_baud, receiver_baud);
    joined.wire->feed(Bytes(5000, 1));
    joined.link.look({});
    joined.wire->feed(to_bytes("later"));
    joined.link.look({});
    EXPECT_EQ(to_string(joined.wire->read()), "later") << "left in the driver";
}

TEST(Link, APortWithoutASpeedHearsEverySpeed) {
    JoinedLink joined = paced_link(std::nullopt, 4800);
    EXPECT_EQ(joined.wire->receiver_baud(), 0U) << "none is told";
    const GpsTime start = to_gps_time(2400, 0);
    joined.wire->feed(Bytes(3000, 7));
    EXPECT_TRUE(all_heard(joined.link, std::nullopt, start).empty());
    EXPECT_EQ(all_heard(joined.link, std::nullopt, start + 1ms).size(), 1499U) << "12 Mbit/s";
    EXPECT_EQ(all_heard(joined.link, std::nullopt, start + 3ms), Bytes(1501, 7));
    joined.link.send(sentence_bytes, std::nullopt, true);
    EXPECT_EQ(joined.wire->written(), sentence_bytes);
    EXPECT_EQ(joined.link.counters().bytes_garbled, 0U);
}

}  // namespace
}  // namespace skyloop
