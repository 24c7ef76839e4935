// A receiver that goes off and comes back: power save mode, RXM-PMREQ, CFG-PWR.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint8_t in_ram_alone = 1, kept_in_battery = 3;
constexpr std::uint32_t pmreq_backup = 2, pmreq_force = 4;
constexpr std::uint32_t woken_by_uart = 1u << 3, woken_by_spi = 1u << 7;

BoardProfile saver_board() {
    BoardProfile board = sample_ublox();
    board.ports.push_back(PortId::spi);
    board.power.save_modes = board.power.backup = true;
    board.timing.hot_start = Seconds(1.5);
    board.legacy[CfgPwr::message_id] = LegacyAnswer::apply;
    board.config[0x20910007] = 1;  // NAV-PVT on UART1
    return board;
}

// A receiver with its sky, its client and the time; epochs come as often as it wants them.
class PowerBench {
public:
    explicit PowerBench(BoardProfile board = saver_board()) : receiver_(std::move(board)) {
        fix_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix_, Constellation::gps, 1, 12);
        begin_ = now_ = fix_.time;
        receiver_.start(now_);
    }
    PowerBench& write(ByteSpan bytes, PortId port = PortId::uart1) {
        receiver_.input(port, bytes, now_);
        return *this;
    }
    template <class Message>
    PowerBench& send(const Message& message, PortId port = PortId::uart1) {
        return write(encode_frame(message), port);
    }
    PowerBench& set(std::vector<ConfigPair> pairs, std::uint8_t layers = in_ram_alone) {
        CfgValset message;
        message.layers = layers;
        message.pairs = std::move(pairs);
        return send(message);
    }
    PowerBench& wait(Nanoseconds length, Nanoseconds step = 1ms) {
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += step;
            for (const Receiver::Sent& sent : receiver_.output(now_))
                if (sent.port == PortId::uart1)
                    for (StreamPiece& piece : splitter_.feed(sent.bytes))
                        keep(piece);
            if (now_.time_since_epoch() % receiver_.settings().navigation_period != 0ns) continue;
            Fix fix = fix_;
            fix.time = now_;
            if (!receiver_.settings().navigating || !sky) {
                fix.type = FixType::none;
                fix.satellites.clear();
            }
            receiver_.on_epoch({fix});
        }
        return *this;
    }
    // What NAV-PVT has told since the last call: seconds since the start, psmState, and an asterisk with a fix.
    std::vector<std::string> solutions() { return std::exchange(solutions_, {}); }
    std::string texts() { return std::exchange(texts_, {}); }
    std::vector<UbxMessageId> ids() { return std::exchange(ids_, {}); }
    Receiver& receiver() { return receiver_; }
    [[nodiscard]] bool is_on() const { return receiver_.settings().navigating; }
    bool sky = true;

private:
    void keep(const StreamPiece& piece) {
        if (piece.kind == StreamKind::nmea) texts_ += to_string(piece.bytes);
        if (piece.kind != StreamKind::ubx) return;
        const auto frame = parse_frame(piece.bytes);
        ids_.push_back(frame->id);
        if (frame->id == MonSys::message_id) boot_type = decode_payload<MonSys>(frame->payload)->boot_type;
        if (frame->id != NavPvt::message_id) return;
        const auto pvt = decode_payload<NavPvt>(frame->payload);
        const auto since = std::chrono::milliseconds(pvt->i_tow) - week_and_tow(begin_).tow;
        const double seconds = std::chrono::duration<double>(since).count();
        std::string text = seconds == std::floor(seconds) ? std::to_string(static_cast<int>(seconds))
                                                          : std::to_string(static_cast<int>(seconds)) + ".5";
        solutions_.push_back(text + " " + std::to_string(pvt->flags >> 2 & 7) + ((pvt->flags & 1) != 0 ? "*" : ""));
    }
    Receiver receiver_;
    Fix fix_;
    GpsTime begin_, now_;
    StreamSplitter splitter_;
    std::vector<std::string> solutions_;
    std::vector<UbxMessageId> ids_;
    std::string texts_;

public:
    int boot_type = -1;
};

using SolutionsTold = std::vector<std::string>;
constexpr UbxMessageId version_id{0x0A, 0x04}, acknowledged{0x05, 0x01}, refused{0x05, 0x00};

TEST(ReceiverPower, IsFullFromTheFactoryOn) {
    PowerBench bench;
    EXPECT_EQ(bench.wait(2500ms).solutions(), (SolutionsTold{"1 0*", "2 0*"}));
    EXPECT_FALSE(bench.receiver().next_change());
}

TEST(ReceiverPower, GoesOnAndOff) {
    PowerBench bench;
    bench.set(
        {{key::pm_operate_mode, 1}, {key::pm_update_period, 20}, {key::pm_on_time, 2}, {key::pm_update_ephemerides, 0}},
        kept_in_battery);
    bench.wait(10s);
    EXPECT_EQ(bench.solutions(), (SolutionsTold{"0.5 1*", "1 2*", "1.5 3*", "2 3*", "3 3*", "4 3*"}));
    EXPECT_FALSE(bench.is_on());
    EXPECT_EQ(bench.receiver().state().power_save, PowerSaveState::inactive);
    EXPECT_FALSE(bench.receiver().state().fix_ok);
    EXPECT_FALSE(bench.receiver().report_time());
    ASSERT_TRUE(bench.receiver().next_change());
    // The grid is one of whole 20 s of UTC; a start of 0.4 s and a second to the first epoch.
    bench.wait(16s);
    EXPECT_EQ(bench.solutions(), (SolutionsTold{"21.5 1*", "22 2*", "22.5 3*", "23 3*", "24 3*", "25 3*"}));
    EXPECT_THAT(bench.texts(), HasSubstr("HELLO"));
    EXPECT_FALSE(bench.is_on());
}

TEST(ReceiverPower, ForgetsBeingOnAndOffWithItsRam) {
    PowerBench bench;
    bench.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 20}});
    bench.wait(25s).solutions();
    EXPECT_EQ(bench.wait(2s).solutions(), (SolutionsTold{"25 0*", "26 0*"})) << "as from the factory";
    BoardProfile board = saver_board();
    board.power.keeps_ram = true;
    PowerBench other(board);
    other.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 20}});
    other.wait(40s).solutions();
    EXPECT_FALSE(other.wait(15s).solutions().empty());
    EXPECT_EQ(other.receiver().state().power_save, PowerSaveState::inactive);
}

TEST(ReceiverPower, TriesAgainWithoutSky) {
    PowerBench bench;
    bench.set({{key::pm_operate_mode, 1}, {key::pm_search_period, 60}}, kept_in_battery);
    bench.sky = false;
    bench.wait(40s);
    EXPECT_EQ(bench.solutions().size(), 32u);
    EXPECT_FALSE(bench.is_on());
    bench.wait(18500ms);
    EXPECT_FALSE(bench.is_on());
    bench.wait(1s);
    EXPECT_TRUE(bench.is_on()) << "a second ahead of the minute";
}

TEST(ReceiverPower, IsWokenByItsUart) {
    BoardProfile board = saver_board();
    board.identity.banner.assign(20, "A TEXT THAT TAKES ITS TIME");
    PowerBench bench(board);
    bench.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 0}}, kept_in_battery);
    bench.wait(10s).solutions();
    ASSERT_FALSE(bench.is_on());
    const Bytes poll = encode_frame(version_id, {});
    // It hears the edge alone, and what comes half a second later.
    bench.write(poll).wait(390ms).write(poll).ids();
    bench.wait(20ms).texts();
    bench.wait(100ms);
    EXPECT_THAT(bench.ids(), testing::Not(testing::Contains(version_id)));
    bench.write(poll).wait(1s);
    EXPECT_THAT(bench.ids(), testing::Contains(version_id));
    EXPECT_TRUE(bench.is_on());
}

TEST(ReceiverPower, IsLeftByTheUser) {
    PowerBench bench;
    bench.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 0}}, kept_in_battery);
    bench.wait(10s);
    ASSERT_FALSE(bench.is_on());
    bench.write(Bytes{0xFF}).wait(500ms).set({{key::pm_operate_mode, 0}}, kept_in_battery).wait(3s).solutions();
    EXPECT_EQ(bench.wait(2s).solutions().size(), 2u);
    EXPECT_EQ(bench.receiver().state().power_save, PowerSaveState::full_power);
}

TEST(ReceiverPower, StaysOnWhenItIsSwitchedOffWhileItFallsAsleep) {
    BoardProfile board = saver_board();
    board.baud = 9600;
    PowerBench bench(board);
    bench.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 20}, {0x20910018, 1}});
    bench.wait(1500ms + 52ms);
    ASSERT_TRUE(bench.receiver().next_change()) << "its last epoch is still leaving";
    bench.set({{key::pm_operate_mode, 0}}).wait(5s);
    EXPECT_TRUE(bench.is_on());
    EXPECT_FALSE(bench.receiver().next_change());
}

TEST(ReceiverPower, TracksInCycles) {
    BoardProfile board = saver_board();
    board.identity.generation = 8;
    PowerBench bench(board);
    bench.set({{key::pm_operate_mode, 2}, {key::pm_update_period, 4}});
    bench.wait(17s);
    EXPECT_EQ(bench.solutions(), (SolutionsTold{"1 1*", "2 2*", "3 3*", "4 4*", "6 4*", "10 4*", "14 4*"}))
        << "by the grid of GPS time";
}

TEST(ReceiverPower, TellsItInNavStatus) {
    BoardProfile board = saver_board();
    PowerBench bench(board);
    bench.set({{key::pm_operate_mode, 2}, {0x2091001B, 1}});
    bench.wait(4500ms);
    ASSERT_EQ(bench.receiver().state().power_save, PowerSaveState::optimized);
    int told = -1;
    StreamSplitter splitter;
    bench.wait(500ms);
    for (const auto& sent : bench.receiver().output(bench.receiver().state().epoch.fix.time + 900ms))
        for (const StreamPiece& piece : splitter.feed(sent.bytes))
            if (const auto frame = parse_frame(piece.bytes); frame && frame->id == NavStatus::message_id)
                told = decode_payload<NavStatus>(frame->payload)->flags2 & 3;
    EXPECT_EQ(told, 2) << "optimized";
}

TEST(ReceiverPower, IsOffForAsLongAsItIsAsked) {
    PowerBench bench;
    bench.wait(2500ms).solutions();
    bench.send(RxmPmreqShort{5000, pmreq_backup}).wait(4990ms);
    EXPECT_FALSE(bench.is_on());
    EXPECT_TRUE(bench.solutions().empty());
    EXPECT_THAT(bench.ids(), testing::Not(testing::Contains(refused)));
    bench.wait(3s);
    EXPECT_TRUE(bench.is_on());
    EXPECT_EQ(bench.solutions(), (SolutionsTold{"9 0*", "10 0*"})) << "a hot start";
    EXPECT_THAT(bench.texts(), HasSubstr("FWVER"));
}

TEST(ReceiverPower, SendsFirstWhatWasToBeSent) {
    BoardProfile board = saver_board();
    board.baud = 9600;
    board.polled.insert(version_id);
    PowerBench bench(board);
    bench.wait(2500ms).ids();
    bench.write(encode_frame(version_id, {})).send(RxmPmreqShort{0, pmreq_backup}).wait(2s);
    EXPECT_THAT(bench.ids(), testing::Contains(version_id));
    EXPECT_FALSE(bench.is_on());
}

TEST(ReceiverPower, IsWokenByWhatWasNamed) {
    const auto woken = [](std::uint32_t sources, PortId port) {
        PowerBench bench;
        bench.wait(1500ms).send(RxmPmreq{0, {}, 0, pmreq_backup, sources}).wait(1s);
        EXPECT_FALSE(bench.is_on());
        EXPECT_FALSE(bench.receiver().next_change());
        bench.write(Bytes{0xFF}, port).wait(1ms);
        return bench.is_on();
    };
    EXPECT_TRUE(woken(woken_by_uart, PortId::uart1));
    EXPECT_FALSE(woken(woken_by_uart, PortId::spi));
    EXPECT_TRUE(woken(woken_by_spi, PortId::spi));
    EXPECT_FALSE(woken(woken_by_spi, PortId::uart1));
    EXPECT_FALSE(woken(0, PortId::uart1));
    EXPECT_FALSE(woken(woken_by_uart | woken_by_spi, PortId::uart2));
    EXPECT_FALSE(woken(woken_by_uart | woken_by_spi, PortId::i2c));
    EXPECT_FALSE(woken(0xFFFFFFFF, PortId::usb));
}

TEST(ReceiverPower, IgnoresRequestsThatMeanNothing) {
    const auto stays_on = [](PowerBench& bench) {
        bench.wait(1s);
        return bench.is_on();
    };
    PowerBench bench;
    bench.wait(1500ms);
    EXPECT_TRUE(stays_on(bench.send(RxmPmreqShort{1000, 0})));
    EXPECT_TRUE(stays_on(bench.send(RxmPmreq{1, {}, 1000, pmreq_backup, woken_by_uart})));
    EXPECT_TRUE(stays_on(bench.write(encode_frame(RxmPmreq::message_id, Bytes(9)))));
    EXPECT_TRUE(stays_on(bench.write(encode_frame(RxmPmreq::message_id, {}))));
    EXPECT_TRUE(stays_on(bench.send(RxmPmreqShort{1000, pmreq_backup}, PortId::usb))) << "USB is connected";
    EXPECT_FALSE(stays_on(bench.send(RxmPmreq{0, {}, 0, pmreq_backup | pmreq_force, woken_by_uart}, PortId::usb)));
    BoardProfile none = saver_board();
    none.power.backup = false;
    PowerBench other(none);
    EXPECT_TRUE(stays_on(other.wait(1500ms).send(RxmPmreqShort{1000, pmreq_backup})));
}

TEST(ReceiverPower, NeedsForceOnSomeBoards) {
    BoardProfile board = saver_board();
    board.power.backup_needs_force = true;
    PowerBench bench(board);
    EXPECT_TRUE(bench.wait(1500ms).send(RxmPmreqShort{0, pmreq_backup}).wait(1s).is_on());
    EXPECT_TRUE(bench.send(RxmPmreq{0, {}, 0, pmreq_backup, woken_by_uart}).wait(1s).is_on());
    EXPECT_FALSE(bench.send(RxmPmreq{0, {}, 0, pmreq_backup | pmreq_force, woken_by_uart}).wait(1s).is_on());
}

TEST(ReceiverPower, LosesItsRamAndKeepsItsBattery) {
    PowerBench bench;
    bench.set({{key::uart1_baudrate, 115200}});
    bench.wait(500ms).set({{0x20910007, 0}}, kept_in_battery).wait(1s).solutions();
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 115200u);
    bench.send(RxmPmreqShort{2000, pmreq_backup}).wait(6s);
    EXPECT_EQ(bench.receiver().baud(PortId::uart1), 38400u);
    EXPECT_TRUE(bench.solutions().empty()) << "NAV-PVT was switched off in battery-backed memory, too";
    EXPECT_EQ(bench.receiver().settings().start, StartKind::hot);
}

TEST(ReceiverPower, StartsWarmAfterHours) {
    PowerBench bench;
    bench.wait(1500ms).send(RxmPmreqShort{4 * 3600'000 + 1000, pmreq_backup});
    bench.wait(4h + 2s, 500ms);
    EXPECT_TRUE(bench.is_on());
    EXPECT_EQ(bench.receiver().settings().start, StartKind::warm);
}

TEST(ReceiverPower, TellsWhyItHasStarted) {
    BoardProfile board = saver_board();
    board.polled.insert(MonSys::message_id);
    PowerBench bench(board);
    bench.wait(1500ms).write(encode_frame(MonSys::message_id, {})).wait(100ms);
    EXPECT_EQ(bench.boot_type, 1);
    bench.send(RxmPmreqShort{1000, pmreq_backup}).wait(4s).write(encode_frame(MonSys::message_id, {})).wait(100ms);
    EXPECT_EQ(bench.boot_type, 5);
    for (const auto& [mode, boot_type] : {std::pair{0, 3}, std::pair{1, 6}, std::pair{4, 3}, std::pair{2, 3}}) {
        bench.send(CfgRst{0, static_cast<std::uint8_t>(mode), 0}).wait(4s);
        bench.write(encode_frame(MonSys::message_id, {})).wait(100ms);
        EXPECT_EQ(bench.boot_type, boot_type) << "after mode " << mode;
    }
}

TEST(ReceiverPower, IsOverruledByARequest) {
    PowerBench bench;
    bench.set({{key::pm_operate_mode, 1},
               {key::pm_update_period, 10},
               {key::pm_on_time, 100},
               {key::pm_update_ephemerides, 0}},
              kept_in_battery);
    bench.wait(5s).send(RxmPmreqShort{30'000, pmreq_backup}).wait(29s);
    EXPECT_FALSE(bench.is_on());
    bench.solutions();
    bench.wait(4s);
    EXPECT_EQ(bench.solutions().front(), "36.5 1*") << "and goes on as configured";
}

TEST(ReceiverPower, HasStatesOfCfgPwr) {
    const auto told = [](PowerBench& bench) {
        bench.wait(2s);
        const auto ids = bench.ids();
        return std::find(ids.begin(), ids.end(), acknowledged) != ids.end();
    };
    PowerBench bench;
    bench.wait(1500ms).ids();
    EXPECT_TRUE(told(bench.send(CfgPwr{1, {}, power_stop})));
    EXPECT_FALSE(bench.is_on());
    bench.solutions();
    EXPECT_TRUE(told(bench.send(CfgPwr{1, {}, power_run}))) << "it still hears";
    EXPECT_TRUE(bench.is_on());
    EXPECT_FALSE(told(bench.send(CfgPwr{1, {}, 7})));
    EXPECT_FALSE(told(bench.send(CfgPwr{0, {}, power_stop})));
    EXPECT_TRUE(bench.is_on());
    EXPECT_TRUE(told(bench.send(CfgPwr{1, {}, power_backup}))) << "before it goes off";
    EXPECT_FALSE(bench.is_on());
    EXPECT_TRUE(bench.write(Bytes{0xFF}).wait(1ms).is_on());
    BoardProfile none = saver_board();
    none.legacy.erase(CfgPwr::message_id);
    PowerBench other(none);
    EXPECT_FALSE(told(other.wait(1500ms).send(CfgPwr{1, {}, power_stop})));
    EXPECT_TRUE(other.is_on());
}

TEST(ReceiverPower, IsRebootedFromOutside) {
    PowerBench bench;
    bench.wait(1500ms).send(RxmPmreqShort{0, pmreq_backup}).wait(1s);
    ASSERT_FALSE(bench.is_on());
    bench.receiver().happen(Reboot{}, bench.receiver().state().epoch.fix.time + 2s);
    EXPECT_TRUE(bench.wait(5s).is_on());
    EXPECT_FALSE(bench.solutions().empty());
}

TEST(ReceiverPower, DoesNotWakeADeafOne) {
    PowerBench bench;
    bench.wait(1500ms).send(RxmPmreqShort{0, pmreq_backup}).wait(1s);
    FirmwareFaults faults;
    faults.deaf = true;
    bench.receiver().set_faults(faults);
    EXPECT_FALSE(bench.write(Bytes{0xFF}).wait(1ms).is_on());
}

BoardProfile command_board(MakerKind kind) {
    BoardProfile board = sample_board(NmeaVersion::v2_3, {Constellation::gps});
    board.maker = kind;
    board.messages = {{0xF0, 0x00}, {0xF0, 0x04}};
    board.identity.banner = {"$PMTK011,MTKGPS", "$PMTK010,001", "$PMTK010,002"};
    board.identity.version_answers = {"$PAIR020,AG3352,1.2"};
    board.power.texts = {"$PMTK010,002"};
    board.power.keeps_ram = true;
    return board;
}

Bytes command(const std::string& body) { return to_bytes(Sentence(body).finish()); }

// Adafruit's library takes the acknowledgement for the one and PMTK010,002 for the other.
TEST(ReceiverPower, StandsByOnPmtk161UntilAByteComes) {
    PowerBench bench(command_board(MakerKind::mtk));
    EXPECT_THAT(bench.wait(3s).texts(), HasSubstr("$GPRMC"));
    bench.write(command("PMTK220,500")).wait(1s).texts();
    bench.write(command("PMTK161,0")).wait(500ms);
    EXPECT_THAT(bench.texts(), HasSubstr("$PMTK001,161,3*36\r\n"));
    EXPECT_FALSE(bench.is_on());
    EXPECT_EQ(bench.wait(10s).texts(), "");
    bench.write(to_bytes("\r\n")).wait(3s);
    const std::string woken = bench.texts();
    EXPECT_THAT(woken, testing::StartsWith("$PMTK010,002*2D\r\n"));
    EXPECT_THAT(woken, testing::Not(HasSubstr("PMTK011")));
    EXPECT_THAT(woken, HasSubstr("$GPRMC"));
    EXPECT_EQ(bench.receiver().settings().navigation_period, 500ms) << "it keeps its settings";
    bench.write(command("PMTK161,2")).wait(1s);
    EXPECT_THAT(bench.texts(), HasSubstr("$PMTK001,161,0"));
    EXPECT_TRUE(bench.is_on()) << "no such kind";
}

TEST(ReceiverPower, HearsCommandsWhileAiroha003KeepsItsTrackingOff) {
    PowerBench bench(command_board(MakerKind::airoha));
    EXPECT_THAT(bench.wait(3s).texts(), HasSubstr("$GPRMC"));
    bench.write(command("PAIR003")).wait(500ms).texts();  // the epoch under way still leaves
    EXPECT_EQ(bench.wait(5s).texts(), "");
    bench.write(command("PAIR020")).wait(1s);
    EXPECT_EQ(bench.texts(), Sentence("PAIR001,020,0").finish() + Sentence("PAIR020,AG3352,1.2").finish());
    EXPECT_EQ(bench.write(command("PAIR003")).wait(1s).texts(), Sentence("PAIR001,003,0").finish());
    bench.write(command("PAIR002")).wait(5s);
    const std::string again = bench.texts();
    EXPECT_THAT(again, testing::StartsWith(Sentence("PAIR001,002,0").finish()));
    EXPECT_THAT(again, HasSubstr("$GPRMC"));
    EXPECT_THAT(again, testing::Not(HasSubstr("TXT")));
}

TEST(ReceiverPower, GivesTheSameBytesHoweverOftenItIsLookedAt) {
    const auto run = [](Nanoseconds step) {
        PowerBench bench;
        bench.set({{key::pm_operate_mode, 1}, {key::pm_update_period, 15}}, kept_in_battery);
        bench.wait(60s, step);
        return bench.solutions();
    };
    EXPECT_EQ(run(1ms), run(500ms));
    EXPECT_FALSE(run(500ms).empty());
}

}  // namespace
}  // namespace skyloop::firmware
