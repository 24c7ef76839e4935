/// Where whole messages go one way, to other ends that may be slow, refuse or be gone.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/transport/tcp.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// What became of messages.
struct SinkCounts {
    std::uint64_t messages = 0;  ///< handed to the system, once for each other end
    std::uint64_t bytes = 0;     ///< of these
    std::uint64_t unheard = 0;   ///< nobody was connected
    std::uint64_t lost = 0;      ///< another end was too slow for one, once for each, or refused it later
    bool operator==(const SinkCounts&) const = default;
};

/// One way out of the program. Every other end gets messages whole or not at all. For one thread.
class MessageSink {
public:
    virtual ~MessageSink() = default;
    /// Nothing refuses the run any more; before the first message.
    virtual void begin() {}
    /// Sends a message to every other end. One that still has a part of an earlier message before it does not get it.
    virtual void send(ByteSpan message) = 0;
    /// Looks after connections and goes on with what was half sent; to be called every 100 ms or more often.
    virtual void look() {}
    /// From now on send() waits for a slow other end, until `patience` is over: from then on it is never waited for
    /// again. A connection that is being made is waited for here and now.
    virtual void wait_for_readers(std::chrono::milliseconds) {}
    /// The end: what is half sent is given this long.
    virtual void finish(std::chrono::milliseconds) {}
    [[nodiscard]] const SinkCounts& counts() const { return counts_; }
    /// What has happened since the last call and its owner should hear at once, in sentences.
    std::vector<std::string> take_news();
    /// What has broken for good, in one sentence; empty: nothing.
    [[nodiscard]] virtual std::string failure() const { return {}; }
    /// "127.0.0.1:14550 (udp)"
    [[nodiscard]] virtual std::string description() const = 0;

protected:
    void count_sent(std::size_t bytes) {
        ++counts_.messages;
        counts_.bytes += bytes;
    }
    void tell(std::string sentence) { news_.push_back(std::move(sentence)); }

    SinkCounts counts_;

private:
    std::vector<std::string> news_;
};

/// Datagrams to one address, one for each message. What a peer that is not there yet refuses (ICMP, RFC 1122, section
/// 3.2.2.1) and what the system cannot take is lost; the first refusal is told.
/// Fails with `usage` for port 0, with `outside` for an unknown host or when the system refuses.
Result<std::unique_ptr<MessageSink>> open_udp_sink(const TcpAddress& address);

/// A TCP server with any number of clients, at most 64, who get all messages from their arrival on. What they send is
/// not heard. The description tells the port when `address` leaves it to the system. Fails as TcpTransport does.
Result<std::unique_ptr<MessageSink>> open_tcp_server_sink(const TcpAddress& address);

/// Messages onto a wire: a connection that is made, or a file.
std::unique_ptr<MessageSink> make_wire_sink(std::unique_ptr<Transport> wire);

}  // namespace skyloop::inline wire
