// A node of DroneCAN and what others of its bus make of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "base/core/can_frame.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using test::board_named;
using test::driving_fix;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint8_t autopilot = 10;

class DronecanNode : public testing::Test {
protected:
    struct Came {
        DronecanTransfer transfer;
        GpsTime at;
    };

    void switch_on(int node_id, std::size_t number = 0, std::uint64_t seed = 1) {
        BoardProfile board = board_named("dronecan-generic");
        board.can.node_id = node_id;
        start(std::move(board), number, seed);
    }
    void start(BoardProfile board, std::size_t number = 0, std::uint64_t seed = 1) {
        ReceiverOptions options;
        options.number = number;
        options.seed = seed;
        options.rate_hz = rate_hz;
        receiver.emplace(std::move(board), options);
        receiver->start(now);
        next_epoch = now;
    }

    void run(Nanoseconds length) {
        const GpsTime end = now + length;
        while (now < end) {
            now = std::min({end, now + 5ms, next_epoch > now ? next_epoch : now + 5ms});
            for (const Receiver::Sent& sent : receiver->output(now))
                for (const std::string& line : lines.feed(sent.bytes))
                    hear(*parse_slcan_line(line));
            if (now < next_epoch) continue;
            receiver->on_epoch(world(now));
            const Nanoseconds period = receiver->settings().navigation_period;
            next_epoch = now - now.time_since_epoch() % period + period;
        }
    }
    void hear(const CanFrame& frame) {
        ++frames;
        auto transfer = taken.take(frame, now);
        if (!transfer) return;
        came.push_back({*transfer, now});
        if (allocates && transfer->source == 0) grant(*transfer);
    }

    // The server of ids as the specification has it: it repeats what it has of the unique id, and gives the id at last.
    void grant(const DronecanTransfer& request) {
        const auto asks = decode_bits<DronecanAllocation>(request.payload);
        ASSERT_TRUE(asks);
        ++requests;
        if (asks->first_part != 0) collected.clear();
        collected.insert(collected.end(), asks->unique_id.begin(), asks->unique_id.end());
        DronecanAllocation answer;
        answer.unique_id.assign(collected.begin(), collected.end());
        if (collected.size() == 16) answer.node_id = 77;
        say(answer);
    }

    template <class Message>
    void say(const Message& message, std::uint8_t to = 0) {
        const DronecanTransfer transfer{Message::type.kind,  Message::type.id, 20, autopilot, to, next_id,
                                        encode_bits(message)};
        next_id = static_cast<std::uint8_t>((next_id + 1) % 32);
        std::string text;
        for (const CanFrame& frame : dronecan_frames(transfer, Message::type.signature))
            text += slcan_line(frame);
        receiver->input(PortId::uart1, to_bytes(text), now);
    }

    template <class Message>
    std::vector<Message> all() const {
        std::vector<Message> found;
        for (const Came& one : came)
            if (one.transfer.kind == Message::type.kind && one.transfer.type_id == Message::type.id)
                if (const auto message = decode_bits<Message>(one.transfer.payload)) found.push_back(*message);
        return found;
    }
    template <class Response, class Request>
    std::vector<Response> answers_to(const Request& request, std::uint8_t to = 42) {
        came.clear();
        say(request, to);
        run(500ms);
        return all<Response>();
    }

    DronecanGetSetResponse parameter(const std::string& name, std::optional<std::int64_t> value = {}) {
        DronecanGetSetRequest request;
        request.name.assign(name.begin(), name.end());
        if (value) {
            request.value.tag = DronecanValue::integer_value;
            request.value.integer = *value;
        }
        const auto answers = answers_to<DronecanGetSetResponse>(request);
        EXPECT_THAT(answers, SizeIs(1)) << name;
        return answers.empty() ? DronecanGetSetResponse{} : answers.front();
    }

    double rate_hz = 0;
    bool allocates = false;
    int requests = 0;
    std::size_t frames = 0;
    Bytes collected;
    std::uint8_t next_id = 0;
    std::optional<Receiver> receiver;
    GpsTime now = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    GpsTime next_epoch{};
    SlcanLines lines;
    TransferReceiver taken;
    std::vector<Came> came;
    std::function<Epoch(GpsTime)> world = [](GpsTime time) { return Epoch{driving_fix(time)}; };
};

TEST_F(DronecanNode, SaysEachSecondThatItIsWell) {
    switch_on(42);
    run(10500ms);
    const auto statuses = all<DronecanNodeStatus>();
    ASSERT_THAT(statuses, SizeIs(11));
    for (std::size_t i = 0; i < statuses.size(); ++i) {
        EXPECT_EQ(statuses[i].uptime, i);
        EXPECT_EQ(statuses[i].health, 0U);
        EXPECT_EQ(statuses[i].mode, 0U);
    }
    for (const Came& one : came)
        EXPECT_EQ(one.transfer.source, 42);
    EXPECT_EQ(taken.counts().transfers, came.size());
    EXPECT_EQ(taken.counts().out_of_order + taken.counts().bad_crc + taken.counts().malformed, 0U);
}

// What ArduPilot makes of them: AP_GPS_DroneCAN.cpp.
TEST_F(DronecanNode, TellsItsFixAsArdupilotReadsIt) {
    switch_on(42);
    run(2s);
    const auto fixes = all<DronecanFix2>();
    ASSERT_THAT(fixes, SizeIs(10)) << "5 Hz";
    const DronecanFix2& fix = fixes.back();
    EXPECT_NEAR(fix.latitude.value(), 47.3977, 1e-8);
    EXPECT_NEAR(fix.longitude.value(), 8.5456, 1e-8);
    EXPECT_NEAR(fix.height.value(), 488, 1e-3);
    EXPECT_NEAR(fix.msl_height.value(), 441, 1e-3);
    EXPECT_THAT(std::vector(fix.velocity.begin(), fix.velocity.end()), ElementsAre(8.0F, 1.0F, 0.0F));
    EXPECT_EQ(fix.status, 3U);
    EXPECT_EQ(fix.mode, 0U);
    EXPECT_EQ(fix.satellites, 32U);
    ASSERT_THAT(fix.covariance, SizeIs(6));
    EXPECT_NEAR(std::sqrt(fix.covariance[0]), 1.2, 1e-3);
    EXPECT_NEAR(std::sqrt(fix.covariance[2]), 1.8, 1e-3);
    EXPECT_NEAR(std::sqrt((fix.covariance[3] + fix.covariance[4] + fix.covariance[5]) / 3), 0.1, 1e-4);
    EXPECT_NEAR(fix.pdop, 1.3, 1e-3);
    EXPECT_EQ(fix.time_standard, 2U) << "UTC";
    EXPECT_EQ(fix.leap_seconds, 18U);
    EXPECT_EQ(fix.gnss_timestamp.raw % 200'000, 0U);
    EXPECT_GE(fix.gnss_timestamp.raw, 1'709'640'000'000'000U) << "2024-03-05 12:00 UTC";
    EXPECT_EQ(fix.timestamp - fix.gnss_timestamp, 50'000U) << "its latency";
    const auto auxiliary = all<DronecanAuxiliary>();
    ASSERT_THAT(auxiliary, SizeIs(10));
    EXPECT_NEAR(auxiliary.back().hdop, 0.8, 1e-3);
    EXPECT_NEAR(auxiliary.back().vdop, 1.0, 1e-3);
    EXPECT_EQ(auxiliary.back().visible, 32U);
    EXPECT_THAT(all<DronecanGnssStatus>(), IsEmpty()) << "it would gate arming";
    EXPECT_THAT(all<DronecanRelPosHeading>(), IsEmpty());
}

TEST_F(DronecanNode, TellsWhichKindOfFixItHas) {
    struct Row {
        FixType type;
        std::uint64_t status, mode, sub_mode;
    };
    for (const Row& row : {Row{FixType::none, 0, 0, 0}, Row{FixType::fix_2d, 2, 0, 0}, Row{FixType::dgnss, 3, 1, 0},
                           Row{FixType::rtk_float, 3, 2, 0}, Row{FixType::rtk_fixed, 3, 2, 1}}) {
        switch_on(42);
        world = [&](GpsTime time) {
            Fix fix = driving_fix(time);
            fix.type = row.type;
            return Epoch{fix};
        };
        came.clear();
        taken = {};
        run(1s);
        const auto fixes = all<DronecanFix2>();
        ASSERT_THAT(fixes, testing::Not(IsEmpty()));
        EXPECT_EQ(fixes.back().status, row.status) << fix_type_name(row.type);
        // Carrier phases count with corrections alone, which nobody has sent.
        if (row.type == FixType::rtk_float || row.type == FixType::rtk_fixed) continue;
        EXPECT_EQ(fixes.back().mode, row.mode) << fix_type_name(row.type);
    }
}

TEST_F(DronecanNode, GetsItsIdFromAServer) {
    switch_on(0);
    run(5s);
    EXPECT_EQ(requests, 0);
    ASSERT_THAT(came, testing::Not(IsEmpty()));
    for (const Came& one : came) {
        EXPECT_EQ(one.transfer.source, 0) << "without an id it only asks for one";
        const auto asks = decode_bits<DronecanAllocation>(one.transfer.payload);
        ASSERT_TRUE(asks);
        EXPECT_EQ(asks->node_id, 0U);
        EXPECT_EQ(asks->first_part, 1U);
        EXPECT_THAT(asks->unique_id, SizeIs(6));
    }
    for (std::size_t i = 1; i < came.size(); ++i) {
        EXPECT_GE(came[i].at - came[i - 1].at, 590ms);
        EXPECT_LE(came[i].at - came[i - 1].at, 1010ms);
    }
    allocates = true;
    came.clear();
    run(3s);
    EXPECT_EQ(requests, 3) << "6, 6 and 4 bytes";
    EXPECT_THAT(collected, SizeIs(16));
    came.clear();
    run(3s);
    ASSERT_GE(all<DronecanNodeStatus>().size(), 3U);
    for (const Came& one : came)
        EXPECT_EQ(one.transfer.source, 77);
    const auto infos = answers_to<DronecanGetNodeInfoResponse>(DronecanGetNodeInfoRequest{}, 77);
    ASSERT_THAT(infos, SizeIs(1));
    EXPECT_EQ(Bytes(infos[0].unique_id.begin(), infos[0].unique_id.end()), collected);
}

TEST_F(DronecanNode, IsTheSameNodeInEveryRunAndAnotherForEachReceiver) {
    const auto id_of = [&](std::size_t number, std::uint64_t seed) {
        switch_on(42, number, seed);
        const auto infos = answers_to<DronecanGetNodeInfoResponse>(DronecanGetNodeInfoRequest{},
                                                                   static_cast<std::uint8_t>(42 + number));
        EXPECT_THAT(infos, SizeIs(1));
        return infos.empty() ? Bytes() : Bytes(infos[0].unique_id.begin(), infos[0].unique_id.end());
    };
    const Bytes first = id_of(0, 1);
    EXPECT_EQ(id_of(0, 99), first);
    EXPECT_NE(id_of(1, 1), first);
}

TEST_F(DronecanNode, TellsWhoItIs) {
    switch_on(42);
    run(3s);
    const auto infos = answers_to<DronecanGetNodeInfoResponse>(DronecanGetNodeInfoRequest{});
    ASSERT_THAT(infos, SizeIs(1));
    EXPECT_EQ(std::string(infos[0].name.begin(), infos[0].name.end()), "org.skyloop.gnss");
    EXPECT_EQ(infos[0].status.uptime, 3U);
    EXPECT_EQ(came.front().transfer.source, 42);
    EXPECT_THAT(answers_to<DronecanGetNodeInfoResponse>(DronecanGetNodeInfoRequest{}, 43), IsEmpty())
        << "another node was asked";
}

TEST_F(DronecanNode, HasTheParametersThatDriversSet) {
    switch_on(42);
    EXPECT_EQ(parameter("GPS_TYPE").value.integer, 1);
    EXPECT_EQ(parameter("GPS_TYPE", 17).value.integer, 17);
    EXPECT_EQ(parameter("GPS1_TYPE").value.integer, 17) << "the same by its newer name";
    EXPECT_EQ(parameter("GPS1_TYPE", 300).value.integer, 17) << "out of range";
    EXPECT_EQ(parameter("GPS_MB_ONLY_PORT", -1).value.integer, -1);
    EXPECT_EQ(parameter("CAN_NODE").value.integer, 42);
    const auto rate = parameter("GPS_RATE_MS", 100);
    EXPECT_EQ(rate.value.integer, 100);
    EXPECT_EQ(rate.default_value.integer, 200);
    EXPECT_EQ(receiver->settings().navigation_period, 100ms);
    EXPECT_THAT(parameter("NONE").name, IsEmpty());
    DronecanGetSetRequest by_index;
    by_index.index = 1;
    const auto second = answers_to<DronecanGetSetResponse>(by_index);
    ASSERT_THAT(second, SizeIs(1));
    EXPECT_EQ(std::string(second[0].name.begin(), second[0].name.end()), "GPS_TYPE");
    by_index.index = 100;
    EXPECT_THAT(answers_to<DronecanGetSetResponse>(by_index).at(0).name, IsEmpty());
}

TEST_F(DronecanNode, KeepsWhatIsSavedOverARestart) {
    switch_on(42);
    parameter("GPS_TYPE", 17);
    DronecanExecuteOpcodeRequest opcode;
    opcode.opcode = DronecanExecuteOpcodeRequest::save;
    EXPECT_EQ(answers_to<DronecanExecuteOpcodeResponse>(opcode).at(0).ok, 1U);
    parameter("GPS_TYPE", 18);
    DronecanRestartNodeRequest restart;
    restart.magic_number = 1;
    EXPECT_EQ(answers_to<DronecanRestartNodeResponse>(restart).at(0).ok, 0U);
    EXPECT_EQ(parameter("GPS_TYPE").value.integer, 18) << "without the magic number nothing happens";
    restart.magic_number = DronecanRestartNodeRequest::magic;
    EXPECT_EQ(answers_to<DronecanRestartNodeResponse>(restart).at(0).ok, 1U);
    run(5s);
    EXPECT_EQ(parameter("GPS_TYPE").value.integer, 17);
    EXPECT_LT(all<DronecanNodeStatus>().empty() ? 0U : all<DronecanNodeStatus>().back().uptime.raw, 10U);
    opcode.opcode = DronecanExecuteOpcodeRequest::erase;
    EXPECT_EQ(answers_to<DronecanExecuteOpcodeResponse>(opcode).at(0).ok, 1U);
    answers_to<DronecanRestartNodeResponse>(restart);
    run(5s);
    EXPECT_EQ(parameter("GPS_TYPE").value.integer, 1);
    opcode.opcode = 7;
    EXPECT_EQ(answers_to<DronecanExecuteOpcodeResponse>(opcode).at(0).ok, 0U);
}

TEST_F(DronecanNode, RefusesAFirmwareUpdateAndLeavesTheRestAlone) {
    switch_on(42);
    DronecanBeginFirmwareUpdateRequest update;
    update.path = {'x'};
    const auto refusal = answers_to<DronecanBeginFirmwareUpdateResponse>(update);
    ASSERT_THAT(refusal, SizeIs(1));
    EXPECT_EQ(refusal[0].error, 1U);
    came.clear();
    // A beep and lights: uavcan.equipment.indication, 1080 and 1081.
    receiver->input(PortId::uart1, to_bytes("T1804380A501020304C0\rT1804390A501020304C0\rhello\rT18\r"), now);
    run(1s);
    EXPECT_THAT(all<DronecanNodeStatus>(), SizeIs(1));
}

TEST_F(DronecanNode, TakesCorrectionsInPieces) {
    switch_on(42);
    Bytes stream;
    for (const std::uint8_t content : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
        const Bytes frame = encode_rtcm3(Bytes(150, content));
        stream.insert(stream.end(), frame.begin(), frame.end());
    }
    run(1s);
    const auto before = receiver->port_status(PortId::uart1).messages_in[2];
    for (std::size_t at = 0; at < stream.size(); at += 100) {
        DronecanRtcmStream piece;
        piece.data.assign(stream.begin() + static_cast<std::ptrdiff_t>(at),
                          stream.begin() + static_cast<std::ptrdiff_t>(std::min(at + 100, stream.size())));
        say(piece);
        run(20ms);
    }
    EXPECT_EQ(receiver->port_status(PortId::uart1).messages_in[2], before + 3);
}

TEST_F(DronecanNode, HasAHeadingOfItsPair) {
    world = [](GpsTime time) {
        Epoch epoch{driving_fix(time)};
        epoch.relative = RelativePosition{};
        epoch.relative->north_m = 0.6;
        epoch.relative->east_m = 0.8;
        epoch.relative->down_m = 0.1;
        epoch.relative->deviation = Metres(0.01);
        return epoch;
    };
    switch_on(42);
    run(1s);
    ASSERT_THAT(all<DronecanRelPosHeading>(), testing::Not(IsEmpty()));
    const DronecanRelPosHeading relative = all<DronecanRelPosHeading>().back();
    EXPECT_NEAR(relative.heading, 53.13, 0.01);
    EXPECT_NEAR(relative.distance, std::sqrt(1.01), 1e-3);
    EXPECT_NEAR(relative.down, 0.1, 1e-3);
    EXPECT_EQ(relative.accuracy_available, 1U);
    EXPECT_NEAR(relative.accuracy, 0.573, 0.001);
    EXPECT_THAT(all<DronecanHeading>(), IsEmpty());

    BoardProfile board = board_named("dronecan-generic");
    board.can.node_id = 42;
    board.can.two_antennas = true;
    came.clear();
    taken = {};
    start(std::move(board));
    run(1s);
    ASSERT_THAT(all<DronecanHeading>(), testing::Not(IsEmpty()));
    EXPECT_NEAR(all<DronecanHeading>().back().heading, 53.13 * std::numbers::pi / 180, 1e-3);
    EXPECT_THAT(all<DronecanRelPosHeading>(), IsEmpty());
}

TEST_F(DronecanNode, LosesNoFrameAtFiftyHertz) {
    rate_hz = 50;
    switch_on(42);
    run(10s);
    EXPECT_THAT(all<DronecanFix2>(), SizeIs(testing::AllOf(testing::Ge(497U), testing::Le(501U))));
    EXPECT_EQ(receiver->counters().messages_dropped, 0U);
    EXPECT_EQ(taken.counts().out_of_order, 0U);
}

TEST_F(DronecanNode, ShowsTheFaultsOfABus) {
    switch_on(42);
    FirmwareFaults faults;
    faults.no_node_status = true;
    receiver->set_faults(faults);
    run(3s);
    EXPECT_THAT(all<DronecanNodeStatus>(), IsEmpty());
    EXPECT_THAT(all<DronecanFix2>(), SizeIs(testing::Ge(14U)));
    faults = {};
    faults.shares_node_id = true;
    receiver->set_faults(faults);
    came.clear();
    run(2500ms);
    EXPECT_EQ(taken.counts().repeated + all<DronecanNodeStatus>().size(), 4U) << taken.counts().repeated << " of them";
    const auto infos = answers_to<DronecanGetNodeInfoResponse>(DronecanGetNodeInfoRequest{});
    EXPECT_GE(infos.size() + taken.counts().repeated, 2U);
}

}  // namespace
}  // namespace skyloop::firmware
