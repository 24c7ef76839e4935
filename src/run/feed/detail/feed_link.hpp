/// How a feed's thread reaches its source.
/// Sockets of feeds.
#pragma once

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "feed_hearer.hpp"
#include "run/feed/truth_feed.hpp"
#include "wire/transport/tcp.hpp"

namespace skyloop::inline run {

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

/// @param to null: whom the socket is connected to
void send_datagram(int socket, ByteSpan bytes, const FeedPeer* to);

/// Whom a socket that listens speaks to: at most 8 who have been heard, each forgotten after 10 s of silence.
/// Times are of the steady clock.
class DatagramPeers {
public:
    void forget_old(std::int64_t now_ns);
    [[nodiscard]] bool empty() const { return peers_.empty(); }
    /// He is one of them, or may become one.
    [[nodiscard]] bool has_room_for(const FeedPeer& peer) const;
    /// He has been heard; without room for him nothing changes.
    void remember(const FeedPeer& peer, std::int64_t now_ns);
    void send_to_all(int socket, ByteSpan bytes) const;

private:
    struct Heard {
        FeedPeer peer;
        std::int64_t at_ns = 0;
    };
    std::vector<Heard> peers_;
};

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

/// One wire to a source. All of it belongs to the feed's thread, once that runs; nothing in it waits.
class FeedLink {
public:
    virtual ~FeedLink() = default;
    /// What the thread waits for.
    virtual void add_waits(std::vector<pollfd>& waits) const = 0;
    /// Takes a bounded share of what is there, lets it be heard and sends answers. @return anything was there
    virtual bool serve(std::int64_t now_ns) = 0;
    /// Says what dialects say unasked; every second.
    virtual void speak(std::int64_t now_ns) = 0;
    virtual void answer(std::uint64_t speaker, const std::vector<Bytes>& answers) = 0;
    /// As the system gave it; 0: this wire does not listen.
    [[nodiscard]] virtual std::uint16_t port() const { return 0; }
    /// Looks come at least so often.
    [[nodiscard]] virtual int longest_wait_ms() const { return 100; }
    /// Others wait for what goes through here: no look is put off to make fewer of them.
    [[nodiscard]] virtual bool in_haste() const { return false; }
};

/// Fails with `outside`. @param hearer outlives it
Result<std::unique_ptr<FeedLink>> open_datagram_link(const FeedAddress& address, FeedHearer& hearer);
Result<std::unique_ptr<FeedLink>> open_stream_link(const FeedAddress& address, FeedHearer& hearer);
Result<std::unique_ptr<FeedLink>> open_serial_link(const FeedAddress& address, FeedHearer& hearer);
Result<std::unique_ptr<FeedLink>> open_datagram_relay(const FeedAddress& address, FeedHearer& hearer);
Result<std::unique_ptr<FeedLink>> open_stream_relay(const FeedAddress& address, FeedHearer& hearer);

/// One end of a stream with what waits to be sent there.
class FeedStream {
public:
    FeedStream() = default;
    explicit FeedStream(FileDescriptor socket) : socket_(std::move(socket)) { prepare_connection(socket_.value()); }

    [[nodiscard]] bool open() const { return socket_.open(); }
    void close() { *this = FeedStream(); }
    [[nodiscard]] pollfd wait(bool reads) const;
    /// At most `most` bytes; empty when there are none. Sets gone() when the other end has closed or broken.
    const Bytes& read(std::size_t most);
    /// Sends, and keeps what the socket does not take.
    void send(ByteSpan bytes);
    void send_waiting();
    [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
    [[nodiscard]] bool gone() const { return gone_; }
    /// The other end has closed, and nothing of it waits to be read.
    [[nodiscard]] bool hung_up() const;
    /// Nothing more comes; what waits may still be sent.
    [[nodiscard]] bool finished() const { return finished_; }

private:
    FileDescriptor socket_;
    Bytes read_;
    SendBuffer waiting_;
    bool gone_ = false, finished_ = false;
};

/// Connects to a host whose addresses are tried in turn, again and again: 0.2 s later at first, then after twice as
/// long each time, up to 5 s.
class StreamConnector {
public:
    explicit StreamConnector(std::vector<FeedPeer> peers) : peers_(std::move(peers)) {}
    /// Goes on with the attempt. @return a socket when it has come about @param why of a failure
    FileDescriptor look(std::int64_t now_ns, std::string& why);
    /// Of the attempt that is under way; −1 without one.
    [[nodiscard]] int descriptor() const { return socket_.value(); }
    /// The connection was lost. @param lasted it had been of use
    void lost(std::int64_t now_ns, bool lasted);

private:
    void put_off(std::int64_t now_ns);

    static constexpr std::int64_t first_wait_ns = 200'000'000, longest_wait_ns = 5'000'000'000;
    std::vector<FeedPeer> peers_;
    std::size_t next_ = 0;
    FileDescriptor socket_;
    std::int64_t begun_ns_ = 0, next_try_ns_ = 0, wait_ns_ = first_wait_ns;
};

}  // namespace skyloop::inline run
