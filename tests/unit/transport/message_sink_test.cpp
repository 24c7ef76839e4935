// Whole messages, whatever the other ends do.
#include "wire/transport/message_sink.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "tcp_peer.hpp"
#include "temporary_folder.hpp"
#include "wire/transport/file.hpp"
#include "wire/transport/tcp_client.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::becomes_true;
using test::PlayedServer;
using test::TcpPeer;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

// A socket for datagrams on the loopback address.
class PlayedUdp {
public:
    PlayedUdp() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in where = TcpPeer::loopback(0);
        EXPECT_EQ(::bind(socket_.value(), reinterpret_cast<const sockaddr*>(&where), sizeof where), 0);
        socklen_t size = sizeof where;
        ::getsockname(socket_.value(), reinterpret_cast<sockaddr*>(&where), &size);
        port_ = ntohs(where.sin_port);
    }
    [[nodiscard]] std::uint16_t port() const { return port_; }
    // The next datagram; waits two seconds.
    [[nodiscard]] std::string next() const {
        std::array<char, 65536> bytes{};
        pollfd ready{socket_.value(), POLLIN, 0};
        if (::poll(&ready, 1, 2000) <= 0) return "nothing";
        const ssize_t size = ::recv(socket_.value(), bytes.data(), bytes.size(), 0);
        return {bytes.data(), static_cast<std::size_t>(size)};
    }
    void close() { socket_ = FileDescriptor(); }

private:
    FileDescriptor socket_;
    std::uint16_t port_ = 0;
};

std::uint16_t port_of(const MessageSink& sink) {
    const std::string text = sink.description();
    std::uint16_t port = 0;
    std::from_chars(text.data() + text.find(':') + 1, text.data() + text.size(), port);
    return port;
}

std::unique_ptr<MessageSink> served() {
    auto sink = open_tcp_server_sink({"127.0.0.1", 0});
    EXPECT_TRUE(sink) << sink.error().message;
    return std::move(*sink);
}

void send_text(MessageSink& sink, const std::string& text) { sink.send(to_bytes(text)); }

TEST(UdpSink, SendsADatagramForEachMessage) {
    const PlayedUdp peer;
    const auto sink = open_udp_sink({"127.0.0.1", peer.port()});
    ASSERT_TRUE(sink) << sink.error().message;
    EXPECT_EQ((*sink)->description(), "127.0.0.1:" + std::to_string(peer.port()) + " (udp)");
    send_text(**sink, "one");
    send_text(**sink, "two, which is longer");
    EXPECT_EQ(peer.next(), "one");
    EXPECT_EQ(peer.next(), "two, which is longer");
    EXPECT_EQ((*sink)->counts(), (SinkCounts{2, 23, 0, 0}));
    EXPECT_THAT((*sink)->take_news(), IsEmpty());
}

TEST(UdpSink, CountsWhatIsRefusedTellsItOnceAndGoesOn) {
    PlayedUdp gone;
    const std::uint16_t port = gone.port();
    gone.close();
    const auto sink = open_udp_sink({"127.0.0.1", port});
    ASSERT_TRUE(sink) << sink.error().message;
    for (int i = 0; i < 50; ++i)
        send_text(**sink, "to nobody");
    const SinkCounts counts = (*sink)->counts();
    EXPECT_EQ(counts.messages, 50U);
    EXPECT_GT(counts.lost, 0U);
    const auto news = (*sink)->take_news();
    ASSERT_EQ(news.size(), 1U);
    EXPECT_THAT(news.front(), HasSubstr("refused"));
    // Longer than any datagram.
    (*sink)->send(Bytes(70000, 0x41));
    EXPECT_EQ((*sink)->counts().lost, counts.lost + 1);
    EXPECT_THAT((*sink)->take_news(), IsEmpty());
}

TEST(UdpSink, SaysWhatCannotBe) {
    const auto none = open_udp_sink({"127.0.0.1", 0});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::usage);
    const auto unknown = open_udp_sink({"no.such.host.invalid", 1});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::outside);
    EXPECT_THAT(unknown.error().message, HasSubstr("no.such.host.invalid:1"));
}

TEST(TcpServerSink, TellsEveryClientTheSameFromItsArrivalOn) {
    const auto sink = served();
    EXPECT_THAT(sink->description(), EndsWith(" (tcp)"));
    send_text(*sink, "nobody hears this\n");
    EXPECT_EQ(sink->counts(), (SinkCounts{0, 0, 1, 0}));
    const TcpPeer first = TcpPeer::to(port_of(*sink));
    ASSERT_TRUE(becomes_true([&] {
        send_text(*sink, "a\n");
        return sink->counts().messages > 0;
    }));
    const TcpPeer second = TcpPeer::to(port_of(*sink));
    const std::uint64_t before = sink->counts().messages;
    ASSERT_TRUE(becomes_true([&] {
        const std::uint64_t count = sink->counts().messages;
        send_text(*sink, "b\n");
        return sink->counts().messages == count + 2;
    }));
    EXPECT_THAT(first.read(4), testing::StartsWith("a\n"));
    EXPECT_THAT(second.read(2), testing::StartsWith("b\n"));
    EXPECT_GT(sink->counts().messages, before);
    EXPECT_EQ(sink->counts().lost, 0U);
}

// One stops to read: it loses whole messages, and the other none.
TEST(TcpServerSink, AClientThatDoesNotReadLosesWholeMessagesAndDisturbsNobody) {
    const auto sink = served();
    const TcpPeer lazy = TcpPeer::to(port_of(*sink));
    const TcpPeer diligent = TcpPeer::to(port_of(*sink));
    ASSERT_TRUE(becomes_true([&] {
        const std::uint64_t count = sink->counts().messages;
        send_text(*sink, "-\n");
        return sink->counts().messages == count + 2;
    }));
    const std::string filling(4000, 'x');
    std::string heard;
    constexpr int messages = 3000;
    for (int i = 0; i < messages; ++i) {
        send_text(*sink, std::to_string(i) + filling + "\n");
        if (i % 10 == 0) heard += diligent.read(20000);
    }
    EXPECT_GT(sink->counts().lost, 100U);
    const auto news = sink->take_news();
    ASSERT_EQ(news.size(), 1U);
    EXPECT_THAT(news.front(), HasSubstr("reads too slowly"));
    const std::string last = std::to_string(messages - 1) + filling + "\n";
    while (!heard.ends_with(last)) {
        const std::string more = diligent.read(1);
        ASSERT_FALSE(more.empty());
        heard += more;
    }
    EXPECT_EQ(std::count(heard.begin(), heard.end(), '\n') - std::count(heard.begin(), heard.end(), '-'), messages);

    // What the lazy one gets in the end are whole lines, of which some are missing.
    std::string late;
    while (!late.ends_with("end\n")) {
        late += lazy.read(1);
        send_text(*sink, "end\n");
    }
    std::istringstream lines(late);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count)
        if (line != "-" && line != "end") {
            EXPECT_THAT(line, EndsWith(filling)) << count;
        }
    EXPECT_GT(count, 50);
    EXPECT_LT(count, messages);
}

TEST(TcpServerSink, AClientThatBreaksAwayIsForgotten) {
    const auto sink = served();
    TcpPeer broken = TcpPeer::to(port_of(*sink));
    ASSERT_TRUE(becomes_true([&] {
        send_text(*sink, "a");
        return sink->counts().messages > 0;
    }));
    broken.reset();
    ASSERT_TRUE(becomes_true([&] {
        const std::uint64_t unheard = sink->counts().unheard;
        send_text(*sink, "b");
        return sink->counts().unheard > unheard;
    }));
    const TcpPeer next = TcpPeer::to(port_of(*sink));
    ASSERT_TRUE(becomes_true([&] {
        const std::uint64_t count = sink->counts().messages;
        send_text(*sink, "c");
        return sink->counts().messages > count;
    }));
    EXPECT_EQ(next.read(1).front(), 'c');
}

TEST(TcpServerSink, WaitsForAReaderWhenItMayAndThenNeverAgain) {
    const auto sink = served();
    sink->wait_for_readers(100ms);
    const TcpPeer lazy = TcpPeer::to(port_of(*sink));
    ASSERT_TRUE(becomes_true([&] {
        send_text(*sink, "a");
        return sink->counts().messages > 0;
    }));
    const Bytes large(100000, 'x');
    const auto begin = std::chrono::steady_clock::now();
    while (sink->counts().lost == 0)
        sink->send(large);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 100ms);
    const auto later = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i)
        sink->send(large);
    EXPECT_LT(std::chrono::steady_clock::now() - later, 1s);
    EXPECT_EQ(sink->counts().lost, 21U);
}

TEST(WireSink, CallsAServerAndCountsWhatNobodyHeard) {
    const PlayedServer server;
    auto wire = TcpClientTransport::open({"127.0.0.1", server.port()});
    ASSERT_TRUE(wire);
    const auto sink = make_wire_sink(std::move(*wire));
    sink->wait_for_readers(2000ms);
    TcpPeer peer = server.accept();
    send_text(*sink, "hello");
    EXPECT_EQ(peer.read(5), "hello");
    peer.reset();
    ASSERT_TRUE(becomes_true([&] {
        send_text(*sink, "lost");
        return sink->counts().unheard > 0;
    }));
    EXPECT_THAT(sink->take_news(), testing::Contains(HasSubstr("connection lost; trying again")));
}

TEST(WireSink, WritesAFile) {
    const TemporaryFolder folder;
    auto file = FileTransport::open(folder / "out");
    ASSERT_TRUE(file);
    {
        const auto sink = make_wire_sink(std::move(*file));
        send_text(*sink, "one\n");
        send_text(*sink, "two\n");
        EXPECT_EQ(sink->counts(), (SinkCounts{2, 8, 0, 0}));
        EXPECT_EQ(sink->failure(), "");
    }
    std::ifstream written(folder / "out");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), "one\ntwo\n");
}

}  // namespace
}  // namespace skyloop
