// The receiver's own part of faults: what is told against what it goes on with, and what befalls it.
#include <gtest/gtest.h>

#include "firmware/core/receiver.hpp"
#include "firmware/output_only/other_protocols.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "sample_epochs.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr UbxMessageId solution{0x01, 0x07}, version_poll{0x0A, 0x04};

// A receiver, a fix every second, and all bytes of its first UART.
struct BrokenReceiver {
    explicit BrokenReceiver(ReceiverOptions options = {}) : receiver(sample_ublox(), std::move(options)) {
        fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix, Constellation::gps, 1, 12);
        now = fix.time;
        receiver.start(now);
    }
    void wait(Nanoseconds length, const ReportEdit& edit = {}) {
        for (const GpsTime end = now + length; now < end;) {
            now += 5ms;
            if (now.time_since_epoch() % 1s == 0ns) {
                fix.time = now;
                receiver.on_epoch({fix}, edit);
            }
            for (const Receiver::Sent& sent : receiver.output(now))
                if (sent.port == PortId::uart1) bytes.insert(bytes.end(), sent.bytes.begin(), sent.bytes.end());
        }
    }
    void write(ByteSpan message) { receiver.input(PortId::uart1, message, now); }
    void set(std::uint32_t item, std::uint64_t value, std::uint8_t layers = 1) {
        CfgValset message;
        message.layers = layers;
        message.pairs = {{item, value}};
        write(encode_frame(message));
    }
    std::vector<NavPvt> solutions() const {
        std::vector<NavPvt> found;
        StreamSplitter splitter;
        for (const StreamPiece& piece : splitter.feed(bytes)) {
            const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
            if (frame && frame->id == solution) found.push_back(*decode_payload<NavPvt>(frame->payload));
        }
        return found;
    }
    Receiver receiver;
    Fix fix;
    GpsTime now;
    Bytes bytes;
};

void say_lost(NavigationState& state) {
    state.epoch.fix.type = FixType::none;
    state.fix_ok = false;
}

TEST(FirmwareFaults, AnswersPollsFromWhatItReportsAndGoesOnWithWhatItKnows) {
    BrokenReceiver r;
    r.wait(1500ms, say_lost);
    r.write(encode_frame(solution, {}));
    r.wait(200ms);
    ASSERT_EQ(r.solutions().size(), 1U);
    EXPECT_EQ(r.solutions()[0].fix_type, 0);
    EXPECT_EQ(r.receiver.state().epoch.fix.type, FixType::none);
    r.wait(1s);
    EXPECT_EQ(r.receiver.state().epoch.fix.type, FixType::fix_3d) << "nothing was lost";
    EXPECT_EQ(r.receiver.state().epoch_index, 1U);
}

// Messages leave when the epoch was, whatever time they report: those after a step back of an hour, too.
TEST(FirmwareFaults, SendsInTimeWhateverTimeItReports) {
    BrokenReceiver receiver;
    receiver.set(0x20910007, 1);  // CFG-MSGOUT-UBX_NAV_PVT_UART1
    receiver.wait(3s, [](NavigationState& state) { state.epoch.fix.time += 1h; });
    receiver.wait(3500ms);
    EXPECT_EQ(receiver.solutions().size(), 6U);
}

TEST(FirmwareFaults, EditsEachEpochOnce) {
    BrokenReceiver r;
    int calls = 0;
    r.wait(5s, [&](NavigationState&) { ++calls; });
    EXPECT_EQ(calls, 5);
}

TEST(FirmwareFaults, SendsTheBytesOfASoundReceiverWithoutFaults) {
    BrokenReceiver sound, told;
    for (BrokenReceiver* r : {&sound, &told})
        r->set(0x20910007, 1);
    told.receiver.set_faults({});
    sound.wait(5500ms);
    told.wait(5500ms, [](NavigationState&) {});
    EXPECT_EQ(sound.bytes, told.bytes);
    EXPECT_EQ(sound.solutions().size(), 5U);
}

TEST(FirmwareFaults, SwallowsItsBannerWhileItIsMute) {
    for (const bool mute : {false, true}) {
        BrokenReceiver r;
        FirmwareFaults faults;
        faults.mute = mute;
        r.receiver.set_faults(faults);
        r.receiver.happen(Reboot{}, r.now);
        r.wait(3s);
        EXPECT_EQ(r.bytes.empty(), mute);
    }
}

TEST(FirmwareFaults, RebootsWithoutABannerAndHearsAgainAfterwards) {
    BrokenReceiver r;
    r.receiver.happen(Reboot{StartKind::cold, false}, r.now);
    r.wait(100ms);
    r.write(encode_frame(version_poll, {}));
    r.wait(2s);
    EXPECT_TRUE(r.bytes.empty()) << "it booted as it was asked";
    r.write(encode_frame(version_poll, {}));
    r.wait(200ms);
    EXPECT_FALSE(r.bytes.empty());
}

TEST(FirmwareFaults, ForgetsEveryLayer) {
    BrokenReceiver r;
    r.set(0x30210001, 200, 7);
    r.wait(1s);
    EXPECT_EQ(r.receiver.settings().navigation_period, 200ms);
    r.receiver.happen(ForgetConfiguration{}, r.now);
    EXPECT_EQ(r.receiver.settings().navigation_period, 1s);
    r.receiver.happen(Reboot{}, r.now);
    EXPECT_EQ(r.receiver.settings().navigation_period, 1s) << "nothing was stored either";
}

TEST(FirmwareFaults, LosesWithTheBatteryWhatItKeptAndNotWhatIsInFlash) {
    BrokenReceiver r;
    r.set(0x30210001, 200, 3);  // CFG-RATE-MEAS, RAM and battery
    r.set(0x20110021, 8, 5);    // CFG-NAVSPG-DYNMODEL, RAM and flash
    r.wait(1s);
    r.receiver.happen(Reboot{StartKind::cold, true}, r.now);
    EXPECT_EQ(r.receiver.settings().navigation_period, 200ms) << "cold, and with a battery";
    r.receiver.happen(Reboot{StartKind::cold, true, true}, r.now);
    EXPECT_EQ(r.receiver.settings().navigation_period, 1s);
    EXPECT_EQ(r.receiver.persistent_text(), "flash CFG-NAVSPG-DYNMODEL 8\n");
}

TEST(FirmwareFaults, LosesWithTheBatteryWhatItsUserHadSavedOnlyWithoutFlash) {
    for (const bool flash : {true, false}) {
        BoardProfile board = sample_ublox();
        if (!flash) board.identity.software = "ROM SPG 5.10 (7b202e)";
        Receiver receiver(board, {});
        ASSERT_TRUE(receiver.configure({{0x30210001, 200}}));
        const GpsTime now = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500).time;
        receiver.start(now);
        receiver.happen(Reboot{StartKind::cold, true, true}, now);
        EXPECT_EQ(receiver.settings().navigation_period, flash ? 200ms : 1s);
    }
}

TEST(FirmwareFaults, GivesTheSpeedOfBeforeBackOnceAndNotOverAReboot) {
    BrokenReceiver r;
    const auto baud = [&] {
        r.wait(20ms);
        return r.receiver.baud(PortId::uart1);
    };
    r.receiver.happen(ForceBaud{9600}, r.now);
    EXPECT_EQ(baud(), 9600U);
    r.receiver.happen(ForceBaud{19200}, r.now);
    EXPECT_EQ(baud(), 19200U);
    r.receiver.happen(ForceBaud{9600, true}, r.now);
    EXPECT_EQ(baud(), 9600U);
    r.receiver.happen(ForceBaud{0}, r.now);
    EXPECT_EQ(baud(), 38400U);
    r.receiver.happen(ForceBaud{9600, true}, r.now);
    EXPECT_EQ(baud(), 38400U) << "it has been given another";
    r.receiver.happen(ForceBaud{0}, r.now);
    EXPECT_EQ(baud(), 38400U);
    r.receiver.happen(ForceBaud{9600}, r.now);
    r.receiver.happen(Reboot{}, r.now);
    EXPECT_EQ(baud(), 38400U) << "the speed was in RAM";
    r.receiver.happen(ForceBaud{0}, r.now);
    EXPECT_EQ(baud(), 38400U);
}

TEST(FirmwareFaults, TakesSettingsAtASpeedThatItCannotBeSetTo) {
    BrokenReceiver r;
    const auto verdict = [&] {
        r.wait(500ms);
        r.bytes.clear();
        r.set(0x20910007, 1);
        r.wait(500ms);
        StreamSplitter splitter;
        for (const StreamPiece& piece : splitter.feed(r.bytes))
            if (piece.kind == StreamKind::ubx && piece.bytes[2] == 0x05)
                return std::string(piece.bytes[3] == 1 ? "ACK" : "NAK");
        return std::string("none");
    };
    r.receiver.happen(ForceBaud{100'000}, r.now);
    EXPECT_EQ(verdict(), "ACK");
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 100'000U) << "other settings leave the speed alone";
    r.receiver.happen(ForceBaud{12'000'000}, r.now);
    EXPECT_EQ(verdict(), "ACK");
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 8'000'000U) << "the fastest of any UART";
    r.set(0x40520001, 9600);
    r.wait(500ms);
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 9600U) << "the client has set another";
    r.receiver.happen(ForceBaud{0}, r.now);
    r.wait(500ms);
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 9600U);
    r.receiver.happen(ForceBaud{2400}, r.now);
    r.wait(20ms);
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 2400U);
    r.receiver.happen(ForceBaud{0}, r.now);
    r.wait(20ms);
    EXPECT_EQ(r.receiver.baud(PortId::uart1), 9600U);
}

TEST(FirmwareFaults, KeepsAnswersInOrderWhenTheirDelayEnds) {
    BrokenReceiver r;
    FirmwareFaults slow;
    slow.answer_delay = Seconds(0.5);
    r.receiver.set_faults(slow);
    r.write(encode_frame(version_poll, {}));
    r.receiver.set_faults({});
    r.set(0x20910007, 1);
    r.wait(400ms);
    EXPECT_TRUE(r.bytes.empty()) << "the second answer waits for the first";
    r.wait(300ms);
    ASSERT_GT(r.bytes.size(), 4U);
    EXPECT_EQ(r.bytes[2], version_poll.message_class);
}

TEST(FirmwareFaults, ForgetsTheLatencyOfBeforeWhenItRestarts) {
    BrokenReceiver r;
    r.set(0x20910007, 1, 7);
    FirmwareFaults slow;
    slow.solution_delay = Seconds(30);
    r.receiver.set_faults(slow);
    r.wait(3s);
    r.receiver.set_faults({});
    r.receiver.happen(Reboot{}, r.now);
    r.wait(5s);
    EXPECT_GE(r.solutions().size(), 3U) << "what waited is lost, and nothing waits for it";
}

TEST(FirmwareFaults, LeavesSentencesThatItRefusesAlone) {
    BrokenReceiver r;
    FirmwareFaults faults;
    faults.refused = {{0xF1, 0x40}};
    const Bytes rates = to_bytes(
        Sentence("PUBX").text("40").text("GGA").text("0").text("1").text("0").text("0").text("0").text("0").finish());
    r.receiver.set_faults(faults);
    r.write(rates);
    r.wait(2s);
    EXPECT_TRUE(r.bytes.empty());
    r.receiver.set_faults({});
    r.write(rates);
    r.wait(2s);
    EXPECT_FALSE(r.bytes.empty()) << "GGA comes";
}

TEST(FirmwareFaults, HidesJammingWhereNoOtherMessageTellsIt) {
    for (const bool has_sec_sig : {false, true}) {
        BoardProfile board = sample_ublox();
        board.quirks.default_interference_monitor = true;
        if (has_sec_sig) board.messages.push_back({0x27, 0x09});
        Receiver receiver(board, {});
        Epoch epoch{sample_fix("2024-03-05T12:00:00Z", 47, 8, 500)};
        epoch.front_end.interference = Decibels(20);
        receiver.start(epoch.fix.time);
        for (const bool hidden : {false, true}) {
            FirmwareFaults faults;
            faults.jamming_hidden = hidden;
            receiver.set_faults(faults);
            epoch.fix.time += 1s;
            receiver.on_epoch(epoch, {});
            EXPECT_GE(receiver.state().monitors.jamming_state(), 2);
            EXPECT_EQ(receiver.state().monitors.told_jamming_state() >= 2, has_sec_sig || !hidden);
        }
    }
}

// Dates and times of week stay.
TEST(FirmwareFaults, CountsWeeksApartInEveryMessageThatHasThem) {
    UbxReport r(9, "2024-03-10T00:00:00Z");  // time of week 18 s in GPS time, 4 s in BeiDou time
    const auto told = [&] {
        return std::vector<int>{r.report<NavTimegps>().week,      r.report<NavTimegal>().week,
                                r.report<NavSol>().week,          r.report<NavTimebds>().week,
                                r.report<NavTimeqzss>().week,     r.report<RxmRawx>().week,
                                r.report<RxmSvsi>().week,         r.report<TimTp>().week,
                                msp_sensor_gps(r.state).gps_week, mavlink_gps_input(r.state).time_week};
    };
    const std::vector<int> before = told();
    const auto pvt = r.report<NavPvt>();
    r.state.week_lag = Seconds(20);
    const std::vector<int> after = told();
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(after[i], before[i] - 1) << i;
    EXPECT_EQ(r.report<NavPvt>().day, pvt.day);
    EXPECT_EQ(r.report<NavPvt>().i_tow, pvt.i_tow);
}

// Between the ends of the GPS week and of BeiDou's, 14 s later, they differ.
TEST(FirmwareFaults, CountsTheWeekOfEachTimeScaleApartWhereThatEnds) {
    UbxReport r(9, "2024-03-09T23:59:43Z");  // 1 s of the GPS week, 13 s before BeiDou's ends
    r.state.week_lag = Seconds(2);
    const int gps = 2304, beidou = 948;  // of before
    EXPECT_EQ(r.report<NavTimegps>().week, gps);
    EXPECT_EQ(r.report<NavTimebds>().week, beidou);
    r.state.epoch.fix.time += 13s;  // BeiDou's first second
    EXPECT_EQ(r.report<NavTimegps>().week, gps + 1);
    EXPECT_EQ(r.report<NavTimebds>().tow, 0u);
    EXPECT_EQ(r.report<NavTimebds>().week, beidou);
    r.state.epoch.fix.time += 2s;
    EXPECT_EQ(r.report<NavTimebds>().week, beidou + 1);
    r.state.week_lag = Seconds(-2);
    r.state.epoch.fix.time -= 18s;  // 2 s before the end of the GPS week
    EXPECT_EQ(r.report<NavTimegps>().week, gps + 1);
    EXPECT_EQ(r.report<NavTimebds>().week, beidou);
}

// The receiver's clock may be in the week before, or milliseconds behind the instant at which the week number changes.
TEST(FirmwareFaults, CountsTheWeekOfRawMeasurementsApartAsThatOfTheEpoch) {
    UbxReport r(9, "2024-03-09T23:59:42Z");  // the GPS week begins
    const GpsTime begin = r.state.epoch.fix.time;
    r.state.epoch.observations.signals.emplace_back();
    const auto weeks = [&](Nanoseconds epoch, Nanoseconds bias, double lag) {
        r.state.epoch.fix.time = begin + epoch;
        r.state.epoch.observations.receive_time = begin + epoch + bias;
        r.state.week_lag = Seconds(lag);
        return std::pair(static_cast<int>(r.report<NavTimegps>().week), static_cast<int>(r.report<RxmRawx>().week));
    };
    EXPECT_EQ(weeks(1s, 200us, 2), std::pair(2304, 2304));
    EXPECT_EQ(weeks(2s, -200us, 2), std::pair(2305, 2305));
    EXPECT_EQ(weeks(-2s, -200us, -2), std::pair(2305, 2305));
    EXPECT_EQ(weeks(0s, -200us, 2), std::pair(2304, 2304));  // its own week has not ended
    EXPECT_EQ(weeks(0s, -4200us, 0), std::pair(2305, 2304));
    EXPECT_EQ(weeks(0s, -200us, 0), std::pair(2305, 2305));
}

}  // namespace
}  // namespace skyloop::firmware
