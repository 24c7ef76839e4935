#include "wire/devices/device_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::Not;

UsbDeviceInfo device_with(UsbIds ids, std::string manufacturer, std::string product) {
    return {ids, std::move(manufacturer), std::move(product), "", "1-1"};
}

DeviceProfile profile_of(std::string name, std::vector<UsbIds> ids, std::vector<std::string> products = {}) {
    DeviceProfile profile;
    profile.name = std::move(name);
    profile.ids = std::move(ids);
    profile.products = std::move(products);
    return profile;
}

constexpr UsbIds stm32{0x0483, 0x5740}, dfu{0x0483, 0xdf11}, fmu{0x26ac, 0x0032};

TEST(MatchesPattern, TakesStarsMarksAndSets) {
    EXPECT_TRUE(matches_pattern("USBRelay2", "USBRelay*"));
    EXPECT_TRUE(matches_pattern("USBRelay", "USBRelay*"));
    EXPECT_TRUE(matches_pattern("CubeOrange-BL", "*-BL"));
    EXPECT_TRUE(matches_pattern("a-BL-BL", "*-BL"));
    EXPECT_TRUE(matches_pattern("fmuv3", "fmuv[2345]"));
    EXPECT_TRUE(matches_pattern("fmuv3", "fmuv?"));
    EXPECT_TRUE(matches_pattern("", "*"));
    EXPECT_TRUE(matches_pattern("", ""));
    EXPECT_TRUE(matches_pattern("x[y", "x[y"));  // a bracket that does not close is itself
    EXPECT_TRUE(matches_pattern("aXbXc", "a*b*c"));
    EXPECT_FALSE(matches_pattern("HIDRelay", "USBRelay*"));
    EXPECT_FALSE(matches_pattern("CubeOrange", "*-BL"));
    EXPECT_FALSE(matches_pattern("fmuv6", "fmuv[2345]"));
    EXPECT_FALSE(matches_pattern("fmuv", "fmuv?"));
    EXPECT_FALSE(matches_pattern("x", ""));
    EXPECT_FALSE(matches_pattern("", "?"));
}

// A device may tell anything of itself: no text takes long.
TEST(MatchesPattern, IsNotDrawnIntoManyTries) {
    std::string pattern;
    for (int i = 0; i < 60; ++i)
        pattern += "*a";
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(matches_pattern(std::string(250, 'a') + 'b', pattern));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(MatchDevice, TellsFirmwaresOfTheSameIdsApart) {
    std::vector<DeviceProfile> profiles{profile_of("plain", {stm32}),
                                        profile_of("betaflight", {stm32}, {"Betaflight*"}),
                                        profile_of("inav", {stm32}, {"INAV*"})};
    profiles[2].manufacturers = {"INAV"};
    const auto name = [&](const UsbDeviceInfo& device) { return match_device(profiles, device)->profile->name; };
    EXPECT_EQ(name(device_with(stm32, "Betaflight", "Betaflight STM32F405")), "betaflight");
    EXPECT_EQ(name(device_with(stm32, "INAV", "MATEKF405")), "inav");
    EXPECT_EQ(name(device_with(stm32, "STMicroelectronics", "STM32 Virtual ComPort")), "plain");
    EXPECT_EQ(name(device_with(stm32, "", "")), "plain");
}

TEST(MatchDevice, KnowsABootloaderByItsIdsOrItsProduct) {
    std::vector<DeviceProfile> profiles{profile_of("fmu", {fmu})};
    profiles[0].bootloader_ids = {dfu};
    profiles[0].bootloader_products = {"PX4 BL *"};
    EXPECT_FALSE(match_device(profiles, device_with(fmu, "3D Robotics", "PX4 FMU v5.x"))->bootloader);
    EXPECT_TRUE(match_device(profiles, device_with(fmu, "3D Robotics", "PX4 BL FMU v5.x"))->bootloader);
    EXPECT_TRUE(match_device(profiles, device_with(dfu, "STMicroelectronics", "STM32  BOOTLOADER"))->bootloader);
    // A profile of the bootloader itself says more.
    profiles.push_back(profile_of("dfu", {dfu}));
    EXPECT_EQ(match_device(profiles, device_with(dfu, "", ""))->profile->name, "dfu");
}

TEST(MatchDevice, ProfilesThatNeedStringsLeaveOthersUnknown) {
    const std::vector<DeviceProfile> profiles{profile_of("relay", {{0x16c0, 0x05df}}, {"USBRelay*"})};
    EXPECT_FALSE(match_device(profiles, device_with({0x16c0, 0x05df}, "", "Keyboard")));
    EXPECT_FALSE(match_device(profiles, device_with({0x16c0, 0x05e0}, "", "USBRelay2")));
    EXPECT_FALSE(match_device({}, device_with(stm32, "", "")));
}

TEST(UdevRules, NameEachPairOfIdsOnce) {
    std::vector<DeviceProfile> profiles{profile_of("one", {stm32}),
                                        profile_of("two", {stm32, {0x0403, 0x6015}}, {"x"})};
    profiles[0].bootloader_ids = {dfu};
    profiles[1].latency_timer_ms = 1;
    const std::string rules = udev_rules(profiles);
    EXPECT_THAT(rules, HasSubstr("# one, two\n"));
    EXPECT_THAT(rules, HasSubstr("# one (bootloader)\n"));
    EXPECT_THAT(rules, HasSubstr(udev_rules_of(stm32)));
    EXPECT_THAT(rules, HasSubstr("ATTRS{idVendor}==\"0403\", ATTRS{idProduct}==\"6015\", ATTR{latency_timer}=\"1\""));
    EXPECT_EQ(rules.find(udev_rules_of(stm32)), rules.rfind(udev_rules_of(stm32)));
    EXPECT_THAT(udev_rules_of(stm32), Not(HasSubstr("latency")));
}

}  // namespace
}  // namespace skyloop
