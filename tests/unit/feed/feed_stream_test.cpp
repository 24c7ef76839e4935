#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>

#include "run/feed/detail/feed_link.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

FeedPeer peer_at(const char* host, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    inet_pton(AF_INET, host, &address.sin_addr);
    FeedPeer peer;
    std::memcpy(&peer.storage, &address, sizeof address);
    peer.length = sizeof address;
    return peer;
}

// A broadcast is refused by the system at once, before anything is sent.
const FeedPeer off_the_net = peer_at("255.255.255.255", 9);

TEST(StreamConnector, SaysWhyAnAddressCannotEvenBeTried) {
    StreamConnector connector({off_the_net});
    std::string why;
    EXPECT_FALSE(connector.look(0, why).open());
    EXPECT_THAT(why, HasSubstr("etwork"));
    why.clear();
    EXPECT_FALSE(connector.look(100'000'000, why).open());
    EXPECT_EQ(why, "") << "it rests before the next attempt";
    EXPECT_FALSE(connector.look(200'000'000, why).open());
    EXPECT_NE(why, "");
}

TEST(StreamConnector, TriesTheNextAddressAtOnce) {
    const auto server = listening_socket({"127.0.0.1", 0}, SOCK_STREAM);
    ASSERT_TRUE(server) << server.error().message;
    StreamConnector connector({off_the_net, peer_at("127.0.0.1", own_port(server->value()))});
    std::string why;
    EXPECT_FALSE(connector.look(0, why).open());
    FileDescriptor connection = connector.look(1, why);
    for (int i = 0; i < 100 && !connection.open(); ++i)
        connection = connector.look(2 + i, why);
    EXPECT_TRUE(connection.open()) << why;
}

TEST(FinishConnecting, TakesNoConnectionWithItselfForASource) {
    FileDescriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
    const FeedPeer any = peer_at("127.0.0.1", 0);
    ASSERT_EQ(::bind(socket.value(), any.get(), any.length), 0);
    const FeedPeer own = peer_at("127.0.0.1", own_port(socket.value()));
    ASSERT_EQ(::connect(socket.value(), own.get(), own.length), 0) << "the kernel lets a socket call itself";
    std::string why;
    EXPECT_EQ(finish_connecting(socket.value(), why), ConnectState::failed);
    EXPECT_EQ(why, "Connection refused");
}

TEST(FeedStream, KeepsTheOrderOfWhatASlowReaderLeaves) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    FeedStream stream{FileDescriptor(ends[0])};
    const FileDescriptor reader(ends[1]);
    Bytes said, heard(65536);
    while (stream.waiting() < 100'000) {
        const Bytes piece(10'000, static_cast<std::uint8_t>(said.size() / 10'000));
        said.insert(said.end(), piece.begin(), piece.end());
        stream.send(piece);
    }
    Bytes all;
    for (ssize_t count = 0; (count = ::recv(reader.value(), heard.data(), heard.size(), MSG_DONTWAIT)) > 0;) {
        all.insert(all.end(), heard.begin(), heard.begin() + count);
        stream.send_waiting();
    }
    EXPECT_EQ(stream.waiting(), 0U);
    EXPECT_EQ(all, said);
}

}  // namespace
}  // namespace skyloop
