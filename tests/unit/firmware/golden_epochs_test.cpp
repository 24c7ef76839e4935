// Fixed epochs against the exact bytes in tests/golden/vectors/nmea_epochs.txt.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "sample_reports.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;

// "[name]" lines and the sentences under them, each of which ends in CR LF on the wire; "#" starts a comment.
std::map<std::string, std::string> golden_epochs() {
    std::ifstream file(SKYLOOP_SOURCE_DIR "/tests/golden/vectors/nmea_epochs.txt");
    std::map<std::string, std::string> epochs;
    std::string name;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        if (line[0] == '[')
            name = line.substr(1, line.size() - 2), epochs[name];
        else
            epochs[name] += line + "\r\n";
    }
    return epochs;
}

void expect_golden(const std::string& name, const BoardProfile& board, const std::vector<Fix>& fixes) {
    SampleReceiver receiver(board);
    std::string bytes;
    for (const Fix& fix : fixes)
        for (const std::string& sentence : receiver.sentences(fix)) {
            EXPECT_LE(sentence.size(), 82U) << sentence;
            EXPECT_TRUE(decode_nmea(sentence)) << sentence;
            bytes += sentence;
        }
    const auto epochs = golden_epochs();
    const auto expected = epochs.find(name);
    ASSERT_NE(expected, epochs.end()) << "no [" << name << "]; the bytes are\n" << bytes;
    EXPECT_EQ(bytes, expected->second);
}

TEST(GoldenEpochs, GpsFixInVersion4_0) {
    Fix fix = sample_fix("2010-07-01T12:00:00Z", 46.4775, 30.7326, 77.0);
    add_satellites(fix, gps, 2, 9);
    expect_golden("gps fix, 4.0", sample_board(NmeaVersion::v4_0, {gps, sbas}), {fix});
}

TEST(GoldenEpochs, ColdStartThenTimeThenFixThenLost) {
    Fix none = sample_fix("2024-03-05T12:00:00Z", 0, 0, 0);
    none.type = FixType::none;
    Fix searching = none;
    add_satellites(searching, gps, 5, 3);
    Fix time_only = searching, fix = sample_fix("2024-03-05T12:00:02Z", 51.5, -0.125, 150), lost = searching;
    time_only.type = FixType::time_only;
    time_only.time += std::chrono::seconds(1);
    add_satellites(fix, gps, 5, 5);
    lost.time += std::chrono::seconds(3);
    const std::vector<Fix> fixes{none, searching, time_only, fix, lost};
    expect_golden("cold start, 4.0", sample_board(NmeaVersion::v4_0, {gps, sbas, qzss, glonass}), fixes);
    expect_golden("cold start, 4.10", sample_board(NmeaVersion::v4_10, {gps, sbas, galileo, beidou, glonass}), fixes);
}

TEST(GoldenEpochs, ManySatellitesOfAllSystemsInVersion4_10) {
    Fix fix = sample_fix("2024-03-05T12:00:00.1Z", 38.110494, -122.6268969, 53.55);
    fix.type = FixType::dgnss;
    fix.geoid_undulation = Metres(-29.5);
    fix.speed = MetresPerSecond(0.02);
    add_satellites(fix, gps, 1, 18);
    add_satellites(fix, sbas, 31, 2);
    add_satellites(fix, galileo, 3, 5);
    add_satellites(fix, beidou, 19, 6);
    add_satellites(fix, qzss, 2, 2);
    add_satellites(fix, glonass, 1, 4);
    expect_golden("all systems, 4.10", sample_board(NmeaVersion::v4_10, {gps, sbas, galileo, beidou, qzss, glonass}),
                  {fix});
    BoardProfile extended = sample_board(NmeaVersion::v4_0, {gps, sbas, galileo, beidou, qzss, glonass});
    extended.satellite_numbering = NmeaNumbering::extended;
    extended.max_listed_satellites = 99;
    expect_golden("all systems, 4.0 extended", extended, {fix});
}

TEST(GoldenEpochs, SouthAndWestAtTheYearsEndInVersion4_11) {
    Fix fix = sample_fix("2023-12-31T23:59:59.996Z", -33.9999999, -70.0000001, 567.891);
    fix.course = Angle::degrees(359.997);
    fix.dop.hdop = 12.345;
    add_satellites(fix, gps, 1, 5);
    add_satellites(fix, galileo, 1, 3);
    add_satellites(fix, qzss, 1, 3);
    expect_golden("south west, 4.11", sample_board(NmeaVersion::v4_11, {gps, sbas, galileo, beidou, qzss}), {fix});
}

TEST(GoldenEpochs, OtherKindsOfSolutionInVersion2_3) {
    std::vector<Fix> fixes;
    for (const FixType type : {FixType::fix_2d, FixType::dead_reckoning, FixType::rtk_float, FixType::rtk_fixed}) {
        fixes.push_back(sample_fix("2016-12-31T23:59:60.2Z", -0.0000000001, 179.99999999, -12.345));
        fixes.back().type = type;
        add_satellites(fixes.back(), glonass, 1, 4);
    }
    expect_golden("solutions, 2.3", sample_board(NmeaVersion::v2_3, {glonass}), fixes);
}

}  // namespace
}  // namespace skyloop::firmware
