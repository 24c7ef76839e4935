// hid: wires to a CP2110, through both unmodified backends of hidapi.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <mutex>

#include "eventually.hpp"
#include "mock_device.hpp"
#include "testbed.hpp"
#include "wire/hid/cp2110.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop {
namespace {

using mock::DeviceSpec;
using mock::eventually;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// AN434, as far as the bridge is asked: reports with numbers, an interrupt endpoint each way.
class MockCp2110 : public mock::MockDevice {
public:
    Answer control(const mock::Setup& setup, ByteSpan data) override {
        const std::lock_guard lock(mutex_);
        const auto id = static_cast<std::uint8_t>(setup.value & 0xff);
        if (setup.type == 0x21 && setup.request == 9 && setup.value >> 8 == 3) {
            features_.emplace_back(data.begin(), data.end());
            after_.push_back(heard_.size());
            if (id == 0x50 || id == 0x41) stored_[id] = Bytes(data.begin(), data.end());
            return {};
        }
        if (setup.type != 0xa1 || setup.request != 1) return stall();
        if (id == 0x42) return {Status::done, {0x42, 0, fifo_ > 0 ? fifo_-- : std::uint8_t{0}, 0, 0, 0, 0}};
        if (stored_.count(id) == 0) return stall();
        return {Status::done, stored_[id]};
    }
    Answer out(std::uint8_t, ByteSpan data) override {
        const std::lock_guard lock(mutex_);
        if (data.empty() || data[0] == 0 || data[0] > 63 || data.size() != 1U + data[0]) return stall();
        heard_.insert(heard_.end(), data.begin() + 1, data.end());
        return {};
    }
    Answer in(std::uint8_t, std::size_t) override {
        const std::lock_guard lock(mutex_);
        if (to_say_.empty()) return busy();
        const auto size = static_cast<std::ptrdiff_t>(std::min<std::size_t>(63, to_say_.size()));
        Bytes report(64);  // the endpoint's whole packet; the number says how many bytes count
        report[0] = static_cast<std::uint8_t>(size);
        std::copy(to_say_.begin(), to_say_.begin() + size, report.begin() + 1);
        to_say_.erase(to_say_.begin(), to_say_.begin() + size);
        return {Status::done, report};
    }
    void say(const Bytes& bytes) {
        const std::lock_guard lock(mutex_);
        to_say_.insert(to_say_.end(), bytes.begin(), bytes.end());
    }
    Bytes heard() {
        const std::lock_guard lock(mutex_);
        return heard_;
    }
    // Each feature report that it was sent, and how many bytes it had heard by then.
    std::vector<Bytes> features() {
        const std::lock_guard lock(mutex_);
        return features_;
    }
    std::vector<std::size_t> bytes_before_features() {
        const std::lock_guard lock(mutex_);
        return after_;
    }
    // Its FIFO tells that it holds bytes for the next so many questions.
    void hold(std::uint8_t questions) {
        const std::lock_guard lock(mutex_);
        fifo_ = questions;
    }

private:
    std::mutex mutex_;
    std::map<std::uint8_t, Bytes> stored_{{0x41, {0x41, 0}}, {0x50, {0x50, 0, 0, 0x25, 0x80, 0, 0, 3, 0}}};
    std::vector<Bytes> features_;
    std::vector<std::size_t> after_;
    std::deque<std::uint8_t> to_say_;
    Bytes heard_;
    std::uint8_t fifo_ = 0;
};

// Vendor page; the feature and data reports that the bridge is sent, each with its number.
const Bytes report_descriptor{0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x85, 0x41, 0x15, 0x00, 0x26,
                              0xff, 0x00, 0x75, 0x08, 0x95, 0x01, 0x09, 0x01, 0xb1, 0x02, 0x85, 0x3f,
                              0x95, 0x3f, 0x09, 0x02, 0x81, 0x02, 0x09, 0x03, 0x91, 0x02, 0xc0};

DeviceSpec bridge(std::uint8_t address = 7, const std::string& port = "4") {
    const mock::HidShape shape{static_cast<std::uint16_t>(report_descriptor.size()), 64, true};
    return {{0x10c4, 0xea80}, "Silicon Laboratories",         "CP2110 HID USB-to-UART Bridge",
            "0001A2B3",       mock::hid_configuration(shape), port,
            address};
}

Bytes letters(std::size_t size) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>('a' + i % 26);
    return bytes;
}

class HidWire : public testing::TestWithParam<HidBackend> {
protected:
    void plug_in(const DeviceSpec& spec) {
        bed.plug_in(spec, device);
        if (GetParam() == HidBackend::hidraw) bed.add_hidraw(spec, hidraw_nodes++, device, report_descriptor);
    }
    // Without a /dev/hidrawN the wire finds the device through libusb.
    void open(const std::string& options = "") {
        plug_in(bridge());
        auto opened = open_transport("hid:10c4:ea80" + options);
        ASSERT_TRUE(opened) << opened.error().message;
        wire = std::move(*opened);
    }
    bool tells(const std::string& sign) {
        return eventually([&] {
            (void)wire->line();
            for (const std::string& text : wire->take_news())
                if (text.find(sign) != std::string::npos) return true;
            return false;
        });
    }

    mock::Testbed bed;
    std::shared_ptr<MockCp2110> device = std::make_shared<MockCp2110>();
    std::unique_ptr<Transport> wire;
    int hidraw_nodes = 0;
};

TEST_P(HidWire, SetsTheUartAndPutsItBack) {
    open(",9600,8O1,rtscts");
    EXPECT_EQ(wire->description(), "10c4:ea80 (hid)");
    EXPECT_THAT(device->features(),
                ElementsAre(Bytes{0x50, 0, 0, 0x25, 0x80, 1, 1, 3, 0}, Bytes{0x41, 1}, Bytes{0x43, 3}));
    EXPECT_THAT(wire->take_news(), IsEmpty());
    wire.reset();
    const auto features = device->features();
    ASSERT_EQ(features.size(), 5U);
    EXPECT_EQ(features[3], (Bytes{0x50, 0, 0, 0x25, 0x80, 0, 0, 3, 0})) << "as it was";
    EXPECT_EQ(features[4], (Bytes{0x41, 0}));
}

TEST_P(HidWire, CarriesBytesBothWays) {
    open();
    const Bytes out = letters(1000), in = letters(700);
    device->say(in);
    EXPECT_EQ(wire->write(out), out.size());
    Bytes all;
    EXPECT_TRUE(eventually([&] {
        const Bytes piece = wire->read();
        all.insert(all.end(), piece.begin(), piece.end());
        return all.size() >= in.size();
    }));
    EXPECT_EQ(all, in);
    EXPECT_TRUE(eventually([&] { return device->heard().size() >= out.size(); }));
    EXPECT_EQ(device->heard(), out);
}

TEST_P(HidWire, SpeedChangesInItsPlaceOnceTheFifoIsEmpty) {
    open();
    wire->set_receiver_baud(38400);
    wire->write(letters(100));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 100; }));
    device->hold(5);
    wire->set_receiver_baud(921600);
    wire->write(letters(50));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 150; }));
    const auto features = device->features();
    ASSERT_EQ(features.size(), 5U);
    EXPECT_EQ(features[3], (Bytes{0x50, 0x00, 0x00, 0x96, 0x00, 0, 0, 3, 0}));  // the most significant byte first
    EXPECT_EQ(features[4], (Bytes{0x50, 0x00, 0x0e, 0x10, 0x00, 0, 0, 3, 0}));
    EXPECT_THAT(device->bytes_before_features(), ElementsAre(0, 0, 0, 0, 100));
}

TEST_P(HidWire, TellsOfSpeedsThatTheBridgeDoesNotHave) {
    open();
    wire->set_receiver_baud(2'000'000);
    EXPECT_TRUE(tells("does not do 2000000 bit/s; expected 300 to 1000000"));
}

TEST_P(HidWire, UnpluggedAndBackBySerialNumberElsewhere) {
    open();
    wire->set_receiver_baud(38400);
    wire->write(letters(100));
    bed.unplug(bridge());
    EXPECT_TRUE(tells("10c4:ea80 (hid) is gone"));
    EXPECT_FALSE(wire->line().connected);
    EXPECT_EQ(wire->write(letters(10)), 10U);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // until what was there beside it has been noted
    device = std::make_shared<MockCp2110>();
    plug_in(bridge(8, "6"));
    EXPECT_TRUE(tells("is back, at 1-6"));
    wire->write(letters(20));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 20; }));
    EXPECT_EQ(device->features().front(), (Bytes{0x50, 0x00, 0x00, 0x96, 0x00, 0, 0, 3, 0}));
}

TEST_P(HidWire, AnAbsentBridgeIsOneSentence) {
    EXPECT_EQ(open_transport("hid:10c4:ea80").error().message, "no HID device 10c4:ea80 is plugged in");
}

INSTANTIATE_TEST_SUITE_P(Backend, HidWire, testing::Values(HidBackend::hidraw, HidBackend::libusb),
                         [](const auto& backend) {
                             return backend.param == HidBackend::hidraw ? std::string("hidraw") : std::string("libusb");
                         });

}  // namespace
}  // namespace skyloop
