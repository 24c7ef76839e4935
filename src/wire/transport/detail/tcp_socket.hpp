/// What servers and clients on TCP share.
/// A socket that listens on TCP, for wires that look after their connections themselves.
#pragma once

#include <netdb.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/core/bytes.hpp"
#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline wire {

/// Most bytes that are taken in at one look: an other end that writes without end must not hold the loop.
constexpr std::size_t most_read_at_once = 65536;

struct AddressListDeleter {
    void operator()(addrinfo* first) const { ::freeaddrinfo(first); }
};
using AddressList = std::unique_ptr<addrinfo, AddressListDeleter>;

/// Every address that a host has. May wait for a name server. Fails with `outside` and a sentence that begins with
/// `scheme`.
/// @param to_listen addresses of this machine
Result<AddressList> look_up(const TcpAddress& address, const std::string& scheme, bool to_listen);

/// True when only programs of this machine reach what listens there.
bool is_loopback(const sockaddr& address);

/// A socket that neither waits nor outlives exec, with the send buffer of this program's wires; none, and errno, when
/// the system refuses.
FileDescriptor make_socket(const addrinfo& where);

/// How a connection stands after a look.
enum class StreamState { open, finished, gone };

/// Appends what is there, up to `most` bytes in all; tells whether the other end has shut its sending side (`finished`)
/// or broken the connection (`gone`).
StreamState receive_available(int socket, Bytes& bytes, std::size_t most = most_read_at_once);
/// Gives how many bytes the socket took; `state` becomes `gone` when the connection is broken.
std::size_t send_available(int socket, ByteSpan bytes, StreamState& state);

/// A connection that has come.
struct AcceptedTcp {
    FileDescriptor socket;  ///< neither waits nor outlives exec; see prepare_connection()
    std::string peer;       ///< "127.0.0.1:40123"
};

/// Where connections come.
class TcpListener {
public:
    /// Fails with `outside` when the host is unknown or the system refuses; the sentence begins with `scheme`.
    static Result<TcpListener> open(const TcpAddress& address, const std::string& scheme);

    /// A connection waits, or the socket has something to say of itself.
    [[nodiscard]] bool any_waits() const;
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

}  // namespace skyloop::inline wire
