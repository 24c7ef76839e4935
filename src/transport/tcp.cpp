#include "skyloop/transport/tcp.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace skyloop {
namespace {

constexpr int waiting_clients = 8;
// Bounds how old the bytes of a slow client grow. Each write of some bytes a millisecond travels alone and takes some 2
// kB until it is acknowledged, which clients may put off for 40 ms and more: much less would lose bytes of a client
// that reads.
constexpr int send_buffer_bytes = 262144;
constexpr unsigned patience_ms = 60000;  // with a client that acknowledges nothing
constexpr int keep_alive_idle_s = 30, keep_alive_every_s = 10, keep_alive_tries = 3;

struct AddressList {
    addrinfo* first = nullptr;
    AddressList() = default;
    AddressList(const AddressList&) = delete;
    AddressList& operator=(const AddressList&) = delete;
    ~AddressList() {
        if (first != nullptr) ::freeaddrinfo(first);
    }
};

std::string shown_address(const TcpAddress& address) {
    const bool v6 = address.host.find(':') != std::string::npos;
    return v6 ? fmt::format("[{}]:{}", address.host, address.port) : fmt::format("{}:{}", address.host, address.port);
}

// A system that does not know an option goes without it.
void set_option(int socket, int level, int name, int value) {
    (void)::setsockopt(socket, level, name, &value, sizeof value);
}

void prepare_client(int socket) {
    set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
    set_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, keep_alive_idle_s);
    set_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, keep_alive_every_s);
    set_option(socket, IPPROTO_TCP, TCP_KEEPCNT, keep_alive_tries);
    set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(patience_ms));
}

// Gives a listening socket, or nothing with errno set.
FileDescriptor listen_at(const addrinfo& where) {
    FileDescriptor server(::socket(where.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, where.ai_protocol));
    if (!server.open()) return {};
    // A run that follows another finds its port free, though old connections still linger in TIME_WAIT.
    set_option(server.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    set_option(server.value(), SOL_SOCKET, SO_SNDBUF, send_buffer_bytes);  // its clients inherit it
    if (::bind(server.value(), where.ai_addr, where.ai_addrlen) != 0 ||
        ::listen(server.value(), waiting_clients) != 0) {
        const int reason = errno;
        server = FileDescriptor();
        errno = reason;
    }
    return server;
}

std::uint16_t port_of_socket(int socket) {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0) return 0;
    std::array<char, NI_MAXSERV> service{};
    if (::getnameinfo(reinterpret_cast<sockaddr*>(&name), size, nullptr, 0, service.data(), service.size(),
                      NI_NUMERICSERV) != 0)
        return 0;
    unsigned port = 0;
    std::from_chars(service.data(), service.data() + std::strlen(service.data()), port);
    return static_cast<std::uint16_t>(port);
}

}  // namespace

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
    unsigned number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (port.empty() || error != std::errc() || end != port.data() + port.size() || number > 65535)
        return refused("a port from 0 to 65535 is missing");
    address.port = static_cast<std::uint16_t>(number);
    return address;
}

Result<std::unique_ptr<TcpTransport>> TcpTransport::listen(const TcpAddress& address) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    AddressList found;
    if (const int error =
            ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found.first);
        error != 0)
        return fail(ErrorCode::outside, fmt::format("tcp {}: {}", shown_address(address), ::gai_strerror(error)));
    for (const addrinfo* where = found.first; where != nullptr; where = where->ai_next) {
        FileDescriptor server = listen_at(*where);
        if (!server.open()) continue;
        TcpAddress actual = address;
        actual.port = port_of_socket(server.value());
        return std::unique_ptr<TcpTransport>(new TcpTransport(std::move(server), std::move(actual)));
    }
    return fail(ErrorCode::outside,
                fmt::format("tcp {}: cannot be listened at: {}", shown_address(address), std::strerror(errno)));
}

void TcpTransport::drop_client() {
    client_ = FileDescriptor();
    client_finished_ = false;
}

// Reads what is there, since only that tells of a client that has gone; then lets the next one in.
void TcpTransport::follow_clients() {
    constexpr std::size_t most = 65536;  // a client that writes without end must not hold us here
    std::array<std::uint8_t, 4096> piece;
    while (client_.open() && !client_finished_ && unread_.size() < most) {
        const ssize_t count = ::recv(client_.value(), piece.data(), piece.size(), MSG_DONTWAIT);
        if (count > 0)
            unread_.insert(unread_.end(), piece.begin(), piece.begin() + count);
        else if (count == 0)
            client_finished_ = true;
        else if (errno == EAGAIN)
            break;
        else if (errno != EINTR)
            drop_client();
    }
    for (int i = 0; i < waiting_clients; ++i) {
        FileDescriptor next(::accept4(server_.value(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!next.open()) return;
        if (client_.open() && !client_finished_) {
            ++turned_away_;
            continue;
        }
        drop_client();
        client_ = std::move(next);
        prepare_client(client_.value());
    }
}

std::size_t TcpTransport::write(ByteSpan bytes) {
    follow_clients();
    if (!client_.open()) return bytes.size();
    std::size_t taken = 0;
    while (taken < bytes.size()) {
        const ssize_t count =
            ::send(client_.value(), bytes.data() + taken, bytes.size() - taken, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count > 0) {
            taken += static_cast<std::size_t>(count);
        } else if (count < 0 && errno != EAGAIN && errno != EINTR) {
            drop_client();  // it has gone, and with it the bytes
            return bytes.size();
        } else if (count == 0 || errno == EAGAIN) {
            break;
        }
    }
    return taken;
}

Bytes TcpTransport::read() {
    follow_clients();
    return std::exchange(unread_, {});
}

LineState TcpTransport::line() {
    follow_clients();
    return {client_.open(), std::nullopt};
}

std::string TcpTransport::notice() const {
    if (turned_away_ == 0) return {};
    return fmt::format("{}: {} more client{} came while one was connected and {} closed at once", description(),
                       turned_away_, turned_away_ == 1 ? "" : "s", turned_away_ == 1 ? "was" : "were");
}

std::string TcpTransport::description() const { return shown_address(address_) + " (tcp)"; }

}  // namespace skyloop
