// Epochs larger than the transmit buffer: on a fast line nothing is lost, and a slow one says so (RECEIVER.md 4.7).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/core/receiver.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum Constellation;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A u-blox whose epoch of NMEA, some 900 bytes, is larger than its buffer.
BoardProfile small_buffer(std::uint32_t baud) {
    BoardProfile board = sample_ublox();
    board.transmit_buffer_bytes = 400;
    board.generated_ahead_bytes = 300;
    board.baud = baud;
    board.sentences = sample_board(NmeaVersion::v4_10, {}).sentences;
    board.messages = {{0x01, 0x07}};
    for (const int id : {4, 5, 0, 2, 3, 1, 7, 8})  // RMC VTG GGA GSA GSV GLL GST ZDA
        board.messages.push_back({0xF0, static_cast<std::uint8_t>(id)});
    board.polled = {{0x0A, 0x04}, {0x0A, 0x08}};
    board.quirks.overflow_notice = true;
    return board;
}

// Runs epochs of a second each; what has left by one port, to its end.
class Overflow {
public:
    Overflow(BoardProfile board, PortId port) : receiver_(std::move(board), {1}), port_(port) {
        fix_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix_, gps, 1, 20);
        receiver_.start(fix_.time);
    }
    Overflow& epoch() {
        fix_.time += 1s;
        receiver_.on_epoch({fix_});
        look(fix_.time + 999ms);
        return *this;
    }
    Overflow& write(ByteSpan bytes) {
        receiver_.input(port_, bytes, fix_.time + 999ms);
        return *this;
    }
    // The answer to MON-TXBUF, asked in the middle of an epoch's second.
    MonTxbuf buffers() {
        fix_.time += 1s;
        receiver_.on_epoch({fix_});
        look(fix_.time + 500ms);
        receiver_.input(port_, encode_frame(MonTxbuf::message_id, {}), fix_.time + 500ms);
        look(fix_.time + 999ms);
        look(receiver_.drained_at().value_or(fix_.time + 999ms));
        MonTxbuf answer;
        for (const StreamPiece& piece : splitter_.feed(bytes_))
            if (const auto frame = parse_frame(piece.bytes); frame && frame->id == MonTxbuf::message_id)
                answer = *decode_payload<MonTxbuf>(frame->payload);
        return answer;
    }
    [[nodiscard]] const Receiver& receiver() const { return receiver_; }
    [[nodiscard]] std::string text() const { return to_string(bytes_); }
    [[nodiscard]] std::uint64_t dropped() const { return receiver_.port_totals(port_).messages_dropped; }

private:
    void look(GpsTime now) {
        for (const Receiver::Sent& sent : receiver_.output(now))
            if (sent.port == port_) bytes_.insert(bytes_.end(), sent.bytes.begin(), sent.bytes.end());
    }
    Receiver receiver_;
    PortId port_;
    Fix fix_;
    Bytes bytes_;
    StreamSplitter splitter_;
};

TEST(ReceiverOverflow, LosesNothingOfALargeEpochOnAFastLine) {
    for (const PortId port : {PortId::uart1, PortId::usb, PortId::i2c}) {
        Overflow fast(small_buffer(921600), port);
        for (int i = 0; i < 3; ++i)
            fast.epoch();
        EXPECT_EQ(fast.dropped(), 0U);
        EXPECT_THAT(fast.text(), HasSubstr("$GNZDA,120003.00"));
        EXPECT_THAT(fast.text(), Not(HasSubstr("txbuf alloc")));
        EXPECT_EQ(fast.buffers().errors, 0);
    }
}

// As a ZED-F9P's does, between two GSV of one burst (jclark/satpulse, gps/testdata/packets).
TEST(ReceiverOverflow, AnAnswerStandsBeforeWhatHasNotBeenGenerated) {
    BoardProfile board = small_buffer(9600);
    board.generated_ahead_bytes = 200;
    Overflow slow(board, PortId::uart1);
    slow.buffers();
    const std::string text = slow.text();
    const std::size_t answer = text.find("\xb5\x62\x0a\x08");
    ASSERT_NE(answer, std::string::npos);
    EXPECT_LT(text.find("$GNRMC,"), answer);
    EXPECT_LT(answer, text.find("$GNZDA,"));
    EXPECT_EQ(slow.dropped(), 0U);
}

// Order stays: RMC leads each epoch, and what did not fit is missing at its end.
TEST(ReceiverOverflow, IsToldByMonTxbufAndInATextOncePerEpoch) {
    Overflow slow(small_buffer(4800), PortId::uart1);
    constexpr int epochs = 6;
    int overflows = 0;
    for (int i = 0; i < epochs; ++i) {
        const std::uint64_t before = slow.dropped();
        slow.epoch();
        overflows += slow.dropped() > before ? 1 : 0;
    }
    EXPECT_EQ(overflows, epochs - 1);  // that of the first shows when the second is reported
    EXPECT_EQ(slow.buffers().errors, 0x80 | 1 << 1);
    const std::string text = slow.text();
    const auto count = [&](const std::string& sentence) {
        int found = 0;
        for (auto at = text.find(sentence); at != std::string::npos; at = text.find(sentence, at + 1))
            ++found;
        return found;
    };
    EXPECT_EQ(count("$GNRMC,"), epochs + 1);
    EXPECT_LT(count("$GNZDA,"), epochs);
    EXPECT_EQ(count("$GNTXT,01,01,00,txbuf alloc*61\r\n"), overflows + 1) << "and of the last epoch";
}

TEST(ReceiverOverflow, IsCountedOverRestartsWithTheSpeedThatWasTooSlow) {
    constexpr std::uint32_t uart1_baudrate = 0x40520001;
    Overflow slow(small_buffer(4800), PortId::uart1);
    slow.epoch().epoch().epoch();
    const PortTotals before = slow.receiver().port_totals(PortId::uart1);
    EXPECT_GT(before.messages_dropped, 0U);
    EXPECT_EQ(before.dropped_at_baud, 4800U);
    CfgValset faster;
    faster.layers = 0x06;
    faster.pairs = {{uart1_baudrate, 921600}};
    slow.write(encode_frame(faster)).write(encode_frame(CfgRst{.nav_bbr_mask = 0, .reset_mode = 1, .reserved = 0}));
    slow.epoch().epoch().epoch().epoch();
    const PortTotals after = slow.receiver().port_totals(PortId::uart1);
    EXPECT_EQ(slow.receiver().baud(PortId::uart1), 921600U);
    EXPECT_EQ(after.messages_dropped, before.messages_dropped);
    EXPECT_EQ(after.dropped_at_baud, 4800U);
    EXPECT_GT(after.messages_out, before.messages_out);
}

TEST(ReceiverOverflow, EndsWithItsCause) {
    BoardProfile board = small_buffer(4800);
    board.sentences.resize(2);
    Overflow small(board, PortId::uart1);
    EXPECT_EQ(small.epoch().epoch().buffers().errors, 0);
}

}  // namespace
}  // namespace skyloop::firmware
