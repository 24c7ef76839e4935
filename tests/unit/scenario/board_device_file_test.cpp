// Device files: what they hold, their mistakes, and the ones of the project.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string device_mistakes(std::string_view text) {
    const auto read = read_devices(text, "bench.toml");
    return read ? std::string() : read.error().message;
}

TEST(DeviceFile, EveryKeyIsTaken) {
    const auto devices = read_devices(R"(description = "all keys"
bootloader_product = ["*-BL"]
[[device]]
name = "one"
description = "The one"
kind = "bridge"
usb = ["0403:6015", "0403:6001"]
product = "FT*"
manufacturer = ["FTDI", "Future*"]
bootloader_usb = "0483:DF11"
good_for = "a line"
transport = "serial"
baud = 38400
max_baud = 3000000
latency_timer_ms = 1
hints = ["first", "second"]
[[device]]
name = "two"
kind = "relay"
usb = "16c0:05df"
bootloader_product = "boot*"
)",
                                      "bench.toml");
    ASSERT_TRUE(devices) << devices.error().message;
    ASSERT_EQ(devices->size(), 2U);
    const DeviceProfile& one = (*devices)[0];
    EXPECT_EQ(one.name, "one");
    EXPECT_EQ(one.description, "The one");
    EXPECT_EQ(one.kind, DeviceKind::bridge);
    EXPECT_EQ(one.ids, (std::vector<UsbIds>{{0x0403, 0x6015}, {0x0403, 0x6001}}));
    EXPECT_EQ(one.products, std::vector<std::string>{"FT*"});
    EXPECT_EQ(one.manufacturers, (std::vector<std::string>{"FTDI", "Future*"}));
    EXPECT_EQ(one.bootloader_ids, (std::vector<UsbIds>{{0x0483, 0xdf11}}));
    EXPECT_EQ(one.bootloader_products, std::vector<std::string>{"*-BL"});
    EXPECT_EQ(one.good_for, "a line");
    EXPECT_EQ(one.transport, DeviceTransport::serial);
    EXPECT_EQ(one.baud, 38400U);
    EXPECT_EQ(one.max_baud, 3000000U);
    EXPECT_EQ(one.latency_timer_ms, 1U);
    EXPECT_EQ(one.hints.size(), 2U);
    const DeviceProfile& two = (*devices)[1];
    EXPECT_EQ(two.kind, DeviceKind::relay);
    EXPECT_EQ(two.transport, DeviceTransport::none);
    EXPECT_EQ(two.bootloader_products, std::vector<std::string>{"boot*"});
}

TEST(DeviceFile, MistakesNameLineColumnAndKey) {
    const std::string head = "[[device]]\nname = \"a\"\nkind = \"bridge\"\n";
    EXPECT_EQ(device_mistakes(head + "usb = \"1546:1a8\"\n"),
              "bench.toml:4:7: device.usb: is '1546:1a8'; expected VID:PID, four hexadecimal digits each, such as "
              "'1546:01a8'");
    EXPECT_THAT(device_mistakes(head + "usb = \"1546:01a8\"\nprodukt = \"x\"\n"),
                HasSubstr("bench.toml:5:1: device.produkt: unknown key; did you mean 'product'?"));
    EXPECT_THAT(device_mistakes(head), HasSubstr("has no ids"));
    EXPECT_THAT(device_mistakes(head + "usb = [\"1546:01a8\", \"1546:01A8\"]\n"), HasSubstr("twice"));
    EXPECT_THAT(device_mistakes(head + "usb = \"1546:01a8\"\nbaud = 9600\nmax_baud = 4800\n"),
                HasSubstr("5:8: device.baud: is 9600; expected at most max_baud, 4800"));
    EXPECT_THAT(device_mistakes(head + "usb = \"1546:01a8\"\nhints = [\"a\\nb\"]\n"), HasSubstr("line breaks"));
    EXPECT_THAT(device_mistakes("[[device]]\nname = \"A b\"\nkind = \"brigde\"\nusb = \"1546:01a8\"\n"),
                testing::AllOf(HasSubstr("2:8: device.name: is 'A b'"), HasSubstr("did you mean 'bridge'")));
    EXPECT_THAT(device_mistakes("[[device]]\nusb = \"1546:01a8\"\n"),
                testing::AllOf(HasSubstr("has no name"), HasSubstr("has no kind")));
    EXPECT_THAT(device_mistakes("description = \"x\"\n"), HasSubstr("has no device"));
    EXPECT_THAT(device_mistakes("device = []\n"), HasSubstr("bench.toml:1:10: device: holds none"));
    EXPECT_THAT(device_mistakes("[[device]\n"), HasSubstr("bench.toml:1:"));
}

TEST(DeviceFile, TwoDevicesMustBeToldApart) {
    const std::string two = R"([[device]]
name = "a"
kind = "bridge"
usb = "1546:01a8"
[[device]]
name = "b"
kind = "bridge"
usb = "1546:01a8"
)";
    EXPECT_THAT(device_mistakes(two), HasSubstr("bench.toml:5:1: [device] usb: 1546:01a8 is that of 'a' too"));
    EXPECT_EQ(device_mistakes(two + "product = \"B*\"\n"), "");
    EXPECT_THAT(
        device_mistakes("[[device]]\nname = \"a\"\nkind = \"gpio\"\nusb = \"0001:0001\"\n[[device]]\nname = \"a\"\n"
                        "kind = \"gpio\"\nusb = \"0001:0002\"\n"),
        HasSubstr("'a' is that of another device"));
}

// Every pair of ids that a bench of today has.
TEST(DeviceFile, TheProjectsFilesKnowTheBench) {
    const fs::path boards = fs::path(__FILE__).parent_path() / "../../../boards";
    const auto devices = load_devices(std::vector<fs::path>{boards});
    ASSERT_TRUE(devices) << devices.error().message;
    for (const char* ids :
         {"1546:01a5", "1546:01a6", "1546:01a7", "1546:01a8", "1546:01a9", "1546:01ab", "152a:85c0", "26ac:0011",
          "26ac:0012", "26ac:0032", "3185:0033", "3185:0035", "3185:0038", "1b8c:0036", "3643:001d", "2dae:1011",
          "2dae:1012", "2dae:1016", "2dae:1058", "2dae:1059", "3162:004b", "3162:0050", "3163:004c", "1209:5740",
          "1209:5741", "0483:5740", "0483:df11", "0403:6001", "0403:6010", "0403:6011", "0403:6014", "0403:6015",
          "10c4:ea60", "10c4:ea70", "1a86:7523", "1a86:5523", "067b:2303", "067b:23a3", "10c4:ea80", "04d8:00dd"}) {
        SCOPED_TRACE(ids);
        const auto match = match_device(*devices, {*parse_usb_ids(ids), "", "", "", "1-1"});
        ASSERT_TRUE(match);
        EXPECT_FALSE(match->bootloader);
        EXPECT_FALSE(match->profile->description.empty());
        EXPECT_FALSE(match->profile->good_for.empty());
    }
    const auto named = [&](UsbIds ids, const char* manufacturer, const char* product) {
        return match_device(*devices, {ids, manufacturer, product, "", "1-1"})->profile->name;
    };
    EXPECT_EQ(named({0x16c0, 0x05df}, "www.dcttech.com", "USBRelay2"), "usb-relay");
    // Ids that are anybody's: only their names tell them apart.
    EXPECT_FALSE(match_device(*devices, {{0x0525, 0xa4a7}, "", "", "", "1-1"}));
    EXPECT_EQ(named({0x0525, 0xa4a7}, "skyloop", "GNSS receiver"), "skyloop");
    EXPECT_EQ(named({0x0525, 0xa4a7}, "Linux 6.1.0 with musb-hdrc", "Gadget Serial v2.4"), "linux-gadget-serial");
    EXPECT_EQ(named({0x0525, 0xa4a7}, "Trimble", "R2"), "trimble-usb");
    EXPECT_EQ(named({0x0483, 0x5740}, "Betaflight", "Betaflight STM32F405"), "betaflight");
    EXPECT_EQ(named({0x0483, 0x5740}, "INAV", "MATEKF722"), "inav");
    EXPECT_EQ(named({0x0483, 0x5740}, "ArduPilot", "fmuv3"), "ardupilot-stm32");
    EXPECT_EQ(named({0x0525, 0xa4a7}, "Linux 6.1 with dwc2", "Gadget Serial v2.4"), "linux-gadget-serial");
    EXPECT_TRUE(match_device(*devices, {{0x2dae, 0x1016}, "Hex", "CubeOrange-BL", "", "1-1"})->bootloader);
}

class DeviceFolders : public testing::Test {
protected:
    DeviceFolders() {
        std::string name = (fs::temp_directory_path() / "skyloop_devicefiles_XXXXXX").string();
        root = ::mkdtemp(name.data());
    }
    ~DeviceFolders() override {
        std::error_code error;
        fs::remove_all(root, error);
    }
    void write(const char* file, const std::string& name, const std::string& ids) {
        fs::create_directories((root / file).parent_path());
        std::ofstream(root / file) << "[[device]]\nname = \"" << name << "\"\nkind = \"gpio\"\nusb = \"" << ids
                                   << "\"\n";
    }
    fs::path root;
};

TEST_F(DeviceFolders, AnEarlierFolderHidesFilesOfTheSameName) {
    write("mine/adapters/a.toml", "mine", "0001:0001");
    write("all/adapters/a.toml", "hidden", "0001:0001");
    write("all/autopilots/a.toml", "autopilot", "0001:0002");
    const auto devices = load_devices(std::vector<fs::path>{root / "mine", root / "all", root / "absent"});
    ASSERT_TRUE(devices) << devices.error().message;
    ASSERT_EQ(devices->size(), 2U);
    EXPECT_EQ((*devices)[0].name, "mine");
    EXPECT_EQ((*devices)[1].name, "autopilot");
}

TEST_F(DeviceFolders, FilesThatClashAreNamed) {
    write("all/adapters/a.toml", "a", "0001:0001");
    write("all/adapters/b.toml", "b", "0001:0001");
    const auto devices = load_devices(std::vector<fs::path>{root / "all"});
    ASSERT_FALSE(devices);
    EXPECT_THAT(devices.error().message, testing::AllOf(HasSubstr("b.toml: usb: 0001:0001"), HasSubstr("'a'")));
}

TEST_F(DeviceFolders, NoFilesAreNoMistake) {
    const auto devices = load_devices(std::vector<fs::path>{root});
    ASSERT_TRUE(devices);
    EXPECT_TRUE(devices->empty());
}

}  // namespace
}  // namespace skyloop
