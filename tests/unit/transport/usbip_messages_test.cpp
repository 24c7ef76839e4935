#include "wire/transport/usbip_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "usbip_host.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

using test::words;

UsbipDevice a_device() {
    UsbipDevice device;
    device.path = "/sys/devices/x/usb1/1-1";
    device.bus_id = "1-1";
    device.ids = {0x1546, 0x01a8};
    device.release = 0x0301;
    device.device_class = {2, 0, 0};
    device.configuration = 1;
    device.interfaces = {{2, 2, 1}, {10, 0, 0}};
    return device;
}

TEST(UsbipRequest, ListAndImport) {
    const auto list = parse_usbip_request(words({0x01118005, 0}));
    ASSERT_TRUE(list.message);
    EXPECT_EQ(list.message->kind, UsbipRequest::Kind::device_list);
    EXPECT_EQ(list.size, 8U);
    Bytes import = words({0x01118003, 0, 0x312d3100});
    EXPECT_FALSE(parse_usbip_request(import).message) << "28 bytes are missing";
    EXPECT_THAT(parse_usbip_request(import).mistake, "");
    import.resize(50);
    const auto parsed = parse_usbip_request(import);
    ASSERT_TRUE(parsed.message);
    EXPECT_EQ(parsed.message->kind, UsbipRequest::Kind::import);
    EXPECT_EQ(parsed.message->bus_id, "1-1");
    EXPECT_EQ(parsed.size, 40U);
    std::fill(import.begin() + 8, import.end(), 'x');
    EXPECT_EQ(parse_usbip_request(import).message->bus_id, std::string(32, 'x')) << "no zero at its end";
}

TEST(UsbipRequest, MistakesAreSeenAtOnce) {
    EXPECT_THAT(parse_usbip_request(to_bytes("GE")).mistake, HasSubstr("version 0x4745; expected 0x0111"));
    EXPECT_THAT(parse_usbip_request(words({0x01118004})).mistake, HasSubstr("request 0x8004"));
    EXPECT_THAT(parse_usbip_request({}).mistake, "");
    EXPECT_FALSE(parse_usbip_request(words({0x01118005})).message);
}

// The transfers of the kernel's documentation, "CmdIntrIN" and "CmdIntrOUT".
TEST(UsbipCommand, ReadsSubmit) {
    const auto in = parse_usbip_command(words({1, 0xd05, 0x1000f, 1, 1, 0x200, 0x40, 0xffffffff, 0, 4, 0, 0}));
    ASSERT_TRUE(in.message) << in.mistake;
    const auto& submit = std::get<UsbipSubmit>(*in.message);
    EXPECT_EQ(submit.sequence, 0xd05U);
    EXPECT_EQ(submit.device, 0x1000fU);
    EXPECT_TRUE(submit.to_host);
    EXPECT_EQ(submit.endpoint, 1U);
    EXPECT_EQ(submit.length, 0x40U);
    EXPECT_EQ(in.size, 48U) << "data come with the answer";

    Bytes out = words({1, 0xd06, 0x1000f, 0, 1, 0, 5, 0, 0xffffffff, 4, 0, 0});
    EXPECT_FALSE(parse_usbip_command(out).message) << "the data are missing";
    const Bytes data = to_bytes("$GPGGA");
    out.insert(out.end(), data.begin(), data.end());
    const auto parsed = parse_usbip_command(out);
    ASSERT_TRUE(parsed.message);
    EXPECT_EQ(parsed.size, 53U);
    EXPECT_EQ(to_string(std::get<UsbipSubmit>(*parsed.message).data), "$GPGG");
    EXPECT_EQ(std::get<UsbipSubmit>(*parsed.message).packets, -1);
}

TEST(UsbipCommand, ReadsTheSetupOfEndpointZero) {
    const auto parsed = parse_usbip_command(words({1, 7, 0x10002, 1, 0, 0x200, 18, 0, 0, 0, 0x80060001, 0x00001200}));
    ASSERT_TRUE(parsed.message);
    const UsbSetup& setup = std::get<UsbipSubmit>(*parsed.message).setup;
    EXPECT_EQ(setup.type, 0x80);
    EXPECT_EQ(setup.request, 6);
    EXPECT_EQ(setup.value, 0x0100) << "low byte first";
    EXPECT_EQ(setup.length, 18);
}

TEST(UsbipCommand, ReadsUnlink) {
    const Bytes bytes = words({2, 9, 0x10002, 0, 0, 7, 0, 0, 0, 0, 0, 0});
    const auto parsed = parse_usbip_command(bytes);
    ASSERT_TRUE(parsed.message);
    EXPECT_EQ(std::get<UsbipUnlink>(*parsed.message).sequence, 9U);
    EXPECT_EQ(std::get<UsbipUnlink>(*parsed.message).target, 7U);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const auto part = parse_usbip_command(ByteSpan(bytes).first(size));
        EXPECT_FALSE(part.message) << size;
        EXPECT_EQ(part.mistake, "") << size;
    }
}

TEST(UsbipCommand, RefusesWhatNoHostSends) {
    const auto mistake = [](const Bytes& bytes) { return parse_usbip_command(bytes).mistake; };
    EXPECT_THAT(mistake(words({0x48545450})), HasSubstr("command 0x48545450; expected 1 (submit) or 2 (unlink)"));
    EXPECT_THAT(mistake(words({3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})), HasSubstr("command 0x00000003"));
    EXPECT_THAT(mistake(words({1, 1, 0x10002, 2, 2, 0, 64, 0, 0, 0, 0, 0})), HasSubstr("direction 2"));
    EXPECT_THAT(mistake(words({1, 1, 0x10002, 0, 1, 0, 0x7fffffff, 0, 0, 0, 0, 0})),
                HasSubstr("a transfer of 2147483647 bytes; expected at most 262144"));
    EXPECT_THAT(mistake(words({1, 1, 0x10002, 1, 2, 0, 0xffffffff, 0, 0, 0, 0, 0})), HasSubstr("4294967295 bytes"));
    EXPECT_THAT(mistake(words({1, 1, 0x10002, 1, 2, 0, 64, 0, 0x10000000, 0, 0, 0})),
                HasSubstr("268435456 isochronous packets; expected none"));
}

TEST(UsbipReplies, DeviceListAsDocumented) {
    const UsbipDevice device = a_device();
    const Bytes list = usbip_device_list(&device);
    ASSERT_EQ(list.size(), 12U + 312 + 8);
    EXPECT_EQ(Bytes(list.begin(), list.begin() + 12), words({0x01110005, 0, 1}));
    EXPECT_EQ(to_string(ByteSpan(list).subspan(12, 6)), "/sys/d");
    EXPECT_EQ(to_string(ByteSpan(list).subspan(0x10C, 4)), std::string("1-1\0", 4));
    EXPECT_EQ(Bytes(list.begin() + 0x12C, list.begin() + 0x144), words({1, 2, 2, 0x154601a8, 0x03010200, 0x00010102}));
    EXPECT_EQ(Bytes(list.begin() + 0x144, list.end()), words({0x02020100, 0x0a000000}));
    EXPECT_EQ(usbip_device_list(nullptr), words({0x01110005, 0, 0}));
}

TEST(UsbipReplies, ImportAsDocumented) {
    const Bytes granted = usbip_import_reply(UsbipImport::granted, a_device());
    ASSERT_EQ(granted.size(), 8U + 312);
    EXPECT_EQ(Bytes(granted.begin() + 0x128, granted.end()), words({1, 2, 2, 0x154601a8, 0x03010200, 0x00010102}));
    EXPECT_EQ(usbip_import_reply(UsbipImport::busy, a_device()), words({0x01110003, 2}));
    UsbipDevice long_names = a_device();
    long_names.path = std::string(1000, 'p');
    long_names.bus_id = std::string(100, 'b');
    const Bytes cut = usbip_import_reply(UsbipImport::granted, long_names);
    ASSERT_EQ(cut.size(), 8U + 312);
    EXPECT_EQ(cut[8 + 255], 0);
    EXPECT_EQ(cut[8 + 256 + 31], 0);
}

TEST(UsbipReplies, SubmitAndUnlinkAsDocumented) {
    UsbipSubmit submit;
    submit.sequence = 0xd05;
    submit.packets = -1;
    Bytes expected = words({3, 0xd05, 0, 0, 0, 0, 2, 0, 0xffffffff, 0, 0, 0});
    expected.insert(expected.end(), {'o', 'k'});
    EXPECT_EQ(usbip_submit_reply(submit, UsbipStatus::success, 2, to_bytes("ok")), expected);
    submit.packets = 0;
    EXPECT_EQ(usbip_submit_reply(submit, UsbipStatus::stalled, 0, {}),
              words({3, 0xd05, 0, 0, 0, 0xffffffe0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(usbip_unlink_reply({9, 0x10002, 7}, UsbipStatus::unlinked),
              words({4, 9, 0, 0, 0, 0xffffff98, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace skyloop
