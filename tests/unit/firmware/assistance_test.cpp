// What a receiver says to assistance.
#include "firmware/ublox/assistance.hpp"

#include <gtest/gtest.h>

#include "firmware/core/receiver.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A payload of a type, as long as asked.
Bytes assistance(std::uint8_t type, std::size_t bytes, std::uint8_t version = 0) {
    Bytes payload(bytes);
    if (bytes > 0) payload[0] = type;
    if (bytes > 1) payload[1] = version;
    return payload;
}

AssistanceInfo judged(std::uint8_t id, const Bytes& payload, bool time_known = true) {
    return judge_assistance({{0x13, id}, payload}, time_known);
}

TEST(Assistance, IsUsedInTheSizeOfItsTypeAlone) {
    using enum AssistanceInfo;
    EXPECT_EQ(judged(0x00, assistance(1, 68)), accepted);
    EXPECT_EQ(judged(0x00, assistance(1, 67)), wrong_size);
    EXPECT_EQ(judged(0x02, assistance(1, 76)), accepted);
    EXPECT_EQ(judged(0x03, assistance(1, 88)), accepted);
    EXPECT_EQ(judged(0x06, assistance(3, 20)), accepted);
    EXPECT_EQ(judged(0x20, assistance(0, 76)), accepted);
    EXPECT_EQ(judged(0x40, assistance(0x10, 24)), accepted);
    EXPECT_EQ(judged(0x40, assistance(0x10, 2)), wrong_size);
    EXPECT_EQ(judged(0x40, assistance(0x10, 24, 9)), other_version);
    EXPECT_EQ(judged(0x40, {}), wrong_size);
    EXPECT_EQ(judged(0x40, assistance(0x7F, 24)), unknown_type);
    EXPECT_EQ(judged(0x7F, assistance(1, 68)), unknown_type);
    EXPECT_EQ(judged(0x80, Bytes(12)), accepted);
    EXPECT_EQ(judged(0x80, Bytes(100)), accepted);
    EXPECT_EQ(judged(0x80, {}), accepted) << "a poll";
    EXPECT_EQ(judged(0x80, Bytes(11)), wrong_size);
}

TEST(Assistance, OfOrbitsNeedsTheTime) {
    using enum AssistanceInfo;
    EXPECT_EQ(judged(0x00, assistance(1, 68), false), time_unknown);
    EXPECT_EQ(judged(0x06, assistance(2, 36), false), time_unknown);
    EXPECT_EQ(judged(0x20, assistance(0, 76), false), time_unknown);
    EXPECT_EQ(judged(0x00, assistance(5, 20), false), accepted);
    EXPECT_EQ(judged(0x40, assistance(0x01, 20), false), accepted);
    EXPECT_EQ(judged(0x00, assistance(1, 20), false), wrong_size);
}

// A receiver that has begun cold and acknowledges assistance.
class Assisted : public testing::Test {
protected:
    Assisted() : receiver_(board(), options()) {
        now_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500).time;
        receiver_.start(now_);
    }
    static BoardProfile board() {
        BoardProfile board = sample_ublox();
        board.config[key::navspg_ackaiding] = 1;
        return board;
    }
    static ReceiverOptions options() {
        ReceiverOptions options;
        options.settings.start = StartKind::cold;
        return options;
    }
    MgaAck answer(std::uint8_t id, const Bytes& payload) {
        receiver_.input(PortId::uart1, encode_frame({0x13, id}, payload), now_);
        now_ += 500ms;
        Bytes bytes;
        for (const Receiver::Sent& sent : receiver_.output(now_))
            bytes.insert(bytes.end(), sent.bytes.begin(), sent.bytes.end());
        StreamSplitter splitter;
        for (const StreamPiece& piece : splitter.feed(bytes)) {
            const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
            if (frame && frame->id == MgaAck::message_id) return *decode_payload<MgaAck>(frame->payload);
        }
        ADD_FAILURE() << "no answer";
        return {};
    }
    Receiver receiver_;
    GpsTime now_;
};

TEST_F(Assisted, RefusesOrbitsUntilItIsToldTheTime) {
    const MgaAck refused = answer(0x00, assistance(1, 68));
    EXPECT_EQ(refused.type, 0);
    EXPECT_EQ(refused.info_code, 1);
    EXPECT_EQ(refused.msg_id, 0);
    EXPECT_EQ(refused.payload_start, (std::array<std::uint8_t, 4>{1, 0, 0, 0}));
    EXPECT_EQ(answer(0x40, assistance(0x10, 2)).info_code, 3);
    EXPECT_EQ(answer(0x00, assistance(1, 68)).info_code, 1) << "a time that is not taken tells none";
    EXPECT_EQ(answer(0x40, assistance(0x10, 24)).type, 1);
    const MgaAck taken = answer(0x00, assistance(1, 68));
    EXPECT_EQ(taken.type, 1);
    EXPECT_EQ(taken.info_code, 0);
    receiver_.happen(RestartNavigation{StartKind::warm}, now_);
    EXPECT_EQ(answer(0x00, assistance(1, 68)).info_code, 0);
    receiver_.happen(RestartNavigation{StartKind::cold}, now_);
    EXPECT_EQ(answer(0x00, assistance(1, 68)).info_code, 1) << "forgotten";
    EXPECT_EQ(answer(0x7F, assistance(1, 2)).info_code, 6);
}

}  // namespace
}  // namespace skyloop::firmware
