#include "receiver/protocol/rtcm3_ublox.hpp"

#include <gtest/gtest.h>

#include "base/core/bytes.hpp"

namespace skyloop {
namespace {

Bytes ublox_from_hex(std::string_view hex) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return bytes;
}

// 4072.1 of gpsd's ublox-f9p-rtcm.log, whose 1077 beside it is of 258 059 000 ms, and ublox-zed-f9t-rtcm3.log.
const Bytes real_4072_f9p = ublox_from_hex(
    "d30032fe800100000023d86abe00000006010000e300120200000000000201000e001c030003e70017060008b20022060107"
    "c10023b35130");
const Bytes real_4072_f9t = ublox_from_hex(
    "d30086fe80010000001597609e40000014000000000000000100000000000200000000000300000000020000540004020100"
    "54000402020054000402030054000403000053000a03010053000a03020053000a03030053000a0500000000000501000000"
    "0005020000000005030000000006000599000506010599000506020599000506030599000541baf5");

TEST(Rtcm3Ublox, CapturedBiasesComeBackAsTheyWere) {
    const auto f9p = decode_station_biases(*parse_rtcm3(real_4072_f9p));
    ASSERT_TRUE(f9p);
    EXPECT_EQ(f9p->head, (Rtcm3UbloxHead{0, 2, 258'059'000}));
    const std::vector<Rtcm3StationBiases::Bias> biases{{1, 0, 227, 18}, {2, 0, 0, 0},     {2, 1, 14, 28},
                                                       {3, 0, 999, 23}, {6, 0, 2226, 34}, {6, 1, 1985, 35}};
    EXPECT_EQ(f9p->biases, biases);
    EXPECT_EQ(encode(*f9p), real_4072_f9p);
    const auto f9t = decode_station_biases(*parse_rtcm3(real_4072_f9t));
    ASSERT_TRUE(f9t);
    EXPECT_EQ(f9t->head, (Rtcm3UbloxHead{0, 1, 375'227'001}));
    EXPECT_EQ(f9t->biases.size(), 20u);
    EXPECT_EQ(encode(*f9t), real_4072_f9t);
}

TEST(Rtcm3Ublox, MovingStationsComeBack) {
    const Rtcm3MovingStation station{{4095, 1, 604'799'999},
                                     {-(std::int64_t{1} << 37), (std::int64_t{1} << 37) - 1, -1},
                                     {-(1 << 23), (1 << 23) - 1, -1},
                                     1'048'575,
                                     7};
    const Bytes frame = encode(station);
    const auto message = parse_rtcm3(frame);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->number, 4072);
    EXPECT_EQ(message->subtype, 0);
    EXPECT_EQ(message->station, 4095);
    EXPECT_EQ(decode_moving_station(*message), station);
    Rtcm3MovingStation unsure = station;
    unsure.position_deviation_mm = 4'000'000'000;
    EXPECT_EQ(encode(unsure), frame);
}

TEST(Rtcm3Ublox, RefusesWhatIsNone) {
    const auto biases = parse_rtcm3(real_4072_f9p);
    EXPECT_FALSE(decode_moving_station(*biases));
    for (std::size_t size = 6; size < biases->payload.size(); ++size)
        EXPECT_FALSE(decode_station_biases({4072, 0, 1, biases->payload.first(size)})) << size;
    EXPECT_FALSE(decode_station_biases({4072, 0, 0, biases->payload}));
    EXPECT_FALSE(decode_station_biases({1005, 0, 1, biases->payload}));
    const Bytes frame = encode(Rtcm3MovingStation());
    const auto station = parse_rtcm3(frame);
    for (std::size_t size = 6; size < station->payload.size(); ++size)
        EXPECT_FALSE(decode_moving_station({4072, 0, 0, station->payload.first(size)})) << size;
    Rtcm3StationBiases many;
    many.biases.resize(400);
    EXPECT_EQ(decode_station_biases(*parse_rtcm3(encode(many)))->biases.size(), 168u);
}

}  // namespace
}  // namespace skyloop
