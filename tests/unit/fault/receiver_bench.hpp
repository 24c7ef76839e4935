/// A receiver on a straight way north, its faults, and what its client hears of it.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../firmware/sample_epochs.hpp"
#include "base/geo/local_frame.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::fault_test {

using Given = std::map<std::string, ParameterValue, std::less<>>;

/// A fault as a scenario would make it. Parameters that are not right fail the test.
inline Result<Fault> make_fault(const std::string& kind, const Given& given, std::uint64_t seed = 1) {
    const FaultKind* found = find_fault_kind(kind);
    if (found == nullptr) return fail(ErrorCode::usage, "no kind " + kind);
    const CheckedParameters checked = check_parameters(found->parameters, given);
    for (const ParameterMistake& mistake : checked.mistakes)
        ADD_FAILURE() << mistake.name << " " << mistake.sentence;
    return found->make(checked.parameters, {seed, kind});
}

/// A receiver of u-blox 9 that has been on for long; all that the tests read is sent once an epoch, 1 Hz.
class ReceiverBench {
public:
    static constexpr double latitude = 47, longitude = 8, height_m = 500, speed_mps = 10;

    explicit ReceiverBench(const char* utc = "2024-03-05T12:00:00Z") : receiver_(board(), {}) {
        fix_ = firmware::sample_fix(utc, latitude, longitude, height_m);
        fix_.velocity = {speed_mps, 0, 0};
        fix_.speed = MetresPerSecond(speed_mps);
        fix_.course = Angle::degrees(0);
        firmware::add_satellites(fix_, Constellation::gps, 1, 12);
        firmware::add_satellites(fix_, Constellation::galileo, 1, 4);
        now_ = fix_.time;
        receiver_.start(now_);
        CfgValset wanted;
        wanted.layers = 1;
        for (const UbxMessageId id : asked)
            wanted.pairs.push_back({*firmware::rate_key(id, firmware::PortId::uart1), 1});
        send(wanted);
        wait(0.9);
        forget();
    }

    firmware::Receiver& receiver() { return receiver_; }
    Fix& fix() { return fix_; }
    std::optional<RelativePosition>& relative() { return relative_; }
    FrontEnd& front_end() { return front_end_; }

    template <class Message>
    void send(const Message& message) {
        receiver_.input(firmware::PortId::uart1, encode_frame(message), now_);
    }
    void poll(UbxMessageId id) { receiver_.input(firmware::PortId::uart1, encode_frame(id, {}), now_); }
    void say(ByteSpan bytes) { receiver_.input(firmware::PortId::uart1, bytes, now_); }

    void begin(const std::string& kind, const Given& given = {}, double strength = 1) {
        auto made = make_fault(kind, given);
        ASSERT_TRUE(made) << made.error().message;
        running_ = {std::move(*made), now_, strength};
        for (const firmware::ReceiverEvent& event : running_.fault.at_start)
            receiver_.happen(event, now_);
        look();
    }
    void end() {
        for (const firmware::ReceiverEvent& event : running_.fault.at_end)
            receiver_.happen(event, now_);
        running_ = {};
        look();
    }

    /// Time passes in hundredths of a second; epochs come at whole seconds of GPS time.
    void wait(double seconds) {
        using namespace std::chrono_literals;
        for (const GpsTime until = advanced(now_, Seconds(seconds)); now_ < until;) {
            now_ += 10ms;
            look();
            if (now_.time_since_epoch() % 1s == 0ns) epoch();
            for (const firmware::Receiver::Sent& sent : receiver_.output(now_))
                if (sent.port == firmware::PortId::uart1) hear(sent);
        }
    }
    /// What came since, from now on.
    void forget() {
        pieces_.clear();
        bauds_.clear();
    }

    template <class Message>
    [[nodiscard]] std::vector<Message> all() const {
        std::vector<Message> found;
        for (const StreamPiece& piece : pieces_) {
            if (piece.kind != StreamKind::ubx) continue;
            const auto frame = parse_frame(piece.bytes);
            if (frame && frame->id == Message::message_id)
                found.push_back(decode_payload<Message>(frame->payload).value());
        }
        return found;
    }
    template <class Message>
    [[nodiscard]] Message last() const {
        const std::vector<Message> found = all<Message>();
        if (!found.empty()) return found.back();
        ADD_FAILURE() << "nothing came";
        return {};
    }
    /// The NAV-PVT of one more epoch.
    NavPvt next() {
        wait(1);
        return last<NavPvt>();
    }
    [[nodiscard]] std::size_t count(UbxMessageId id) const {
        std::size_t number = 0;
        for (const StreamPiece& piece : pieces_)
            number += piece.kind == StreamKind::ubx && parse_frame(piece.bytes)->id == id ? 1U : 0U;
        return number;
    }
    /// Fields of the last sentence of a formatter, "GGA": field 0 is its address.
    [[nodiscard]] std::vector<std::string> sentence(const std::string& formatter) const {
        std::vector<std::string> fields;
        for (const StreamPiece& piece : pieces_) {
            const std::string text = to_string(piece.bytes);
            if (piece.kind != StreamKind::nmea || text.substr(3, 3) != formatter) continue;
            fields.clear();
            std::string field;
            for (const char c : text.substr(1, text.find('*') - 1) + ",")
                if (c == ',')
                    fields.push_back(std::exchange(field, {}));
                else
                    field += c;
        }
        if (fields.empty()) ADD_FAILURE() << "no " << formatter;
        fields.resize(20);
        return fields;
    }
    [[nodiscard]] std::size_t sentences() const {
        std::size_t number = 0;
        for (const StreamPiece& piece : pieces_)
            number += piece.kind == StreamKind::nmea ? 1U : 0U;
        return number;
    }
    [[nodiscard]] const std::vector<std::uint32_t>& bauds() const { return bauds_; }
    [[nodiscard]] std::size_t pieces() const { return pieces_.size(); }
    [[nodiscard]] GpsTime now() const { return now_; }
    /// Where NAV-PVT says that it is, against the true place: metres east, north, up.
    static Position<Enu> error(const NavPvt& pvt) {
        const Geodetic told = Geodetic::degrees(pvt.lat.value(), pvt.lon.value(), pvt.height.value());
        return LocalFrame(Geodetic::degrees(latitude, longitude, height_m)).to_enu(to_ecef(told));
    }

private:
    struct Running {
        Fault fault;
        GpsTime since{};
        double strength = 1;
    };

    static constexpr UbxMessageId asked[] = {{0x01, 0x07}, {0xF0, 0x00}, {0xF0, 0x04}, {0x01, 0x20},
                                             {0x01, 0x26}, {0x0A, 0x38}, {0x27, 0x09}, {0x01, 0x3C}};

    static firmware::BoardProfile board() {
        firmware::BoardProfile board = firmware::sample_ublox();
        board.baud = 115200;
        board.messages.assign(std::begin(asked), std::end(asked));
        board.quirks.default_interference_monitor = true;
        return board;
    }
    [[nodiscard]] FaultMoment moment() const {
        return {now_, difference(now_, running_.since), running_.strength, nullptr, nullptr};
    }
    void look() {
        firmware::FirmwareFaults faults;
        if (running_.fault.firmware) running_.fault.firmware(faults, moment());
        receiver_.set_faults(faults);
    }
    void epoch() {
        fix_.time = now_;
        Epoch epoch{fix_};
        epoch.relative = relative_;
        epoch.front_end = front_end_;
        if (running_.fault.epoch) running_.fault.epoch(epoch, moment());
        receiver_.on_epoch(epoch, [&](firmware::NavigationState& state) {
            if (running_.fault.report) running_.fault.report(state, moment());
        });
    }
    void hear(const firmware::Receiver::Sent& sent) {
        if (bauds_.empty() || bauds_.back() != sent.baud) bauds_.push_back(sent.baud);
        for (StreamPiece& piece : splitter_.feed(sent.bytes))
            pieces_.push_back(std::move(piece));
    }

    firmware::Receiver receiver_;
    Fix fix_;
    std::optional<RelativePosition> relative_;
    FrontEnd front_end_;
    GpsTime now_;
    Running running_;
    StreamSplitter splitter_;
    std::vector<StreamPiece> pieces_;
    std::vector<std::uint32_t> bauds_;
};

}  // namespace skyloop::fault_test
