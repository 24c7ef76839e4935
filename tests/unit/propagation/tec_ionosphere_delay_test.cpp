#include "world/propagation/sensor_model_delays.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"
#include "world/gnss/atmosphere.hpp"

namespace skyloop {
namespace {

using test::OneSatellite;
using test::OracleRow;

TEST(TecDelay, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("paper_iono_delay.csv")) {
        SCOPED_TRACE(row.id());
        const Angle elevation = Angle::degrees(row.number("el_deg"));
        EXPECT_NEAR(ionosphere_obliquity(elevation), row.number("obliquity"), row.number("tol"));
        EXPECT_NEAR(tec_delay(Tecu(row.number("tec_tecu")), elevation).value(), row.number("E_iono_m"),
                    row.number("tol"));
    }
}

TEST(TecDelay, DefaultContentDelaysByFiveMetresAtTheZenith) {
    EXPECT_NEAR(tec_delay(Tecu(30.86), Angle::degrees(90)).value(), 5.0, 0.005);
}

TEST(TecIonosphereDelay, ConstantContentIsTheSameEverywhere) {
    TecIonosphereDelay effect(Tecu(20));
    OneSatellite scene(Angle::degrees(33), Metres(22e6), Geodetic::degrees(-30, 150, 20));
    EXPECT_EQ(scene.after(effect).iono_delay, tec_delay(Tecu(20), Angle::degrees(33)));
}

TEST(TecIonosphereDelay, BroadcastContentIsTheVerticalDelayAtThePiercePoint) {
    const KlobucharCoefficients broadcast{{4.6566e-09, 1.4901e-08, -5.9605e-08, -1.1921e-07},
                                          {81920.0, 98304.0, -65536.0, -524290.0}};
    TecIonosphereDelay effect(broadcast);
    OneSatellite scene(Angle::degrees(20), Metres(22e6), Geodetic::degrees(40, -100, 0));
    scene.sky.satellites.front().azimuth = Angle::degrees(210);
    scene.truth.time = to_gps_time(2111, 593100.0);
    // Row pI001 of iono_klobuchar.csv: vertical 2.4447843077 m.
    EXPECT_NEAR(effect.vertical_content(scene.sky.satellites.front(), scene.truth).value(), 2.4447843077 / 0.162, 1e-6);
    EXPECT_NEAR(scene.after(effect).iono_delay.value(), 2.4447843077 * ionosphere_obliquity(Angle::degrees(20)), 1e-6);
}

// Of two maps, a day apart, on the same slope from south to north.
IonosphereMaps sloping_maps(GpsTime first) {
    IonosphereMaps maps;
    maps.latitude = {Angle::degrees(90), Angle::degrees(-5), 37};
    maps.longitude = {Angle::degrees(-180), Angle::degrees(5), 73};
    IonosphereMap map{first, {}};
    for (int i = 0; i < 37; ++i)
        map.content_tecu.insert(map.content_tecu.end(), 73, 10.0 + i);
    maps.maps = {map, {first + std::chrono::days(1), map.content_tecu}};
    return maps;
}

TEST(TecIonosphereDelay, ContentOfMapsIsThatAtThePiercePointWithTheObliquityOfTheArticle) {
    OneSatellite scene(Angle::degrees(30), Metres(22e6), Geodetic::degrees(40, -100, 0));
    scene.truth.time = to_gps_time(2111, 593100.0);
    const IonosphereMaps maps = sloping_maps(scene.truth.time - std::chrono::hours(1));
    TecIonosphereDelay effect(maps);
    const SatelliteInView& satellite = scene.sky.satellites.front();
    const PiercePoint there = pierce_point(maps.shell, scene.truth.geodetic, {satellite.azimuth, satellite.elevation});
    const double content = 10 + (90 - there.latitude.deg()) / 5;
    EXPECT_NEAR(effect.vertical_content(satellite, scene.truth).value(), content, 1e-9);
    EXPECT_NEAR(scene.after(effect).iono_delay.value(), 0.162 * content * ionosphere_obliquity(Angle::degrees(30)),
                1e-9);
}

TEST(TecIonosphereDelay, FallsWithTheSquareOfTheCarrier) {
    TecIonosphereDelay effect(Tecu(20));
    for (const double f : {1575.42e6, 1602e6 - 7 * 562.5e3, 1561.098e6, 1176.45e6}) {
        OneSatellite scene(Angle::degrees(33), Metres(22e6), Geodetic::degrees(-30, 150, 20));
        scene.arrival().signals.push_back({Signal::l1, Hertz(f), Seconds(0), Decibels(0)});
        const double ratio = 1575.42e6 / f;
        EXPECT_NEAR(scene.after(effect).iono_delay.value(),
                    tec_delay(Tecu(20), Angle::degrees(33)).value() * ratio * ratio, 1e-12);
    }
}

TEST(TecIonosphereDelay, EndsAtTheShell) {
    const auto delay_at = [](TecIonosphereDelay effect, double height) {
        OneSatellite scene(Angle::degrees(30), Metres(22e6), Geodetic::degrees(40, -100, height));
        scene.truth.time = to_gps_time(2111, 593100.0);
        return scene.after(effect).iono_delay.value();
    };
    const KlobucharCoefficients broadcast{{4.6566e-09, 1.4901e-08, -5.9605e-08, -1.1921e-07},
                                          {81920.0, 98304.0, -65536.0, -524290.0}};
    EXPECT_GT(delay_at(TecIonosphereDelay(Tecu(20)), 349999), 1);
    EXPECT_EQ(delay_at(TecIonosphereDelay(Tecu(20)), 350000), 0);
    EXPECT_GT(delay_at(TecIonosphereDelay(broadcast), 349999), 1);
    EXPECT_EQ(delay_at(TecIonosphereDelay(broadcast), 350000), 0);
    const IonosphereMaps maps = sloping_maps(to_gps_time(2111, 593100.0) - std::chrono::hours(1));
    EXPECT_GT(delay_at(TecIonosphereDelay(maps), 449999), 1);
    EXPECT_EQ(delay_at(TecIonosphereDelay(maps), 450000), 0);
}

}  // namespace
}  // namespace skyloop
