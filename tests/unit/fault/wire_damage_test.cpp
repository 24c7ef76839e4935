#include "run/fault/wire_damage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "base/core/random.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "wire_stream.hpp"

namespace skyloop {
namespace {

using test::append_bytes;
using test::heard_stream;
using test::wire_message;
using test::wire_messages;
using test::wire_start;
using test::wire_time;

WireDirection damaged_direction(const std::function<void(WireDirection&)>& how) {
    WireDirection direction;
    how(direction);
    return direction;
}

// One field of WireDirection each.
std::vector<WireDirection> single_damages() {
    return {damaged_direction([](WireDirection& d) { d.byte_loss = 0.1; }),
            damaged_direction([](WireDirection& d) { d.bit_errors = 0.02; }),
            damaged_direction([](WireDirection& d) { d.checksum_errors = 0.4; }),
            damaged_direction([](WireDirection& d) { d.truncation = 0.4; }),
            damaged_direction([](WireDirection& d) { d.merging = 0.4; }),
            damaged_direction([](WireDirection& d) { d.duplication = 0.4; }),
            damaged_direction([](WireDirection& d) { d.reordering = 0.4; }),
            damaged_direction([](WireDirection& d) {
                d.garbage = {{5, 11}};
            }),
            damaged_direction([](WireDirection& d) { d.delay = Seconds(0.73); }),
            damaged_direction([](WireDirection& d) { d.jitter = Seconds(0.2); }),
            damaged_direction([](WireDirection& d) { d.stalled = true; }),
            damaged_direction([](WireDirection& d) { d.bytes_per_s = 333; }),
            damaged_direction([](WireDirection& d) { d.dead = true; })};
}

WireDirection everything_wrong() {
    WireDirection all;
    all.byte_loss = 0.01;
    all.bit_errors = 0.002;
    all.checksum_errors = all.truncation = all.merging = all.duplication = all.reordering = 0.2;
    all.garbage = {{4, 7}};
    all.delay = Seconds(0.05);
    all.jitter = Seconds(0.03);
    all.bytes_per_s = 700;
    return all;
}

// All that comes out of `stream`, put in at once and given ten seconds.
Bytes passed_through(const WireDirection& direction, const Bytes& stream, std::uint64_t seed = 1) {
    WireDamage wire(seed, "wire");
    wire.set(direction, wire_start);
    wire.put(stream, wire_start);
    return wire.take(wire_time(10));
}

TEST(WireDamage, PassesASoundStreamAtOnce) {
    WireDamage wire(1, "wire");
    EXPECT_FALSE(wire.next_at());
    const Bytes stream = wire_messages(10);
    wire.put(stream, wire_start);
    EXPECT_EQ(wire.waiting(), stream.size());
    EXPECT_EQ(wire.next_at(), wire_start);
    EXPECT_EQ(wire.take(wire_start), stream);
    EXPECT_EQ(wire.waiting(), 0U);
    EXPECT_FALSE(wire.next_at());
    EXPECT_EQ(wire.counts(), WireDamageCounts{});
}

TEST(WireDamage, LosesEverythingOnADeadWire) {
    WireDamage wire(1, "wire");
    WireDirection slow;
    slow.delay = Seconds(1);
    wire.set(slow, wire_start);
    wire.put(wire_messages(3), wire_start);
    WireDirection dead = slow;
    dead.dead = true;
    wire.set(dead, wire_time(0.5));  // what is on its way is lost too
    wire.put(wire_messages(4), wire_time(0.6));
    EXPECT_TRUE(wire.take(wire_time(5)).empty());
    EXPECT_EQ(wire.waiting(), 0U);
    EXPECT_EQ(wire.counts().bytes_lost, wire_messages(3).size() + wire_messages(4).size());
}

TEST(WireDamage, LosesTheGivenShareOfBytes) {
    const Bytes stream = wire_messages(1000);
    const Bytes heard = passed_through(damaged_direction([](WireDirection& d) { d.byte_loss = 0.1; }), stream);
    const double share = 1 - static_cast<double>(heard.size()) / static_cast<double>(stream.size());
    EXPECT_NEAR(share, 0.1, 0.01);  // 6 sigma of 37 000 bytes
}

TEST(WireDamage, TurnsTheGivenShareOfBits) {
    const Bytes stream(20'000, 0x55);
    const Bytes heard = passed_through(damaged_direction([](WireDirection& d) { d.bit_errors = 0.05; }), stream);
    ASSERT_EQ(heard.size(), stream.size());
    std::size_t turned = 0;
    for (const std::uint8_t byte : heard)
        turned += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(byte ^ 0x55U)));
    EXPECT_NEAR(static_cast<double>(turned) / 160'000, 0.05, 0.004);
}

TEST(WireDamage, SpoilsChecksumsAndNothingElse) {
    const int count = 1000;
    const Bytes stream = wire_messages(count);
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.checksum_errors = 0.3; }), wire_start);
    wire.put(stream, wire_start);
    const Bytes heard = wire.take(wire_time(1));
    ASSERT_EQ(heard.size(), stream.size());
    int different_bits = 0;
    for (std::size_t i = 0; i < heard.size(); ++i)
        different_bits += std::popcount(static_cast<unsigned>(heard[i] ^ stream[i]));
    const auto client = heard_stream(heard);
    const auto spoilt = static_cast<int>(wire.counts().messages_changed);
    EXPECT_NEAR(spoilt, 300, 75);
    EXPECT_EQ(different_bits, spoilt);
    EXPECT_EQ(static_cast<int>(client.messages.size()), count - spoilt);
    EXPECT_GT(client.counts.bad[static_cast<std::size_t>(StreamKind::ubx)], 100U);
    EXPECT_GT(client.counts.bad[static_cast<std::size_t>(StreamKind::nmea)], 100U);
}

// Frames of MSP and MAVLink in both versions, one of them signed.
std::vector<Bytes> autopilot_frames() {
    Bytes signed_frame = encode_mavlink({}, MavlinkGpsInput{});
    signed_frame[2] = 1;  // MAVLINK_IFLAG_SIGNED
    signed_frame.resize(signed_frame.size() - mavlink_crc_size);
    const std::uint8_t extra = MavlinkGpsInput::crc_extra;
    const std::uint16_t crc = crc16_x25({&extra, 1}, crc16_x25(ByteSpan(signed_frame).subspan(1)));
    signed_frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    signed_frame.push_back(static_cast<std::uint8_t>(crc >> 8));
    signed_frame.resize(signed_frame.size() + mavlink_signature_size, 0x5A);
    return {encode_mavlink({}, MavlinkGpsInput{}), encode_mavlink_v1({}, 0, encode_payload(MavlinkHeartbeat{})),
            std::move(signed_frame), encode_msp(MspSensorGps{}), encode_msp(MspSetRawGps{})};
}

StreamCounts autopilot_counts(ByteSpan stream) {
    StreamSplitter splitter(StreamProtocols{false, false, false, true, true, false});
    splitter.feed(stream);
    splitter.finish();
    return splitter.counts();
}

TEST(WireDamage, SpoilsTheChecksumsOfMspAndMavlink) {
    const std::vector<Bytes> frames = autopilot_frames();
    for (const Bytes& frame : frames) {
        const StreamCounts whole = autopilot_counts(frame);
        EXPECT_EQ(whole.skipped, 0U);
        for (std::uint64_t seed = 1; seed <= 200; ++seed) {
            const Bytes heard =
                passed_through(damaged_direction([](WireDirection& d) { d.checksum_errors = 1; }), frame, seed);
            ASSERT_EQ(heard.size(), frame.size());
            const StreamCounts counts = autopilot_counts(heard);
            const auto of = static_cast<std::size_t>(frame[0] == '$' ? StreamKind::msp : StreamKind::mavlink);
            EXPECT_EQ(counts.frames[of], 0U) << "seed " << seed;
            EXPECT_GE(counts.bad[of], 1U) << "seed " << seed;  // the frame stands
        }
    }
}

TEST(WireDamage, DamagesMessagesOfMspAndMavlinkAsTheyCome) {
    for (const Bytes& frame : autopilot_frames()) {
        WireDamage wire(1, "wire");
        wire.set(damaged_direction([](WireDirection& d) { d.duplication = 1; }), wire_start);
        wire.put(frame, wire_start);
        Bytes twice = frame;
        append_bytes(twice, frame);
        EXPECT_EQ(wire.take(wire_start), twice);  // a message is not held until others follow
        wire.set(damaged_direction([](WireDirection& d) { d.truncation = 1; }), wire_start);
        wire.put(frame, wire_start);
        EXPECT_LT(wire.take(wire_start).size(), frame.size());
    }
}

TEST(WireDamage, CutsTheEndsOfMessages) {
    const Bytes stream = wire_messages(400);
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.truncation = 0.25; }), wire_start);
    wire.put(stream, wire_start);
    const Bytes heard = wire.take(wire_time(1));
    const std::uint64_t cut = wire.counts().messages_changed;
    EXPECT_NEAR(static_cast<double>(cut), 100, 45);
    EXPECT_EQ(heard.size() + wire.counts().bytes_lost, stream.size());
    // A cut message may swallow a whole one that follows it; it never makes one.
    const auto whole = heard_stream(heard).messages.size();
    EXPECT_LE(whole, 400 - cut);
    EXPECT_GT(whole, 150U);
}

TEST(WireDamage, MergesAMessageWithTheNextOne) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.merging = 1; }), wire_start);
    wire.put(wire_message(0), wire_start);
    const Bytes first = wire.take(wire_start);
    wire.set(damaged_direction([](WireDirection& d) { d.merging = 1e-12; }), wire_time(0.1));
    wire.put(wire_message(2), wire_time(0.1));
    wire.put(wire_message(4), wire_time(0.1));
    const Bytes rest = wire.take(wire_time(0.1));

    const Bytes whole = wire_message(0), next = wire_message(2), last = wire_message(4);
    ASSERT_GT(first.size(), 0U);
    ASSERT_LT(first.size(), whole.size());
    EXPECT_TRUE(std::equal(first.begin(), first.end(), whole.begin()));
    ASSERT_GT(rest.size(), last.size());
    ASSERT_LT(rest.size(), next.size() + last.size());
    Bytes expected = next;
    append_bytes(expected, last);
    EXPECT_TRUE(std::equal(rest.rbegin(), rest.rend(), expected.rbegin()));
}

TEST(WireDamage, SparesTheNextMessageWhenMergingHasEnded) {
    for (const WireDirection& between : {WireDirection{}, damaged_direction([](WireDirection& d) { d.dead = true; })}) {
        WireDamage wire(1, "wire");
        wire.set(damaged_direction([](WireDirection& d) { d.merging = 1; }), wire_start);
        wire.put(wire_message(0), wire_start);
        EXPECT_LT(wire.take(wire_start).size(), wire_message(0).size());
        wire.set(between, wire_time(0.1));
        wire.set(damaged_direction([](WireDirection& d) { d.merging = 1e-12; }), wire_time(0.2));
        wire.put(wire_message(2), wire_time(0.2));
        EXPECT_EQ(wire.take(wire_time(0.2)), wire_message(2));
    }
}

TEST(WireDamage, SendsMessagesTwice) {
    Bytes expected;
    for (int i = 0; i < 6; ++i) {
        append_bytes(expected, wire_message(i));
        append_bytes(expected, wire_message(i));
    }
    EXPECT_EQ(passed_through(damaged_direction([](WireDirection& d) { d.duplication = 1; }), wire_messages(6)),
              expected);
}

TEST(WireDamage, SendsAMessageAfterTheNextOne) {
    Bytes expected;
    for (const int i : {1, 0, 3, 2, 5, 4})
        append_bytes(expected, wire_message(i));
    const auto always = damaged_direction([](WireDirection& d) { d.reordering = 1; });
    EXPECT_EQ(passed_through(always, wire_messages(6)), expected);

    // A message that finds no next one comes all the same.
    WireDamage wire(1, "wire");
    wire.set(always, wire_start);
    wire.put(wire_message(0), wire_start);
    EXPECT_TRUE(wire.take(wire_time(1.999)).empty());
    EXPECT_EQ(wire.next_at(), wire_time(2));
    EXPECT_EQ(wire.take(wire_time(2)), wire_message(0));
}

TEST(WireDamage, PutsGarbageBetweenMessagesOnly) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.garbage = {{4, 5}}; }), wire_start);
    // Each message takes 60 ms of every 100 ms, in two halves.
    Bytes heard;
    for (int i = 0; i < 1000; ++i) {
        const Bytes message = wire_message(i);
        wire.put(ByteSpan(message).first(9), wire_time(0.1 * i));
        append_bytes(heard, wire.take(wire_time(0.1 * i + 0.03)));
        wire.put(ByteSpan(message).subspan(9), wire_time(0.1 * i + 0.06));
        append_bytes(heard, wire.take(wire_time(0.1 * i + 0.06)));
    }
    const WireDamageCounts counts = wire.counts();
    EXPECT_NEAR(static_cast<double>(counts.garbage_bursts), 400, 120);  // 6 sigma
    EXPECT_EQ(counts.bytes_inserted, 5 * counts.garbage_bursts);
    EXPECT_EQ(heard.size(), wire_messages(1000).size() + counts.bytes_inserted);
    std::size_t found = 0, from = 0;
    for (int i = 0; i < 1000; ++i) {
        const Bytes message = wire_message(i);
        const auto at =
            std::search(heard.begin() + static_cast<std::ptrdiff_t>(from), heard.end(), message.begin(), message.end());
        if (at == heard.end()) continue;
        ++found;
        from = static_cast<std::size_t>(at - heard.begin()) + message.size();
    }
    EXPECT_EQ(found, 1000U);
}

TEST(WireDamage, EachSourceOfGarbageHasBurstsOfItsOwnLength) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.garbage = {{3, 4}, {1, 40}}; }), wire_start);
    std::map<std::size_t, int> bursts;  // by length
    for (auto next = wire.next_at(); next && *next < wire_time(500); next = wire.next_at())
        ++bursts[wire.take(*next).size()];
    EXPECT_EQ(bursts.size(), 2U);
    EXPECT_NEAR(bursts[4], 1500, 240);  // 6 sigma
    EXPECT_NEAR(bursts[40], 500, 135);
}

TEST(WireDamage, DelaysEveryByte) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.delay = Seconds(0.25); }), wire_start);
    wire.put(to_bytes("ab"), wire_start);
    wire.put(to_bytes("c"), wire_time(0.1));
    EXPECT_TRUE(wire.take(wire_time(0.2499)).empty());
    EXPECT_EQ(wire.next_at(), wire_time(0.25));
    EXPECT_EQ(wire.take(wire_time(0.25)), to_bytes("ab"));
    EXPECT_EQ(wire.waiting(), 1U);
    EXPECT_EQ(wire.take(wire_time(0.35)), to_bytes("c"));
}

TEST(WireDamage, NeverOvertakesWhenTheDelayShrinks) {
    WireDamage wire(1, "wire");
    const auto delayed = [](double seconds) {
        return damaged_direction([&](WireDirection& d) { d.delay = Seconds(seconds); });
    };
    wire.set(delayed(1), wire_start);
    wire.put(to_bytes("a"), wire_start);
    wire.set(delayed(0.1), wire_time(0.1));
    wire.put(to_bytes("b"), wire_time(0.2));
    EXPECT_TRUE(wire.take(wire_time(0.9)).empty());
    EXPECT_EQ(wire.take(wire_time(1)), to_bytes("ab"));
    wire.put(to_bytes("c"), wire_time(1));
    wire.set({}, wire_time(1.01));
    EXPECT_EQ(wire.take(wire_time(1.01)), to_bytes("c"));
}

TEST(WireDamage, JittersMessagesInOrder) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) {
                 d.delay = Seconds(1);
                 d.jitter = Seconds(0.1);
             }),
             wire_start);
    const Bytes stream = wire_messages(300);
    Bytes heard;
    std::vector<double> delays;
    for (int i = 0; i < 300; ++i) {
        wire.put(wire_message(i), wire_time(2.0 * i));
        ASSERT_TRUE(wire.next_at());
        const GpsTime at = *wire.next_at();
        append_bytes(heard, wire.take(at));
        delays.push_back(difference(at, wire_time(2.0 * i)).value());
    }
    EXPECT_EQ(heard, stream);
    double sum = 0, squares = 0;
    for (const double delay : delays) {
        sum += delay;
        squares += (delay - 1) * (delay - 1);
    }
    EXPECT_NEAR(sum / 300, 1, 0.03);
    EXPECT_NEAR(std::sqrt(squares / 300), 0.1, 0.025);
}

TEST(WireDamage, SendsWhatItKeptInOneBurst) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.stalled = true; }), wire_start);
    Bytes sent;
    for (int i = 0; i < 20; ++i) {
        wire.put(wire_message(i), wire_time(0.1 * i));
        append_bytes(sent, wire_message(i));
        EXPECT_TRUE(wire.take(wire_time(0.1 * i)).empty());
    }
    EXPECT_FALSE(wire.next_at());
    EXPECT_EQ(wire.waiting(), sent.size());
    wire.set({}, wire_time(3));
    EXPECT_EQ(wire.next_at(), wire_time(3));
    EXPECT_EQ(wire.take(wire_time(3)), sent);
}

TEST(WireDamage, LagsBehindALimitedThroughput) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.bytes_per_s = 100; }), wire_start);
    std::size_t heard = 0;
    for (int second = 0; second < 10; ++second) {  // 150 bytes each second
        wire.put(Bytes(150, 7), wire_time(second));
        EXPECT_EQ(wire.next_at(), wire_time(second + 0.01));
        heard += wire.take(wire_time(second + 0.505)).size();
        EXPECT_EQ(heard, static_cast<std::size_t>(second) * 100 + 50);
        heard += wire.take(wire_time(second + 1)).size();
        EXPECT_EQ(wire.waiting(), static_cast<std::size_t>(second + 1) * 50);
    }
    wire.set({}, wire_time(10));
    EXPECT_EQ(heard + wire.take(wire_time(10)).size(), 1500U);
    EXPECT_EQ(wire.counts(), WireDamageCounts{});
}

TEST(WireDamage, KeepsItsPaceWhileTheLimitChanges) {
    WireDamage wire(1, "wire");
    const auto limited = [](double rate) { return damaged_direction([&](WireDirection& d) { d.bytes_per_s = rate; }); };
    wire.set(limited(10), wire_start);
    wire.put(Bytes(1000, 1), wire_start);
    // A ramp that is looked at a hundred times during each byte: from 10 to 20 bytes/s in ten seconds, 150 bytes.
    std::size_t heard = 0;
    for (int i = 1; i <= 10'000; ++i) {
        wire.set(limited(10 + 0.001 * i), wire_time(0.001 * i));
        heard += wire.take(wire_time(0.001 * i)).size();
    }
    EXPECT_NEAR(static_cast<double>(heard), 150, 1.01);
}

TEST(WireDamage, LosesTheNewestWhenTooMuchWaits) {
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.stalled = true; }), wire_start);
    wire.put(Bytes(600'000, 1), wire_start);
    wire.put(Bytes(600'000, 2), wire_start);
    EXPECT_EQ(wire.waiting(), WireDamage::capacity);
    EXPECT_EQ(wire.counts().bytes_overrun, 200'000U);
    wire.set({}, wire_time(1));
    const Bytes heard = wire.take(wire_time(1));
    ASSERT_EQ(heard.size(), WireDamage::capacity);
    EXPECT_EQ(std::count(heard.begin(), heard.end(), std::uint8_t{1}), 600'000);
    // Bytes that need not wait are never too many.
    wire.set(damaged_direction([](WireDirection& d) { d.byte_loss = 1e-15; }), wire_time(2));
    wire.put(Bytes(2'000'000, 3), wire_time(2));
    EXPECT_EQ(wire.take(wire_time(2)).size(), 2'000'000U);
}

TEST(WireDamage, DoesNotKeepAnUnfinishedMessageForLong) {
    for (const Bytes& beginning : {to_bytes("$GNGGA,12"), Bytes{0xB5, 0x62, 0x01, 0x07, 0xFF, 0x1F, 1, 2}, Bytes{7}}) {
        WireDamage wire(1, "wire");
        wire.set(damaged_direction([](WireDirection& d) { d.truncation = 1; }), wire_start);
        wire.put(beginning, wire_start);
        EXPECT_TRUE(wire.take(wire_time(0.0999)).empty());
        EXPECT_EQ(wire.next_at(), wire_time(0.1));
        EXPECT_EQ(wire.take(wire_time(0.1)), beginning);
    }
    // Nor one that never ends.
    WireDamage wire(1, "wire");
    wire.set(damaged_direction([](WireDirection& d) { d.truncation = 1; }), wire_start);
    wire.put(Bytes{0xB5, 0x62, 0x01, 0x07, 0xFF, 0x1F}, wire_start);
    for (int i = 1; i < 20; ++i)
        wire.put(Bytes{1}, wire_time(0.05 * i));
    EXPECT_TRUE(wire.take(wire_time(0.999)).empty());
    EXPECT_EQ(wire.take(wire_time(1)).size(), 25U);
}

TEST(WireDamage, LeavesNoResidue) {
    std::vector<WireDirection> all = single_damages();
    all.push_back(everything_wrong());
    for (std::size_t which = 0; which < all.size(); ++which) {
        SCOPED_TRACE(which);
        WireDamage wire(3, "wire");
        Bytes before;
        wire.set(all[which], wire_start);
        std::size_t sent = 0;
        for (int i = 0; i < 100; ++i) {
            // The last message is cut in two by the end of the fault.
            const Bytes message = wire_message(i);
            const Bytes now(message.begin(), message.begin() + (i < 99 ? std::ssize(message) : 12));
            wire.put(now, wire_time(0.05 * i));
            sent += now.size();
            if (i % 3 == 0) append_bytes(before, wire.take(wire_time(0.05 * i + 0.01)));
        }
        wire.set({}, wire_time(4.96));
        append_bytes(before, wire.take(wire_time(4.96)));
        EXPECT_EQ(wire.waiting(), 0U);
        const WireDamageCounts counts = wire.counts();
        EXPECT_EQ(before.size() + counts.bytes_lost + counts.bytes_overrun, sent + counts.bytes_inserted);
        const Bytes last = wire_message(99), rest(last.begin() + 12, last.end());
        for (int i = 0; i < 20; ++i) {
            const Bytes message = i == 0 ? rest : wire_message(i);
            wire.put(message, wire_time(5 + i));
            EXPECT_EQ(wire.take(wire_time(5 + i)), message);
            EXPECT_EQ(wire.waiting(), 0U);
            EXPECT_FALSE(wire.next_at());
        }
        EXPECT_EQ(wire.counts(), counts);
    }
}

struct TimedPut {
    int at_ms = 0;
    Bytes bytes;
};

// What has come out by each tenth of a second. Conditions change at whole seconds.
std::vector<Bytes> heard_by_tenths(const std::vector<WireDirection>& conditions, const std::vector<TimedPut>& puts,
                                   RandomStream* cuts) {
    WireDamage wire(5, "wire");
    Bytes heard;
    std::vector<Bytes> by_tenths;
    std::size_t next_put = 0;
    for (int ms = 0; ms < 6000; ++ms) {
        const GpsTime now = wire_time(0.001 * ms);
        if (ms % 1000 == 0) wire.set(conditions[static_cast<std::size_t>(ms / 1000) % conditions.size()], now);
        for (; next_put < puts.size() && puts[next_put].at_ms == ms; ++next_put) {
            ByteSpan left(puts[next_put].bytes);
            while (cuts != nullptr && left.size() > 1) {
                const auto part = 1 + static_cast<std::size_t>(cuts->uniform() * static_cast<double>(left.size() - 1));
                wire.put(left.first(part), now);
                left = left.subspan(part);
                if (cuts->uniform() < 0.5) append_bytes(heard, wire.take(now));
            }
            wire.put(left, now);
        }
        if (cuts != nullptr && cuts->uniform() < 0.3) append_bytes(heard, wire.take(now));
        if (ms % 100 != 0) continue;
        append_bytes(heard, wire.take(now));
        by_tenths.push_back(heard);
    }
    return by_tenths;
}

// What is drawn depends on bytes and times only.
TEST(WireDamage, DoesNotDependOnCutsAndLooks) {
    RandomStream random(9, "test");
    std::vector<TimedPut> puts;
    const Bytes stream = wire_messages(200);
    for (std::size_t at = 0; at < stream.size();) {
        const auto size = std::min(stream.size() - at, static_cast<std::size_t>(1 + random.uniform() * 120));
        const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(at);
        puts.push_back(
            {static_cast<int>(random.uniform() * 5500), Bytes(begin, begin + static_cast<std::ptrdiff_t>(size))});
        at += size;
    }
    // Sorting by time alone would shuffle the messages: the bytes stay, the times are sorted.
    std::vector<int> times;
    for (const TimedPut& put : puts)
        times.push_back(put.at_ms);
    std::sort(times.begin(), times.end());
    for (std::size_t i = 0; i < puts.size(); ++i)
        puts[i].at_ms = times[i];

    std::vector<std::vector<WireDirection>> all{
        {everything_wrong()}, {{}, everything_wrong()}, {everything_wrong(), {}}};
    for (const WireDirection& single : single_damages())
        all.push_back({single, {}, everything_wrong(), single});
    for (std::size_t which = 0; which < all.size(); ++which) {
        SCOPED_TRACE(which);
        const auto expected = heard_by_tenths(all[which], puts, nullptr);
        EXPECT_GT(expected.back().size(), stream.size() / 8);
        for (int trial = 0; trial < 4; ++trial)
            ASSERT_TRUE(heard_by_tenths(all[which], puts, &random) == expected) << "trial " << trial;
    }
}

TEST(WireDamage, DrawsByItsSeedAndName) {
    const Bytes stream = wire_messages(200);
    EXPECT_EQ(passed_through(everything_wrong(), stream, 4), passed_through(everything_wrong(), stream, 4));
    EXPECT_NE(passed_through(everything_wrong(), stream, 4), passed_through(everything_wrong(), stream, 5));
    WireDamage other(4, "other");
    other.set(everything_wrong(), wire_start);
    other.put(stream, wire_start);
    EXPECT_NE(other.take(wire_time(10)), passed_through(everything_wrong(), stream, 4));
}

TEST(WireDamage, TakesNonsenseAsNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const Bytes stream = wire_messages(50);
    for (const double nonsense : {nan, -1.0, -infinite}) {
        WireDirection direction;
        direction.byte_loss = direction.bit_errors = direction.checksum_errors = direction.truncation = nonsense;
        direction.merging = direction.duplication = direction.reordering = nonsense;
        direction.garbage = {{nonsense, -5}, {nonsense, 5}, {4, -5}};
        direction.delay = direction.jitter = Seconds(nonsense);
        EXPECT_EQ(passed_through(direction, stream), stream);
    }
    EXPECT_EQ(passed_through(damaged_direction([&](WireDirection& d) { d.bytes_per_s = infinite; }), stream), stream);
    EXPECT_EQ(passed_through(damaged_direction([&](WireDirection& d) { d.bytes_per_s = nan; }), stream), stream);
    EXPECT_TRUE(passed_through(damaged_direction([](WireDirection& d) { d.bytes_per_s = 0; }), stream).empty());
}

}  // namespace
}  // namespace skyloop
