#include "world/gnss/navigation_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

const NominalConstellation nominal;

// Degrees between two angles, the short way round.
double apart_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

TEST(NominalConstellation, HasThirtyOneHealthySatellitesInSixPlanes) {
    const auto satellites = nominal.satellites();
    ASSERT_EQ(satellites.size(), 31u);
    EXPECT_TRUE(std::is_sorted(satellites.begin(), satellites.end()));
    std::set<char> planes;
    std::set<std::string_view> names;
    for (const NominalSlot& slot : NominalConstellation::slots()) {
        planes.insert(slot.name[0]);
        names.insert(slot.name);
    }
    EXPECT_EQ(planes, (std::set<char>{'A', 'B', 'C', 'D', 'E', 'F'}));
    EXPECT_EQ(names.size(), 31u);
    for (const SatelliteId id : satellites) {
        const auto record = nominal.record(id, to_gps_time(2300, 12345.0));
        ASSERT_TRUE(record);
        EXPECT_TRUE(record->healthy());
        EXPECT_EQ(record->satellite, id);
        EXPECT_NEAR(degrees(record->i0), 55, 1e-9);
    }
    EXPECT_FALSE(nominal.span());
    EXPECT_FALSE(nominal.klobuchar());
    EXPECT_FALSE(nominal.ephemeris({Constellation::gps, 32}, GpsTime{}));
    EXPECT_FALSE(nominal.record({Constellation::gps, 0}, GpsTime{}));
    EXPECT_FALSE(nominal.record({Constellation::galileo, 1}, GpsTime{}));
}

TEST(NominalConstellation, StandsInThePublishedSlotsAtTheEpoch) {
    const GpsTime epoch = gps_calendar_time(1993, 7, 1, 0, 0, 0);
    const double tow = week_and_tow(epoch).tow_seconds();
    // Right ascensions of the planes' nodes less the Greenwich hour angle 18 h 36 min 14.4 s.
    const std::array<double, 6> nodes{272.847, 332.847, 32.847, 92.847, 152.847, 212.847};
    for (const SatelliteId id : nominal.satellites()) {
        const NominalSlot& slot = NominalConstellation::slots()[static_cast<std::size_t>(id.number - 1)];
        const auto record = nominal.record(id, epoch);
        EXPECT_EQ(record->toe, epoch);
        const double node = nodes[static_cast<std::size_t>(slot.name[0] - 'A')] - 279.06;
        EXPECT_LT(apart_deg(degrees(record->omega0 - earth_rotation_rate * tow), node), 1e-9) << slot.name;
        EXPECT_LT(apart_deg(degrees(record->m0), slot.argument_of_latitude_deg), 1e-9) << slot.name;
    }
}

TEST(NominalConstellation, OwnSatellitesStandMidwayInTheWidestGaps) {
    for (const std::string_view name : {"A5", "B5", "C5", "E5"}) {
        double nearest_before = 360;
        double nearest_after = 360;
        double own = 0;
        for (const NominalSlot& s : NominalConstellation::slots())
            if (s.name == name) own = s.argument_of_latitude_deg;
        for (const NominalSlot& s : NominalConstellation::slots()) {
            if (s.name == name || s.name[0] != name[0]) continue;
            nearest_after = std::min(nearest_after, std::fmod(s.argument_of_latitude_deg - own + 360, 360));
            nearest_before = std::min(nearest_before, std::fmod(own - s.argument_of_latitude_deg + 360, 360));
        }
        EXPECT_NEAR(nearest_before, nearest_after, 1e-3) << name;
        EXPECT_GT(nearest_before, 50) << name;
    }
}

TEST(NominalConstellation, RunsOnSmoothlyFromRecordToRecord) {
    // Ordinary even hours, week ends, before the epoch, and decades away from it.
    const std::array instants{gps_calendar_time(1985, 3, 4, 6, 0, 0),  gps_calendar_time(1993, 7, 1, 0, 0, 0),
                              gps_calendar_time(2019, 4, 7, 0, 0, 0),  gps_calendar_time(2024, 3, 5, 12, 0, 0),
                              gps_calendar_time(2024, 3, 10, 0, 0, 0), gps_calendar_time(2049, 12, 31, 22, 0, 0)};
    for (const GpsTime t : instants)
        for (const SatelliteId id : nominal.satellites()) {
            const auto before = nominal.record(id, t - 1ns);
            const auto after = nominal.record(id, t);
            ASSERT_EQ(after->toe, t);
            ASSERT_EQ(before->toe, t - 2h);
            ASSERT_NE(before->iode, after->iode);
            const Displacement<Ecef> step = satellite_state(*before, t).position - satellite_state(*after, t).position;
            EXPECT_LT(step.length().value(), 1e-5) << to_string(id);
        }
}

TEST(NominalConstellation, FliesAtTheAltitudeOfGps) {
    const GpsTime start = gps_calendar_time(2024, 3, 5, 0, 0, 0);
    for (const SatelliteId id : nominal.satellites())
        for (int minute = 0; minute < 1440; minute += 60) {
            const GpsTime t = start + std::chrono::minutes(minute);
            const SatelliteState state = satellite_state(*nominal.record(id, t), t);
            EXPECT_NEAR(state.position.vector().norm() - 6378.137e3, 20180e3, 5e3);
            EXPECT_EQ(state.clock_bias, 0);
        }
}

TEST(NominalConstellation, ShowsAtLeastSixSatellitesEverywhere) {
    const GpsTime start = gps_calendar_time(2024, 3, 5, 0, 0, 0);
    std::size_t fewest = 31;
    std::size_t fewest_planes = 6;
    double sum = 0;
    int skies = 0;
    for (int minute = 0; minute < 1440; minute += 30) {
        const GpsTime t = start + std::chrono::minutes(minute);
        std::vector<Position<Ecef>> positions;
        for (const SatelliteId id : nominal.satellites())
            positions.push_back(satellite_state(*nominal.record(id, t), t).position);
        for (int latitude = -90; latitude <= 90; latitude += 15)
            for (int longitude = -180; longitude < 180; longitude += 30) {
                const LocalFrame place(Geodetic::degrees(latitude, longitude, 0));
                std::size_t seen = 0;
                std::set<char> planes;
                for (std::size_t i = 0; i < positions.size(); ++i) {
                    if (place.look_angles(positions[i]).elevation.deg() < 5) continue;
                    ++seen;
                    planes.insert(NominalConstellation::slots()[i].name[0]);
                }
                fewest = std::min(fewest, seen);
                fewest_planes = std::min(fewest_planes, planes.size());
                sum += static_cast<double>(seen);
                ++skies;
            }
    }
    EXPECT_GE(fewest, 6u);
    EXPECT_GE(fewest_planes, 4u);
    EXPECT_GT(sum / skies, 9);
}

}  // namespace
}  // namespace skyloop::test
