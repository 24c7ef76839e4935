// Relay boards, the MCP2221A and hubs, switched through the unmodified libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "as_nobody.hpp"
#include "testbed.hpp"
#include "wire/actuator/actuator_uri.hpp"
#include "wire/actuator/power_watchdog.hpp"

namespace skyloop {
namespace {

using mock::AsNobody;
using mock::DeviceSpec;
using mock::MockDevice;
using testing::AnyOf;
using testing::HasSubstr;

// A board of eight-byte reports without numbers (HID 1.11, section 7.2: 09 is Set_Report, 01 Get_Report).
class MockRelays : public MockDevice {
public:
    explicit MockRelays(std::uint8_t answers_to = 0) : answers_to_(answers_to) {}
    Answer control(const mock::Setup& setup, ByteSpan data) override {
        if (setup.type == 0x21 && setup.request == 9) return take(data);
        const bool asked = setup.type == 0xa1 && setup.request == 1 && (setup.value & 0xff) == answers_to_;
        if (!asked) return stall();
        const std::lock_guard lock(mutex_);
        return {Status::done, {'H', 'U', 'R', 'T', 'M', 0, 0, drawn_}};
    }
    Answer out(std::uint8_t, ByteSpan data) override { return take(data); }
    [[nodiscard]] int drawn() const {
        const std::lock_guard lock(mutex_);
        return drawn_;
    }
    std::atomic<bool> stuck{false};
    Bytes last;  // of a test that has waited for the order

private:
    Answer take(ByteSpan data) {
        const std::lock_guard lock(mutex_);
        last.assign(data.begin(), data.end());
        if (stuck || data.size() < 2) return {};
        const auto bit = static_cast<std::uint8_t>(1U << (data[1] - 1U));
        if (data[0] == 0xff) drawn_ = static_cast<std::uint8_t>(drawn_ | bit);
        if (data[0] == 0xfd) drawn_ = static_cast<std::uint8_t>(drawn_ & ~bit);
        return {};
    }
    mutable std::mutex mutex_;
    std::uint8_t drawn_ = 0;
    const std::uint8_t answers_to_;
};

const Bytes eight_bytes{0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                        0x00, 0x75, 0x08, 0x95, 0x08, 0x09, 0x00, 0xb2, 0x02, 0x01, 0xc0};

DeviceSpec board(const std::string& product, const std::string& port = "1", std::uint8_t address = 4) {
    DeviceSpec spec;
    spec.ids = {0x16c0, 0x05df};
    spec.manufacturer = "www.dcttech.com";
    spec.product = product;
    spec.configuration = mock::hid_configuration({22, 8, true});
    spec.port = port;
    spec.address = address;
    return spec;
}

// With the kernel's driver a hidraw node is there and taken; without it libusb is.
class Relays : public testing::TestWithParam<bool> {
protected:
    void plug_in(mock::Testbed& bed, const DeviceSpec& spec, const std::shared_ptr<MockDevice>& device) {
        bed.plug_in(spec, device);
        if (GetParam()) bed.add_hidraw(spec, nodes_++, device, eight_bytes);
    }

private:
    int nodes_ = 0;
};

TEST_P(Relays, SwitchAndTellTheirState) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>();
    plug_in(bed, board("USBRelay2"), relays);
    const auto second = open_actuator("relay:16c0:05df/2");
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ((*second)->description(), "relay 2 of USBRelay2 (16c0:05df at 1-1)");
    EXPECT_EQ((*second)->state().value(), PowerState::on);
    const auto cut = (*second)->cut();
    ASSERT_TRUE(cut) << cut.error().message;
    EXPECT_EQ(relays->drawn(), 2);
    EXPECT_EQ((*second)->state().value(), PowerState::cut);
    ASSERT_TRUE((*second)->restore());
    EXPECT_EQ(relays->drawn(), 0);
}

TEST_P(Relays, PowerWhileDrawnWhereTheyAreWiredSo) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>(1);  // one that answers to the other number
    plug_in(bed, board("USBRelay1"), relays);
    const auto relay = open_actuator("relay:16c0:05df@1-1/1,active=power");
    ASSERT_TRUE(relay) << relay.error().message;
    EXPECT_EQ((*relay)->state().value(), PowerState::cut);
    ASSERT_TRUE((*relay)->restore());
    EXPECT_EQ(relays->drawn(), 1);
    ASSERT_TRUE((*relay)->cut());
    EXPECT_EQ(relays->drawn(), 0);
}

TEST_P(Relays, OneThatDoesNotFollowIsTold) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>();
    relays->stuck = true;
    plug_in(bed, board("USBRelay2"), relays);
    const auto relay = open_actuator("relay:16c0:05df/1");
    ASSERT_TRUE(relay) << relay.error().message;
    EXPECT_EQ((*relay)->cut().error().message,
              "relay 1 of USBRelay2 (16c0:05df at 1-1) did not follow: the board says it is not drawn");
}

TEST_P(Relays, OfTheOtherKindTellNoState) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>();
    plug_in(bed, board("HIDRelay"), relays);
    const auto relay = open_actuator("relay:16c0:05df/3");
    ASSERT_TRUE(relay) << relay.error().message;
    ASSERT_TRUE((*relay)->cut());
    EXPECT_EQ(relays->last, (Bytes{0xf3, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ((*relay)->state().value(), std::nullopt);
    ASSERT_TRUE((*relay)->restore());
    EXPECT_EQ(relays->last, (Bytes{0x03, 0, 0, 0, 0, 0, 0, 0}));
}

TEST_P(Relays, OthersOfTheSameIdsAreRefused) {
    mock::Testbed bed;
    const auto stranger = std::make_shared<MockRelays>();
    plug_in(bed, board("Joystick"), stranger);
    const auto relay = open_actuator("relay:16c0:05df/1");
    ASSERT_FALSE(relay);
    EXPECT_EQ(relay.error().code, ErrorCode::outside);
    EXPECT_EQ(relay.error().message,
              "16c0:05df at 1-1 is 'Joystick', no relay board; expected the product USBRelay1 to 8 or HIDRelay");
    EXPECT_TRUE(stranger->last.empty()) << "nothing was sent to it";
    const auto board_2 = std::make_shared<MockRelays>();
    plug_in(bed, board("USBRelay2", "2", 5), board_2);
    EXPECT_THAT(open_actuator("relay:16c0:05df@1-2/3").error().message, HasSubstr("it has no relay 3"));
    EXPECT_THAT(open_actuator("relay:16c0:05df@1-2:A/1").error().message, HasSubstr("names no USB device"));
    for (const char* uri : {"relay:16c0:05df:HURTM/1", "relay:16c0:05df/2"}) {
        const auto found = open_actuator(uri);
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_THAT((*found)->description(), HasSubstr("at 1-2"));
    }
    // Whichever of both comes first.
    EXPECT_THAT(open_actuator("relay:16c0:05df:OTHER/1").error().message,
                AnyOf(HasSubstr("'Joystick'"),
                      HasSubstr("the relay board at 1-2 has the serial number 'HURTM'; expected 'OTHER'")));
    EXPECT_THAT(open_actuator("relay:16c0:0001/1").error().message, HasSubstr("no HID device 16c0:0001 is plugged in"));
}

TEST_P(Relays, WithoutPermissionTheSentenceNamesTheNode) {
    mock::Testbed bed;
    plug_in(bed, board("USBRelay2"), std::make_shared<MockRelays>());
    bed.forbid(board("USBRelay2"));
    const AsNobody nobody;
    const auto relay = open_actuator("relay:16c0:05df/1");
    ASSERT_FALSE(relay);
    EXPECT_THAT(relay.error().message,
                HasSubstr(GetParam() ? "(/dev/hidraw0): no permission" : "(/dev/bus/usb/001/004): no permission"));
}

TEST_P(Relays, UnpluggedTheyFail) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>();
    plug_in(bed, board("USBRelay2"), relays);
    const auto relay = open_actuator("relay:16c0:05df/1");
    ASSERT_TRUE(relay) << relay.error().message;
    relays->present = false;
    const auto cut = (*relay)->cut();
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().code, ErrorCode::outside);
}

// Of a child that has ended, or any for -1.
int status_of(pid_t child) {
    int status = -1;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

// The process that cut the power is gone without a word: another one restores, by handles of its own.
TEST_P(Relays, AreRestoredAfterAKill) {
    mock::Testbed bed;
    const auto relays = std::make_shared<MockRelays>();
    plug_in(bed, board("USBRelay2"), relays);
    ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // the orphaned watchdog becomes ours
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string uri = "relay:16c0:05df/2";
        const auto watchdog = PowerWatchdog::start({uri});
        const auto relay = open_actuator(uri);
        if (watchdog && relay && (*watchdog)->note_cut(0) && (*relay)->cut()) ::kill(::getpid(), SIGKILL);
        ::_exit(1);
    }
    EXPECT_TRUE(WIFSIGNALED(status_of(child))) << "it could not cut";
    // To its end: it holds the board's node open, and umockdev's answers must not go before its last call.
    const int watchdog = status_of(-1);
    EXPECT_TRUE(WIFEXITED(watchdog) && WEXITSTATUS(watchdog) == 0) << watchdog;
    EXPECT_EQ(relays->drawn(), 0);
    EXPECT_EQ(relays->last, (Bytes{0xfd, 2, 0, 0, 0, 0, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(Backend, Relays, testing::Values(true, false), [](const auto& with_node) {
    return with_node.param ? std::string("hidraw") : std::string("libusb");
});

// Commands of the MCP2221A as its data sheet has them (DS20005565, section 3.1). GP1 is a clock from the factory on.
class MockMcp2221 : public MockDevice {
public:
    Answer out(std::uint8_t, ByteSpan command) override {
        const std::lock_guard lock(mutex_);
        if (command.size() != 64) return stall();
        answer_.assign(64, 0);
        answer_[0] = command[0];
        for (std::size_t pin = 0; pin < 4; ++pin) {
            const std::size_t set = 2 + 4 * pin;
            const bool gpio = (settings_[pin] & 7) == 0;
            if (command[0] == 0x50 && gpio && command[set] != 0) value(pin, command[set + 1]);
            if (command[0] == 0x50 && gpio && command[set + 2] != 0) direction(pin, command[set + 3]);
            if (command[0] == 0x51) {
                answer_[2 + 2 * pin] = gpio ? settings_[pin] >> 4 & 1 : 0xEE;
                answer_[3 + 2 * pin] = gpio ? settings_[pin] >> 3 & 1 : 0xEF;
            }
            if (command[0] == 0x60 && (command[7] & 0x80) != 0) settings_[pin] = command[8 + pin];
            // What command 50 has done does not show here.
            if (command[0] == 0x60 && (command[7] & 0x80) != 0) told_[pin] = settings_[pin];
            if (command[0] == 0x61) answer_[22 + pin] = told_[pin];
        }
        return {};
    }
    Answer in(std::uint8_t, std::size_t) override {
        const std::lock_guard lock(mutex_);
        if (answer_.empty()) return busy();
        return {Status::done, std::exchange(answer_, {})};
    }
    [[nodiscard]] int setting(std::size_t pin) const {
        const std::lock_guard lock(mutex_);
        return settings_[pin];
    }

private:
    void value(std::size_t pin, int high) {
        settings_[pin] = static_cast<std::uint8_t>((settings_[pin] & ~0x10) | (high != 0 ? 0x10 : 0));
    }
    void direction(std::size_t pin, int in) {
        settings_[pin] = static_cast<std::uint8_t>((settings_[pin] & ~0x08) | (in != 0 ? 0x08 : 0));
    }
    mutable std::mutex mutex_;
    std::array<std::uint8_t, 4> settings_{0x02, 0x01, 0x08, 0x00}, told_ = settings_;
    Bytes answer_;
};

DeviceSpec converter() {
    DeviceSpec spec;
    spec.ids = {0x04d8, 0x00dd};
    spec.product = "MCP2221 USB-I2C/UART Combo";
    spec.configuration = mock::hid_configuration({28, 64, true});
    return spec;
}

// The kernel's driver gives it no hidraw node.
TEST(Mcp2221, SwitchesAPinThroughLibusb) {
    mock::Testbed bed;
    const auto chip = std::make_shared<MockMcp2221>();
    bed.plug_in(converter(), chip);
    const auto pin = open_actuator("gpio:04d8:00dd/2");  // an input
    ASSERT_TRUE(pin) << pin.error().message;
    EXPECT_EQ((*pin)->state().value(), std::nullopt);
    const auto cut = (*pin)->cut();
    ASSERT_TRUE(cut) << cut.error().message;
    EXPECT_EQ(chip->setting(2), 0x10);
    EXPECT_EQ((*pin)->state().value(), PowerState::cut);
    ASSERT_TRUE((*pin)->restore());
    EXPECT_EQ(chip->setting(2), 0x00);
    EXPECT_EQ(chip->setting(1), 0x01) << "the others keep what they have";
}

TEST(Mcp2221, WithoutPermissionTheSentenceNamesTheNode) {
    mock::Testbed bed;
    EXPECT_EQ(open_actuator("gpio:04d8:00dd/2").error().message, "no HID device 04d8:00dd is plugged in");
    bed.plug_in(converter(), std::make_shared<MockMcp2221>());
    bed.forbid(converter());
    const AsNobody nobody;
    EXPECT_EQ(open_actuator("gpio:04d8:00dd/2").error().message,
              "cannot open HID device 04d8:00dd (" + node_of(converter()) +
                  "): no permission; a udev rule gives it: skyloop devices shows the line");
}

TEST(Mcp2221, TakesAPinFromItsOtherDuty) {
    mock::Testbed bed;
    const auto chip = std::make_shared<MockMcp2221>();
    bed.plug_in(converter(), chip);
    const auto pin = open_actuator("gpio:04d8:00dd/1,active=power");
    ASSERT_TRUE(pin) << pin.error().message;
    const auto restored = (*pin)->restore();
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(chip->setting(1), 0x10);
    ASSERT_TRUE((*pin)->cut());
    EXPECT_EQ(chip->setting(1), 0x00);
    EXPECT_EQ(chip->setting(0), 0x02);
    EXPECT_EQ(chip->setting(2), 0x08);
}

TEST(Mcp2221, LeavesAnotherPinCutThatItSharesTheChipWith) {
    mock::Testbed bed;
    const auto chip = std::make_shared<MockMcp2221>();
    bed.plug_in(converter(), chip);
    {
        const auto other = open_actuator("gpio:04d8:00dd/3");  // a GPIO already
        ASSERT_TRUE(other) << other.error().message;
        ASSERT_TRUE((*other)->cut());
        EXPECT_EQ(chip->setting(3), 0x10);
    }
    const auto pin = open_actuator("gpio:04d8:00dd/1");  // a clock
    ASSERT_TRUE(pin) << pin.error().message;
    ASSERT_TRUE((*pin)->restore());
    EXPECT_EQ(chip->setting(1), 0x00);
    EXPECT_EQ(chip->setting(3), 0x10);
}

// Requests of a hub (USB 2.0, table 11-16).
class MockHub : public MockDevice {
public:
    explicit MockHub(std::uint8_t characteristics) : characteristics_(characteristics) {}
    Answer control(const mock::Setup& setup, ByteSpan) override {
        const std::lock_guard lock(mutex_);
        if (setup.type == 0xa0 && setup.request == 6 && setup.value == 0x2900)
            return {Status::done, {9, 0x29, 4, characteristics_, 0, 50, 100, 0, 0xff}};
        if (setup.index < 1 || setup.index > 4) return stall();
        const auto bit = static_cast<std::uint8_t>(1U << setup.index);
        if (setup.type == 0x23 && setup.value == 8 && setup.request == 3 && !stuck) powered_ |= bit;
        if (setup.type == 0x23 && setup.value == 8 && setup.request == 1 && !stuck) {
            powered_ &= static_cast<std::uint8_t>(~bit);
            claimed_at_cut = claimed.load();
        }
        if (setup.type == 0x23) return {};
        if (setup.type != 0xa3 || setup.request != 0) return stall();
        return {Status::done, {0, static_cast<std::uint8_t>((powered_ & bit) != 0 ? 1 : 0), 0, 0}};
    }
    [[nodiscard]] int powered() const {
        const std::lock_guard lock(mutex_);
        return powered_;
    }
    void port_claimed(unsigned port, bool now) override { claimed = now ? static_cast<int>(port) : 0; }
    std::atomic<bool> stuck{false};
    std::atomic<int> claimed{0}, claimed_at_cut{0};  // the port that the kernel's hub driver is kept off

private:
    mutable std::mutex mutex_;
    std::uint8_t powered_ = 0x1e;
    const std::uint8_t characteristics_;
};

DeviceSpec hub() {
    DeviceSpec spec;
    spec.ids = {0x2109, 0x3431};
    spec.configuration = mock::configuration(1, mock::interface(0, 0, {9, 0, 0}));
    spec.port = "3";
    spec.address = 5;
    return spec;
}

TEST(HubPort, IsSwitchedAlone) {
    mock::Testbed bed;
    const auto device = std::make_shared<MockHub>(std::uint8_t{0x09});
    bed.plug_in(hub(), device);
    const auto port = open_actuator("hub:1-3.2");
    ASSERT_TRUE(port) << port.error().message;
    EXPECT_EQ((*port)->description(), "port 2 of the hub 2109:3431 at 1-3");
    EXPECT_EQ((*port)->state().value(), PowerState::on);
    const auto cut = (*port)->cut();
    ASSERT_TRUE(cut) << cut.error().message;
    EXPECT_EQ(device->powered(), 0x1a);
    EXPECT_EQ((*port)->state().value(), PowerState::cut);
    ASSERT_TRUE((*port)->restore());
    EXPECT_EQ(device->powered(), 0x1e);
    device->stuck = true;
    EXPECT_THAT((*port)->cut().error().message, HasSubstr("did not follow: the hub says its power is on"));
}

// The driver switches a port on again when what was plugged in has gone, unless it is claimed. Here none does; what is
// seen is that it would not.
TEST(HubPort, IsKeptFromTheKernelWhileItIsCut) {
    mock::Testbed bed;
    const auto device = std::make_shared<MockHub>(std::uint8_t{0x09});
    bed.plug_in(hub(), device);
    auto port = open_actuator("hub:1-3.2");
    ASSERT_TRUE(port) << port.error().message;
    EXPECT_EQ(device->claimed, 0);
    ASSERT_TRUE((*port)->cut());
    EXPECT_EQ(device->claimed_at_cut, 2) << "before what is plugged in goes";
    EXPECT_EQ(device->claimed, 2);
    ASSERT_TRUE((*port)->restore());
    EXPECT_EQ(device->claimed, 0) << "what comes back wants its driver";
    ASSERT_TRUE((*port)->cut());
    const auto begin = std::chrono::steady_clock::now();
    port->reset();
    EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500))
        << "the driver looks within a quarter of a second, and afterwards lets it be";
    EXPECT_EQ(device->claimed, 0);
    EXPECT_EQ(device->powered(), 0x1a) << "it stays cut";
}

TEST(HubPort, IsRefusedWhereAllAreSwitchedTogether) {
    for (const std::uint8_t characteristics : {std::uint8_t{0x00}, std::uint8_t{0x02}}) {
        mock::Testbed bed;
        const auto device = std::make_shared<MockHub>(characteristics);
        bed.plug_in(hub(), device);
        const auto port = open_actuator("hub:1-3.2");
        ASSERT_FALSE(port);
        EXPECT_EQ(
            port.error().message,
            "cannot switch the USB port 1-3.2: the hub 2109:3431 at 1-3 does not switch the power of its ports one "
            "by one");
        EXPECT_EQ(device->powered(), 0x1e);
    }
}

TEST(HubPort, IsRefusedWhereThereIsNone) {
    mock::Testbed bed;
    bed.plug_in(hub(), std::make_shared<MockHub>(std::uint8_t{0x09}));
    EXPECT_THAT(open_actuator("hub:1-3.5").error().message, HasSubstr("the hub at 1-3 has 4 ports"));
    EXPECT_THAT(open_actuator("hub:1-4.1").error().message, HasSubstr("there is no hub at 1-4"));
    EXPECT_THAT(open_actuator("hub:1-3").error().message, HasSubstr("there is no hub at usb1"));
    DeviceSpec other = converter();
    other.port = "2";
    bed.plug_in(other, std::make_shared<MockMcp2221>());
    EXPECT_THAT(open_actuator("hub:1-2.1").error().message, HasSubstr("what is there is no hub"));
}

}  // namespace
}  // namespace skyloop
