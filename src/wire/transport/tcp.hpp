/// A TCP socket: a receiver's port over the network, as serial device servers offer it.
/// What connections over TCP have in common, whichever end is this program's.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// Where a server listens.
struct TcpAddress {
    std::string host = "127.0.0.1";  ///< a name, an IPv4 address, or an IPv6 address without its brackets
    std::uint16_t port = 0;          ///< 0: any that is free
};
/// Reads "PORT", "HOST:PORT" or "[IPV6]:PORT". Fails with `usage` and a sentence that quotes the text.
Result<TcpAddress> parse_tcp_address(std::string_view text);

class TcpListener;

/// A server whose one client at a time is the other end of the wire.
///
/// Nothing is written while nobody is connected; a client never reads what an earlier one left. A further client is
/// closed at once (notice() counts them), unless the present one has shut its sending side: that one then gives way. A
/// client that does not read fills the socket's buffers; write() then takes fewer bytes. One that has vanished from the
/// network is given up after a minute (RFC 5482; keep-alive of RFC 9293, section 3.8.4). A socket has no line speed.
class TcpTransport : public Transport {
public:
    /// Fails with `outside` when the host is unknown or the system refuses. A host name may take its time to look up.
    static Result<std::unique_ptr<TcpTransport>> listen(const TcpAddress& address);
    ~TcpTransport() override;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    /// At first a warning when others than this machine's programs can connect.
    std::vector<std::string> take_news() override;
    [[nodiscard]] std::string notice() const override;
    /// "127.0.0.1:40123 (tcp)".
    [[nodiscard]] std::string description() const override;

    /// Where it listens; never 0.
    [[nodiscard]] std::uint16_t port() const;
    /// Clients that were closed at once, because there was one already.
    [[nodiscard]] std::uint64_t turned_away() const { return turned_away_; }
    /// Clients that there have been, the present one included. What read() gives is all of the latest.
    [[nodiscard]] std::uint64_t connections() const { return connections_; }

private:
    explicit TcpTransport(std::unique_ptr<TcpListener> server);

    void hear_client();
    void follow_clients();
    void drop_client();

    std::unique_ptr<TcpListener> server_;
    FileDescriptor client_;
    bool client_finished_ = false;  // it sends no more; perhaps it still listens
    Bytes unread_;                  // heard while looking after clients; what one wrote before it went is heard, too
    std::uint64_t turned_away_ = 0, connections_ = 0;
    std::vector<std::string> news_;
};

/// "127.0.0.1:2000", "[::1]:2000".
std::string shown_address(const TcpAddress& address);

/// A system that does not know the option goes without it.
void set_socket_option(int socket, int level, int name, int value);

/// Options of a connection: small writes leave at once, and an other end that has vanished is given up after a minute.
void prepare_connection(int socket);

/// Whether both ends are this one. A port that is free and of the system's own choice may be called from the very same
/// port: then the two ends are one (RFC 9293, section 3.5, simultaneous open), and no server could ever have the port.
bool calls_itself(int socket);

}  // namespace skyloop::inline wire
