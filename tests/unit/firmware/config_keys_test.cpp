#include "firmware/ublox/config/config_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

// RECEIVER.md 3.4: ids name their size.
std::size_t size_of_type(ConfigType type) {
    using enum ConfigType;
    switch (type) {
        case u2:
        case i2:
        case x2:
            return 2;
        case u4:
        case i4:
        case x4:
        case r4:
            return 4;
        case u8:
        case i8:
        case x8:
        case r8:
            return 8;
        default:
            return 1;
    }
}

TEST(ConfigKeys, AreUniqueAndInOrder) {
    std::set<std::string_view> names;
    std::uint32_t last = 0;
    for (const ConfigKey& key : config_keys()) {
        EXPECT_GT(group_and_item(key.id), last) << key.name;
        last = group_and_item(key.id);
        EXPECT_TRUE(names.insert(key.name).second) << key.name;
        EXPECT_TRUE(key.name.starts_with("CFG-")) << key.name;
    }
}

TEST(ConfigKeys, SizeBitsFitTheTypes) {
    for (const ConfigKey& key : config_keys()) {
        EXPECT_EQ(config_value_size(key.id), size_of_type(key.type)) << key.name;
        EXPECT_EQ(key.id >> 28 == 1, key.type == ConfigType::l) << key.name;
        EXPECT_EQ(key.id & 0x8F00'F000u, 0U) << key.name;
    }
}

// RECEIVER.md 3.5.1 and 3.5.2, and the configurations that clients write (section 6).
TEST(ConfigKeys, HaveTheIdsAndDefaultsOfTheInterfaceDescription) {
    const auto expect_key = [](std::string_view name, std::uint32_t id, std::uint64_t value) {
        const ConfigKey* key = find_config_key(name);
        ASSERT_NE(key, nullptr) << name;
        EXPECT_EQ(key->id, id) << name;
        EXPECT_EQ(key->default_value, value) << name;
        EXPECT_EQ(find_config_key(id), key) << name;
        EXPECT_TRUE(is_of_ublox(key->id)) << name;
    };
    expect_key("CFG-RATE-MEAS", 0x30210001, 1000);
    expect_key("CFG-NAVSPG-DYNMODEL", 0x20110021, 0);
    expect_key("CFG-NAVSPG-CONSTR_ALTVAR", 0x401100C2, 10000);
    expect_key("CFG-NAVHPG-DGNSSMODE", 0x20140011, 3);
    expect_key("CFG-SIGNAL-BDS_B1C_ENA", 0x1031000F, 0);
    expect_key("CFG-SBAS-PRNSCANMASK", 0x50360006, 0x72B88);
    expect_key("CFG-TP-DUTY_LOCK_TP1", 0x5005002B, 0x4024'0000'0000'0000);  // 10 %
    expect_key("CFG-UART1-BAUDRATE", 0x40520001, 38400);
    expect_key("CFG-UART1INPROT-UBX", 0x10730001, 1);
    expect_key("CFG-INFMSG-NMEA_SPI", 0x2092000A, 7);
    expect_key("CFG-NMEA-PROTVER", 0x20930001, 41);
    expect_key("CFG-SEC-CFG_LOCK", 0x10F60009, 0);
    expect_key("CFG-MSGOUT-UBX_NAV_PVT_UART1", 0x20910007, 0);
    expect_key("CFG-MSGOUT-UBX_NAV_SIG_UART1", 0x20910346, 0);
    expect_key("CFG-MSGOUT-NMEA_ID_GGA_USB", 0x209100BD, 1);
    expect_key("CFG-MSGOUT-NMEA_ID_ZDA_SPI", 0x209100DC, 0);
    expect_key("CFG-MSGOUT-RTCM_3X_TYPE4072_0_UART2", 0x20910300, 0);
    expect_key("CFG-MSGOUT-UBX_NAV_TIMEGAL_I2C", 0x20910056, 0);
}

TEST(ConfigKeys, OtherSizeBitsAreAnotherId) {
    EXPECT_EQ(find_config_key(0x20210001), nullptr);
    EXPECT_EQ(find_config_key(0x40210001), nullptr);
    EXPECT_EQ(find_config_key(0), nullptr);
    EXPECT_EQ(find_config_key(0xFFFFFFFF), nullptr);
    EXPECT_EQ(find_config_key("CFG-RATE-MEASURE"), nullptr);
}

TEST(OutputMessages, HaveARateOnEachPort) {
    UbxMessageId last{};
    for (const OutputMessage& message : output_messages()) {
        EXPECT_LT(last, message.id) << message.name;
        last = message.id;
        EXPECT_EQ(find_output_message(message.id), &message);
        EXPECT_EQ(find_output_message(message.name), &message) << message.name;
        for (const PortId port : {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb, PortId::spi}) {
            const auto key = rate_key(message.id, port);
            ASSERT_TRUE(key);
            ASSERT_NE(find_config_key(*key), nullptr) << message.name;
            EXPECT_EQ(*key, message.i2c_key + static_cast<std::uint32_t>(port));
        }
    }
    EXPECT_EQ(rate_key({0x01, 0x07}, PortId::uart1), 0x20910007U);
    EXPECT_EQ(rate_key({0xF5, 0xE6}, PortId::usb), 0x20910306U);
    EXPECT_EQ(rate_key({0x0A, 0x04}, PortId::uart1), std::nullopt);  // MON-VER is only polled
    EXPECT_EQ(find_output_message("NAV-PVD"), nullptr);
}

TEST(OutputMessages, WithoutAKeyOfTheirOwnAreNotOnTheWire) {
    for (const std::string_view name : {"NAV-SOL", "NAV-SVINFO", "NAV-DGPS", "RXM-SVSI", "THS"}) {
        const OutputMessage* message = find_output_message(name);
        ASSERT_NE(message, nullptr) << name;
        const ConfigKey* key = find_config_key(message->i2c_key);
        ASSERT_NE(key, nullptr) << name;
        EXPECT_FALSE(is_of_ublox(key->id)) << name;
    }
}

TEST(MessageNames, NameNoMessageTwice) {
    std::set<UbxMessageId> ids;
    std::set<std::string_view> names;
    for (const auto list : {polled_messages(), legacy_messages()})
        for (const NamedMessage& message : list) {
            EXPECT_TRUE(ids.insert(message.id).second) << message.name;
            EXPECT_TRUE(names.insert(message.name).second) << message.name;
            EXPECT_EQ(find_output_message(message.id), nullptr) << message.name;
        }
}

}  // namespace
}  // namespace skyloop::firmware
