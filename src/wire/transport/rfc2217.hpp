/// A serial port over the network whose client sets the line: RFC 2217, as pyserial's rfc2217:// and ser2net speak it.
/// The access server's side of a serial port over Telnet (RFC 2217), without its socket.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline wire {

/// What the client has made of the port. Numbers are those of RFC 2217, section 3.
struct ComPortSettings {
    std::optional<std::uint32_t> baud;  ///< bit/s; nothing until the client has set one
    std::uint8_t data_bits = 8;         ///< 5 … 8
    std::uint8_t parity = 1;            ///< 1 none, 2 odd, 3 even, 4 mark, 5 space
    std::uint8_t stop_bits = 1;         ///< 1; 2: two; 3: one and a half
    std::uint8_t flow = 1;              ///< 1 none, 2 XON/XOFF, 3 lines
    std::uint8_t inbound_flow = 14;     ///< 14 none, 15 XON/XOFF, 16 lines
    bool dtr = false, rts = false, sends_break = false;
    bool suspended = false;  ///< the client wants no data now
    bool operator==(const ComPortSettings&) const = default;
};

/// Takes a client's stream apart into data and commands, and answers the commands.
///
/// Telnet as of RFC 854 and 855: options binary (RFC 856), echo refused, suppress go ahead (RFC 858) and
/// COM-PORT-OPTION (44, RFC 2217); every other option is refused. An option that stands already is not answered again,
/// so that no negotiation runs in a circle. Commands of any content change nothing or what they say; a value that the
/// port cannot have is answered with the one that it has. A subnegotiation beyond 128 bytes is passed over. Answers
/// that nobody takes are kept up to 64 kB, further ones are dropped.
///
/// State: where in a command the stream is, the options, the settings, and what waits to be taken.
class ComPortServer {
public:
    /// @param signature what the port calls itself when asked (SIGNATURE)
    explicit ComPortServer(std::string signature) : signature_(std::move(signature)) {}

    /// Another client has come: settings, options and answers are those of a start, and the offer of the options waits
    /// among the answers. Data stays.
    void begin();
    /// Takes bytes from the client; gives how many. It stops where the client changes the speed while data of the old
    /// one has not been taken, and behind 64 commands.
    std::size_t receive(ByteSpan bytes);
    /// What the client has written for the device.
    Bytes take_data() { return std::exchange(data_, {}); }
    [[nodiscard]] std::size_t data_waiting() const { return data_.size(); }
    /// What is to be sent to the client before further data.
    Bytes take_answers() { return std::exchange(answers_, {}); }
    [[nodiscard]] const ComPortSettings& settings() const { return settings_; }
    /// The speed of a port of which none has been set, bit/s.
    void set_own_baud(std::uint32_t baud) { own_baud_ = baud; }
    /// True when both ends have agreed on COM-PORT-OPTION, in words or by a command of the client.
    [[nodiscard]] bool agreed() const { return agreed_; }
    /// Data as it goes to the client: each 255 twice (RFC 854, IAC).
    static Bytes escaped(ByteSpan data);

private:
    enum class State { data, command, option, sub, sub_command };
    struct Option {
        bool ours = false, theirs = false;
    };
    void take(std::uint8_t byte);
    void take_command(std::uint8_t byte);
    void take_sub(std::uint8_t byte);
    void negotiate(std::uint8_t verb, std::uint8_t option);
    void agree();
    Option* known(std::uint8_t option);
    void answer(ByteSpan bytes);
    void answer_option(std::uint8_t command, ByteSpan value);
    void answer_byte(std::uint8_t command, std::uint8_t value) { answer_option(command, ByteSpan(&value, 1)); }
    void carry_out(std::uint8_t command, ByteSpan value);
    void carry_out_on_line(std::uint8_t command, std::uint8_t value);
    void set_baud(ByteSpan value);
    void control(std::uint8_t value);
    void purge(std::uint8_t value);
    void finish_sub();

    std::string signature_;
    ComPortSettings settings_;
    std::uint32_t own_baud_ = 9600;
    std::array<Option, 3> options_{};  // binary, suppress go ahead, com port
    bool agreed_ = false;
    State state_ = State::data;
    std::uint8_t verb_ = 0;
    Bytes sub_;
    bool sub_too_long_ = false;
    int followed_ = 0;   // commands of the present call
    bool held_ = false;  // a change of speed that waits until the data before it has been taken
    Bytes data_, answers_;
};

/// An access server for one client at a time, on a TcpTransport.
///
/// The client's speed is the one that it has set; before, that of the receiver. A wrong one garbles as on a terminal.
/// Data bits, parity, stop bits, modem lines and break are kept and told, and change nothing. While the client has
/// suspended the flow, the receiver's bytes are lost, as in an overrun UART.
class Rfc2217Transport : public Transport {
public:
    /// Fails as TcpTransport::listen().
    static Result<std::unique_ptr<Rfc2217Transport>> listen(const TcpAddress& address);

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    void set_receiver_baud(std::uint32_t baud) override { port_.set_own_baud(baud); }
    std::vector<std::string> take_news() override { return server_->take_news(); }
    [[nodiscard]] std::string notice() const override { return server_->notice(); }
    /// "127.0.0.1:40123 (rfc2217)".
    [[nodiscard]] std::string description() const override;

    [[nodiscard]] std::uint16_t port() const { return server_->port(); }
    /// What the present client has made of the port.
    /// True once the client has spoken of COM-PORT-OPTION.
    [[nodiscard]] bool agreed() const { return port_.agreed(); }
    [[nodiscard]] const ComPortSettings& settings() const { return port_.settings(); }

private:
    explicit Rfc2217Transport(std::unique_ptr<TcpTransport> server);
    void follow();
    void meet_client();
    void send_waiting();

    std::unique_ptr<TcpTransport> server_;
    ComPortServer port_;
    std::uint64_t met_ = 0;   // connections of server_ that the port has begun with
    Bytes unparsed_;          // of the client, behind a change of speed or many commands
    std::size_t parsed_ = 0;  // of unparsed_
    Bytes waiting_;           // for the client: answers, and the second half of an escaped byte
};

}  // namespace skyloop::inline wire
