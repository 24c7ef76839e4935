#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/core/number_text.hpp"
#include "detail/tcp_socket.hpp"

namespace skyloop::inline wire {
namespace {

// Bounds how old the bytes of a slow client grow. Each write of some bytes a millisecond travels alone and takes some 2
// kB until it is acknowledged, which clients may put off for 40 ms and more: much less would lose bytes of a client
// that reads.
constexpr int send_buffer_bytes = 262144;

}  // namespace

Result<AddressList> look_up(const TcpAddress& address, const std::string& scheme, bool to_listen) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    wanted.ai_flags = AI_NUMERICSERV | (to_listen ? AI_PASSIVE : 0);
    addrinfo* first = nullptr;
    if (const int error = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &first);
        error != 0)
        return fail(ErrorCode::outside,
                    fmt::format("{} {}: {}", scheme, shown_address(address), ::gai_strerror(error)));
    return AddressList(first);
}

bool is_loopback(const sockaddr& address) {
    constexpr std::uint32_t loopback_net = 127;  // 127.0.0.0/8 (RFC 1122, section 3.2.1.3)
    if (address.sa_family == AF_INET)
        return ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >> 24U == loopback_net;
    if (address.sa_family != AF_INET6) return false;
    const in6_addr& six = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
    return IN6_IS_ADDR_LOOPBACK(&six) || (IN6_IS_ADDR_V4MAPPED(&six) && six.s6_addr[12] == loopback_net);
}

FileDescriptor make_socket(const addrinfo& where) {
    FileDescriptor socket(::socket(where.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, where.ai_protocol));
    if (socket.open()) set_socket_option(socket.value(), SOL_SOCKET, SO_SNDBUF, send_buffer_bytes);
    return socket;
}

StreamState receive_available(int socket, Bytes& bytes, std::size_t most) {
    std::array<std::uint8_t, 4096> piece;
    while (bytes.size() < most) {
        const ssize_t count = ::recv(socket, piece.data(), std::min(piece.size(), most - bytes.size()), MSG_DONTWAIT);
        if (count > 0)
            bytes.insert(bytes.end(), piece.begin(), piece.begin() + count);
        else if (count == 0)
            return StreamState::finished;
        else if (errno == EAGAIN)
            break;
        else if (errno != EINTR)
            return StreamState::gone;
    }
    return StreamState::open;
}

std::size_t send_available(int socket, ByteSpan bytes, StreamState& state) {
    std::size_t taken = 0;
    while (taken < bytes.size()) {
        const ssize_t count = ::send(socket, bytes.data() + taken, bytes.size() - taken, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count > 0) {
            taken += static_cast<std::size_t>(count);
        } else if (count < 0 && errno != EAGAIN && errno != EINTR) {
            state = StreamState::gone;
            break;
        } else if (count == 0 || errno == EAGAIN) {
            break;
        }
    }
    return taken;
}

namespace {

constexpr int waiting_clients = 16;

// A listening socket, or nothing with errno set.
FileDescriptor listen_at(const addrinfo& where) {
    FileDescriptor server = make_socket(where);  // its clients inherit the buffer
    if (!server.open()) return {};
    // A run that follows another finds its port free, though old connections still linger in TIME_WAIT.
    set_socket_option(server.value(), SOL_SOCKET, SO_REUSEADDR, 1);
    if (::bind(server.value(), where.ai_addr, where.ai_addrlen) != 0 || ::listen(server.value(), waiting_clients) != 0)
        return {};
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

}  // namespace skyloop::inline wire
