#include "wire/transport/line_garbler.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

Bytes random_bytes(std::size_t count, std::string_view name) {
    RandomStream random(1, name);
    Bytes bytes(count);
    for (auto& byte : bytes)
        byte = static_cast<std::uint8_t>(random.bits());
    return bytes;
}

const std::string nmea_text = "$GNGGA,223745.00,3806.62964,N,12237.61382,W,2,12,0.54,83.1,M,-29.5,M,,0000*44\r\n";

Bytes append(Bytes bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return bytes;
}

Bytes heard_all(LineGarbler& line, ByteSpan sent) {
    Bytes heard = line.pass(sent);
    return append(std::move(heard), line.idle());
}

TEST(LineGarbler, PassesEqualSpeedsAsTheyAre) {
    LineGarbler line(9600, 9600);
    const Bytes sent = random_bytes(1000, "equal");
    EXPECT_EQ(line.pass(sent), sent);
    EXPECT_TRUE(line.idle().empty());
    EXPECT_EQ(line.framing_errors(), 0U);
}

// WIRES.md section 1: intact from 96 to 105 %.
TEST(LineGarbler, KeepsBytesWholeFrom96To105Percent) {
    const Bytes sent = random_bytes(4000, "tolerance");
    for (const std::uint32_t baud : {9600U, 38400U, 115200U, 921600U})
        for (const std::uint32_t percent : {96U, 97U, 98U, 99U, 101U, 102U, 103U, 104U, 105U}) {
            LineGarbler line(baud, baud / 100 * percent);
            EXPECT_EQ(heard_all(line, sent), sent) << baud << " at " << percent << " %";
            EXPECT_EQ(line.framing_errors(), 0U);
        }
}

TEST(LineGarbler, DeliversEveryByteAtOnceWithinTolerance) {
    LineGarbler line(115200, 111744);
    for (const std::uint8_t byte : random_bytes(500, "at once"))
        EXPECT_EQ(line.pass({&byte, 1}), Bytes{byte});
}

TEST(LineGarbler, BreaksTextOutsideTheTolerance) {
    std::string text;
    for (int i = 0; i < 20; ++i)
        text += nmea_text;
    for (const std::uint32_t percent : {50U, 80U, 90U, 93U, 94U, 107U, 110U, 125U, 200U}) {
        LineGarbler line(115200, 1152 * percent);
        const std::string heard = to_string(heard_all(line, to_bytes(text)));
        EXPECT_GT(line.framing_errors(), 50U) << percent;
        EXPECT_EQ(heard.find("$GNGGA,"), std::string::npos) << percent << heard;
    }
}

TEST(LineGarbler, BreaksEveryPairOfUsualSpeeds) {
    const std::uint32_t bauds[] = {4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600};
    const Bytes sent = to_bytes(nmea_text);
    for (const std::uint32_t from : bauds)
        for (const std::uint32_t to : bauds) {
            if (from == to) continue;
            LineGarbler line(from, to);
            const Bytes heard = heard_all(line, sent);
            EXPECT_FALSE(heard.empty()) << from << " to " << to;
            EXPECT_EQ(to_string(heard).find("GGA"), std::string::npos) << from << " to " << to;
        }
}

// A listener twelve times as fast sees each of the sender's low bits as a whole byte of zeros without a stop bit.
TEST(LineGarbler, GivesNulsToAMuchFasterListener) {
    LineGarbler line(9600, 115200);
    const Bytes heard = heard_all(line, to_bytes("U"));  // 0x55: low and high in turn
    EXPECT_EQ(heard, Bytes(5, 0));
    EXPECT_EQ(line.framing_errors(), 5U);
}

// A listener half as fast joins two bits to one: worked out by hand.
TEST(LineGarbler, SamplesAtTheListenersBitCentres) {
    LineGarbler line(19200, 9600);
    // 0xF0 then 0xFF: levels 0 0000 1111 1 | 0 1111 1111 1. The listener samples at sender bits 3, 5, 7 … 19, the last
    // being the stop bit: 0? start at 1: low; data 3 low, 5 7 9 high, 11 13 15 17 high; stop 19 high.
    const Bytes sent{0xF0, 0xFF};
    EXPECT_EQ(line.pass(sent), Bytes{0xFE});
    EXPECT_TRUE(line.idle().empty());
    EXPECT_EQ(line.framing_errors(), 0U);
}

TEST(LineGarbler, FinishesABytePendingWhenTheLineRests) {
    LineGarbler line(115200, 9600);
    EXPECT_TRUE(line.pass(Bytes{0x00}).empty());
    EXPECT_EQ(line.idle(), Bytes{0xFF});  // nine low bits of 115200 are three quarters of one of 9600
    EXPECT_TRUE(line.idle().empty());
    // A pulse shorter than half a bit is no start bit.
    EXPECT_TRUE(heard_all(line, Bytes{0xFF}).empty());
}

TEST(LineGarbler, GivesTheSameHoweverTheStreamIsSplit) {
    RandomStream random(2, "splits");
    const Bytes sent = random_bytes(3000, "split stream");
    const std::uint32_t pairs[][2] = {{9600, 115200}, {115200, 9600}, {38400, 57600},  {115200, 123000},
                                      {4800, 921600}, {921600, 4800}, {100000, 97000}, {1, 4'000'000'000U}};
    for (const auto& [from, to] : pairs) {
        LineGarbler whole(from, to), pieces(from, to);
        const Bytes expected = heard_all(whole, sent);
        Bytes heard;
        for (std::size_t at = 0; at < sent.size();) {
            const std::size_t size = std::min(sent.size() - at, static_cast<std::size_t>(random.bits() % 40));
            heard = append(std::move(heard), pieces.pass(ByteSpan(sent).subspan(at, size)));
            at += size;
        }
        heard = append(std::move(heard), pieces.idle());
        EXPECT_EQ(heard, expected) << from << " to " << to;
        EXPECT_EQ(pieces.framing_errors(), whole.framing_errors());
    }
}

TEST(LineGarbler, StartsAfreshAtNewSpeeds) {
    LineGarbler line(115200, 9600);
    (void)line.pass(random_bytes(33, "before the change"));
    line.set_bauds(115200, 115200);
    EXPECT_EQ(to_string(line.pass(to_bytes("abc"))), "abc");
    line.set_bauds(115200, 117000);
    EXPECT_EQ(to_string(line.pass(to_bytes("abc"))), "abc");
}

TEST(LineGarbler, StandsImpossibleSpeeds) {
    LineGarbler line(0, 0);
    EXPECT_EQ(to_string(line.pass(to_bytes("abc"))), "abc");
    line.set_bauds(4'294'967'295U, 1);
    for (int i = 0; i < 1000; ++i)
        (void)line.pass(to_bytes(nmea_text));
    EXPECT_LE(line.idle().size(), 1U);
}

}  // namespace
}  // namespace skyloop
