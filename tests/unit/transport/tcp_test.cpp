#include "wire/transport/tcp.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>

namespace skyloop {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

// A client on the loopback address that waits at most two seconds for anything.
class TcpClient {
public:
    explicit TcpClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in where{};
        where.sin_family = AF_INET;
        where.sin_port = htons(port);
        where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_.value(), reinterpret_cast<sockaddr*>(&where), sizeof where) == 0;
    }
    [[nodiscard]] bool connected() const { return connected_; }
    void write(std::string_view text) const {
        EXPECT_EQ(::send(socket_.value(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
    }
    // Until `least` bytes are there, or the other end has closed.
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
    // The other end has closed, with nothing more to read.
    [[nodiscard]] bool closed() const {
        char byte = 0;
        pollfd ready{socket_.value(), POLLIN, 0};
        return ::poll(&ready, 1, 2000) > 0 && ::recv(socket_.value(), &byte, 1, 0) <= 0;
    }
    void finish_sending() const { ::shutdown(socket_.value(), SHUT_WR); }
    // As when its process is killed with bytes unread: the other end hears a reset.
    void reset() {
        const linger at_once{1, 0};
        ::setsockopt(socket_.value(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        socket_ = FileDescriptor();
    }

private:
    FileDescriptor socket_;
    bool connected_ = false;
};

std::unique_ptr<TcpTransport> any_port() {
    auto wire = TcpTransport::listen({});
    EXPECT_TRUE(wire) << wire.error().message;
    return std::move(*wire);
}

// The kernel tells of what a client did a moment later.
template <class Condition>
bool comes_true(Condition condition) {
    for (int i = 0; i < 2000; ++i) {
        if (condition()) return true;
        ::usleep(1000);
    }
    return false;
}

std::string heard(TcpTransport& wire, std::size_t least) {
    std::string all;
    EXPECT_TRUE(comes_true([&] {
        all += to_string(wire.read());
        return all.size() >= least;
    }));
    return all;
}

TEST(TcpAddress, ReadsHostAndPort) {
    EXPECT_EQ(parse_tcp_address("2000")->host, "127.0.0.1");
    EXPECT_EQ(parse_tcp_address("2000")->port, 2000);
    EXPECT_EQ(parse_tcp_address("0.0.0.0:0")->host, "0.0.0.0");
    EXPECT_EQ(parse_tcp_address("[::1]:65535")->host, "::1");
    EXPECT_EQ(parse_tcp_address("[::1]:65535")->port, 65535);
    for (const std::string text :
         {"", ":", "host", "host:", ":2000", "65536", "-1", "2000x", "::1:2000", "[]:1", "a:+1"}) {
        const auto address = parse_tcp_address(text);
        ASSERT_FALSE(address) << text;
        EXPECT_EQ(address.error().code, ErrorCode::usage);
        EXPECT_THAT(address.error().message, HasSubstr("'" + text + "'"));
    }
}

TEST(TcpTransport, CarriesBytesBothWays) {
    const auto wire = any_port();
    EXPECT_EQ(wire->description(), "127.0.0.1:" + std::to_string(wire->port()) + " (tcp)");
    EXPECT_FALSE(wire->line().connected);
    EXPECT_EQ(wire->write(to_bytes("nobody listens")), 14U);
    const TcpClient client(wire->port());
    ASSERT_TRUE(client.connected());
    EXPECT_TRUE(comes_true([&] { return wire->line().connected; }));
    EXPECT_EQ(wire->line().baud, std::nullopt);
    EXPECT_EQ(wire->write(to_bytes("$GNGLL\r\n")), 8U);
    EXPECT_EQ(client.read(8), "$GNGLL\r\n") << "and nothing of before";
    client.write("poll");
    EXPECT_EQ(heard(*wire, 4), "poll");
    EXPECT_TRUE(wire->read().empty());
}

TEST(TcpTransport, TurnsAwayASecondClientAndTakesTheNext) {
    const auto wire = any_port();
    auto first = std::make_unique<TcpClient>(wire->port());
    EXPECT_TRUE(comes_true([&] { return wire->line().connected; }));
    const TcpClient second(wire->port());
    EXPECT_TRUE(comes_true([&] {
        wire->line();
        return wire->turned_away() == 1;
    }));
    EXPECT_TRUE(second.closed());
    EXPECT_THAT(wire->notice(), HasSubstr("1 more client came while one was connected and was closed at once"));
    wire->write(to_bytes("for the first"));
    EXPECT_EQ(first->read(13), "for the first");
    first->reset();
    EXPECT_TRUE(comes_true([&] { return !wire->line().connected; }));
    wire->write(to_bytes("for nobody"));
    const TcpClient third(wire->port());
    EXPECT_TRUE(comes_true([&] { return wire->line().connected; }));
    wire->write(to_bytes("fresh"));
    EXPECT_EQ(third.read(5), "fresh");
    EXPECT_EQ(wire->turned_away(), 1U);
}

// The look that finds the second connection must find the first one's end, too.
TEST(TcpTransport, WhoComesBackAtOnceIsNeverTurnedAway) {
    const auto wire = any_port();
    std::atomic<bool> over{false};
    std::thread loop([&] {
        while (!over)
            wire->write(to_bytes("x"));
    });
    for (int i = 0; i < 500; ++i) {
        TcpClient client(wire->port());
        EXPECT_FALSE(client.read(1).empty()) << i;
        client.reset();
    }
    over = true;
    loop.join();
    EXPECT_EQ(wire->turned_away(), 0U);
}

TEST(TcpTransport, AHalfClosedClientListensOnAndGivesWay) {
    const auto wire = any_port();
    const TcpClient half(wire->port());
    half.write("last words");
    half.finish_sending();
    EXPECT_EQ(heard(*wire, 10), "last words");
    EXPECT_TRUE(wire->line().connected);
    wire->write(to_bytes("still here"));
    EXPECT_EQ(half.read(10), "still here");
    const TcpClient next(wire->port());
    EXPECT_TRUE(half.closed() || comes_true([&] {
                    wire->line();
                    return half.closed();
                }));
    wire->write(to_bytes("new"));
    EXPECT_EQ(next.read(3), "new");
    EXPECT_EQ(wire->turned_away(), 0U);
}

TEST(TcpTransport, AClientThatDoesNotReadStallsNothing) {
    const auto wire = any_port();
    auto client = std::make_unique<TcpClient>(wire->port());
    EXPECT_TRUE(comes_true([&] { return wire->line().connected; }));
    std::size_t taken = 0, offered = 0;
    while (taken == offered && offered < 100'000'000) {
        taken += wire->write(Bytes(10'000, 7));
        offered += 10'000;
    }
    EXPECT_LT(taken, offered) << "all was taken";
    EXPECT_EQ(client->read(taken).size(), taken) << "what was taken arrives";
    client->reset();
    EXPECT_TRUE(comes_true([&] { return !wire->line().connected; }));
}

TEST(TcpTransport, AClientThatFloodsIsReadPieceByPiece) {
    const auto wire = any_port();
    const TcpClient client(wire->port());
    client.write(std::string(1000, 'x'));
    std::size_t most = 0, all = 0;
    EXPECT_TRUE(comes_true([&] {
        const std::size_t now = wire->read().size();
        most = std::max(most, now);
        all += now;
        return all == 1000;
    }));
    EXPECT_LE(most, 65536U + 4096U);
}

TEST(TcpTransport, RefusesWhatCannotBeHad) {
    const auto wire = any_port();
    TcpAddress taken;
    taken.port = wire->port();
    const auto second = TcpTransport::listen(taken);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::outside);
    EXPECT_THAT(second.error().message, EndsWith("cannot be listened at: Address already in use"));
    TcpAddress elsewhere;
    elsewhere.host = "192.0.2.1";  // TEST-NET-1 of RFC 5737: nobody's
    EXPECT_FALSE(TcpTransport::listen(elsewhere));
}

}  // namespace
}  // namespace skyloop
