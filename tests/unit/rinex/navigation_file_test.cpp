#include "world/rinex/navigation_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <filesystem>

#include "base/time/utc_time.hpp"
#include "navigation_text.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string iono_v2 = header_line("    1.0000D-08  2.0000D-08 -6.0000D-08 -1.0000D-07", "ION ALPHA") +
                            header_line("    8.0000D+04  9.0000D+04 -6.0000D+04 -5.0000D+05", "ION BETA");

NavigationFile read_good(const std::string& text) {
    const Result<NavigationFile> file = read_navigation(text, "made.nav");
    EXPECT_TRUE(file) << file.error().message;
    return file ? *file : NavigationFile{};
}

std::string read_bad(const std::string& text) {
    const Result<NavigationFile> file = read_navigation(text, "made.nav");
    EXPECT_FALSE(file) << "read " << file->records.size() << " records";
    if (file) return {};
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    return file.error().message;
}

// The one record of a text, read without a warning.
KeplerEphemeris read_one(const std::string& text) {
    const NavigationFile file = read_good(text);
    EXPECT_EQ(file.records.size(), 1u);
    EXPECT_THAT(file.warnings, ::testing::IsEmpty());
    return file.records.empty() ? KeplerEphemeris{} : std::get<KeplerEphemeris>(file.records.front());
}

// The only warning of a text of which one record survives.
std::string only_warning(const std::string& text) {
    const NavigationFile file = read_good(text);
    EXPECT_EQ(file.records.size(), 1u);
    EXPECT_EQ(file.warnings.size(), 1u);
    return file.warnings.empty() ? "" : file.warnings.front();
}

TEST(NavigationFile, ReadsEveryFieldOfARecord) {
    const KeplerEphemeris e = read_one(header_v2() + record_text({}));
    EXPECT_EQ(e.satellite, (SatelliteId{Constellation::gps, 5}));
    EXPECT_EQ(e.toc, gps_calendar_time(2024, 3, 5, 2, 0, 0));
    EXPECT_EQ(e.toe, e.toc);
    EXPECT_EQ(e.af0, 1.5e-4);
    EXPECT_EQ(e.af1, -1e-12);
    EXPECT_EQ(e.af2, 0);
    EXPECT_EQ(e.iode, 55);
    EXPECT_EQ(e.crs, -20.5);
    EXPECT_EQ(e.delta_n, 4.6e-9);
    EXPECT_EQ(e.m0, 0.7);
    EXPECT_EQ(e.cuc, -1e-6);
    EXPECT_EQ(e.e, 0.011);
    EXPECT_EQ(e.cus, 7e-6);
    EXPECT_EQ(e.sqrt_a, 5153.7);
    EXPECT_EQ(e.cic, 5e-8);
    EXPECT_EQ(e.omega0, 1.2);
    EXPECT_EQ(e.cis, -7e-8);
    EXPECT_EQ(e.i0, 0.96);
    EXPECT_EQ(e.crc, 250.25);
    EXPECT_EQ(e.omega, -2.1);
    EXPECT_EQ(e.omega_dot, -8e-9);
    EXPECT_EQ(e.idot, 2e-10);
    EXPECT_EQ(e.accuracy_m, 2.4);
    EXPECT_TRUE(e.healthy());
    EXPECT_EQ(e.tgd, -1e-8);
    EXPECT_EQ(e.iodc, 567);
    EXPECT_EQ(e.fit_interval_h, 4);
}

TEST(NavigationFile, ReadsAnyExponentLetterAndLineEnd) {
    const std::string plain = header_v2(iono_v2) + record_text({});
    const KeplerEphemeris expected = read_one(plain);
    for (const char letter : {'E', 'e', 'd'})
        EXPECT_EQ(read_one(header_v2() + record_text({.exponent = letter})).crc, expected.crc);
    EXPECT_EQ(read_one(with_crlf(plain)).m0, expected.m0);
    EXPECT_EQ(read_one(plain.substr(0, plain.size() - 1)).fit_interval_h, 4);
    EXPECT_EQ(read_one("\xEF\xBB\xBF" + plain).m0, expected.m0) << "byte order mark";
    std::string leading_point = replaced(plain, field(0.7), "  .700000000000D+00");
    EXPECT_EQ(read_one(leading_point).m0, 0.7);
    EXPECT_EQ(read_one(replaced(plain, field(0.7), " +.700000000000D+00")).m0, 0.7);
    EXPECT_EQ(read_one(replaced(plain, field(250.25), "    250.25         ")).crc, 250.25);
}

TEST(NavigationFile, DoesNotDependOnTheLocale) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    for (const char* name : {"de_DE.UTF-8", "C.UTF-8"})
        std::setlocale(LC_NUMERIC, name);
    EXPECT_EQ(read_one(header_v2() + record_text({})).crc, 250.25);
    std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(NavigationFile, ReadsTheHeader) {
    const NavigationFile file = read_good(header_v2(iono_v2 + header_line("    18", "LEAP SECONDS")) + record_text({}));
    EXPECT_EQ(file.version, 2.11);
    EXPECT_EQ(file.leap_seconds, 18);
    ASSERT_TRUE(file.ionosphere.gps);
    EXPECT_EQ(file.ionosphere.gps->alpha, (std::array<double, 4>{1e-8, 2e-8, -6e-8, -1e-7}));
    EXPECT_EQ(file.ionosphere.gps->beta, (std::array<double, 4>{8e4, 9e4, -6e4, -5e5}));

    const NavigationFile without = read_good(header_v2() + record_text({}));
    EXPECT_FALSE(without.ionosphere.gps);
    EXPECT_FALSE(without.leap_seconds);
}

TEST(NavigationFile, WarnsOfADamagedHeaderLineAndReadsOn) {
    const std::string records = record_text({});
    const std::string bad_alpha = replaced(iono_v2, "1.0000D-08", "x.0000D-08");
    EXPECT_THAT(only_warning(header_v2(bad_alpha) + records),
                StartsWith("made.nav:2:3: found 'x.0000D-08'; expected an ionosphere"));
    EXPECT_FALSE(read_good(header_v2(bad_alpha) + records).ionosphere.gps);
    EXPECT_THAT(only_warning(header_v2(iono_v2.substr(0, iono_v2.find('\n') + 1)) + records),
                HasSubstr("only one of the two lines"));
    EXPECT_THAT(only_warning(header_v2(header_line("  1x", "LEAP SECONDS")) + records),
                HasSubstr("expected the number of leap seconds"));
    EXPECT_THAT(only_warning(header_v2(header_line("    18", "LEEP SECONDS")) + records),
                HasSubstr("made.nav:2: found '18"));
}

TEST(NavigationFile, ResolvesTwoDigitYearsAndShortWeeks) {
    const auto toc_of = [](std::string first, double tow, double week) {
        return read_one(header_v2() + record_text({.first = std::move(first), .toe_tow = tow, .week = week})).toc;
    };
    // 1999-09-02 is a Thursday of week 1025, which broadcasts as week 1.
    for (const double week : {1025.0, 1.0})
        EXPECT_EQ(toc_of(" 6 99  9  2 17 51 44.0", 409904, week), gps_calendar_time(1999, 9, 2, 17, 51, 44));
    EXPECT_EQ(toc_of(" 6 80  1  6  0  0  0.0", 0, 0), gps_calendar_time(1980, 1, 6, 0, 0, 0));
    EXPECT_EQ(toc_of(" 6 79 12 31  0  0  0.0", 0, 5217), gps_calendar_time(2079, 12, 31, 0, 0, 0));
    EXPECT_EQ(toc_of(" 6 00  1  1  0  0  0.0", 518400, 1042), gps_calendar_time(2000, 1, 1, 0, 0, 0));
}

TEST(NavigationFile, ResolvesToeAcrossTheEndOfTheWeek) {
    // toe 16 s before the week's end with the clock's epoch in the next week, and the other way round.
    const std::string before = record_text({.first = " 6 24  3 10  0  0  0.0", .toe_tow = 604784, .week = 2304});
    EXPECT_EQ(read_one(header_v2() + before).toe, to_gps_time(2304, 604784.0));
    const std::string after = record_text({.first = " 6 24  3  9 23 59 44.0", .toe_tow = 0, .week = 2305});
    EXPECT_EQ(read_one(header_v2() + after).toe, to_gps_time(2305, 0.0));
    EXPECT_EQ(read_one(header_v2() + after).toc, to_gps_time(2304, 604784.0));
}

TEST(NavigationFile, ReadsSecondsOfEveryKind) {
    const auto toc_of = [](const std::string& first) {
        return read_one(header_v2() + record_text({.first = first})).toc;
    };
    EXPECT_EQ(toc_of(" 5 24  3  5  1 59 44.0"), gps_calendar_time(2024, 3, 5, 1, 59, 44));
    EXPECT_EQ(toc_of(" 5 24 03 05 02 00  0.0"), gps_calendar_time(2024, 3, 5, 2, 0, 0));
    EXPECT_EQ(toc_of(" 5 24  3  5  2  0 00.5"), gps_calendar_time(2024, 3, 5, 2, 0, 0.5));
}

TEST(NavigationFile, TakesBlankFieldsAsZeroExceptThoseOfTheOrbit) {
    const std::string blank(19, ' ');
    const std::string good = header_v2() + record_text({});
    EXPECT_EQ(read_one(replaced(good, field(250.25), blank)).crc, 0);
    EXPECT_EQ(read_one(replaced(good, field(2304), blank)).toe, gps_calendar_time(2024, 3, 5, 2, 0, 0));
    EXPECT_EQ(read_one(replaced(good, field(2.4) + field(0) + field(-1e-8) + field(567), "")).iodc, 0)
        << "a short line";

    for (const double needed : {5153.7, 0.011, tuesday_s + 7200, 0.7, 1.2, 0.96, -2.1}) {
        const std::string warning =
            only_warning(replaced(good, field(needed), blank) + record_text({.first = " 7 24  3  5  2  0  0.0"}));
        EXPECT_THAT(warning, HasSubstr("found a blank field; expected a number")) << needed;
        EXPECT_THAT(warning, HasSubstr("record skipped"));
    }
    EXPECT_THAT(read_bad(replaced(good, field(5153.7), blank)), StartsWith("made.nav:5:61: found a blank field"));
}

TEST(NavigationFile, KeepsUnhealthyRecords) {
    const KeplerEphemeris e = read_one(header_v2() + record_text({.health = 63}));
    EXPECT_EQ(e.health, 63);
    EXPECT_FALSE(e.healthy());
}

TEST(NavigationFile, IgnoresWhatStandsBeyondTheFields) {
    std::string text = record_text({});
    std::string longer;
    for (const char c : text)
        longer += c == '\n' ? std::string("   words far beyond column eighty\n") : std::string(1, c);
    // The last line has room for two spare fields.
    longer = replaced(longer, "   words far beyond column eighty\n", field(9.99e8) + "\n");
    EXPECT_EQ(read_one(header_v2() + text.substr(0, text.size() - 1) + field(0) + field(9.99e8) + "\n").fit_interval_h,
              4);
    EXPECT_EQ(read_good(header_v2() + longer).records.size(), 1u);
}

TEST(NavigationFile, SkipsDefectiveRecordsWithOneCountedWarning) {
    const std::string good = record_text({.first = " 7 24  3  5  2  0  0.0"});
    const std::string bad = replaced(record_text({}), field(0.011), "       0.011x      ");
    const NavigationFile file = read_good(header_v2() + bad + good + bad + bad);
    EXPECT_EQ(file.records.size(), 1u);
    EXPECT_EQ(file.skipped.defective, 3);
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_EQ(
        file.warnings[0],
        "made.nav:5:23: found '0.011x'; expected a number, the eccentricity; record skipped, and 2 more likewise");
}

TEST(NavigationFile, SkipsRecordsThatNoSatelliteBroadcasts) {
    const std::string good = record_text({.first = " 7 24  3  5  2  0  0.0"});
    const std::string plain = record_text({});
    const auto warning = [&](const std::string& bad) { return only_warning(header_v2() + bad + good); };
    EXPECT_THAT(warning(replaced(plain, field(0.011), field(1.5))), HasSubstr("the eccentricity between 0 and 0.5"));
    EXPECT_THAT(warning(replaced(plain, field(0.011), "                nan")), HasSubstr("found 'nan'"));
    EXPECT_THAT(warning(replaced(plain, field(0.011), "               1e99")), HasSubstr("found '1e99'"));
    EXPECT_THAT(warning(replaced(plain, field(0.011), "              1e999")), HasSubstr("found '1e999'"));
    EXPECT_THAT(warning(record_text({.toe_tow = 604801})), HasSubstr("the toe between 0 and 604800"));
    EXPECT_THAT(warning(record_text({.toe_tow = tuesday_s + 3 * 86400})), HasSubstr("toe within a day"));
    EXPECT_THAT(warning(record_text({.week = 2200})), HasSubstr("found GPS week 2200; expected week 2304"));
    EXPECT_THAT(warning(record_text({.first = " 5 24 13  5  2  0  0.0"})), HasSubstr("expected a calendar epoch"));
    EXPECT_THAT(warning(record_text({.first = " 5 24  2 30  2  0  0.0"})), HasSubstr("expected a calendar epoch"));
    EXPECT_THAT(warning(record_text({.first = " 5 24  3  5 25  0  0.0"})), HasSubstr("expected a calendar epoch"));
    EXPECT_THAT(warning(record_text({.first = " 0 24  3  5  2  0  0.0"})), HasSubstr("expected a satellite number"));
}

TEST(NavigationFile, KeepsTheReadablePartOfATruncatedFile) {
    const std::string text = header_v2() + record_text({}) + record_text({.first = " 7 24  3  5  2  0  0.0"});
    // Cut anywhere in the second record before its last line begins.
    const std::size_t second = text.find(" 7 24");
    const std::size_t last_line = text.rfind("\n", text.size() - 2) + 1;
    for (std::size_t size = second + 2; size < last_line; size += 7) {
        const NavigationFile file = read_good(text.substr(0, size));
        ASSERT_EQ(file.records.size(), 1u) << size;
        ASSERT_EQ(file.warnings.size(), 1u) << size;
        EXPECT_EQ(file.skipped.incomplete, 1) << size;
        EXPECT_THAT(file.warnings[0], HasSubstr("made.nav:11: found a record of G07 cut off after")) << size;
    }
    EXPECT_THAT(read_bad(text.substr(0, second - 100)), HasSubstr("no record could be read"));
}

TEST(NavigationFile, ResumesAfterLinesAreMissing) {
    std::string torn = record_text({});
    torn.erase(torn.find('\n') + 1, 80);
    const NavigationFile file =
        read_good(header_v2() + torn + record_text({.first = " 7 24  3  5  2  0  0.0"}) + "   stray\n\n");
    ASSERT_EQ(file.records.size(), 1u);
    EXPECT_EQ(satellite_of(file.records[0]).number, 7);
    EXPECT_EQ(file.warnings.size(), 2u);
}

TEST(NavigationFile, RefusesWhatIsNoNavigationFile) {
    EXPECT_EQ(read_bad(""),
              "made.nav:1: found an empty file; expected navigation data (RINEX 2.00-2.12, 3.00-3.05 or 4.00-4.02)");
    EXPECT_THAT(read_bad("\n \r\n"), HasSubstr("an empty file"));
    EXPECT_THAT(read_bad("An almanac\n\n****\n"), HasSubstr("or the first line of a YUMA or SEM almanac"));
    EXPECT_THAT(read_bad("{\"a\": 1}\n"), StartsWith("made.nav:1: found '{\"a\": 1}'; expected a RINEX header"));
    EXPECT_THAT(read_bad(std::string("\x00\x01\xff\x1b[2J", 7)), StartsWith("made.nav:1: found '????[2J'"));
    EXPECT_THAT(read_bad(std::string(100'000, 'x')), HasSubstr("…'"));
    EXPECT_THAT(read_bad(header_v2()), StartsWith("made.nav:2: found the end of the file and no ephemeris"));
    const std::string endless = header_v2(iono_v2).substr(0, header_v2(iono_v2).find("END OF") - 60);
    EXPECT_THAT(read_bad(endless), StartsWith("made.nav:3: found the end of the file within the header"));
    EXPECT_THAT(read_bad(endless + record_text({})), StartsWith("made.nav:4: found '5 24  3  5"));
}

TEST(NavigationFile, SurvivesAnyCutAndAnyChangedByte) {
    const std::string text = header_v2(iono_v2) + record_text({}) +
                             record_text({.first = " 7 24  3  5  4  0  0.0", .toe_tow = tuesday_s + 14400});
    for (std::size_t size = 0; size < text.size(); ++size) {
        const auto file = read_navigation(text.substr(0, size), "cut.nav");
        EXPECT_TRUE(file || file.error().message.starts_with("cut.nav:")) << size;
    }
    for (std::size_t at = 0; at < text.size(); ++at)
        for (const char c : {'\0', '\n', '-', '9', 'D', '\xff'}) {
            std::string bent = text;
            bent[at] = c;
            const auto file = read_navigation(bent, "bent.nav");
            EXPECT_TRUE(!file || file->records.size() <= 2) << at;
        }
}

TEST(NavigationFile, NamesAFileThatIsNotThere) {
    const auto file = read_navigation_file("/no/such/file.24n");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::outside);
    EXPECT_THAT(file.error().message, HasSubstr("/no/such/file.24n"));
}

}  // namespace
}  // namespace skyloop::test
