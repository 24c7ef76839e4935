// The strings 6 to 15, taken apart by table 4.9 of the ICD, against the orbits of the records.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support/four_systems.hpp"
#include "support/page_bits.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

using test::PageBits;

constexpr double half_circle = std::numbers::pi;

// A field from its highest bit on, as the ICD numbers them from 85 down, with its sign in front.
double signed_field(const PageBits& string, int high, int width, int exponent) {
    const auto at = static_cast<std::size_t>(85 - high);
    const double magnitude = string.positive(at + 1, width - 1, exponent);
    return string.field(at, 1) != 0 ? -magnitude : magnitude;
}

GlonassAlmanac almanac_of(const PageBits& even, const PageBits& odd) {
    GlonassAlmanac a;
    a.healthy = even.field(85 - 80, 1) == 1;
    a.satellite = {Constellation::glonass, static_cast<int>(even.field(85 - 77, 5))};
    a.time_correction = signed_field(even, 72, 10, -18);
    a.node_longitude = half_circle * signed_field(even, 62, 21, -20);
    a.inclination = half_circle * (63 / 180.0 + signed_field(even, 41, 18, -20));
    a.eccentricity = even.positive(85 - 23, 15, -20);
    a.perigee = half_circle * signed_field(odd, 80, 16, -15);
    a.node_time = odd.positive(85 - 64, 21, -5);
    a.draconic_period = 43200 + signed_field(odd, 43, 22, -9);
    const auto channel = static_cast<int>(odd.field(85 - 14, 5));
    a.frequency_channel = channel >= 25 ? channel - 32 : channel;
    return a;
}

// Where the almanac says that the satellite is: from the node on an ellipse whose node drifts (A.3.2.1, without the
// short-period terms).
Eigen::Vector3d place_of(const GlonassAlmanac& a, double second_of_day) {
    const double gravity = gravitational_constant_glonass, rate = 2 * std::numbers::pi / a.draconic_period;
    const double axis = std::cbrt(gravity / (rate * rate)), p = axis * (1 - a.eccentricity * a.eccentricity);
    const double drift = -1.5 * second_zonal_harmonic_glonass * std::pow(equatorial_radius_glonass / p, 2) * rate *
                         std::cos(a.inclination);
    const double passed = second_of_day - a.node_time;
    const auto eccentric = [&a](double truly) {
        return std::atan2(std::sqrt(1 - a.eccentricity * a.eccentricity) * std::sin(truly),
                          std::cos(truly) + a.eccentricity);
    };
    const double start = eccentric(-a.perigee), mean = start - a.eccentricity * std::sin(start) + rate * passed;
    double e = mean;
    for (int i = 0; i < 10; ++i)
        e = mean + a.eccentricity * std::sin(e);
    const double u = a.perigee + std::atan2(std::sqrt(1 - a.eccentricity * a.eccentricity) * std::sin(e),
                                            std::cos(e) - a.eccentricity);
    const double r = axis * (1 - a.eccentricity * std::cos(e));
    const double node = a.node_longitude + (drift - earth_rotation_rate_glonass) * passed;
    return {r * (std::cos(u) * std::cos(node) - std::sin(u) * std::sin(node) * std::cos(a.inclination)),
            r * (std::cos(u) * std::sin(node) + std::sin(u) * std::cos(node) * std::cos(a.inclination)),
            r * std::sin(u) * std::sin(a.inclination)};
}

TEST(GlonassAlmanac, AllSatellitesInTwoMinutesAndAHalf) {
    const test::FourSystems source({Constellation::glonass});
    const LeapSeconds& leap = LeapSeconds::announced();
    // 18 s after a whole superframe of GLONASS time, 09:10 of its day.
    const GpsTime begin = to_gps_time(2300, 86400.0 * 2 + 150 * 147 + 18);
    const double of_day = 150 * 147 + 3 * 3600;
    GlonassAlmanacStrings strings;
    std::map<int, GlonassAlmanac> told;
    PageBits even;
    for (int second = 2; second <= 150; second += 2) {
        const GpsTime end = begin + std::chrono::seconds(second);
        const int string = glonass_string_ending(end, leap).value();
        if (string < 6) continue;
        const auto sender = std::get<GlonassEphemeris>(*source.ephemeris({Constellation::glonass, 3}, end));
        const GlonassWords words = strings.at(source, sender, string, end, leap);
        const PageBits bits{{words.begin(), words.end()}};
        EXPECT_EQ(bits.field(1, 4), static_cast<unsigned>(string));
        if (string % 2 == 0) even = bits;
        if (string % 2 != 0 && second < 150) told[told.empty() ? 1 : told.rbegin()->first + 1] = almanac_of(even, bits);
        if (second > 146) {
            EXPECT_EQ(bits.field(5, 64), 0u) << "of the fifth frame only four satellites";
        }
    }
    ASSERT_EQ(told.size(), 24u);
    for (const auto& [number, almanac] : told) {
        EXPECT_EQ(almanac.satellite.number, number);
        EXPECT_TRUE(almanac.healthy);
        EXPECT_EQ(almanac.frequency_channel, number % 14 - 7);
        EXPECT_GE(almanac.node_time, 0);
        EXPECT_LT(almanac.node_time, almanac.draconic_period);
        const auto record = std::get<GlonassEphemeris>(*source.ephemeris({Constellation::glonass, number}, begin));
        EXPECT_NEAR(almanac.time_correction, -record.clock_bias, 4e-6);
        for (int later = 0; later <= 1800; later += 600) {
            const Eigen::Vector3d is = satellite_state(record, begin + std::chrono::seconds(later)).position.vector();
            EXPECT_LT((is - place_of(almanac, of_day + later)).norm(), 30e3) << number << " after " << later;
        }
    }
}

TEST(GlonassAlmanac, ASatelliteThatIsNotThereIsNought) {
    class Nobody : public test::FourSystems {
    public:
        [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId, GpsTime) const override { return std::nullopt; }
    } nobody;
    GlonassEphemeris ill;
    ill.health = 4;
    GlonassAlmanacStrings strings;
    const GpsTime end = to_gps_time(2300, 150000.0 + 18 + 14);
    const GlonassWords words = strings.at(nobody, ill, 7, end, LeapSeconds::announced());
    const PageBits bits{{words.begin(), words.end()}};
    EXPECT_EQ(bits.field(5, 71), 0u);
    EXPECT_EQ(bits.field(76, 1), 1u) << "the sender's own health";
}

}  // namespace
}  // namespace skyloop
