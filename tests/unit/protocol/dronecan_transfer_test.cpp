// Transfers of DroneCAN in frames, whole and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "receiver/protocol/dronecan_transfer.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint64_t fix_signature = DronecanFix2::type.signature;

DronecanTransfer long_transfer(std::uint8_t id = 5) {
    DronecanTransfer transfer{DronecanKind::message, 1063, 24, 42, 0, id, {}};
    for (std::uint8_t i = 0; i < 62; ++i)
        transfer.payload.push_back(static_cast<std::uint8_t>(7 * i));
    return transfer;
}

// What comes of frames, one millisecond after the other.
std::vector<DronecanTransfer> received(TransferReceiver& receiver, const std::vector<CanFrame>& frames,
                                       GpsTime from = {}) {
    std::vector<DronecanTransfer> transfers;
    for (const CanFrame& frame : frames)
        if (auto transfer = receiver.take(frame, from += 1ms)) transfers.push_back(std::move(*transfer));
    return transfers;
}

TEST(DronecanTransfer, OfSevenBytesIsOneFrame) {
    const DronecanTransfer status{DronecanKind::message, 341, 16, 42, 0, 31, {1, 2, 3, 4, 5, 6, 7}};
    const auto frames = dronecan_frames(status, DronecanNodeStatus::type.signature);
    ASSERT_THAT(frames, SizeIs(1));
    EXPECT_EQ(frames[0].id, 0x1001552AU) << "priority 16, type 341, node 42";
    EXPECT_THAT(std::vector(frames[0].data.begin(), frames[0].data.end()), ElementsAre(1, 2, 3, 4, 5, 6, 7, 0xDF));
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, frames), ElementsAre(status));
}

TEST(DronecanTransfer, OfARequestNamesBothNodes) {
    const DronecanTransfer request{DronecanKind::request, 1, 30, 127, 42, 2, {}};
    const auto frames = dronecan_frames(request, DronecanGetNodeInfoRequest::type.signature);
    ASSERT_THAT(frames, SizeIs(1));
    EXPECT_EQ(frames[0].id, 0x1E01AAFFU) << "priority 30, service 1, request to 42, of 127";
    EXPECT_EQ(frames[0].size, 1);
    EXPECT_EQ(frames[0].data[0], 0xC2);
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, frames), ElementsAre(request));
}

TEST(DronecanTransfer, WithoutASourceIsOneFrameWithADiscriminator) {
    DronecanTransfer request{DronecanKind::message, 1, 24, 0, 0, 0, {1, 2, 3, 4, 5, 6, 7}};
    const auto frames = dronecan_frames(request, 0);
    ASSERT_THAT(frames, SizeIs(1));
    EXPECT_EQ(frames[0].id & 0x1F0003FFU, 0x18000100U);
    EXPECT_NE(frames[0].id & 0x00FFFC00U, 0U);
    request.payload.push_back(8);
    EXPECT_THAT(dronecan_frames(request, 0), IsEmpty()) << "an anonymous message has one frame";
}

TEST(DronecanTransfer, OfMoreBytesHasItsCrcBeforeThemAndATailBehindEachSeven) {
    const auto frames = dronecan_frames(long_transfer(), fix_signature);
    ASSERT_THAT(frames, SizeIs(10)) << "64 bytes";
    std::vector<int> tails;
    for (const CanFrame& frame : frames)
        tails.push_back(frame.data[frame.size - 1U]);
    EXPECT_THAT(tails, ElementsAre(0x85, 0x25, 0x05, 0x25, 0x05, 0x25, 0x05, 0x25, 0x05, 0x65));
    EXPECT_EQ(frames.back().size, 2);
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, frames), ElementsAre(long_transfer()));
    EXPECT_EQ(receiver.counts().transfers, 1U);
}

TEST(DronecanTransfer, OfEveryLengthComesBack) {
    TransferReceiver receiver;
    for (std::size_t size = 0; size <= TransferReceiver::longest_payload; ++size) {
        DronecanTransfer transfer = long_transfer(static_cast<std::uint8_t>(size % 32));
        transfer.payload.assign(size, static_cast<std::uint8_t>(size));
        ASSERT_THAT(received(receiver, dronecan_frames(transfer, fix_signature)), ElementsAre(transfer)) << size;
    }
    DronecanTransfer longer = long_transfer();
    longer.payload.assign(TransferReceiver::longest_payload + 1, 0);
    EXPECT_THAT(dronecan_frames(longer, fix_signature), IsEmpty());
}

TEST(DronecanTransfer, IsDroppedAndCountedForEachKindOfDamage) {
    const auto frames = dronecan_frames(long_transfer(), fix_signature);
    const auto counts_of = [](const std::vector<CanFrame>& damaged) {
        TransferReceiver receiver;
        EXPECT_THAT(received(receiver, damaged), IsEmpty());
        return receiver.counts();
    };
    auto hole = frames;
    hole.erase(hole.begin() + 4);
    EXPECT_GE(counts_of(hole).out_of_order, 1U);
    auto two_missing = frames;  // the toggle fits again
    two_missing.erase(two_missing.begin() + 4, two_missing.begin() + 6);
    EXPECT_EQ(counts_of(two_missing).bad_crc, 1U);
    auto swapped = frames;
    std::swap(swapped[2], swapped[3]);
    EXPECT_GE(counts_of(swapped).out_of_order, 1U);
    auto wrong_bit = frames;
    wrong_bit[3].data[2] ^= 4U;
    EXPECT_EQ(counts_of(wrong_bit).bad_crc, 1U);
    auto wrong_start = frames;
    wrong_start[0].data[7] |= 0x20U;
    EXPECT_EQ(counts_of(wrong_start).malformed, 1U);
    auto short_piece = frames;
    short_piece[5].size = 4;
    EXPECT_EQ(counts_of(short_piece).malformed, 1U);
    auto headless = frames;
    headless.erase(headless.begin());
    EXPECT_EQ(counts_of(headless).out_of_order, 9U);
    EXPECT_EQ(counts_of({CanFrame{0x123, false, 1, {0xC0}}}).malformed, 1U);
    EXPECT_EQ(counts_of({CanFrame{0x18042A2A, true, 0, {}}}).malformed, 1U) << "without a tail";
}

TEST(DronecanTransfer, OfAnotherSignatureIsNoTransfer) {
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, dronecan_frames(long_transfer(), fix_signature + 1)), IsEmpty());
    EXPECT_EQ(receiver.counts().bad_crc, 1U);
}

TEST(DronecanTransfer, ThatIsRepeatedComesOnce) {
    const auto frames = dronecan_frames(long_transfer(), fix_signature);
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, frames), SizeIs(1));
    EXPECT_THAT(received(receiver, frames, GpsTime{} + 100ms), IsEmpty());
    EXPECT_EQ(receiver.counts().repeated, 1U);
    EXPECT_THAT(received(receiver, frames, GpsTime{} + 5s), SizeIs(1)) << "the ids have come round";
}

TEST(DronecanTransfer, ThatIsNotFinishedIsGivenUp) {
    const auto frames = dronecan_frames(long_transfer(5), fix_signature);
    const auto next = dronecan_frames(long_transfer(6), fix_signature);
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, {frames.begin(), frames.begin() + 5}), IsEmpty());
    EXPECT_THAT(received(receiver, next), ElementsAre(long_transfer(6)));
    EXPECT_EQ(receiver.counts().unfinished, 1U);
    EXPECT_THAT(received(receiver, {frames.begin(), frames.begin() + 5}, GpsTime{} + 4s), IsEmpty());
    EXPECT_THAT(received(receiver, {frames.begin() + 5, frames.end()}, GpsTime{} + 7s), IsEmpty());
    EXPECT_EQ(receiver.counts().unfinished, 2U) << "2 s of silence";
}

TEST(DronecanTransfer, OfSeveralNodesComesBesideOthers) {
    DronecanTransfer other = long_transfer();
    other.source = 43;
    const auto a = dronecan_frames(long_transfer(), fix_signature), b = dronecan_frames(other, fix_signature);
    std::vector<CanFrame> mixed;
    for (std::size_t i = 0; i < a.size(); ++i) {
        mixed.push_back(a[i]);
        mixed.push_back(b[i]);
    }
    TransferReceiver receiver;
    EXPECT_THAT(received(receiver, mixed), ElementsAre(long_transfer(), other));
}

TEST(DronecanTransfer, SurvivesAnyFrames) {
    std::mt19937 random(3);
    TransferReceiver receiver;
    GpsTime now{};
    for (int i = 0; i < 50'000; ++i) {
        CanFrame frame{static_cast<std::uint32_t>(random() & 0x1FFF'FFFFU), random() % 8 != 0,
                       static_cast<std::uint8_t>(random() % 9)};
        if (random() % 2 == 0) frame.id = (frame.id & 0xFF0000FFU) | 1063U << 8;
        for (std::uint8_t k = 0; k < frame.size; ++k)
            frame.data[k] = static_cast<std::uint8_t>(random());
        static_cast<void>(receiver.take(frame, now += 100us));
    }
    EXPECT_GT(receiver.counts().out_of_order, 0U);
}

}  // namespace
}  // namespace skyloop
