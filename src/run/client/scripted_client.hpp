/// The ground on which scripted clients stand: a wire whose other end lives in simulated time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "receiver/protocol/stream_splitter.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// A client of a receiver: hears its bytes cut into messages, speaks, has a line speed and a belief.
///
/// Its clock is the simulated time; of that it uses differences, and the date for what was known of calendars then. It
/// acts at whole multiples of 10 ms, on all that has arrived by then, so that what it does is the same however often
/// the loop looks at it.
class ScriptedClient : public Transport, public SimulatedEnd {
public:
    std::size_t write(ByteSpan bytes) final;
    Bytes read() final { return std::exchange(outbox_, {}); }
    LineState line() final { return {true, speed_}; }
    SimulatedEnd* simulated_end() final { return this; }
    void tell_time(GpsTime now) final;
    [[nodiscard]] std::optional<GpsTime> acts_at(GpsTime now) const final;
    std::optional<ClientBelief> new_belief() final { return std::exchange(news_, std::nullopt); }
    [[nodiscard]] std::string description() const final { return "client:" + name_; }

    /// What it believes at present.
    [[nodiscard]] const ClientBelief& belief() const { return belief_; }

protected:
    explicit ScriptedClient(std::string name) : name_(std::move(name)) {}

    /// It is switched on: the time is known for the first time.
    virtual void start() {}
    virtual void hear(const StreamPiece& piece) = 0;
    virtual void pass_time() = 0;

    [[nodiscard]] GpsTime now() const { return now_; }
    void send(ByteSpan bytes) { outbox_.insert(outbox_.end(), bytes.begin(), bytes.end()); }
    /// Bit/s; what was half heard at the old speed is forgotten.
    void set_speed(std::uint32_t speed);
    void believe(bool trusts, std::string reason);
    /// Frames whose checksum failed, and bytes in no frame, since the speed was set.
    [[nodiscard]] const StreamCounts& counts() const { return splitter_.counts(); }

private:
    std::string name_;
    StreamSplitter splitter_{StreamProtocols{.rtcm3 = false, .impatient = true}};
    Bytes inbox_;  // arrived since it acted last
    Bytes outbox_;
    std::uint32_t speed_ = 9600;
    GpsTime now_{};
    bool begun_ = false;
    ClientBelief belief_{false, "nothing heard yet"};
    std::optional<ClientBelief> news_;
};

}  // namespace skyloop::inline run
