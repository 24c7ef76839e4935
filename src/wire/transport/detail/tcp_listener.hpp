/// A socket that listens on TCP, for wires that look after their connections themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/transport/file_descriptor.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop {

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

}  // namespace skyloop
