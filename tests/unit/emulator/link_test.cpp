#include "skyloop/emulator/link.hpp"

#include <gtest/gtest.h>

#include "skyloop/transport/memory.hpp"

namespace skyloop {
namespace {

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
    EXPECT_TRUE(joined.link.receive(receiver_baud).empty());
    joined.wire->feed(sentence_bytes);
    EXPECT_EQ(joined.link.receive(receiver_baud), sentence_bytes);
    EXPECT_EQ(joined.link.counters().bytes_in, sentence_bytes.size());
    EXPECT_TRUE(joined.link.receive(receiver_baud).empty());
}

TEST(Link, BytesOfAClientAtAnotherSpeedReachTheReceiverGarbled) {
    JoinedLink joined = joined_link(4800);
    joined.wire->feed(sentence_bytes);
    Bytes heard = joined.link.receive(receiver_baud);
    const Bytes rest = joined.link.receive(receiver_baud);
    heard.insert(heard.end(), rest.begin(), rest.end());
    EXPECT_GT(heard.size(), sentence_bytes.size()) << "twice as many bits fit into the time";
    EXPECT_EQ(to_string(heard).find("GPRMC"), std::string::npos);
    EXPECT_EQ(joined.link.counters().bytes_in, heard.size());
}

}  // namespace
}  // namespace skyloop
