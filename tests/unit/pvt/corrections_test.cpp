#include "receiver/pvt/corrections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/time/utc_time.hpp"
#include "support/flat_geoid.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {
namespace {

const Geodetic odessa = Geodetic::degrees(46.5, 30.7, 60);
const SkyDirection slanting{Angle::degrees(120), Angle::degrees(30)};
const GpsTime noon = to_gps_time(2300, 216000.0 + 43200);
constexpr Hertz l1(carrier_frequency_l1);

TEST(RangeCorrections, HasADefaultIonosphereOnlyWhenAsked) {
    CorrectionParameters parameters;
    const RangeCorrections silent(parameters, {});
    EXPECT_EQ(silent.at(odessa, noon).ionosphere(Constellation::gps, slanting, l1), Metres(0));
    parameters.default_ionosphere = true;
    const RangeCorrections assumed(parameters, {});
    const KlobucharDelay model = klobuchar_delay(default_klobuchar_coefficients(), odessa, slanting, noon);
    EXPECT_EQ(assumed.at(odessa, noon).ionosphere(Constellation::gps, slanting, l1), model.slant);
    EXPECT_GT(model.slant, Metres(2.5));
    parameters.ionosphere = IonosphereCorrection::none;
    const RangeCorrections off(parameters, {});
    EXPECT_EQ(off.at(odessa, noon).ionosphere(Constellation::gps, slanting, l1), Metres(0));
}

TEST(RangeCorrections, TakesEachSystemsOwnIonosphereWhereItIsHeard) {
    BroadcastIonosphere heard(default_klobuchar_coefficients());
    const Hertz e1 = l1;
    const Hertz b1i = carrier_frequency(Signal::b1i);
    const RangeCorrections gps_alone({}, {heard});
    heard.galileo = std::array<double, 3>{100, 0.3, 0.002};
    heard.beidou = KlobucharCoefficients{{2e-8, 0, 0, 0}, {1e5, 0, 0, 0}};
    const RangeCorrections all({}, {heard});
    CorrectionParameters klobuchar;
    klobuchar.ionosphere = IonosphereCorrection::klobuchar;
    const RangeCorrections forced(klobuchar, {heard});

    const auto at = [](const RangeCorrections& c, Constellation s, Hertz f) {
        return c.at(odessa, noon).ionosphere(s, slanting, f).value();
    };
    EXPECT_EQ(at(gps_alone, Constellation::galileo, e1), at(all, Constellation::gps, l1));
    EXPECT_NE(at(all, Constellation::galileo, e1), at(all, Constellation::gps, l1));
    EXPECT_EQ(at(forced, Constellation::galileo, e1), at(all, Constellation::gps, l1));
    const double ratio = l1.value() / b1i.value();
    EXPECT_NEAR(at(forced, Constellation::beidou, b1i), at(all, Constellation::gps, l1) * ratio * ratio, 1e-12);
    EXPECT_NEAR(at(all, Constellation::beidou, b1i),
                beidou_klobuchar_delay(*heard.beidou, odessa, slanting, noon).value(), 1e-12);
    EXPECT_EQ(gps_alone.at(odessa, noon).ionosphere(Constellation::gps, {Angle(), Angle::degrees(-3)}, l1), Metres(0));
}

// The longitude by an arcsine, which stays on this side of the pole.
TEST(RangeCorrections, FollowsThePublishedGeometryOfGalileosIonosphere) {
    BroadcastIonosphere heard;
    heard.galileo = std::array<double, 3>{100, 0.3, 0.002};
    const Geodetic arctic = Geodetic::degrees(82.49, -62.34, 78);
    const SkyDirection over_the_pole{Angle::degrees(-21), Angle::degrees(15)};
    const auto delay = [&](const PiercePoint& pierce) {
        const IonosphereTime when = IonosphereTime::of(to_utc(noon, LeapSeconds::announced()));
        return ionosphere_group_delay(ntcm_g_content({100, 0.3, 0.002}, pierce, over_the_pole.elevation, when), l1);
    };
    const Geodetic ground{arctic.latitude, arctic.longitude, {}};
    const Metres published = delay(published_pierce_point({}, ground, over_the_pole));
    const RangeCorrections corrections({}, {heard});
    EXPECT_EQ(corrections.at(arctic, noon).ionosphere(Constellation::galileo, over_the_pole, l1), published);
    EXPECT_GT(std::abs((published - delay(pierce_point({}, ground, over_the_pole))).value()), 0.01);
}

// What stands behind the pseudoranges of oracles/spp: the coefficients of their headers, and where their receivers are.
constexpr KlobucharCoefficients oracle_air{{4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7},
                                           {8.1920e4, 9.8304e4, -6.5536e4, -5.2429e5}};
Geodetic oracle_place(const std::string& scenario) {
    const Eigen::Vector3d third(3783288.8564, 901655.4393, 5038277.8237);
    const Eigen::Vector3d others(3782096.1791, 2248555.9434, 4601986.9856);
    return to_geodetic(Position<Ecef>(scenario == "PS3" ? third : others));
}

GpsTime oracle_time(const std::string& gpst) {
    const auto number = [&](std::size_t at, std::size_t count) {
        return static_cast<unsigned>(std::stoul(gpst.substr(at, count)));
    };
    return gps_calendar_time(static_cast<int>(number(0, 4)), number(5, 2), number(8, 2), number(11, 2), number(14, 2),
                             number(17, 2));
}

Hertz oracle_carrier(const std::string& satellite) {
    // Of GLONASS' slots 1 to 24, as the constellation has had them for years.
    constexpr int channels[] = {1, -4, 5, 6, 1, -4, 5, 6, -2, -7, 0, -1, -2, -7, 0, -1, 4, -3, 3, 2, 4, -3, 3, 2};
    if (satellite[0] == 'C') return carrier_frequency(Signal::b1i);
    if (satellite[0] != 'R') return l1;
    return Hertz(1602e6 + 562.5e3 * channels[std::stoi(satellite.substr(1)) - 1]);
}

TEST(RangeCorrections, AreThoseOfTheAtmosphereComponents) {
    CorrectionParameters parameters;
    parameters.ionosphere = IonosphereCorrection::klobuchar;
    parameters.troposphere = TroposphereCorrection::saastamoinen;
    parameters.relative_humidity = 0.7;
    const RangeCorrections corrections(parameters, {BroadcastIonosphere(oracle_air)});
    int rows = 0;
    for (const test::OracleRow& row : test::oracle_rows("spp_atmosphere_components.csv")) {
        const double tolerance = row.number("tol_m");
        const SiteCorrections site = corrections.at(oracle_place(row.text("scenario")), oracle_time(row.text("gpst")));
        const SkyDirection direction{Angle::degrees(row.number("az_deg")), Angle::degrees(row.number("el_deg"))};
        const double iono = site.ionosphere(Constellation::gps, direction, oracle_carrier(row.text("sat"))).value();
        const double tropo = site.troposphere(direction.elevation).value();
        EXPECT_NEAR(iono, row.number("iono_m"), tolerance) << row.id();
        EXPECT_NEAR(tropo, row.number("tropo_m"), tolerance) << row.id();
        EXPECT_NEAR(row.number("clean_m") + iono + tropo, row.number("pseudorange_m"), tolerance) << row.id();
        ++rows;
    }
    EXPECT_GE(rows, 4);
}

TEST(BeidouKlobuchar, HasItsNightAndItsNoonAtTheZenith) {
    const KlobucharCoefficients c{{2e-8, 0, 0, 0}, {1e5, 0, 0, 0}};
    const SkyDirection zenith{Angle(), Angle::degrees(90)};
    // 14:00 local BDT time at longitude 0 is the peak; at night 5 ns are left.
    const Geodetic greenwich = Geodetic::degrees(20, 0, 0);
    const GpsTime peak = to_gps_time(2300, 86400.0 + 50400 + 14);
    EXPECT_NEAR(beidou_klobuchar_delay(c, greenwich, zenith, peak).value(), speed_of_light * 25e-9, 1e-9);
    EXPECT_NEAR(beidou_klobuchar_delay(c, greenwich, zenith, peak + std::chrono::hours(10)).value(),
                speed_of_light * 5e-9, 1e-9);
    // A sixth of the period before the peak the cosine is one half.
    EXPECT_NEAR(beidou_klobuchar_delay(c, greenwich, zenith, advanced(peak, Seconds(-1e5 / 6))).value(),
                speed_of_light * 15e-9, 1e-9);
    // As published, a ray over the pole has the local time of its own side.
    const SkyDirection over_pole{Angle(), Angle::degrees(10)};
    EXPECT_NEAR(beidou_klobuchar_delay(c, Geodetic::degrees(88, 0, 0), over_pole, peak).value(),
                speed_of_light * 25e-9 * single_layer_mapping({Metres(6378000), Metres(375000)}, over_pole.elevation),
                1e-9);
}

TEST(RangeCorrections, MapsTheZenithTroposphere) {
    CorrectionParameters parameters;
    parameters.troposphere = TroposphereCorrection::saastamoinen;
    const RangeCorrections simple(parameters, {});
    const double expected = saastamoinen_delay(odessa.latitude, MslHeight{Metres(60)}, slanting.elevation, 0.5).value();
    EXPECT_NEAR(simple.at(odessa, noon).troposphere(slanting.elevation).value(), expected, 1e-12);
    const RangeCorrections niell({}, {});
    EXPECT_NEAR(niell.at(odessa, noon).troposphere(slanting.elevation).value(), expected, 0.05);
    EXPECT_NEAR(niell.at(odessa, noon).troposphere(Angle::degrees(90)).value(),
                simple.at(odessa, noon).troposphere(Angle::degrees(90)).value(), 1e-9);
    EXPECT_LT(niell.at(odessa, noon).troposphere(Angle()).value(), 110);
    EXPECT_EQ(niell.at(odessa, noon).troposphere(Angle::degrees(-10)), niell.at(odessa, noon).troposphere(Angle()));
    EXPECT_TRUE(std::isfinite(simple.at(odessa, noon).troposphere(Angle::degrees(-10)).value()));
    parameters.troposphere = TroposphereCorrection::none;
    const RangeCorrections off(parameters, {});
    EXPECT_EQ(off.at(odessa, noon).troposphere(slanting.elevation), Metres(0));
}

TEST(RangeCorrections, CountsHeightsFromTheSeaWhenThereIsAGeoid) {
    const auto geoid = test::flat_geoid(40);
    ASSERT_TRUE(geoid);
    CorrectionParameters parameters;
    parameters.troposphere = TroposphereCorrection::saastamoinen;
    const RangeCorrections with(parameters, {{}, &*geoid});
    const double expected = saastamoinen_delay(odessa.latitude, MslHeight{Metres(20)}, slanting.elevation, 0.5).value();
    EXPECT_NEAR(with.at(odessa, noon).troposphere(slanting.elevation).value(), expected, 1e-6);
}

}  // namespace
}  // namespace skyloop
