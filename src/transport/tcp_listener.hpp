/// A socket that listens on TCP, for wires that look after their connections themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skyloop/base/bytes.hpp"
#include "skyloop/base/result.hpp"
#include "skyloop/transport/file_descriptor.hpp"
#include "skyloop/transport/tcp.hpp"

namespace skyloop {

/// A connection that has come.
struct AcceptedTcp {
    FileDescriptor
        socket;        ///< waits for nothing; small writes leave at once; a vanished peer is given up after a minute
    std::string peer;  ///< "127.0.0.1:40123"
};

/// Where connections come.
class TcpListener {
public:
    /// Fails with `outside` when the host is unknown or the system refuses; the sentence begins with `scheme`.
    static Result<TcpListener> open(const TcpAddress& address, const std::string& scheme);

    /// The next connection that waits; nothing when none does.
    [[nodiscard]] std::optional<AcceptedTcp> accept() const;
    /// The port is never 0.
    [[nodiscard]] const TcpAddress& address() const { return address_; }
    /// Only programs of this machine can connect.
    [[nodiscard]] bool loopback() const { return loopback_; }

private:
    FileDescriptor socket_;
    TcpAddress address_;
    bool loopback_ = true;
};

/// How a connection stands after bytes were moved.
enum class TcpStream { open, ended, broken };

/// Appends to `heard` what has come, as long as it has fewer than `most` bytes.
TcpStream hear_tcp(int socket, Bytes& heard, std::size_t most);
/// Sends what the socket takes and gives how much; `state` becomes `broken` when there is no connection any more.
std::size_t send_tcp(int socket, ByteSpan bytes, TcpStream& state);

}  // namespace skyloop
