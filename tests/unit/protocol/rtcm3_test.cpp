#include "receiver/protocol/rtcm3.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "base/core/bytes.hpp"
#include "base/core/files.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

Bytes from_hex(std::string_view hex) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return bytes;
}

// Of a ZED-F9T that stands in Bend, Oregon, and of a ZED-F9P.
const Bytes real_1005 = from_hex("d300133ed00003ba71ca31f2b6de30eb470a472a66d37fa0e9");
const Bytes real_1230 = from_hex("d300084ce0008a00000000a8f72a");
const Bytes real_1230_all = from_hex("d3000c4ce1160ff1f3f1f3f1f3f1f3d85235");

TEST(BitField, WritesAndReadsTheSame) {
    BitWriter writer;
    writer.put(5, 3);
    writer.put_signed(-3, 38);
    writer.put(0xFFFF'FFFF'FFFF'FFFF, 64);
    writer.put_signed(-1, 1);
    const Bytes bytes = writer.bytes();
    ASSERT_EQ(bytes.size(), 14u);
    BitReader reader(bytes);
    EXPECT_EQ(reader.get(3), 5u);
    EXPECT_EQ(reader.get_signed(38), -3);
    EXPECT_EQ(reader.get(64), 0xFFFF'FFFF'FFFF'FFFF);
    EXPECT_EQ(reader.get_signed(1), -1);
    EXPECT_TRUE(reader.ok());
    reader.skip(6);
    EXPECT_TRUE(reader.ok());
    EXPECT_EQ(reader.get(1), 0u);
    EXPECT_FALSE(reader.ok());
}

TEST(BitField, QuantisesWhateverComes) {
    EXPECT_EQ(quantised(2.6, 1, -4, 3), 3);
    EXPECT_EQ(quantised(-2.6, 1, -4, 3), -3);
    EXPECT_EQ(quantised(1e300, 1, -4, 3), 3);
    EXPECT_EQ(quantised(-1e300, 1e-300, -4, 3), -4);
    EXPECT_EQ(quantised(std::nan(""), 1, -4, 3), 0);
}

TEST(Rtcm3, ReadsARealStation) {
    const auto message = parse_rtcm3(real_1005);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->number, 1005);
    EXPECT_EQ(message->station, 0);
    const auto station = decode_station(*message);
    ASSERT_TRUE(station);
    // Taken apart by hand: x, y < 0 and z > 0, as in Oregon.
    EXPECT_EQ(station->position, (std::array<std::int64_t, 3>{-23'860'727'310, -39'221'925'049, 44'143'634'131}));
}

TEST(Rtcm3, ReadsRealBiases) {
    const auto cut = decode_glonass_biases(*parse_rtcm3(real_1230));
    ASSERT_TRUE(cut);
    EXPECT_TRUE(cut->aligned);
    EXPECT_EQ(cut->bias[0], 0);
    EXPECT_FALSE(cut->bias[1]);
    EXPECT_EQ(cut->bias[2], 0);
    const auto all = decode_glonass_biases(*parse_rtcm3(real_1230_all));
    ASSERT_TRUE(all);
    EXPECT_EQ(all->station, 278);
    for (const auto& bias : all->bias)
        EXPECT_EQ(bias, -3597);
    EXPECT_EQ(encode(*all), real_1230_all);
}

TEST(Rtcm3, RefusesWhatIsNoFrame) {
    for (std::size_t length = 0; length < real_1005.size(); ++length)
        EXPECT_FALSE(parse_rtcm3(ByteSpan(real_1005).first(length))) << length;
    for (std::size_t i = 0; i < real_1005.size(); ++i) {
        Bytes damaged = real_1005;
        damaged[i] ^= 0x10;
        EXPECT_FALSE(parse_rtcm3(damaged)) << i;
    }
    EXPECT_FALSE(parse_rtcm3(encode_rtcm3(Bytes{0x3E, 0xD0})));  // no room for a station
    EXPECT_TRUE(encode_rtcm3(Bytes(1024)).empty());
}

TEST(Rtcm3, StationsComeBack) {
    for (const auto& height : {std::optional<int>(), std::optional<int>(65535)}) {
        const Rtcm3Station station{
            4095, {-(std::int64_t{1} << 37), (std::int64_t{1} << 37) - 1, -1}, height, height.has_value()};
        const Bytes frame = encode(station);
        const auto message = parse_rtcm3(frame);
        ASSERT_TRUE(message);
        EXPECT_EQ(message->number, height ? 1006 : 1005);
        EXPECT_EQ(decode_station(*message), station);
    }
}

TEST(Rtcm3, MsmHeadersComeBack) {
    const Rtcm3MsmHeader header{
        1127, 17, 123'456'000, true, 3, 0x8000'0000'0000'0003, 0x4000'0200, {true, false, true, true, false, true}};
    EXPECT_EQ(header.satellite_count(), 3);
    EXPECT_EQ(header.signal_count(), 2);
    const Bytes frame = encode(header);
    EXPECT_EQ(decode_msm_header(*parse_rtcm3(frame)), header);
    EXPECT_EQ(msm_kind(1127), 7);
    EXPECT_FALSE(msm_kind(1078));
    EXPECT_FALSE(msm_kind(1005));
}

TEST(Rtcm3, RefusesAnMsmOfTooManyCells) {
    const Rtcm3MsmHeader header{1077, 0, 0, false, 0, ~std::uint64_t{0}, 3, {}};
    const Bytes frame = encode(header);
    EXPECT_FALSE(decode_msm_header(*parse_rtcm3(frame)));
}

TEST(Rtcm3, EphemeridesHaveNoStation) {
    const Bytes frame = encode_rtcm3(Bytes{0x3F, 0xB0, 0x50, 0, 0});
    const auto message = parse_rtcm3(frame);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->number, 1019);
    EXPECT_FALSE(message->station);
}

TEST(Rtcm3, StationsStandWhereTheMessageHasThem) {
    const auto station_of = [](int number) {
        const auto first = static_cast<std::uint8_t>(number >> 4), second = static_cast<std::uint8_t>(number << 4);
        const Bytes frame = encode_rtcm3(Bytes{first, static_cast<std::uint8_t>(second | 1), 0x23, 0x45, 0x60});
        return parse_rtcm3(frame)->station;
    };
    for (const int number : {1002, 1006, 1012, 1033, 1077, 1127, 1137, 1230})
        EXPECT_EQ(station_of(number), 0x123) << number;
    for (const int number : {1014, 1019, 1020, 1042, 1046, 1060, 1078, 1242, 4050, 4076})
        EXPECT_FALSE(station_of(number)) << number;
    EXPECT_EQ(station_of(4072), 0x456) << "behind the subtype";
}

TEST(Rtcm3, HeadersOfARealBase) {
    SKYLOOP_REQUIRE_SHARED(path, "serial/ublox-zed-f9t-rtcm3.log");
    const auto log = read_text_file(path);
    ASSERT_TRUE(log);
    StreamSplitter splitter;
    std::map<int, int> numbers;
    std::map<int, std::uint32_t> last;
    for (const StreamPiece& piece : splitter.feed(to_bytes(*log))) {
        if (piece.kind != StreamKind::rtcm3) continue;
        const auto message = parse_rtcm3(piece.bytes);
        ASSERT_TRUE(message);
        ++numbers[message->number];
        const auto header = decode_msm_header(*message);
        EXPECT_EQ(header.has_value(), msm_kind(message->number).has_value());
        if (!header) continue;
        EXPECT_GT(header->satellite_count(), 2);
        if (last.contains(header->number)) {
            EXPECT_EQ(header->epoch - last[header->number], 1000u) << header->number;
        }
        last[header->number] = header->epoch;
    }
    const std::map<int, int> expected{{1005, 26}, {1077, 26}, {1087, 26}, {1097, 26},
                                      {1127, 26}, {1230, 26}, {4072, 26}};
    EXPECT_EQ(numbers, expected);
}

}  // namespace
}  // namespace skyloop
