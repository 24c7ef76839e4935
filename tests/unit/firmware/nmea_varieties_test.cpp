// What a board's own keys make of its sentences: headings, qualities, heights, satellites, late sentences, own lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "firmware/core/told_heading.hpp"
#include "firmware/sentences/own_lines.hpp"
#include "sample_reports.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Optional;
using testing::SizeIs;
using testing::StartsWith;

constexpr std::uint8_t gga = 0x00, gll = 0x01, gsa = 0x02, rmc = 0x04, vtg = 0x05, gns = 0x0D, ths = 0x0E, hdt = 0x30,
                       hdg = 0x31, rot = 0x32;

template <class Set>
SampleReceiver varied(Set set, NmeaVersion version = NmeaVersion::v4_10) {
    BoardProfile board = sample_board(version, {gps, sbas, galileo, glonass});
    set(board.style);
    SampleReceiver receiver(board);
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 3);
    add_satellites(fix, galileo, 11, 3);
    receiver.set(fix);
    return receiver;
}

// Quality of GGA, mode and status of RMC, mode of VTG.
std::string told(ToldQuality quality, FixType type, NmeaVersion version = NmeaVersion::v4_10, bool valid = false) {
    SampleReceiver receiver = varied([&](NmeaStyle& s) { s.quality = quality, s.simulated_is_valid = valid; }, version);
    receiver.state.epoch.fix.type = type;
    const auto line = messages_of_kind<Rmc>({receiver.line(rmc)}).at(0);
    EXPECT_EQ(messages_of_kind<Gll>({receiver.line(gll)}).at(0).valid, line.valid);
    std::string out = std::to_string(messages_of_kind<Gga>({receiver.line(gga)}).at(0).quality);
    out += static_cast<char>(*line.mode);
    out += line.valid ? 'A' : 'V';
    return out + static_cast<char>(*messages_of_kind<Vtg>({receiver.line(vtg)}).at(0).mode);
}

TEST(NmeaVarieties, CallFixesAsTheBoardSays) {
    EXPECT_EQ(told(ToldQuality::solved, FixType::fix_3d), "1AAA");
    EXPECT_EQ(told(ToldQuality::precise, FixType::fix_3d), "3PAP");
    EXPECT_EQ(told(ToldQuality::precise, FixType::fix_3d, NmeaVersion::v2_3), "3AAA") << "mode P came with 4.0";
    EXPECT_EQ(told(ToldQuality::precise, FixType::dgnss), "2DAD");
    EXPECT_EQ(told(ToldQuality::manual, FixType::fix_3d), "7MVM");
    EXPECT_EQ(told(ToldQuality::simulator, FixType::rtk_fixed), "8SVS");
    EXPECT_EQ(told(ToldQuality::simulator, FixType::fix_3d, NmeaVersion::v4_10, true), "8SAS");
    EXPECT_THAT(varied([](NmeaStyle& s) { s.quality = ToldQuality::simulator; }).line(gns), HasSubstr(",SNSN,"));
}

TEST(NmeaVarieties, CallNoFixNone) {
    SampleReceiver receiver = varied([](NmeaStyle& s) { s.quality = ToldQuality::simulator; });
    receiver.state.epoch.fix.type = FixType::none;
    receiver.state.fix_ok = false;
    EXPECT_THAT(receiver.line(rmc), HasSubstr(",V,"));
    EXPECT_EQ(messages_of_kind<Gga>({receiver.line(gga)}).at(0).quality, 0);
}

TEST(NmeaVarieties, TellSatellitesByTalkerOrInOne) {
    const auto by_talker = varied([](NmeaStyle& s) { s.gsa = GsaStyle::by_talker; }).message(gsa);
    ASSERT_THAT(by_talker, SizeIs(3));
    EXPECT_THAT(by_talker[0], StartsWith("$GPGSA,A,3,01,02,03,,"));
    EXPECT_THAT(by_talker[1], StartsWith("$GLGSA,A,3,,"));
    EXPECT_THAT(by_talker[2], StartsWith("$GAGSA,A,3,11,12,13,,"));
    const auto one = varied([](NmeaStyle& s) { s.gsa = GsaStyle::one; }).message(gsa);
    ASSERT_THAT(one, ElementsAre(StartsWith("$GNGSA,A,3,01,02,03,11,12,13,,,,,,,2.02,1.10,1.69,*")));
    SampleReceiver alone = varied([](NmeaStyle& s) { s.gsa = GsaStyle::one; });
    std::erase_if(alone.state.epoch.fix.satellites, [](const auto& s) { return s.id.constellation == gps; });
    EXPECT_THAT(alone.message(gsa), ElementsAre(HasSubstr(",1.69,3*"))) << "of one system, its id";
}

TEST(NmeaVarieties, TellTheGeoidOrNot) {
    const auto of = [](ToldGeoid geoid) { return varied([&](NmeaStyle& s) { s.geoid = geoid; }).line(gga); };
    EXPECT_THAT(of(ToldGeoid::separation), HasSubstr(",478.6,M,21.4,M,"));
    EXPECT_THAT(of(ToldGeoid::zero), HasSubstr(",500.0,M,0.0,M,"));
    EXPECT_THAT(of(ToldGeoid::nothing), HasSubstr(",500.0,M,,,,*"));
    EXPECT_THAT(varied([](NmeaStyle& s) { s.geoid = ToldGeoid::nothing; }).line(gns), HasSubstr(",500.0,,,"));
}

TEST(NmeaVarieties, TellHeadingsOfAPairBeforeAllOthers) {
    SampleReceiver receiver = varied([](NmeaStyle& s) { s.heading = HeadingSource::course; });
    EXPECT_THAT(receiver.line(ths), StartsWith("$GNTHS,77.78,E*"));
    receiver.state.epoch.relative.emplace().east_m = -1;
    EXPECT_THAT(receiver.line(ths), StartsWith("$GNTHS,270.00,A*"));
    EXPECT_THAT(receiver.line(hdt), StartsWith("$GNHDT,270.00,T*"));
    receiver.state.epoch.relative->base_moves = false;
    EXPECT_THAT(receiver.line(hdt), StartsWith("$GNHDT,77.78,T*")) << "a vector from a fixed base is no heading";
    receiver.state.fix_ok = false;
    EXPECT_THAT(receiver.line(hdt), StartsWith("$GNHDT,,T*"));
    EXPECT_THAT(receiver.line(ths), StartsWith("$GNTHS,,V*"));
}

TEST(NmeaVarieties, TellTheVehiclesAttitude) {
    SampleReceiver receiver = varied([](NmeaStyle& s) {
        s.magnetic_variation_deg = 3.5, s.heading_decimals = 1, s.heading = HeadingSource::attitude,
        s.heading_talker = "HE";
    });
    EXPECT_THAT(receiver.line(hdg), StartsWith("$HEHDG,,,,3.5,E*")) << "the path tells none";
    receiver.state.epoch.compass_heading = Angle::degrees(-178);
    receiver.state.turn_rate_dpm = -12.34;
    EXPECT_THAT(receiver.line(hdt), StartsWith("$HEHDT,182.0,T*"));
    EXPECT_THAT(receiver.line(hdg), StartsWith("$HEHDG,178.5,,,3.5,E*"));
    EXPECT_THAT(receiver.line(ths), StartsWith("$HETHS,182.0,A*"));
    EXPECT_THAT(receiver.line(rot), StartsWith("$HEROT,-12.3,A*"));
    EXPECT_THAT(receiver.line(gga), StartsWith("$GNGGA"));
    SampleReceiver simulated =
        varied([](NmeaStyle& s) { s.heading = HeadingSource::attitude, s.quality = ToldQuality::simulator; });
    simulated.state.epoch.compass_heading = Angle::degrees(2);
    EXPECT_THAT(simulated.line(ths), StartsWith("$GNTHS,2.00,S*"));
}

TEST(TurnRates, AreThoseOfHeadingsOfOneSource) {
    TurnRate rate;
    const GpsTime start(1000s);
    const auto heading = [](double degrees, HeadingSource from = HeadingSource::course) {
        return ToldHeading{Angle::degrees(degrees), from};
    };
    EXPECT_EQ(rate.follow(heading(359), start), std::nullopt);
    EXPECT_THAT(rate.follow(heading(1), start + 1s), Optional(testing::DoubleNear(120, 1e-9)));
    EXPECT_THAT(rate.follow(heading(0.5), start + 1200ms), Optional(testing::DoubleNear(-150, 1e-9)));
    EXPECT_EQ(rate.follow(heading(9, HeadingSource::antennas), start + 2s), std::nullopt);
    EXPECT_EQ(rate.follow(std::nullopt, start + 3s), std::nullopt);
    EXPECT_EQ(rate.follow(heading(9), start + 4s), std::nullopt);
    EXPECT_EQ(rate.follow(heading(9), start + 10s), std::nullopt) << "whole turns may lie between";
    EXPECT_EQ(rate.follow(heading(9), start + 10s), std::nullopt);
}

// What a receiver of sentences sends of so many epochs, a second each.
std::vector<std::string> sent(BoardProfile board, int seconds) {
    board.timing.boot = board.timing.first_epoch = Seconds(0);
    board.timing.cold_start = board.timing.hot_start = board.timing.warm_start = Seconds(0);
    board.baud = 115200;
    test::ReceiverRig rig(board);
    rig.world = [](GpsTime time) {
        Epoch epoch{test::driving_fix(time)};
        const auto second = static_cast<double>(time.time_since_epoch() / 1s % 360);
        epoch.compass_heading = Angle::degrees(second);
        return epoch;
    };
    rig.run(seconds * 1s + 500ms);
    std::istringstream lines(rig.sentences());
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);)
        all.push_back(line);
    return all;
}

BoardProfile sending(std::initializer_list<NmeaSentence> sentences) {
    BoardProfile board = sample_board(NmeaVersion::v4_10, {gps});
    board.sentences.clear();
    for (const NmeaSentence sentence : sentences)
        board.sentences.push_back({sentence, 1});
    return board;
}

TEST(LateSentences, TellTheEpochBefore) {
    BoardProfile board = sending({NmeaSentence::rmc, NmeaSentence::gga});
    board.style.late[{0xF0, rmc}] = 2;
    const auto lines = sent(board, 5);
    std::vector<unsigned> of_rmc, of_gga;
    for (const Rmc& message : messages_of_kind<Rmc>(lines))
        of_rmc.push_back(message.time->second);
    for (const Gga& message : messages_of_kind<Gga>(lines))
        of_gga.push_back(message.time->second);
    ASSERT_GE(of_gga.size(), 5U);
    ASSERT_EQ(of_rmc.size() + 2, of_gga.size()) << "of the first two epochs there is none before";
    for (std::size_t i = 0; i < of_rmc.size(); ++i)
        EXPECT_EQ(of_rmc[i] + 2, of_gga[i + 2]);
}

TEST(LateSentences, TurnRatesComeWithTheSecondHeading) {
    BoardProfile board = sending({NmeaSentence::rot});
    board.style.heading = HeadingSource::attitude;
    const auto turns = messages_of_kind<Rot>(sent(board, 4));
    ASSERT_GE(turns.size(), 3U);
    EXPECT_FALSE(turns.front().valid);
    EXPECT_TRUE(turns.back().valid);
    EXPECT_THAT(turns.back().degrees_per_minute, Optional(60.0));
}

TEST(OwnLines, LeaveWithTheirSentence) {
    BoardProfile board = sending({NmeaSentence::rmc, NmeaSentence::gga, NmeaSentence::gll});
    board.style.lines = {{"$PGRMZ,{altitude_ft:0},f,3", 1, NmeaSentence::gga},
                         {"$PXXX,{RMC.9},{GGA.6},{h_acc_m:2},{heading_deg},{GST.2}", 2, std::nullopt}};
    const auto lines = sent(board, 3);
    const auto altitude = std::ranges::find_if(lines, [](const auto& line) { return line.starts_with("$PGRMZ"); });
    ASSERT_NE(altitude, lines.end());
    EXPECT_THAT(*altitude, StartsWith("$PGRMZ,1447,f,3*")) << "441 m";
    EXPECT_TRUE(parse_sentence(*altitude));
    EXPECT_THAT(*(altitude - 1), HasSubstr("GGA,"));
    EXPECT_THAT(*(altitude + 1), HasSubstr("GLL,"));
    const auto whole = [&](std::string_view start) {
        return std::ranges::count_if(lines, [&](const auto& line) { return line.starts_with(start); });
    };
    const auto of_epochs = whole("$GPGGA");
    EXPECT_EQ(whole("$PGRMZ"), of_epochs);
    EXPECT_EQ(whole("$PXXX"), (of_epochs + 1) / 2);
    EXPECT_EQ(whole("$PXXX,050324,1,1.20,,"), whole("$PXXX")) << "it has no heading";
}

TEST(OwnLines, AreRefusedWithWhatIsWrong) {
    EXPECT_EQ(mistake_of_own_line("$PGRME,{h_acc_m:1},M,{GGA.9}"), std::nullopt);
    EXPECT_THAT(mistake_of_own_line("PGRME"), Optional(HasSubstr("from '$' on")));
    EXPECT_THAT(mistake_of_own_line("$PGRME*00"), Optional(HasSubstr("without checksum")));
    EXPECT_THAT(mistake_of_own_line("$PX,{GGA.1"), Optional(HasSubstr("each '{' to have its '}'")));
    EXPECT_THAT(mistake_of_own_line("$PX,{{GGA.1}}"), Optional(HasSubstr("each '{'")));
    EXPECT_THAT(mistake_of_own_line("$PX,{h_ac_m}"), Optional(HasSubstr("did you mean 'h_acc_m'?")));
    EXPECT_THAT(mistake_of_own_line("$PX,{GGA.0}"), Optional(HasSubstr("has '{GGA.0}'")));
    EXPECT_THAT(mistake_of_own_line("$PX,{XYZ.1}"), Optional(HasSubstr("a field of a sentence")));
    EXPECT_THAT(mistake_of_own_line("$PX,{h_acc_m:x}"), Optional(HasSubstr("has '{h_acc_m:x}'")));
    EXPECT_THAT(mistake_of_own_line("$PX,\n"), Optional(Not(HasSubstr("GGA.9"))));
}

}  // namespace
}  // namespace skyloop::firmware
