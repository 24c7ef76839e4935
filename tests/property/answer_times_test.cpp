// How long an answer takes at 9600 baud with the factory's sentences and the sky of four systems: PX4's driver waits
// for 2 s for its first one, and for 250 ms with receivers before the M10 (PX4-GPSDrivers, src/ubx.cpp).
#include <gtest/gtest.h>

#include <ostream>

#include "receiver/protocol/ubx_cfg.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::ReceiverRig;

constexpr UbxMessageId asked_version{0x0A, 0x04}, ack{0x05, 0x01}, nak{0x05, 0x00};

struct SlowBoard {
    const char* name;
    Nanoseconds longest;
};
void PrintTo(const SlowBoard& board, std::ostream* out) { *out << board.name; }

class AnswersAt9600 : public testing::TestWithParam<SlowBoard> {
protected:
    static ReceiverRig rig() {
        firmware::BoardProfile board = test::board_named(GetParam().name);
        board.baud = 9600;
        return ReceiverRig(std::move(board));
    }
};

Bytes first_valset() {
    CfgValset set;
    set.layers = 1;
    set.pairs = {{0x10740001, 1}, {0x10740002, 0}};
    return encode_frame(set);
}

TEST_P(AnswersAt9600, AFirstAcknowledgementComesInTime) {
    Nanoseconds longest{0};
    for (Nanoseconds phase = 0ms; phase < 1s; phase += 37ms) {
        ReceiverRig receiver = rig();
        receiver.run(10s + phase);
        EXPECT_FALSE(receiver.sentences().empty());
        const GpsTime asked = receiver.now();
        receiver.write(first_valset());
        receiver.run(3s, 1ms);
        std::vector<test::Heard> answers = receiver.of(ack);
        if (answers.empty()) answers = receiver.of(nak);
        ASSERT_EQ(answers.size(), 1U) << phase.count();
        EXPECT_LE(answers[0].at - asked, GetParam().longest) << phase.count();
        longest = std::max(longest, answers[0].at - asked);
    }
    RecordProperty("longest_us", static_cast<int>(longest.count() / 1000));
}

TEST_P(AnswersAt9600, AnAnswerStandsBetweenWholeSentences) {
    ReceiverRig receiver = rig();
    receiver.run(10s + 150ms);
    receiver.heard().clear();
    receiver.poll(asked_version);
    receiver.run(2s, 1ms);
    for (const test::Heard& h : receiver.heard())
        EXPECT_NE(h.piece.kind, StreamKind::noise);
    EXPECT_EQ(receiver.of(asked_version).size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Boards, AnswersAt9600,
                         testing::Values(SlowBoard{"ublox-m8", 250ms}, SlowBoard{"ublox-m9", 1500ms},
                                         SlowBoard{"ublox-m10", 1500ms}, SlowBoard{"ublox-f9p", 1500ms}),
                         [](const auto& instance) {
                             std::string name = instance.param.name;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace skyloop
