// What a board has no word for is not reported either: verdicts and outputs tell what its messages could.
#include <gtest/gtest.h>

#include "firmware/config/config_handler.hpp"
#include "firmware/state_tracker.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

NavigationState reported_by(const BoardProfile& board, FixType type, SpoofingIndication spoofing) {
    Epoch epoch{sample_fix("2024-03-05T12:00:00Z", 47, 8, 500)};
    add_satellites(epoch.fix, Constellation::gps, 1, 8);
    const ConfigStore store(factory_config(board));
    StateTracker tracker(board);
    tracker.start(epoch.fix.time, {}, true);
    tracker.update(epoch, store, {});
    epoch.fix.time += std::chrono::seconds(1);
    epoch.fix.type = type;
    epoch.front_end.spoofing = spoofing;
    return tracker.update(epoch, store, {});
}

BoardProfile board_of(Personality personality, int generation = 9) {
    BoardProfile board = sample_ublox();
    board.personality = personality;
    board.identity.generation = generation;
    return board;
}

TEST(UntoldStates, DeadReckoningIsNoFixWhereNoMessageTellsIt) {
    const auto type_on = [](Personality personality) {
        return reported_by(board_of(personality), FixType::dead_reckoning, {}).epoch.fix.type;
    };
    using enum Personality;
    for (const Personality personality : {ublox, mtk, airoha, mute})
        EXPECT_EQ(type_on(personality), FixType::dead_reckoning) << static_cast<int>(personality);
    for (const Personality personality : {msp, msp_v1, mavlink, sbf})
        EXPECT_EQ(type_on(personality), FixType::none) << static_cast<int>(personality);
}

TEST(UntoldStates, SpoofingIsUnknownToReceiversThatDoNotLookForIt) {
    const auto told_by = [](Personality personality, int generation) {
        return reported_by(board_of(personality, generation), FixType::fix_3d, SpoofingIndication::indicated)
            .monitors.spoofing;
    };
    EXPECT_EQ(told_by(Personality::ublox, 8), SpoofingIndication::indicated);
    EXPECT_EQ(told_by(Personality::sbf, 9), SpoofingIndication::indicated);
    EXPECT_EQ(told_by(Personality::ublox, 6), SpoofingIndication::unknown);
    for (const Personality personality :
         {Personality::mute, Personality::mtk, Personality::airoha, Personality::msp, Personality::mavlink})
        EXPECT_EQ(told_by(personality, 9), SpoofingIndication::unknown) << static_cast<int>(personality);
}

}  // namespace
}  // namespace skyloop::firmware
