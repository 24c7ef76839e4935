// What the receiver does with what a client sends: answers, speeds, restarts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/core/receiver.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum Constellation;
using testing::HasSubstr;

constexpr UbxMessageId mon_ver_id{0x0A, 0x04}, nav_pvt_id{0x01, 0x07}, ack_id{0x05, 0x01}, nak_id{0x05, 0x00};

CfgValset valset(std::vector<ConfigPair> pairs, std::uint8_t layers = 1) {
    CfgValset message;
    message.layers = layers;
    message.pairs = std::move(pairs);
    return message;
}

Bytes payload_of(const UbxFrameView& frame) { return {frame.payload.begin(), frame.payload.end()}; }

// A receiver that has been on for long, its client on one port, and the time.
class Bench {
public:
    explicit Bench(BoardProfile board = sample_ublox(), ReceiverOptions options = {}, PortId port = PortId::uart1)
        : receiver_(std::move(board), options), port_(port) {
        fix_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix_, gps, 1, 12);
        now_ = fix_.time;
        receiver_.start(now_);
    }
    Receiver& receiver() { return receiver_; }
    [[nodiscard]] GpsTime now() const { return now_; }
    Bench& write(ByteSpan bytes) {
        receiver_.input(port_, bytes, now_);
        return *this;
    }
    template <class Message>
    Bench& send(const Message& message) {
        return write(encode_frame(message));
    }
    // Epochs of a second each, looked at every millisecond.
    Bench& wait(Nanoseconds length) {
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += 1ms;
            for (const Receiver::Sent& sent : receiver_.output(now_))
                if (sent.port == port_) keep(sent);
            if (now_.time_since_epoch() % 1s != 0ns) continue;
            fix_.time = now_;
            receiver_.on_epoch({fix_});
        }
        return *this;
    }
    [[nodiscard]] std::vector<UbxFrameView> frames(UbxMessageId id) const {
        std::vector<UbxFrameView> found;
        for (const StreamPiece& piece : pieces_)
            if (piece.kind == StreamKind::ubx)
                if (const auto frame = parse_frame(piece.bytes); frame->id == id) found.push_back(*frame);
        return found;
    }
    [[nodiscard]] std::string text() const {
        std::string text;
        for (const StreamPiece& piece : pieces_)
            if (piece.kind == StreamKind::nmea) text += to_string(piece.bytes);
        return text;
    }
    [[nodiscard]] const std::vector<Receiver::Sent>& sent() const { return sent_; }
    void forget() {
        pieces_.clear();
        sent_.clear();
    }

private:
    void keep(const Receiver::Sent& sent) {
        for (StreamPiece& piece : splitter_.feed(sent.bytes))
            pieces_.push_back(std::move(piece));
        if (sent_.empty() || sent_.back().baud != sent.baud)
            sent_.push_back(sent);
        else
            sent_.back().bytes.insert(sent_.back().bytes.end(), sent.bytes.begin(), sent.bytes.end());
    }
    Receiver receiver_;
    PortId port_;
    Fix fix_;
    GpsTime now_;
    StreamSplitter splitter_;
    std::vector<StreamPiece> pieces_;
    std::vector<Receiver::Sent> sent_;
};

TEST(ReceiverCommands, AnswersAPollOnceWithoutAcknowledgement) {
    Bench bench;
    bench.wait(1500ms).write(encode_frame(mon_ver_id, {})).wait(3s);
    EXPECT_EQ(bench.frames(mon_ver_id).size(), 1U);
    EXPECT_TRUE(bench.frames(ack_id).empty());
    EXPECT_TRUE(bench.frames(nak_id).empty());
}

TEST(ReceiverCommands, AnswersFromTheLastEpoch) {
    Bench bench;
    bench.wait(1500ms).write(encode_frame(nav_pvt_id, {})).wait(60ms);
    ASSERT_EQ(bench.frames(nav_pvt_id).size(), 1U);
    const auto pvt = decode_payload<NavPvt>(bench.frames(nav_pvt_id)[0].payload);
    ASSERT_TRUE(pvt);
    EXPECT_EQ(pvt->lat, 470000000);
    EXPECT_EQ(pvt->i_tow % 1000, 0U);
}

TEST(ReceiverCommands, SaysNothingToWhatItDoesNotKnowOutsideOfConfiguration) {
    Bench bench;
    bench.wait(100ms).write(encode_frame({0x0A, 0x77}, {})).write(encode_frame({0x33, 0x01}, Bytes(4))).wait(500ms);
    EXPECT_TRUE(bench.sent().empty());
    bench.write(encode_frame({0x06, 0x77}, {})).wait(500ms);
    EXPECT_EQ(bench.frames(nak_id).size(), 1U);
}

TEST(ReceiverCommands, AcknowledgesTheResetOfItsOdometer) {
    constexpr UbxMessageId nav_resetodo{0x01, 0x10};
    BoardProfile board = sample_ublox();
    board.messages.push_back(NavOdo::message_id);
    Bench bench(board);
    bench.wait(1100ms).write(encode_frame(nav_resetodo, {})).wait(200ms);
    ASSERT_EQ(bench.frames(ack_id).size(), 1U);
    EXPECT_EQ(payload_of(bench.frames(ack_id)[0]), (Bytes{0x01, 0x10}));
    Bench without;
    without.wait(1100ms).forget();
    without.write(encode_frame(nav_resetodo, {})).wait(200ms);
    EXPECT_TRUE(without.sent().empty()) << "a receiver without an odometer does not know the command";
}

TEST(ReceiverCommands, TakesNoPollWithAPayload) {
    Bench bench;
    bench.wait(1100ms).write(encode_frame(nav_pvt_id, Bytes{0})).write(encode_frame(mon_ver_id, Bytes{1})).wait(500ms);
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty());
    EXPECT_TRUE(bench.frames(mon_ver_id).empty());
}

TEST(ReceiverCommands, TellsThatThereIsNoBackup) {
    constexpr UbxMessageId sos = UpdSosStatus::message_id;
    BoardProfile board = sample_ublox();
    board.polled.insert(sos);
    Bench bench(board);
    bench.wait(100ms).write(encode_frame(sos, {})).wait(200ms);
    ASSERT_EQ(bench.frames(sos).size(), 1U);
    EXPECT_EQ(payload_of(bench.frames(sos)[0]), (Bytes{3, 0, 0, 0, 3, 0, 0, 0})) << "restored: no backup";
    bench.forget();
    bench.send(UpdSos{.cmd = 0, .reserved0 = {}}).wait(200ms);
    ASSERT_EQ(bench.frames(sos).size(), 1U);
    EXPECT_EQ(payload_of(bench.frames(sos)[0]), (Bytes{2, 0, 0, 0, 0, 0, 0, 0})) << "created: no";
    bench.send(UpdSos{.cmd = 1, .reserved0 = {}}).wait(200ms);
    ASSERT_EQ(bench.frames(ack_id).size(), 1U);
    EXPECT_EQ(payload_of(bench.frames(ack_id)[0]), (Bytes{0x09, 0x14}));
    bench.send(UpdSos{.cmd = 7, .reserved0 = {}}).write(encode_frame(sos, Bytes(5))).wait(200ms);
    EXPECT_EQ(bench.frames(nak_id).size(), 2U);
    Bench without;
    without.wait(100ms).write(encode_frame(sos, {})).wait(200ms);
    EXPECT_TRUE(without.sent().empty());
}

TEST(ReceiverCommands, AcknowledgesWithinFiftyMillisecondsUnloaded) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x20910007, 1}})).wait(50ms);
    ASSERT_EQ(bench.frames(ack_id).size(), 1U);
    EXPECT_EQ(bench.frames(ack_id)[0].payload[0], 0x06);
    EXPECT_EQ(bench.frames(ack_id)[0].payload[1], 0x8A);
    bench.wait(3s);
    EXPECT_EQ(bench.frames(nav_pvt_id).size(), 3U);
    EXPECT_EQ(bench.frames(ack_id).size(), 1U) << "never twice";
}

TEST(ReceiverCommands, RefusesAllOfAValsetWithOneUnknownKey) {
    Bench bench;
    bench.wait(300ms)
        .send(valset({{0x20910007, 1}, {0x30210001, 200}, {0x20FF0001, 1}, {0x20910039, 1}, {0x20110021, 4}}))
        .wait(2s);
    EXPECT_EQ(bench.frames(nak_id).size(), 1U);
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty());
    EXPECT_EQ(bench.receiver().settings().navigation_period, 1s);
    EXPECT_EQ(bench.receiver().settings().dynamic_model, DynamicModel::portable);
}

TEST(ReceiverCommands, ConfiguresMeasurementAndSolution) {
    Bench bench;
    bench.send(valset({{0x30210001, 200}, {0x20110021, 8}, {0x201100A4, 10}, {0x10310021, 0}, {0x20250038, 30}}))
        .wait(1s);
    const ReceiverSettings& settings = bench.receiver().settings();
    EXPECT_EQ(settings.navigation_period, 200ms);
    EXPECT_EQ(settings.dynamic_model, DynamicModel::airborne_4g);
    EXPECT_NEAR(settings.elevation_mask.deg(), 10, 1e-9);
    EXPECT_NEAR(settings.static_hold_below.value(), 0.3, 1e-9);
    EXPECT_TRUE(settings.tracks(gps, Signal::l1));
    EXPECT_FALSE(settings.tracks(galileo, Signal::l1));
    EXPECT_EQ(settings.restarts, 1) << "other signals: tracking begins anew";
}

TEST(ReceiverCommands, LooksForTheSbasSatellitesOfTheScanMaskAlone) {
    Bench bench;
    const ReceiverSettings& settings = bench.receiver().settings();
    EXPECT_EQ(settings.sbas_scan_mask, 0x72B88U);
    bench.wait(300ms).send(valset({{key::sbas_scan_mask, 0x8}, {0x10310020, 1}, {0x10310005, 1}})).wait(300ms);
    EXPECT_TRUE(settings.tracks({sbas, 23}, Signal::l1));
    EXPECT_FALSE(settings.tracks({sbas, 24}, Signal::l1));
    EXPECT_TRUE(settings.tracks({gps, 24}, Signal::l1));
    EXPECT_TRUE(settings.sbas_ranging);
    bench.send(valset({{0x10360003, 0}})).wait(300ms);
    EXPECT_FALSE(settings.sbas_ranging);
}

TEST(ReceiverCommands, SkipsMeasurementsWhenAskedForMoreThanItCanDo) {
    BoardProfile board = sample_ublox();
    board.max_rate_hz = 10;
    Bench bench(board);
    bench.send(valset({{0x30210001, 40}})).wait(1s);
    EXPECT_EQ(bench.receiver().settings().navigation_period, 120ms);
}

TEST(ReceiverCommands, ChangesTheSpeedWithItsAnswer) {
    const auto speeds = [](SpeedChangeAnswer answer) {
        BoardProfile board = sample_ublox();
        board.quirks.speed_change = answer;
        Bench bench(board);
        bench.wait(300ms).send(valset({{0x40520001, 115200}})).wait(100ms);
        std::vector<std::uint32_t> found;
        for (const Receiver::Sent& sent : bench.sent())
            found.push_back(sent.baud);
        EXPECT_EQ(bench.receiver().baud(PortId::uart1), 115200U);
        EXPECT_EQ(bench.receiver().baud(PortId::uart2), 38400U);
        return found;
    };
    EXPECT_EQ(speeds(SpeedChangeAnswer::at_new_speed), std::vector<std::uint32_t>{115200});
    EXPECT_EQ(speeds(SpeedChangeAnswer::at_old_speed), std::vector<std::uint32_t>{38400});
    EXPECT_TRUE(speeds(SpeedChangeAnswer::lost).empty());
}

// What is in the buffer goes on at the new speed, from a whole byte on.
TEST(ReceiverCommands, ChangesTheSpeedBetweenTwoBytes) {
    BoardProfile board = sample_ublox();
    board.baud = 9600;
    Bench bench(board);
    bench.send(valset({{0x209100AC, 1}, {0x209100BB, 1}})).wait(700ms);
    bench.wait(390ms);
    bench.forget();
    bench.send(valset({{0x40520001, 38400}})).wait(500ms);
    ASSERT_EQ(bench.sent().size(), 2U);
    EXPECT_EQ(bench.sent()[0].baud, 9600U);
    EXPECT_EQ(bench.sent()[1].baud, 38400U);
    EXPECT_FALSE(bench.frames(ack_id).empty());
}

TEST(ReceiverCommands, LosesWhatFollowsAChangeOfSpeedInOnePiece) {
    Bench bench;
    Bytes both = encode_frame(valset({{0x40520001, 115200}}));
    const Bytes second = encode_frame(valset({{0x20910007, 1}}));
    both.insert(both.end(), second.begin(), second.end());
    bench.wait(300ms).write(both).wait(3s);
    EXPECT_EQ(bench.frames(ack_id).size(), 1U);
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty());
}

TEST(ReceiverCommands, ShutsAClientOutThatTurnsItsProtocolOff) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x10730001, 0}})).wait(100ms);
    EXPECT_EQ(bench.frames(ack_id).size(), 1U);
    bench.write(encode_frame(mon_ver_id, {})).wait(500ms);
    EXPECT_TRUE(bench.frames(mon_ver_id).empty());
    Bench silent;
    silent.wait(300ms).send(valset({{0x10740001, 0}})).wait(500ms);
    EXPECT_TRUE(silent.frames(ack_id).empty());
}

TEST(ReceiverCommands, ShutsAClientOutThatSwitchesItsPortOff) {
    Bench bench;
    bench.wait(1500ms);
    bench.forget();
    bench.send(valset({{key::uart1_enabled, 0}})).wait(2s);
    bench.send(valset({{key::uart1_enabled, 1}})).wait(2s);
    EXPECT_TRUE(bench.sent().empty()) << "neither sentences nor answers nor texts";
    Bench other(sample_ublox(), {}, PortId::usb);
    other.send(valset({{key::uart1_enabled, 0}})).wait(100ms);
    EXPECT_EQ(other.frames(ack_id).size(), 1U) << "the others stay";
}

TEST(ReceiverCommands, KeepsItsPortsApart) {
    Bench bench(sample_ublox(), {}, PortId::usb);
    bench.wait(300ms).write(encode_frame(CfgMsgCurrentPort{0x01, 0x07, 1})).wait(2s);
    EXPECT_EQ(bench.frames(nav_pvt_id).size(), 2U);
    EXPECT_FALSE(bench.receiver().has(PortId::spi));
    EXPECT_EQ(bench.receiver().baud(PortId::spi), 0U);
    Bench other;
    other.receiver().input(PortId::usb, encode_frame(CfgMsgCurrentPort{0x01, 0x07, 1}), other.now());
    other.wait(2s);
    EXPECT_TRUE(other.frames(nav_pvt_id).empty());
}

TEST(ReceiverCommands, BeginsAnewAfterAHardwareResetAtTheStoredSpeedWithItsBanner) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x40520001, 115200}, {0x20910007, 1}})).wait(2s);
    bench.send(CfgRst{0xFFFF, 0, 0});
    bench.forget();
    bench.wait(100ms);
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 38400U);
    bench.write(encode_frame(mon_ver_id, {})).wait(3s);
    EXPECT_TRUE(bench.frames(mon_ver_id).empty()) << "it boots, and hears nothing";
    EXPECT_TRUE(bench.frames(ack_id).empty()) << "a reset is not acknowledged";
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty()) << "the configuration was in RAM alone";
    EXPECT_THAT(bench.text(), HasSubstr("$GNTXT,01,01,02,FWVER=SPG 4.04*"));
    EXPECT_EQ(bench.receiver().settings().start, StartKind::cold);
    EXPECT_EQ(bench.receiver().settings().restarts, 1);
}

TEST(ReceiverCommands, AResetCancelsATransaction) {
    constexpr std::uint32_t period = 0x30210001;
    Bench bench;
    CfgValset begin = valset({{period, 500}}), apply = valset({});
    begin.version = apply.version = 1;
    begin.transaction = 1;
    apply.transaction = 3;
    bench.wait(300ms).send(begin).wait(200ms).send(CfgRst{0, 9, 0}).wait(1500ms).send(apply).wait(200ms);
    EXPECT_EQ(bench.frames(nak_id).size(), 1U);
    EXPECT_EQ(bench.receiver().settings().navigation_period, 1s);
}

TEST(ReceiverCommands, StaysStoppedUntilItIsStarted) {
    constexpr std::uint32_t pvt_on_uart1 = 0x20910007, galileo = 0x10310021;
    Bench bench;
    bench.wait(300ms).send(valset({{pvt_on_uart1, 1}})).wait(2s).send(CfgRst{0, 8, 0}).wait(1s);
    bench.forget();
    bench.send(valset({{galileo, 0}})).wait(3s);
    EXPECT_EQ(bench.frames(ack_id).size(), 1U);
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty()) << "other signals start nothing";
    bench.send(CfgRst{0, 9, 0}).wait(3s);
    EXPECT_FALSE(bench.frames(nav_pvt_id).empty());
}

TEST(ReceiverCommands, ForgetsThePlaceWithoutTheTime) {
    Bench bench;
    bench.wait(2s).send(CfgRst{0x0010, 2, 0}).wait(100ms);
    EXPECT_EQ(bench.receiver().settings().start, StartKind::cold);
    EXPECT_TRUE(bench.receiver().state().time.date);
    EXPECT_TRUE(bench.receiver().state().time.leap_seconds);
    bench.send(CfgRst{0x0100, 2, 0}).wait(100ms);
    EXPECT_FALSE(bench.receiver().state().time.date) << "bit 8 is the clock";
}

TEST(ReceiverCommands, AcknowledgesARestartBeforeIt) {
    BoardProfile board = sample_ublox();
    board.maker = MakerKind::airoha;
    for (const int number : {4, 5, 6, 7}) {
        Bench bench(board);
        bench.wait(300ms).write(to_bytes(number == 4   ? "$PAIR004*3E\r\n"
                                         : number == 5 ? "$PAIR005*3F\r\n"
                                         : number == 6 ? "$PAIR006*3C\r\n"
                                                       : "$PAIR007*3D\r\n"));
        bench.wait(400ms);
        EXPECT_THAT(bench.text(), HasSubstr("$PAIR001,00" + std::to_string(number) + ",0*")) << number;
        EXPECT_EQ(bench.receiver().settings().restarts, 1);
    }
}

TEST(ReceiverCommands, AcknowledgesARestartAtTheOldSpeed) {
    BoardProfile board = sample_ublox();
    board.maker = MakerKind::airoha;
    Bench bench(board);
    const auto command = [](const char* body) { return to_bytes(Sentence(body).finish()); };
    bench.wait(300ms).write(command("PAIR864,0,0,115200")).wait(100ms).forget();
    bench.write(command("PAIR004")).wait(100ms);
    ASSERT_EQ(bench.sent().size(), 1U);
    EXPECT_EQ(bench.sent()[0].baud, 38400U);
    EXPECT_THAT(bench.text(), HasSubstr("$PAIR001,004,0*"));
    bench.wait(2s);
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 115200U);
}

TEST(ReceiverCommands, KeepsWhatIsInFlashOverAReset) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x20910007, 1}}, 5)).wait(500ms);
    bench.send(valset({{0x20910039, 1}}, 3)).wait(500ms).send(CfgRst{0, 0, 0});
    bench.forget();
    bench.wait(6s);
    EXPECT_FALSE(bench.frames(nav_pvt_id).empty());
    EXPECT_TRUE(bench.frames({0x01, 0x04}).empty()) << "the battery-backed layer is cleared with the hardware";
    bench.send(valset({{0x20910039, 1}}, 3)).wait(500ms).send(CfgRst{0, 1, 0});
    bench.forget();
    bench.wait(6s);
    EXPECT_FALSE(bench.frames({0x01, 0x04}).empty()) << "a software reset keeps it";
}

TEST(ReceiverCommands, KeepsPortsAndConfigurationWhenNavigationAloneRestarts) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x40520001, 115200}, {0x20910007, 1}})).wait(2s);
    bench.send(CfgRst{0x0001, 2, 0});
    bench.forget();
    bench.wait(5s);
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 115200U);
    EXPECT_GE(bench.frames(nav_pvt_id).size(), 4U);
    EXPECT_EQ(bench.text().find("FWVER"), std::string::npos);
    EXPECT_EQ(bench.receiver().settings().start, StartKind::warm);
}

TEST(ReceiverCommands, StopsAndStartsNavigation) {
    Bench bench;
    bench.wait(300ms).send(valset({{0x20910007, 1}})).wait(2s).send(CfgRst{0, 8, 0}).wait(200ms);
    EXPECT_THAT(bench.text(), HasSubstr("Stopping GNSS"));
    EXPECT_FALSE(bench.receiver().settings().navigating);
    bench.forget();
    bench.wait(3s);
    EXPECT_TRUE(bench.frames(nav_pvt_id).empty());
    bench.send(CfgRst{0, 9, 0}).wait(4s);
    EXPECT_TRUE(bench.receiver().settings().navigating);
    EXPECT_EQ(bench.receiver().settings().start, StartKind::hot);
    EXPECT_FALSE(bench.frames(nav_pvt_id).empty());
    EXPECT_TRUE(bench.frames(ack_id).empty()) << "neither is acknowledged";
}

TEST(ReceiverCommands, SaysWhoItIsWhenItIsSwitchedOn) {
    ReceiverOptions options;
    options.power_up = true;
    BoardProfile board = sample_ublox();
    board.timing.boot = Seconds(0.5);
    board.timing.first_epoch = Seconds(1.0);
    Bench bench(board, options);
    bench.wait(499ms);
    EXPECT_TRUE(bench.sent().empty());
    bench.wait(200ms);
    EXPECT_THAT(bench.text(), HasSubstr("$GNTXT,01,01,02,HELLO*"));
}

TEST(ReceiverCommands, RemembersOverTheEndOfTheProcess) {
    Bench bench;
    bench.send(valset({{0x20910007, 1}, {0x40520001, 57600}}, 4)).wait(500ms);
    const std::string stored = bench.receiver().persistent_text();
    Bench next;
    ASSERT_TRUE(next.receiver().restore(stored, "state"));
    EXPECT_EQ(next.receiver().baud(PortId::uart1), 57600U);
    next.wait(3500ms);
    EXPECT_EQ(next.frames(nav_pvt_id).size(), 3U);
    EXPECT_FALSE(next.receiver().restore("nonsense", "state"));
}

TEST(ReceiverCommands, BeginsAsItsUserHasSavedIt) {
    constexpr std::uint32_t pvt_on_uart1 = 0x20910007, baud = 0x40520001, period = 0x30210001;
    Bench bench;
    ASSERT_TRUE(bench.receiver().configure({{pvt_on_uart1, 1}, {baud, 57600}, {period, 500}}));
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 57600U);
    EXPECT_EQ(bench.receiver().settings().navigation_period, 500ms);
    bench.wait(3200ms);
    EXPECT_GE(bench.frames(nav_pvt_id).size(), 3U);
    bench.forget();
    bench.send(CfgRst{0xFFFF, 0, 0}).wait(3s);
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 57600U) << "no reset takes it away";

    const auto refused = [](const std::map<std::uint32_t, std::uint64_t>& items) {
        BoardProfile board = sample_ublox();
        board.absent_keys = {0x20030001};
        Bench other(std::move(board));
        const auto result = other.receiver().configure(items);
        return result ? std::string("taken") : result.error().message;
    };
    BoardProfile board = sample_ublox();
    board.maker = MakerKind::mute;
    Bench mute(std::move(board));
    EXPECT_TRUE(mute.receiver().configure({}));
    EXPECT_FALSE(mute.receiver().configure({{period, 500}})) << "no u-blox receiver";
    EXPECT_EQ(refused({{0x20920001, 7}}), "taken") << "an item of any group";
    EXPECT_THAT(refused({{0x20110021, 77}}), HasSubstr("CFG-NAVSPG-DYNMODEL is 77"));
    EXPECT_THAT(refused({{0x20030001, 1}}), HasSubstr("has no CFG-TMODE-MODE"));
    EXPECT_THAT(refused({{0x20FF0001, 1}}), HasSubstr("has no item 0x20ff0001"));
    std::map<std::uint32_t, std::uint64_t> none;
    for (const std::uint32_t system : {0x1031001FU, 0x10310021U, 0x10310022U, 0x10310025U})
        none[system] = 0;
    EXPECT_THAT(refused(none), HasSubstr("do not go together")) << "no system is left";
}

// Clients such as SparkFun's library switch systems alone and leave their signals as they are.
TEST(ReceiverCommands, HearsASystemThatIsSwitchedOnAlone) {
    constexpr std::uint32_t glonass_alone = 0x10310025, galileo_e1 = 0x10310007;
    constexpr UbxMessageId mon_gnss{0x0A, 0x28};
    BoardProfile board = sample_ublox();
    board.gnss_supported = 15;
    board.polled.insert(mon_gnss);
    ReceiverOptions options;
    options.settings.signals = {{gps, Signal::l1}, {galileo, Signal::l1}};
    Bench bench(board, options);
    EXPECT_EQ(bench.receiver().settings().signals, options.settings.signals);
    bench.send(valset({{glonass_alone, 1}})).wait(1s);
    EXPECT_TRUE(bench.receiver().settings().signals.contains({glonass, Signal::g1}));
    bench.send(valset({{galileo_e1, 0}})).wait(1s);
    EXPECT_FALSE(bench.receiver().settings().signals.contains({galileo, Signal::l1}));
    bench.write(encode_frame(mon_gnss, {})).wait(100ms);
    ASSERT_EQ(bench.frames(mon_gnss).size(), 1U);
    EXPECT_EQ(bench.frames(mon_gnss)[0].payload[3], 3) << "Galileo without a signal is not heard, and not announced";
}

TEST(ReceiverCommands, SaysThatItCannotFollowAPlanOfSignals) {
    constexpr std::uint32_t gps_alone = 0x1031001F, galileo_alone = 0x10310021;
    Bench bench(sample_ublox());
    bench.send(valset({{gps_alone, 0}, {galileo_alone, 0}})).wait(500ms);
    const std::string said = bench.text();
    EXPECT_THAT(said, HasSubstr("TXT,01,01,01,inv sig cfg*"));
    EXPECT_THAT(said, HasSubstr("TXT,01,01,01,bad cfg RAM*"));
    EXPECT_EQ(bench.frames(nak_id).size(), 1U);
    bench.forget();
    bench.send(valset({{0x20110021, 99}})).wait(500ms);
    EXPECT_EQ(bench.text().find("cfg"), std::string::npos) << "no such dynamic model, but the plan is good";
}

// Of signals that a board has no items for (`dual_frequency` of the scenario) its client cannot speak.
TEST(ReceiverCommands, KeepsTheScenariosSecondSignalsWhenSystemsAreSwitched) {
    constexpr std::uint32_t glonass_alone = 0x10310025, galileo_alone = 0x10310021, gps_l2c = 0x10310003,
                            galileo_e5b = 0x1031000A;
    BoardProfile board = sample_ublox();
    board.absent_keys = {gps_l2c, galileo_e5b};
    ReceiverOptions options;
    options.settings.signals = {{gps, Signal::l1}, {gps, Signal::l2}, {galileo, Signal::l1}, {galileo, Signal::e5b}};
    Bench bench(board, options);
    bench.send(valset({{glonass_alone, 1}})).wait(1s);
    std::set<SystemSignal> expected = options.settings.signals;
    expected.insert({glonass, Signal::g1});
    EXPECT_EQ(bench.receiver().settings().signals, expected);
    bench.send(valset({{galileo_alone, 0}})).wait(1s);
    std::erase_if(expected, [](const SystemSignal& s) { return s.constellation == galileo; });
    EXPECT_EQ(bench.receiver().settings().signals, expected);
}

TEST(ReceiverCommands, TellsOfACorrectionThatArrivesDamaged) {
    constexpr UbxMessageId rxm_rtcm{0x02, 0x32}, rxm_cor{0x02, 0x34};
    constexpr std::uint32_t rxm_rtcm_on_uart1 = 0x20910269, rxm_cor_on_uart1 = 0x209106B7,
                            rtcm3_into_uart1 = 0x10730004;
    BoardProfile board = sample_ublox();
    board.messages.push_back(rxm_rtcm);
    Bench bench(board);
    bench.send(valset({{rxm_rtcm_on_uart1, 1}, {rxm_cor_on_uart1, 1}, {rtcm3_into_uart1, 1}})).wait(1s).forget();
    Bytes frame = encode_rtcm3(Bytes{0x43, 0x50, 0x07, 0x01, 0x02, 0x03});
    frame[5] ^= 0x10;
    bench.write(frame).wait(100ms);
    ASSERT_EQ(bench.frames(rxm_rtcm).size(), 1u);
    EXPECT_EQ(bench.frames(rxm_rtcm)[0].payload[1], 1) << "crcFailed";
    frame[5] ^= 0x10;
    bench.write(frame).wait(100ms);
    ASSERT_EQ(bench.frames(rxm_rtcm).size(), 2u);
    EXPECT_EQ(bench.frames(rxm_rtcm)[1].payload[1] & 1, 0);
    ASSERT_EQ(bench.frames(rxm_cor).size(), 2u);
    EXPECT_EQ(bench.frames(rxm_cor)[1].payload[4] >> 5 & 3, 1) << "free of errors";
    bench.forget();
    bench.send(valset({{rtcm3_into_uart1, 0}})).wait(1s);
    frame[5] ^= 0x10;
    bench.write(frame).wait(100ms);
    EXPECT_TRUE(bench.frames(rxm_rtcm).empty()) << "a port that takes no RTCM looks for none";
}

TEST(ReceiverCommands, TellsWhenTheAntennaChanges) {
    BoardProfile board = sample_ublox();
    board.quirks.voltage_control = true;
    Receiver receiver(board, {});
    Epoch epoch{sample_fix("2024-03-05T12:00:00Z", 47, 8, 500)};
    receiver.start(epoch.fix.time);
    std::string text;
    for (const AntennaStatus status : {AntennaStatus::ok, AntennaStatus::short_circuit, AntennaStatus::short_circuit}) {
        epoch.fix.time += 1s;
        epoch.front_end.antenna = status;
        receiver.on_epoch(epoch);
        for (const Receiver::Sent& sent : receiver.output(epoch.fix.time + 900ms))
            if (sent.port == PortId::uart1) text += to_string(sent.bytes);
    }
    EXPECT_EQ(text, "$GNTXT,01,01,02,ANTSTATUS=SHORT*73\r\n");
}

TEST(ReceiverCommands, TellsTheAntennaAfterABannerThatDidNotKnowIt) {
    ReceiverOptions options;
    options.power_up = true;
    BoardProfile board = sample_ublox();
    board.quirks.voltage_control = true;
    board.identity.banner = {"HELLO", "ANTSTATUS=DONTKNOW"};
    Bench supervised(board, options);
    supervised.wait(5s);
    EXPECT_THAT(supervised.text(), HasSubstr("ANTSTATUS=OK*"));
    board.quirks.voltage_control = false;
    Bench other(board, options);
    other.wait(5s);
    EXPECT_THAT(other.text(), HasSubstr("ANTSTATUS=DONTKNOW*"));
    EXPECT_THAT(other.text(), testing::Not(HasSubstr("ANTSTATUS=OK*")));
}

}  // namespace
}  // namespace skyloop::firmware
