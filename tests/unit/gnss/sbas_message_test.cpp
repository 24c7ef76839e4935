// Messages of SBAS against a reader of their bits that is written here, field by field from the tables of DO-229.
#include "world/gnss/sbas_message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

namespace skyloop {
namespace {

const GpsTime start = to_gps_time({2243, std::chrono::hours(12)});

// Bits as they are sent, one a character.
class SentBits {
public:
    explicit SentBits(const SbasWords& words) {
        for (const std::uint32_t word : words)
            for (int bit = 31; bit >= 0; --bit)
                bits_.push_back((word >> bit & 1) != 0 ? '1' : '0');
    }
    [[nodiscard]] std::int64_t at(std::size_t offset, std::size_t width) const {
        return std::stoll(bits_.substr(offset, width), nullptr, 2);
    }
    [[nodiscard]] std::int64_t signed_at(std::size_t offset, std::size_t width) const {
        const std::int64_t value = at(offset, width);
        return bits_[offset] == '1' ? value - (std::int64_t{1} << width) : value;
    }
    [[nodiscard]] std::string text(std::size_t offset, std::size_t width) const { return bits_.substr(offset, width); }

private:
    std::string bits_;
};

// The remainder of message · x²⁴ by long division with g(x) = (1 + x) p(x) of DO-229, A.4.3.3, written out.
std::string remainder_of(std::string bits) {
    const std::string generator = "1100001100100110011111011";
    const std::size_t length = bits.size();
    bits += std::string(24, '0');
    for (std::size_t i = 0; i < length; ++i) {
        if (bits[i] == '0') continue;
        for (std::size_t j = 0; j < generator.size(); ++j)
            bits[i + j] = bits[i + j] == generator[j] ? '0' : '1';
    }
    return bits.substr(length);
}

std::optional<SbasMessage> again(const SbasMessage& message) {
    const SbasWords words = encode_sbas(message, start);
    return decode_sbas({words.begin(), words.end()});
}

constexpr std::size_t data = 14;  // where the 212 bits of a message begin

TEST(SbasMessage, HasPreambleTypeAndParity) {
    const std::array preambles{0x53, 0x9A, 0xC6};
    for (int second = 0; second < 6; ++second) {
        const GpsTime time = start + std::chrono::seconds(second);
        const SentBits bits(encode_sbas(SbasNull{}, time));
        EXPECT_EQ(bits.at(0, 8), preambles[static_cast<std::size_t>(second % 3)]);
        EXPECT_EQ(bits.at(8, 6), 63);
        EXPECT_EQ(bits.text(226, 24), remainder_of(bits.text(0, 226)));
        EXPECT_EQ(bits.text(250, 6), "000000");
    }
}

TEST(SbasMessage, IsRefusedWithAnyBitWrong) {
    SbasFastCorrections message;
    message.satellites[3] = {-12.5, 4};
    const SbasWords words = encode_sbas(message, start);
    std::vector<std::uint32_t> sent(words.begin(), words.end());
    ASSERT_EQ(decode_sbas(sent), SbasMessage(message));
    for (std::size_t bit = 0; bit < 250; ++bit) {
        std::vector<std::uint32_t> wrong = sent;
        wrong[bit / 32] ^= 1u << (31 - bit % 32);
        EXPECT_FALSE(decode_sbas(wrong)) << bit;
    }
    sent.pop_back();
    EXPECT_FALSE(decode_sbas(sent));
    EXPECT_FALSE(decode_sbas({}));
}

TEST(SbasMessage, OfTypesThatNobodySendsHereIsRefused) {
    // Type 12, by hand, with its parity.
    std::string bits =
        "01010011"
        "001100" +
        std::string(212, '0');
    bits += remainder_of(bits) + "000000";
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < 256; i += 32)
        words.push_back(static_cast<std::uint32_t>(std::stoul(bits.substr(i, 32), nullptr, 2)));
    EXPECT_FALSE(decode_sbas(words));
}

TEST(SbasMessage, NamesSatellitesByABitEach) {
    const SbasPrnMask mask{{1, 2, 32, 37, 120, 210}, 2};
    const SentBits bits(encode_sbas(mask, start));
    EXPECT_EQ(bits.at(8, 6), 1);
    for (int slot = 1; slot <= 210; ++slot)
        EXPECT_EQ(bits.at(data + static_cast<std::size_t>(slot) - 1, 1) != 0, std::ranges::count(mask.slots, slot) > 0);
    EXPECT_EQ(bits.at(data + 210, 2), 2);
    EXPECT_EQ(again(mask), SbasMessage(mask));
    EXPECT_EQ(sbas_mask_slot({Constellation::gps, 7}), 7);
    EXPECT_EQ(sbas_mask_slot({Constellation::glonass, 3}), 40);
    EXPECT_EQ(sbas_mask_slot({Constellation::sbas, 36}), 136);
    EXPECT_FALSE(sbas_mask_slot({Constellation::galileo, 3}));
    EXPECT_FALSE(sbas_mask_slot({Constellation::gps, 38}));
}

TEST(SbasMessage, OfFastCorrectionsHasThirteenSatellites) {
    for (int block = 0; block < 4; ++block) {
        SbasFastCorrections m;
        m.block = block;
        m.iodf = 2;
        m.iodp = 1;
        for (std::size_t i = 0; i < m.satellites.size(); ++i)
            m.satellites[i] = {-3.5 + 0.625 * static_cast<double>(i), static_cast<int>(i)};
        const SentBits bits(encode_sbas(m, start));
        EXPECT_EQ(bits.at(8, 6), 2 + block);
        EXPECT_EQ(bits.at(data, 2), 2);
        EXPECT_EQ(bits.at(data + 2, 2), 1);
        for (std::size_t i = 0; i < 13; ++i) {
            EXPECT_EQ(static_cast<double>(bits.signed_at(data + 4 + 12 * i, 12)) / 8, m.satellites[i].range_m);
            EXPECT_EQ(bits.at(data + 160 + 4 * i, 4), m.satellites[i].udrei);
        }
        EXPECT_EQ(again(m), SbasMessage(m));
    }
}

TEST(SbasMessage, OfIntegrityAndDegradationHasFiftyOneSatellites) {
    SbasIntegrity integrity;
    integrity.iodf = {0, 1, 2, 3};
    SbasFastDegradation ageing{7, 3, {}};
    for (std::size_t i = 0; i < 51; ++i) {
        integrity.udrei[i] = static_cast<int>(i % 16);
        ageing.indicators[i] = static_cast<int>((i + 5) % 16);
    }
    const SentBits first(encode_sbas(integrity, start)), second(encode_sbas(ageing, start));
    EXPECT_EQ(first.at(8, 6), 6);
    EXPECT_EQ(first.at(data, 8), 0b00'01'10'11);
    EXPECT_EQ(second.at(8, 6), 7);
    EXPECT_EQ(second.at(data, 4), 7);
    EXPECT_EQ(second.at(data + 4, 2), 3);
    for (std::size_t i = 0; i < 51; ++i) {
        EXPECT_EQ(first.at(data + 8 + 4 * i, 4), integrity.udrei[i]);
        EXPECT_EQ(second.at(data + 8 + 4 * i, 4), ageing.indicators[i]);
    }
    EXPECT_EQ(again(integrity), SbasMessage(integrity));
    EXPECT_EQ(again(ageing), SbasMessage(ageing));
}

TEST(SbasMessage, OfTheSatellitesOwnOrbit) {
    SbasEphemeris record;
    record.toe = to_gps_time({2243, std::chrono::seconds(86400 + 3200)});
    record.iode = 77;
    record.accuracy_m = 2;
    record.position_m = {42164000.08, -1234567.92, 40000.4};
    record.velocity_mps = {1.25, -0.625, 0.004};
    record.acceleration_mps2 = {0.0000125, -0.0000125, 0.0000625};
    record.clock_bias = -std::ldexp(100.0, -31);
    record.clock_drift = std::ldexp(3.0, -40);
    const SbasNavigation m = sbas_navigation(record);
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 9);
    EXPECT_EQ(bits.at(data, 8), 77);
    EXPECT_EQ(bits.at(data + 8, 13) * 16, 3200);
    EXPECT_EQ(bits.at(data + 21, 4), 0);
    EXPECT_NEAR(static_cast<double>(bits.signed_at(data + 25, 30)) * 0.08, record.position_m[0], 0.04);
    EXPECT_NEAR(static_cast<double>(bits.signed_at(data + 55, 30)) * 0.08, record.position_m[1], 0.04);
    EXPECT_NEAR(static_cast<double>(bits.signed_at(data + 85, 25)) * 0.4, record.position_m[2], 0.2);
    EXPECT_EQ(bits.signed_at(data + 110, 17), 2000);
    EXPECT_EQ(bits.signed_at(data + 127, 17), -1000);
    EXPECT_EQ(bits.signed_at(data + 144, 18), 1);
    EXPECT_EQ(bits.signed_at(data + 162, 10), 1);
    EXPECT_EQ(bits.signed_at(data + 172, 10), -1);
    EXPECT_EQ(bits.signed_at(data + 182, 10), 1);
    EXPECT_EQ(bits.signed_at(data + 192, 12), -100);
    EXPECT_EQ(bits.signed_at(data + 204, 8), 3);
    const auto read = std::get<SbasNavigation>(*again(m));
    EXPECT_NEAR(read.position_m[0], record.position_m[0], 1e-6);
    EXPECT_EQ(read.clock_drift, record.clock_drift);
    record.health = 0b10'0000;
    EXPECT_EQ(sbas_navigation(record).accuracy_index, 15);
}

TEST(SbasMessage, OfAgeing) {
    SbasDegradation m;
    m.b_rrc_m = 0.3;
    m.c_ltc_lsb_m = 0.002;
    m.c_ltc_v1_mps = 0.001;
    m.i_ltc_v1_s = 511;
    m.c_ltc_v0_m = 2.046;
    m.i_ltc_v0_s = 1;
    m.c_geo_lsb_m = 0.5;
    m.c_geo_v_mps = 0.05;
    m.i_geo_s = 300;
    m.c_er_m = 31.5;
    m.c_iono_step_m = 1;
    m.i_iono_s = 2;
    m.c_iono_ramp_mps = 0.005;
    m.rss_udre = 1;
    m.c_covariance = 12.7;
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 10);
    const std::array<std::pair<int, int>, 16> fields{{{10, 150},
                                                      {10, 1},
                                                      {10, 20},
                                                      {9, 511},
                                                      {10, 1023},
                                                      {9, 1},
                                                      {10, 1000},
                                                      {10, 1000},
                                                      {9, 300},
                                                      {6, 63},
                                                      {10, 1000},
                                                      {9, 2},
                                                      {10, 1000},
                                                      {1, 1},
                                                      {1, 0},
                                                      {7, 127}}};
    std::size_t offset = data;
    for (const auto& [width, value] : fields) {
        EXPECT_EQ(bits.at(offset, static_cast<std::size_t>(width)), value) << "at bit " << offset;
        offset += static_cast<std::size_t>(width);
    }
    const auto read = std::get<SbasDegradation>(*again(m));
    EXPECT_NEAR(read.c_er_m, 31.5, 1e-12);
    EXPECT_NEAR(read.c_iono_ramp_mps, 0.005, 1e-12);
    EXPECT_EQ(read.i_geo_s, 300);
}

TEST(SbasMessage, OfAlmanacs) {
    SbasAlmanacs m;
    m.satellites[0] = {1, 136, 0x10, {2600 * 16200.0, -2600 * 3.0, 26000 * -2.0}, {10, -20, 60}};
    m.satellites[2] = {0, 123, 0x13, {-2600, 2600, 0}, {}};
    m.time_of_day_s = 64 * 100;
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 17);
    EXPECT_EQ(bits.at(data, 2), 1);
    EXPECT_EQ(bits.at(data + 2, 8), 136);
    EXPECT_EQ(bits.at(data + 10, 8), 0x10);
    EXPECT_EQ(bits.signed_at(data + 18, 15), 16200);
    EXPECT_EQ(bits.signed_at(data + 33, 15), -3);
    EXPECT_EQ(bits.signed_at(data + 48, 9), -2);
    EXPECT_EQ(bits.signed_at(data + 57, 3), 1);
    EXPECT_EQ(bits.signed_at(data + 60, 3), -2);
    EXPECT_EQ(bits.signed_at(data + 63, 4), 1);
    EXPECT_EQ(bits.at(data + 67 + 2, 8), 0);
    EXPECT_EQ(bits.at(data + 134 + 2, 8), 123);
    EXPECT_EQ(bits.at(data + 201, 11), 100);
    EXPECT_EQ(again(m), SbasMessage(m));
}

TEST(SbasMessage, OfTheGrid) {
    const SbasGridMask mask{5, 4, 2, {1, 15, 200, 201}};
    const SentBits bits(encode_sbas(mask, start));
    EXPECT_EQ(bits.at(8, 6), 18);
    EXPECT_EQ(bits.at(data, 4), 5);
    EXPECT_EQ(bits.at(data + 4, 4), 4);
    EXPECT_EQ(bits.at(data + 8, 2), 2);
    for (int point = 1; point <= 201; ++point)
        EXPECT_EQ(bits.at(data + 9 + static_cast<std::size_t>(point), 1) != 0,
                  std::ranges::count(mask.points, point) > 0);
    EXPECT_EQ(again(mask), SbasMessage(mask));

    SbasIonosphere m{9, 13, 3, {}};
    for (std::size_t i = 0; i < 14; ++i)
        m.points[i] = {0.125 * static_cast<double>(36 * i), static_cast<int>(i)};
    const SentBits grid(encode_sbas(m, start));
    EXPECT_EQ(grid.at(8, 6), 26);
    EXPECT_EQ(grid.at(data, 4), 9);
    EXPECT_EQ(grid.at(data + 4, 4), 13);
    for (std::size_t i = 0; i < 14; ++i) {
        EXPECT_EQ(grid.at(data + 8 + 13 * i, 9), static_cast<std::int64_t>(36 * i));
        EXPECT_EQ(grid.at(data + 17 + 13 * i, 4), static_cast<std::int64_t>(i));
    }
    EXPECT_EQ(grid.text(data + 8 + 13 * 14, 9), "111111111") << "a point that is not to be used";
    EXPECT_EQ(grid.at(data + 203, 2), 3);
    EXPECT_EQ(again(m), SbasMessage(m));
}

// Bits of a half: one satellite with its velocity, or two without.
void expect_half(const SentBits& bits, std::size_t offset, const SbasLongTermHalf& half) {
    const double clock = std::ldexp(1.0, -31);
    EXPECT_EQ(bits.at(offset, 1) != 0, half.with_velocity);
    EXPECT_EQ(bits.at(offset + (half.with_velocity ? 104 : 103), 2), half.iodp);
    for (std::size_t i = 0; i < (half.with_velocity ? 1u : 2u); ++i) {
        const SbasLongTermCorrection& c = half.satellites[i];
        const std::size_t at = offset + 1 + 51 * i, width = half.with_velocity ? 11 : 9;
        EXPECT_EQ(bits.at(at, 6), c.number);
        EXPECT_EQ(bits.at(at + 6, 8), c.iode);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(static_cast<double>(bits.signed_at(at + 14 + width * axis, width)) / 8, c.position_m[axis]);
        const std::size_t after = at + 14 + 3 * width;
        EXPECT_EQ(static_cast<double>(bits.signed_at(after, half.with_velocity ? 11 : 10)) * clock, c.clock_s);
        if (!half.with_velocity) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(static_cast<double>(bits.signed_at(after + 11 + 8 * axis, 8)) / 2048, c.velocity_mps[axis]);
        EXPECT_EQ(std::ldexp(static_cast<double>(bits.signed_at(after + 35, 8)), -39), c.clock_drift);
        EXPECT_EQ(static_cast<double>(bits.at(after + 43, 13)) * 16, c.time_of_day_s);
    }
}

SbasLongTermHalf half_without_velocity(int number) {
    SbasLongTermHalf half;
    half.iodp = 2;
    half.satellites[0] = {number, 200, {1.125, -2, 31.875}, std::ldexp(-7.0, -31)};
    half.satellites[1] = {number + 1, 3, {-32, 0, 0.125}, std::ldexp(511.0, -31)};
    return half;
}

SbasLongTermHalf half_with_velocity() {
    SbasLongTermHalf half;
    half.with_velocity = true;
    half.iodp = 1;
    half.satellites[0] = {
        51,   255, {127.875, -128, 0.125}, std::ldexp(-1024.0, -31), {127. / 2048, -0.0625, 0}, std::ldexp(-128.0, -39),
        86384};
    return half;
}

TEST(SbasMessage, OfSlowCorrectionsHasTwoHalves) {
    const SbasLongTermCorrections m{{half_without_velocity(5), half_with_velocity()}};
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 25);
    expect_half(bits, data, m.halves[0]);
    expect_half(bits, data + 106, m.halves[1]);
    EXPECT_EQ(again(m), SbasMessage(m));
}

TEST(SbasMessage, OfMixedCorrectionsHasSixSatellitesAndAHalf) {
    SbasMixedCorrections m;
    m.iodp = 1;
    m.block = 2;
    m.iodf = 3;
    for (std::size_t i = 0; i < 6; ++i)
        m.satellites[i] = {0.125 * static_cast<double>(i) - 256, static_cast<int>(15 - i)};
    m.long_term = half_with_velocity();
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 24);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(static_cast<double>(bits.signed_at(data + 12 * i, 12)) / 8, m.satellites[i].range_m);
        EXPECT_EQ(bits.at(data + 72 + 4 * i, 4), m.satellites[i].udrei);
    }
    EXPECT_EQ(bits.at(data + 96, 6), 0b01'10'11);
    expect_half(bits, data + 106, m.long_term);
    EXPECT_EQ(again(m), SbasMessage(m));
}

TEST(SbasMessage, OfRegions) {
    SbasServiceRegions m{5, 1, 0, 2, 3, 4, 15, {}};
    m.regions[0] = {20, -40, 72, 45, true};
    m.regions[4] = {-90, -180, 90, 179, false};
    const SentBits bits(encode_sbas(m, start));
    EXPECT_EQ(bits.at(8, 6), 27);
    EXPECT_EQ(bits.text(data, 22),
              "101"
              "001"
              "000"
              "010"
              "11"
              "0100"
              "1111");
    EXPECT_EQ(bits.signed_at(data + 22, 8), 20);
    EXPECT_EQ(bits.signed_at(data + 30, 9), -40);
    EXPECT_EQ(bits.signed_at(data + 39, 8), 72);
    EXPECT_EQ(bits.signed_at(data + 47, 9), 45);
    EXPECT_EQ(bits.at(data + 56, 1), 1);
    EXPECT_EQ(bits.signed_at(data + 22 + 140, 8), -90);
    EXPECT_EQ(bits.signed_at(data + 22 + 148, 9), -180);
    EXPECT_EQ(again(m), SbasMessage(m));
}

TEST(SbasMessage, OfTypeZeroSaysNothingOrWhatIsTested) {
    EXPECT_EQ(SentBits(encode_sbas(SbasDoNotUse{}, start)).at(8, 6), 0);
    EXPECT_EQ(again(SbasDoNotUse{}), SbasMessage(SbasDoNotUse{}));
    SbasFastCorrections fast;
    fast.iodp = 1;
    fast.satellites[12] = {1.5, 3};
    const SentBits bits(encode_sbas(SbasDoNotUse{fast}, start));
    EXPECT_EQ(bits.at(8, 6), 0);
    EXPECT_EQ(bits.at(data + 2, 2), 1);
    EXPECT_EQ(bits.signed_at(data + 4 + 144, 12), 12);
    EXPECT_EQ(again(SbasDoNotUse{fast}), SbasMessage(SbasDoNotUse{fast}));
}

// Whatever is sent, within its range it is off by at most half a step, and beyond it is the last value there is.
TEST(SbasMessage, RoundsAndSaturates) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> wide(-1000, 1000);
    for (int i = 0; i < 2000; ++i) {
        const double metres = wide(random);
        SbasMixedCorrections m;
        m.satellites[0].range_m = metres;
        m.long_term.satellites[0] = {1, 0, {metres, 0, 0}, metres * 1e-9};
        SbasIonosphere grid;
        grid.points[0] = {std::abs(metres), 0};
        const auto mixed = std::get<SbasMixedCorrections>(*again(m));
        const SbasLongTermCorrection& slow = mixed.long_term.satellites[0];
        EXPECT_LE(std::abs(mixed.satellites[0].range_m - std::clamp(metres, -256.0, 255.875)), 0.0625);
        EXPECT_LE(std::abs(slow.position_m[0] - std::clamp(metres, -32.0, 31.875)), 0.0625);
        const double step = std::ldexp(1.0, -31);
        EXPECT_LE(std::abs(slow.clock_s - std::clamp(metres * 1e-9, -512 * step, 511 * step)), step / 2);
        const auto delay = std::get<SbasIonosphere>(*again(grid)).points[0].vertical_m;
        ASSERT_TRUE(delay) << "a long delay is no missing one";
        EXPECT_LE(std::abs(*delay - std::min(std::abs(metres), 63.75)), 0.0625);
    }
    SbasFastCorrections wrong;
    wrong.satellites[0].range_m = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(std::get<SbasFastCorrections>(*again(wrong)).satellites[0].range_m, 0);
}

// Any 250 bits with a good parity are read without harm, and what was read is written again as it was.
TEST(SbasMessage, ReadsWhateverComes) {
    std::mt19937 random(11);
    int known = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string bits = "01010011";
        for (int bit = 0; bit < 218; ++bit)
            bits += (random() & 1) != 0 ? '1' : '0';
        bits += remainder_of(bits) + "000000";
        std::vector<std::uint32_t> words;
        for (std::size_t at = 0; at < 256; at += 32)
            words.push_back(static_cast<std::uint32_t>(std::stoul(bits.substr(at, 32), nullptr, 2)));
        const auto message = decode_sbas(words);
        if (!message) continue;
        ++known;
        const SbasWords written = encode_sbas(*message, start);
        EXPECT_EQ(decode_sbas({written.begin(), written.end()}), message);
    }
    EXPECT_GT(known, 300);
}

TEST(SbasBounds, AreThoseOfTheTables) {
    EXPECT_EQ(sbas_udre(0), 0.75);
    EXPECT_EQ(sbas_udre(13), 150);
    EXPECT_EQ(sbas_udre_index(0), 0);
    EXPECT_EQ(sbas_udre_index(0.76), 1);
    EXPECT_EQ(sbas_udre_index(3), 5);
    EXPECT_EQ(sbas_udre_index(1e9), 13);
    EXPECT_EQ(sbas_give(14), 45);
    EXPECT_EQ(sbas_give_index(0.31), 1);
    EXPECT_EQ(sbas_give_index(1e9), 14);
    for (int i = 0; i < 14; ++i)
        EXPECT_EQ(sbas_udre_index(sbas_udre(i)), i);
    EXPECT_EQ(sbas_fast_timeout(0), Seconds(180));
    EXPECT_EQ(sbas_fast_timeout(15), Seconds(18));
}

}  // namespace
}  // namespace skyloop
