#include "wire/transport/rfc2217.hpp"

#include <gmock/gmock.h>

#include "tcp_peer.hpp"

namespace skyloop {
namespace {

using test::becomes_true;
using test::TcpPeer;
using testing::EndsWith;
using testing::HasSubstr;

const std::string hello("\xff\xfb\0\xff\xfd\0\xff\xfb\3\xff\xfd\3\xff\xfb\x2c\xff\xfd\x2c", 18);
const std::string modem_lines("\xff\xfa\x2c\x6b\xb0\xff\xf0", 7);
const std::string speed_9600("\xff\xfa\x2c\1\0\0\x25\x80\xff\xf0", 10);

std::unique_ptr<Rfc2217Transport> any_com_port() {
    auto wire = Rfc2217Transport::listen({});
    EXPECT_TRUE(wire) << wire.error().message;
    return std::move(*wire);
}

// A client that has been met.
TcpPeer met_client(Rfc2217Transport& wire) {
    TcpPeer client = TcpPeer::to(wire.port());
    EXPECT_TRUE(becomes_true([&] { return wire.line().connected; }));
    wire.line();
    EXPECT_EQ(client.read(hello.size()), hello);
    client.write("\xff\xfb\x2c");
    EXPECT_TRUE(becomes_true([&] {
        wire.line();
        return wire.agreed();
    }));
    EXPECT_EQ(client.read(modem_lines.size()), modem_lines);
    return client;
}

TEST(Rfc2217Transport, CarriesEveryByteBothWays) {
    const auto wire = any_com_port();
    EXPECT_THAT(wire->description(), EndsWith(" (rfc2217)"));
    EXPECT_FALSE(wire->line().connected);
    const TcpPeer client = met_client(*wire);
    EXPECT_EQ(wire->write(Bytes{1, 255, 2}), 3U);
    EXPECT_EQ(client.read(4), "\1\xff\xff\2");
    client.write("\3\xff\xff\4");
    Bytes heard;
    EXPECT_TRUE(becomes_true([&] {
        const Bytes piece = wire->read();
        heard.insert(heard.end(), piece.begin(), piece.end());
        return heard.size() >= 3;
    }));
    EXPECT_EQ(heard, (Bytes{3, 255, 4}));
}

TEST(Rfc2217Transport, TheClientsSpeedIsTheLines) {
    const auto wire = any_com_port();
    wire->set_receiver_baud(38400);
    const TcpPeer client = met_client(*wire);
    EXPECT_EQ(wire->line().baud, std::nullopt) << "none set: the receiver's";
    client.write("before" + speed_9600 + "after");
    std::string heard;
    std::vector<std::optional<std::uint32_t>> bauds;
    EXPECT_TRUE(becomes_true([&] {
        const auto baud = wire->line().baud;
        const std::string piece = to_string(wire->read());
        if (!piece.empty()) bauds.push_back(baud);
        heard += piece;
        return heard.size() >= 11;
    }));
    EXPECT_EQ(heard, "beforeafter");
    EXPECT_THAT(bauds, testing::ElementsAre(std::nullopt, 9600U));
    EXPECT_EQ(client.read(10), std::string("\xff\xfa\x2c\x65\0\0\x25\x80\xff\xf0", 10));
}

TEST(Rfc2217Transport, ASuspendedFlowLosesBytes) {
    const auto wire = any_com_port();
    const TcpPeer client = met_client(*wire);
    client.write("\xff\xfa\x2c\x8\xff\xf0");
    EXPECT_TRUE(becomes_true([&] {
        wire->line();
        return wire->settings().suspended;
    }));
    EXPECT_EQ(wire->write(to_bytes("lost")), 0U);
    client.write("\xff\xfa\x2c\x9\xff\xf0");
    EXPECT_TRUE(becomes_true([&] { return wire->write(to_bytes("heard")) == 5; }));
    EXPECT_EQ(client.read(5), "heard");
}

TEST(Rfc2217Transport, TheNextClientBeginsAnew) {
    const auto wire = any_com_port();
    {
        TcpPeer first = met_client(*wire);
        first.write(speed_9600 + "\xff\xfa\x2c\x8\xff\xf0" + "\xff\xfa");
        EXPECT_TRUE(becomes_true([&] { return wire->line().baud == 9600U; }));
        first.reset();
    }
    EXPECT_TRUE(becomes_true([&] { return !wire->line().connected; }));
    const TcpPeer second = met_client(*wire);
    EXPECT_EQ(wire->line().baud, std::nullopt);
    EXPECT_FALSE(wire->settings().suspended);
    EXPECT_EQ(wire->write(to_bytes("fresh")), 5U);
    EXPECT_EQ(second.read(5), "fresh");
}

// The half of an escaped byte that did not fit comes first when there is room again.
TEST(Rfc2217Transport, AClientThatDoesNotReadLosesBytesAndKeepsTheStreamWhole) {
    const auto wire = any_com_port();
    const TcpPeer client = met_client(*wire);
    const Bytes block(100001, 255);
    std::size_t taken = 0;
    for (std::size_t last = 1; last > 0; taken += last)
        last = wire->write(block);
    EXPECT_LT(taken, 64'000'000U);
    std::string heard = client.read(2 * taken - 1);
    for (int i = 0; i < 100; ++i)
        wire->line();
    taken += wire->write(Bytes{'x'});
    while (heard.size() < 2 * taken - 1) {
        const std::string piece = client.read(1);
        if (piece.empty()) break;
        heard += piece;
    }
    EXPECT_EQ(heard.size(), 2 * taken - 1);
    EXPECT_EQ(heard.find_first_not_of('\xff'), heard.size() - 1);
}

TEST(Rfc2217Transport, AFloodOfCommandsDoesNotHoldTheLoop) {
    const auto wire = any_com_port();
    const TcpPeer client = met_client(*wire);
    constexpr std::size_t asked = 8 * 64;
    const std::string answer = modem_lines;
    for (std::size_t i = 0; i < asked; ++i)
        client.write(std::string("\xff\xfa\x2c\7\xff\xf0", 6));
    int looks = 0;
    std::string heard;
    while (heard.size() < asked * answer.size() && looks < 1000) {
        wire->line();
        ++looks;
        heard += client.read(64 * answer.size());
    }
    EXPECT_EQ(heard.size(), asked * answer.size());
    EXPECT_GE(looks, 8) << "64 of them at a look";
}

TEST(Rfc2217Transport, WarnsOffLoopback) {
    EXPECT_TRUE(any_com_port()->take_news().empty());
    const auto open_to_all = Rfc2217Transport::listen({"0.0.0.0", 0});
    ASSERT_TRUE(open_to_all) << open_to_all.error().message;
    EXPECT_THAT((*open_to_all)->take_news(), testing::ElementsAre(HasSubstr("can read and configure the receiver")));
    EXPECT_EQ(Rfc2217Transport::listen({"no.such.host.invalid", 0}).error().code, ErrorCode::outside);
}

}  // namespace
}  // namespace skyloop
