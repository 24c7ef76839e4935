#include "wire/transport/cdc_acm_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;

constexpr std::uint8_t from_device = 0x80, from_interface = 0x81, from_endpoint = 0x82, to_device = 0x00,
                       to_interface = 0x01, to_endpoint = 0x02, class_in = 0xA1, class_out = 0x21;

UsbFace ublox_face() { return {{0x1546, 0x01a8}, 0x0301, "u-blox AG", "u-blox GNSS receiver", ""}; }

// A device with its configuration set.
CdcAcmDevice configured_device() {
    CdcAcmDevice device(ublox_face());
    EXPECT_TRUE(device.control({to_device, 9, 1, 0, 0}, {}));
    return device;
}

bool stalls(CdcAcmDevice& device, const UsbSetup& setup, const Bytes& data = {}) {
    return !device.control(setup, data).has_value();
}

TEST(CdcAcmDevice, TellsItsDescriptors) {
    CdcAcmDevice device(ublox_face());
    EXPECT_THAT(device.control({from_device, 6, 0x0100, 0, 64}, {}).value(),
                ElementsAre(18, 1, 0x10, 0x01, 2, 0, 0, 64, 0x46, 0x15, 0xa8, 0x01, 0x01, 0x03, 1, 2, 0, 1));
    EXPECT_THAT(device.control({from_device, 6, 0x0100, 0, 8}, {}).value(), ElementsAre(18, 1, 0x10, 0x01, 2, 0, 0, 64))
        << "no more than was asked for";
    const Bytes configuration = device.control({from_device, 6, 0x0200, 0, 255}, {}).value();
    ASSERT_EQ(configuration.size(), 67U);
    EXPECT_EQ(configuration[2] | configuration[3] << 8, 67);
    EXPECT_EQ(configuration[4], 2) << "interfaces";
    EXPECT_EQ(device.control({from_device, 6, 0x0200, 0, 9}, {})->size(), 9U);
}

// The chain of descriptors adds up, and holds what cdc_acm looks for.
TEST(CdcAcmDevice, HasOneControlAndOneDataInterface) {
    const Bytes bytes = CdcAcmDevice(ublox_face()).configuration_descriptor();
    std::vector<Bytes> parts;
    for (std::size_t at = 0; at < bytes.size(); at += bytes[at]) {
        ASSERT_GT(bytes[at], 0);
        ASSERT_LE(at + bytes[at], bytes.size());
        parts.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                           bytes.begin() + static_cast<std::ptrdiff_t>(at + bytes[at]));
    }
    EXPECT_THAT(
        parts, ElementsAre(Bytes{9, 2, 67, 0, 2, 1, 0, 0xC0, 0}, Bytes{9, 4, 0, 0, 1, 2, 2, 1, 0},
                           Bytes{5, 0x24, 0, 0x10, 1}, Bytes{5, 0x24, 1, 0, 1}, Bytes{4, 0x24, 2, 6},
                           Bytes{5, 0x24, 6, 0, 1}, Bytes{7, 5, 0x83, 3, 64, 0, 255}, Bytes{9, 4, 1, 0, 2, 10, 0, 0, 0},
                           Bytes{7, 5, 0x01, 2, 64, 0, 0}, Bytes{7, 5, 0x82, 2, 64, 0, 0}));
}

TEST(CdcAcmDevice, TellsItsTexts) {
    UsbFace face = ublox_face();
    CdcAcmDevice plain(face);
    EXPECT_THAT(plain.control({from_device, 6, 0x0300, 0, 255}, {}).value(), ElementsAre(4, 3, 0x09, 0x04));
    const Bytes maker = plain.control({from_device, 6, 0x0301, 0x0409, 255}, {}).value();
    EXPECT_EQ(maker.size(), 2 + 2 * std::string("u-blox AG").size());
    EXPECT_EQ(maker[0], maker.size());
    EXPECT_EQ(maker[2], 'u');
    EXPECT_TRUE(stalls(plain, {from_device, 6, 0x0303, 0x0409, 255})) << "it has no serial number";
    face.serial = "A1";
    CdcAcmDevice numbered(face);
    EXPECT_EQ(numbered.device_descriptor()[16], 3);
    EXPECT_THAT(numbered.control({from_device, 6, 0x0303, 0x0409, 255}, {}).value(), ElementsAre(6, 3, 'A', 0, '1', 0));
    face.product = std::string(300, 'x');
    EXPECT_EQ(CdcAcmDevice(face).control({from_device, 6, 0x0302, 0, 255}, {})->size(), 254U);
}

TEST(CdcAcmDevice, AnswersStandardRequests) {
    CdcAcmDevice device(ublox_face());
    EXPECT_THAT(device.control({from_device, 0, 0, 0, 2}, {}).value(), ElementsAre(1, 0)) << "powered by itself";
    EXPECT_THAT(device.control({from_device, 8, 0, 0, 1}, {}).value(), ElementsAre(0));
    EXPECT_TRUE(device.control({to_device, 5, 7, 0, 0}, {})) << "SET_ADDRESS";
    EXPECT_FALSE(device.configured());
    EXPECT_TRUE(stalls(device, {from_interface, 10, 0, 0, 1})) << "GET_INTERFACE before a configuration";
    EXPECT_TRUE(device.control({to_device, 9, 1, 0, 0}, {}));
    EXPECT_TRUE(device.configured());
    EXPECT_THAT(device.control({from_device, 8, 0, 0, 1}, {}).value(), ElementsAre(1));
    EXPECT_THAT(device.control({from_interface, 10, 0, 1, 1}, {}).value(), ElementsAre(0));
    EXPECT_THAT(device.control({from_interface, 0, 0, 1, 2}, {}).value(), ElementsAre(0, 0));
    EXPECT_TRUE(device.control({to_interface, 11, 0, 1, 0}, {})) << "SET_INTERFACE";
    EXPECT_TRUE(device.control({to_device, 9, 0, 0, 0}, {}));
    EXPECT_FALSE(device.configured());
}

TEST(CdcAcmDevice, HaltsAndClearsEndpoints) {
    CdcAcmDevice device = configured_device();
    EXPECT_THAT(device.control({from_endpoint, 0, 0, 0x82, 2}, {}).value(), ElementsAre(0, 0));
    EXPECT_TRUE(device.control({to_endpoint, 3, 0, 0x82, 0}, {}));
    EXPECT_TRUE(device.halted(CdcAcmDevice::data_in));
    EXPECT_FALSE(device.halted(CdcAcmDevice::data_out));
    EXPECT_THAT(device.control({from_endpoint, 0, 0, 0x82, 2}, {}).value(), ElementsAre(1, 0));
    EXPECT_TRUE(device.control({to_endpoint, 1, 0, 0x82, 0}, {}));
    EXPECT_FALSE(device.halted(CdcAcmDevice::data_in));
    EXPECT_THAT(device.control({from_endpoint, 0, 0, 0x80, 2}, {}).value(), ElementsAre(0, 0)) << "endpoint 0";
}

TEST(CdcAcmDevice, AnInterfaceThatIsSetBeginsWithItsEndpoints) {
    CdcAcmDevice device = configured_device();
    for (const std::uint16_t endpoint : std::initializer_list<std::uint16_t>{0x01, 0x82, 0x83})
        EXPECT_TRUE(device.control({to_endpoint, 3, 0, endpoint, 0}, {}));
    EXPECT_TRUE(device.control({to_interface, 11, 0, 1, 0}, {}));
    EXPECT_FALSE(device.halted(CdcAcmDevice::data_in));
    EXPECT_FALSE(device.halted(CdcAcmDevice::data_out));
    EXPECT_TRUE(device.halted(CdcAcmDevice::notify_in)) << "that is the other one's";
    EXPECT_TRUE(device.control({to_interface, 11, 0, 0, 0}, {}));
    EXPECT_FALSE(device.halted(CdcAcmDevice::notify_in));
}

TEST(CdcAcmDevice, HasNoEndpointsBeforeItsConfiguration) {
    CdcAcmDevice device(ublox_face());
    EXPECT_TRUE(stalls(device, {to_endpoint, 3, 0, 0x82, 0}));
    EXPECT_TRUE(stalls(device, {to_endpoint, 1, 0, 0x01, 0}));
    EXPECT_TRUE(stalls(device, {from_endpoint, 0, 0, 0x82, 2}));
    EXPECT_THAT(device.control({from_endpoint, 0, 0, 0, 2}, {}).value(), ElementsAre(0, 0)) << "but endpoint 0";
}

TEST(CdcAcmDevice, KeepsTheLineCoding) {
    CdcAcmDevice device = configured_device();
    EXPECT_FALSE(device.line_coding());
    EXPECT_THAT(device.control({class_in, 0x21, 0, 0, 7}, {}).value(), ElementsAre(0x80, 0x25, 0, 0, 0, 0, 8))
        << "9600 8N1";
    const Bytes coding{0x00, 0xC2, 0x01, 0x00, 2, 2, 7};
    EXPECT_TRUE(device.control({class_out, 0x20, 0, 0, 7}, coding));
    EXPECT_EQ(to_string(*device.line_coding()), "115200 7E2");
    EXPECT_EQ(device.control({class_in, 0x21, 0, 0, 7}, {}).value(), coding);
    for (const Bytes& wrong : {Bytes{}, Bytes{0, 0, 0, 0, 0, 0}, Bytes{0, 0, 0, 0, 3, 0, 8}, Bytes{0, 0, 0, 0, 0, 5, 8},
                               Bytes{0, 0, 0, 0, 0, 0, 9}})
        EXPECT_TRUE(stalls(device, {class_out, 0x20, 0, 0, 7}, wrong));
    EXPECT_EQ(device.line_coding()->baud, 115200U) << "what stalled changed nothing";
}

TEST(CdcAcmDevice, FollowsLinesAndBreak) {
    CdcAcmDevice device = configured_device();
    EXPECT_TRUE(device.control({class_out, 0x22, 3, 0, 0}, {}));
    EXPECT_TRUE(device.dtr());
    EXPECT_TRUE(device.rts());
    EXPECT_TRUE(device.control({class_out, 0x22, 2, 0, 0}, {}));
    EXPECT_FALSE(device.dtr());
    EXPECT_FALSE(device.take_break());
    EXPECT_TRUE(device.control({class_out, 0x23, 0xFFFF, 0, 0}, {}));
    EXPECT_EQ(device.take_break(), 0xFFFF);
    EXPECT_FALSE(device.take_break()) << "told once";
}

TEST(CdcAcmDevice, NotifiesOfCarrierAndOverrun) {
    CdcAcmDevice device(ublox_face());
    EXPECT_FALSE(device.take_notification());
    EXPECT_TRUE(device.control({to_device, 9, 1, 0, 0}, {}));
    EXPECT_THAT(device.take_notification().value(), ElementsAre(0xA1, 0x20, 0, 0, 0, 0, 2, 0, 3, 0));
    EXPECT_FALSE(device.take_notification());
    device.note_overrun();
    EXPECT_THAT(device.take_notification().value(), ElementsAre(0xA1, 0x20, 0, 0, 0, 0, 2, 0, 0x43, 0));
}

TEST(CdcAcmDevice, ANewConfigurationForgetsWhatWasSet) {
    CdcAcmDevice device = configured_device();
    EXPECT_TRUE(device.control({class_out, 0x20, 0, 0, 7}, Bytes{0, 0xC2, 1, 0, 0, 0, 8}));
    EXPECT_TRUE(device.control({class_out, 0x22, 3, 0, 0}, {}));
    EXPECT_TRUE(device.control({to_endpoint, 3, 0, 1, 0}, {}));
    EXPECT_TRUE(device.control({to_device, 9, 1, 0, 0}, {}));
    EXPECT_FALSE(device.line_coding());
    EXPECT_FALSE(device.dtr());
    EXPECT_FALSE(device.halted(CdcAcmDevice::data_out));
}

TEST(CdcAcmDevice, StallsOnEverythingElse) {
    CdcAcmDevice device = configured_device();
    const UsbSetup unknown[] = {
        {from_device, 6, 0x0600, 0, 10},   // device qualifier
        {from_device, 6, 0x0F00, 0, 5},    // capabilities (BOS)
        {from_device, 6, 0x0201, 0, 255},  // a second configuration
        {from_device, 6, 0x0309, 0, 255},  // text 9
        {from_device, 7, 0, 0, 0},         // SET_DESCRIPTOR, the wrong way
        {from_endpoint, 0, 0, 0x84, 2},    // status of no endpoint
        {from_interface, 0, 0, 2, 2},      // status of no interface
        {from_interface, 10, 0, 2, 1},     // alternate setting of no interface
        {from_endpoint, 12, 0, 0x82, 2},   // SYNCH_FRAME
        {to_device, 9, 2, 0, 0},           // configuration 2
        {to_device, 3, 1, 0, 0},           // remote wake-up
        {to_device, 7, 0x0100, 0, 18},     // SET_DESCRIPTOR
        {to_interface, 11, 1, 1, 0},       // alternate setting 1
        {to_endpoint, 3, 0, 0x84, 0},      // halt of no endpoint
        {to_endpoint, 3, 1, 0x82, 0},      // no such feature
        {class_out, 0x00, 0, 0, 4},        // SEND_ENCAPSULATED_COMMAND
        {class_out, 0x20, 0, 1, 7},        // line coding of the data interface
        {class_in, 0x20, 0, 0, 7},         // SET_LINE_CODING, the wrong way
        {0xC0, 1, 0, 0, 4},                // a vendor's
    };
    for (const UsbSetup& setup : unknown)
        EXPECT_TRUE(stalls(device, setup)) << int{setup.type} << " " << int{setup.request} << " " << setup.value;
    EXPECT_TRUE(device.configured());
}

}  // namespace
}  // namespace skyloop
