#include "world/broadcast/daily_navigation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const GpsTime new_year = gps_calendar_time(2023, 1, 1, 0, 0, 0);

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(DailyNavigation, ADayIsOneOfGpsTime) {
    EXPECT_EQ(day_of(new_year), new_year);
    EXPECT_EQ(day_of(new_year + 24h - 1ns), new_year);
    EXPECT_EQ(day_of(new_year - 1ns), new_year - 24h);
    EXPECT_EQ(day_text(new_year - 24h), "2022-12-31");
    EXPECT_EQ(parse_day("2023-01-01").value(), new_year);
    for (const char* wrong :
         {"", "2023", "2023-13-01", "2023-02-29", "01.01.2023", "2023-01-01T00:00:00Z", "20230101"}) {
        const auto day = parse_day(wrong);
        ASSERT_FALSE(day) << wrong;
        EXPECT_EQ(day.error().message, std::string("'") + wrong + "'; expected a day such as 2023-01-01");
    }
}

TEST(DailyNavigation, NamesAndAddressesHaveTheDay) {
    EXPECT_EQ(daily_navigation_name(new_year), "BRDC_20230010000_01D_MN.rnx.gz");
    EXPECT_EQ(daily_navigation_name(new_year - 24h), "BRDC_20223650000_01D_MN.rnx.gz");
    EXPECT_EQ(cached_navigation_path("/c", new_year), "/c/navigation/BRDC_20230010000_01D_MN.rnx.gz");
    EXPECT_EQ(address_of_day("https://a/{year}/{doy}/b{doy}0.{yy}n.gz", gps_calendar_time(2009, 2, 4, 0, 0, 0)),
              "https://a/2009/035/b0350.09n.gz");
}

TEST(DailyNavigation, AnAddressIsOfTheWeb) {
    EXPECT_TRUE(check_address_pattern("https://a/{year}{yy}{doy}.gz"));
    EXPECT_TRUE(check_address_pattern("http://127.0.0.1:8080/x"));
    for (const char* wrong : {"", "a/b", "ftp://a/{doy}", "file:///etc/passwd", "https://a/{day}", "https://a/{doy",
                              "https://a/b c", "https://a/\n", "https://a/ä"})
        EXPECT_FALSE(check_address_pattern(wrong)) << wrong;
}

TEST(DailyNavigation, MirrorsAreChosenInTheOrderOfTheirWords) {
    const std::vector<NavigationMirror> known{{"one", {"https://one/{doy}"}}, {"two", {"https://two/{doy}"}}};
    const std::vector<std::string> wanted{"two", "http://here/{doy}", "one"};
    const auto chosen = chosen_mirrors(known, wanted);
    ASSERT_TRUE(chosen);
    std::vector<std::string> addresses;
    for (const NavigationMirror& mirror : *chosen)
        addresses.push_back(mirror.addresses.front());
    EXPECT_THAT(addresses, ::testing::ElementsAre("https://two/{doy}", "http://here/{doy}", "https://one/{doy}"));
    EXPECT_EQ(chosen_mirrors(known, std::vector<std::string>{"owe"}).error().message,
              "'owe'; expected one, two or an address; did you mean 'one'?");
    EXPECT_FALSE(chosen_mirrors(known, std::vector<std::string>{"ftp://here/{doy}"}));
}

TEST(DailyNavigation, OtherBytesAreRefused) {
    const auto refusal = [](std::string_view bytes) {
        const auto checked = check_daily_navigation(bytes, "x.gz", new_year);
        return checked ? "taken" : checked.error().message;
    };
    EXPECT_EQ(refusal(""), "x.gz: found ''; expected a file packed by gzip");
    EXPECT_EQ(refusal("<html>\n\x80 and so on for long"),
              "x.gz: found '<html>.. and so on f'; expected a file packed by gzip");
    EXPECT_THAT(refusal("\x1f\x8b\x08"), HasSubstr("x.gz"));
}

// Those of the IGS of two years, and of a GPS week that is not theirs.
TEST(DailyNavigation, RealFilesOfADayAreTaken) {
    for (const int year : {2023, 2024}) {
        const std::string name = "BRDC00IGS_R_" + std::to_string(year) + "0010000_01D_MN.rnx.gz";
        SKYLOOP_REQUIRE_SHARED(file, "nav/" + name);
        const std::string bytes = bytes_of(file);
        const GpsTime day = gps_calendar_time(year, 1, 1, 0, 0, 0);
        const auto checked = check_daily_navigation(bytes, name, day);
        ASSERT_TRUE(checked) << checked.error().message;
        EXPECT_TRUE(checked->whole);
        EXPECT_EQ(checked->until, day + 24h);
        EXPECT_GT(checked->satellites, 110u);
        EXPECT_THAT(checked->systems, HasSubstr("gps, sbas, galileo, beidou"));
        const auto other = check_daily_navigation(bytes, name, day + 24h);
        ASSERT_FALSE(other);
        EXPECT_EQ(other.error().message,
                  name + ": its records are of " + day_text(day) + "; expected " + day_text(day + 24h));
        EXPECT_FALSE(check_daily_navigation(std::string_view(bytes).substr(0, bytes.size() / 2), name, day));
    }
}

// A single station sees but a part of the sky at any time.
TEST(DailyNavigation, AFileOfOneStationIsNone) {
    SKYLOOP_REQUIRE_SHARED(file, "nav/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");
    const auto checked = check_daily_navigation(bytes_of(file), "esbc", gps_calendar_time(2020, 6, 25, 0, 0, 0));
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message, ::testing::MatchesRegex("esbc: has orbits of [0-9]+ GPS satellites at 00:00; "
                                                                 "expected at least 24"));
}

}  // namespace
}  // namespace skyloop::test
