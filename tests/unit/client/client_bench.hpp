/// A scripted client on a bench: a clock that the test moves, and messages made by hand.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/time/utc_time.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "run/client/open_client.hpp"

namespace skyloop::test {

inline const GpsTime bench_start = to_gps_time(2407, 100000);

/// What a sound receiver would say at `now`, moving north at 10 m/s since bench_start's time of the day.
struct BenchSolution {
    explicit BenchSolution(GpsTime now) {
        constexpr Nanoseconds day = std::chrono::hours(24);
        const double since = to_seconds(((now - bench_start) % day + day) % day).value();
        const UtcTime utc = to_utc(now, LeapSeconds::announced());
        pvt.i_tow = static_cast<std::uint32_t>(week_and_tow(now).tow.count() / 1'000'000);
        pvt.year = static_cast<std::uint16_t>(utc.year);
        pvt.month = static_cast<std::uint8_t>(utc.month);
        pvt.day = static_cast<std::uint8_t>(utc.day);
        pvt.hour = static_cast<std::uint8_t>(utc.hour);
        pvt.minute = static_cast<std::uint8_t>(utc.minute);
        pvt.second = static_cast<std::uint8_t>(utc.second);
        pvt.nano = static_cast<std::int32_t>(utc.nanosecond);
        pvt.valid = 7;
        pvt.fix_type = 3;
        pvt.flags = 1;
        pvt.num_sv = 12;
        pvt.lat = 474'000'000 + static_cast<std::int32_t>(since * 10 / 111'195.0 * 1e7);
        pvt.lon = 85'000'000;
        pvt.height = 500'000;
        pvt.h_acc = 800;
        pvt.v_acc = 1200;
        pvt.s_acc = 100;
        pvt.vel_n = 10'000;
        pvt.g_speed = 10'000;
        pvt.vehicle = NavPvtVehicle{};
    }
    NavPvt pvt;
};

/// The client and its clock, which looks every 10 ms as the emulator does.
class ClientBench {
public:
    explicit ClientBench(std::string_view name, GpsTime start = bench_start) : now(start) {
        auto opened = open_client(name);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
        client = std::move(*opened);
        look();
    }

    void look() {
        client->simulated_end()->tell_time(now);
        if (const auto belief = client->simulated_end()->new_belief()) beliefs.push_back(*belief);
        const Bytes sent = client->read();
        for (const StreamPiece& piece : splitter.feed(sent))
            heard.push_back(piece);
    }
    void pass(Nanoseconds span) {
        for (const GpsTime end = now + span; now < end;) {
            now += std::chrono::milliseconds(10);
            look();
        }
    }
    void say(ByteSpan bytes) {
        client->write(bytes);
        look();
    }
    template <class Message>
    void say(const Message& message) {
        say(ByteSpan(encode_frame(message)));
    }
    /// The messages of one class and id that the client has sent, and forgets them.
    std::vector<Bytes> take(UbxMessageId id) {
        std::vector<Bytes> taken;
        std::vector<StreamPiece> rest;
        for (StreamPiece& piece : heard) {
            const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
            if (frame && frame->id == id)
                taken.emplace_back(frame->payload.begin(), frame->payload.end());
            else
                rest.push_back(std::move(piece));
        }
        heard = std::move(rest);
        return taken;
    }
    [[nodiscard]] bool trusts() const { return !beliefs.empty() && beliefs.back().trusts; }
    [[nodiscard]] std::string reason() const { return beliefs.empty() ? "" : beliefs.back().reason; }
    [[nodiscard]] std::uint32_t speed() { return client->line().baud.value_or(0); }

    std::unique_ptr<Transport> client;
    GpsTime now;
    std::vector<ClientBelief> beliefs;
    std::vector<StreamPiece> heard;

private:
    StreamSplitter splitter;
};

/// A receiver that hears at one speed, acknowledges every setting and answers polls; it follows CFG-PRT.
class BenchReceiver {
public:
    explicit BenchReceiver(ClientBench& bench) : bench_(bench) {}

    std::uint32_t speed = 9600;
    bool has_pvt = true;                    // without: a receiver before protocol version 14
    std::set<UbxMessageId> old_messages{};  // that it was told to send
    bool answers_version = true, acknowledges = true, sends = true, mute = false;
    std::uint8_t solution_rate = 0;
    std::uint16_t period_ms = 1000;
    int settings = 0;  // of all messages that it was given
    std::function<void(NavPvt&)> edit{};

    /// Runs the client for a while, with epochs every 200 ms.
    void run(Nanoseconds span) {
        for (const GpsTime end = bench_.now + span; bench_.now < end;) {
            for (int i = 0; i < 20; ++i) {
                bench_.pass(std::chrono::milliseconds(10));
                answer();
            }
            epoch();
        }
    }

private:
    void speak(const Bytes& bytes) {
        if (!mute && bench_.speed() == speed) bench_.say(ByteSpan(bytes));
    }
    void epoch() {
        if (!sends || solution_rate == 0) return;
        NavPvt pvt = BenchSolution(bench_.now).pvt;
        if (edit) edit(pvt);
        if (has_pvt)
            speak(encode_frame(pvt));
        else
            speak_in_parts(pvt);
    }
    void speak_in_parts(const NavPvt& pvt) {
        if (old_messages.contains(NavPosllh::message_id))
            speak(encode_frame(NavPosllh{pvt.i_tow, pvt.lon, pvt.lat, pvt.height, pvt.h_msl, pvt.h_acc, pvt.v_acc}));
        NavSol solution;
        solution.i_tow = pvt.i_tow;
        solution.gps_fix = pvt.fix_type;
        solution.flags = pvt.flags;
        solution.num_sv = pvt.num_sv;
        speak(encode_frame(solution));
        NavVelned velocity;
        velocity.i_tow = pvt.i_tow;
        velocity.vel_n = pvt.vel_n / 10;
        velocity.vel_e = pvt.vel_e / 10;
        velocity.vel_d = pvt.vel_d / 10;
        velocity.s_acc = pvt.s_acc / 10;
        if (old_messages.contains(NavVelned::message_id)) speak(encode_frame(velocity));
        if (old_messages.contains(NavTimeutc::message_id))
            speak(encode_frame(NavTimeutc{pvt.i_tow, 50, pvt.nano, pvt.year, pvt.month, pvt.day, pvt.hour, pvt.minute,
                                          pvt.second, pvt.valid}));
    }
    void answer() {
        std::vector<StreamPiece> heard = std::exchange(bench_.heard, {});
        if (bench_.speed() != speed) return;
        for (const StreamPiece& piece : heard)
            if (const auto frame = parse_frame(piece.bytes)) obey(*frame);
    }
    void obey(const UbxFrameView& frame) {
        if (frame.id == MonVer::message_id) {
            if (answers_version) speak(encode_frame(MonVer{}));
            return;
        }
        ++settings;
        if (!has_pvt && frame.id == CfgMsg::message_id && frame.payload[0] == NavPvt::message_id.message_class &&
            frame.payload[1] == NavPvt::message_id.id)
            return speak(encode_frame(AckNak{frame.id.message_class, frame.id.id}));
        if (acknowledges) speak(encode_frame(AckAck{frame.id.message_class, frame.id.id}));
        if (frame.id == CfgPrt::message_id) speed = decode_payload<CfgPrt>(frame.payload)->ports.at(0).baud_rate;
        if (frame.id == CfgRate::message_id) rate(frame);
        if (frame.id == CfgMsg::message_id) message(frame);
    }
    void rate(const UbxFrameView& frame) {
        if (const auto set = decode_payload<CfgRate>(frame.payload))
            period_ms = set->meas_rate;
        else
            speak(encode_frame(CfgRate{period_ms, 1, 1}));
    }
    void message(const UbxFrameView& frame) {
        if (frame.payload.size() == 2) {
            speak(encode_frame(CfgMsg{frame.payload[0], frame.payload[1], {0, solution_rate, 0, 0, 0, 0}}));
            return;
        }
        const UbxMessageId id{frame.payload[0], frame.payload[1]};
        if (!has_pvt) old_messages.insert(id);
        if (id == (has_pvt ? NavPvt::message_id : NavSol::message_id)) solution_rate = frame.payload[2];
    }

    ClientBench& bench_;
};

}  // namespace skyloop::test
