#include "world/rinex/detail/compact_observations.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <sstream>
#include <string>

#include "base/core/archive.hpp"
#include "base/core/files.hpp"
#include "support/oracle_table.hpp"
#include "support/packed.hpp"
#include "world/rinex/observation_reader.hpp"

namespace skyloop::test {
namespace {

using testing::HasSubstr;

std::string labelled(std::string text, const std::string& label) {
    text.resize(60, ' ');
    return text + label + "\n";
}

std::string compact_begin(const std::string& version) {
    return labelled(version + "                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE") +
           labelled("RNX2CRX ver.4.1.0", "CRINEX PROG / DATE");
}

const std::string header_2 = labelled("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE") +
                             labelled("     6    C1    L1    L2    P2    S1    S2", "# / TYPES OF OBSERV") +
                             labelled("", "END OF HEADER");
const std::string header_3 = labelled("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
                             labelled("G    2 C1C L1C", "SYS / # / OBS TYPES") +
                             labelled("R    1 C1C", "SYS / # / OBS TYPES") + labelled("", "END OF HEADER");

std::string restored(const std::string& compact) {
    const auto text = rinex::from_compact(compact, "a.crx");
    if (text) return *text;
    EXPECT_EQ(text.error().code, ErrorCode::input);
    return text.error().message;
}

std::string restored_3(const std::string& body) {
    const std::string text = restored(compact_begin("3.0") + header_3 + body);
    return text.starts_with(header_3) ? text.substr(header_3.size()) : text;
}

TEST(CompactObservations, RestoresVersion1) {
    std::string satellites = "G01R02", written = "G01R02";
    std::string lines, more;
    for (int i = 3; i <= 13; ++i) {
        satellites += "G" + std::to_string(i + 10);
        if (i <= 12) written += "G" + std::to_string(i + 10);
        lines += "1&20000000000      \n";
        more += "  20000000.000\n\n";
    }
    const std::string text = restored(
        compact_begin("1.0") + header_2 + "&24  1  1  0  0  0.0000000  0  2G01R02\n1&123456789\n" +
        "3&20000000123 3&105000000456  1&20000000999 1&45000     7   5 1\n" + "3&19000000000 3&100000000000 3&-500 \n" +
        // One satellite less, the clock goes on, a blank observation loses its flags.
        "                3              1G01&&&\n-11\n1000 -3  1 -1000     8   &\n" +
        // An event with a comment, after which all begins anew; the clock is unknown; two lines of satellites.
        "&                           4  1\n" + labelled("a car passes", "COMMENT") +
        "&24  1  1  0  1  0.0000000  0 13" + satellites + "\n\n1&1     \n1&2     \n" + lines);
    EXPECT_EQ(text, header_2 + " 24  1  1  0  0  0.0000000  0  2G01R02                               0.123456789\n" +
                        "  20000000.123   105000000.456 7                  20000000.999 5        45.000 1\n" + "\n" +
                        "  19000000.000   100000000.000          -0.500\n" + "\n" +
                        " 24  1  1  0  0 30.0000000  0  1G01                                  0.123456778\n" +
                        "  20000001.123   105000000.453 8                  20000001.000          44.000 1\n\n" +
                        "                            4  1\n" + labelled("a car passes", "COMMENT") +
                        " 24  1  1  0  1  0.0000000  0 13" + written + "\n" + std::string(32, ' ') + "G23\n" +
                        "         0.001\n\n         0.002\n\n" + more);
}

TEST(CompactObservations, RestoresVersion3) {
    EXPECT_EQ(restored_3("> 2024 01 01 12 00  0.0000000  0  2      G01R02\n2&-1234567890123\n"
                         "3&20000000123 3&105000000456  7 6\n3&19000000000  8\n"
                         "& 2024: a line that is passed over\n"
                         "                    1             1      R02&&&\n\n5\n"
                         // The clock and G01 begin anew; a flag may stand without its observation.
                         "                    2             2      G01R02\n0&7\n1&1 1&2\n-5  &\n"
                         "                    3\n-7\n 5  9\n\n"),
              "> 2024 01 01 12 00  0.0000000  0  2      -1.234567890123\n"
              "G01  20000000.123 7 105000000.456 6\n"
              "R02  19000000.000 8\n"
              "> 2024 01 01 12 00  1.0000000  0  1\n"
              "R02  19000000.005 8\n"
              "> 2024 01 01 12 00  2.0000000  0  2       0.000000000007\n"
              "G01         0.001           0.002\n"
              "R02  19000000.005\n"
              "> 2024 01 01 12 00  3.0000000  0  2      -0.000000000007\n"
              "G01               9         0.007\n"
              "R02\n");
}

TEST(CompactObservations, TakesTypesOfEvents) {
    EXPECT_EQ(restored_3("> 2024 01 01 12 00  0.0000000  4  2\n" + labelled("R    2 C1C L1C", "SYS / # / OBS TYPES") +
                         labelled("now with phases", "COMMENT") +
                         "> 2024 01 01 12 00  1.0000000  0  1      R02\n\n0&1000 0&2000\n"),
              "> 2024 01 01 12 00  0.0000000  4  2\n" + labelled("R    2 C1C L1C", "SYS / # / OBS TYPES") +
                  labelled("now with phases", "COMMENT") +
                  "> 2024 01 01 12 00  1.0000000  0  1\nR02         1.000           2.000\n");
}

// Differences of each order, taken by a table.
TEST(CompactObservations, RestoresDifferencesUpToTheNinth) {
    constexpr std::size_t count = 14;
    for (int order = 0; order <= 9; ++order) {
        std::array<std::int64_t, count> values{}, told{};
        for (std::size_t i = 0; i < count; ++i)
            values[i] = 20'000'000'123 + static_cast<std::int64_t>((i * i * i * 7919 + i * i * 104'729) % 999'983) * 37;
        for (std::size_t i = 0; i < count; ++i) {
            std::array<std::int64_t, count> table = values;
            const std::size_t times = std::min(i, static_cast<std::size_t>(order));
            for (std::size_t difference = 0; difference < times; ++difference)
                for (std::size_t k = i; k > difference; --k)
                    table[k] -= table[k - 1];
            told[i] = table[i];
        }
        std::string compact, expected;
        for (std::size_t i = 0; i < count; ++i) {
            const char digit = static_cast<char>('A' + i);  // a second that differs from line to line
            compact += i == 0 ? "> 2024 01 01 12 00  A.0000000  0  1      R02\n\n" + std::to_string(order) + "&"
                              : std::string(20, ' ') + digit + "\n\n";
            compact += std::to_string(told[i]) + "\n";
            const std::string thousandths = std::to_string(values[i] % 1000);
            expected += std::string("> 2024 01 01 12 00  ") + digit + ".0000000  0  1\nR02  " +
                        std::to_string(values[i] / 1000) + "." + std::string(3 - thousandths.size(), '0') +
                        thousandths + "\n";
        }
        EXPECT_EQ(restored_3(compact), expected) << "order " << order;
    }
}

TEST(CompactObservations, NamesTheLineOfADamage) {
    const std::string head = "> 2024 01 01 12 00  0.0000000  0  1      R02\n";
    EXPECT_EQ(restored(compact_begin("2.0") + header_3),
              "a.crx:1: found compact RINEX version '2.0'; expected 1.0 or 3.0");
    EXPECT_EQ(restored(compact_begin("3.0") + header_3.substr(0, 100)),
              "a.crx:4: found the end of the file within the header; expected a whole compact RINEX file");
    EXPECT_EQ(restored_3("                   1\n"),
              "a.crx:7: found '1'; expected an epoch that depends on none before it");
    EXPECT_EQ(restored_3("> 2024 01 01 12 00  0.0000000  x  1      R02\n"),
              "a.crx:7: found '> 2024 01 01 12 00  0.0000000  x  1     …'; expected an epoch with its flag and the "
              "count of its satellites");
    EXPECT_THAT(restored_3("> 2024 01 01 12 00  0.0000000  0 12      R02\n"),
                HasSubstr("a.crx:7: found '> 2024 01 01 12 00  0.0000000  0 12     …'; expected the names of 12"));
    EXPECT_EQ(restored_3("> 2024 01 01 12 00  0.0000000  0  1      E02\n\n1&1\n"),
              "a.crx:9: found satellite 'E02'; expected one whose observation types are declared");
    EXPECT_EQ(restored_3(head + "x\n"), "a.crx:8: found 'x'; expected the offset of the receiver's clock");
    for (const char* field : {"5", "x&1", "3&", "3&1x", "3&99999999999999999999", "&1"})
        EXPECT_EQ(restored_3(head + "\n" + field + "\n"),
                  std::string("a.crx:9: found '") + field +
                      "'; expected the difference to an observation before it, or the start of a series");
    EXPECT_EQ(restored_3(head + "\n3&99999999999999\n"),
              "a.crx:9: found 99999999999999 thousandths; expected an observation that fits RINEX");
    EXPECT_EQ(restored_3(head + "\n3&1 789\n"), "a.crx:9: found '789'; expected two flags for each of 1 observations");
    for (const std::string& cut : {head, head + "\n", std::string("> 2024 01 01 12 00  0.0000000  4  2\n")})
        EXPECT_THAT(restored_3(cut), HasSubstr("found the end of the file within an e"));
}

TEST(CompactObservations, AreReadLikeOthers) {
    const std::string compact = compact_begin("3.0") + header_3 +
                                "> 2024 01 01 12 00  0.0000000  0  1      G01\n\n0&20000000123 0&105000000456\n";
    const auto file = read_observations(compact, "a.crx");
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->epochs.size(), 1u);
    EXPECT_EQ(file->epochs[0].signals.at(0).pseudorange->value(), 20000000.123);
    const auto odd = read_observations(compact_begin("3.0") + header_3 + "> 2024 01 01 12 00  0.0000000  0  0\n\n" +
                                           "> 2024 01 01 12 00  1.0000000  0  1      G01\n\n0&20000000123 0&1 \n" +
                                           "> 2024 13 01 12 00  1.0000000  0  0\n\n",
                                       "a.crx");
    ASSERT_TRUE(odd) << odd.error().message;
    EXPECT_THAT(odd->warnings.at(0), HasSubstr("a.crx, as RINEX:8: found '> 2024 13 01")) << "in lines of that";
}

TEST(CompactObservations, OfAStationAreItsObservations) {
    SKYLOOP_REQUIRE_SHARED(folder, "receivers/tlse_20240101");
    const std::string stem = (folder / "TLSE00FRA_R_20240011200_15M_01S_MO").string();
    const auto compact = read_text_file(stem + ".crx.gz"), plain = read_text_file(stem + ".rnx.gz");
    ASSERT_TRUE(compact && plain);
    std::istringstream lines(*plain);
    std::string line, expected;
    while (std::getline(lines, line)) {
        line.erase(line.find_last_not_of(' ') + 1);
        expected += line + '\n';
    }
    EXPECT_TRUE(restored(*compact) == expected) << "but for blanks at the ends of lines, all is as it was";
    for (const std::string& packed :
         {archive_of("zip", {{"TLSE.crx", *compact}}), compressed("compress", *compact), compressed("xz", *compact),
          archive_of("pax", {{"TLSE.crx.bz2", compressed("bzip2", *compact)}})})
        EXPECT_TRUE(unpacked(packed, "x", max_text_file_size).value() == *compact);
}

}  // namespace
}  // namespace skyloop::test
