#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "navigation_text.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::StartsWith;

NavigationFile systems_of(const std::string& text) {
    const Result<NavigationFile> file = read_navigation(text, "made.nav");
    EXPECT_TRUE(file) << file.error().message;
    return file ? *file : NavigationFile{};
}

std::string refusal_of(const std::string& text) {
    const Result<NavigationFile> file = read_navigation(text, "made.nav");
    EXPECT_FALSE(file) << "read " << file->records.size() << " records";
    return file ? std::string() : file.error().message;
}

constexpr const char* march_5 = " 2024 03 05 02 00 00";
const GpsTime two_o_clock = gps_calendar_time(2024, 3, 5, 2, 0, 0);

std::string kepler_text(const std::string& satellite, double sqrt_a = 5153.7, double week = march_5_2024_week) {
    const std::string text = record_text({.first = satellite + march_5, .week = week, .sqrt_a = sqrt_a}, 4);
    // The field of IODC is BeiDou's second group delay.
    return satellite[0] == 'C' ? replaced(text, field(567), field(-2e-9)) : text;
}

// A record of Galileo: the fields of `kepler_text` with other data sources and group delays.
std::string galileo_text(const std::string& satellite, double sources) {
    std::string text = replaced(kepler_text(satellite, 5440.6), field(2e-10) + field(1), field(2e-10) + field(sources));
    return replaced(text, field(-1e-8) + field(567), field(3e-9) + field(4e-9));
}

struct StateVectorText {
    std::string first;  // satellite and epoch
    double x = 7003.0, y = -12206.0, z = 21280.0;
    double health = 0;
    double second_line = 5;  // channel of GLONASS, accuracy of SBAS
    double scale = 1;        // of the acceleration
};

std::string state_vector_text(const StateVectorText& r, int indent = 4, bool fifth_line = false) {
    const std::string in(static_cast<std::size_t>(indent), ' ');
    std::string text = r.first + field(5e-5) + field(1e-12) + field(293400) + "\n" +                          //
                       in + field(r.x) + field(0.78) + field(1e-9 * r.scale) + field(r.health) + "\n" +       //
                       in + field(r.y) + field(2.8) + field(-2e-9 * r.scale) + field(r.second_line) + "\n" +  //
                       in + field(r.z) + field(1.3) + field(0) + field(7) + "\n";
    if (fifth_line) text += in + field(183) + field(-2.8e-9) + field(3) + field(0) + "\n";
    return text;
}

std::string sbas_text(const std::string& first, int indent = 4) {
    return state_vector_text({.first = first, .x = 30474.0, .y = -29138.0, .z = -3.2, .health = 0, .second_line = 4},
                             indent);
}

TEST(NavigationSystems, ReadsAMixedFileOfVersionThree) {
    const NavigationFile file =
        systems_of(header_v3("3.04") + kepler_text("G05") + galileo_text("E11", 517) + kepler_text("J 2", 6493.5) +
                   state_vector_text({.first = std::string("R03") + march_5}) + galileo_text("E12", 258) +
                   kepler_text("C01", 6493.4, 2304 - 1356) + kepler_text("I02", 6493.4) +
                   sbas_text(std::string("S23") + march_5) + kepler_text("G 6"));
    ASSERT_EQ(file.records.size(), 9u);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_EQ(file.skipped, SkippedRecords{});
    EXPECT_THAT(file.counts(),
                ElementsAre(Pair(Constellation::gps, 2), Pair(Constellation::sbas, 1), Pair(Constellation::galileo, 2),
                            Pair(Constellation::beidou, 1), Pair(Constellation::qzss, 1),
                            Pair(Constellation::glonass, 1), Pair(Constellation::navic, 1)));
    EXPECT_EQ(to_string(satellite_of(file.records[2])), "J02");
    EXPECT_EQ(message_of(file.records[1]), NavigationMessage::inav);
    EXPECT_EQ(message_of(file.records[4]), NavigationMessage::fnav);
    EXPECT_EQ(message_of(file.records[5]), NavigationMessage::d2);
}

TEST(NavigationSystems, TakesGalileosGroupDelaysAndSourcesApart) {
    const NavigationFile file = systems_of(header_v3("3.04") + galileo_text("E11", 517) + galileo_text("E12", 258) +
                                           galileo_text("E13", 2) + galileo_text("E14", 0));
    const auto& e = std::get<KeplerEphemeris>(file.records.at(0));
    EXPECT_EQ(e.tgd, 3e-9);
    EXPECT_EQ(e.tgd2, 4e-9);
    EXPECT_EQ(e.iodc, 0);
    EXPECT_EQ(message_of(file.records.at(2)), NavigationMessage::fnav);
    EXPECT_EQ(message_of(file.records.at(3)), NavigationMessage::inav);
    // Weeks counted from Galileo's own epoch are met, too.
    EXPECT_EQ(systems_of(header_v3("3.01") + replaced(galileo_text("E11", 517), field(2304), field(2304 - 1024)))
                  .records.size(),
              1u);
}

TEST(NavigationSystems, KeepsBeidousTime) {
    const auto toe = [](double week, const std::string& satellite) {
        const NavigationFile file = systems_of(header_v3("3.04") + kepler_text(satellite, 5282.6, week));
        return file.records.empty() ? GpsTime{} : toe_of(file.records[0]);
    };
    EXPECT_EQ(toe(2304 - 1356, "C21"), two_o_clock + 14s);
    EXPECT_EQ(toe(2304, "C21"), two_o_clock + 14s) << "some writers give the GPS week";
    EXPECT_THAT(refusal_of(header_v3("3.04") + kepler_text("C21", 5282.6, 700)),
                HasSubstr("found BeiDou week 700; expected week 948"));
    const NavigationFile geo = systems_of(header_v3("3.04") + kepler_text("C59", 6493.4, 948));
    EXPECT_EQ(message_of(geo.records.at(0)), NavigationMessage::d2);
}

TEST(NavigationSystems, ReadsStateVectorsOfGlonass) {
    const std::string r03 = state_vector_text({.first = std::string("R03") + march_5});
    const NavigationFile file = systems_of(header_v3("3.04") + r03);
    const auto& e = std::get<GlonassEphemeris>(file.records.at(0));
    EXPECT_EQ(e.toe, two_o_clock + 18s) << "UTC";
    EXPECT_EQ(e.position_m, (std::array<double, 3>{7003e3, -12206e3, 21280e3}));
    EXPECT_EQ(e.velocity_mps, (std::array<double, 3>{780, 2800, 1300}));
    EXPECT_EQ(e.acceleration_mps2[0], 1e-9 * 1000);
    EXPECT_EQ(e.clock_bias, 5e-5);
    EXPECT_EQ(e.clock_drift, 1e-12);
    EXPECT_EQ(e.frequency_channel, 5);
    EXPECT_EQ(e.iode, (2 + 3) * 4);
    EXPECT_TRUE(e.healthy());

    const std::string byte_channel =
        state_vector_text({.first = std::string("R03") + march_5, .health = 1, .second_line = 251});
    const NavigationFile other = systems_of(header_v3("3.04") + byte_channel);
    EXPECT_EQ(std::get<GlonassEphemeris>(other.records.at(0)).frequency_channel, -5);
    EXPECT_FALSE(is_healthy(other.records.at(0)));

    // Leap seconds are those of the record's own day.
    const NavigationFile old =
        systems_of(header_line("     2.01           GLONASS NAV DATA", "RINEX VERSION / TYPE") +
                   header_line("", "END OF HEADER") + state_vector_text({.first = " 3 09  4  1  0 15  0.0"}, 3));
    EXPECT_EQ(toe_of(old.records.at(0)), gps_calendar_time(2009, 4, 1, 0, 15, 15));
}

TEST(NavigationSystems, TakesFourOrFiveLinesOfGlonass) {
    const StateVectorText r03{.first = std::string("R03") + march_5};
    for (const char* version : {"3.04", "3.05"}) {
        const NavigationFile file = systems_of(header_v3(version) + state_vector_text(r03, 4, true) +
                                               state_vector_text(r03, 4, false) + kepler_text("G05"));
        ASSERT_EQ(file.records.size(), 3u) << version;
        const auto& with = std::get<GlonassEphemeris>(file.records[0]);
        EXPECT_EQ(with.group_delay_l2, -2.8e-9);
        EXPECT_EQ(with.accuracy_m, 4);
        EXPECT_EQ(std::get<GlonassEphemeris>(file.records[1]).group_delay_l2, 0);
        EXPECT_THAT(file.warnings, IsEmpty());
    }
    const std::string unknown = replaced(state_vector_text(r03, 4, true), field(-2.8e-9), field(999999999.999));
    EXPECT_EQ(std::get<GlonassEphemeris>(systems_of(header_v3("3.05") + unknown).records.at(0)).group_delay_l2, 0);
}

TEST(NavigationSystems, ReadsStateVectorsOfSbas) {
    const NavigationFile file = systems_of(header_v3("3.01") + sbas_text(std::string("S23") + march_5));
    const auto& e = std::get<SbasEphemeris>(file.records.at(0));
    EXPECT_EQ(to_string(e.satellite), "S23");
    EXPECT_EQ(e.toe, two_o_clock);
    EXPECT_EQ(e.position_m[1], -29138e3);
    EXPECT_EQ(e.accuracy_m, 4);
    EXPECT_EQ(e.iode, 7);
    EXPECT_EQ(systems_of(header_line("     2.10           H: GEO NAV MSG DATA", "RINEX VERSION / TYPE") +
                         header_line("", "END OF HEADER") + sbas_text("22 24  3  5  2  0  0.0", 3))
                  .records.size(),
              1u);
}

TEST(NavigationSystems, RefusesStateVectorsThatNoSatelliteHas) {
    const auto refused = [](const StateVectorText& r) { return refusal_of(header_v3("3.04") + state_vector_text(r)); };
    const std::string r03 = std::string("R03") + march_5;
    EXPECT_THAT(refused({.first = r03, .x = 1, .y = 1, .z = 1}),
                StartsWith("made.nav:4:5: found a satellite 2 km from the Earth's centre; expected 20000 to 32000 km"));
    EXPECT_THAT(refused({.first = r03, .x = 7e5}), HasSubstr("X between -50000 and 50000"));
    EXPECT_THAT(refused({.first = r03, .second_line = 99}), HasSubstr("found frequency channel 99"));
    EXPECT_THAT(refused({.first = r03, .scale = 1e7}), HasSubstr("the acceleration between"));
    EXPECT_THAT(refused({.first = std::string("S23") + march_5}), HasSubstr("35000 to 50000 km"));
    EXPECT_THAT(refusal_of(header_v3("3.04") +
                           replaced(state_vector_text({.first = r03}), field(-12206.0), std::string(19, ' '))),
                HasSubstr("found a blank field; expected a number, Y"));
    EXPECT_THAT(refusal_of(header_v3("3.04") + state_vector_text({.first = r03}).substr(0, 200)),
                HasSubstr("a record of R03 cut off after 3 of its lines; expected 4 lines"));
}

TEST(NavigationSystems, ReadsTheIonosphereAndTimeOfEverySystem) {
    const std::string header =
        header_line("GPSA   1.0000E-08  2.0000E-08 -6.0000E-08 -1.0000E-07", "IONOSPHERIC CORR") +
        header_line("GPSB   8.0000E+04  9.0000E+04 -6.0000E+04 -5.0000E+05", "IONOSPHERIC CORR") +
        header_line("BDSA   9.0000E-08  2.0000E-08 -6.0000E-08 -1.0000E-07 B 06", "IONOSPHERIC CORR") +
        header_line("BDSA   7.0000E-08  2.0000E-08 -6.0000E-08 -1.0000E-07 C 07", "IONOSPHERIC CORR") +
        header_line("BDSB   8.1000E+04  9.0000E+04 -6.0000E+04 -5.0000E+05 B 06", "IONOSPHERIC CORR") +
        header_line("QZSA   5.0000E-09  2.0000E-08 -6.0000E-08 -1.0000E-07", "IONOSPHERIC CORR") +
        header_line("GAL    6.6250e+01 -1.6410e-01 -2.4720e-03  0.0000e+00", "IONOSPHERIC CORR") +
        header_line("GPUT  1.8626451492E-09 4.440892099E-15  61440 2304", "TIME SYSTEM CORR") +
        header_line("GAGP -3.3e-9          -1.0e-15         432000 2304", "TIME SYSTEM CORR") +
        header_line("    18    18  2185     7GPS", "LEAP SECONDS");
    const NavigationFile file = systems_of(header_v3("3.04", header) + kepler_text("G05"));
    EXPECT_EQ(file.ionosphere.gps->alpha[0], 1e-8);
    EXPECT_EQ(file.ionosphere.beidou->alpha[0], 9e-8) << "the first of several";
    EXPECT_EQ(file.ionosphere.beidou->beta[0], 81e3);
    EXPECT_FALSE(file.ionosphere.qzss);
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("only one of the two lines of ionosphere coefficients of QZS")));
    EXPECT_EQ(file.ionosphere.galileo, (std::array<double, 3>{66.25, -0.1641, -2.472e-3}));
    EXPECT_EQ(file.leap_seconds, 18);

    const NavigationFile v2 = systems_of(
        header_v2(header_line("     .133179128170D-06 .107469588780D-12   552960     1025", "DELTA-UTC: A0,A1,T,W")) +
        record_text({}));
    EXPECT_THAT(v2.warnings, IsEmpty());
}

TEST(NavigationSystems, CoefficientsOfNoughtsAreNone) {
    const std::string noughts = "  0.0000E+00  0.0000E+00  0.0000E+00  0.0000E+00";
    const NavigationFile none = systems_of(
        header_v3("3.04", header_line("GPSA " + noughts, "IONOSPHERIC CORR") +
                              header_line("GPSB " + noughts, "IONOSPHERIC CORR") +
                              header_line("BDSA " + noughts, "IONOSPHERIC CORR") +
                              header_line("BDSB   8.1000E+04  9.0000E+04 -6.0000E+04 -5.0000E+05", "IONOSPHERIC CORR") +
                              header_line("GAL  " + noughts, "IONOSPHERIC CORR")) +
        kepler_text("G05"));
    EXPECT_FALSE(none.ionosphere.gps);
    EXPECT_TRUE(none.ionosphere.beidou) << "no amplitude, but a period";
    EXPECT_FALSE(none.ionosphere.galileo);
    EXPECT_THAT(none.warnings, ElementsAre());

    const auto klobuchar = [](double alpha_0) {
        return "> ION G05 LNAV\n    2024 03 05 02 00 00" + field(alpha_0) + field(0) + field(0) + "\n    " + field(0) +
               field(0) + field(0) + field(0) + "\n    " + field(0) + field(0) + "\n";
    };
    const auto galileo = [](double a_0) {
        return "> ION E05 IFNV\n    2024 03 05 02 00 00" + field(a_0) + field(0) + field(0) + "\n    " + field(0) +
               "\n";
    };
    const NavigationFile second = systems_of(header_v3("4.00") + klobuchar(0) + klobuchar(1e-8) + galileo(0) +
                                             galileo(120.75) + "> EPH G05 LNAV\n" + kepler_text("G05"));
    EXPECT_EQ(second.ionosphere.gps->alpha[0], 1e-8) << "of the first satellite that has some";
    EXPECT_EQ((*second.ionosphere.galileo)[0], 120.75);
}

TEST(NavigationSystems, ReadsTheBlocksOfVersionFour) {
    const auto block = [](const std::string& head, const std::string& record) { return "> " + head + "\n" + record; };
    const std::string epoch = "    2024 03 05 02 00 00";
    const std::string klobuchar = epoch + field(1e-8) + field(2e-8) + field(-6e-8) + "\n    " + field(-1e-7) +
                                  field(8e4) + field(9e4) + field(-6e4) + "\n    " + field(-5e5) + field(0) + "\n";
    const std::string galileo = epoch + field(120.75) + field(-0.19) + field(-7e-4) + "\n    " + field(0) + "\n";
    const std::string offset = epoch + " GPUT                                  UTC(USNO)\n    " + field(295284) +
                               field(9e-10) + field(2e-15) + "\n";
    const NavigationFile file = systems_of(
        header_v3("4.00") + block("EPH G05 LNAV", kepler_text("G05")) +
        block("EPH I05 L1NV", kepler_text("I05") + "    1.0\n") + block("STO G05 LNAV", offset) +
        block("ION G05 LNAV", klobuchar) + block("ION E05 IFNV", galileo) + block("ION C05 D1D2", klobuchar) +
        block("ION C05 CNVX", klobuchar) + block("EOP G05 LNAV", klobuchar) +
        block("EPH E05 INAV", galileo_text("E05", 517)) + block("EPH E05 FNAV", galileo_text("E05", 258)) +
        block("EPH J02 LNAV", kepler_text("J02", 6493.5)) + block("EPH C01 D2", kepler_text("C01", 6493.5, 948)) +
        block("EPH C21 D1", kepler_text("C21", 5282.5, 948)) + block("EPH C21 CNV9", kepler_text("C21", 5282.5, 948)) +
        block("EPH R03 FDMA", state_vector_text({.first = std::string("R03") + march_5}, 4, true)) +
        block("EPH S23 SBAS", sbas_text(std::string("S23") + march_5)) +
        block("EPH I02 LNAV", kepler_text("I02", 6493.5)));
    EXPECT_EQ(file.records.size(), 9u);
    EXPECT_EQ(file.ionosphere.gps->alpha, (std::array<double, 4>{1e-8, 2e-8, -6e-8, -1e-7}));
    EXPECT_EQ(file.ionosphere.gps->beta, (std::array<double, 4>{8e4, 9e4, -6e4, -5e5}));
    EXPECT_TRUE(file.ionosphere.beidou);
    EXPECT_EQ((*file.ionosphere.galileo)[0], 120.75);
    EXPECT_THAT(file.skipped.messages, ElementsAre(Pair("CNV9", 1), Pair("EOP", 1), Pair("ION", 1), Pair("L1NV", 1)));
    EXPECT_EQ(file.skipped.defective, 0);
    EXPECT_THAT(file.warnings,
                ElementsAre("made.nav: skipped messages of other kinds (1 'CNV9', 1 'EOP', 1 'ION', 1 'L1NV')"));
    EXPECT_THAT(refusal_of(header_v3("4.00") + block("EPH I05 L1NV", kepler_text("I05"))),
                HasSubstr("found only messages of other kinds (1 'L1NV'); expected ephemerides of LNAV"));
}

// Coefficients are a system's, whichever satellite sent them; GNSS-SDR's files name no satellite.
TEST(NavigationSystems, ReadsIonospheresOfSystemsWithoutASatellite) {
    const std::string epoch = "    2024 03 05 02 00 00";
    const auto klobuchar = [&](double first) {
        return epoch + field(first) + field(2e-8) + field(-6e-8) + "\n    " + field(-1e-7) + field(8e4) + field(9e4) +
               field(-6e4) + "\n    " + field(-5e5) + field(0) + "\n";
    };
    const NavigationFile file =
        systems_of(header_v3("4.00") + "> ION G   LNAV\n" + klobuchar(1e-8) + "> ION C   D1D2\n" + klobuchar(3e-8) +
                   "> ION E   IFNV\n" + epoch + field(120.75) + field(-0.19) + field(-7e-4) + "\n    " + field(0) +
                   "\n" + "> EPH G05 LNAV\n" + kepler_text("G05"));
    ASSERT_TRUE(file.ionosphere.gps && file.ionosphere.beidou && file.ionosphere.galileo);
    EXPECT_EQ(file.ionosphere.gps->alpha[0], 1e-8);
    EXPECT_EQ(file.ionosphere.beidou->alpha[0], 3e-8);
    EXPECT_EQ((*file.ionosphere.galileo)[0], 120.75);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_THAT(refusal_of(header_v3("4.00") + "> EPH G   LNAV\n" + kepler_text("G05")),
                HasSubstr("expected a block header such as '> EPH G02 LNAV'"));
}

TEST(NavigationSystems, CountsDamagedBlocks) {
    const NavigationFile file =
        systems_of(header_v3("4.00") + "> EPH G05 LNAV\n" + kepler_text("G05") + "> STO GPUT LNAV\n    x\n" +
                   "> ION G05 LNAV\n    2024\n" + "> XYZ G05 LNAV\n");
    EXPECT_EQ(file.records.size(), 1u);
    EXPECT_EQ(file.skipped.defective, 3);
    EXPECT_THAT(file.warnings, ElementsAre(StartsWith("made.nav:12: found a damaged time offset block")));
}

TEST(NavigationSystems, RefusesOtherKindsAndVersions) {
    const std::string records = record_text({});
    const auto with_first_line = [&](std::string_view content) {
        return refusal_of(header_line(content, "RINEX VERSION / TYPE") + header_line("", "END OF HEADER") + records);
    };
    EXPECT_THAT(with_first_line("     2.11           OBSERVATION DATA    G (GPS)"),
                HasSubstr("a file of observations"));
    EXPECT_THAT(with_first_line("     2.11           METEOROLOGICAL DATA"), HasSubstr("meteorological data"));
    EXPECT_THAT(with_first_line("     2.11           Z"), HasSubstr("file type 'Z'"));
    EXPECT_THAT(with_first_line("     3.02           G: GLONASS NAV DATA"), HasSubstr("file type 'G'"));
    EXPECT_THAT(with_first_line("     3.02           N: GNSS NAV DATA    X"), HasSubstr("satellite system 'X'"));
    for (const char* version : {"     1.00", "     3.33", "     9.99", "      nan", "         ", "      abc"})
        EXPECT_THAT(with_first_line(std::string(version) + "           N: GPS NAV DATA"),
                    StartsWith("made.nav:1: found RINEX version"));
}

TEST(NavigationSystems, SurvivesAnyCutAndAnyChangedByteOfAMixedFile) {
    const std::string text = header_v3("3.05") + galileo_text("E11", 517) +
                             state_vector_text({.first = std::string("R03") + march_5}, 4, true) +
                             sbas_text(std::string("S23") + march_5);
    for (std::size_t size = 0; size < text.size(); size += 3) {
        const auto file = read_navigation(text.substr(0, size), "cut.nav");
        EXPECT_TRUE(file || file.error().message.starts_with("cut.nav:")) << size;
    }
    for (std::size_t at = 0; at < text.size(); ++at)
        for (const char c : {'\0', '\n', '-', '9', 'R', '\xff'}) {
            std::string bent = text;
            bent[at] = c;
            const auto file = read_navigation(bent, "bent.nav");
            EXPECT_TRUE(!file || file->records.size() <= 3) << at;
        }
}

}  // namespace
}  // namespace skyloop::test
