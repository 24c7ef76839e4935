#include "detail/tcp_listener.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/core/number_in.hpp"
#include "detail/tcp_socket.hpp"

namespace skyloop {
namespace {

constexpr int waiting_clients = 16;

// A listening socket, or nothing with errno set.
FileDescriptor listen_at(const addrinfo& where) {
    FileDescriptor server = make_socket(where);  // its clients inherit the buffer
    if (!server.open()) return {};
    // A run that follows another finds its port free, though old connections still linger in TIME_WAIT.
    set_socket_option(server.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    if (::bind(server.value(), where.ai_addr, where.ai_addrlen) != 0 ||
        ::listen(server.value(), waiting_clients) != 0) {
        const int reason = errno;
        server = FileDescriptor();
        errno = reason;
    }
    return server;
}

// Host and port of an address, as numbers.
TcpAddress numeric_address(const sockaddr_storage& name, socklen_t size) {
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> service{};
    if (::getnameinfo(reinterpret_cast<const sockaddr*>(&name), size, host.data(), host.size(), service.data(),
                      service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
        return {"?", 0};
    return {host.data(), number_in<std::uint16_t>(service.data()).value_or(0)};
}

}  // namespace

Result<TcpListener> TcpListener::open(const TcpAddress& address, const std::string& scheme) {
    const auto found = look_up(address, scheme, true);
    if (!found) return fail(found.error());
    int reason = 0;
    for (const addrinfo* where = found->get(); where != nullptr; where = where->ai_next) {
        TcpListener listener;
        listener.socket_ = listen_at(*where);
        reason = errno;
        if (!listener.socket_.open()) continue;
        sockaddr_storage name{};
        socklen_t size = sizeof name;
        if (::getsockname(listener.socket_.value(), reinterpret_cast<sockaddr*>(&name), &size) != 0) continue;
        listener.address_ = {address.host, numeric_address(name, size).port};
        listener.loopback_ = is_loopback(*where->ai_addr);
        return listener;
    }
    return fail(ErrorCode::outside,
                fmt::format("{} {}: cannot be listened at: {}", scheme, shown_address(address), std::strerror(reason)));
}

bool TcpListener::any_waits() const {
    pollfd look{socket_.value(), POLLIN, 0};
    return ::poll(&look, 1, 0) > 0;
}

std::optional<AcceptedTcp> TcpListener::accept() const {
    sockaddr_storage name{};
    socklen_t size = sizeof name;
    FileDescriptor socket(
        ::accept4(socket_.value(), reinterpret_cast<sockaddr*>(&name), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.open()) return std::nullopt;
    prepare_connection(socket.value());
    return AcceptedTcp{std::move(socket), shown_address(numeric_address(name, size))};
}

}  // namespace skyloop
