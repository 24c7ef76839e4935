// usb: wires to a CDC-ACM device, through the unmodified libusb.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <numeric>

#include "eventually.hpp"
#include "mock_cdc_acm.hpp"
#include "testbed.hpp"
#include "what_is_held.hpp"
#include "wire/transport/open_transport.hpp"
#include "wire/usb/cdc_acm.hpp"

namespace skyloop {
namespace {

using mock::DeviceSpec;
using mock::eventually;
using mock::MockCdcAcm;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint8_t data_out = 0x01, data_in = 0x82;

DeviceSpec board(const std::string& serial = "A1", const std::string& port = "1", std::uint8_t address = 4) {
    return {{0x1546, 0x01a8}, "u-blox AG", "u-blox GNSS receiver", serial, mock::cdc_acm_configuration(), port,
            address};
}

Bytes counting(std::size_t size) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    return bytes;
}

// A device that is plugged in, and a wire to it.
class UsbWire : public testing::Test {
protected:
    void open(const std::string& options = "") {
        bed.plug_in(board(), device);
        auto opened = open_transport("usb:1546:01a8" + options);
        ASSERT_TRUE(opened) << opened.error().message;
        wire = std::move(*opened);
    }
    bool hears(const Bytes& expected) {
        Bytes all;
        const bool done = eventually([&] {
            const Bytes piece = wire->read();
            all.insert(all.end(), piece.begin(), piece.end());
            return all.size() >= expected.size();
        });
        EXPECT_EQ(all, expected);
        return done;
    }
    // Looks at the wire until it says so.
    bool tells(const std::string& sign) {
        return eventually([&] {
            (void)wire->line();
            for (std::string& text : wire->take_news())
                news.push_back(std::move(text));
            return std::any_of(news.begin(), news.end(),
                               [&](const std::string& text) { return text.find(sign) != std::string::npos; });
        });
    }

    mock::Testbed bed;
    std::shared_ptr<MockCdcAcm> device = std::make_shared<MockCdcAcm>();
    std::unique_ptr<Transport> wire;
    std::vector<std::string> news;
};

TEST_F(UsbWire, TakesTheDeviceAndGivesItBack) {
    open();
    EXPECT_EQ(wire->description(), "1546:01a8 (usb)");
    EXPECT_TRUE(wire->line().connected);
    EXPECT_FALSE(wire->line().baud);
    EXPECT_THAT(device->claims(), ElementsAre(0, 1));
    EXPECT_EQ(device->driver(0), "");
    ASSERT_EQ(device->codings().size(), 1U);
    EXPECT_EQ(device->codings().front().coding, (Bytes{0x00, 0xc2, 0x01, 0x00, 0, 0, 8}));  // 115200, 8N1
    EXPECT_EQ(device->lines(), 3U) << "DTR and RTS";
    EXPECT_THAT(wire->take_news(), IsEmpty());
    wire.reset();
    EXPECT_THAT(device->claims(), IsEmpty());
    EXPECT_EQ(device->driver(0), "cdc_acm");
    EXPECT_EQ(device->driver(1), "cdc_acm");
    EXPECT_EQ(device->lines(), 0U);
}

TEST_F(UsbWire, CarriesBytesBothWays) {
    open();
    const Bytes out = counting(10'000), in = counting(20'000);
    device->say(in);
    EXPECT_EQ(wire->write(out), out.size());
    EXPECT_TRUE(hears(in));
    EXPECT_TRUE(eventually([&] { return device->heard().size() >= out.size(); }));
    EXPECT_EQ(device->heard(), out);
    EXPECT_EQ(device->largest_in() % 64, 0U) << "a transfer that ends inside a packet overflows";
}

// A transfer of whole packets looks unfinished to the device.
TEST_F(UsbWire, EndsTransfersOfWholePackets) {
    open();
    wire->write(counting(63));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 63; }));
    EXPECT_EQ(device->zero_packets(), 0);
    wire->write(counting(128));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 63 + 128; }));
    EXPECT_EQ(device->zero_packets(), 1);
}

TEST_F(UsbWire, FormatAndSpeedAsAskedFor) {
    open(",57600,7E2");
    ASSERT_EQ(device->codings().size(), 1U);
    EXPECT_EQ(device->codings().front().coding, (Bytes{0x00, 0xe1, 0x00, 0x00, 2, 2, 7}));
    wire->set_receiver_baud(9600);  // its first word: the line keeps what was asked for
    wire->write(counting(4));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 4; }));
    EXPECT_EQ(device->codings().size(), 1U);
    wire->set_receiver_baud(38400);
    EXPECT_TRUE(eventually([&] { return device->codings().size() == 2; }));
    EXPECT_EQ(device->codings().back().baud(), 38400U);
}

// Bytes that were written before a change of speed leave before it, and those after it behind it.
TEST_F(UsbWire, SpeedChangesInItsPlace) {
    open();
    wire->set_receiver_baud(9600);
    wire->write(counting(100));
    wire->set_receiver_baud(230400);
    wire->write(counting(50));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 150; }));
    const auto codings = device->codings();
    ASSERT_EQ(codings.size(), 3U);
    EXPECT_EQ(codings[1].baud(), 9600U);
    EXPECT_EQ(codings[1].after_bytes, 0U);
    EXPECT_EQ(codings[2].baud(), 230400U);
    EXPECT_EQ(codings[2].after_bytes, 100U);
}

// 100 bytes at 9600 bit/s take 104 ms to leave the device's own UART.
TEST_F(UsbWire, WaitsForTheLineBeforeItsSpeedChanges) {
    open(",9600");
    wire->set_receiver_baud(9600);
    const auto begin = std::chrono::steady_clock::now();
    wire->write(counting(100));
    wire->set_receiver_baud(115200);
    EXPECT_TRUE(eventually([&] { return device->codings().size() == 2; }));
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(104));
}

TEST_F(UsbWire, RecoversFromStalls) {
    open();
    device->stall_endpoint(data_in);
    device->stall_endpoint(data_out);
    const Bytes bytes = counting(300);
    device->say(bytes);
    wire->write(bytes);
    EXPECT_TRUE(hears(bytes));
    EXPECT_TRUE(eventually([&] { return device->heard().size() >= bytes.size(); }));
    EXPECT_EQ(device->heard(), bytes) << "none lost, none twice";
    EXPECT_GE(device->halts_cleared(), 2);
    EXPECT_TRUE(tells("stalled"));
    EXPECT_TRUE(wire->line().connected);
}

TEST_F(UsbWire, TellsWhenNothingIsTakenAndGoesOnAfterwards) {
    open();
    device->take_data(false);
    EXPECT_EQ(wire->write(counting(20'000)), 16384U) << "what the buffer holds";
    EXPECT_TRUE(tells("has taken no data for 1000 ms"));
    EXPECT_TRUE(wire->line().connected);
    device->take_data(true);
    EXPECT_TRUE(eventually([&] { return device->heard().size() >= 16384; }));
    EXPECT_EQ(device->heard(), [] {
        Bytes all = counting(20'000);
        all.resize(16384);
        return all;
    }());
}

// A transfer that gets no answer ends after 1 s; calls that waited for one would not be done within the test's limit.
TEST_F(UsbWire, NeverWaitsForADeviceThatDoesNotAnswer) {
    open();
    device->take_data(false);
    std::size_t taken = 0;
    for (int i = 0; i < 400; ++i) {
        taken += wire->write(counting(100));
        EXPECT_TRUE(wire->read().empty());
        EXPECT_TRUE(wire->line().connected);
    }
    EXPECT_GE(taken, 16384U);
    EXPECT_LE(taken, 16384U + 4096U) << "one transfer and what the buffer holds";
    EXPECT_THAT(device->heard(), IsEmpty());
}

TEST_F(UsbWire, HoldsTheDeviceUpWhileNobodyReads) {
    open();
    const Bytes bytes = counting(200'000);
    device->say(bytes);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_TRUE(hears(bytes)) << "none is dropped";
}

TEST_F(UsbWire, UnpluggedAndBackBySerialNumberElsewhere) {
    open();
    wire->set_receiver_baud(38400);
    wire->write(counting(10));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 10; }));
    bed.unplug(board());
    EXPECT_TRUE(tells("1546:01a8 (usb) is gone"));
    EXPECT_FALSE(wire->line().connected);
    EXPECT_EQ(wire->write(counting(10)), 10U) << "lost, as on a pulled wire";
    wire->set_receiver_baud(57600);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // until what was there beside it has been noted
    auto other = std::make_shared<MockCdcAcm>();
    bed.plug_in(board("B2", "2", 5), other);
    auto back = std::make_shared<MockCdcAcm>();
    bed.plug_in(board("A1", "5", 6), back);
    EXPECT_TRUE(tells("is back, at 1-5"));
    EXPECT_TRUE(wire->line().connected);
    wire->write(counting(7));
    EXPECT_TRUE(eventually([&] { return back->heard().size() == 7; }));
    EXPECT_EQ(back->codings().back().baud(), 57600U);
    EXPECT_THAT(other->codings(), IsEmpty());
    back->say(counting(9));
    EXPECT_TRUE(hears(counting(9)));
}

// Without a serial number the port that it was plugged into tells it from its like.
TEST_F(UsbWire, UnpluggedAndBackByItsPort) {
    bed.plug_in(board("", "3", 4), device);
    auto opened = open_transport("usb:1546:01a8");
    ASSERT_TRUE(opened) << opened.error().message;
    wire = std::move(*opened);
    bed.unplug(board("", "3", 4));
    EXPECT_TRUE(tells("is gone"));
    auto other = std::make_shared<MockCdcAcm>();
    bed.plug_in(board("", "2", 5), other);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    EXPECT_FALSE(wire->line().connected);
    bed.plug_in(board("", "3", 6), std::make_shared<MockCdcAcm>());
    EXPECT_TRUE(tells("is back, at 1-3"));
    EXPECT_THAT(other->codings(), IsEmpty());
}

// SKYLOOP_UNPLUGS says how often; each takes half a second, until the device is looked for.
TEST_F(UsbWire, UnpluggedInTheMiddleOfAStreamManyTimes) {
    constexpr int warm = 5;
    const char* const given = std::getenv("SKYLOOP_UNPLUGS");
    const int rounds = given != nullptr ? std::atoi(given) : 10;
    const auto numbered = [](int round) { return board("A1", "1", static_cast<std::uint8_t>(4 + round % 100)); };
    open();
    std::size_t descriptors = 0, memory = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round == warm) descriptors = mock::open_descriptors(), memory = mock::memory_in_use();
        device->say(counting(5000));
        wire->write(counting(5000));
        (void)wire->read();
        bed.unplug(numbered(round));
        news.clear();
        ASSERT_TRUE(tells("is gone")) << round;
        device = std::make_shared<MockCdcAcm>();
        bed.plug_in(numbered(round + 1), device);
        ASSERT_TRUE(tells("is back")) << round;
    }
    EXPECT_TRUE(mock::comes_down_to(descriptors, mock::open_descriptors))
        << mock::open_descriptors() << " after " << descriptors;
    std::cout << rounds << " times unplugged: " << mock::memory_in_use() << " bytes in use after " << memory << '\n';
}

TEST_F(UsbWire, ToldWhenTheSpeedCannotBeSet) {
    device->refuse_line_coding();
    open();
    EXPECT_TRUE(tells("USB device 1546:01a8 at 1-1 does not take 115200 bit/s: the device refused (stall)"));
    wire->write(counting(5));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 5; }));
}

TEST_F(UsbWire, BulkEndpointsAloneAreUsedAsTheyAre) {
    DeviceSpec plain = board();
    plain.configuration =
        mock::configuration(1, mock::joined({mock::interface(0, 2, {0xff, 0, 0}), mock::endpoint(data_out, 2, 64),
                                             mock::endpoint(data_in, 2, 64)}));
    bed.plug_in(plain, device);
    auto opened = open_transport("usb:1546:01a8");
    ASSERT_TRUE(opened) << opened.error().message;
    wire = std::move(*opened);
    EXPECT_TRUE(tells("has no CDC-ACM control interface"));
    EXPECT_THAT(device->codings(), IsEmpty());
    wire->write(counting(5));
    device->say(counting(6));
    EXPECT_TRUE(hears(counting(6)));
    EXPECT_TRUE(eventually([&] { return device->heard().size() == 5; }));
}

TEST_F(UsbWire, WhatIsNoSerialDeviceIsRefused) {
    DeviceSpec disk = board();
    disk.configuration =
        mock::configuration(1, mock::joined({mock::interface(0, 2, {8, 6, 80}), mock::endpoint(data_out, 2, 64),
                                             mock::endpoint(data_in, 2, 64)}));
    bed.plug_in(disk, device);
    EXPECT_THAT(open_transport("usb:1546:01a8").error().message, HasSubstr("USB device 1546:01a8 is no serial device"));
    EXPECT_EQ(open_transport("usb:1546:01a9").error().message, "no USB device 1546:01a9 is plugged in");
}

}  // namespace
}  // namespace skyloop
