// What boards report of their front ends: it moves by itself, and with a jammer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/sbf_frame.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

template <class Message>
Message polled(test::ReceiverRig& rig) {
    rig.heard().clear();
    rig.poll(Message::message_id);
    rig.run(200ms);
    const auto heard = rig.of(Message::message_id);
    EXPECT_EQ(heard.size(), 1U);
    return heard.empty() ? Message{} : *decode_payload<Message>(parse_frame(heard[0].piece.bytes)->payload);
}

TEST(Monitors, ShowsInTheMessagesOfAnEpochAndNotBetweenThem) {
    firmware::BoardProfile board = test::board_named("ublox-f9p");
    board.baud = 460800;
    test::ReceiverRig rig(board);
    rig.run(1100ms);
    const auto first = polled<MonRf>(rig);
    const auto spectrum = polled<MonSpan>(rig).blocks.at(0).spectrum;
    EXPECT_EQ(polled<MonSpan>(rig).blocks.at(0).spectrum, spectrum) << "in one epoch";
    ASSERT_EQ(first.blocks.size(), 2U);
    EXPECT_NE(first.blocks[0].noise_per_ms, first.blocks[1].noise_per_ms) << "two front ends";
    std::set<int> noises, indicators;
    for (int i = 0; i < 20; ++i) {
        rig.run(1s);
        const auto band = polled<MonRf>(rig).blocks.at(0);
        noises.insert(band.noise_per_ms);
        indicators.insert(band.jam_ind);
    }
    EXPECT_GE(noises.size(), 3U);
    EXPECT_GE(indicators.size(), 5U);
    EXPECT_NE(polled<MonSpan>(rig).blocks.at(0).spectrum, spectrum);
    EXPECT_NEAR(polled<MonSys>(rig).temp_value, 28, 7);
}

TEST(Monitors, FollowsAJammerAsBefore) {
    test::ReceiverRig rig(test::board_named("ublox-m9"));
    rig.run(3s);
    const auto quiet = polled<MonHwShort>(rig);
    rig.world = [](GpsTime time) {
        Epoch epoch{test::driving_fix(time)};
        epoch.front_end.interference = Decibels(12);
        return epoch;
    };
    rig.run(2s);
    const auto jammed = polled<MonHwShort>(rig);
    EXPECT_GT(jammed.jam_ind, quiet.jam_ind + 80);
    EXPECT_LT(jammed.agc_cnt, quiet.agc_cnt - 1300);
    EXPECT_GT(jammed.noise_per_ms, 3 * quiet.noise_per_ms);
}

TEST(Monitors, ASeptentrioReportsItsTemperatureAndItsFrontEnd) {
    firmware::BoardProfile board = test::board_named("septentrio-sbf");
    board.sbf_blocks = {"ReceiverStatus"};
    firmware::Receiver receiver(board);
    GpsTime now = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    receiver.start(now);
    StreamSplitter splitter(StreamProtocols{.sbf = true});
    std::set<int> temperatures, gains, variances;
    for (int i = 0; i < 60; ++i) {
        receiver.on_epoch(Epoch{test::driving_fix(now)});
        now += 1s;
        for (const firmware::Receiver::Sent& sent : receiver.output(now))
            for (const StreamPiece& piece : splitter.feed(sent.bytes)) {
                const auto view = piece.kind == StreamKind::sbf ? parse_sbf(piece.bytes) : std::nullopt;
                if (!view || view->number != SbfReceiverStatus::block_number) continue;
                const auto block = decode_sbf<SbfReceiverStatus>(view->body);
                ASSERT_TRUE(block && block->front_ends.size() == 1);
                temperatures.insert(block->temperature - 100);
                gains.insert(block->front_ends[0].gain);
                variances.insert(block->front_ends[0].sample_variance);
            }
    }
    EXPECT_THAT(temperatures, testing::Each(testing::AllOf(testing::Ge(20), testing::Le(36))));
    EXPECT_THAT(gains, testing::Each(testing::AllOf(testing::Ge(27), testing::Le(39))));
    EXPECT_THAT(variances, testing::Each(testing::AllOf(testing::Ge(95), testing::Le(106))));
    EXPECT_GE(variances.size(), 3U);
}

}  // namespace
}  // namespace skyloop
