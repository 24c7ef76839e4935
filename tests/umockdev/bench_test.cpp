// A bench of ten devices through the unmodified libusb: listed, told apart, plugged in and out.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "testbed.hpp"
#include "what_is_held.hpp"
#include "wire/devices/device_list.hpp"
#include "wire/usb/usb_device.hpp"
#include "wire/usb/usb_watch.hpp"

namespace skyloop {
namespace {

using mock::comes_down_to;
using mock::DeviceSpec;
using mock::memory_in_use;
using mock::MockDevice;
using mock::open_descriptors;
using std::chrono::milliseconds;
using testing::IsEmpty;

constexpr UsbIds cube_ids{0x2dae, 0x1016}, ftdi_ids{0x0403, 0x6015}, stm32_ids{0x0483, 0x5740};

DeviceSpec spec(UsbIds ids, const char* manufacturer, const char* product, const char* serial, const char* port) {
    const auto address = static_cast<std::uint8_t>(10 + port[0] - '0' + (port[1] == '.' ? 10 * (port[2] - '0') : 0));
    return {ids, manufacturer, product, serial, mock::cdc_acm_configuration(), port, address};
}
DeviceSpec hid_spec(UsbIds ids, const char* manufacturer, const char* product, const char* port) {
    DeviceSpec device = spec(ids, manufacturer, product, "", port);
    device.configuration = mock::hid_configuration({22, 8, true});
    return device;
}

DeviceSpec cube() { return spec(cube_ids, "CubePilot", "CubeOrange", "3100", "1"); }
DeviceSpec ftdi() { return spec(ftdi_ids, "FTDI", "FT230X Basic UART", "DM00ABCD", "2"); }
DeviceSpec relay() { return hid_spec({0x16c0, 0x05df}, "www.dcttech.com", "USBRelay2", "3.1"); }
DeviceSpec cp2110() { return hid_spec({0x10c4, 0xea80}, "Silicon Labs", "CP2110 HID USB-to-UART Bridge", "3.2"); }
DeviceSpec hub() {
    DeviceSpec device = spec({0x05e3, 0x0608}, "", "USB2.0 Hub", "", "3");
    device.configuration = mock::configuration(1, mock::interface(0, 0, {9, 0, 0}));
    device.device_class = 9;
    return device;
}

// Profiles of their own, so that a change of the project's data does not change what is tested here.
DeviceProfile profile_of(const char* name, DeviceKind kind, UsbIds ids, DeviceTransport transport) {
    DeviceProfile profile;
    profile.name = name;
    profile.kind = kind;
    profile.ids = {ids};
    profile.transport = transport;
    return profile;
}
std::vector<DeviceProfile> bench_profiles() {
    using Transport = DeviceTransport;
    std::vector<DeviceProfile> profiles{profile_of("cube", DeviceKind::autopilot, cube_ids, Transport::serial),
                                        profile_of("ftdi", DeviceKind::bridge, ftdi_ids, Transport::serial),
                                        profile_of("relay", DeviceKind::relay, {0x16c0, 0x05df}, Transport::hid),
                                        profile_of("cp2110", DeviceKind::bridge, {0x10c4, 0xea80}, Transport::hid),
                                        profile_of("betaflight", DeviceKind::autopilot, stm32_ids, Transport::serial),
                                        profile_of("stm32", DeviceKind::bridge, stm32_ids, Transport::none)};
    profiles[2].products = {"USBRelay*"};
    profiles[4].manufacturers = {"Betaflight"};
    return profiles;
}

std::shared_ptr<MockDevice> silent() { return std::make_shared<MockDevice>(); }

const Bytes report{0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                   0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x00, 0xb2, 0x02, 0x01, 0xc0};

void plug_in_bench(mock::Testbed& bed) {
    bed.plug_in(cube(), silent());
    bed.add_tty(cube(), 0, "ttyACM0", "cdc_acm");
    bed.add_tty(cube(), 2, "ttyACM1", "cdc_acm");
    bed.plug_in(ftdi(), silent());
    bed.add_tty(ftdi(), 0, "ttyUSB0", "ftdi_sio");
    bed.plug_in(hub(), silent());
    bed.plug_in(relay(), silent());
    bed.add_hidraw(relay(), 0, silent(), report);
    bed.plug_in(cp2110(), silent());
    bed.add_hidraw(cp2110(), 1, silent(), report);
    bed.plug_in(spec(stm32_ids, "Betaflight", "Betaflight STM32F405", "", "4"), silent());
    bed.plug_in(spec(stm32_ids, "STMicroelectronics", "STM32 Virtual ComPort", "", "5"), silent());
    bed.plug_in(hid_spec({0x16c0, 0x05df}, "somebody", "Not a relay", "6"), silent());
    bed.plug_in(spec({0x1234, 0x5678}, "Nobody", "Thing", "", "7"), silent());
    bed.plug_in(spec({0x1234, 0x5679}, "", "", "", "8"), silent());
}

const DeviceEntry* at_port(const std::vector<DeviceEntry>& devices, const std::string& port) {
    const auto found = std::find_if(devices.begin(), devices.end(),
                                    [&](const DeviceEntry& d) { return d.usb && d.usb->port_path == "1-" + port; });
    return found == devices.end() ? nullptr : &*found;
}
std::string profile_at(const std::vector<DeviceEntry>& devices, const std::string& port) {
    const DeviceEntry* device = at_port(devices, port);
    if (!device) return "absent";
    return device->known ? device->known->profile->name : std::string(device->kind_name());
}

TEST(Bench, EachDeviceHasItsProfileAndNodes) {
    mock::Testbed bed;
    plug_in_bench(bed);
    const auto profiles = bench_profiles();
    const auto devices = list_devices(profiles);
    ASSERT_TRUE(devices) << devices.error().message;
    ASSERT_EQ(std::count_if(devices->begin(), devices->end(), [](const DeviceEntry& d) { return d.usb.has_value(); }),
              10);
    EXPECT_EQ(profile_at(*devices, "1"), "cube");
    EXPECT_EQ(profile_at(*devices, "2"), "ftdi");
    EXPECT_EQ(profile_at(*devices, "3"), "hub");
    EXPECT_EQ(profile_at(*devices, "3.1"), "relay");
    EXPECT_EQ(profile_at(*devices, "3.2"), "cp2110");
    EXPECT_EQ(profile_at(*devices, "4"), "betaflight");
    EXPECT_EQ(profile_at(*devices, "5"), "stm32");
    EXPECT_EQ(profile_at(*devices, "6"), "unknown");
    EXPECT_EQ(profile_at(*devices, "7"), "unknown");
    EXPECT_EQ(at_port(*devices, "7")->title(), "Nobody Thing");
    EXPECT_EQ(at_port(*devices, "8")->title(), "it tells nothing of itself");

    const std::vector<DeviceNode>& lines = at_port(*devices, "1")->nodes;
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0].path, "/dev/ttyACM0");
    EXPECT_EQ(lines[0].interface, "1.0");
    EXPECT_TRUE(lines[0].exists);
    EXPECT_EQ(lines[1].path, "/dev/ttyACM1");
    EXPECT_EQ(lines[1].interface, "1.2");
    EXPECT_EQ(lines[2].path, mock::node_of(cube()));
    EXPECT_EQ(at_port(*devices, "2")->port(), "serial:/dev/ttyUSB0");
    EXPECT_EQ(at_port(*devices, "3.1")->nodes.at(0).path, "/dev/hidraw0");
    EXPECT_EQ(at_port(*devices, "3.2")->nodes.at(0).path, "/dev/hidraw1");
    EXPECT_EQ(at_port(*devices, "3.2")->port(), "hid:10c4:ea80@1-3.2");
    EXPECT_THAT(device_doubts(*at_port(*devices, "3.1")), IsEmpty());
    EXPECT_EQ(at_port(*devices, "3.1")->usb->product, "USBRelay2");
}

TEST(Bench, AMachineWithoutUsbHasNone) {
    mock::Testbed bed;
    const auto devices = list_devices(bench_profiles());
    ASSERT_TRUE(devices) << devices.error().message;
    EXPECT_TRUE(std::none_of(devices->begin(), devices->end(), [](const DeviceEntry& d) { return d.usb.has_value(); }));
    auto watch = UsbWatch::start(UsbWatchMode::hotplug);
    ASSERT_TRUE(watch) << watch.error().message;
    EXPECT_THAT(*watch->wait(milliseconds(50)), IsEmpty());
}

DeviceSpec numbered(DeviceSpec device, int number) {
    device.address = static_cast<std::uint8_t>(20 + number);
    return device;
}

// Listing goes on while a device comes and goes under its hands.
TEST(Bench, DevicesMayVanishWhileTheyAreDescribed) {
    constexpr int times = 30;
    mock::Testbed bed;
    plug_in_bench(bed);
    const auto profiles = bench_profiles();
    // umockdev ends the program where a listener leaves while it sends an event: this session keeps libusb listening.
    const auto session = open_usb();
    ASSERT_TRUE(session) << session.error().message;
    std::atomic<bool> stop{false};
    std::thread listing([&] {
        while (!stop)
            if (const auto devices = list_devices(profiles); !devices) ADD_FAILURE() << devices.error().message;
    });
    DeviceSpec last = ftdi();
    for (int i = 0; i < times; ++i) {
        bed.unplug_in_use(last);
        std::this_thread::sleep_for(milliseconds(2));
        last = numbered(ftdi(), 60 + i);  // past the addresses of the others
        bed.plug_in(last, silent());
        bed.add_tty(last, 0, fmt::format("ttyUSB{}", i + 1), "ftdi_sio");  // umockdev knows each name once
        std::this_thread::sleep_for(milliseconds(2));
    }
    stop = true;
    listing.join();
    const auto devices = list_devices(profiles);
    ASSERT_TRUE(devices);
    EXPECT_EQ(profile_at(*devices, "2"), "ftdi");
}

std::vector<UsbChange> changes_within(UsbWatch& watch, milliseconds time, std::size_t enough) {
    std::vector<UsbChange> all;
    const auto end = std::chrono::steady_clock::now() + time;
    while (all.size() < enough && std::chrono::steady_clock::now() < end) {
        const auto changes = watch.wait(milliseconds(100));
        if (!changes) return ADD_FAILURE() << changes.error().message, all;
        all.insert(all.end(), changes->begin(), changes->end());
    }
    return all;
}

// In and out once, both heard of in their order.
void expect_heard(mock::Testbed& bed, UsbWatch& watch, const DeviceSpec& device) {
    bed.plug_in(device, silent());
    const auto came = changes_within(watch, milliseconds(5000), 1);
    ASSERT_EQ(came.size(), 1U);
    EXPECT_TRUE(came[0].arrived);
    EXPECT_EQ(came[0].device.serial, "DM00ABCD");
    bed.unplug(device);
    const auto left = changes_within(watch, milliseconds(5000), 1);
    ASSERT_EQ(left.size(), 1U);
    EXPECT_FALSE(left[0].arrived);
    EXPECT_EQ(left[0].device.serial, "DM00ABCD");  // as it was known
    EXPECT_EQ(left[0].device.node, came[0].device.node);
}

// One hundred times in and out; what was used for it is given back. The testbed itself keeps a little of each device.
TEST(Hotplug, AStormIsHeardWhole) {
    constexpr int times = 100, warm = 10;
    constexpr milliseconds settling{500};
    mock::Testbed bed;
    bed.plug_in(cube(), silent());
    std::size_t alone = 0;
    for (int i = 0; i < times; ++i) {
        if (i == warm) std::this_thread::sleep_for(settling);
        if (i == warm) alone = memory_in_use();
        bed.plug_in(numbered(ftdi(), i), silent());
        bed.unplug(numbered(ftdi(), i));
    }
    std::this_thread::sleep_for(settling);
    alone = memory_in_use() - alone;
    auto watch = UsbWatch::start(UsbWatchMode::hotplug);
    ASSERT_TRUE(watch) << watch.error().message;
    ASSERT_EQ(changes_within(*watch, milliseconds(2000), 1).size(), 1U);  // what is there
    std::size_t descriptors = 0, memory = 0;
    for (int i = 0; i < times; ++i) {
        if (i == warm) std::this_thread::sleep_for(settling);
        if (i == warm) descriptors = open_descriptors(), memory = memory_in_use();
        SCOPED_TRACE(i);
        expect_heard(bed, *watch, numbered(ftdi(), i));
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_TRUE(comes_down_to(descriptors, open_descriptors)) << open_descriptors() << " after " << descriptors;
    constexpr std::size_t less_than_a_device = 512;
    const std::size_t most = memory + alone + less_than_a_device * (times - warm);
    EXPECT_TRUE(comes_down_to(most, memory_in_use))
        << memory_in_use() << " bytes after " << memory << ", " << alone << " without the watch";
}

// Nobody listens while it storms: in the end what is there is known.
TEST(Hotplug, AfterAnUnheardStormTheStateIsRight) {
    mock::Testbed bed;
    const auto profiles = bench_profiles();
    auto usb = UsbWatch::start(UsbWatchMode::hotplug);
    ASSERT_TRUE(usb);
    DeviceWatch watch(std::move(*usb), profiles);
    for (int i = 0; i < 100; ++i) {
        bed.plug_in(numbered(cube(), i), silent());
        if (i < 99) bed.unplug(numbered(cube(), i));
    }
    int there = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < end) {
        const auto news = watch.wait(milliseconds(1500));
        ASSERT_TRUE(news) << news.error().message;
        if (news->empty()) break;
        for (const DeviceNews& one : *news)
            there += one.arrived ? 1 : -1;
    }
    EXPECT_EQ(there, 1);
}

TEST(Hotplug, ALineIsToldWithTheDeviceThatItBelongsTo) {
    mock::Testbed bed;
    const auto profiles = bench_profiles();
    auto usb = UsbWatch::start(UsbWatchMode::hotplug);
    ASSERT_TRUE(usb);
    DeviceWatch watch(std::move(*usb), profiles);
    bed.plug_in(ftdi(), silent());
    EXPECT_THAT(*watch.wait(milliseconds(200)), IsEmpty());  // waits for its line
    bed.add_tty(ftdi(), 0, "ttyUSB0", "ftdi_sio");
    const auto came = watch.wait(milliseconds(3000));
    ASSERT_TRUE(came);
    ASSERT_EQ(came->size(), 1U);
    EXPECT_EQ(came->at(0).device.nodes.at(0).path, "/dev/ttyUSB0");
    bed.unplug(ftdi());
    const auto left = watch.wait(milliseconds(3000));
    ASSERT_EQ(left->size(), 1U);
    EXPECT_FALSE(left->at(0).arrived);
    EXPECT_EQ(left->at(0).device.nodes.at(0).path, "/dev/ttyUSB0");  // what is gone is named as it was
}

TEST(Hotplug, ADeviceWhoseLineNeverComesIsToldWithoutIt) {
    mock::Testbed bed;
    const auto profiles = bench_profiles();
    auto usb = UsbWatch::start(UsbWatchMode::hotplug);
    ASSERT_TRUE(usb);
    DeviceWatch watch(std::move(*usb), profiles);
    bed.plug_in(ftdi(), silent());
    const auto came = watch.wait(milliseconds(4000));
    ASSERT_TRUE(came);
    ASSERT_EQ(came->size(), 1U);
    EXPECT_EQ(came->at(0).device.port(), "");
    EXPECT_FALSE(device_doubts(came->at(0).device).empty());
}

// Without udevd, as in a container.
TEST(Polling, FindsWhatCameAndWhatLeft) {
    mock::Testbed bed;
    bed.plug_in(cube(), silent());
    auto watch = UsbWatch::start(UsbWatchMode::polling);
    ASSERT_TRUE(watch);
    EXPECT_TRUE(watch->polls());
    ASSERT_EQ(watch->wait(milliseconds(0))->size(), 1U);
    bed.plug_in(ftdi(), silent());
    auto changes = changes_within(*watch, milliseconds(3000), 1);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_TRUE(changes[0].arrived);
    EXPECT_EQ(changes[0].device.ids, ftdi_ids);
    // Out and in between two looks: another address tells that it is not the same.
    bed.unplug(ftdi());
    DeviceSpec again = ftdi();
    again.address = 99;
    bed.plug_in(again, silent());
    changes = changes_within(*watch, milliseconds(3000), 2);
    ASSERT_EQ(changes.size(), 2U);
    EXPECT_FALSE(changes[0].arrived);
    EXPECT_TRUE(changes[1].arrived);
    bed.unplug(again);
    changes = changes_within(*watch, milliseconds(3000), 1);
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_FALSE(changes[0].arrived);
    EXPECT_EQ(changes[0].device.serial, "DM00ABCD");
    EXPECT_THAT(*watch->wait(milliseconds(600)), IsEmpty());
}

struct Growth {
    std::size_t descriptors, memory;
};
Growth growth_of(const std::function<void()>& work) {
    constexpr int times = 100, warm = 10;
    std::size_t descriptors = 0, memory = 0;
    for (int i = 0; i < times; ++i) {
        if (i == warm) descriptors = open_descriptors(), memory = memory_in_use();
        work();
    }
    const auto more = [](std::size_t now, std::size_t before) { return now > before ? now - before : 0; };
    return {more(open_descriptors(), descriptors), more(memory_in_use(), memory)};
}

// Each look is a session of libusb, behind which umockdev keeps a little: nothing besides may stay.
TEST(Polling, LookingLeavesNothingBehind) {
    mock::Testbed bed;
    plug_in_bench(bed);
    const Growth bare = growth_of([] {
        const auto context = open_usb();
        ASSERT_TRUE(context);
        ASSERT_TRUE(list_usb_devices(*context));
    });
    auto watch = UsbWatch::start(UsbWatchMode::polling);
    ASSERT_TRUE(watch);
    EXPECT_EQ(watch->wait(milliseconds(0))->size(), 10U);
    const Growth looking = growth_of([&] { ASSERT_THAT(*watch->wait(milliseconds(0)), IsEmpty()); });
    EXPECT_EQ(looking.descriptors, bare.descriptors);
    constexpr std::size_t allowed = 8 << 10;
    EXPECT_LE(looking.memory, bare.memory + allowed);
}

}  // namespace
}  // namespace skyloop
