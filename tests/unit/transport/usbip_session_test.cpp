#include "wire/transport/usbip_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "usbip_host.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

constexpr std::int64_t frame_ms = 1'000'000;

// A session whose host hears what is answered, at once.
class HostedSession {
public:
    HostedSession() : session_({}, UsbipDevice{}) {}
    // One look later.
    void run(std::int64_t later_ns = frame_ms) { session_.run(now_ += later_ns); }
    void send(const Bytes& command) {
        session_.hear(command);
        run();
    }
    void configure() {
        send(test::set_configuration(1));
        forget();
    }
    struct Reply {
        std::uint32_t command = 0, sequence = 0;
        std::int32_t status = 0;
        std::string data;
    };
    // All answers since the last call. Data are told by the length where they came from the device.
    std::vector<Reply> replies() {
        const Bytes bytes(session_.output().begin(), session_.output().end());
        session_.sent(bytes.size());
        std::vector<Reply> all;
        for (std::size_t at = 0; at + usbip_header_bytes <= bytes.size();) {
            const auto word = [&](std::size_t i) {
                std::uint32_t value = 0;
                for (std::size_t k = 0; k < 4; ++k)
                    value = value << 8U | bytes[at + 4 * i + k];
                return value;
            };
            Reply reply{word(0), word(1), static_cast<std::int32_t>(word(5)), {}};
            const std::size_t size = in_.contains(reply.sequence) && reply.command == 3 ? word(6) : 0;
            reply.data = to_string(ByteSpan(bytes).subspan(at + usbip_header_bytes, size));
            at += usbip_header_bytes + size;
            all.push_back(std::move(reply));
        }
        return all;
    }
    void poll(std::uint32_t sequence, std::uint32_t endpoint = CdcAcmDevice::data_in, std::uint32_t length = 128) {
        in_.insert(sequence);
        send(test::submit_in(sequence, endpoint, length));
    }
    void forget() { session_.sent(session_.output().size()); }
    UsbipSession& operator*() { return session_; }
    UsbipSession* operator->() { return &session_; }

private:
    UsbipSession session_;
    std::int64_t now_ = 0;
    std::set<std::uint32_t> in_;
};

TEST(UsbipSession, ListensOnceDataArePolled) {
    HostedSession host;
    host.poll(1);
    EXPECT_EQ(host.replies().at(0).status, -32) << "not configured: no such endpoint";
    host.configure();
    EXPECT_FALSE(host->listening());
    EXPECT_EQ(host->put(to_bytes("lost")), 4U);
    host.poll(2);
    EXPECT_TRUE(host->listening());
    EXPECT_TRUE(host.replies().empty()) << "nothing to tell yet";
    EXPECT_EQ(host->put(to_bytes("$GPGGA")), 6U);
    host.run();
    const auto replies = host.replies();
    ASSERT_EQ(replies.size(), 1U);
    EXPECT_EQ(replies[0].sequence, 2U);
    EXPECT_EQ(replies[0].data, "$GPGGA");
    host.run(10'000 * frame_ms);
    EXPECT_TRUE(host->listening()) << "a slow reader is one all the same";
}

TEST(UsbipSession, ALongMessageTakesSeveralTransfers) {
    HostedSession host;
    host.configure();
    for (std::uint32_t i = 10; i < 13; ++i)
        host.poll(i, CdcAcmDevice::data_in, 64);
    std::string sent;
    for (int i = 0; i < 150; ++i)
        sent += static_cast<char>('0' + i % 10);
    host->put(to_bytes(sent));
    host.run();
    const auto replies = host.replies();
    ASSERT_EQ(replies.size(), 3U);
    EXPECT_EQ(replies[0].data.size(), 64U);
    EXPECT_EQ(replies[0].data + replies[1].data + replies[2].data, sent);
}

TEST(UsbipSession, StopsListeningWithTheLastPoll) {
    HostedSession host;
    host.configure();
    host.poll(2);
    host.send(test::unlink(3, 2));
    EXPECT_EQ(host.replies().back().status, -104);
    EXPECT_TRUE(host->listening()) << "a program that polls with a timeout does so again soon";
    host->put(to_bytes("stale"));
    host.run(4'990 * frame_ms);
    EXPECT_TRUE(host->listening());
    host.run(10 * frame_ms);
    EXPECT_FALSE(host->listening());
    host.poll(4);
    EXPECT_TRUE(host.replies().empty()) << "nothing stale";
}

TEST(UsbipSession, AReaderNowAndThenHearsWhatCameMeanwhile) {
    HostedSession host;
    host.configure();
    host.send(test::set_lines(2, 1));
    std::uint32_t sequence = 10;
    for (int i = 0; i < 3; ++i) {
        host.poll(sequence);
        host.send(test::unlink(sequence + 1, sequence));  // nothing has come within its patience
        host.forget();
        host->put(to_bytes("$GPGGA"));
        host.run(20'000 * frame_ms);
        host.poll(sequence + 2);
        ASSERT_EQ(host.replies().at(0).data, "$GPGGA");
        sequence += 10;
    }
    host.poll(sequence);
    host.send(test::unlink(sequence + 1, sequence));
    host.run(30'000 * frame_ms);
    EXPECT_FALSE(host->listening()) << "as long as DTR is set by a program that has gone";
}

TEST(UsbipSession, AReaderNowAndThenHearsTheNewest) {
    HostedSession host;
    host.configure();
    host.poll(2);
    host.send(test::unlink(3, 2));
    host.forget();
    EXPECT_EQ(host->put(Bytes(100, 'o')), 100U);
    EXPECT_EQ(host->put(Bytes(UsbipSession::most_backlog - 1, 'n')), UsbipSession::most_backlog - 1);
    host.run(20 * frame_ms);
    host.poll(4, CdcAcmDevice::data_in, 65536);
    EXPECT_EQ(host.replies().at(0).data.substr(0, 3), "onn") << "and one that still fits";
}

TEST(UsbipSession, DtrThatFallsEndsListeningAtOnce) {
    HostedSession host;
    host.configure();
    host.send(test::set_lines(2, 3));
    host.poll(3);
    host.send(test::set_lines(4, 0));
    EXPECT_TRUE(host->listening()) << "it polls still";
    host.send(test::unlink(5, 3));
    EXPECT_FALSE(host->listening());
}

TEST(UsbipSession, HearsTheHost) {
    HostedSession host;
    host.configure();
    host.send(test::submit_out(2, to_bytes("$PUBX,00*33\r\n")));
    EXPECT_EQ(host.replies().at(0).status, 0);
    EXPECT_EQ(to_string(host->take_received()), "$PUBX,00*33\r\n");
    host.send(test::submit_out(3, Bytes(5000, 'x')));
    host.send(test::submit_out(4, Bytes(10, 'y')));
    EXPECT_EQ(host.replies().size(), 1U) << "the second waits until the first has been read";
    EXPECT_EQ(host->take_received().size(), 5000U);
    host.run(20 * frame_ms);
    EXPECT_EQ(host.replies().size(), 1U);
    EXPECT_EQ(to_string(host->take_received()), "yyyyyyyyyy");
}

TEST(UsbipSession, KeepsThePaceOfAFullSpeedBus) {
    HostedSession host;
    host.configure();
    host.run(1000 * frame_ms);
    std::size_t moved = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        host.poll(100 + i, CdcAcmDevice::data_in, 65536);
        host->put(Bytes(UsbipSession::most_backlog, 'x'));
        host.run(0);
        for (const auto& reply : host.replies())
            moved += reply.data.size();
    }
    EXPECT_NEAR(static_cast<double>(moved), 1000 * 1216.0, 21 * 1216.0) << "19 packets of 64 bytes each ms";
}

TEST(UsbipSession, WhatDoesNotFitIsRefusedAndTold) {
    HostedSession host;
    host.configure();
    host.poll(2, CdcAcmDevice::notify_in, 64);
    EXPECT_EQ(host.replies().at(0).data.size(), 10U);
    host.poll(3, CdcAcmDevice::data_in, 1);
    host.poll(4, CdcAcmDevice::notify_in, 64);
    EXPECT_EQ(host->put(Bytes(20000, 'x')), UsbipSession::most_backlog);
    host.run();
    const auto replies = host.replies();
    ASSERT_EQ(replies.size(), 2U);
    EXPECT_EQ(replies[1].data[8], 0x43) << "overrun";
}

TEST(UsbipSession, StalledEndpointsStallTheirTransfers) {
    HostedSession host;
    host.configure();
    host.poll(2);
    Bytes halt = test::control_out(3, 0x02, 3, 0);
    halt[44] = 0x82;
    host.send(halt);
    auto replies = host.replies();
    ASSERT_EQ(replies.size(), 2U);
    EXPECT_EQ(replies[1].sequence, 2U);
    EXPECT_EQ(replies[1].status, -32);
    halt[41] = 1;
    host.send(halt);
    host.forget();
    host.poll(4);
    EXPECT_TRUE(host.replies().empty()) << "cleared: it waits";
}

TEST(UsbipSession, CancelsEachKindOfTransfer) {
    HostedSession host;
    host.configure();
    host.poll(2, CdcAcmDevice::notify_in);
    host.forget();
    host.poll(3, CdcAcmDevice::notify_in);
    host.poll(4);
    host.send(test::submit_out(5, Bytes(4096, 'x')));
    host.send(test::submit_out(6, Bytes(1, 'y')));
    host.forget();
    EXPECT_EQ(host->pending(), 3U);
    for (const std::uint32_t target : {3U, 4U, 6U}) {
        host.send(test::unlink(100 + target, target));
        EXPECT_EQ(host.replies().at(0).status, -104);
        host.send(test::unlink(200 + target, target));
        EXPECT_EQ(host.replies().at(0).status, 0) << "there is none any more";
    }
    EXPECT_EQ(host->pending(), 0U);
    host->take_received();
    host.run(20 * frame_ms);
    EXPECT_TRUE(host->take_received().empty()) << "what was cancelled does not arrive";
}

// However the bytes are cut into pieces.
TEST(UsbipSession, CommandsMayComeInPieces) {
    HostedSession host;
    Bytes all = test::set_configuration(1);
    const Bytes out = test::submit_out(2, to_bytes("hello"));
    all.insert(all.end(), out.begin(), out.end());
    for (const std::uint8_t byte : all)
        host.send({byte});
    EXPECT_EQ(host.replies().size(), 2U);
    EXPECT_EQ(to_string(host->take_received()), "hello");
    EXPECT_FALSE(host->inside_message());
    host.send({0});
    EXPECT_TRUE(host->inside_message());
    EXPECT_EQ(host->mistake(), "");
}

TEST(UsbipSession, MemoryIsBoundedByTheHostsPatience) {
    HostedSession host;
    host.configure();
    for (std::uint32_t i = 0; i < 1000; ++i)
        host->hear(test::submit_in(1000 + i, CdcAcmDevice::data_in, 64));
    for (int i = 0; i < 5; ++i)
        host.run();
    EXPECT_EQ(host->pending(), 256U);
    EXPECT_EQ(host->output().size(), (1000 - 256) * usbip_header_bytes) << "the others are refused";
    for (int i = 0; i < 100'000 && host->wants_bytes(); ++i) {
        host->hear(test::set_configuration(5));
        host.run();
    }
    EXPECT_FALSE(host->wants_bytes()) << "a host that floods waits";
    EXPECT_LT(host->output().size(), 600'000U);
}

TEST(UsbipSession, TooManyTransfersDoNotKeepTheRestFromBeingHeard) {
    HostedSession host;
    host.configure();
    for (std::uint32_t i = 0; i < 256; ++i)
        host.poll(1000 + i);
    EXPECT_TRUE(host.replies().empty());
    host.poll(2000);
    EXPECT_EQ(host.replies().at(0).status, -12);
    host.send(test::set_lines(3000, 3));
    EXPECT_EQ(host.replies().at(0).status, 0);
    host.send(test::unlink(3001, 1000));
    EXPECT_EQ(host.replies().at(0).status, -104);
    host.poll(2001);
    EXPECT_EQ(host->pending(), 256U);
}

TEST(UsbipSession, AForeignDeviceIsAMistake) {
    HostedSession host;
    host.send(test::words({1, 1, 0x20002, 1, 2, 0, 64, 0, 0, 0, 0, 0}));
    EXPECT_THAT(host->mistake(), HasSubstr("a command for device 0x20002; expected 0x10002"));
    EXPECT_TRUE(host.replies().empty());
}

}  // namespace
}  // namespace skyloop
