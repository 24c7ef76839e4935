// Devices as libusb and both backends of hidapi find them, and what is said where one may not be opened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "as_nobody.hpp"
#include "mock_cdc_acm.hpp"
#include "testbed.hpp"
#include "what_is_held.hpp"
#include "wire/hid/hid_device.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop {
namespace {

using mock::AsNobody;
using mock::DeviceSpec;
using mock::MockDevice;
using testing::HasSubstr;

DeviceSpec ublox() {
    return {{0x1546, 0x01a8}, "u-blox AG", "u-blox GNSS receiver", "", mock::cdc_acm_configuration(), "1", 4};
}

// Reports without numbers, of eight bytes, as a relay board of the V-USB family has them.
class MockReports : public MockDevice {
public:
    Answer control(const mock::Setup& setup, ByteSpan data) override {
        if (setup.type == 0x21 && setup.request == 9) {
            feature = Bytes(data.begin(), data.end());
            return {};
        }
        if (setup.type == 0xa1 && setup.request == 1) return {Status::done, feature};
        return stall();
    }
    Answer out(std::uint8_t, ByteSpan data) override {
        written = Bytes(data.begin(), data.end());
        return {};
    }
    Answer in(std::uint8_t, std::size_t) override {
        if (input.empty()) return busy();
        return {Status::done, std::exchange(input, {})};
    }
    Bytes feature = Bytes(8);
    Bytes written;
    Bytes input;
};

const Bytes eight_bytes_report{0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                               0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x00, 0xb2, 0x02, 0x01, 0xc0};

DeviceSpec relay() {
    return {
        {0x16c0, 0x05df}, "www.dcttech.com", "USBRelay2", "A0001", mock::hid_configuration({22, 8, true}), "3.2", 6};
}

// A port of a hub exists where the hub does.
DeviceSpec hub() {
    return {{0x1d6b, 0x0002}, "", "hub", "", mock::configuration(1, mock::interface(0, 0, {9, 0, 0})), "3", 5};
}

TEST(UsbDevices, AreListedWithTheirTexts) {
    mock::Testbed bed;
    bed.plug_in(ublox(), std::make_shared<MockDevice>());
    bed.plug_in(hub(), std::make_shared<MockDevice>());
    bed.plug_in(relay(), std::make_shared<MockDevice>());
    const auto context = open_usb();
    ASSERT_TRUE(context) << context.error().message;
    const auto devices = list_usb_devices(*context);
    ASSERT_TRUE(devices);
    ASSERT_EQ(devices->size(), 3U);
    const auto found = find_usb_device(*context, *parse_usb_address("16c0:05df@1-3.2"));
    ASSERT_TRUE(found) << found.error().message;
    const UsbDeviceInfo info = describe(*found);
    EXPECT_EQ(info.manufacturer, "www.dcttech.com");
    EXPECT_EQ(info.product, "USBRelay2");
    EXPECT_EQ(info.serial, "A0001");
    EXPECT_EQ(info.port_path, "1-3.2");
}

TEST(UsbDevices, AbsentOnesAreToldWithWhatIsThere) {
    mock::Testbed bed;
    bed.plug_in(hub(), std::make_shared<MockDevice>());
    bed.plug_in(relay(), std::make_shared<MockDevice>());
    const auto context = open_usb();
    ASSERT_TRUE(context);
    EXPECT_EQ(find_usb_device(*context, *parse_usb_address("1546:01a8")).error().message,
              "no USB device 1546:01a8 is plugged in");
    EXPECT_EQ(find_usb_device(*context, *parse_usb_address("16c0:05df:B7")).error().message,
              "no USB device 16c0:05df:B7; of these ids there is serial A0001 at 1-3.2");
}

TEST(UsbDevices, Open) {
    mock::Testbed bed;
    auto device = std::make_shared<mock::MockCdcAcm>();
    bed.plug_in(ublox(), device);
    const auto context = open_usb();
    ASSERT_TRUE(context);
    const auto found = find_usb_device(*context, *parse_usb_address("1546:01a8"));
    ASSERT_TRUE(found);
    const auto handle = open_usb_device(*context, *found);
    EXPECT_TRUE(handle) << handle.error().message;
}

TEST(UsbDevices, WithoutPermissionTheSentenceNamesTheNode) {
    mock::Testbed bed;
    bed.plug_in(ublox(), std::make_shared<MockDevice>());
    const auto context = open_usb();
    ASSERT_TRUE(context);
    const auto found = find_usb_device(*context, *parse_usb_address("1546:01a8"));
    ASSERT_TRUE(found);
    bed.forbid(ublox());
    const AsNobody nobody;
    const auto handle = open_usb_device(*context, *found);
    ASSERT_FALSE(handle);
    EXPECT_EQ(handle.error().message,
              "cannot open USB device 1546:01a8 at 1-1 (/dev/bus/usb/001/004): no permission; a udev rule gives it: "
              "skyloop devices shows the line");
}

// A session each time, as where no udevd tells of changes; and one that lives through all of it.
TEST(UsbDevices, ComeAndGoAHundredTimes) {
    mock::Testbed bed;
    const auto witness = open_usb();
    ASSERT_TRUE(witness);
    const auto address = *parse_usb_address("1546:01a8");
    std::size_t descriptors = 0;
    for (int round = 0; round < 100; ++round) {
        DeviceSpec spec = ublox();
        spec.address = static_cast<std::uint8_t>(4 + round);
        bed.plug_in(spec, std::make_shared<MockDevice>());
        {
            const auto context = open_usb();
            ASSERT_TRUE(context);
            const auto found = find_usb_device(*context, address);
            ASSERT_TRUE(found) << round;
            ASSERT_TRUE(open_usb_device(*context, *found)) << round;
        }
        bed.unplug(spec);
        const auto context = open_usb();
        ASSERT_TRUE(context);
        ASSERT_FALSE(find_usb_device(*context, address)) << round;
        if (round == 9) descriptors = mock::open_descriptors();
    }
    EXPECT_TRUE(mock::comes_down_to(descriptors, mock::open_descriptors));
    ASSERT_TRUE(list_usb_devices(*witness));
}

class HidDevices : public testing::TestWithParam<HidBackend> {};

TEST_P(HidDevices, CarryReportsBothWays) {
    mock::Testbed bed;
    auto device = std::make_shared<MockReports>();
    bed.plug_in(hub(), std::make_shared<MockDevice>());
    bed.plug_in(relay(), device);
    bed.add_hidraw(relay(), 0, device, eight_bytes_report);
    auto hid = HidDevice::open(*parse_usb_address("16c0:05df:A0001"), GetParam());
    ASSERT_TRUE(hid) << hid.error().message;
    EXPECT_EQ(hid->backend(), GetParam());
    EXPECT_EQ(hid->info().product, "USBRelay2");
    EXPECT_EQ(hid->info().port_path, "1-3.2");
    ASSERT_TRUE(hid->send_feature(Bytes{0, 0xff, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(device->feature, (Bytes{0xff, 2, 3, 4, 5, 6, 7, 8}));
    const auto feature = hid->get_feature(0, 9);
    ASSERT_TRUE(feature) << feature.error().message;
    EXPECT_EQ(*feature, (Bytes{0, 0xff, 2, 3, 4, 5, 6, 7, 8}));
    ASSERT_TRUE(hid->write(Bytes{0, 1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(device->written, (Bytes{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(hid->read(std::chrono::milliseconds(0)).value(), Bytes{});
}

TEST_P(HidDevices, WithoutPermissionTheSentenceNamesTheNode) {
    mock::Testbed bed;
    auto device = std::make_shared<MockReports>();
    bed.plug_in(hub(), std::make_shared<MockDevice>());
    bed.plug_in(relay(), device);
    bed.add_hidraw(relay(), 0, device, eight_bytes_report);
    bed.forbid(relay());
    const AsNobody nobody;
    const std::string node = GetParam() == HidBackend::hidraw ? "/dev/hidraw0" : "/dev/bus/usb/001/006";
    for (const std::string address : {"16c0:05df", "16c0:05df:A0001"}) {
        const auto hid = HidDevice::open(*parse_usb_address(address), GetParam());
        ASSERT_FALSE(hid);
        EXPECT_EQ(hid.error().message, "cannot open HID device " + address + " (" + node +
                                           "): no permission; a udev rule gives it: skyloop devices shows the line");
    }
}

TEST_P(HidDevices, AreAbsentInOneSentence) {
    mock::Testbed bed;
    const auto hid = HidDevice::open(*parse_usb_address("16c0:05df"), GetParam());
    ASSERT_FALSE(hid);
    EXPECT_EQ(hid.error().message, "no HID device 16c0:05df is plugged in");
}

INSTANTIATE_TEST_SUITE_P(Backend, HidDevices, testing::Values(HidBackend::hidraw, HidBackend::libusb),
                         [](const auto& backend) {
                             return backend.param == HidBackend::hidraw ? std::string("hidraw") : std::string("libusb");
                         });

}  // namespace
}  // namespace skyloop
