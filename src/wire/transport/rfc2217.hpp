/// A serial port over the network whose client sets the line: RFC 2217, as pyserial's rfc2217:// and ser2net speak it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wire/transport/com_port_server.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop {

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

}  // namespace skyloop
