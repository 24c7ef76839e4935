#include "receiver/protocol/decoded_message.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"

namespace skyloop {
namespace {

std::string text_of(StreamKind kind, const Bytes& bytes) { return text_line(decode_piece({kind, bytes})); }
std::string json_of(StreamKind kind, const Bytes& bytes) { return json_line(decode_piece({kind, bytes}), 7); }
std::string sentence_text(const std::string& body) {
    Sentence sentence(body);
    return text_of(StreamKind::nmea, to_bytes(sentence.finish()));
}

TEST(DecodedMessage, NumbersHaveTheirScaleAndExactlyTheirDigits) {
    NavPosllh m;
    m.i_tow = 345600123;
    m.lon = 307326001;
    m.lat = -464775009;
    m.height = -1;
    EXPECT_EQ(
        text_of(StreamKind::ubx, encode_frame(m)),
        "UBX NAV-POSLLH tow_s=345600.123 lon_deg=30.7326001 lat_deg=-46.4775009 height_m=-0.001 msl_m=0 h_acc_m=0 "
        "v_acc_m=0");
    EXPECT_EQ(json_of(StreamKind::ubx, encode_frame(m)),
              "{\"protocol\":\"ubx\",\"offset\":7,\"bytes\":36,\"id\":\"01-02\",\"name\":\"NAV-POSLLH\",\"fields\":"
              "{\"tow_s\":345600.123,\"lon_deg\":30.7326001,\"lat_deg\":-46.4775009,\"height_m\":-0.001,\"msl_m\":0,"
              "\"h_acc_m\":0,\"v_acc_m\":0}}");
}

TEST(DecodedMessage, ListsAndTextsAreReadable) {
    NavSat m;
    m.version = 1;
    m.satellites.resize(1);
    m.satellites[0].elev = -91;
    m.satellites[0].pr_res = -13;
    EXPECT_NE(text_of(StreamKind::ubx, encode_frame(m)).find("elevation_deg=- azimuth_deg=0 residual_m=-1.3"),
              std::string::npos);
    MonVer version;
    std::copy_n("ROM 3.01", 8, version.sw_version.begin());
    version.extensions.resize(2);
    std::copy_n("PROTVER=18.00", 13, version.extensions[1].begin());
    EXPECT_EQ(text_of(StreamKind::ubx, encode_frame(version)),
              "UBX MON-VER software=\"ROM 3.01\" hardware=\"\" extensions=[\"\" \"PROTVER=18.00\"]");
}

TEST(DecodedMessage, TheVersionTellsQuestionAndAnswerOfValget) {
    // One key, and one key with one byte: RECEIVER.md 1.1.
    const Bytes poll{0xB5, 0x62, 6, 0x8B, 8, 0, 0, 0, 0, 0, 1, 0, 0x73, 0x10, 0x1D, 0x8B};
    const Bytes answer{0xB5, 0x62, 6, 0x8B, 9, 0, 1, 0, 0, 0, 1, 0, 0x73, 0x10, 1, 0x20, 0xBD};
    EXPECT_EQ(text_of(StreamKind::ubx, poll), "UBX CFG-VALGET version=0 layer=0 position=0 keys=[275972097]");
    EXPECT_EQ(text_of(StreamKind::ubx, answer),
              "UBX CFG-VALGET version=1 layer=0 position=0 pairs=[{key=275972097 value=1}]");
    EXPECT_EQ(text_of(StreamKind::ubx, encode_frame(UbxMessageId{0x0A, 0x04}, {})), "UBX MON-VER poll=1");
}

TEST(DecodedMessage, WhatIsNotKnownKeepsItsPayload) {
    EXPECT_EQ(text_of(StreamKind::ubx, encode_frame(UbxMessageId{0x77, 0x01}, Bytes{0xAB, 0xCD})),
              "UBX 77-01 2 bytes abcd");
    // A known message of a length that it cannot have.
    EXPECT_EQ(text_of(StreamKind::ubx, encode_frame(UbxMessageId{0x01, 0x61}, Bytes{1})), "UBX NAV-EOE 1 bytes 01");
    EXPECT_EQ(json_of(StreamKind::msp, encode_msp_v2(0x1F04, Bytes{9})),
              "{\"protocol\":\"msp\",\"offset\":7,\"bytes\":10,\"id\":\"0x1F04\",\"payload\":\"09\"}");
    EXPECT_EQ(text_of(StreamKind::sbf, encode_sbf_block(5936, 0, Bytes(4))), "SBF 5936 4 bytes 00000000");
}

TEST(DecodedMessage, SentencesAreListedByTheirFields) {
    EXPECT_EQ(sentence_text("GNRMC,235959.50,A,4628.65006,N,03043.95600,W,10,77.7,010326,,,D,V"),
              "NMEA GNRMC time=23:59:59.50 status=A lat_deg=46.477501 lon_deg=-30.7326 speed_mps=5.144444 "
              "course_deg=77.7 date=2026-03-01 variation_deg=- variation_side=- mode=D navigation_status=V");
    EXPECT_EQ(sentence_text("GPGSA,A,3,05,12,,,,,,,,,,,1.5,0.9,1.2,1"),
              "NMEA GPGSA mode=A fix_mode=3 satellites=[5 12] pdop=1.5 hdop=0.9 vdop=1.2 system_id=1");
    EXPECT_EQ(sentence_text("GPGSV,1,1,02,05,17,123,40,12,,,,A"),
              "NMEA GPGSV pages=1 page=1 satellites_in_view=2 satellites=[{number=5 elevation_deg=17 azimuth_deg=123 "
              "cno_dbhz=40} {number=12 elevation_deg=- azimuth_deg=- cno_dbhz=-}] signal_id=A");
    EXPECT_EQ(sentence_text("PUBX,41,1,0007,0003,9600,0"),
              "NMEA PUBX-41 port=1 in_protocols=0007 out_protocols=0003 baud=9600 autobaud=0");
}

TEST(DecodedMessage, ResidualsKeepTheirPlacesAmongTheSatellites) {
    EXPECT_EQ(sentence_text("GPGRS,104148.00,1,2.6,,-1.6,,,,,,,,,,1,1"),
              "NMEA GPGRS time=10:41:48.00 mode=1 residuals_m=[2.6 - -1.6] system_id=1 signal_id=1");
    EXPECT_EQ(sentence_text("GPGRS,104148.00,1,,,,,,,,,,,,,1,1"),
              "NMEA GPGRS time=10:41:48.00 mode=1 residuals_m=[] system_id=1 signal_id=1");
    EXPECT_EQ(sentence_text("GPGSA,A,3,05,,12,,,,,,,,,,1.5,0.9,1.2,1"),
              "NMEA GPGSA mode=A fix_mode=3 satellites=[5 - 12] pdop=1.5 hdop=0.9 vdop=1.2 system_id=1");
}

TEST(DecodedMessage, SentencesThatAreNotKnownOrNotRightLoseNothing) {
    EXPECT_EQ(sentence_text("PMTK605"), "NMEA PMTK605");
    EXPECT_EQ(sentence_text("PMTK705,AXN_2.31,5 6"), "NMEA PMTK705 fields=[AXN_2.31 \"5 6\"]");
    EXPECT_EQ(sentence_text("GPGLL,north,N,1,E,12,A"),
              "NMEA GPGLL lat_deg=north lon_deg=0.0166666667 time=12 status=A");
    EXPECT_EQ(sentence_text("GPHDT,12.5,T,x"), "NMEA GPHDT heading_deg=12.5 more=[x]");
}

TEST(DecodedMessage, StationPositionOfRtcm) {
    // The example of RTCM 10403.3, section 4.2: message 1005, station 2003.
    const Bytes frame{0xD3, 0x00, 0x13, 0x3E, 0xD7, 0xD3, 0x02, 0x02, 0x98, 0x0E, 0xDE, 0xEF, 0x34,
                      0xB4, 0xBD, 0x62, 0xAC, 0x09, 0x41, 0x98, 0x6F, 0x33, 0x36, 0x0B, 0x98};
    EXPECT_EQ(text_of(StreamKind::rtcm3, frame),
              "RTCM3 station position station=2003 itrf_year=0 ecef_x_m=1114104.5999 ecef_y_m=-4850729.7108 "
              "ecef_z_m=3975521.4643");
}

TEST(DecodedMessage, ShortOrOddRtcmIsNotMisread) {
    EXPECT_EQ(text_of(StreamKind::rtcm3, {0xD3, 0, 2, 0x3E, 0xD0, 0, 0, 0}), "RTCM3 station position 2 bytes 3ed0");
    EXPECT_EQ(text_of(StreamKind::rtcm3, {0xD3, 0, 0, 1, 2, 3}), "RTCM3 none");
    EXPECT_EQ(text_of(StreamKind::rtcm3, {0xD3, 0, 2, 0xFF, 0xF0, 0, 0, 0}), "RTCM3 4095 2 bytes fff0");
}

TEST(DecodedMessage, ValuesThatMeanNothingAreMissing) {
    const std::string pvt = json_of(StreamKind::sbf, encode_sbf(SbfPvtGeodetic{}));
    EXPECT_NE(pvt.find("\"tow_s\":null,\"week\":null,\"mode\":0,\"error\":1,\"latitude_rad\":null"), std::string::npos);
    EXPECT_NE(pvt.find("\"vel_north_mps\":null"), std::string::npos);
    EXPECT_NE(json_of(StreamKind::msp, encode_msp(MspSensorGps{})).find("\"gps_week\":null"), std::string::npos);
    const std::string input = text_of(StreamKind::mavlink, encode_mavlink({1, 220, 5}, MavlinkGpsInput{}));
    EXPECT_TRUE(input.starts_with("MAVLINK GPS_INPUT system=1 component=220 sequence=5 unix_time_s=0")) << input;
    EXPECT_NE(input.find("hdop=- vdop=-"), std::string::npos);
    EXPECT_TRUE(input.ends_with("yaw_deg=-"));
}

TEST(DecodedMessage, FramesOfVersionOneHaveNoExtensions) {
    Bytes payload = encode_payload(MavlinkGpsRawInt{});
    payload.resize(MavlinkGpsRawInt::base_size);
    const std::string one = json_of(StreamKind::mavlink, encode_mavlink_v1({}, MavlinkGpsRawInt::message_id, payload));
    EXPECT_NE(one.find("\"fix_type\":0,\"satellites\":null,\"height_m\":null,\"h_acc_m\":null"), std::string::npos)
        << one;
    EXPECT_NE(json_of(StreamKind::mavlink, encode_mavlink({}, MavlinkGpsRawInt{})).find("\"height_m\":0,"),
              std::string::npos);
}

TEST(DecodedMessage, SinglePrecisionIsNotDressedUp) {
    MavlinkGpsInput m;
    m.alt = 77.3F;
    m.vn = std::numeric_limits<float>::quiet_NaN();
    const std::string text = json_of(StreamKind::mavlink, encode_mavlink({}, m));
    EXPECT_NE(text.find("\"msl_m\":77.3,"), std::string::npos) << text;
    EXPECT_NE(text.find("\"vel_north_mps\":null"), std::string::npos) << text;
}

TEST(DecodedMessage, JsonStringsAreAlwaysAscii) {
    EXPECT_EQ(json_string("a\"b\\c\n\xE9"), "\"a\\\"b\\\\c\\u000a\\u00e9\"");
}

}  // namespace
}  // namespace skyloop
