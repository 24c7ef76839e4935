#include "world/rinex/antenna_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "antenna_text.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;

const SatelliteId antenna_satellite{Constellation::gps, 7};

AntennaCatalogue catalogue_of(const std::string& text) {
    auto read = read_antennas(text, "made.atx");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : AntennaCatalogue{};
}

std::string antenna_refusal(const std::string& text) {
    const auto read = read_antennas(text, "made.atx");
    EXPECT_FALSE(read);
    return read ? std::string() : read.error().message;
}

std::string block_of_g07(std::string_view type, double z_mm, const std::string& valid) {
    return antex_antenna({type,
                          "G07",
                          "G048      2008-012A",
                          "   0.0  14.0   7.0",
                          0,
                          valid,
                          {{"G01", 394, -1.5, z_mm, {-1, 2, 5}}, {"G02", 394, 0, 0.5 * z_mm, {0, 0, 0}}}});
}

const std::string until_2010 = antex_line("  1995     1     1     0     0    0.0000000", "VALID FROM") +
                               antex_line("  2010    12    31    23    59   59.9999999", "VALID UNTIL");
const std::string from_2011 = antex_line("  2011     1     1     0     0    0.0000000", "VALID FROM");

TEST(AntennaFile, ReadsSatellitesAndWhenTheyWere) {
    const AntennaCatalogue all = catalogue_of(antex_header() + block_of_g07("BLOCK IIA", 2000, until_2010) +
                                              block_of_g07("BLOCK IIR-M", 800, from_2011));
    const auto* old = all.satellites.of(antenna_satellite, gps_calendar_time(2010, 12, 31, 23, 0, 0));
    ASSERT_NE(old, nullptr);
    const PhaseCentre* l1 = old->at(Constellation::gps, Signal::l1);
    ASSERT_NE(l1, nullptr);
    EXPECT_EQ(l1->offset, Eigen::Vector3d(0.394, -0.0015, 2));
    EXPECT_NEAR(l1->variation(Angle::degrees(3.5)).value(), 0.0005, 1e-12) << "half way from -1 to 2 mm";
    EXPECT_NEAR(l1->variation(Angle::degrees(20)).value(), 0.005, 1e-12) << "beyond the last as at the last";
    EXPECT_EQ(old->at(Constellation::gps, Signal::l5)->offset.z(), 1) << "the nearest carrier, L2";
    const auto* young = all.satellites.of(antenna_satellite, gps_calendar_time(2011, 1, 1, 0, 0, 0));
    ASSERT_NE(young, nullptr);
    EXPECT_EQ(young->at(Constellation::gps, Signal::l1)->offset.z(), 0.8);
    EXPECT_EQ(all.satellites.of(antenna_satellite, gps_calendar_time(1994, 1, 1, 0, 0, 0)), nullptr);
    EXPECT_EQ(all.satellites.of({Constellation::gps, 8}, gps_calendar_time(2011, 1, 1, 0, 0, 0)), nullptr);
}

TEST(AntennaFile, ReadsReceiversByNameAndAzimuth) {
    const std::string rest = "   0.0  90.0  45.0";
    const AntexFrequency around{"G01", 0.5, -0.3, 89, {1, 2, 3}, {{0, 0, 0}, {0, 4, 8}, {0, 0, 0}}};
    const AntennaCatalogue all = catalogue_of(
        antex_header() + antex_antenna({"TRM59800.00     NONE", "", "", rest, 180, "", {around}}) +
        antex_antenna({"TRM59800.00     NONE", "5225354537", "", rest, 0, "", {{"G01", 0, 0, 1, {0, 0, 0}}}}) +
        antex_antenna({"LEIAR25.R3      LEIT", "", "", rest, 0, "", {{"G02", 0, 0, 2, {0, 0, 0}}}}));
    ASSERT_EQ(all.receivers.size(), 2U) << "that of a single piece is not that of the type";
    const auto found = all.receivers.find(receiver_antenna_name("  TRM59800.00 "));
    ASSERT_NE(found, all.receivers.end()) << "without a radome: NONE";
    const PhaseCentre* centre = found->second.at(Constellation::galileo, Signal::l1);
    ASSERT_NE(centre, nullptr) << "of a system that was not measured: GPS";
    EXPECT_EQ(centre->offset.z(), 0.089);
    EXPECT_NEAR(centre->variation(Angle::degrees(45)).value(), 2e-3, 1e-12);
    EXPECT_NEAR(centre->variation(Angle::degrees(45), Angle::degrees(90)).value(), 2e-3, 1e-12);
    EXPECT_NEAR(centre->variation(Angle::degrees(90), Angle::degrees(270)).value(), 4e-3, 1e-12);
    EXPECT_NEAR(centre->variation(Angle::degrees(90), Angle::degrees(-180)).value(), 8e-3, 1e-12);
    EXPECT_EQ(receiver_antenna_name("LEIAR25.R3      LEIT"), "LEIAR25.R3 LEIT");
}

TEST(AntennaFile, PassesOverDeviationsAndOtherVehicles) {
    const std::string deviations = antex_line("   G01", "START OF FREQ RMS") + "   NOAZI    0.10    0.10    0.10\n" +
                                   antex_line("   G01", "END OF FREQ RMS") + antex_line("", "END OF ANTENNA");
    std::string text = antex_header() + block_of_g07("BLOCK IIA", 2000, from_2011);
    text.replace(text.rfind(antex_line("", "END OF ANTENNA")), std::string::npos, deviations);
    EXPECT_EQ(catalogue_of(text).satellites.size(), 1U);
}

TEST(AntennaFile, NamesTheLineThatIsWrong) {
    EXPECT_THAT(antenna_refusal("hello\n"), HasSubstr("made.atx:1: found 'hello'; expected an ANTEX file"));
    EXPECT_THAT(antenna_refusal(antex_header("R")), HasSubstr("made.atx:2: found 'R'; expected absolute"));
    EXPECT_THAT(antenna_refusal(antex_header()), HasSubstr("no antenna"));
    std::string text = antex_header() + block_of_g07("BLOCK IIA", 2000, from_2011);
    EXPECT_THAT(antenna_refusal(text.substr(0, text.find("END OF ANTENNA"))), HasSubstr("expected END OF ANTENNA"));
    const auto replaced = [&](std::string_view from, std::string_view to) {
        std::string other = text;
        return other.replace(other.find(from), from.size(), to);
    };
    EXPECT_THAT(antenna_refusal(replaced("   -1.00    2.00", "   -1.00     two")),
                HasSubstr("made.atx:11: found 'NOAZI   -1.00     two    5.00'; expected 3 variations"));
    EXPECT_THAT(antenna_refusal(replaced("  2011     1", "  2011    13")), HasSubstr("expected an epoch"));
    EXPECT_THAT(antenna_refusal(replaced("   7.0", "   0.0")), HasSubstr("expected zenith angles"));
    EXPECT_THAT(antenna_refusal(replaced("    394.00", "       abc")), HasSubstr("expected three offsets"));
}

}  // namespace
}  // namespace skyloop::test
