#include "world/gnss/nominal_sky.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/time/utc_time.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using System = Constellation;

const NominalSky whole_sky({System::gps, System::sbas, System::galileo, System::beidou, System::qzss, System::glonass,
                            System::navic});

std::size_t count_of(Constellation constellation) {
    const std::vector<SatelliteId> all = whole_sky.satellites();
    return static_cast<std::size_t>(
        std::ranges::count_if(all, [&](SatelliteId id) { return id.constellation == constellation; }));
}

TEST(NominalSky, HasWhatIsInService) {
    EXPECT_EQ(count_of(System::gps), 31U);
    EXPECT_EQ(count_of(System::galileo), 24U);
    EXPECT_EQ(count_of(System::glonass), 24U);
    EXPECT_EQ(count_of(System::beidou), 43U);
    EXPECT_EQ(count_of(System::qzss), 4U);
    EXPECT_EQ(count_of(System::navic), 4U);
    EXPECT_EQ(count_of(System::sbas), 16U);
    EXPECT_TRUE(std::ranges::is_sorted(whole_sky.satellites()));
    EXPECT_FALSE(whole_sky.span());
    EXPECT_EQ(NominalSky({System::galileo, System::gps}).description(), "nominal GPS, Galileo constellations");
    EXPECT_EQ(NominalSky({System::gps}).description(), "nominal GPS constellation");
    EXPECT_FALSE(NominalSky({System::gps}).ephemeris({System::galileo, 1}, GpsTime{}));
    EXPECT_FALSE(whole_sky.ephemeris({System::galileo, 14}, GpsTime{}));
}

TEST(NominalSky, EachRecordIsAHealthyOneOfItsTime) {
    for (const GpsTime t : {gps_calendar_time(2012, 7, 1, 3, 4, 5), gps_calendar_time(2026, 12, 1, 23, 59, 59)})
        for (const SatelliteId id : whole_sky.satellites()) {
            const auto record = whole_sky.ephemeris(id, t);
            ASSERT_TRUE(record) << to_string(id);
            EXPECT_TRUE(is_healthy(*record)) << to_string(id);
            EXPECT_EQ(satellite_of(*record), id);
            EXPECT_LE(std::chrono::abs(t - toe_of(*record)), 2h) << to_string(id);
            EXPECT_EQ(satellite_state(*record, t).clock_drift * 0, 0) << to_string(id);
        }
}

// Below the step over which a run leads its satellites (10 m); to millimetres but for GLONASS, whose records are
// integrated.
TEST(NominalSky, RunsOnFromRecordToRecord) {
    for (const GpsTime start : {gps_calendar_time(1999, 12, 31, 23, 0, 0), gps_calendar_time(2023, 1, 1, 0, 0, 0),
                                gps_calendar_time(2049, 6, 5, 11, 0, 0)})
        for (const SatelliteId id : whole_sky.satellites()) {
            std::optional<Ephemeris> before = whole_sky.ephemeris(id, start);
            int changes = 0;
            for (GpsTime t = start; t < start + 4h + 1min; t += 60s) {
                const auto now = whole_sky.ephemeris(id, t);
                if (toe_of(*now) != toe_of(*before)) {
                    ++changes;
                    const auto step = satellite_state(*before, t).position - satellite_state(*now, t).position;
                    EXPECT_LT(step.length().value(), id.constellation == System::glonass ? 5 : 1e-3) << to_string(id);
                }
                before = now;
            }
            EXPECT_GE(changes, 2) << to_string(id);
        }
}

TEST(NominalSky, GeostationarySatellitesStandStill) {
    const std::vector<std::pair<SatelliteId, double>> places{
        {{System::sbas, 23}, 31.5}, {{System::beidou, 59}, 140}, {{System::qzss, 7}, 127}, {{System::navic, 6}, 32.4}};
    for (const auto& [id, longitude] : places)
        for (const GpsTime t : {gps_calendar_time(2019, 4, 7, 0, 0, 0), gps_calendar_time(2026, 12, 1, 17, 0, 0)}) {
            const SatelliteState state = satellite_state(*whole_sky.ephemeris(id, t), t + 7min);
            const auto& p = state.position.vector();
            EXPECT_NEAR(std::atan2(p.y(), p.x()) * 180 / std::numbers::pi, longitude, 1e-6) << to_string(id);
            EXPECT_NEAR(p.z(), 0, 1) << to_string(id);
            EXPECT_NEAR(p.norm(), 42164.2e3, 10) << to_string(id);
            EXPECT_LT(state.velocity.length().value(), 1e-3) << to_string(id);
        }
}

// Each satellite is over the same place again after so many days, less the four minutes of each.
TEST(NominalSky, GroundTracksRepeat) {
    const std::vector<std::pair<SatelliteId, int>> cycles{
        {{System::galileo, 11}, 10}, {{System::beidou, 23}, 7}, {{System::glonass, 5}, 8}, {{System::qzss, 2}, 1}};
    for (const auto& [id, days] : cycles) {
        const GpsTime t = gps_calendar_time(2024, 3, 5, 0, 0, 0);
        const auto place = [&, satellite = id](GpsTime at) {
            return satellite_state(*whole_sky.ephemeris(satellite, at), at).position;
        };
        // The nodes drift, so that a day is shorter than a sidereal one by up to eight seconds.
        double nearest = 1e9;
        for (double less = 235; less < 246; less += 0.25)
            nearest =
                std::min(nearest, (place(advanced(t, Seconds(days * (86400 - less)))) - place(t)).length().value());
        EXPECT_LT(nearest, 5e3) << to_string(id);
    }
}

}  // namespace
}  // namespace skyloop::test
