#include "wire/transport/usb_bridge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace skyloop {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

TEST(UsbBridgeAddress, TakesDeviceSpeedAndFormat) {
    const auto plain = parse_usb_bridge_address("1546:01a8");
    ASSERT_TRUE(plain);
    EXPECT_EQ(to_string(plain->device), "1546:01a8");
    EXPECT_FALSE(plain->baud);
    EXPECT_EQ(plain->format.data_bits, 8);
    const auto full = parse_usb_bridge_address("10c4:ea80:0001A2B3,57600,7e2,rtscts");
    ASSERT_TRUE(full);
    EXPECT_EQ(full->device.serial, "0001A2B3");
    EXPECT_EQ(full->baud, 57600U);
    EXPECT_EQ(full->format.data_bits, 7);
    EXPECT_EQ(full->format.parity, Parity::even);
    EXPECT_EQ(full->format.stop_bits, 2);
    EXPECT_TRUE(full->format.rtscts);
    const auto port = parse_usb_bridge_address("1546:01a8@1-1.2,8O1");
    ASSERT_TRUE(port);
    EXPECT_EQ(port->device.port_path, "1-1.2");
    EXPECT_FALSE(port->baud);
    EXPECT_EQ(port->format.parity, Parity::odd);
}

TEST(UsbBridgeAddress, RefusesClearly) {
    const auto refusal = [](const char* text) {
        const auto address = parse_usb_bridge_address(text);
        EXPECT_FALSE(address) << text;
        return address ? std::string() : address.error().message;
    };
    EXPECT_THAT(refusal("1546"), StartsWith("'1546' names no USB device"));
    EXPECT_THAT(refusal("1546:01a8,"), HasSubstr("option '' is not understood"));
    EXPECT_THAT(refusal("1546:01a8,49"), HasSubstr("the speed '49' is not understood"));
    EXPECT_THAT(refusal("1546:01a8,12000001"), HasSubstr("the speed '12000001' is not understood"));
    EXPECT_THAT(refusal("1546:01a8,99999999999999999999"), HasSubstr("is not understood"));
    EXPECT_THAT(refusal("1546:01a8,8N1,9600"), HasSubstr("option '9600' is not understood"));
    EXPECT_THAT(refusal("1546:01a8,9600,"), HasSubstr("option '' is not understood"));
    EXPECT_THAT(refusal("1546:01a8,fast"),
                StartsWith("device '1546:01a8,fast': option 'fast' is not understood; expected"));
}

// What the wire does with its bridge, seen from the bridge.
struct BridgeLog {
    std::atomic<bool> gone{false};
    std::vector<std::uint32_t> bauds{};
    Bytes written{};
};

class FakeBridge : public SerialBridge {
public:
    FakeBridge(std::shared_ptr<BridgeLog> log, UsbDeviceInfo info) : log_(std::move(log)), info_(std::move(info)) {}
    std::size_t write(ByteSpan bytes) override {
        log_->written.insert(log_->written.end(), bytes.begin(), bytes.end());
        return bytes.size();
    }
    Bytes read() override { return {}; }
    void set_baud(std::uint32_t baud) override { log_->bauds.push_back(baud); }
    bool gone() const override { return log_->gone; }
    std::vector<std::string> take_news() override { return {}; }
    const UsbDeviceInfo& info() const override { return info_; }

private:
    std::shared_ptr<BridgeLog> log_;
    UsbDeviceInfo info_;
};

// The devices that are plugged in, and what a wire asks of them.
class Bus {
public:
    void plug_in(std::vector<std::string> ports) {
        const std::lock_guard lock(mutex_);
        ports_ = std::move(ports);
    }
    Result<std::unique_ptr<SerialBridge>> open(const UsbAddress& address, const BridgeLine& line) {
        const std::lock_guard lock(mutex_);
        asked_.emplace_back(address.serial, address.port_path);
        baud_ = line.baud;
        for (const std::string& port : ports_)
            if (address.matches(at(port))) return std::make_unique<FakeBridge>(log, at(port));
        return fail(ErrorCode::outside, "not there");
    }
    std::vector<UsbDeviceInfo> list() {
        const std::lock_guard lock(mutex_);
        std::vector<UsbDeviceInfo> devices;
        for (const std::string& port : ports_)
            devices.push_back(at(port));
        return devices;
    }
    std::vector<std::pair<std::string, std::string>> asked() {
        const std::lock_guard lock(mutex_);
        return asked_;
    }
    std::uint32_t baud() {
        const std::lock_guard lock(mutex_);
        return baud_;
    }

    std::shared_ptr<BridgeLog> log = std::make_shared<BridgeLog>();

private:
    static UsbDeviceInfo at(const std::string& port) { return {{0xffff, 0xfffe}, "", "", "A1", port}; }

    std::mutex mutex_;
    std::vector<std::string> ports_{"1-1"};
    std::vector<std::pair<std::string, std::string>> asked_;  // serial numbers and ports
    std::uint32_t baud_ = 0;                                  // of the last opening
};

std::unique_ptr<UsbBridgeTransport> wire_on(const std::shared_ptr<Bus>& bus, std::string_view address) {
    auto wire = UsbBridgeTransport::open(
        *parse_usb_bridge_address(address),
        [bus](const UsbAddress& device, const BridgeLine& line) { return bus->open(device, line); }, "usb",
        [bus] { return bus->list(); });
    EXPECT_TRUE(wire);
    return wire ? std::move(*wire) : nullptr;
}

bool soon(const std::function<bool()>& question) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (!question() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return question();
}

// Until a lost device has been looked for so often.
bool looked_for(UsbBridgeTransport& wire, Bus& bus, std::size_t times) {
    const std::size_t before = bus.asked().size();
    return soon([&] { return !wire.line().connected && bus.asked().size() >= before + times; });
}

TEST(UsbBridgeTransport, LooksForALostDeviceAtItsOldPortAndThenByItsSerialNumber) {
    const auto bus = std::make_shared<Bus>();
    const auto wire = wire_on(bus, "ffff:fffe,4800");
    ASSERT_TRUE(wire);
    EXPECT_TRUE(wire->line().connected);
    wire->set_receiver_baud(9600);
    EXPECT_TRUE(bus->log->bauds.empty()) << "the speed that was asked for stands until the receiver's changes";
    wire->set_receiver_baud(38400);
    EXPECT_THAT(bus->log->bauds, ElementsAre(38400));
    bus->plug_in({});
    bus->log->gone = true;
    EXPECT_FALSE(wire->line().connected);
    EXPECT_EQ(wire->write(to_bytes("lost")), 4U);
    EXPECT_TRUE(bus->log->written.empty());
    EXPECT_THAT(wire->take_news(), ElementsAre("ffff:fffe (usb) is gone; it is looked for every 0.5 s"));
    ASSERT_TRUE(looked_for(*wire, *bus, 2));
    bus->log->gone = false;
    bus->plug_in({"1-2"});
    ASSERT_TRUE(soon([&] { return wire->line().connected; }));
    EXPECT_THAT(wire->take_news(), ElementsAre("ffff:fffe (usb) is back, at 1-2"));
    EXPECT_THAT(bus->asked().front(), Pair("", ""));
    EXPECT_THAT(bus->asked()[1], Pair("A1", "1-1"));
    EXPECT_THAT(bus->asked().back(), Pair("A1", "1-2"));
    EXPECT_EQ(bus->baud(), 38400U);
}

TEST(UsbBridgeTransport, LeavesADeviceAloneThatSharesItsSerialNumber) {
    const auto bus = std::make_shared<Bus>();
    bus->plug_in({"1-1", "1-2"});
    const auto wire = wire_on(bus, "ffff:fffe");
    ASSERT_TRUE(wire);
    bus->plug_in({"1-2"});
    bus->log->gone = true;
    EXPECT_FALSE(wire->line().connected);
    EXPECT_TRUE(looked_for(*wire, *bus, 2)) << "the one at 1-2 was there beside it";
    bus->log->gone = false;
    bus->plug_in({"1-2", "1-3", "1-4"});
    EXPECT_TRUE(looked_for(*wire, *bus, 2)) << "either of the two could be it";
    bus->plug_in({"1-2", "1-3"});
    ASSERT_TRUE(soon([&] { return wire->line().connected; }));
    EXPECT_THAT(wire->take_news(), Contains("ffff:fffe (usb) is back, at 1-3"));
}

TEST(UsbBridgeTransport, FailsAsItsOpenerDoes) {
    const auto wire = UsbBridgeTransport::open(
        *parse_usb_bridge_address("ffff:fffe"),
        [](const UsbAddress&, const BridgeLine&) -> Result<std::unique_ptr<SerialBridge>> {
            return fail(ErrorCode::outside, "no such thing");
        },
        "hid");
    ASSERT_FALSE(wire);
    EXPECT_EQ(wire.error().message, "no such thing");
}

}  // namespace
}  // namespace skyloop
