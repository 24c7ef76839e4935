/// A receiver's state by hand, and its messages read back.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_fields.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {

/// A board of a generation of u-blox, its factory configuration and an epoch with a fix.
struct UbxReport {
    explicit UbxReport(int generation, const char* utc = "2024-03-05T12:49:23.521Z")
        : board(board_of(generation)), config(factory_config(board)) {
        Fix& fix = state.epoch.fix;
        fix = sample_fix(utc, 47.1234567891, 8.7654321987, 512.3456);
        fix.velocity = {3.0004, 4.0006, -1.25};
        fix.speed = MetresPerSecond(5.001);
        fix.speed_accuracy = MetresPerSecond(0.25);
        fix.course_accuracy = Angle::degrees(1.5);
        fix.clock_drift = MetresPerSecond(149.896229);
        add_satellites(fix, Constellation::gps, 1, 8);
        add_satellites(fix, Constellation::galileo, 1, 4);
        state.fix_ok = state.ever_had_fix = state.position_known = true;
        state.time = {true, true, true, true, Seconds(25e-9)};
        state.course = Angle::degrees(53.13);
        state.since_start = Seconds(123.456);
        state.since_boot = Seconds(456.789);
        state.time_to_first_fix = Seconds(26.5);
        state.monitors = {{1, 14, 4200, 69}, {}, AntennaStatus::ok, 1, SpoofingIndication::none};
    }

    static BoardProfile board_of(int generation) {
        BoardProfile board = sample_board(NmeaVersion::v4_0, {Constellation::gps, Constellation::galileo});
        board.identity.generation = generation;
        board.identity.software = "ROM CORE 3.01 (107888)";
        board.identity.hardware = generation == 8 ? "00080000" : generation == 9 ? "00190000" : "000A0000";
        board.identity.extensions = {"FWVER=SPG 3.01", "PROTVER=18.00"};
        board.identity.unique_id = generation >= 10 ? Bytes{1, 2, 3, 4, 5, 6} : Bytes{1, 2, 3, 4, 5};
        board.gnss_supported = 0x0F;
        board.gnss_simultaneous = 3;
        return board;
    }

    /// As after a cold start, `seconds` ago.
    void start_cold(double seconds) {
        state = {};
        state.epoch.fix.time = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
        state.since_start = Seconds(seconds);
    }
    /// The fix is gone; what was last is still there.
    void lose_fix() {
        state.epoch.fix.type = FixType::none;
        state.fix_ok = false;
    }

    /// What it holds is that of the last call.
    [[nodiscard]] ReportContext context() const {
        in_force = receiver_config(config, board);
        return {board, in_force, state, ports, PortId::uart1};
    }

    [[nodiscard]] std::vector<Bytes> frames(UbxMessageId message) const {
        switch (message.message_class) {
            case 0x01: {
                std::vector<Bytes> list = make_satellite_message(message, context());
                return list.empty() ? make_navigation_message(message, context()) : list;
            }
            case 0x02:
                return make_raw_message(message, context());
            case 0x0D:
                return make_navigation_message(message, context());
            default:
                return make_monitor_message(message, context());
        }
    }

    /// The one frame of a message, read back.
    template <class Message>
    [[nodiscard]] Message report() const {
        const std::vector<Bytes> list = frames(Message::message_id);
        EXPECT_EQ(list.size(), 1u);
        if (list.size() != 1) return {};
        const auto frame = parse_frame(list[0]);
        EXPECT_TRUE(frame && frame->id == Message::message_id);
        const auto message = frame ? decode_payload<Message>(frame->payload) : std::nullopt;
        EXPECT_TRUE(message) << "payload of " << (frame ? frame->payload.size() : 0) << " bytes";
        return message.value_or(Message{});
    }

    BoardProfile board;
    ConfigStore config;
    NavigationState state;
    std::vector<PortStatus> ports;
    mutable ReceiverConfig in_force;
};

}  // namespace skyloop::firmware
