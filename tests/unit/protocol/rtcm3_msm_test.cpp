#include "receiver/protocol/rtcm3.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/bytes.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

constexpr double wavelength = speed_of_light / 1575.42e6;

Rtcm3MsmCell msm_test_cell(int satellite, int signal, double range) {
    Rtcm3MsmCell cell;
    cell.satellite = satellite;
    cell.signal = signal;
    cell.range_m = range;
    cell.phase_range_m = range + 3.25;
    cell.phase_range_rate = -512.3456;
    cell.wavelength_m = wavelength;
    cell.lock_s = 12.345;
    cell.cno_dbhz = 44.3;
    return cell;
}

constexpr std::size_t fixed_header_bits = 169;

// The one cell of an MSM7 as its fields say (RTCM 10403.3, tables 3.5-79 and 3.5-81).
struct ReadCell {
    double range_m, phase_m, rate;
    std::uint64_t lock, half_cycle;
    double cno;
};
ReadCell only_cell(const Bytes& frame) {
    const auto message = parse_rtcm3(frame);
    BitReader bits(message->payload);
    bits.skip(fixed_header_bits + 1);
    const double whole_ms = static_cast<double>(bits.get(8));
    bits.skip(4);
    const double rough = whole_ms + static_cast<double>(bits.get(10)) / 1024;
    const double rough_rate = static_cast<double>(bits.get_signed(14));
    const double ms = speed_of_light / 1000;
    ReadCell cell{};
    cell.range_m = (rough + static_cast<double>(bits.get_signed(20)) * std::exp2(-29)) * ms;
    cell.phase_m = (rough + static_cast<double>(bits.get_signed(24)) * std::exp2(-31)) * ms;
    cell.lock = bits.get(10);
    cell.half_cycle = bits.get(1);
    cell.cno = static_cast<double>(bits.get(10)) / 16;
    cell.rate = rough_rate + static_cast<double>(bits.get_signed(15)) * 1e-4;
    EXPECT_TRUE(bits.ok());
    return cell;
}

TEST(Rtcm3Msm, TellsOneCellToTheResolutionOfItsFields) {
    Rtcm3MsmObservations m;
    m.cells = {msm_test_cell(7, 2, 22145739.3983)};
    const ReadCell cell = only_cell(encode(m));
    EXPECT_NEAR(cell.range_m, 22145739.3983, 3e-4);
    EXPECT_NEAR(cell.phase_m, 22145742.6483, 8e-5);
    EXPECT_NEAR(cell.rate, -512.3456, 6e-5);
    EXPECT_EQ(cell.lock, 304U);  // 256 ms a step from 288 for 8192 ms on (table 3.5-75)
    EXPECT_EQ(cell.half_cycle, 0U);
    EXPECT_NEAR(cell.cno, 44.3, 0.032);
}

TEST(Rtcm3Msm, HeaderNamesSatellitesSignalsAndCells) {
    Rtcm3MsmObservations m;
    m.number = 1084;
    m.station = 777;
    m.epoch = 0x1234567;
    m.more = true;
    m.cells = {msm_test_cell(9, 8, 2.1e7), msm_test_cell(3, 2, 2.2e7), msm_test_cell(9, 2, 2.1e7)};
    const Bytes frame = encode(m);
    const auto header = decode_msm_header(*parse_rtcm3(frame));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->number, 1084);
    EXPECT_EQ(header->station, 777);
    EXPECT_EQ(header->epoch, 0x1234567U);
    EXPECT_TRUE(header->more);
    EXPECT_EQ(header->satellites, std::uint64_t{1} << 61 | std::uint64_t{1} << 55);
    EXPECT_EQ(header->signals, 1U << 30 | 1U << 24);
    EXPECT_EQ(header->cells, (std::vector<bool>{true, false, true, true}));
    // Two satellites of 18 bits and three cells of 48 (tables 3.5-78 and 3.5-80).
    EXPECT_EQ(frame.size(), 6 + (fixed_header_bits + 4 + 2 * 18 + 3 * 48 + 7) / 8);
}

TEST(Rtcm3Msm, APhaseFarFromTheRangeComesNearerByWholeCycles) {
    Rtcm3MsmObservations m;
    m.cells = {msm_test_cell(7, 2, 2.2e7)};
    m.cells[0].phase_range_m = 2.2e7 - 123456.789;
    const ReadCell cell = only_cell(encode(m));
    EXPECT_LT(std::abs(cell.phase_m - 2.2e7), 600);
    const double cycles = (cell.phase_m - *m.cells[0].phase_range_m) / wavelength;
    EXPECT_NEAR(cycles, std::round(cycles), 1e-3);
}

TEST(Rtcm3Msm, WithoutAPhaseTheFieldsSayThatThereIsNone) {
    Rtcm3MsmObservations m;
    m.cells = {msm_test_cell(7, 2, 2.2e7)};
    m.cells[0].phase_range_m.reset();
    m.cells[0].phase_range_rate.reset();
    const auto frame = encode(m);
    BitReader bits(parse_rtcm3(frame)->payload);
    bits.skip(fixed_header_bits + 1 + 8 + 4 + 10);
    EXPECT_EQ(bits.get_signed(14), -8192);
    bits.skip(20);
    EXPECT_EQ(bits.get_signed(24), -8388608);
    bits.skip(10 + 1 + 10);
    EXPECT_EQ(bits.get_signed(15), -16384);
}

TEST(Rtcm3Msm, NeverHasMoreThan64Cells) {
    Rtcm3MsmObservations m;
    for (int satellite = 1; satellite <= 40; ++satellite)
        for (const int signal : {2, 16})
            m.cells.push_back(msm_test_cell(satellite, signal, 2.2e7 + satellite));
    const Bytes frame = encode(m);
    const auto header = decode_msm_header(*parse_rtcm3(frame));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->satellite_count(), 32);
    EXPECT_EQ(header->cells.size(), 64U);
}

TEST(Rtcm3Msm, OtherKindsAndNothingAtAllAreNoMessage) {
    Rtcm3MsmObservations m;
    EXPECT_TRUE(encode(m).empty());
    m.cells = {msm_test_cell(7, 2, 2.2e7)};
    m.number = 1073;
    EXPECT_TRUE(encode(m).empty());
}

// Half a step of each field, of coarse kinds and fine ones.
TEST(Rtcm3Msm, KindsFourToSevenComeBackToTheirResolution) {
    for (const int kind : {4, 5, 6, 7}) {
        Rtcm3MsmObservations m;
        m.number = 1090 + kind;
        m.station = 12;
        m.epoch = 345600500;
        m.cells = {msm_test_cell(7, 2, 22145739.3983), msm_test_cell(7, 16, 22145744.2), msm_test_cell(36, 16, 2.8e7)};
        m.cells[1].phase_range_m.reset();
        m.cells[2].half_cycle_unknown = true;
        const Bytes frame = encode(m);
        const auto back = decode_msm(*parse_rtcm3(frame));
        ASSERT_TRUE(back) << kind;
        EXPECT_EQ(back->number, m.number);
        EXPECT_EQ(back->station, 12);
        EXPECT_EQ(back->epoch, 345600500U);
        ASSERT_EQ(back->cells.size(), 3u);
        const bool fine = kind >= 6, rates = kind % 2 != 0;
        const double ms = speed_of_light / 1000;
        for (std::size_t i = 0; i < 3; ++i) {
            const Rtcm3MsmCell &sent = m.cells[i], &decoded = back->cells[i];
            EXPECT_EQ(decoded.satellite, sent.satellite);
            EXPECT_EQ(decoded.signal, sent.signal);
            EXPECT_NEAR(decoded.range_m, sent.range_m, ms * std::exp2(fine ? -30 : -25) + 1e-8);
            ASSERT_EQ(decoded.phase_range_m.has_value(), sent.phase_range_m.has_value());
            EXPECT_NEAR(decoded.phase_range_m.value_or(0), sent.phase_range_m.value_or(0),
                        ms * std::exp2(fine ? -32 : -30) + 1e-8);
            ASSERT_EQ(decoded.phase_range_rate.has_value(), rates);
            EXPECT_NEAR(decoded.phase_range_rate.value_or(-512.3456), *sent.phase_range_rate, 5.1e-5);
            EXPECT_NEAR(decoded.cno_dbhz, sent.cno_dbhz, fine ? 0.032 : 0.51);
            EXPECT_EQ(decoded.half_cycle_unknown, sent.half_cycle_unknown);
            EXPECT_LE(decoded.lock_s, sent.lock_s);
            EXPECT_GT(decoded.lock_s, sent.lock_s * (fine ? 0.96 : 0.49));
        }
        for (std::size_t size = 2; size + 7 < frame.size(); ++size) {  // of the last byte some bits may be none's
            const Bytes cut = encode_rtcm3(ByteSpan(frame).subspan(3, size));
            const auto message = parse_rtcm3(cut);
            EXPECT_FALSE(message && decode_msm(*message)) << size;
        }
    }
}

// Without whole milliseconds (255) there is neither range nor phase.
TEST(Rtcm3Msm, SatellitesWithoutARangeAreLeftOut) {
    Rtcm3MsmObservations m;
    m.cells = {msm_test_cell(7, 2, 2.2e7)};
    const Bytes frame = encode(m);
    Bytes payload(frame.begin() + 3, frame.end() - 3);
    // Eight bits behind the header and its one cell.
    for (std::size_t bit = fixed_header_bits + 1; bit < fixed_header_bits + 9; ++bit)
        payload[bit / 8] |= static_cast<std::uint8_t>(0x80 >> bit % 8);
    const auto back = decode_msm(*parse_rtcm3(encode_rtcm3(payload)));
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->cells.empty());
}

}  // namespace
}  // namespace skyloop
