// The nominal sky against the broadcasts of the day that it was placed by, and of a year later:
// ctest -R NominalSkyDay -V prints the table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/foreign_records.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/nominal_sky.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

using Elevations = std::map<SatelliteId, double>;

const std::vector<Constellation> compared{Constellation::gps,  Constellation::galileo, Constellation::beidou,
                                          Constellation::qzss, Constellation::glonass, Constellation::navic};
const std::vector<std::pair<double, double>> places{{46.5, 30.7},  {52.4, 13.1},   {69.6, 18.9},   {1.3, 103.9},
                                                    {35.7, 139.7}, {-33.9, 151.2}, {-16.5, -71.5}, {40.7, -74.0},
                                                    {-33.9, 18.4}, {19.1, 72.9}};

// Of healthy satellites above 5°, degrees.
Elevations elevations(const NavigationSource& source, std::pair<double, double> place, GpsTime time) {
    const LocalFrame frame(Geodetic::degrees(place.first, place.second, 0));
    Elevations seen;
    for (const SatelliteId id : source.satellites()) {
        const auto record = source.ephemeris(id, time);
        if (!record || !is_healthy(*record)) continue;
        const double elevation = frame.look_angles(satellite_state(*record, time).position).elevation.deg();
        if (elevation > 5) seen[id] = elevation;
    }
    return seen;
}

std::map<Constellation, int> counts_of(const Elevations& seen) {
    std::map<Constellation, int> counts;
    for (const auto& [id, elevation] : seen)
        ++counts[id.constellation];
    return counts;
}

NavigationData broadcasts_of(const std::filesystem::path& path) {
    auto file = read_navigation_file(path);
    if (!file) throw std::runtime_error(file.error().message);
    drop_foreign_records(file->records);
    return NavigationData(file->records, std::nullopt, path.filename().string());
}

TEST(NominalSkyDay, ShowsAsManySatellitesAsTheDayItIsOf) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    const NavigationData day = broadcasts_of(path);
    const NominalSky sky(compared);
    for (const auto& place : places)
        for (int hour = 3; hour <= 21; hour += 6) {
            const GpsTime time = to_gps_time(2243, hour * 3600.0);
            const Elevations real = elevations(day, place, time), nominal = elevations(sky, place, time);
            auto wanted = counts_of(real), found = counts_of(nominal);
            for (const Constellation c : compared)
                EXPECT_NEAR(found[c], wanted[c], c == Constellation::gps ? 5 : 2)  // GPS has its published slots
                    << constellation_name(c) << " at " << place.first << " " << place.second;
            int common = 0, near = 0;
            for (const auto& [id, elevation] : real)
                if (const auto same = nominal.find(id);
                    same != nominal.end() && id.constellation != Constellation::gps) {
                    ++common;
                    near += std::abs(same->second - elevation) < 3 ? 1 : 0;
                }
            EXPECT_GE(near, common - 1) << "of those that both have, but for GPS";
        }
}

// Counts stay alike as the satellites are kept in their slots.
TEST(NominalSkyDay, HoldsForYears) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz");
    const NavigationData day = broadcasts_of(path);
    const NominalSky sky(compared);
    std::map<Constellation, double> wanted, found;
    int skies = 0;
    for (const auto& place : places)
        for (int hour = 1; hour < 24; hour += 2, ++skies) {
            const GpsTime time = to_gps_time(2295, 86400 + hour * 3600.0);
            for (const auto& [system, count] : counts_of(elevations(day, place, time)))
                wanted[system] += count;
            for (const auto& [system, count] : counts_of(elevations(sky, place, time)))
                found[system] += count;
        }
    for (const Constellation c : compared) {
        fmt::print("{:8} of the day {:5.2f}, nominal {:5.2f}\n", constellation_name(c), wanted[c] / skies,
                   found[c] / skies);
        EXPECT_NEAR(found[c] / skies, wanted[c] / skies, 1) << constellation_name(c);
    }
}

}  // namespace
}  // namespace skyloop::test
