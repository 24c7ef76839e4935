#include "firmware/core/receiver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/core/random.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum Constellation;
using testing::EndsWith;
using testing::StartsWith;

// All that has left by `now`.
Bytes sent_by(Receiver& receiver, GpsTime now) {
    Bytes all;
    for (const Receiver::Sent& sent : receiver.output(now))
        all.insert(all.end(), sent.bytes.begin(), sent.bytes.end());
    return all;
}

Epoch epoch_at(int index, Nanoseconds period) {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    fix.time += index * period;
    add_satellites(fix, gps, 1, 12);
    return {fix};
}

constexpr UbxMessageId mon_ver_poll{0x0A, 0x04}, refusal_id{0x05, 0x00};

std::size_t frames_of(UbxMessageId id, ByteSpan bytes) {
    std::size_t count = 0;
    for (const StreamPiece& piece : StreamSplitter().feed(bytes))
        count += piece.kind == StreamKind::ubx && parse_frame(piece.bytes)->id == id ? 1U : 0U;
    return count;
}

// A u-blox receiver that has been on for long, and what a client writes to it and hears of it.
struct Asked {
    Asked() { receiver.start(now); }
    void write(ByteSpan bytes) { receiver.input(PortId::uart1, bytes, now); }
    void wait(Nanoseconds length) {
        now += length;
        const Bytes sent = sent_by(receiver, now);
        heard.insert(heard.end(), sent.begin(), sent.end());
    }
    Receiver receiver{sample_ublox()};
    GpsTime now = epoch_at(0, 1s).fix.time;
    Bytes heard;
};

// RECEIVER.md 1.3: only what fails its checksum is searched once more.
TEST(Receiver, ExecutesAFrameThatHoldsAnotherAndNotThatOne) {
    Asked asked;
    Bytes payload{0, 0, 0, 0};  // of CFG-VALGET; keys that no receiver has
    const Bytes poll = encode_frame(mon_ver_poll, {});
    payload.insert(payload.end(), poll.begin(), poll.end());
    for (const std::uint8_t byte : encode_frame(UbxMessageId{0x06, 0x8B}, payload)) {
        asked.write(ByteSpan(&byte, 1));
        asked.wait(1ms);
    }
    asked.wait(3s);
    EXPECT_EQ(frames_of(refusal_id, asked.heard), 1U);
    EXPECT_EQ(frames_of(mon_ver_poll, asked.heard), 0U);
}

TEST(Receiver, IsHeldByAFalseBeginningForAMomentOnly) {
    const Bytes false_beginning{0xB5, 0x62, 0x06, 0x8A, 0x00, 0x08};  // of 2048 bytes
    const Bytes poll = encode_frame(mon_ver_poll, {});
    Asked waiting;
    waiting.write(false_beginning);
    waiting.write(poll);
    waiting.wait(99ms);
    EXPECT_EQ(frames_of(mon_ver_poll, waiting.heard), 0U);
    waiting.wait(100ms);
    EXPECT_EQ(frames_of(mon_ver_poll, waiting.heard), 1U);

    Asked hurrying;  // never silent for so long
    hurrying.write(false_beginning);
    for (int k = 0; k < 26; ++k) {
        hurrying.write(poll);
        hurrying.wait(50ms);
        if (k == 18) {
            EXPECT_EQ(frames_of(mon_ver_poll, hurrying.heard), 0U);
        }
    }
    EXPECT_GE(frames_of(mon_ver_poll, hurrying.heard), 5U);

    Asked late;  // looked at seldom: its answer was due all the same
    late.write(false_beginning);
    late.write(poll);
    late.wait(10s);
    EXPECT_EQ(frames_of(mon_ver_poll, late.heard), 1U);
}

TEST(Receiver, RoundsThePeriodToMillisecondsWithinTheBoardsRate) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.max_rate_hz = 18;
    board.default_rate_hz = 2;
    const auto period = [&](double rate) { return Receiver(board, {rate}).settings().navigation_period; };
    EXPECT_EQ(period(1), 1s);
    EXPECT_EQ(period(3), 333ms);
    EXPECT_EQ(period(18), 56ms);
    EXPECT_EQ(period(1000), 56ms);
    EXPECT_EQ(period(0), 500ms);
    EXPECT_EQ(period(-4), 500ms);
    EXPECT_EQ(period(std::nan("")), 500ms);
    EXPECT_EQ(period(1e-9), 65535ms);
}

TEST(Receiver, RemembersItsPlaceUnlessItStartsCold) {
    const auto started = [](StartKind kind) {
        ReceiverOptions options;
        options.settings.start = kind;
        Receiver receiver(sample_ublox(), options);
        receiver.remember(Geodetic::degrees(47, 8, 500), Metres(48));
        receiver.start(epoch_at(0, 1s).fix.time);
        return receiver.kept_state();
    };
    const auto warm = started(StartKind::warm);
    EXPECT_TRUE(warm->ever_had_fix && warm->position_known && warm->only_place_known);
    EXPECT_EQ(warm->epoch.fix.position.latitude, Angle::degrees(47));
    EXPECT_EQ(warm->epoch.fix.geoid_undulation, Metres(48));
    EXPECT_EQ(warm->epoch.fix.type, FixType::none);
    const auto cold = started(StartKind::cold);
    EXPECT_FALSE(cold->ever_had_fix || cold->position_known);
    EXPECT_EQ(cold->epoch.fix.position.latitude, Angle());
}

// With them it would refuse every setting from then on.
TEST(Receiver, RefusesStoredSettingsThatItWouldRefuse) {
    Receiver receiver(sample_ublox());
    const auto refusal = [&](const std::string& text) {
        const auto restored = receiver.restore(text, "state");
        return restored ? std::string("taken") : restored.error().message;
    };
    EXPECT_EQ(refusal("flash CFG-RATE-MEAS 500\nflash CFG-NAVSPG-DYNMODEL 99\n"),
              "state:2: CFG-NAVSPG-DYNMODEL is 99, which this receiver itself would refuse");
    EXPECT_THAT(refusal("battery CFG-SIGNAL-GPS_ENA 0\nbattery CFG-SIGNAL-GAL_ENA 0\nbattery CFG-SIGNAL-BDS_ENA 0\n"
                        "battery CFG-SIGNAL-GLO_ENA 0\n"),
                testing::AllOf(StartsWith("state: "), testing::HasSubstr("do not go together")));
    EXPECT_EQ(receiver.settings().navigation_period, 1s) << "nothing of a refused text is taken";
    EXPECT_EQ(refusal("flash CFG-RATE-MEAS 500\n"), "taken");

    BoardProfile board = sample_ublox();
    board.identity.software = "ROM SPG 5.10 (7b202e)";
    Receiver without_flash(board);
    EXPECT_EQ(without_flash.restore("battery CFG-RATE-MEAS 500\nflash CFG-RATE-NAV 2\n", "state").error().message,
              "state:2: layer 'flash', which this receiver does not have");
    EXPECT_TRUE(without_flash.restore("battery CFG-RATE-MEAS 500\n", "state"));

    board.maker = MakerKind::mtk;
    Receiver other(std::move(board));
    EXPECT_EQ(other.restore("battery CFG-RATE-MEAS 500\n", "state").error().message,
              "state:1: 'CFG-RATE-MEAS' is no configuration item of this receiver");
    EXPECT_TRUE(other.restore("battery fix_interval_ms 500\n", "state"));
    EXPECT_EQ(other.settings().navigation_period, 500ms);
}

TEST(Receiver, TakesAPeriodThatLeavesOutTheRestOfADivision) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.max_rate_hz = 18;
    const auto period = [&](std::uint64_t measurement_ms) {
        ConfigStore store(factory_config(board));
        store.set(in_ram, key::rate_meas, measurement_ms);
        return settings_of(store, board, {}).navigation_period;
    };
    EXPECT_EQ(period(56), 56ms);
    EXPECT_EQ(period(55), 55ms);
    EXPECT_EQ(period(50), 100ms);
}

TEST(Receiver, SolvesWithFewerSatellitesAboveARate) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.all_satellites_rate_hz = 5;
    EXPECT_EQ(Receiver(board, {5}).settings().most_satellites, 0U);
    EXPECT_EQ(Receiver(board, {10}).settings().most_satellites, 16U);
}

// RECEIVER.md 2.4: 32 from the factory on.
TEST(Receiver, OfUBloxSolvesWithAsManySatellitesAsItsConfigurationSays) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.maker = MakerKind::ublox;
    EXPECT_EQ(Receiver(board, {5}).settings().most_satellites, 32U);
    board.config[0x201100A2] = 20;
    EXPECT_EQ(Receiver(board, {5}).settings().most_satellites, 20U);
}

TEST(Receiver, HearsB1cOfBeidou3Alone) {
    BoardProfile board = sample_board(NmeaVersion::v4_11, {Constellation::beidou});
    board.maker = MakerKind::ublox;
    const SatelliteId beidou_2{Constellation::beidou, 7}, meo{Constellation::beidou, 21},
        geo{Constellation::beidou, 59};
    for (const bool b1c : {false, true}) {
        board.config[0x1031000D] = b1c ? 0 : 1;
        board.config[0x1031000F] = b1c ? 1 : 0;
        const ReceiverSettings settings = Receiver(board, {1}).settings();
        EXPECT_TRUE(settings.tracks(meo, Signal::b1i)) << b1c;
        EXPECT_EQ(settings.tracks(beidou_2, Signal::b1i), !b1c);
        EXPECT_EQ(settings.tracks(geo, Signal::b1i), !b1c);
        ReceiverOptions named{1};  // by a scenario
        named.settings.signals = {{Constellation::beidou, Signal::b1i}};
        EXPECT_EQ(Receiver(board, named).settings().tracks(beidou_2, Signal::b1i), !b1c);
    }
}

// RECEIVER.md 4.8, table of dynamic models.
TEST(Receiver, HasTheCeilingOfItsGeneration) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.identity.generation = 8;
    EXPECT_EQ(Receiver(board, {1}).settings().airborne_ceiling, Metres(50'000));
    board.identity.generation = 9;
    EXPECT_EQ(Receiver(board, {1}).settings().airborne_ceiling, Metres(80'000));
}

TEST(Receiver, BeginsOneLatencyAfterTheEpoch) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.solution_latency = Seconds(0.07);
    Receiver receiver(board, {1});
    const Epoch epoch = epoch_at(0, 1s);
    receiver.on_epoch(epoch);
    const GpsTime first = epoch.fix.time + 70ms + 1'041'667ns;
    EXPECT_TRUE(sent_by(receiver, first - 1ns).empty());
    EXPECT_EQ(to_string(sent_by(receiver, first)), "$");
    const std::string rest = to_string(sent_by(receiver, *receiver.drained_at()));
    EXPECT_THAT(rest, StartsWith("GPRMC,120000.00,A,"));
    EXPECT_THAT(rest, EndsWith("\r\n"));
    EXPECT_EQ(receiver.drained_at(), std::nullopt);
    EXPECT_EQ(receiver.counters().messages_sent, 10U);
    EXPECT_EQ(receiver.counters().epochs, 1U);
}

TEST(Receiver, IsMute) {
    Receiver receiver(sample_board(NmeaVersion::v4_0, {gps}), {1});
    const GpsTime now = epoch_at(0, 1s).fix.time;
    receiver.input(PortId::uart1, to_bytes("\xb5\x62\x0a\x04"), now);
    receiver.input(PortId::uart1, to_bytes("$PUBX,00*33\r\n"), now);
    EXPECT_TRUE(sent_by(receiver, now + 10s).empty());
    EXPECT_EQ(receiver.counters().bytes_received, 17U);
}

// 10 Hz at 9600 baud: most of each epoch cannot be sent, and what is sent is whole.
TEST(Receiver, DropsWholeMessagesWhenTheLineIsTooSlow) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.transmit_buffer_bytes = 1000;
    board.quirks.overflow_notice = true;
    Receiver receiver(board, {10});
    StreamSplitter splitter;
    std::size_t sentences = 0, notices = 0;
    for (int i = 0; i < 100; ++i) {
        const Epoch epoch = epoch_at(i, 100ms);
        receiver.on_epoch(epoch);
        for (const StreamPiece& piece : splitter.feed(sent_by(receiver, epoch.fix.time + 100ms))) {
            const std::string line = to_string(piece.bytes);
            ASSERT_TRUE(parse_sentence(line)) << line;
            ++sentences;
            notices += line.starts_with("$GPTXT,01,01,00,txbuf alloc*7F") ? 1U : 0U;
        }
    }
    for (const StreamPiece& piece : splitter.feed(sent_by(receiver, *receiver.drained_at()))) {
        ASSERT_TRUE(parse_sentence(to_string(piece.bytes)));
        ++sentences;
    }
    EXPECT_EQ(sentences, receiver.counters().messages_sent);
    EXPECT_GT(receiver.counters().messages_dropped, 700U);
    EXPECT_GT(sentences, 100U);
    EXPECT_GT(notices, 5U);
}

TEST(Receiver, GivesTheSameBytesByTheSameTimeHoweverOftenItIsPolled) {
    RandomStream random(9, "receiver polling");
    for (const std::uint32_t baud : {4800U, 9600U, 115200U}) {
        BoardProfile board = sample_board(NmeaVersion::v4_10, {gps, glonass});
        board.baud = baud;
        board.transmit_buffer_bytes = 1500;
        Receiver often(board, {5}), seldom(board, {5});
        std::string by_often, by_seldom;
        for (int i = 0; i < 25; ++i) {
            const Epoch epoch = epoch_at(i, 200ms);
            often.on_epoch(epoch);
            seldom.on_epoch(epoch);
            const GpsTime end = epoch.fix.time + 200ms;
            for (GpsTime now = epoch.fix.time; now < end;) {
                now = std::min(end, now + Nanoseconds(random.bits() % 3'000'000));
                by_often += to_string(sent_by(often, now));
                if (now == end || random.uniform() < 0.03) {
                    by_seldom += to_string(sent_by(seldom, now));
                    ASSERT_EQ(by_often.size(), by_seldom.size());
                }
            }
        }
        EXPECT_EQ(by_often, by_seldom);
        EXPECT_EQ(often.counters().messages_dropped, seldom.counters().messages_dropped);
        EXPECT_EQ(often.counters().messages_dropped > 0, baud < 115200U);
    }
}

TEST(Receiver, SendsTimTpOncePerPulse) {
    constexpr UbxMessageId tim_tp{0x0D, 0x01};
    BoardProfile board = sample_ublox();
    board.messages = {tim_tp};
    const auto sent = [&](double rate, std::uint64_t every, std::uint32_t period_us) {
        board.config = {{find_output_message("TIM-TP")->i2c_key + 1, every}, {0x40050003, period_us}};
        Receiver receiver(board, {rate});
        const auto period = receiver.settings().navigation_period;
        for (int i = 0; i < 40; ++i)
            receiver.on_epoch(epoch_at(i, period));
        return sent_by(receiver, epoch_at(40, period).fix.time).size() / 24;
    };
    EXPECT_EQ(sent(10, 1, 1'000'000), 4U);
    EXPECT_EQ(sent(10, 2, 1'000'000), 2U);
    EXPECT_EQ(sent(10, 1, 500'000), 8U);
    EXPECT_EQ(sent(1, 1, 1'000'000), 40U);
    EXPECT_EQ(sent(1, 1, 100'000), 40U);
}

// A report leaves one solution latency after its epoch, to the first byte.
TEST(Receiver, TellsWhenTheReportOfAnEpochLeaves) {
    BoardProfile board = sample_board(NmeaVersion::v4_10, {gps});
    board.solution_latency = Seconds(0.07);
    Receiver receiver(board, {1});
    EXPECT_FALSE(receiver.report_time());
    const Epoch epoch = epoch_at(0, 1s);
    receiver.on_epoch(epoch);
    ASSERT_EQ(receiver.report_time(), epoch.fix.time + 70ms);
    EXPECT_TRUE(sent_by(receiver, epoch.fix.time + 69ms).empty());
    EXPECT_FALSE(sent_by(receiver, epoch.fix.time + 72ms).empty());

    receiver.on_epoch(epoch_at(1, 1s), [](NavigationState& state) { state.report_delay = Seconds(0.2); });
    EXPECT_EQ(receiver.report_time(), epoch.fix.time + 1270ms);
    receiver.on_epoch(epoch_at(2, 1s), [](NavigationState& state) { state.reports = 0; });
    EXPECT_FALSE(receiver.report_time());
    FirmwareFaults faults;
    faults.mute = true;
    receiver.set_faults(faults);
    receiver.on_epoch(epoch_at(3, 1s));
    EXPECT_FALSE(receiver.report_time());
}

}  // namespace
}  // namespace skyloop::firmware
