#include "wire/transport/tcp.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cstring>
#include <utility>

#include "base/core/number_text.hpp"
#include "detail/tcp_socket.hpp"

namespace skyloop::inline wire {
namespace {

constexpr unsigned patience_ms = 60000;  // with an other end that acknowledges nothing
constexpr int keep_alive_idle_s = 30, keep_alive_every_s = 10, keep_alive_tries = 3;
constexpr int most_at_once = 8;  // clients that are let in or turned away in one look

}  // namespace

std::string shown_address(const TcpAddress& address) {
    const bool v6 = address.host.find(':') != std::string::npos;
    return v6 ? fmt::format("[{}]:{}", address.host, address.port) : fmt::format("{}:{}", address.host, address.port);
}

void set_socket_option(int socket, int level, int name, int value) {
    (void)::setsockopt(socket, level, name, &value, sizeof value);
}

void prepare_connection(int socket) {
    set_socket_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
    set_socket_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
    set_socket_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, keep_alive_idle_s);
    set_socket_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, keep_alive_every_s);
    set_socket_option(socket, IPPROTO_TCP, TCP_KEEPCNT, keep_alive_tries);
    set_socket_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(patience_ms));
}

bool calls_itself(int socket) {
    sockaddr_storage own{}, other{};
    socklen_t own_size = sizeof own, other_size = sizeof other;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 ||
        ::getpeername(socket, reinterpret_cast<sockaddr*>(&other), &other_size) != 0)
        return false;
    return own_size == other_size && std::memcmp(&own, &other, own_size) == 0;
}

Result<TcpAddress> parse_tcp_address(std::string_view text) {
    const auto refused = [&](std::string_view what) {
        return fail(ErrorCode::usage,
                    fmt::format("address '{}': {}; expected [HOST:]PORT, an IPv6 address in brackets", text, what));
    };
    TcpAddress address;
    std::string_view port = text;
    if (const std::size_t colon = text.rfind(':'); colon != std::string_view::npos) {
        std::string_view host = text.substr(0, colon);
        port = text.substr(colon + 1);
        if (host.size() > 2 && host.front() == '[' && host.back() == ']')
            host = host.substr(1, host.size() - 2);
        else if (host.find_first_of(":[]") != std::string_view::npos)
            return refused("the host is not understood");
        if (host.empty()) return refused("the host is missing");
        address.host = host;
    }
    const auto number = number_in<std::uint16_t>(port);
    if (!number) return refused("a port from 0 to 65535 is missing");
    address.port = *number;
    return address;
}

TcpTransport::TcpTransport(std::unique_ptr<TcpListener> server) : server_(std::move(server)) {}

TcpTransport::~TcpTransport() = default;

Result<std::unique_ptr<TcpTransport>> TcpTransport::listen(const TcpAddress& address) {
    auto server = TcpListener::open(address, "tcp");
    if (!server) return fail(server.error());
    const bool loopback = server->loopback();
    std::unique_ptr<TcpTransport> wire(new TcpTransport(std::make_unique<TcpListener>(std::move(*server))));
    if (!loopback)
        wire->news_.push_back(
            fmt::format("{}: whoever reaches this machine can read and configure the receiver", wire->description()));
    return wire;
}

std::uint16_t TcpTransport::port() const { return server_->address().port; }

void TcpTransport::drop_client() {
    client_ = FileDescriptor();
    client_finished_ = false;
}

// Reads what is there, since only that tells of a client that has gone.
void TcpTransport::hear_client() {
    if (!client_.open() || client_finished_) return;
    const StreamState state = receive_available(client_.value(), unread_);
    client_finished_ = state == StreamState::finished;
    if (state == StreamState::gone) drop_client();
}

// Lets the next client in, once all that the earlier one wrote has been handed on: bytes of two clients never stand
// together. The earlier one is heard after the next one has come: who leaves and comes back at once is never turned
// away for his own sake.
void TcpTransport::follow_clients() {
    hear_client();
    for (int i = 0; i < most_at_once && server_->any_waits(); ++i) {
        hear_client();
        const bool taken = client_.open() && !client_finished_;
        if (!taken && !unread_.empty()) return;
        auto next = server_->accept();
        if (!next) return;
        if (taken) {
            ++turned_away_;
            continue;
        }
        drop_client();
        client_ = std::move(next->socket);
        ++connections_;
    }
}

std::size_t TcpTransport::write(ByteSpan bytes) {
    follow_clients();
    if (!client_.open()) return bytes.size();
    StreamState state = StreamState::open;
    const std::size_t taken = send_available(client_.value(), bytes, state);
    if (state != StreamState::gone) return taken;
    drop_client();  // and with it the bytes
    return bytes.size();
}

Bytes TcpTransport::read() {
    follow_clients();
    return std::exchange(unread_, {});
}

LineState TcpTransport::line() {
    follow_clients();
    return {client_.open(), std::nullopt};
}

std::vector<std::string> TcpTransport::take_news() { return std::exchange(news_, {}); }

std::string TcpTransport::notice() const {
    if (turned_away_ == 0) return {};
    return fmt::format("{}: {} more client{} came while one was connected and {} closed at once", description(),
                       turned_away_, turned_away_ == 1 ? "" : "s", turned_away_ == 1 ? "was" : "were");
}

std::string TcpTransport::description() const { return shown_address(server_->address()) + " (tcp)"; }

}  // namespace skyloop::inline wire
