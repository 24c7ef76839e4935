#include <gtest/gtest.h>

#include <algorithm>

#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "support/ubx_message_types.hpp"

namespace skyloop {
namespace {

template <class Message>
std::string listing_of(const Message& message) {
    return text_line(decode_piece({StreamKind::ubx, encode_frame(message)}));
}

// A message with a layout but without a listing would show as hexadecimal digits.
template <class Message>
void expect_listed(Message message) {
    if constexpr (requires { message.ports.resize(1); }) message.ports.resize(1);
    if constexpr (requires { message.protocols.resize(1); }) message.protocols.resize(1);
    if constexpr (requires { message.unique_id.resize(5); }) message.unique_id.resize(5);
    const Bytes payload = encode_payload(message);
    const auto known = std::ranges::find(ubx_messages(), Message::message_id, &UbxMessage::id);
    ASSERT_NE(known, ubx_messages().end()) << to_string(Message::message_id);
    ASSERT_NE(known->list, nullptr) << known->name;
    EXPECT_TRUE(known->list(payload)) << known->name << " of " << payload.size() << " bytes";
}

TEST(UbxListing, EveryMessageThatLeavesAReceiverHasOne) {
    UbxOutputTypes::for_each([](const auto& message) { expect_listed(message); });
}

TEST(UbxListing, EveryMessageOfSettingsHasOne) {
    CfgValget answer;
    answer.version = 1;
    expect_listed(answer);
    UbxSettingTypes::for_each([](const auto& message) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(message)>, CfgValget>) expect_listed(message);
    });
}

// RECEIVER.md 3.2: both forms are 12 bytes long when two centre frequencies are there.
TEST(UbxListing, TheVersionTellsTheFormsOfSecSigApart) {
    SecSig1 old;
    old.jam_flags = 3;
    EXPECT_EQ(listing_of(old), "UBX SEC-SIG version=1 jamming_flags=3 spoofing_flags=0");
    SecSig2 modern;
    modern.sig_sec_flags = 9;
    modern.bands = {{1575420, 1}, {1227600, 0}};
    EXPECT_EQ(encode_payload(modern).size(), encode_payload(old).size());
    EXPECT_EQ(listing_of(modern),
              "UBX SEC-SIG version=2 flags=9 bands=[{centre_khz=1575420 jammed=1} {centre_khz=1227600 jammed=0}]");
}

TEST(UbxListing, ScalesNeedNotBePowersOfTen) {
    RxmMeasx m;
    m.gps_tow_acc = 24;
    RxmMeasxItem satellite;
    satellite.doppler_ms = -3;
    satellite.doppler_hz = 7;
    satellite.code_phase = 1U << 20;
    m.satellites = {satellite};
    const std::string text = listing_of(m);
    EXPECT_NE(text.find("gps_tow_acc_ms=1.5 "), text.npos) << text;
    EXPECT_NE(text.find("doppler_mps=-0.12 doppler_hz=1.4 "), text.npos) << text;
    EXPECT_NE(text.find("code_phase_ms=0.5 "), text.npos) << text;
    RxmCor correction;
    correction.ebno = 37;
    EXPECT_NE(listing_of(correction).find(" ebno_db=4.625 "), text.npos) << listing_of(correction);
}

TEST(UbxListing, SettingsOfTheReferenceStationAndTheSentences) {
    CfgTmode3 mode;
    mode.flags = 1;
    mode.svin_min_dur = 300;
    mode.svin_acc_limit = 50000;
    EXPECT_EQ(listing_of(mode),
              "UBX CFG-TMODE3 version=0 flags=1 position=[0 0 0] position_hp=[0 0 0] position_acc_m=0 "
              "survey_duration_s=300 survey_acc_m=5");
    CfgNmeaShort sentences;
    sentences.core.nmea_version = 0x23;
    EXPECT_EQ(listing_of(sentences), "UBX CFG-NMEA filter=0 nmea_version=35 listed_satellites=0 flags=0");
}

TEST(UbxListing, AttitudeIsInDegrees) {
    NavAtt attitude;
    attitude.angle = {100000, -250000, 35900000};
    EXPECT_NE(listing_of(attitude).find(" roll_pitch_heading_deg=[1 -2.5 359] "), std::string::npos);
}

// 1e-2 m/s², as pyubx2 and SparkFun's library have it.
TEST(UbxListing, AccelerationsBetweenTheEpochsAreInHundredths) {
    HnrIns motion;
    motion.ang_rate = {1500, 0, -250};
    motion.accel = {981, -5, 0};
    EXPECT_NE(listing_of(motion).find(" angular_rate_degps=[1.5 0 -0.25] acceleration_mps2=[9.81 -0.05 0]"),
              std::string::npos)
        << listing_of(motion);
}

}  // namespace
}  // namespace skyloop
