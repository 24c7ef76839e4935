/// One receiver port joined to one wire.
#pragma once

#include <cstdint>
#include <memory>

#include "skyloop/transport/line_garbler.hpp"
#include "skyloop/transport/transport.hpp"

namespace skyloop {

/// What has crossed one wire.
struct LinkCounters {
    std::uint64_t bytes_out = 0;      ///< taken by the wire while a client listened
    std::uint64_t bytes_unheard = 0;  ///< sent while nobody listened
    std::uint64_t bytes_lost = 0;     ///< the client did not read in time
    std::uint64_t bytes_garbled = 0;  ///< sent at another speed than the client's
    std::uint64_t bytes_in = 0;
};

/// Carries bytes between a receiver's UART and a Transport, at the speeds that both ends have set.
class Link {
public:
    Link(std::unique_ptr<Transport> transport, std::uint32_t receiver_baud);

    /// Puts on the wire what the receiver has sent. What a slow client does not take is lost, as in an overrun UART.
    /// @param at_rest the receiver has nothing more to send: the line goes idle after these bytes
    void send(ByteSpan bytes, std::uint32_t receiver_baud, bool at_rest);
    /// What the client has sent, as the receiver's UART hears it.
    Bytes receive(std::uint32_t receiver_baud);

    [[nodiscard]] const Transport& transport() const { return *transport_; }
    [[nodiscard]] const LinkCounters& counters() const { return counters_; }
    [[nodiscard]] bool connected() const { return connected_; }

private:
    // What the client's UART makes of the bytes at its own speed.
    Bytes heard_by_client(ByteSpan bytes, std::uint32_t receiver_baud, std::uint32_t client_baud, bool at_rest);

    std::unique_ptr<Transport> transport_;
    LineGarbler to_client_;
    LineGarbler to_receiver_;
    LinkCounters counters_;
    bool connected_ = false;
};

}  // namespace skyloop
