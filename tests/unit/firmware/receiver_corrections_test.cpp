// What a receiver makes of corrections, and what it tells of them.
#include <gtest/gtest.h>

#include "base/geo/geodetic.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A rover with RTK that measures, and the base that its client brings.
class Rover {
public:
    Rover() : receiver_(board(), {1}) {
        fix_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix_, Constellation::gps, 1, 12);
        receiver_.start(fix_.time);
    }
    static BoardProfile board() {
        BoardProfile board = sample_ublox();
        board.corrections.rtk = true;
        board.config[key::in_protocol(PortId::uart1, 4)] = 1;
        return board;
    }
    Receiver& receiver() { return receiver_; }
    void hear_base() {
        const Eigen::Vector3d place = to_ecef(Geodetic::degrees(47, 8, 400)).vector() * 1e4;
        const Rtcm3Station station{7, {std::llround(place.x()), std::llround(place.y()), std::llround(place.z())}, {}};
        receiver_.input(PortId::uart1, encode(station), fix_.time);
        Rtcm3MsmCell cell;
        cell.range_m = 2.1e7;
        const auto tow = static_cast<std::uint32_t>(week_and_tow(fix_.time).tow / 1ms);
        receiver_.input(PortId::uart1, encode(Rtcm3MsmObservations{1077, 7, tow, false, {cell}}), fix_.time);
        ++heard_;
    }
    // The next second. What it solves follows from the corrections at hand, but for `fewer`: satellites that have none,
    // which those of SBAS may serve.
    const NavigationState& go_on(bool fewer = false, std::optional<SatelliteId> sbas = std::nullopt) {
        fix_.time += 1s;
        const Corrections& corrections = receiver_.settings_at(fix_.time).corrections;
        const Seconds age =
            corrections.reference ? difference(fix_.time, corrections.reference->epoch.time) : Seconds(0);
        const bool any = !fewer && corrections.reference && age <= corrections.differential_timeout;
        fix_.type = !any                                            ? FixType::fix_3d
                    : age > corrections.float_timeout               ? FixType::dgnss
                    : heard_ < 5 || age > corrections.fixed_timeout ? FixType::rtk_float
                                                                    : FixType::rtk_fixed;
        if (!any && sbas) fix_.type = FixType::dgnss;
        fix_.sbas_source = sbas;
        Epoch epoch{fix_};
        epoch.observations.receive_time = fix_.time;
        epoch.observations.signals.emplace_back();
        receiver_.on_epoch(epoch);
        return receiver_.state();
    }

private:
    Receiver receiver_;
    Fix fix_;
    int heard_ = 0;
};

// What is told of corrections is that of the solution in the same epoch.
bool agrees(const NavigationState& state) {
    const bool corrected = state.corrections.state != CorrectionState::none;
    return corrected == (state.epoch.fix.type >= FixType::dgnss) &&
           corrections_in_use(state) == (corrected ? CorrectionOrigin::rtcm3 : CorrectionOrigin::none);
}

TEST(ReceiverCorrections, AreThoseOfTheSolutionFromTheFirstEpochToTheLast) {
    Rover rover;
    EXPECT_EQ(rover.go_on().corrections.state, CorrectionState::none);
    CorrectionState last = CorrectionState::none;
    for (int i = 0; i < 20; ++i) {
        rover.hear_base();
        const NavigationState& state = rover.go_on();
        EXPECT_TRUE(agrees(state)) << i;
        EXPECT_TRUE(state.corrections.come);
        last = state.corrections.state;
    }
    EXPECT_EQ(last, CorrectionState::rtk_fixed);
    for (int i = 0; i < 70; ++i) {
        const NavigationState& state = rover.go_on();
        EXPECT_TRUE(agrees(state)) << "silent for " << i + 1 << " s";
        last = state.corrections.state;
    }
    EXPECT_EQ(last, CorrectionState::none);
    EXPECT_FALSE(rover.receiver().state().corrections.come);
}

TEST(ReceiverCorrections, AreNotToldOfASolutionThatHasNone) {
    Rover rover;
    for (int i = 0; i < 3; ++i) {
        rover.hear_base();
        const NavigationState& state = rover.go_on(true);
        EXPECT_EQ(state.corrections.state, CorrectionState::none);
        EXPECT_TRUE(state.corrections.come);
        EXPECT_EQ(corrections_in_use(state), CorrectionOrigin::none);
    }
}

// A solution that was made before they came has none of them, though it was handed in after.
TEST(ReceiverCorrections, AreNotThoseOfSbas) {
    Rover rover;
    rover.hear_base();
    EXPECT_EQ(rover.go_on().corrections.state, CorrectionState::rtk_float);
    const NavigationState& state = rover.go_on(true, SatelliteId{Constellation::sbas, 36});
    EXPECT_EQ(state.epoch.fix.type, FixType::dgnss);
    EXPECT_EQ(state.corrections.state, CorrectionState::none);
    EXPECT_EQ(corrections_in_use(state), CorrectionOrigin::sbas);
}

TEST(ReceiverCorrections, DoNotActBackwards) {
    Rover rover;
    rover.go_on();
    rover.hear_base();
    Fix fix = sample_fix("2024-03-05T12:00:02Z", 47, 8, 500);
    fix.type = FixType::dgnss;  // by SBAS
    Epoch epoch{fix};
    epoch.observations.signals.emplace_back();
    rover.receiver().on_epoch(epoch);
    EXPECT_EQ(rover.receiver().state().corrections.state, CorrectionState::none);
    EXPECT_EQ(corrections_in_use(rover.receiver().state()), CorrectionOrigin::sbas);
    EXPECT_EQ(rover.receiver().settings_at(fix.time).corrections.at_most, CorrectionState::rtk_fixed);
}

TEST(ReceiverCorrections, OfCarrierPhasesAreNeverThoseOfSbas) {
    NavigationState state;
    state.epoch.fix.type = FixType::rtk_fixed;
    EXPECT_EQ(corrections_in_use(state), CorrectionOrigin::rtcm3);
    state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(corrections_in_use(state), CorrectionOrigin::sbas);
}

}  // namespace
}  // namespace skyloop::firmware
