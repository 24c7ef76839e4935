#include "world/gnss/satellite.hpp"

#include <gtest/gtest.h>

#include <array>

namespace skyloop::test {
namespace {

constexpr std::array all_constellations{Constellation::gps,    Constellation::sbas, Constellation::galileo,
                                        Constellation::beidou, Constellation::qzss, Constellation::glonass,
                                        Constellation::navic};

TEST(Satellite, IsWrittenAsInRinex) {
    EXPECT_EQ(to_string(SatelliteId{Constellation::gps, 7}), "G07");
    EXPECT_EQ(to_string(SatelliteId{Constellation::sbas, 22}), "S22");
    EXPECT_EQ(to_string(SatelliteId{Constellation::beidou, 59}), "C59");
    EXPECT_EQ(to_string(SatelliteId{Constellation::navic, 2}), "I02");
}

TEST(Satellite, ReadsWhatItWrites) {
    for (const Constellation c : all_constellations)
        for (int number = 1; number <= 99; ++number) {
            const SatelliteId id{c, number};
            EXPECT_EQ(parse_satellite(to_string(id)), id);
        }
    EXPECT_EQ(parse_satellite("G 7"), (SatelliteId{Constellation::gps, 7}));
}

TEST(Satellite, RefusesWhatIsNoSatellite) {
    for (const char* text : {"", "G", "G7", "G077", "G00", "G 0", "X07", "g07", "G-1", "Gx1", "G1x", "07G", "G7 "})
        EXPECT_FALSE(parse_satellite(text)) << text;
}

TEST(Satellite, ConstellationsHaveLettersAndNamesBothWays) {
    for (const Constellation c : all_constellations) {
        EXPECT_EQ(constellation_from_letter(rinex_letter(c)), c);
        EXPECT_EQ(constellation_from_name(constellation_name(c)), c);
    }
    EXPECT_EQ(rinex_letter(Constellation::qzss), 'J');
    EXPECT_EQ(constellation_name(Constellation::beidou), "beidou");
    EXPECT_FALSE(constellation_from_letter('Z'));
    EXPECT_FALSE(constellation_from_name("GPS"));
}

TEST(Satellite, OrdersBySystemThenNumber) {
    EXPECT_LT((SatelliteId{Constellation::gps, 32}), (SatelliteId{Constellation::sbas, 20}));
    EXPECT_LT((SatelliteId{Constellation::gps, 2}), (SatelliteId{Constellation::gps, 10}));
}

TEST(Constellation, EveryListStandsInTheSameOrder) {
    EXPECT_EQ(constellation_names[static_cast<std::size_t>(Constellation::navic)], "navic");
    EXPECT_EQ(constellation_title(Constellation::gps), "GPS");
    EXPECT_EQ(constellation_title(Constellation::glonass), "GLONASS");
    EXPECT_EQ(rinex_letter(Constellation::qzss), 'J');
}

}  // namespace
}  // namespace skyloop::test
