#include "wire/transport/usbip_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <iterator>

#include "base/core/file_descriptor.hpp"
#include "usbip_host.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Bytes list_request = test::words({0x01118005, 0});
Bytes import_request(std::string_view bus_id = "1-1") {
    Bytes bytes = test::words({0x01118003, 0});
    bytes.insert(bytes.end(), bus_id.begin(), bus_id.end());
    bytes.resize(40);
    return bytes;
}
constexpr std::size_t import_reply_bytes = 320;

// A client on the loopback address; the server under test is looked after while it waits.
class UsbipVisitor {
public:
    explicit UsbipVisitor(UsbipTransport& server) : server_(server), socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in where{};
        where.sin_family = AF_INET;
        where.sin_port = htons(server.port());
        where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_.value(), reinterpret_cast<sockaddr*>(&where), sizeof where), 0);
    }
    void write(const Bytes& bytes) {
        EXPECT_EQ(::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(bytes.size()));
    }
    // So many bytes, or fewer when the server has closed.
    Bytes read(std::size_t count) {
        for (int i = 0; i < 3000 && heard_.size() < count && !closed_; ++i) {
            server_.line();
            std::array<std::uint8_t, 4096> piece{};
            const ssize_t got = ::recv(socket_.value(), piece.data(), piece.size(), MSG_DONTWAIT);
            if (got > 0) heard_.insert(heard_.end(), piece.begin(), piece.begin() + got);
            if (got == 0 || (got < 0 && errno != EAGAIN)) closed_ = true;
            if (got < 0) ::usleep(1000);
        }
        const auto end = heard_.begin() + static_cast<std::ptrdiff_t>(std::min(count, heard_.size()));
        const Bytes bytes(heard_.begin(), end);
        heard_.erase(heard_.begin(), end);
        return bytes;
    }
    bool is_closed() { return read(1).empty() && closed_; }
    bool import() {
        write(import_request());
        return read(import_reply_bytes).size() == import_reply_bytes;
    }
    // Configured, with a transfer of data that waits.
    void open_terminal() {
        write(test::set_configuration(1));
        write(test::submit_in(2, CdcAcmDevice::data_in, 4096));
        EXPECT_EQ(read(usbip_header_bytes).size(), usbip_header_bytes);
    }
    void reset() {
        const linger at_once{1, 0};
        ::setsockopt(socket_.value(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
        close();
    }
    void close() { socket_ = FileDescriptor(); }

private:
    UsbipTransport& server_;
    FileDescriptor socket_;
    Bytes heard_;
    bool closed_ = false;
};

std::unique_ptr<UsbipTransport> usbip_server() {
    auto server = UsbipTransport::listen({}, {{0x1546, 0x01a8}, 0x0301, "maker", "receiver", ""});
    EXPECT_TRUE(server) << server.error().message;
    return std::move(*server);
}

template <class Condition>
bool in_time(UsbipTransport& server, Condition condition) {
    for (int i = 0; i < 3000; ++i) {
        server.line();
        if (condition()) return true;
        ::usleep(1000);
    }
    return false;
}

TEST(UsbipTransport, IsListedAtAnyTime) {
    const auto server = usbip_server();
    EXPECT_THAT(server->description(), HasSubstr("127.0.0.1:" + std::to_string(server->port()) + " (usbip)"));
    UsbipVisitor host(*server);
    ASSERT_TRUE(host.import());
    UsbipVisitor visitor(*server);
    visitor.write(list_request);
    EXPECT_EQ(visitor.read(1000).size(), 332U);
    EXPECT_TRUE(visitor.is_closed());
    UsbipVisitor second(*server);
    second.write(import_request());
    EXPECT_EQ(second.read(1000), test::words({0x01110003, 2})) << "busy";
    UsbipVisitor elsewhere(*server);
    elsewhere.write(import_request("2-1"));
    EXPECT_EQ(elsewhere.read(1000), test::words({0x01110003, 4})) << "no such device";
    EXPECT_EQ(server->imports(), 1U);
}

TEST(UsbipTransport, SilentVisitorsGiveWay) {
    const auto server = usbip_server();
    std::vector<std::unique_ptr<UsbipVisitor>> silent;
    for (int i = 0; i < 8; ++i)
        silent.push_back(std::make_unique<UsbipVisitor>(*server));
    for (int i = 0; i < 50; ++i) {
        server->line();
        ::usleep(1000);
    }
    UsbipVisitor visitor(*server);
    visitor.write(list_request);
    EXPECT_EQ(visitor.read(1000).size(), 332U) << "at once, not when they have been waited for";
    EXPECT_TRUE(silent.front()->is_closed()) << "the oldest";
    silent.back()->write(list_request);
    EXPECT_EQ(silent.back()->read(1000).size(), 332U);
}

TEST(UsbipTransport, CarriesBytesBothWays) {
    const auto server = usbip_server();
    EXPECT_FALSE(server->line().connected);
    EXPECT_EQ(server->write(to_bytes("to nobody")), 9U);
    UsbipVisitor host(*server);
    ASSERT_TRUE(host.import());
    EXPECT_FALSE(server->line().connected) << "no program has opened the terminal";
    host.open_terminal();
    ASSERT_TRUE(in_time(*server, [&] { return server->line().connected; }));
    EXPECT_EQ(server->line().baud, std::nullopt) << "the host has set no speed";
    EXPECT_EQ(server->write(to_bytes("$GPGGA\r\n")), 8U);
    EXPECT_EQ(to_string(ByteSpan(host.read(56)).subspan(48)), "$GPGGA\r\n");
    host.write(test::submit_out(3, to_bytes("poll")));
    Bytes heard;
    ASSERT_TRUE(in_time(*server, [&] {
        const Bytes more = server->read();
        heard.insert(heard.end(), more.begin(), more.end());
        return heard.size() == 4;
    }));
    EXPECT_EQ(to_string(heard), "poll");
    host.write(test::set_lines(4, 1));
    ASSERT_TRUE(in_time(*server, [&] { return server->other_end().ends_with(", DTR"); })) << server->other_end();
}

TEST(UsbipTransport, PulledPlugsAreToldAndTheLastBytesHeard) {
    const auto server = usbip_server();
    UsbipVisitor host(*server);
    ASSERT_TRUE(host.import());
    host.open_terminal();
    host.write(test::submit_out(3, to_bytes("last")));
    host.close();
    ASSERT_TRUE(in_time(*server, [&] { return server->other_end().empty(); }));
    EXPECT_EQ(to_string(server->read()), "last");
    EXPECT_THAT(server->take_news(), ElementsAre(HasSubstr("attached by 127.0.0.1:"), HasSubstr(" has detached")));
    UsbipVisitor next(*server);
    EXPECT_TRUE(next.import());
    next.write({0, 0, 0});
    next.close();
    ASSERT_TRUE(in_time(*server, [&] { return server->other_end().empty(); }));
    EXPECT_THAT(server->take_news().back(), HasSubstr("is gone in the middle of a message"));
}

TEST(UsbipTransport, UnpluggedItIsGoneAndComesBack) {
    const auto server = usbip_server();
    UsbipVisitor host(*server);
    ASSERT_TRUE(host.import());
    server->set_plugged(false);
    EXPECT_TRUE(host.is_closed());
    EXPECT_THAT(server->take_news().back(), HasSubstr("has lost the receiver: it is unplugged"));
    UsbipVisitor visitor(*server);
    visitor.write(list_request);
    EXPECT_EQ(visitor.read(1000), test::words({0x01110005, 0, 0}));
    UsbipVisitor eager(*server);
    eager.write(import_request());
    EXPECT_EQ(eager.read(1000), test::words({0x01110003, 4}));
    server->set_plugged(true);
    EXPECT_TRUE(UsbipVisitor(*server).import());
}

TEST(UsbipTransport, RuleBreakersAreClosedAndTold) {
    const auto server = usbip_server();
    UsbipVisitor browser(*server);
    browser.write(to_bytes("GET / HTTP/1.1\r\n\r\n"));
    EXPECT_TRUE(browser.is_closed());
    EXPECT_THAT(server->take_news(), ElementsAre(HasSubstr("is closed: version 0x4745")));
    UsbipVisitor quiet(*server);
    quiet.close();
    server->line();
    EXPECT_THAT(server->take_news(), IsEmpty()) << "who only knocks is nobody's business";
    UsbipVisitor host(*server);
    ASSERT_TRUE(host.import());
    host.write(Bytes(48, 0xFF));
    EXPECT_TRUE(host.is_closed());
    EXPECT_THAT(server->take_news().back(), HasSubstr("is closed: command 0xffffffff"));
    for (int i = 0; i < 50; ++i) {
        UsbipVisitor again(*server);
        again.write(to_bytes("GE"));
        EXPECT_TRUE(again.is_closed());
    }
    const auto news = server->take_news();
    EXPECT_EQ(news.size(), 33U);
    EXPECT_EQ(news.back(), "18 more such notices are left out");
}

TEST(UsbipTransport, AThousandResetsLeaveNothingBehind) {
    const auto server = usbip_server();
    const auto descriptors = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    const auto before = descriptors();
    for (int i = 0; i < 1000; ++i) {
        UsbipVisitor host(*server);
        ASSERT_TRUE(host.import()) << i;
        host.open_terminal();
        ASSERT_GT(server->write(to_bytes("$GPGGA\r\n")), 0U);
        host.reset();
    }
    EXPECT_TRUE(in_time(*server, [&] { return server->other_end().empty(); }));
    EXPECT_EQ(server->imports(), 1000U);
    EXPECT_EQ(descriptors(), before);
}

TEST(UsbipTransport, WarnsOffLoopbackAndRefusesClearly) {
    const auto open = UsbipTransport::listen({"0.0.0.0", 0});
    ASSERT_TRUE(open) << open.error().message;
    EXPECT_THAT((*open)->take_news(), ElementsAre(HasSubstr("USB/IP has no authentication")));
    EXPECT_THAT(usbip_server()->take_news(), IsEmpty());
    const auto taken = UsbipTransport::listen({"127.0.0.1", (*open)->port()});
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, ErrorCode::outside);
    EXPECT_THAT(taken.error().message, HasSubstr("cannot be listened at: Address already in use"));
    EXPECT_THAT(UsbipTransport::listen({"no host of that name", 0}).error().message, HasSubstr("usbip no host"));
}

}  // namespace
}  // namespace skyloop
