// Whole messages into a stream that takes as many bytes as it likes.
#include "wire/transport/message_sink.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <functional>
#include <list>
#include <thread>
#include <utility>

#include "base/core/bytes.hpp"
#include "detail/tcp_socket.hpp"

namespace skyloop::inline wire {
namespace {

using std::chrono::milliseconds;

// One other end of a stream.
//
// State: what it has not taken of its last message, and whether it has been too slow to be waited for.
class StreamPeer {
public:
    // Offers bytes to the stream; gives how many were taken.
    using Write = std::function<std::size_t(ByteSpan)>;
    // Returns when the stream may take more, or after a few milliseconds.
    using Wait = std::function<void()>;

    // False: the message is not sent, since a part of an earlier one still is before it. With patience an other end
    // that has not been too slow before is waited for.
    bool send(ByteSpan message, milliseconds patience, const Write& write, const Wait& wait) {
        const bool waits = patience.count() > 0 && !slow_;
        if (!(waits ? flush_within(patience, write, wait) : flush(write))) {
            slow_ = true;
            return false;
        }
        const std::size_t taken = std::min(write(message), message.size());
        rest_.assign(message.begin() + static_cast<std::ptrdiff_t>(taken), message.end());
        return true;
    }
    // Goes on with the rest; true: there is none any more.
    bool flush(const Write& write) {
        if (rest_.empty()) return true;
        const std::size_t taken = std::min(write(rest_), rest_.size());
        rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(taken));
        return rest_.empty();
    }
    // flush() until it is true or the patience is over.
    bool flush_within(milliseconds patience, const Write& write, const Wait& wait) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!flush(write)) {
            if (std::chrono::steady_clock::now() >= end) return false;
            wait();
        }
        return true;
    }
    // The stream is a new one.
    void forget() { rest_.clear(); }

private:
    Bytes rest_;
    bool slow_ = false;
};

constexpr int wait_slice_ms = 5;
constexpr std::size_t most_clients = 64;

class UdpSink : public MessageSink {
public:
    UdpSink(TcpAddress address, FileDescriptor socket) : address_(std::move(address)), socket_(std::move(socket)) {}

    void send(ByteSpan message) override {
        int reason = try_to_send(message);
        // The first call after a refusal tells of it and sends nothing: the peer may have come since.
        if (reason == ECONNREFUSED) {
            ++counts_.lost;
            tell_once(reason);
            reason = try_to_send(message);
        }
        if (reason == 0) return count_sent(message.size());
        ++counts_.lost;
        tell_once(reason);
    }
    [[nodiscard]] std::string description() const override { return shown_address(address_) + " (udp)"; }

private:
    [[nodiscard]] int try_to_send(ByteSpan message) const {
        return ::send(socket_.value(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0 ? 0 : errno;
    }
    void tell_once(int reason) {
        if (std::exchange(told_, true)) return;
        tell(fmt::format("{}: {}; what is refused is lost", shown_address(address_), std::strerror(reason)));
    }

    TcpAddress address_;
    FileDescriptor socket_;
    bool told_ = false;
};

// A socket that speaks to one address, or none and errno.
FileDescriptor datagram_socket(const addrinfo& where) {
    FileDescriptor socket(::socket(where.ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket.open()) return {};
    set_socket_option(socket.value(), SOL_SOCKET, SO_BROADCAST, 1);  // a whole network may listen
    if (::connect(socket.value(), where.ai_addr, where.ai_addrlen) != 0) return {};
    return socket;
}

class TcpServerSink : public MessageSink {
public:
    explicit TcpServerSink(TcpListener server) : server_(std::move(server)) {
        if (!server_.loopback())
            tell(fmt::format("{}: whoever reaches this machine can read what the receiver reports", description()));
    }

    void send(ByteSpan message) override {
        look();
        if (clients_.empty()) ++counts_.unheard;
        for (Client& client : clients_)
            if (!client.peer.send(message, patience_, writer(client), waiter(client)))
                lose(client);
            else if (!client.gone)
                count_sent(message.size());
        std::erase_if(clients_, [](const Client& client) { return client.gone; });
    }
    void look() override {
        for (Client& client : clients_) {
            Bytes unheard;
            if (receive_available(client.socket.value(), unheard) == StreamState::gone) client.gone = true;
            if (!client.gone) client.peer.flush(writer(client));
        }
        std::erase_if(clients_, [](const Client& client) { return client.gone; });
        let_in();
    }
    void wait_for_readers(milliseconds patience) override { patience_ = patience; }
    void finish(milliseconds patience) override {
        const auto end = std::chrono::steady_clock::now() + patience;
        for (Client& client : clients_) {
            const auto left = std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
            client.peer.flush_within(std::max(left, milliseconds(0)), writer(client), waiter(client));
        }
        // Without anything unread, closing sends the rest instead of a reset (RFC 9293, section 3.10.4).
        look();
        clients_.clear();
    }
    [[nodiscard]] std::string description() const override { return shown_address(server_.address()) + " (tcp)"; }

private:
    struct Client {
        FileDescriptor socket;
        std::string name;
        StreamPeer peer{};
        bool gone = false, told = false;
    };

    static StreamPeer::Write writer(Client& client) {
        return [&client](ByteSpan bytes) -> std::size_t {
            if (client.gone) return bytes.size();
            StreamState state = StreamState::open;
            const std::size_t taken = send_available(client.socket.value(), bytes, state);
            if (state != StreamState::gone) return taken;
            client.gone = true;
            return bytes.size();
        };
    }
    static StreamPeer::Wait waiter(const Client& client) {
        return [socket = client.socket.value()] {
            pollfd ready{socket, POLLOUT, 0};
            ::poll(&ready, 1, wait_slice_ms);
        };
    }
    void lose(Client& client) {
        ++counts_.lost;
        if (std::exchange(client.told, true)) return;
        tell(fmt::format("{}: {} reads too slowly; it gets no message until it has read", description(), client.name));
    }
    void let_in() {
        while (auto next = server_.accept()) {
            if (clients_.size() >= most_clients) continue;  // and the connection is closed
            Client& client = clients_.emplace_back();
            client.socket = std::move(next->socket);
            client.name = std::move(next->peer);
        }
    }

    TcpListener server_;
    std::list<Client> clients_;
    milliseconds patience_{0};
};

class WireSink : public MessageSink {
public:
    explicit WireSink(std::unique_ptr<Transport> wire) : wire_(std::move(wire)) {}

    void begin() override { wire_->begin(); }
    void send(ByteSpan message) override {
        look();
        if (!wire_->line().connected) {
            ++counts_.unheard;
        } else if (const bool taken = peer_.send(message, patience_, writer(), waiter()); !wire_->failure().empty()) {
            ++counts_.lost;
        } else if (taken) {
            count_sent(message.size());
        } else {
            ++counts_.lost;
            if (!std::exchange(told_, true))
                tell(fmt::format("{}: reads too slowly; it gets no message until it has read", description()));
        }
        for (std::string& sentence : wire_->take_news())
            tell(std::move(sentence));
    }
    void look() override {
        (void)wire_->read();
        if (!wire_->line().connected) return peer_.forget();
        peer_.flush(writer());
    }
    void wait_for_readers(milliseconds patience) override {
        patience_ = patience;
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!wire_->line().connected && std::chrono::steady_clock::now() < end)
            waiter()();
    }
    void finish(milliseconds patience) override {
        if (wire_->line().connected) peer_.flush_within(patience, writer(), waiter());
    }
    [[nodiscard]] std::string failure() const override { return wire_->failure(); }
    [[nodiscard]] std::string description() const override { return wire_->description(); }

private:
    StreamPeer::Write writer() {
        return [this](ByteSpan bytes) { return wire_->write(bytes); };
    }
    static StreamPeer::Wait waiter() {
        return [] { std::this_thread::sleep_for(milliseconds(1)); };
    }

    std::unique_ptr<Transport> wire_;
    StreamPeer peer_;
    milliseconds patience_{0};
    bool told_ = false;
};

}  // namespace

std::vector<std::string> MessageSink::take_news() { return std::exchange(news_, {}); }

Result<std::unique_ptr<MessageSink>> open_udp_sink(const TcpAddress& address) {
    if (address.port == 0)
        return fail(ErrorCode::usage,
                    fmt::format("udp {}: port 0 cannot be sent to; expected 1 to 65535", shown_address(address)));
    const auto found = look_up(address, "udp", false);
    if (!found) return fail(found.error());
    int reason = 0;
    for (const addrinfo* where = found->get(); where != nullptr; where = where->ai_next) {
        FileDescriptor socket = datagram_socket(*where);
        reason = errno;
        if (socket.open()) return std::make_unique<UdpSink>(address, std::move(socket));
    }
    return fail(ErrorCode::outside,
                fmt::format("udp {}: cannot be sent to: {}", shown_address(address), std::strerror(reason)));
}

Result<std::unique_ptr<MessageSink>> open_tcp_server_sink(const TcpAddress& address) {
    auto server = TcpListener::open(address, "tcp");
    if (!server) return fail(server.error());
    return std::make_unique<TcpServerSink>(std::move(*server));
}

std::unique_ptr<MessageSink> make_wire_sink(std::unique_ptr<Transport> wire) {
    return std::make_unique<WireSink>(std::move(wire));
}

}  // namespace skyloop::inline wire
