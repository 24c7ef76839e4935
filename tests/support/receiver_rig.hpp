/// A receiver with a client at the other end of one of its ports, in simulated time.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/time/utc_time.hpp"
#include "firmware/core/receiver.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_fields.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop::test {

/// The boards of the source tree.
inline firmware::BoardProfile board_named(const std::string& name) {
    return *find_board(std::string(SKYLOOP_SOURCE_DIR "/boards/receivers/") + name + ".toml", {});
}

/// A fix with four systems in view, driving north.
inline Fix driving_fix(GpsTime time) {
    Fix fix;
    fix.time = time;
    fix.leap_seconds = 18;
    fix.type = FixType::fix_3d;
    fix.position = Geodetic::degrees(47.3977, 8.5456, 488);
    fix.geoid_undulation = Metres(47);
    fix.velocity = {8, 1, 0};
    fix.speed = MetresPerSecond(8.06);
    fix.course = Angle::degrees(7.1);
    fix.dop = {1.5, 1.3, 0.8, 1.0, 0.7, 0.5, 0.6};
    fix.horizontal_accuracy = Metres(1.2);
    fix.vertical_accuracy = Metres(1.8);
    fix.speed_accuracy = MetresPerSecond(0.1);
    fix.course_accuracy = Angle::degrees(1);
    fix.time_accuracy = Metres(3);
    for (const Constellation c :
         {Constellation::gps, Constellation::galileo, Constellation::beidou, Constellation::glonass})
        for (int number = 6; number < 14; ++number)
            fix.satellites.push_back({{c, number},
                                      Angle::degrees(45.0 * (number - 6)),
                                      Angle::degrees(10.0 + 8 * (number - 6)),
                                      DbHz(35.0 + number),
                                      true});
    return fix;
}

/// What the client heard, and when its last byte had come.
struct Heard {
    StreamPiece piece;
    GpsTime at;
    [[nodiscard]] bool is(UbxMessageId id) const {
        const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
        return frame && frame->id == id;
    }
};

/// Steps a receiver through time: an epoch whenever one is due, output at every step.
class ReceiverRig {
public:
    explicit ReceiverRig(firmware::BoardProfile board, firmware::ReceiverOptions options = {},
                         firmware::PortId port = firmware::PortId::uart1)
        : receiver_(std::move(board), std::move(options)), port_(port) {
        receiver_.start(now_);
        next_epoch_ = now_;
    }

    firmware::Receiver& receiver() { return receiver_; }
    [[nodiscard]] GpsTime now() const { return now_; }
    std::vector<Heard>& heard() { return heard_; }
    /// What fixes the next epochs bring.
    std::function<Epoch(GpsTime)> world = [](GpsTime time) { return Epoch{driving_fix(time)}; };

    void write(ByteSpan bytes) { receiver_.input(port_, bytes, now_); }
    template <class Message>
    void send(const Message& message) {
        write(encode_frame(message));
    }
    void poll(UbxMessageId id, ByteSpan payload = {}) { write(encode_frame(id, payload)); }

    void run(Nanoseconds length, Nanoseconds step = std::chrono::milliseconds(5)) {
        const GpsTime end = now_ + length;
        while (now_ < end) {
            now_ = std::min({end, now_ + step, next_epoch_ > now_ ? next_epoch_ : now_ + step});
            take_output();
            if (now_ < next_epoch_) continue;
            receiver_.on_epoch(world(now_));
            const Nanoseconds period = receiver_.settings().navigation_period;
            next_epoch_ = now_ - now_.time_since_epoch() % period + period;
        }
    }
    /// Messages of one kind among what was heard.
    [[nodiscard]] std::vector<Heard> of(UbxMessageId id) const {
        std::vector<Heard> found;
        std::copy_if(heard_.begin(), heard_.end(), std::back_inserter(found), [&](const Heard& h) { return h.is(id); });
        return found;
    }
    [[nodiscard]] std::string sentences() const {
        std::string text;
        for (const Heard& h : heard_)
            if (h.piece.kind == StreamKind::nmea) text += to_string(h.piece.bytes);
        return text;
    }
    [[nodiscard]] bool heard_ack(UbxMessageId of, bool positive = true) const {
        const UbxMessageId id{0x05, static_cast<std::uint8_t>(positive ? 1 : 0)};
        return std::any_of(heard_.begin(), heard_.end(), [&](const Heard& h) {
            return h.is(id) && h.piece.bytes[6] == of.message_class && h.piece.bytes[7] == of.id;
        });
    }

private:
    void take_output() {
        for (const firmware::Receiver::Sent& sent : receiver_.output(now_))
            if (sent.port == port_)
                for (StreamPiece& piece : splitter_.feed(sent.bytes))
                    heard_.push_back({std::move(piece), now_});
    }

    firmware::Receiver receiver_;
    firmware::PortId port_;
    GpsTime now_ = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    GpsTime next_epoch_;
    StreamSplitter splitter_;
    std::vector<Heard> heard_;
};

}  // namespace skyloop::test
