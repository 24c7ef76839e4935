#include "wire/transport/tcp_connection.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cstring>

namespace skyloop {
namespace {

constexpr unsigned patience_ms = 60000;  // with an other end that acknowledges nothing
constexpr int keep_alive_idle_s = 30, keep_alive_every_s = 10, keep_alive_tries = 3;

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

}  // namespace skyloop
