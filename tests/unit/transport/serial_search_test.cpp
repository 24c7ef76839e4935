#include "wire/transport/serial_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "serial_bench.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using test::FarEnd;
using test::PlayedSystem;
using test::UsbTree;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(SerialSearch, KnowsAnAdapterThroughLinks) {
    UsbTree usb;
    const FarEnd far;
    usb.plug_in("ttyUSB7", "1-1.4", "A1", far);
    const PlayedSystem system(usb.roots);
    fs::create_directories(usb.roots.devices / "serial" / "by-id");
    const fs::path link = usb.roots.devices / "serial" / "by-id" / "usb-FTDI-A1";
    fs::create_symlink("../../ttyUSB7", link);
    EXPECT_EQ(tty_name(system, link), "ttyUSB7");
    const auto identity = usb_identity(system, link);
    ASSERT_TRUE(identity);
    EXPECT_EQ(identity->vendor + ":" + identity->product, "0403:6001");
    EXPECT_EQ(identity->serial, "A1");
    EXPECT_EQ(identity->port_path, "1-1.4");
    EXPECT_EQ(identity->interface, "1.0");
    EXPECT_FALSE(usb_identity(system, "/dev/null"));
}

TEST(SerialSearch, TakesNoOtherAdapterForTheLostOne) {
    UsbTree usb;
    const FarEnd far;
    const PlayedSystem system(usb.roots);
    const fs::path tty0 = usb.roots.devices / "ttyUSB0", tty1 = usb.roots.devices / "ttyUSB1";
    usb.plug_in("ttyUSB0", "1-1", "0001", far);
    const auto numbered = usb_identity(system, tty0);
    EXPECT_THAT(places_to_look(system, tty0, numbered, {}), ElementsAre(tty0));
    usb.unplug("ttyUSB0", "1-1");
    EXPECT_THAT(places_to_look(system, tty0, numbered, {}), IsEmpty());
    usb.plug_in("ttyUSB0", "1-2", "", far);
    EXPECT_THAT(places_to_look(system, tty0, numbered, {}), IsEmpty()) << "another serial number";
    usb.unplug("ttyUSB0", "1-2");
    usb.plug_in("ttyUSB0", "1-2", "0001", far);
    EXPECT_THAT(places_to_look(system, tty0, numbered, {}), ElementsAre(tty0)) << "at another port";
    usb.plug_in("ttyUSB1", "1-3", "0001", far);
    EXPECT_THAT(places_to_look(system, tty0, numbered, {}), IsEmpty()) << "two of one number: either could be it";
    UsbIdentity at_three = *numbered;
    at_three.port_path = "1-3";
    EXPECT_THAT(places_to_look(system, tty0, at_three, {}), ElementsAre(tty1)) << "the one at its port is it";
}

TEST(SerialSearch, TakesNoneThatWasThereBesideTheLostOne) {
    UsbTree usb;
    const FarEnd far;
    const PlayedSystem system(usb.roots);
    const fs::path tty0 = usb.roots.devices / "ttyUSB0", tty2 = usb.roots.devices / "ttyUSB2";
    usb.plug_in("ttyUSB0", "1-1", "0001", far);
    usb.plug_in("ttyUSB1", "1-2", "0001", far);
    usb.plug_in("ttyUSB3", "1-4", "A1", far);
    const auto identity = usb_identity(system, tty0);
    const std::vector<std::string> beside = ports_beside(system, *identity);
    EXPECT_THAT(beside, ElementsAre("1-2")) << "of its number, and not itself";
    usb.unplug("ttyUSB0", "1-1");
    EXPECT_THAT(places_to_look(system, tty0, identity, beside), IsEmpty());
    usb.plug_in("ttyUSB2", "1-3", "0001", far);
    EXPECT_THAT(places_to_look(system, tty0, identity, beside), ElementsAre(tty2));
    usb.unplug("ttyUSB2", "1-3");
    usb.plug_in("ttyUSB2", "1-1", "0001", far);
    EXPECT_THAT(places_to_look(system, tty0, identity, beside), ElementsAre(tty2)) << "at its port";
}

TEST(SerialSearch, FollowsNoLinkToOneThatWasThereBesideTheLostOne) {
    UsbTree usb;
    const FarEnd far;
    const PlayedSystem system(usb.roots);
    const fs::path link = usb.roots.devices / "usb-1a86_USB_Serial-if00-port0";
    usb.plug_in("ttyUSB0", "1-1", "", far);
    usb.plug_in("ttyUSB1", "1-2", "", far);
    fs::create_symlink("ttyUSB0", link);
    const auto identity = usb_identity(system, link);
    const std::vector<std::string> beside = ports_beside(system, *identity);
    usb.unplug("ttyUSB0", "1-1");
    fs::remove(link);
    fs::create_symlink("ttyUSB1", link);  // as udev gives it to the other one of the same name
    EXPECT_THAT(places_to_look(system, link, identity, beside), IsEmpty());
}

TEST(SerialSearch, WithoutASerialNumberThePortOrTheLinkCounts) {
    UsbTree usb;
    const FarEnd far;
    const PlayedSystem system(usb.roots);
    const fs::path tty0 = usb.roots.devices / "ttyUSB0", link = usb.roots.devices / "link";
    usb.plug_in("ttyUSB0", "1-1", "", far);
    const auto nameless = usb_identity(system, tty0);
    EXPECT_THAT(places_to_look(system, tty0, nameless, {}), ElementsAre(tty0));
    usb.unplug("ttyUSB0", "1-1");
    usb.plug_in("ttyUSB3", "1-2", "", far);
    EXPECT_THAT(places_to_look(system, tty0, nameless, {}), IsEmpty());
    fs::create_symlink("ttyUSB3", link);
    EXPECT_THAT(places_to_look(system, link, nameless, {}), ElementsAre(link)) << "udev has renewed the link";
    usb.plug_in("ttyUSB4", "1-1", "", far);
    EXPECT_THAT(places_to_look(system, tty0, nameless, {}), ElementsAre(usb.roots.devices / "ttyUSB4"));
}

}  // namespace
}  // namespace skyloop
