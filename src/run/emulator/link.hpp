/// One receiver port joined to one wire.
/// What faults do to the bytes of one wire, both ways.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/time/gps_time.hpp"
#include "firmware/core/receiver.hpp"
#include "run/fault/wire_damage.hpp"
#include "wire/transport/line_garbler.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// What has crossed one wire.
struct LinkCounters {
    std::uint64_t bytes_out = 0;      ///< taken by the wire while a client listened
    std::uint64_t bytes_unheard = 0;  ///< sent while nobody listened
    std::uint64_t bytes_lost = 0;     ///< the client did not read in time
    std::uint64_t bytes_garbled = 0;  ///< sent at another speed than the client's
    std::uint64_t bytes_in = 0;       ///< heard by the receiver
};

/// The line speed of a receiver's port, bit/s; nothing for a port that has none, such as USB.
using PortSpeed = std::optional<std::uint32_t>;

/// When the bytes of a client reach the receiver.
enum class InputPace {
    at_once,  ///< when the loop looks: the transport itself has brought them at the speed of the line
    line      ///< one after the other, at the speed of the client's line
};

/// Carries bytes between a receiver's port and a Transport, at the speeds that both ends have set.
///
/// State: bytes that are on their way to the receiver. A client's bytes follow each other without a gap at the speed
/// that its line had when they were read, ten bits each; on a port without a speed at 12 Mbit/s, the full speed of USB
/// 2.0. Of a client that writes without end no more is read ahead than a terminal's driver holds.
class Link {
public:
    Link(std::unique_ptr<Transport> transport, PortSpeed speed, InputPace pace = InputPace::at_once);

    /// Puts on the wire what the receiver has sent. What a slow client does not take is lost, as in an overrun UART.
    /// @param speed at which the bytes left
    /// @param at_rest the receiver has nothing more to send: the line goes idle after these bytes
    void send(ByteSpan bytes, PortSpeed speed, bool at_rest);
    /// Takes from the wire what the client has written since the last look. To be called before receive().
    void look(GpsTime now);
    /// The next of the client's bytes that have arrived by `now`, as a port of this speed hears them: nothing at all
    /// when there are no more, an empty piece for bytes of which nothing was heard. A port that has a speed is given
    /// one byte at a time, so that a command in them which changes the speed acts on the very next one.
    std::optional<Bytes> receive(PortSpeed speed, GpsTime now);
    /// When receive() has something to do next, if nothing more is written: a byte has arrived, or the line has rested
    /// for the time of one. Nothing where bytes arrive at once.
    [[nodiscard]] std::optional<GpsTime> next_arrival(PortSpeed speed) const;

    /// Pulls the plug, or puts it back: without it neither end hears the other.
    void set_plugged(bool plugged);
    [[nodiscard]] const Transport& transport() const { return *transport_; }
    [[nodiscard]] Transport& transport() { return *transport_; }
    /// As of Transport.
    [[nodiscard]] SimulatedEnd* simulated_end() const { return transport_->simulated_end(); }
    [[nodiscard]] const LinkCounters& counters() const { return counters_; }
    [[nodiscard]] bool connected() const { return connected_; }
    /// Nothing will ever cross it again.
    [[nodiscard]] bool ended() const { return !transport_->failure().empty(); }
    /// Bytes are on their way to the receiver.
    [[nodiscard]] bool input_pending() const { return !incoming_.empty(); }

private:
    struct Piece {
        Bytes bytes;
        PortSpeed speed;  ///< of the client's line; nothing: the receiver's own
        GpsTime read_at;
        std::size_t taken = 0;
    };
    // What the client's UART makes of the bytes at its own speed.
    Bytes heard_by_client(ByteSpan bytes, std::uint32_t receiver_baud, std::uint32_t client_baud, bool at_rest);
    void tell_speed(PortSpeed speed);
    static Nanoseconds byte_time_of(const Piece& piece, PortSpeed port);
    std::optional<Bytes> rest(GpsTime now);
    Bytes take_piece(const Piece& piece, PortSpeed speed, std::size_t count);

    std::unique_ptr<Transport> transport_;
    LineGarbler to_client_;
    LineGarbler to_receiver_;
    InputPace pace_;
    std::deque<Piece> incoming_;
    std::size_t waiting_ = 0;  // bytes in incoming_
    GpsTime line_free_{};      // when the client's line has carried all that was heard
    GpsTime rests_at_{};       // when it has rested after that for the time of a byte
    bool may_rest_ = false;    // nothing has come since the last look
    LinkCounters counters_;
    PortSpeed told_;  // to the wire
    bool connected_ = false;
    bool plugged_ = true;
};

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

}  // namespace skyloop::inline run
