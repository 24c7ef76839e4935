#include "world/rinex/almanac_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string yuma_record =
    "******** Week  377 almanac for PRN-05 ********\n"
    "ID:                         05\n"
    "Health:                     000\n"
    "Eccentricity:               0.6597995758E-002\n"
    "Time of Applicability(s):  319488.0000\n"
    "Orbital Inclination(rad):   0.9893061549\n"
    "Rate of Right Ascen(r/s):  -0.7508884204E-008\n"
    "SQRT(A)  (m 1/2):           5153.683594\n"
    "Right Ascen at Week(rad):  -0.5644326501E+000\n"
    "Argument of Perigee(rad):  -1.781409342\n"
    "Mean Anom(rad):             0.4668447322E+000\n"
    "Af0(s):                     0.8964538574E-004\n"
    "Af1(s/s):                   0.3637978807E-011\n"
    "week:                        377\n";

const std::string sem_text =
    "1  CURRENT.ALM\n 377 319488\n\n5\n32\n0\n"
    " 6.597995758E-03  1.5E-02 -2.5E-09\n 5.153683594E+03 -5.0E-01 -2.5E-01\n 1.25E-01  8.9E-05  3.6E-12\n0\n9\n";

const GpsTime pivot = gps_calendar_time(2007, 1, 1, 0, 0, 0);

std::string almanac_refusal(const std::string& text) {
    const auto records = read_almanac(text, "made.alm", pivot);
    EXPECT_FALSE(records);
    return records ? std::string() : records.error().message;
}

std::string with_line(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(AlmanacFile, ReadsYuma) {
    ASSERT_TRUE(is_almanac(yuma_record));
    const auto records = read_almanac(yuma_record + "\n" + yuma_record, "made.alm", pivot);
    ASSERT_TRUE(records) << records.error().message;
    ASSERT_EQ(records->size(), 2u);
    const KeplerEphemeris& e = records->front();
    EXPECT_EQ(to_string(e.satellite), "G05");
    EXPECT_EQ(e.message, NavigationMessage::almanac);
    EXPECT_EQ(e.toe, to_gps_time(1024 + 377, 319488.0));
    EXPECT_EQ(e.e, 0.006597995758);
    EXPECT_EQ(e.i0, 0.9893061549);
    EXPECT_EQ(e.omega_dot, -7.508884204e-9);
    EXPECT_EQ(e.sqrt_a, 5153.683594);
    EXPECT_EQ(e.omega0, -0.5644326501);
    EXPECT_EQ(e.omega, -1.781409342);
    EXPECT_EQ(e.m0, 0.4668447322);
    EXPECT_EQ(e.af0, 8.964538574e-5);
    EXPECT_EQ(e.af1, 3.637978807e-12);
    EXPECT_TRUE(e.healthy());
    const GpsTime later = gps_calendar_time(2027, 1, 1, 0, 0, 0);
    EXPECT_EQ(read_almanac(yuma_record, "made.alm", later)->front().toe, to_gps_time(2048 + 377, 319488.0));
    const auto qzss = read_almanac(with_line(yuma_record, "                05", "               194"), "q.alm", pivot);
    ASSERT_TRUE(qzss) << qzss.error().message;
    EXPECT_EQ(to_string(qzss->front().satellite), "J02");
}

TEST(AlmanacFile, ReadsSem) {
    ASSERT_TRUE(is_almanac(sem_text));
    const auto records = read_almanac(sem_text, "made.alm", pivot);
    ASSERT_TRUE(records) << records.error().message;
    ASSERT_EQ(records->size(), 1u);
    const KeplerEphemeris& e = records->front();
    EXPECT_EQ(to_string(e.satellite), "G05");
    EXPECT_EQ(e.toe, to_gps_time(1024 + 377, 319488.0));
    EXPECT_DOUBLE_EQ(e.i0, 0.315 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(e.omega0, -0.5 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(e.omega, -0.25 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(e.m0, 0.125 * std::numbers::pi);
    EXPECT_EQ(e.af1, 3.6e-12);
}

TEST(AlmanacFile, PassesOverTheMarksOfEditorsAndTabs) {
    std::string tabs = yuma_record;
    for (std::size_t colon = tabs.find(":  "); colon != std::string::npos; colon = tabs.find(":  "))
        tabs.replace(colon, tabs.find_first_not_of(' ', colon + 1) - colon, ":\t");
    EXPECT_FALSE(is_almanac("\t\n377 319488\n"));
    for (const std::string& text : {yuma_record, tabs, with_line(tabs, "\nID", "\n\tID"), sem_text}) {
        const std::string marked = "\xEF\xBB\xBF" + text;
        EXPECT_TRUE(is_almanac(marked)) << text;
        const auto records = read_almanac(marked, "made.alm", pivot);
        ASSERT_TRUE(records) << records.error().message;
        EXPECT_EQ(records->at(0).sqrt_a, read_almanac(text, "made.alm", pivot)->at(0).sqrt_a);
        EXPECT_NEAR(records->at(0).sqrt_a, 5153.683594, 1e-6);
    }
}

TEST(AlmanacFile, ServesForAWeek) {
    const auto records = read_almanac(yuma_record, "made.alm", pivot);
    const NavigationData data({records->begin(), records->end()}, std::nullopt, "made.alm");
    const SatelliteId g05{Constellation::gps, 5};
    const GpsTime toa = records->front().toe;
    EXPECT_TRUE(data.ephemeris(g05, toa + std::chrono::days(7)));
    EXPECT_FALSE(data.ephemeris(g05, toa + std::chrono::days(8)));
}

TEST(AlmanacFile, NamesTheLineThatIsWrong) {
    const std::string eccentricity = "Eccentricity:               0.6597995758E-002\n";
    EXPECT_THAT(almanac_refusal(with_line(yuma_record, eccentricity, "")),
                StartsWith("made.alm:1: found a record without 'Eccentricity'; expected a record of 13 lines"));
    EXPECT_THAT(almanac_refusal(with_line(yuma_record, eccentricity, eccentricity + eccentricity)),
                StartsWith("made.alm:5: found 'Eccentricity' for the second time"));
    EXPECT_THAT(almanac_refusal(with_line(yuma_record, "0.6597995758E-002", "0.66x")),
                StartsWith("made.alm:4: found '0.66x'; expected a number, Eccentricity"));
    EXPECT_THAT(almanac_refusal(with_line(yuma_record, "0.6597995758E-002", "0.7")),
                HasSubstr("Eccentricity between 0 and 0.5"));
    EXPECT_THAT(almanac_refusal(with_line(yuma_record, "Mean Anom", "Moan Anom")),
                StartsWith("made.alm:11: found 'Moan Anom"));
    EXPECT_THAT(almanac_refusal(with_line(sem_text, " 1.25E-01  8.9E-05  3.6E-12\n", "")),
                StartsWith("made.alm:9: found '0'; expected three numbers: mean anomaly, af0 and af1"));
    EXPECT_THAT(almanac_refusal(with_line(sem_text, "1  CURRENT", "2  CURRENT")),
                HasSubstr("found 1 records; expected 2, as the first line says"));
    EXPECT_THAT(almanac_refusal(sem_text.substr(0, sem_text.size() - 4)), HasSubstr("expected the health"));
    EXPECT_THAT(almanac_refusal("0  CURRENT\n 377 31\n"), HasSubstr("found no records; expected one at least"));
    EXPECT_THAT(almanac_refusal("RINEX?\n"), HasSubstr("found no almanac"));
    EXPECT_FALSE(is_almanac(""));
    EXPECT_FALSE(is_almanac("     2.11           N: GPS NAV DATA                         RINEX VERSION / TYPE\n"));
}

TEST(AlmanacFile, ReadsTheRealOnesAndRefusesTheWrongOnes) {
    SKYLOOP_REQUIRE_SHARED(folder, "nav/almanac");
    const std::map<std::string, std::size_t> counts{
        {"test_input_sem387.txt", 30}, {"test_input_yuma377.txt", 30}, {"yuma.txt", 31}};
    for (const auto& [name, count] : counts) {
        const std::string text = read_text_file(folder / name).value();
        ASSERT_TRUE(is_almanac(text)) << name;
        const auto records = read_almanac(text, name, pivot);
        ASSERT_TRUE(records) << records.error().message;
        EXPECT_EQ(records->size(), count) << name;
        for (const KeplerEphemeris& e : *records) {
            const double height = satellite_state(e, e.toe).position.vector().norm() - 26.56e6;
            EXPECT_LT(std::abs(height), 0.03 * 26.56e6) << name << ' ' << to_string(e.satellite);
        }
    }
    const auto refusal = [&](const std::string& name) {
        const auto records = read_almanac(read_text_file(folder / name).value(), name, pivot);
        return records ? std::string("read") : records.error().message;
    };
    EXPECT_THAT(refusal("wrong_yuma.txt"), StartsWith("wrong_yuma.txt:1: found a record without 'Eccentricity'"));
    EXPECT_THAT(refusal("wrong_sem.txt"), StartsWith("wrong_sem.txt:9: found '0'; expected three numbers: mean"));
}

}  // namespace
}  // namespace skyloop::test
