#include "tcp_listener.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

namespace skyloop {
namespace {

constexpr int connection_queue = 16, connection_buffer_bytes = 262144;
constexpr int connection_patience_ms = 60000;  // with a peer that acknowledges nothing (RFC 5482)
constexpr int alive_idle_s = 30, alive_every_s = 10, alive_tries = 3;

struct FreeAddresses {
    void operator()(addrinfo* first) const { ::freeaddrinfo(first); }
};

void set_tcp_option(int socket, int level, int name, int value) {
    (void)::setsockopt(socket, level, name, &value, sizeof value);  // a system that does not know it goes without it
}

// Host and port of an address, as numbers.
TcpAddress numeric_address(const sockaddr_storage& name, socklen_t size) {
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    if (::getnameinfo(reinterpret_cast<const sockaddr*>(&name), size, host.data(), host.size(), service.data(),
                      service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return {"?", 0};
    TcpAddress address{host.data(), 0};
    std::from_chars(service.data(), service.data() + std::strlen(service.data()), address.port);
    return address;
}

std::string shown(const TcpAddress& address) {
    const bool v6 = address.host.find(':') != std::string::npos;
    return fmt::format("{}{}{}:{}", v6 ? "[" : "", address.host, v6 ? "]" : "", address.port);
}

bool reaches_this_machine_alone(const sockaddr_storage& name) {
    constexpr std::uint32_t loopback_net = 127;  // RFC 1122, section 3.2.1.3
    if (name.ss_family == AF_INET)
        return ntohl(reinterpret_cast<const sockaddr_in&>(name).sin_addr.s_addr) >> 24U == loopback_net;
    if (name.ss_family != AF_INET6) return false;
    const in6_addr& six = reinterpret_cast<const sockaddr_in6&>(name).sin6_addr;
    return IN6_IS_ADDR_LOOPBACK(&six) || (IN6_IS_ADDR_V4MAPPED(&six) && six.s6_addr[12] == loopback_net);
}

// A listening socket, or nothing with errno set.
FileDescriptor listening_socket(const addrinfo& where) {
    FileDescriptor server(::socket(where.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, where.ai_protocol));
    if (!server.open()) return {};
    // A run that follows another finds its port free, though old connections still linger in TIME_WAIT.
    set_tcp_option(server.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    set_tcp_option(server.value(), SOL_SOCKET, SO_SNDBUF, connection_buffer_bytes);  // connections inherit it
    if (::bind(server.value(), where.ai_addr, where.ai_addrlen) == 0 && ::listen(server.value(), connection_queue) == 0)
        return server;
    const int reason = errno;
    server = FileDescriptor();
    errno = reason;
    return server;
}

}  // namespace

Result<TcpListener> TcpListener::open(const TcpAddress& address, const std::string& scheme) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo* first = nullptr;
    const int unknown = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &first);
    if (unknown != 0)
        return fail(ErrorCode::outside, fmt::format("{} {}: {}", scheme, shown(address), ::gai_strerror(unknown)));
    const std::unique_ptr<addrinfo, FreeAddresses> all(first);
    int reason = 0;
    for (const addrinfo* where = all.get(); where != nullptr; where = where->ai_next) {
        TcpListener listener;
        listener.socket_ = listening_socket(*where);
        reason = errno;
        if (!listener.socket_.open()) continue;
        sockaddr_storage name{};
        socklen_t size = sizeof name;
        if (::getsockname(listener.socket_.value(), reinterpret_cast<sockaddr*>(&name), &size) != 0) continue;
        listener.address_ = {address.host, numeric_address(name, size).port};
        listener.loopback_ = reaches_this_machine_alone(name);
        return listener;
    }
    return fail(ErrorCode::outside,
                fmt::format("{} {}: cannot be listened at: {}", scheme, shown(address), std::strerror(reason)));
}

std::optional<AcceptedTcp> TcpListener::accept() const {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    FileDescriptor socket(
        ::accept4(socket_.value(), reinterpret_cast<sockaddr*>(&name), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.open()) return std::nullopt;
    set_tcp_option(socket.value(), IPPROTO_TCP, TCP_NODELAY, 1);
    set_tcp_option(socket.value(), SOL_SOCKET, SO_KEEPALIVE, 1);
    set_tcp_option(socket.value(), IPPROTO_TCP, TCP_KEEPIDLE, alive_idle_s);
    set_tcp_option(socket.value(), IPPROTO_TCP, TCP_KEEPINTVL, alive_every_s);
    set_tcp_option(socket.value(), IPPROTO_TCP, TCP_KEEPCNT, alive_tries);
    set_tcp_option(socket.value(), IPPROTO_TCP, TCP_USER_TIMEOUT, connection_patience_ms);
    return AcceptedTcp{std::move(socket), shown(numeric_address(name, size))};
}

TcpStream hear_tcp(int socket, Bytes& heard, std::size_t most) {
    std::array<std::uint8_t, 16384> piece;
    while (heard.size() < most) {
        const ssize_t count = ::recv(socket, piece.data(), std::min(piece.size(), most - heard.size()), MSG_DONTWAIT);
        if (count > 0)
            heard.insert(heard.end(), piece.begin(), piece.begin() + count);
        else if (count == 0)
            return TcpStream::ended;
        else if (errno == EAGAIN)
            break;
        else if (errno != EINTR)
            return TcpStream::broken;
    }
    return TcpStream::open;
}

std::size_t send_tcp(int socket, ByteSpan bytes, TcpStream& state) {
    std::size_t taken = 0;
    while (taken < bytes.size()) {
        const ssize_t count = ::send(socket, bytes.data() + taken, bytes.size() - taken, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count > 0) {
            taken += static_cast<std::size_t>(count);
        } else if (count == 0 || errno == EAGAIN) {
            break;
        } else if (errno != EINTR) {
            state = TcpStream::broken;
            break;
        }
    }
    return taken;
}

}  // namespace skyloop
