/// The other end of a TCP wire, for tests.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <string_view>

#include "base/core/file_descriptor.hpp"

namespace skyloop::test {

/// A connection on the loopback address that waits at most two seconds for anything.
class TcpPeer {
public:
    /// A client of a server at this port.
    static TcpPeer to(std::uint16_t port) {
        TcpPeer peer{FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0))};
        const sockaddr_in where = loopback(port);
        EXPECT_EQ(::connect(peer.socket_.value(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
        return peer;
    }
    explicit TcpPeer(FileDescriptor socket) : socket_(std::move(socket)) {}

    static sockaddr_in loopback(std::uint16_t port) {
        sockaddr_in where{};
        where.sin_family = AF_INET;
        where.sin_port = htons(port);
        where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return where;
    }
    void write(std::string_view text) const {
        EXPECT_EQ(::send(socket_.value(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
    }
    /// Until `least` bytes are there, or the other end has closed.
    [[nodiscard]] std::string read(std::size_t least) const {
        std::string all;
        std::array<char, 65536> piece{};
        pollfd ready{socket_.value(), POLLIN, 0};
        while (all.size() < least && ::poll(&ready, 1, 2000) > 0) {
            const ssize_t count = ::recv(socket_.value(), piece.data(), piece.size(), 0);
            if (count <= 0) break;
            all.append(piece.data(), static_cast<std::size_t>(count));
        }
        return all;
    }
    /// As when its process is killed with bytes unread: the other end hears a reset.
    void reset() {
        const linger at_once{1, 0};
        ::setsockopt(socket_.value(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        socket_ = FileDescriptor();
    }
    void close() { socket_ = FileDescriptor(); }

private:
    FileDescriptor socket_;
};

/// A server on the loopback address.
class PlayedServer {
public:
    explicit PlayedServer(std::uint16_t port = 0) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const int yes = 1;
        ::setsockopt(socket_.value(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        sockaddr_in where = TcpPeer::loopback(port);
        EXPECT_EQ(::bind(socket_.value(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
        EXPECT_EQ(::listen(socket_.value(), 4), 0);
        socklen_t size = sizeof where;
        ::getsockname(socket_.value(), reinterpret_cast<sockaddr*>(&where), &size);
        port_ = ntohs(where.sin_port);
    }
    [[nodiscard]] std::uint16_t port() const { return port_; }
    /// The next one that has called; waits two seconds.
    [[nodiscard]] TcpPeer accept() const {
        pollfd ready{socket_.value(), POLLIN, 0};
        EXPECT_GT(::poll(&ready, 1, 2000), 0);
        return TcpPeer{FileDescriptor(::accept4(socket_.value(), nullptr, nullptr, SOCK_CLOEXEC))};
    }

private:
    FileDescriptor socket_;
    std::uint16_t port_ = 0;
};

/// Asks again and again for two seconds: the kernel tells of what the other end did a moment later.
template <class Condition>
bool becomes_true(Condition condition) {
    for (int i = 0; i < 2000; ++i) {
        if (condition()) return true;
        ::usleep(1000);
    }
    return false;
}

}  // namespace skyloop::test
