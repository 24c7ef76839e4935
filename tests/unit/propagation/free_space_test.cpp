#include "world/propagation/propagation_effect.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

TEST(FreeSpaceLoss, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("free_space_loss.csv")) {
        SCOPED_TRACE(row.id());
        const Decibels loss = free_space_loss(Metres(row.number("distance_m")), Hertz(row.number("f_Hz")));
        EXPECT_NEAR(loss.value(), row.number("loss_dB"), row.number("tol_dB"));
    }
}

TEST(FreeSpace, GivesOneUndisturbedArrivalForEachSatelliteInOrder) {
    SkyView sky;
    for (const int number : {3, 7, 21}) {
        SatelliteInView satellite;
        satellite.id = {Constellation::gps, number};
        satellite.range = Metres(20e6 + number * 1e5);
        sky.satellites.push_back(satellite);
    }
    const Arrivals arrivals = free_space(sky);
    ASSERT_EQ(arrivals.satellites.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const Arrival& arrival = arrivals.satellites[i];
        EXPECT_EQ(arrival.id, sky.satellites[i].id);
        EXPECT_TRUE(arrival.line_of_sight);
        EXPECT_EQ(arrival.paths, 1);
        EXPECT_EQ(arrival.excess_path, Metres(0));
        EXPECT_EQ(arrival.free_space_loss, free_space_loss(sky.satellites[i].range, Hertz(carrier_frequency_l1)));
        EXPECT_FALSE(arrival.cn0);
    }
}

}  // namespace
}  // namespace skyloop
