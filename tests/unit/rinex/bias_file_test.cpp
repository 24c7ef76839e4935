#include "world/rinex/bias_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;

const GpsTime bias_noon = gps_calendar_time(2020, 6, 25, 12, 0, 0);

// @param codes of an OSB one, of a DSB two
std::string bias_line(std::string_view kind, std::string_view satellite, const std::vector<std::string_view>& codes,
                      double ns, std::string_view days = "2020:177:00000 2020:178:00000") {
    const std::string_view second = codes.size() > 1 ? codes[1] : "";
    return fmt::format(" {:<4} G063 {:<3} {:<9} {:<4} {:<4} {} {:<4} {:21.4f} {:11.4f}\n", kind, satellite, "",
                       codes[0], second, days, "ns", ns, 0.01);
}

std::string bias_file(const std::string& lines) {
    return "%=BIA 1.00 XYZ 2020:178:00000 XYZ 2020:177:00000 2020:178:00000 A 00000002\n+BIAS/SOLUTION\n"
           "*BIAS SVN_ PRN STATION__ OBS1 OBS2 BIAS_START____ BIAS_END______ UNIT __ESTIMATED_VALUE____ _STD_DEV___\n" +
           lines + "-BIAS/SOLUTION\n%=ENDBIA\n";
}

CodeBiases biases_of(const std::string& lines) {
    auto read = read_biases(bias_file(lines), "made.bia");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : CodeBiases{};
}

double nanoseconds_of(const CodeBiases& biases, SatelliteId satellite, Signal signal, GpsTime time = bias_noon) {
    const auto bias = biases.of(satellite, signal, time);
    EXPECT_TRUE(bias);
    return bias ? bias->value() * 1e9 : 0;
}

constexpr SatelliteId g01{Constellation::gps, 1}, e05{Constellation::galileo, 5}, c20{Constellation::beidou, 20};

TEST(BiasFile, TakesSingleCodesAsTheyAre) {
    const CodeBiases biases =
        biases_of(bias_line("OSB", "G01", {"C1C"}, 3.25) + bias_line("OSB", "G01", {"C2L"}, -5.5) +
                  bias_line("OSB", "G01", {"L1C"}, 0.3) + bias_line("OSB", "E05", {"C5X"}, 1.5) +
                  bias_line("OSB", "G01", {"C1C"}, 9, "2020:178:00000 0000:000:00000"));
    EXPECT_DOUBLE_EQ(nanoseconds_of(biases, g01, Signal::l1), 3.25);
    EXPECT_DOUBLE_EQ(nanoseconds_of(biases, g01, Signal::l2), -5.5);
    EXPECT_FALSE(biases.of(g01, Signal::l5, bias_noon));
    EXPECT_DOUBLE_EQ(nanoseconds_of(biases, e05, Signal::l5), 1.5) << "of the attributes the one that there is";
    EXPECT_DOUBLE_EQ(nanoseconds_of(biases, g01, Signal::l1, bias_noon + std::chrono::hours(24)), 9) << "open end";
    EXPECT_FALSE(biases.of(g01, Signal::l1, bias_noon - std::chrono::hours(24)));
}

// TGD = (t1 − t2)/(1 − γ) with γ = (f1/f2)² (IS-GPS-200, 20.3.3.3.3.2): the delay of L1 P(Y) against the clock.
TEST(BiasFile, MakesOfDifferencesWhatTheClockKnows) {
    const CodeBiases biases =
        biases_of(bias_line("DSB", "G01", {"C1C", "C1W"}, -1.5) + bias_line("DSB", "G01", {"C1C", "C2W"}, 6.5) +
                  bias_line("DSB", "G01", {"C2W", "C2L"}, 0.25) + bias_line("DSB", "C20", {"C2I", "C6I"}, 10));
    const double gamma = std::pow(carrier_frequency_l1 / carrier_frequency_l2, 2);
    const double tgd = (8.0 - 0) / (1 - gamma);  // C1W − C2W is 8 ns
    EXPECT_NEAR(nanoseconds_of(biases, g01, Signal::l1), tgd - 1.5, 1e-9);
    EXPECT_NEAR(nanoseconds_of(biases, g01, Signal::l2), gamma * tgd - 0.25, 1e-9);
    const double first = nanoseconds_of(biases, c20, Signal::b1i), second = nanoseconds_of(biases, c20, Signal::b3i);
    EXPECT_NEAR(first - second, 10, 1e-9);
    const double ratio = std::pow(1561.098 / 1268.52, 2);
    EXPECT_NEAR(ratio * first - second, 0, 1e-9) << "nothing is left in the combination of the clock";
    EXPECT_FALSE(biases.of(c20, Signal::l5, bias_noon)) << "nothing leads there";
}

TEST(BiasFile, PassesOverReceivers) {
    const std::string station =
        fmt::format(" {:<4} {:<4} {:<3} {:<9} {:<4} {:<4} {} {} {:<4} {:21.4f} {:11.4f}\n", "OSB", "G", "G", "AREQ",
                    "C1C", "", "2020:177:00000", "2020:178:00000", "ns", 7.0, 0.01);
    EXPECT_EQ(biases_of(station + bias_line("OSB", "G01", {"C1C"}, 3)).size(), 1U);
}

TEST(BiasFile, NamesTheLineThatIsWrong) {
    const auto refusal = [](const std::string& text) {
        const auto read = read_biases(text, "made.bia");
        EXPECT_FALSE(read);
        return read ? std::string() : read.error().message;
    };
    EXPECT_THAT(refusal("CODE'S MONTHLY GNSS P1-P2 DCB SOLUTION\n"), HasSubstr("made.bia:1: found"));
    EXPECT_THAT(refusal(bias_file("")), HasSubstr("no code bias of a satellite"));
    EXPECT_THAT(refusal(bias_file(bias_line("DSB", "G01", {"C1C"}, 1))), HasSubstr("made.bia:4: found"));
    EXPECT_THAT(refusal(bias_file(bias_line("OSB", "G01", {"C1C"}, 1, "2020:400:00000 2020:178:00000"))),
                HasSubstr("expected two epochs"));
    std::string text = bias_file(bias_line("OSB", "G01", {"C1C"}, 1));
    EXPECT_THAT(refusal(text.replace(text.find(" ns "), 4, " cyc")), HasSubstr("expected nanoseconds"));
}

}  // namespace
}  // namespace skyloop::test
