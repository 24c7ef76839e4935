#include "study/analysis/sky_listing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SatelliteInView seen(SatelliteId id, double azimuth, double elevation) {
    SatelliteInView s;
    s.id = id;
    s.azimuth = Angle::degrees(azimuth);
    s.elevation = Angle::degrees(elevation);
    s.range = Metres(21234567.891);
    s.range_rate = MetresPerSecond(-500);
    s.toe = to_gps_time(1590, 388800.0);
    s.iode = 42;
    if (id.constellation == Constellation::gps)
        s.signals.push_back({Signal::l1, carrier_frequency(Signal::l1), Seconds(0)});
    return s;
}

TruthState listed_truth() {
    TruthState truth;
    truth.time = to_gps_time({2010, 7, 1, 12, 0, 0, 0}, LeapSeconds::announced());
    truth.geodetic = Geodetic::degrees(46.4775, 30.7326, 77);
    truth.position = to_ecef(truth.geodetic);
    return truth;
}

SatelliteId listed_gps(int number) { return {Constellation::gps, number}; }

SkyView listed_sky() {
    SkyView sky;
    sky.satellites = {seen(listed_gps(2), 10, 60),       seen(listed_gps(7), 90, 5),
                      seen(listed_gps(9), 180, 30),      seen(listed_gps(12), 270, 45),
                      seen(listed_gps(20), 359.97, 4.9), seen({Constellation::glonass, 3}, 200, 70)};
    sky.satellites[3].healthy = false;
    return sky;
}

TEST(SkyListing, uses_healthy_satellites_at_or_above_the_mask) {
    const SkyListing listing = sky_listing(listed_truth(), listed_sky(), Angle::degrees(5));
    ASSERT_EQ(listing.rows.size(), 6u);
    EXPECT_EQ(listing.used(), 4u);
    EXPECT_TRUE(listing.rows[1].used);   // exactly at the mask
    EXPECT_FALSE(listing.rows[3].used);  // unhealthy
    EXPECT_FALSE(listing.rows[4].used);  // below the mask
    ASSERT_TRUE(listing.dop);
    EXPECT_GT(listing.dop->gdop, listing.dop->pdop);
}

TEST(SkyListing, takes_hidden_satellites_and_cn0_from_arrivals_and_use_from_the_fix) {
    Arrivals arrivals;
    for (const SatelliteInView& s : listed_sky().satellites)
        arrivals.satellites.emplace_back().id = s.id;
    arrivals.satellites[0].paths = 0;
    arrivals.satellites[1].cn0 = DbHz(43.25);
    SkyListing listing = sky_listing(listed_truth(), listed_sky(), Angle::degrees(5), {&arrivals, nullptr});
    EXPECT_FALSE(listing.rows[0].used);
    EXPECT_EQ(listing.rows[1].cn0, DbHz(43.25));
    EXPECT_EQ(listing.used(), 3u);
    EXPECT_FALSE(listing.dop);

    Fix fix;
    fix.type = FixType::fix_3d;
    fix.dop.hdop = 1.25;
    fix.satellites = {{listed_gps(7), {}, {}, std::nullopt, true}, {listed_gps(9), {}, {}, std::nullopt, false}};
    listing = sky_listing(listed_truth(), listed_sky(), Angle::degrees(5), {&arrivals, &fix});
    EXPECT_EQ(listing.used(), 1u);
    EXPECT_TRUE(listing.rows[1].used);
    EXPECT_EQ(listing.dop->hdop, 1.25);
    fix.type = FixType::none;
    EXPECT_FALSE(sky_listing(listed_truth(), listed_sky(), Angle::degrees(5), {nullptr, &fix}).dop);
}

TEST(SkyListing, doppler_is_positive_for_an_approaching_satellite) {
    const auto doppler = first_doppler(seen(listed_gps(1), 0, 10));
    ASSERT_TRUE(doppler);
    EXPECT_NEAR(doppler->value(), 2627.52, 0.01);  // 500 m/s / 0.190293673 m
    EXPECT_FALSE(first_doppler(seen({Constellation::glonass, 1}, 0, 10)));
}

TEST(SkyListing, DopplerIsOfTheSatellitesOwnFirstSignal) {
    SatelliteInView glonass = seen({Constellation::glonass, 9}, 0, 10);
    glonass.signals.push_back({Signal::g1, carrier_frequency(Signal::g1, -2), Seconds(0)});
    glonass.signals.push_back({Signal::g2, carrier_frequency(Signal::g2, -2), Seconds(0)});
    EXPECT_NEAR(first_doppler(glonass)->value(), 2669.97, 0.01);  // 500 m/s, 1600.875 MHz
    SatelliteInView beidou = seen({Constellation::beidou, 5}, 0, 10);
    beidou.signals.push_back({Signal::b1i, carrier_frequency(Signal::b1i), Seconds(0)});
    EXPECT_NEAR(first_doppler(beidou)->value(), 2603.63, 0.01);  // 500 m/s, 1561.098 MHz
}

TEST(SkyListing, text_has_a_row_per_satellite_and_a_dop_line) {
    const std::string text = sky_text(sky_listing(listed_truth(), listed_sky(), Angle::degrees(5)));
    for (const char* word : {"2010-07-01T12:00:00.000Z", "GPS week 1590", "46.4775000, 30.7326000", "mask 5 deg", "G02",
                             "R03", "21234.6", "-500.0", "unhealthy", "6 above the horizon, 4 used; GDOP"})
        EXPECT_THAT(text, HasSubstr(word));
    EXPECT_THAT(text, Not(HasSubstr("360.0")));
    EXPECT_THAT(sky_text(sky_listing(listed_truth(), {}, Angle::degrees(5))),
                HasSubstr("0 above the horizon, 0 used; no DOP"));
}

TEST(SkyListing, json_and_csv_hold_every_satellite) {
    const SkyListing listing = sky_listing(listed_truth(), listed_sky(), Angle::degrees(5));
    const std::string json = sky_json(listing);
    for (const char* word :
         {"\"satellite\": \"G02\"", "\"healthy\": false", "\"gps_week\": 1590", "\"tow_s\": 388800.0", "\"hdop\"",
          "\"doppler_hz\": null", "\"cn0_dbhz\": null", "\"used\": 4"})
        EXPECT_THAT(json, HasSubstr(word));
    const std::string csv = sky_csv(std::vector{listing, listing});
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
    EXPECT_THAT(csv, HasSubstr("time_utc,satellite,azimuth_deg,elevation_deg,range_m,range_rate_mps,"));
    EXPECT_THAT(
        csv, HasSubstr("\n2010-07-01T12:00:00.000Z,G12,270.000000,45.000000,21234567.891,-500.0000,2627.518,,0,0,1590,"
                       "388800.000,42,,,,\n"));
    EXPECT_THAT(csv, HasSubstr("R03,200.000000,70.000000,21234567.891,-500.0000,,,1,1,"));
}

TEST(SatelliteTrack, csv_is_ordered_by_time_then_satellite) {
    const GpsTime start = listed_truth().time;
    const std::vector<SatelliteTrack> tracks{
        {listed_gps(9), {{start, Position<Ecef>(1, 2, 3)}, {start + std::chrono::hours(1), Position<Ecef>(4, 5, 6)}}},
        {listed_gps(2), {{start, Position<Ecef>(-7.0004, 8, 9)}}}};
    EXPECT_EQ(tracks_csv(tracks),
              "time_utc,satellite,x_m,y_m,z_m\n"
              "2010-07-01T12:00:00.000Z,G02,-7.000,8.000,9.000\n"
              "2010-07-01T12:00:00.000Z,G09,1.000,2.000,3.000\n"
              "2010-07-01T13:00:00.000Z,G09,4.000,5.000,6.000\n");
    EXPECT_EQ(tracks_csv({}), "time_utc,satellite,x_m,y_m,z_m\n");
}

}  // namespace
}  // namespace skyloop
