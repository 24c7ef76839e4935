/// How a feed's thread reaches its source.
#pragma once

#include <poll.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/send_buffer.hpp"
#include "feed_hearer.hpp"
#include "feed_socket.hpp"
#include "run/feed/truth_feed.hpp"

namespace skyloop {

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

/// Time until the next attempt to connect: 0.2 s at first, then twice as long each time, up to 5 s.
class ConnectBackoff {
public:
    [[nodiscard]] bool due(std::int64_t now_ns) const { return now_ns >= next_ns_; }
    void failed(std::int64_t now_ns);
    void succeeded() { wait_ns_ = first_ns; }

private:
    static constexpr std::int64_t first_ns = 200'000'000, longest_ns = 5'000'000'000;
    std::int64_t next_ns_ = 0, wait_ns_ = first_ns;
};

/// Connects to a host whose addresses are tried in turn, again and again.
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
    std::vector<FeedPeer> peers_;
    std::size_t next_ = 0;
    FileDescriptor socket_;
    std::int64_t begun_ns_ = 0;
    ConnectBackoff backoff_;
};

}  // namespace skyloop
