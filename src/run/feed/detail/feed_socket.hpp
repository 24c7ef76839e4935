/// Sockets of feeds.
#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/transport/file_descriptor.hpp"
#include "wire/transport/tcp_connection.hpp"

namespace skyloop {

/// A socket address of either family.
struct FeedPeer {
    sockaddr_storage storage{};
    socklen_t length = 0;
    [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
    bool operator==(const FeedPeer& other) const;
};

/// Whether both are addresses of one host, whatever the ports.
bool same_host(const FeedPeer& a, const FeedPeer& b);

std::string shown_peer(const FeedPeer& peer);

/// All addresses of a host, at least one. May wait for a name server. Fails with `outside`.
/// @param type SOCK_DGRAM or SOCK_STREAM
Result<std::vector<FeedPeer>> resolve_host(const TcpAddress& address, int type);

/// Sockets that do not wait. They fail with `outside`; the sentence names the address.
Result<FileDescriptor> listening_socket(const TcpAddress& address, int type);
/// Of datagrams: connected, so that the kernel lets nobody else in.
Result<FileDescriptor> connected_datagrams(const TcpAddress& address);
/// Of datagrams: bound to this port, or to a free one where it is taken, in the family of the other end, from whom it
/// may hear at any port.
Result<FileDescriptor> bound_datagrams(const FeedPeer& to, std::uint16_t wanted);
/// Of a stream: the connection has begun; whether it came about, finish_connecting() tells. None, and `why`, where it
/// cannot even begin.
FileDescriptor begin_connecting(const FeedPeer& to, std::string& why);
enum class ConnectState { pending, open, failed };
ConnectState finish_connecting(int socket, std::string& why);
/// The port of its own end; 0 when it has none.
std::uint16_t own_port(int socket);

/// Datagrams as they came.
struct FeedDatagram {
    ByteSpan bytes;
    const FeedPeer* from = nullptr;
    std::int64_t received_ns = 0;  ///< by the kernel, on our steady clock
};

/// Takes datagrams in batches, with the kernel's times and its count of what it had to drop.
class DatagramReader {
public:
    /// Asks for times, the count and a receive buffer of 4 MiB.
    explicit DatagramReader(int socket);
    /// At most one batch, without waiting. What is given lives until the next call.
    const std::vector<FeedDatagram>& take();
    /// Datagrams that the kernel dropped since the last call.
    std::uint64_t take_dropped();
    static constexpr std::size_t batch = 32;

private:
    static constexpr std::size_t longest = 65536, control_bytes = 128;
    int socket_;
    std::unique_ptr<std::uint8_t[]> bytes_;
    std::array<mmsghdr, batch> messages_{};
    std::array<iovec, batch> parts_{};
    std::array<FeedPeer, batch> peers_{};
    alignas(cmsghdr) std::array<std::array<char, control_bytes>, batch> controls_{};
    std::vector<FeedDatagram> taken_;
    std::uint32_t dropped_seen_ = 0;
    std::uint64_t dropped_ = 0;
};

}  // namespace skyloop
