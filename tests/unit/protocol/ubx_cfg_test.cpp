#include <gtest/gtest.h>

#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop {
namespace {

template <class Message>
void expect_only_size(std::size_t expected) {
    for (std::size_t size = 0; size < 160; ++size)
        EXPECT_EQ(decode_payload<Message>(Bytes(size)).has_value(), size == expected) << size << " of " << expected;
}

// Sizes: RECEIVER.md 3.3; CFG-USB, CFG-LOGFILTER and UPD-SOS: M8 interface description 32.11, 32.20.
TEST(UbxCfgLayouts, HaveTheirSizesAndNoOther) {
    expect_only_size<CfgNavx5>(40);
    expect_only_size<CfgSbas>(8);
    expect_only_size<CfgOdo>(20);
    expect_only_size<CfgDgnss>(4);
    expect_only_size<CfgTmode3>(40);
    expect_only_size<CfgNmeaShort>(4);
    expect_only_size<CfgNmeaV0>(12);
    expect_only_size<CfgNmea>(20);
    expect_only_size<CfgUsb>(108);
    expect_only_size<CfgTp5>(32);
    expect_only_size<CfgItfm>(8);
    expect_only_size<CfgPms>(8);
    expect_only_size<CfgRxm>(2);
    expect_only_size<CfgAnt>(4);
    expect_only_size<CfgLogfilter>(12);
    expect_only_size<CfgDat>(52);
    expect_only_size<CfgDatSet>(44);
    expect_only_size<CfgPm2>(48);
    expect_only_size<UpdSos>(4);
    expect_only_size<UpdSosStatus>(8);
    for (std::size_t size = 0; size < 80; ++size)
        EXPECT_EQ(decode_payload<CfgInf>(Bytes(size)).has_value(), size > 0 && size % 10 == 0) << size;
}

// What an F9P with HPG 1.13 answered (RECEIVER.md 2.4).
TEST(UbxCfgLayouts, ReadCfgNavx5OfARealReceiver) {
    Bytes payload{2, 0, 0x4C, 0x66, 0xC0, 0, 0, 0, 0, 0, 3, 0x20, 6, 0, 0, 0, 0, 0, 0x32, 8};
    payload.resize(40);
    const auto read = decode_payload<CfgNavx5>(payload);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->version, 2);
    EXPECT_EQ(read->mask1, 0x664C);
    EXPECT_EQ(read->mask2, 0xC0u);
    EXPECT_EQ(read->min_svs, 3);
    EXPECT_EQ(read->max_svs, 32);
    EXPECT_EQ(read->min_cno, 6);
    EXPECT_EQ(read->wkn_rollover, 0x832);
    EXPECT_EQ(read->aop_orb_max_err, 0);
    EXPECT_EQ(encode_payload(*read), payload);
}

// Offsets of the late fields of CFG-NAVX5 (RECEIVER.md 3.3).
TEST(UbxCfgLayouts, PutTheFieldsOfCfgNavx5WhereTheyBelong) {
    CfgNavx5 message;
    message.ini_fix_3d = 1;
    message.ack_aiding = 2;
    message.sig_atten_comp_mode = 3;
    message.use_ppp = 4;
    message.aop_cfg = 5;
    message.aop_orb_max_err = 0x0706;
    message.use_adr = 8;
    const Bytes bytes = encode_payload(message);
    EXPECT_EQ(bytes[14], 1);
    EXPECT_EQ(bytes[17], 2);
    EXPECT_EQ(bytes[20], 3);
    EXPECT_EQ(bytes[26], 4);
    EXPECT_EQ(bytes[27], 5);
    EXPECT_EQ(bytes[30], 6);
    EXPECT_EQ(bytes[31], 7);
    EXPECT_EQ(bytes[39], 8);
}

// Time pulse 1 of an M8 (RECEIVER.md 2.4).
TEST(UbxCfgLayouts, ReadCfgTp5OfARealReceiver) {
    const Bytes payload{0, 1, 0, 0, 0x32, 0,    0, 0, 0x40, 0x42, 0x0F, 0, 0x40, 0x42, 0x0F, 0,
                        0, 0, 0, 0, 0xA0, 0x86, 1, 0, 0,    0,    0,    0, 0x77, 0,    0,    0};
    const auto read = decode_payload<CfgTp5>(payload);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->ant_cable_delay, 50);
    EXPECT_EQ(read->freq_period, 1'000'000u);
    EXPECT_EQ(read->pulse_len_ratio_lock, 100'000u);
    EXPECT_EQ(read->flags, 0x77u);
    EXPECT_EQ(encode_payload(*read), payload);
}

TEST(UbxCfgLayouts, PutTheFieldsOfTheOtherMessagesWhereTheyBelong) {
    EXPECT_EQ(encode_payload(CfgSbas{1, 3, 3, 0x40, 0x851}), (Bytes{1, 3, 3, 0x40, 0x51, 8, 0, 0}));
    EXPECT_EQ(encode_payload(CfgItfm{0x2D62ACF3, 0x31E}), (Bytes{0xF3, 0xAC, 0x62, 0x2D, 0x1E, 3, 0, 0}));
    EXPECT_EQ(encode_payload(CfgRxm{8, 1}), (Bytes{8, 1}));
    EXPECT_EQ(encode_payload(CfgAnt{0x1B, 0xA1F0}), (Bytes{0x1B, 0, 0xF0, 0xA1}));
    EXPECT_EQ(encode_payload(CfgPms{0, 2, 10, 3, {}}), (Bytes{0, 2, 10, 0, 3, 0, 0, 0}));
    EXPECT_EQ(encode_payload(CfgLogfilter{1, 5, 2, 3, 4, 6}), (Bytes{1, 5, 2, 0, 3, 0, 4, 0, 6, 0, 0, 0}));
    CfgTmode3 mode;
    mode.position_hp = {-1, 2, 3};
    mode.fixed_pos_acc = 0x0A;
    mode.svin_acc_limit = 0x0B;
    const Bytes bytes = encode_payload(mode);
    EXPECT_EQ(bytes[16], 0xFF);
    EXPECT_EQ(bytes[20], 0x0A);
    EXPECT_EQ(bytes[28], 0x0B);
    CfgNmea nmea;
    nmea.core = {0, 0x40, 0, 2};
    nmea.extension.version = 1;
    nmea.bds_talker_id = {'G', 'B'};
    const Bytes nmea_bytes = encode_payload(nmea);
    EXPECT_EQ(nmea_bytes[1], 0x40);
    EXPECT_EQ(nmea_bytes[11], 1);
    EXPECT_EQ(nmea_bytes[12], 'G');
    CfgUsb usb;
    usb.vendor_id = 0x1546;
    usb.product_string[0] = 'u';
    const Bytes usb_bytes = encode_payload(usb);
    EXPECT_EQ(usb_bytes[0], 0x46);
    EXPECT_EQ(usb_bytes[44], 'u');
}

}  // namespace
}  // namespace skyloop
