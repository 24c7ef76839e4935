// What stands in the way of using a device, and nodes, in a play of /sys, /dev, /run and /proc.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "wire/devices/device_list.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class PlayedSystem : public testing::Test {
protected:
    PlayedSystem() {
        std::string name = (fs::temp_directory_path() / "skyloop_devices_XXXXXX").string();
        root = ::mkdtemp(name.data());
        ::chmod(root.c_str(), 0755);
        folders = {root / "sys", root / "dev", root / "run", root / "proc"};
        profile.name = "fake";
        profile.ids = {{0x1546, 0x01a8}};
        profile.transport = DeviceTransport::serial;
        write(folders.devices / "ttyACM0", "");
        write(interface() / "tty" / "ttyACM0" / "dev", "166:0\n");
        write(interface() / "bInterfaceClass", "02\n");
        write(interface() / "bInterfaceSubClass", "02\n");
        write(interface() / "bInterfaceProtocol", "01\n");
        write(device() / "dev", "189:3\n");
    }
    ~PlayedSystem() override {
        std::error_code error;
        fs::remove_all(root, error);
    }
    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    [[nodiscard]] fs::path device() const { return folders.sysfs / "bus/usb/devices/1-2"; }
    [[nodiscard]] fs::path interface() const { return device() / "1-2:1.0"; }
    [[nodiscard]] DeviceEntry entry(const std::string& serial = "") const {
        return look_up_device({{0x1546, 0x01a8}, "", "", serial, "1-2", "/dev/bus/usb/001/004"}, {&profile, 1},
                              folders);
    }
    [[nodiscard]] std::vector<std::string> doubts() const { return device_doubts(entry(), folders); }

    fs::path root;
    SystemFolders folders;
    DeviceProfile profile;
};

TEST_F(PlayedSystem, ADeviceThatMayBeUsedLeavesNoDoubt) {
    EXPECT_THAT(doubts(), IsEmpty());
    const DeviceEntry device = entry();
    ASSERT_EQ(device.nodes.size(), 2U);
    EXPECT_EQ(device.nodes[0].path, folders.devices / "ttyACM0");
    EXPECT_EQ(device.nodes[0].interface, "1.0");
    EXPECT_TRUE(device.nodes[0].usable);
    EXPECT_FALSE(device.nodes[1].exists);  // its own node, which a serial line does not need
    EXPECT_EQ(device.port(), "serial:" + (folders.devices / "ttyACM0").string());
}

TEST_F(PlayedSystem, ThePathThatStaysIsTheBetterName) {
    profile.baud = 57600;
    fs::create_directories(folders.devices / "serial/by-id");
    fs::create_symlink("../../ttyACM0", folders.devices / "serial/by-id/usb-fake-if00");
    fs::create_symlink("../../ttyACM7", folders.devices / "serial/by-id/usb-another-if00");
    EXPECT_EQ(entry("A1").port(), "serial:" + (folders.devices / "serial/by-id/usb-fake-if00").string() + "@57600");
}

TEST_F(PlayedSystem, ManyInterfacesAreNamedInTheirOrder) {
    write(device() / "1-2:1.2" / "tty" / "ttyACM1" / "dev", "166:1\n");
    write(device() / "1-2:1.4" / "ttyUSB3" / "tty" / "ttyUSB3" / "dev", "188:3\n");
    write(device() / "1-2:1.5" / "0003:1546:01A8.0001" / "hidraw" / "hidraw2" / "dev", "240:2\n");
    const DeviceEntry device = entry();
    ASSERT_EQ(device.nodes.size(), 5U);
    EXPECT_EQ(device.nodes[1].interface, "1.2");
    EXPECT_EQ(device.nodes[2].path, folders.devices / "ttyUSB3");
    EXPECT_EQ(device.nodes[3].kind, NodeKind::hidraw);
    EXPECT_EQ(device.nodes[4].kind, NodeKind::usb);
}

// In a child that is nobody: the superuser may use everything.
std::vector<std::string> doubts_of_nobody(const std::function<std::vector<std::string>()>& ask) {
    int ends[2] = {-1, -1};
    if (::pipe(ends) != 0) return {"no pipe"};
    const pid_t child = ::fork();
    if (child == 0) {
        const bool dropped = ::geteuid() != 0 || (::setgid(65534) == 0 && ::setuid(65534) == 0);
        std::string text;
        for (const std::string& doubt : dropped ? ask() : std::vector<std::string>{"cannot become nobody"})
            text += doubt + '\n';
        const bool told = ::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
        ::_exit(told ? 0 : 1);
    }
    ::close(ends[1]);
    std::string text;
    char bytes[4096];
    for (ssize_t size = 0; (size = ::read(ends[0], bytes, sizeof bytes)) > 0;)
        text.append(bytes, static_cast<std::size_t>(size));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    std::vector<std::string> lines;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        lines.push_back(text.substr(at, end - at));
    return lines;
}

TEST_F(PlayedSystem, WithoutPermissionTheRuleIsTold) {
    ASSERT_EQ(::chmod((folders.devices / "ttyACM0").c_str(), 0000), 0);
    const auto told = doubts_of_nobody([this] { return doubts(); });
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0], HasSubstr("no permission for " + (folders.devices / "ttyACM0").string()));
    EXPECT_THAT(told[0], HasSubstr("mode 0): a udev rule for 1546:01a8 gives it"));
    EXPECT_THAT(told[0], HasSubstr("skyloop devices --udev-rules"));
}

TEST_F(PlayedSystem, WhereAGroupMayUseItTheGroupIsTold) {
    if (::geteuid() != 0) GTEST_SKIP() << "only the superuser may give a file to another group";
    const std::string line = folders.devices / "ttyACM0";
    constexpr gid_t dialout = 20;  // Debian's; by its name or its number in the sentence
    ASSERT_EQ(::chown(line.c_str(), 0, dialout), 0);
    ASSERT_EQ(::chmod(line.c_str(), 0660), 0);
    const auto told = doubts_of_nobody([this] { return doubts(); });
    ASSERT_EQ(told.size(), 1U);
    EXPECT_THAT(told[0],
                testing::MatchesRegex(".*mode 660.: 'sudo usermod -aG (dialout|20) .USER', then log in again"));
}

TEST_F(PlayedSystem, ModemManagerIsToldWhereItWouldProbe) {
    write(folders.processes / "812" / "comm", "ModemManager\n");
    ASSERT_EQ(doubts().size(), 1U);
    EXPECT_THAT(doubts()[0], HasSubstr("ModemManager runs"));
    // A rule keeps it away.
    write(folders.run / "udev/data/c189:3", "E:ID_VENDOR=x\nE:ID_MM_DEVICE_IGNORE=1\n");
    EXPECT_THAT(doubts(), IsEmpty());
    write(folders.run / "udev/data/c189:3", "E:ID_MM_DEVICE_IGNORE=0\n");
    EXPECT_EQ(doubts().size(), 1U);
    // It is no modem by its own words.
    write(interface() / "bInterfaceProtocol", "00\n");
    EXPECT_THAT(doubts(), IsEmpty());
}

TEST_F(PlayedSystem, OtherProcessesAreNoModemManager) {
    write(folders.processes / "812" / "comm", "bash\n");
    write(folders.processes / "self" / "comm", "ModemManager\n");  // a link, no process of its own
    EXPECT_THAT(doubts(), IsEmpty());
}

TEST_F(PlayedSystem, ALongLatencyTimerIsTold) {
    profile.latency_timer_ms = 1;
    const fs::path timer = folders.sysfs / "class/tty/ttyACM0/device/latency_timer";
    write(timer, "16\n");
    ASSERT_EQ(doubts().size(), 1U);
    EXPECT_THAT(doubts()[0], HasSubstr("up to 16 ms"));
    write(timer, "1\n");
    EXPECT_THAT(doubts(), IsEmpty());
}

TEST_F(PlayedSystem, ADeviceWithoutItsLineIsTold) {
    fs::remove_all(interface());
    EXPECT_THAT(doubts(), ElementsAre(HasSubstr("made no serial line")));
    EXPECT_EQ(entry().port(), "");
}

TEST_F(PlayedSystem, DevicesOfOneSerialNumberAreNamedByTheirPorts) {
    profile.transport = DeviceTransport::hid;
    std::vector<DeviceEntry> devices;
    for (const auto& [serial, port] : {std::pair{"0001", "1-1"}, {"0001", "1-2"}, {"0002", "1-3"}})
        devices.push_back(look_up_device({{0x10c4, 0xea80}, "", "", serial, port}, {}, folders));
    for (DeviceEntry& device : devices)
        device.known = DeviceMatch{&profile, false};
    devices.push_back({});  // a line of the machine itself
    mark_shared_serials(devices);
    EXPECT_EQ(devices[0].port(), "hid:10c4:ea80@1-1");
    EXPECT_EQ(devices[1].port(), "hid:10c4:ea80@1-2");
    EXPECT_EQ(devices[2].port(), "hid:10c4:ea80:0002");
}

TEST_F(PlayedSystem, LinesOfDevicesAlikeAreNamedByTheirPorts) {
    const auto link = [&](const char* name) {
        const fs::path path = folders.devices / "serial" / name;
        fs::create_directories(path.parent_path());
        fs::create_symlink("../../ttyACM0", path);
        return "serial:" + path.string();
    };
    const std::string by_id = link("by-id/usb-fake_0001-if00");
    const std::string line = "serial:" + (folders.devices / "ttyACM0").string();
    std::vector<DeviceEntry> devices{entry("0001"), entry("0001")};
    EXPECT_EQ(devices[0].port(), by_id) << "as long as it is alone";
    EXPECT_THAT(device_doubts(devices[0], folders), IsEmpty());
    mark_shared_serials(devices);
    EXPECT_EQ(devices[0].port(), line) << "the link may lead to the other one";
    EXPECT_THAT(device_doubts(devices[0], folders), ElementsAre(HasSubstr("no link in /dev/serial/by-path")));
    EXPECT_EQ(entry("").port(), line) << "of any number";
    const std::string by_path = link("by-path/pci-0000:00:14.0-usb-0:2:1.0");
    devices = {entry("0001"), entry("0001")};
    mark_shared_serials(devices);
    EXPECT_EQ(devices[0].port(), by_path);
    EXPECT_THAT(device_doubts(devices[0], folders), IsEmpty());
    EXPECT_EQ(entry("").port(), by_path);
    EXPECT_EQ(entry("A1").port(), by_id);
}

TEST_F(PlayedSystem, AHidBridgeIsNamedBySerialNumberOrPort) {
    profile.transport = DeviceTransport::hid;
    UsbDeviceInfo usb{{0x1546, 0x01a8}, "", "", "00A1", "1-2"};
    EXPECT_EQ(look_up_device(usb, {&profile, 1}, folders).port(), "hid:1546:01a8:00A1");
    usb.serial.clear();
    EXPECT_EQ(look_up_device(usb, {&profile, 1}, folders).port(), "hid:1546:01a8@1-2");
    usb.serial = "A,1";  // a URI would end it at the comma
    EXPECT_EQ(look_up_device(usb, {&profile, 1}, folders).port(), "hid:1546:01a8@1-2");
    profile.kind = DeviceKind::relay;  // carries no bytes
    EXPECT_EQ(look_up_device(usb, {&profile, 1}, folders).port(), "");
}

TEST_F(PlayedSystem, ABootloaderIsNoWire) {
    profile.bootloader_products = {"*-BL"};
    const UsbDeviceInfo usb{{0x1546, 0x01a8}, "", "board-BL", "", "1-2"};
    const DeviceEntry device = look_up_device(usb, {&profile, 1}, folders);
    EXPECT_EQ(device.kind_name(), "bootloader");
    EXPECT_EQ(device.port(), "");
    EXPECT_THAT(device_doubts(device, folders), ElementsAre(HasSubstr("bootloader runs")));
}

TEST_F(PlayedSystem, LinesOfTheMachineAreThoseWithAUart) {
    for (const auto& [name, type] : std::initializer_list<std::pair<const char*, const char*>>{
             {"ttyS0", "4\n"}, {"ttyS1", "0\n"}, {"ttyAMA0", "16\n"}, {"tty0", nullptr}, {"ptmx", nullptr}}) {
        fs::create_directories(folders.sysfs / "class/tty" / name);
        if (type) write(folders.sysfs / "class/tty" / name / "type", type);
    }
    const auto lines = own_serial_lines(folders);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].nodes.at(0).path, folders.devices / "ttyAMA0");
    EXPECT_EQ(lines[0].kind_name(), "uart");
    EXPECT_EQ(lines[1].port(), "serial:" + (folders.devices / "ttyS0").string());
    EXPECT_THAT(device_doubts(lines[1], folders), ElementsAre(HasSubstr("is not there")));
}

TEST_F(PlayedSystem, ADeviceThatIsGoneHasNoNodes) {
    fs::remove_all(folders.sysfs);
    fs::remove_all(folders.devices);
    const DeviceEntry device = entry();
    ASSERT_EQ(device.nodes.size(), 1U);  // its own, which libusb names
    EXPECT_FALSE(device.nodes[0].exists);
}

}  // namespace
}  // namespace skyloop
