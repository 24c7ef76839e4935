#include "receiver/error_model/baseline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "receiver/error_model/fix_builder.hpp"
#include "support/model_sky.hpp"
#include "support/oracle_table.hpp"
#include "world/propagation/sensor_model_delays.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

// A scenario of paper_error_scale.csv with its satellites, as effects and selection see it.
struct ErrorScaleScene {
    std::vector<OracleRow> rows;
    SkyView sky;
    TruthState truth;
    Arrivals arrivals;
    Fix fix;

    explicit ErrorScaleScene(const OracleRow& scenario) {
        std::vector<test::SkySpot> spots;
        for (const OracleRow& row : test::oracle_rows("paper_error_scale_satellites.csv")) {
            if (row.text("scenario") != scenario.id()) continue;
            rows.push_back(row);
            spots.push_back({row.number("az_deg"), row.number("el_deg")});
        }
        sky = test::sky_of(spots);
        const LeapSeconds gps_calendar = LeapSeconds::constant(0);
        const auto time = parse_utc(scenario.text("gpst"));
        EXPECT_TRUE(time.has_value());
        truth = test::truth_at(
            Geodetic::degrees(scenario.number("rx_lat_deg"), scenario.number("rx_lon_deg"), scenario.number("rx_h_m")),
            to_gps_time(*time, gps_calendar));
        arrivals = free_space(sky);
        TecIonosphereDelay ionosphere(Tecu(rows.empty() ? 0 : rows.front().number("tec_tecu")));
        NiellTroposphereDelay troposphere({}, nullptr, gps_calendar);
        ionosphere.apply(arrivals, sky, truth);
        troposphere.apply(arrivals, sky, truth);
        fix.satellites = select_satellites(sky, arrivals, {});
        const auto dop = dilution_of_precision(used_directions(fix.satellites));
        EXPECT_TRUE(dop.has_value());
        if (dop) fix.dop = *dop;
    }
};

TEST(UereScale, EveryErrorScaleRow) {
    for (const OracleRow& row : test::oracle_rows("paper_error_scale.csv")) {
        SCOPED_TRACE(row.id());
        const ErrorScaleScene scene(row);
        ASSERT_EQ(scene.rows.size(), static_cast<std::size_t>(row.integer("n_used")));
        const auto expect_close = [&](double value, const char* column) {
            EXPECT_NEAR(value / row.number(column), 1, row.number("tol_rel")) << column;
        };
        expect_close(scene.fix.dop.pdop, "pdop");
        expect_close(scene.fix.dop.hdop, "hdop");
        expect_close(scene.fix.dop.vdop, "vdop");

        const UereScale strict = uere_scale(scene.fix, scene.arrivals, BaselineParameters::strict());
        expect_close(strict.sigma_uere.value(), "sigma_uere_sample_std_m");
        expect_close(strict.position_error.value(), "E_sample_std_m");
        expect_close(strict.position_error.value() / std::sqrt(3.0), "E_sample_std_per_axis_m");

        BaselineParameters rms;
        rms.statistic = UereStatistic::rms;
        const UereScale by_rms = uere_scale(scene.fix, scene.arrivals, rms);
        expect_close(by_rms.sigma_uere.value(), "sigma_uere_rms_m");
        expect_close(by_rms.position_error.value(), "E_rms_m");

        const UereScale calibrated = uere_scale(scene.fix, scene.arrivals, BaselineParameters::calibrated());
        expect_close(calibrated.sigma_uere.value(), "sigma_uere_residual_m");
        expect_close(calibrated.position_error.value(), "E_residual_m");
    }
}

TEST(UereScale, EverySatelliteOfTheErrorScaleRows) {
    for (const OracleRow& scenario : test::oracle_rows("paper_error_scale.csv")) {
        const ErrorScaleScene scene(scenario);
        for (std::size_t i = 0; i < scene.rows.size(); ++i) {
            const OracleRow& row = scene.rows[i];
            SCOPED_TRACE(row.id());
            const Arrival& arrival = scene.arrivals.satellites[i];
            EXPECT_NEAR(arrival.iono_delay.value(), row.number("E_iono_m"), row.number("tol_m"));
            EXPECT_NEAR(arrival.tropo_delay.value(), row.number("E_tropo_m"), row.number("tol_m"));
            EXPECT_NEAR(user_equivalent_range_error(arrival, {}).value(), row.number("uere_m"), row.number("tol_m"));
        }
    }
}

TEST(UereSpread, SampleDeviationIgnoresACommonBiasAndRmsDoesNot) {
    const std::vector<Metres> errors{Metres(3), Metres(5), Metres(7)};
    EXPECT_DOUBLE_EQ(uere_spread(errors, UereStatistic::sample_std).value(), 2);
    EXPECT_DOUBLE_EQ(uere_spread(errors, UereStatistic::rms).value(), std::sqrt(83 / 3.0));
    const std::vector<Metres> shifted{Metres(103), Metres(105), Metres(107)};
    EXPECT_NEAR(uere_spread(shifted, UereStatistic::sample_std).value(), 2, 1e-12);
    EXPECT_GT(uere_spread(shifted, UereStatistic::rms), Metres(100));
}

TEST(UereSpread, OfTooFewValuesIsNothing) {
    const std::vector<Metres> one{Metres(4)};
    EXPECT_EQ(uere_spread(one, UereStatistic::sample_std), Metres(0));
    EXPECT_EQ(uere_spread(one, UereStatistic::rms), Metres(4));
    EXPECT_EQ(uere_spread({}, UereStatistic::rms), Metres(0));
    EXPECT_EQ(uere_spread({}, UereStatistic::sample_std), Metres(0));
}

TEST(UserEquivalentRangeError, TakesFractionsOfTheDelaysAndTheWholeDetour) {
    Arrival arrival;
    arrival.iono_delay = Metres(10);
    arrival.tropo_delay = Metres(20);
    arrival.excess_path = Metres(7);
    EXPECT_DOUBLE_EQ(user_equivalent_range_error(arrival, BaselineParameters::strict()).value(), 37);
    EXPECT_DOUBLE_EQ(user_equivalent_range_error(arrival, BaselineParameters::calibrated()).value(), 5 + 2 + 7);
}

}  // namespace
}  // namespace skyloop
