#include "world/sky/observe_sky.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/signal.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

TruthState standing_at(const Geodetic& place, GpsTime time) { return {time, to_ecef(place), {}, place}; }

TruthState moving_from(const Geodetic& place, GpsTime time, const Velocity<Enu>& velocity) {
    return {time, to_ecef(place), LocalFrame(place).to_ecef(velocity), place};
}

// "2020-06-25T10:07:00" of GPS time.
GpsTime gps_text(const std::string& text) { return to_gps_time(parse_utc(text).value(), LeapSeconds::constant(0)); }

// The records of a scene's files, which ';' parts.
NavigationData scene_data(const std::string& files, const EphemerisSelection& selection = {}) {
    std::vector<Ephemeris> records;
    std::istringstream names(files);
    for (std::string name; std::getline(names, name, ';');) {
        const auto file = read_navigation_file(shared_data("oracles/nav/" + name).value());
        EXPECT_TRUE(file) << file.error().message;
        records.insert(records.end(), file->records.begin(), file->records.end());
    }
    return NavigationData(records, std::nullopt, files, selection);
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

TruthState scene_truth(const OracleRow& row) {
    const Geodetic place = Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m"));
    return standing_at(place, gps_text(row.text("gpst")));
}

TEST(ObserveSky, SeesTheSatellitesOfTheScenes) {
    SKYLOOP_REQUIRE_SHARED(nav, "oracles/nav");
    int scenes = 0;
    for (const OracleRow& row : oracle_rows("scenario_summary.csv")) {
        SCOPED_TRACE(row.id());
        const SkyView sky = observe_sky(scene_truth(row), scene_data(row.text("nav_files")));
        std::vector<std::string> seen;
        for (const SatelliteInView& s : sky.satellites)
            if (s.id.constellation != Constellation::sbas && s.healthy && s.elevation.deg() >= 5)
                seen.push_back(to_string(s.id));
        std::sort(seen.begin(), seen.end());
        EXPECT_EQ(seen, words_of(row.text("satellites")));
        const auto count = [&](char letter) {
            return std::count_if(seen.begin(), seen.end(), [&](const std::string& s) { return s[0] == letter; });
        };
        EXPECT_EQ(count('G'), row.integer("n_gps_ge5deg_healthy"));
        EXPECT_EQ(count('E'), row.integer("n_gal"));
        EXPECT_EQ(count('C'), row.integer("n_bds"));
        EXPECT_EQ(count('R'), row.integer("n_glo"));
        ++scenes;
    }
    EXPECT_EQ(scenes, 5);
}

// By the rule of the baseline: of GPS, not before its toe nor 7200 s after it (MODELS.md D-02, D-19).
TEST(ObserveSky, SeesTheSatellitesOfTheErrorScale) {
    SKYLOOP_REQUIRE_SHARED(nav, "oracles/nav");
    int scenes = 0;
    for (const OracleRow& row : oracle_rows("paper_error_scale.csv")) {
        SCOPED_TRACE(row.id());
        const NavigationData data = scene_data(row.text("nav_files"), {EphemerisRule::forward, Seconds(7200)});
        std::vector<std::string> used;
        for (const SatelliteInView& s : observe_sky(scene_truth(row), data).satellites)
            if (s.id.constellation == Constellation::gps && s.healthy && s.elevation.deg() >= 5)
                used.push_back(to_string(s.id));
        std::sort(used.begin(), used.end());
        EXPECT_EQ(used, words_of(row.text("satellites")));
        ++scenes;
    }
    EXPECT_EQ(scenes, 5);
}

void check_scene_satellite(const OracleRow& row, const SatelliteInView& seen) {
    const double metres = row.number("tol_m");
    const double angle = row.number("tol_deg");
    EXPECT_NEAR(seen.elevation.deg(), row.number("el_deg"), angle);
    EXPECT_NEAR(std::remainder(seen.azimuth.deg() - row.number("az_deg"), 360.0), 0, angle);
    EXPECT_NEAR(seen.position_at_transmission.vector().x(), row.number("sat_x_at_tx_m"), metres);
    EXPECT_NEAR(seen.position_at_transmission.vector().y(), row.number("sat_y_at_tx_m"), metres);
    EXPECT_NEAR(seen.position_at_transmission.vector().z(), row.number("sat_z_at_tx_m"), metres);
    EXPECT_NEAR(seen.range.value(), row.number("geometric_range_m"), metres);
    EXPECT_NEAR(seen.travel_time.value(), row.number("travel_time_s"), metres / speed_of_light);
    EXPECT_NEAR(seen.clock_bias.value(), row.number("sat_clk_s"), metres / speed_of_light);
    EXPECT_EQ(seen.group_delay().value(), row.number("tgd_s"));
    const double pseudorange = seen.range.value() - speed_of_light * (seen.clock_bias - seen.group_delay()).value();
    EXPECT_NEAR(pseudorange, row.number("pseudorange_clean_m"), metres);
    EXPECT_NEAR(seen.range_rate.value(), row.number("range_rate_m_s"), row.number("tol_m_s"));
    EXPECT_EQ(seen.healthy, row.integer("healthy") == 1);
    EXPECT_EQ(seen.toe, advanced(GpsTime{}, Seconds(row.number("eph_toe_gpst_total_s"))));
    // The table does not tell the issue of GLONASS records.
    if (!row.empty("eph_iode")) {
        EXPECT_EQ(seen.iode, row.integer("eph_iode"));
    }
    const double carrier = row.number("f_carrier_Hz");
    EXPECT_NEAR(-seen.range_rate.value() / speed_of_light * carrier, row.number("doppler_geometric_Hz"),
                row.number("tol_m_s") / speed_of_light * carrier);
}

// The carrier of the system's first signal, for GLONASS that of the satellite's channel.
double first_carrier(const NavigationData& data, SatelliteId id, GpsTime time) {
    const auto record = data.ephemeris(id, time);
    const auto* glonass = record ? std::get_if<GlonassEphemeris>(&*record) : nullptr;
    return carrier_frequency(first_signal(id.constellation), glonass != nullptr ? glonass->frequency_channel : 0)
        .value();
}

TEST(ObserveSky, AgreesWithTheSatellitesOfTheScenes) {
    SKYLOOP_REQUIRE_SHARED(nav, "oracles/nav");
    int checked = 0;
    std::map<std::string, SkyView> skies;
    std::map<std::string, NavigationData> sources;
    for (const OracleRow& row : oracle_rows("scenario_satellites.csv")) {
        const SatelliteId id = parse_satellite(row.text("sat")).value();
        SCOPED_TRACE(row.id());
        const std::string files = row.text("nav_files");
        if (!sources.contains(files)) sources.emplace(files, scene_data(files));
        const NavigationData& data = sources.at(files);
        const TruthState truth = scene_truth(row);
        EXPECT_EQ(first_carrier(data, id, truth.time), row.number("f_carrier_Hz"));
        const auto [entry, first] = skies.try_emplace(row.text("scenario"));
        if (first) entry->second = observe_sky(truth, data);
        const auto& seen = entry->second.satellites;
        const auto found = std::find_if(seen.begin(), seen.end(), [&](const auto& s) { return s.id == id; });
        ASSERT_NE(found, seen.end());
        check_scene_satellite(row, *found);
        ++checked;
    }
    EXPECT_EQ(checked, 154);
}

TEST(ObserveSky, LightTimeIsConsistent) {
    const NominalConstellation source;
    const Geodetic place = Geodetic::degrees(-33.9, 151.2, 58);
    const TruthState truth = standing_at(place, to_gps_time(2304, 216000.123));
    const SkyView sky = observe_sky(truth, source);
    ASSERT_GE(sky.satellites.size(), 6u);
    EXPECT_TRUE(std::is_sorted(sky.satellites.begin(), sky.satellites.end(),
                               [](const auto& a, const auto& b) { return a.id < b.id; }));
    for (const SatelliteInView& s : sky.satellites) {
        EXPECT_GE(s.elevation.rad(), 0);
        EXPECT_NEAR(s.range.value(), speed_of_light * s.travel_time.value(), 1e-7);
        const auto record = source.ephemeris(s.id, truth.time);
        const SatelliteState then = satellite_state(*record, truth.time, -s.travel_time);
        EXPECT_LT((then.position - s.position_at_transmission).length().value(), 1e-6);
        const Position<Ecef> seen_at = in_reception_frame(s.position_at_transmission, s.travel_time);
        EXPECT_NEAR((seen_at - truth.position).length().value(), s.range.value(), 1e-7);
        const LookAngles look = LocalFrame(place).look_angles(s.position_at_transmission);
        EXPECT_NEAR(look.elevation.rad(), s.elevation.rad(), 1e-12);
        EXPECT_NEAR(look.azimuth.rad(), s.azimuth.rad(), 1e-12);
        EXPECT_NEAR(LocalFrame(place).look_angles(seen_at).elevation.deg(), s.elevation.deg(), 4e-4);
    }
}

TEST(ObserveSky, RangeRateIsTheDerivativeOfRange) {
    const NominalConstellation source;
    const Geodetic place = Geodetic::degrees(46.4775, 30.7326, 77);
    const GpsTime time = to_gps_time(2304, 216000.0 + 3000);
    const TruthState truth = moving_from(place, time, Velocity<Enu>(200, -120, 15));
    const auto shifted = [&](double seconds) {
        TruthState t = truth;
        t.time = advanced(time, Seconds(seconds));
        t.position = Position<Ecef>(truth.position.vector() + seconds * truth.velocity.vector());
        t.geodetic = to_geodetic(t.position);
        return observe_sky(t, source);
    };
    const SkyView now = observe_sky(truth, source);
    const SkyView before = shifted(-0.5);
    const SkyView after = shifted(0.5);
    ASSERT_EQ(before.satellites.size(), now.satellites.size());
    ASSERT_EQ(after.satellites.size(), now.satellites.size());
    for (std::size_t i = 0; i < now.satellites.size(); ++i) {
        const double derivative = (after.satellites[i].range - before.satellites[i].range).value();
        EXPECT_NEAR(now.satellites[i].range_rate.value(), derivative, 2e-5) << to_string(now.satellites[i].id);
    }
}

TEST(ObserveSky, LeavesOutSatellitesWithoutARecord) {
    const NominalConstellation nominal;
    const GpsTime time = to_gps_time(2304, 216000.0);
    std::vector<Ephemeris> records;
    for (const SatelliteId id : nominal.satellites())
        records.push_back(*nominal.ephemeris(id, time));
    const TruthState truth = standing_at(Geodetic::degrees(46.4775, 30.7326, 77), time);
    std::get<KeplerEphemeris>(records[4]).health = 1;
    const NavigationData nearest(records, std::nullopt, "test");
    const NavigationData forward(records, std::nullopt, "test", {.rule = EphemerisRule::forward});
    const SkyView all = observe_sky(truth, nominal);
    EXPECT_EQ(observe_sky(truth, nearest).satellites.size(), all.satellites.size());
    TruthState late = truth;
    late.time = time + 3h;
    EXPECT_TRUE(observe_sky(late, nearest).satellites.empty());
    late.time = time - 1h;
    EXPECT_TRUE(observe_sky(late, forward).satellites.empty());
    for (const SatelliteInView& s : observe_sky(truth, nearest).satellites)
        EXPECT_EQ(s.healthy, s.id.number != 5);
    for (const SatelliteInView& s : observe_sky(truth, forward).satellites)
        EXPECT_NE(s.id.number, 5);
}

TEST(ObserveSky, HasNoStepAtMidnightOrTheEndOfTheWeek) {
    const NominalConstellation source;
    const Geodetic place = Geodetic::degrees(52.52, 13.405, 74);
    for (const GpsTime border : {to_gps_time(2304, 0.0), to_gps_time(2304, 86400.0), to_gps_time(2048, 0.0)}) {
        const SkyView before = observe_sky(standing_at(place, border - 1ms), source);
        const SkyView after = observe_sky(standing_at(place, border), source);
        ASSERT_EQ(before.satellites.size(), after.satellites.size());
        for (std::size_t i = 0; i < after.satellites.size(); ++i) {
            const double step = (after.satellites[i].range - before.satellites[i].range).value();
            EXPECT_NEAR(step, after.satellites[i].range_rate.value() * 1e-3, 1e-5);
        }
    }
}

void expect_same_sky(const SkyView& one, const SkyView& other) {
    ASSERT_EQ(one.satellites.size(), other.satellites.size());
    for (std::size_t i = 0; i < one.satellites.size(); ++i) {
        EXPECT_EQ(one.satellites[i].id, other.satellites[i].id);
        EXPECT_EQ(one.satellites[i].range, other.satellites[i].range);
        EXPECT_EQ(one.satellites[i].clock_bias, other.satellites[i].clock_bias);
    }
}

// An observer that remembers gives bit by bit what one without a memory gives, on a flight and after a leap.
TEST(SkyObserver, GivesWhatAFirstLookGives) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    const auto file = read_navigation_file(nav);
    ASSERT_TRUE(file);
    const NavigationData data(file->records, file->ionosphere, "day");
    const GpsTime start = gps_text("2023-01-01T10:07:00");
    SkyObserver observer;
    std::size_t seen = 0;
    for (int k = 0; k < 240; ++k) {
        const double jump = k < 200 ? 0 : 40;  // degrees of longitude
        const Geodetic place = Geodetic::degrees(48 + 0.002 * k, 11 + jump, 9000);
        const TruthState truth = moving_from(place, start + 37s * k, {0, 250, 0});
        const SkyView sky = observer.observe(truth, data);
        expect_same_sky(sky, observe_sky(truth, data));
        seen = std::max(seen, sky.satellites.size());
    }
    EXPECT_GT(seen, 40U);
}

TEST(SkyObserver, LooksAgainWhenTimeGoesBack) {
    const NominalConstellation nominal;
    SkyObserver observer;
    const GpsTime noon = gps_text("2026-03-01T12:00:00");
    const Geodetic odessa = Geodetic::degrees(46.4775, 30.7326, 77);
    for (const auto hours : {0h, 5h, 1h, 30h})
        expect_same_sky(observer.observe(standing_at(odessa, noon + hours), nominal),
                        observe_sky(standing_at(odessa, noon + hours), nominal));
}

}  // namespace
}  // namespace skyloop::test
