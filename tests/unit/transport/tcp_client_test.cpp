#include "wire/transport/tcp_client.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "tcp_peer.hpp"

namespace skyloop {
namespace {

using test::becomes_true;
using test::PlayedServer;
using test::TcpPeer;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

std::unique_ptr<TcpClientTransport> calling(std::uint16_t port) {
    auto wire = TcpClientTransport::open({"127.0.0.1", port});
    EXPECT_TRUE(wire) << wire.error().message;
    return std::move(*wire);
}

std::string taken_in(Transport& wire, std::size_t least) {
    std::string all;
    EXPECT_TRUE(becomes_true([&] {
        all += to_string(wire.read());
        return all.size() >= least;
    }));
    return all;
}

TEST(TcpClientTransport, CarriesBytesBothWays) {
    const PlayedServer server;
    const auto wire = calling(server.port());
    const TcpPeer peer = server.accept();
    EXPECT_TRUE(becomes_true([&] { return wire->line().connected; }));
    EXPECT_EQ(wire->line().baud, std::nullopt);
    EXPECT_EQ(wire->write(to_bytes("$GNGLL\r\n")), 8U);
    EXPECT_EQ(peer.read(8), "$GNGLL\r\n");
    peer.write("poll");
    EXPECT_EQ(taken_in(*wire, 4), "poll");
    EXPECT_EQ(wire->description(), "127.0.0.1:" + std::to_string(server.port()) + " (tcp-connect)");
}

TEST(TcpClientTransport, CallsAgainWhenTheServerHasGone) {
    const PlayedServer server;
    const auto wire = calling(server.port());
    {
        TcpPeer first = server.accept();
        EXPECT_TRUE(becomes_true([&] { return wire->line().connected; }));
        first.write("last words");
        first.close();
    }
    EXPECT_EQ(taken_in(*wire, 10), "last words");
    EXPECT_TRUE(becomes_true([&] { return !wire->line().connected; }));
    EXPECT_EQ(wire->write(to_bytes("to nobody")), 9U);
    EXPECT_TRUE(becomes_true([&] { return wire->line().connected; }));
    const TcpPeer second = server.accept();
    EXPECT_EQ(wire->write(to_bytes("fresh")), 5U);
    EXPECT_EQ(second.read(5), "fresh") << "and nothing of before";
    EXPECT_EQ(wire->connections(), 2U);
    EXPECT_THAT(wire->take_news(), ElementsAre(HasSubstr("connected"), HasSubstr("connection lost; trying again"),
                                               HasSubstr("connected")));
    EXPECT_TRUE(wire->take_news().empty());
}

TEST(TcpClientTransport, WaitsForAServerThatComesLater) {
    const std::uint16_t port = PlayedServer().port();
    const auto wire = calling(port);
    EXPECT_TRUE(becomes_true([&] {
        wire->line();
        const auto news = wire->take_news();
        return news.size() == 1 && news[0].find("Connection refused; trying again") != std::string::npos;
    }));
    const PlayedServer server(port);
    EXPECT_TRUE(becomes_true([&] { return wire->line().connected; }));
    EXPECT_THAT(wire->take_news(), ElementsAre(EndsWith(": connected"))) << "a failure of a row is told once";
}

// The kernel answers meanwhile; no time passes for the wire.
bool connects(Transport& wire) {
    for (int i = 0; i < 20 && !wire.line().connected; ++i)
        ::usleep(1000);
    return wire.line().connected;
}

// Alone for so long, and so much later there is a server: whether it is called at once.
bool calls_after(std::chrono::nanoseconds alone, std::chrono::nanoseconds pause) {
    const std::uint16_t port = PlayedServer().port();
    std::chrono::nanoseconds now{0};
    const auto wire = std::move(*TcpClientTransport::open({"127.0.0.1", port}, [&] { return now.count(); }));
    now = alone;
    EXPECT_FALSE(connects(*wire)) << "nobody is there";
    const PlayedServer server(port);
    now += pause;
    return connects(*wire);
}

TEST(TcpClientTransport, CallsEveryFewMillisecondsForAMinute) {
    using namespace std::chrono_literals;
    EXPECT_TRUE(calls_after(0s, 5ms)) << "a UART of Betaflight's SITL must find somebody at its first byte";
    EXPECT_TRUE(calls_after(59s, 5ms));
    EXPECT_FALSE(calls_after(0s, 4ms));
    EXPECT_FALSE(calls_after(60s, 490ms)) << "then it has come, or comes some time";
    EXPECT_TRUE(calls_after(60s, 500ms));
}

TEST(TcpClientTransport, HurriesAgainAfterALostConnection) {
    using namespace std::chrono_literals;
    const PlayedServer server;
    std::chrono::nanoseconds now{0};
    const auto wire = std::move(*TcpClientTransport::open({"127.0.0.1", server.port()}, [&] { return now.count(); }));
    EXPECT_TRUE(connects(*wire));
    now = 1h;  // its server starts anew
    server.accept().close();
    EXPECT_TRUE(becomes_true([&] { return !wire->line().connected; }));
    now += 5ms;
    EXPECT_TRUE(connects(*wire));
}

TEST(TcpClientTransport, SurvivesAResetWhileItWrites) {
    const PlayedServer server;
    const auto wire = calling(server.port());
    TcpPeer peer = server.accept();
    EXPECT_TRUE(becomes_true([&] { return wire->line().connected; }));
    peer.reset();
    EXPECT_TRUE(becomes_true([&] {
        EXPECT_EQ(wire->write(to_bytes("epoch")), 5U);
        return !wire->line().connected;
    }));
}

TEST(TcpClientTransport, RefusesWhatCannotBeCalled) {
    EXPECT_EQ(TcpClientTransport::open({"127.0.0.1", 0}).error().code, ErrorCode::usage);
    const auto unknown = TcpClientTransport::open({"no.such.host.invalid", 2000});
    EXPECT_EQ(unknown.error().code, ErrorCode::outside);
    EXPECT_THAT(unknown.error().message, testing::StartsWith("tcp-connect no.such.host.invalid:2000"));
}

}  // namespace
}  // namespace skyloop
