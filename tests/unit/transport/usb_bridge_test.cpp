#include "skyloop/transport/usb_bridge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
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

struct Asked {
    std::mutex mutex{};
    std::vector<std::pair<std::string, std::string>> serial_and_port{};
    std::vector<std::uint32_t> bauds{};
    std::atomic<bool> there{true};
};

bool soon(const std::function<bool()>& question) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (!question() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return question();
}

TEST(UsbBridgeTransport, LooksForALostDeviceByItsSerialNumberAndOldPortFirst) {
    auto log = std::make_shared<BridgeLog>();
    auto asked = std::make_shared<Asked>();
    const auto opener = [=](const UsbAddress& address,
                            const BridgeLine& line) -> Result<std::unique_ptr<SerialBridge>> {
        const std::lock_guard lock(asked->mutex);
        asked->serial_and_port.emplace_back(address.serial, address.port_path);
        asked->bauds.push_back(line.baud);
        if (!asked->there) return fail(ErrorCode::outside, "not there");
        return std::make_unique<FakeBridge>(log, UsbDeviceInfo{{0xffff, 0xfffe}, "", "", "A1", "1-1"});
    };
    auto wire = UsbBridgeTransport::open(*parse_usb_bridge_address("ffff:fffe,4800"), opener, "usb");
    ASSERT_TRUE(wire);
    EXPECT_TRUE((*wire)->line().connected);
    (*wire)->set_receiver_baud(9600);
    EXPECT_TRUE(log->bauds.empty()) << "the speed that was asked for stands until the receiver's changes";
    (*wire)->set_receiver_baud(38400);
    EXPECT_THAT(log->bauds, ElementsAre(38400));
    asked->there = false;
    log->gone = true;
    EXPECT_FALSE((*wire)->line().connected);
    EXPECT_EQ((*wire)->write(to_bytes("lost")), 4U);
    EXPECT_TRUE(log->written.empty());
    EXPECT_THAT((*wire)->take_news(), ElementsAre("ffff:fffe (usb) is gone; it is looked for every 0.5 s"));
    ASSERT_TRUE(soon([&] {
        (void)(*wire)->line();
        const std::lock_guard lock(asked->mutex);
        return asked->serial_and_port.size() >= 3;
    }));
    log->gone = false;
    asked->there = true;
    ASSERT_TRUE(soon([&] { return (*wire)->line().connected; }));
    EXPECT_THAT((*wire)->take_news(), ElementsAre("ffff:fffe (usb) is back, at 1-1"));
    const std::lock_guard lock(asked->mutex);
    EXPECT_EQ(asked->serial_and_port[0], (std::pair<std::string, std::string>("", "")));
    EXPECT_EQ(asked->serial_and_port[1], (std::pair<std::string, std::string>("A1", "1-1")));
    EXPECT_EQ(asked->serial_and_port[2], (std::pair<std::string, std::string>("A1", "")));
    EXPECT_EQ(asked->bauds.back(), 38400U);
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
