// What a board has no word for is not reported either: verdicts and outputs tell what its messages could.
#include <gtest/gtest.h>

#include "firmware/core/state_tracker.hpp"
#include "firmware/makers.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

NavigationState reported_by(const BoardProfile& board, FixType type, SpoofingIndication spoofing) {
    Epoch epoch{sample_fix("2024-03-05T12:00:00Z", 47, 8, 500)};
    add_satellites(epoch.fix, Constellation::gps, 1, 8);
    const std::unique_ptr<Maker> maker = maker_row(board.maker).make(board, {});
    StateTracker tracker(board);
    tracker.start(epoch.fix.time, {}, true);
    tracker.update(epoch, maker->config(), {});
    epoch.fix.time += std::chrono::seconds(1);
    epoch.fix.type = type;
    epoch.front_end.spoofing = spoofing;
    return tracker.update(epoch, maker->config(), {});
}

BoardProfile board_of(MakerKind kind, int generation = 9) {
    BoardProfile board = sample_ublox();
    board.maker = kind;
    board.identity.generation = generation;
    return board;
}

TEST(UntoldStates, DeadReckoningIsNoFixWhereNoMessageTellsIt) {
    const auto type_on = [](MakerKind kind) {
        return reported_by(board_of(kind), FixType::dead_reckoning, {}).epoch.fix.type;
    };
    using enum MakerKind;
    for (const MakerKind kind : {ublox, mtk, airoha, mute})
        EXPECT_EQ(type_on(kind), FixType::dead_reckoning) << static_cast<int>(kind);
    for (const MakerKind kind : {msp, msp_v1, mavlink, sbf})
        EXPECT_EQ(type_on(kind), FixType::none) << static_cast<int>(kind);
}

TEST(UntoldStates, SpoofingIsUnknownToReceiversThatDoNotLookForIt) {
    const auto told_by = [](MakerKind kind, int generation) {
        return reported_by(board_of(kind, generation), FixType::fix_3d, SpoofingIndication::indicated)
            .monitors.spoofing;
    };
    EXPECT_EQ(told_by(MakerKind::ublox, 8), SpoofingIndication::indicated);
    EXPECT_EQ(told_by(MakerKind::sbf, 9), SpoofingIndication::indicated);
    EXPECT_EQ(told_by(MakerKind::ublox, 6), SpoofingIndication::unknown);
    for (const MakerKind kind :
         {MakerKind::mute, MakerKind::mtk, MakerKind::airoha, MakerKind::msp, MakerKind::mavlink})
        EXPECT_EQ(told_by(kind, 9), SpoofingIndication::unknown) << static_cast<int>(kind);
}

}  // namespace
}  // namespace skyloop::firmware
