/// What faults do to the bytes of one wire, both ways.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/receiver.hpp"
#include "run/fault/wire_damage.hpp"

namespace skyloop {

/// One wire of a receiver, between its port and its Link.
///
/// A sound wire hands on what it is given. While something is wrong with the way to the client, bytes enter it at whole
/// milliseconds of GPS time, at which the loop looks then: what becomes of them does not depend on how often it looks
/// besides. State: what is wrong, and the bytes that it holds.
class FaultyWire {
public:
    /// @param number of the wire at its receiver
    FaultyWire(std::uint64_t seed, std::size_t number);

    /// What is wrong from now on; bytes that left by now have been given before.
    void set(const WireConditions& conditions, GpsTime now);
    [[nodiscard]] const WireConditions& conditions() const { return conditions_; }
    /// What comes out towards the client by `now` when the receiver has sent these pieces of one port.
    std::vector<firmware::Receiver::Sent> to_client(std::vector<firmware::Receiver::Sent> sent, GpsTime now);
    /// What comes out towards the receiver by `now` when these bytes have entered.
    Bytes to_receiver(Bytes bytes, GpsTime now);
    /// The speed of the line, where it is not the receiver's.
    [[nodiscard]] std::optional<std::uint32_t> line_baud() const { return conditions_.receiver_baud; }
    /// When held bytes or garbage come out next. Both ways are to be looked at then: time stands still until they are.
    /// @param now of the last look
    [[nodiscard]] std::optional<GpsTime> next_at(GpsTime now) const;

    /// Something is wrong with the way to the client, or was and bytes are still held: it is looked at every
    /// millisecond.
    [[nodiscard]] bool damages_output() const;

private:
    WireConditions conditions_;
    WireDamage to_client_, to_receiver_;

    Bytes entering_;               // towards the client at the next whole millisecond
    std::uint32_t last_baud_ = 0;  // of the bytes that are held
    bool break_begins_ = false;
};

}  // namespace skyloop
