#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "receiver/protocol/unicore_logs.hpp"
#include "support/split_stream.hpp"

namespace skyloop::inline receiver {
namespace {

// Captures of a UM980 (jclark/satpulse, gps/testdata/packets/unicore), of a UM982 (unicore_um982_driver), samples of
// ArduPilot, PX4-GPSDrivers and rtkbase.
const std::string rectime_text =
    "#RECTIMEA,97,GPS,FINE,2379,369797000,0,0,18,18;VALID,-4.755795596e-04,1.302682980e-08,-18.00000000000,2025,8,14,6,"
    "42,59000,VALID*9f81d9db";
const std::string rectime_bytes =
    "aa44b56166002c0000a04b0988a70a16000000000012120000000000b39fb0a7e62a3fbfafeea64e93f94b3e00000000000032c0e907000008"
    "0e062a78e6000001000000b3998b61";
const std::string bestnav_text =
    "#BESTNAVA,97,GPS,FINE,2412,543074000,17548,0,18,17;SOL_COMPUTED,SINGLE,13.73180315099,100.64472527560,10.8046,"
    "-30.8309,WGS84,2.4735,1.9042,2.7234,\"\",0.000,1.000,32,28,28,0,1,12,11,51,SOL_COMPUTED,DOPPLER_VELOCITY,0.000,"
    "0.000,0.0051,9.232753,-0.0082,0.0275,0.0210*f20916c6";
const std::string bestnav_bytes =
    "aa44b5614608780000a06c09d0a65e208c440000001211000000000010000000ca3d11e7ae762b403767cd2d432959400000c08ff09b2540bf"
    "a5f6c13d0000009b4d1e4068bef33f4a4c2e4000000000000000000000803f201c1c000112115100000000080000000000000000000000bc71"
    "1cf1ee03753f19ba385a2b772240461a803038ba80bf905de13c825bac3c62ed7c7f";
const std::string heading_text =
    "#UNIHEADINGA,89,GPS,FINE,2251,168052600,0,0,18,11;SOL_COMPUTED,NARROW_INT,0.3718,67.0255,-0.7974,0.0000,0.8065,"
    "3.3818,\"999\",31,21,21,18,3,01,3,f3*ece5bb07";
const std::string agrica_text =
    "#AGRICA,82,GPS,FINE,2237,176366400,0,0,18,15;GNSS,232,22,11,22,0,59,8,1,5,8,12,0,0.0000,0.0000,0.0000,0.0000,0."
    "0000,"
    "0.0000,296.4656,-26.5685,0.0000,0.005,0.000,0.000,-0.005,0.044,0.032,0.038,-35.33142715815,149.13181842030,609."
    "1494,"
    "-4471799.0368,2672944.7758,-3668288.9857,1.3923,1.5128,3.2272,2.3026,2.1633,2.1586,0.00000000000,0.00000000000,"
    "0.0000,0.00000000000,0.00000000000,0.0000,176366400,0.000,66.175285,18.972784,0.000000,0.000000,5,0,0,0*9f704dad";
const std::string pvtsln_text =
    "#PVTSLNA,79,GPS,FINE,2377,93246900,0,0,18,8;SINGLE,188.1621,34.60324214605,-86.74943363150,7.5696,4.3304,3.4834,"
    "0.000,SINGLE,188.1621,34.60324214605,-86.74943363150,-28.5587,19,17,19,17,-0.0933,-0.0469,-0.1506,NONE,0.0000,"
    "0.0000,0.0000,0,0,0,0,2.8451,1.6314,0.8332,2.4753,2.3309,5.0,17,3,4,9,16,26,31,47,49,51,76,77,82,104,179,182,196,"
    "205*d127bb24";
const std::string version_text =
    "#VERSIONA,97,GPS,FINE,2343,48235000,0,0,18,813;\"UM980\",\"R4.10Build11833\",\"HRPT00-S10C-P\","
    "\"2310415000001-MD22A2225022497\",\"ff3ba396dcb0478d\",\"2023/11/24\"*270a13f7";

Bytes bytes_of(const std::string& digits) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    return bytes;
}

std::string body_of(const std::string& line) {
    const std::size_t from = line.find(';') + 1;
    return line.substr(from, line.rfind('*') - from);
}

template <class Message>
Message read_log(const std::string& line) {
    const auto view = parse_unicore_line(line);
    EXPECT_TRUE(view) << line;
    const auto message = read_unicore_body<Message>(view->fields);
    EXPECT_TRUE(message) << line;
    return message.value_or(Message{});
}

TEST(UnicoreFrame, WritesWhatReceiversHaveSent) {
    EXPECT_EQ(unicore_body(read_log<UnicoreRecTime>(rectime_text)), body_of(rectime_text));
    EXPECT_EQ(unicore_body(read_log<UnicoreBestNav>(bestnav_text)), body_of(bestnav_text));
    EXPECT_EQ(unicore_body(read_log<UnicoreHeading>(heading_text)), body_of(heading_text));
    EXPECT_EQ(unicore_body(read_log<UnicoreAgric>(agrica_text)), body_of(agrica_text));
    EXPECT_EQ(unicore_body(read_log<UnicorePvtsln>(pvtsln_text)), body_of(pvtsln_text));
    EXPECT_EQ(unicore_body(read_log<UnicoreVersion>(version_text)), body_of(version_text));
    for (const std::string& line : {rectime_text, bestnav_text, heading_text, agrica_text, pvtsln_text, version_text}) {
        const auto view = parse_unicore_line(line);
        ASSERT_TRUE(view && view->header) << line;
        EXPECT_EQ(unicore_log_line(view->name, *view->header, body_of(line)), line + "\r\n");
    }
}

TEST(UnicoreFrame, ReadsBinaryLogsOfAReceiver) {
    const Bytes time = bytes_of(rectime_bytes), best = bytes_of(bestnav_bytes);
    const auto time_frame = parse_unicore_frame(time), best_frame = parse_unicore_frame(best);
    ASSERT_TRUE(time_frame && best_frame);
    EXPECT_EQ(time_frame->header, (UnicoreHeader{97, true, 2379, 369797000, 0, 18, 18}));
    EXPECT_EQ(best_frame->header, (UnicoreHeader{97, true, 2412, 543074000, 17548, 18, 17}));
    const auto rectime = decode_payload<UnicoreRecTime>(time_frame->payload);
    const auto bestnav = decode_payload<UnicoreBestNav>(best_frame->payload);
    ASSERT_TRUE(rectime && bestnav);
    // The same epochs as text.
    EXPECT_EQ(unicore_body(*rectime), body_of(rectime_text));
    EXPECT_EQ(unicore_body(*bestnav), body_of(bestnav_text));
    EXPECT_EQ(encode_unicore_frame(102, time_frame->header, encode_payload(*rectime)), time);
    EXPECT_EQ(encode_unicore_frame(2118, best_frame->header, encode_payload(*bestnav)), best);
}

TEST(UnicoreFrame, AgricaHasTheLengthThatItSays) {
    constexpr std::size_t crc = 4;
    EXPECT_EQ(encode_payload(UnicoreAgric{}).size() + crc, 232u);
    EXPECT_EQ(encode_payload(UnicoreBestNav{}).size(), 120u);
    EXPECT_EQ(encode_payload(UnicoreRecTime{}).size(), 44u);
    EXPECT_EQ(encode_payload(UnicoreVersion{}).size(), 308u);
}

TEST(UnicoreFrame, ChecksumsOfAnswersCoverTheirFirstCharacter) {
    for (const std::string line :
         {"$command,BESTNAVA 1,response: OK*57", "$devicename,COM3*65", "$CONFIG,COM3,CONFIG COM3 115200*23",
          "$command,badResponse,response: PARSING FAILD NO MATCHING FUNC  BADRESPONSE*40",
          "$command,umlog,response: PARSING FAILD NO MATCHING FUNC  UMLOG*60", "$CONFIG,MASK,MASK 5.0*25",
          "#MODE,97,GPS,FINE,2389,337235000,0,0,18,969;MODE ROVER SURVEY,*18"}) {
        EXPECT_EQ(unicore_answer_line(line.substr(0, line.size() - 3)), line + "\r\n");
        EXPECT_TRUE(parse_unicore_line(line)) << line;
    }
    EXPECT_FALSE(parse_unicore_line("$command,BESTNAVA 1,response: OK*73"));  // NMEA's
    EXPECT_FALSE(parse_unicore_line("$GNGGA,111338.00,,,,,0,00,9999.0,,,,,,*65"));
    EXPECT_FALSE(parse_unicore_line("#BESTNAVA,97*00000000"));
    EXPECT_FALSE(parse_unicore_line("#"));
    EXPECT_FALSE(parse_unicore_line("$*"));
}

TEST(UnicoreFrame, BodiesOfOtherFormsAreRefused) {
    const std::vector<std::string_view> few{"VALID", "1"}, words(11, "x");
    EXPECT_FALSE(read_unicore_body<UnicoreRecTime>(few));
    EXPECT_FALSE(read_unicore_body<UnicoreRecTime>(words));
    std::vector<std::string_view> prns(36, "0");
    prns.back() = "99999999999999999999";
    EXPECT_FALSE(read_unicore_body<UnicorePvtsln>(prns));
}

// A line that breaks off is no part of the one after it, even where a checksum holds for both together.
TEST(UnicoreFrame, AnAnswerThatBreaksOffIsNoiseHoweverItArrives) {
    const std::string both = "$devicename,COM3*65\r0,0,0,18,969;MODE ROVER SURVEY,";
    const Bytes stream = to_bytes(unicore_answer_line(both));
    const auto whole = test::split_stream({.unicore = true}, stream, stream.size());
    for (const std::size_t portion : {std::size_t{1}, std::size_t{3}, std::size_t{7}})
        EXPECT_EQ(test::split_stream({.unicore = true}, stream, portion), whole) << portion;
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].kind, StreamKind::noise);
}

TEST(UnicoreFrame, AreFoundAmongSentencesHoweverTheyArrive) {
    Bytes stream = to_bytes("$command,BESTNAVA 1,response: OK*57\r\n$GNGGA,111338.00,,,,,0,00,9999.0,,,,,,*41\r\n");
    const auto add = [&](const Bytes& bytes) { stream.insert(stream.end(), bytes.begin(), bytes.end()); };
    add(bytes_of(bestnav_bytes));
    add(to_bytes(bestnav_text + "\r\n"));
    std::string spoilt = rectime_text + "\r\n";
    spoilt[60] ^= 1;
    add(to_bytes(spoilt));
    add(to_bytes(agrica_text + "\r\n"));
    const auto whole = test::split_stream({.unicore = true}, stream, stream.size());
    std::vector<StreamKind> kinds;
    for (const StreamPiece& piece : whole)
        if (piece.kind != StreamKind::noise) kinds.push_back(piece.kind);
    using enum StreamKind;
    EXPECT_EQ(kinds, (std::vector{unicore, nmea, unicore, unicore, unicore}));
    for (const std::size_t portion : {std::size_t{1}, std::size_t{7}, std::size_t{100}})
        EXPECT_EQ(test::split_stream({.unicore = true}, stream, portion), whole) << portion;
}

TEST(UnicoreFrame, AreListedAlikeAsTextAndAsBytes) {
    const auto fields = [](const DecodedMessage& message) {
        const std::string line = text_line(message);
        return line.substr(line.find("week="));
    };
    const DecodedMessage text = decode_piece({StreamKind::unicore, to_bytes(rectime_text + "\r\n")});
    const DecodedMessage bytes = decode_piece({StreamKind::unicore, bytes_of(rectime_bytes)});
    EXPECT_EQ(text.name, "RECTIME");
    EXPECT_EQ(bytes.id, "102");
    EXPECT_NE(fields(text).find("week=2379 tow_s=369797 leap_s=18 clock_status=0"), std::string::npos) << fields(text);
    EXPECT_NE(fields(bytes).find("year=2025 month=8 day=14 hour=6 minute=42 millisecond=59000"), std::string::npos);
    const DecodedMessage answer =
        decode_piece({StreamKind::unicore, to_bytes("$command,BESTNAVA 1,response: OK*57\r\n")});
    EXPECT_EQ(text_line(answer), "UNICORE command fields=[\"BESTNAVA 1\" \"response: OK\"]");
}

}  // namespace
}  // namespace skyloop::inline receiver
