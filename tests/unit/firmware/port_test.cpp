#include "firmware/core/port.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/core/random.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr GpsTime port_start{Nanoseconds(1'000'000'000'000'000)};

TEST(Port, SendsEachByteInTenBits) {
    Port port(9600, 1000, 1000);
    ASSERT_TRUE(port.queue(to_bytes("abc"), port_start));
    // 10 / 9600 s = 1 041 666.67 ns
    EXPECT_TRUE(port.take(port_start + 1'041'666ns).empty());
    EXPECT_EQ(to_string(port.take(port_start + 1'041'667ns)), "a");
    EXPECT_EQ(port.pending(), 2U);
    EXPECT_EQ(to_string(port.take(port_start + 3'124'999ns)), "b");
    EXPECT_EQ(port.drained_at(), port_start + 3'125'000ns);
    EXPECT_EQ(to_string(port.take(port_start + 3'125'000ns)), "c");
    EXPECT_EQ(port.drained_at(), std::nullopt);
    EXPECT_EQ(port.pending(), 0U);
}

TEST(Port, LetsAMessageWaitForTheOneBefore) {
    Port port(10, 1000, 1000);  // a byte per second
    ASSERT_TRUE(port.queue(to_bytes("ab"), port_start + 1s));
    ASSERT_TRUE(port.queue(to_bytes("cd"), port_start + 1s));
    EXPECT_TRUE(port.take(port_start + 1999ms).empty());
    EXPECT_EQ(to_string(port.take(port_start + 4s)), "abc");
    ASSERT_TRUE(port.queue(to_bytes("e"), port_start + 100s));
    EXPECT_EQ(to_string(port.take(port_start + 100s)), "d");
    EXPECT_EQ(port.drained_at(), port_start + 101s);
    EXPECT_EQ(to_string(port.take(port_start + 101s)), "e");
}

TEST(Port, DropsWholeAnswersThatDoNotFit) {
    Port port(10, 5, 5);
    EXPECT_TRUE(port.queue(to_bytes("abc"), port_start));
    EXPECT_FALSE(port.queue(to_bytes("def"), port_start));
    EXPECT_TRUE(port.queue(to_bytes("gh"), port_start));
    EXPECT_FALSE(port.queue(to_bytes("i"), port_start));
    // By then one byte has left, whether or not somebody has taken it.
    EXPECT_TRUE(port.queue(to_bytes("j"), port_start + 1s));
    EXPECT_FALSE(port.queue(to_bytes("k"), port_start + 1s));
    EXPECT_EQ(to_string(port.take(port_start + 100s)), "abcghj");
    EXPECT_TRUE(port.queue({}, port_start + 100s));
    EXPECT_FALSE(port.queue(Bytes(6), port_start + 100s));
}

TEST(Port, GeneratesMessagesInTheirTurnWithoutAGap) {
    Port port(10, 9, 4);
    for (const char* message : {"abc", "d", "efg", "hi"})
        ASSERT_TRUE(port.queue_in_turn(to_bytes(message), port_start));
    EXPECT_EQ(port.pending(), 4U) << "the first two";
    EXPECT_EQ(port.drained_at(), port_start + 9s);
    EXPECT_EQ(to_string(port.take(port_start + 3s)), "abc");
    EXPECT_EQ(port.pending(), 4U) << "d, and efg since abc has left";
    EXPECT_EQ(to_string(port.take(port_start + 9s)), "defghi");
    // One that is longer than that waits until the buffer is empty; longer than the buffer, it never fits.
    ASSERT_TRUE(port.queue_in_turn(to_bytes("j"), port_start + 10s));
    ASSERT_TRUE(port.queue_in_turn(to_bytes("klmnopqrs"), port_start + 10s));
    EXPECT_EQ(port.pending(), 1U);
    EXPECT_EQ(to_string(port.take(port_start + 20s)), "jklmnopqrs");
    EXPECT_FALSE(port.queue_in_turn(Bytes(10), port_start + 20s));
}

TEST(Port, AnAnswerLeavesAfterWhatHasBeenGeneratedAndBeforeWhatHasNot) {
    Port port(10, 100, 4);
    for (const char* message : {"abc", "def", "ghi"})
        ASSERT_TRUE(port.queue_in_turn(to_bytes(message), port_start));
    ASSERT_TRUE(port.queue(to_bytes("!"), port_start + 2500ms));  // "def" is generated after 2 s
    EXPECT_EQ(port.drained_at(), port_start + 10s);
    EXPECT_EQ(to_string(port.take(port_start + 10s)), "abcdef!ghi");
}

TEST(Port, GivesUpTheTurnsOfAnEarlierTime) {
    Port port(10, 100, 4);
    for (const char* message : {"abc", "def", "ghi"})
        ASSERT_TRUE(port.queue_in_turn(to_bytes(message), port_start));
    EXPECT_EQ(port.give_up_turns(port_start), 0U) << "they are of this instant";
    EXPECT_EQ(port.give_up_turns(port_start + 2s), 1U);
    ASSERT_TRUE(port.queue_in_turn(to_bytes("ABC"), port_start + 2s));
    EXPECT_EQ(to_string(port.take(port_start + 100s)), "abcdefABC");
}

TEST(Port, AnotherSpeedIsThatOfAllThatHasNotLeft) {
    Port port(10, 100, 3);
    for (const char* message : {"abc", "def"})
        ASSERT_TRUE(port.queue_in_turn(to_bytes(message), port_start));
    EXPECT_EQ(port.between_bytes(port_start + 1500ms), port_start + 2s);
    EXPECT_EQ(to_string(port.take(port_start + 2s)), "ab");
    port.set_baud(20, port_start + 2s);
    EXPECT_EQ(port.drained_at(), port_start + 4s);
    EXPECT_EQ(to_string(port.take(port_start + 4s)), "cdef");
}

// The same messages, polled at other instants: the same bytes by the same time.
TEST(Port, DoesNotDependOnWhenItIsPolled) {
    RandomStream random(5, "port");
    for (const std::uint32_t baud : {300U, 9600U, 38400U, 115200U, 921600U, 7U, 8'000'000U}) {
        Port fine(baud, 700, 200), coarse(baud, 700, 200);
        Bytes from_fine, from_coarse;
        GpsTime fine_now = port_start;
        for (int epoch = 0; epoch < 40; ++epoch) {
            const GpsTime ready = port_start + epoch * 100ms;
            while (fine_now < ready) {
                fine_now = std::min(ready, fine_now + Nanoseconds(random.bits() % 9'000'000));
                const Bytes piece = fine.take(fine_now);
                from_fine.insert(from_fine.end(), piece.begin(), piece.end());
                if (random.uniform() < 0.1) {
                    const Bytes more = coarse.take(fine_now);
                    from_coarse.insert(from_coarse.end(), more.begin(), more.end());
                    ASSERT_EQ(from_coarse, from_fine);
                }
            }
            for (int message = 0; message < 5; ++message) {
                Bytes bytes(1 + random.bits() % 100);
                for (auto& byte : bytes)
                    byte = static_cast<std::uint8_t>(random.bits());
                const auto queue = message == 4 ? &Port::queue : &Port::queue_in_turn;
                ASSERT_EQ((fine.*queue)(bytes, ready), (coarse.*queue)(bytes, ready));
            }
            ASSERT_EQ(fine.drained_at().has_value(), true);
            ASSERT_EQ(fine.give_up_turns(ready - 150ms), coarse.give_up_turns(ready - 150ms));
        }
        const Bytes a = fine.take(port_start + 48h), b = coarse.take(port_start + 48h);
        from_fine.insert(from_fine.end(), a.begin(), a.end());
        from_coarse.insert(from_coarse.end(), b.begin(), b.end());
        EXPECT_EQ(from_fine, from_coarse) << baud;
    }
}

}  // namespace
}  // namespace skyloop::firmware
