// How a request ends: tests/integration/fetch_nav_test.py asks a server for more of it.
#include "wire/fetch/fetch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;

// Answers one connection with the same bytes, whatever is asked, and hangs up.
class OneAnswer {
public:
    explicit OneAnswer(std::string answer) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in here{};
        here.sin_family = AF_INET;
        here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof here;
        auto* address = reinterpret_cast<sockaddr*>(&here);
        EXPECT_EQ(::bind(socket_, address, size), 0);
        EXPECT_EQ(::listen(socket_, 1), 0);
        EXPECT_EQ(::getsockname(socket_, address, &size), 0);
        port_ = ntohs(here.sin_port);
        thread_ = std::thread([this, text = std::move(answer)] {
            const int peer = ::accept(socket_, nullptr, nullptr);
            char asked[4096];
            if (peer < 0 || ::recv(peer, asked, sizeof asked, 0) <= 0) return;
            (void)!::send(peer, text.data(), text.size(), MSG_NOSIGNAL);
            ::close(peer);
        });
    }
    ~OneAnswer() {
        ::shutdown(socket_, SHUT_RDWR);  // one that waits for nobody any more
        thread_.join();
        ::close(socket_);
    }
    OneAnswer(const OneAnswer&) = delete;
    OneAnswer& operator=(const OneAnswer&) = delete;
    [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/file"; }

private:
    int socket_;
    int port_ = 0;
    std::thread thread_;
};

class Fetch : public testing::Test {
protected:
    Fetch() { ::setenv("no_proxy", "*", 1); }
};

TEST_F(Fetch, GivesTheBytesAsTheyCome) {
    const std::string body("a\0b\x1f\x8b\n", 6);
    const OneAnswer server("HTTP/1.1 200 OK\r\nContent-Length: 6\r\n\r\n" + body);
    const FetchAnswer answer = fetch(server.address());
    EXPECT_EQ(answer.outcome, FetchOutcome::found);
    EXPECT_EQ(answer.bytes, body);
    EXPECT_EQ(answer.problem, "");
}

TEST_F(Fetch, TellsTheStatusOfARefusal) {
    const OneAnswer server("HTTP/1.1 404 Not Found\r\nContent-Length: 4\r\n\r\nnone");
    const FetchAnswer answer = fetch(server.address());
    EXPECT_EQ(answer.outcome, FetchOutcome::refused);
    EXPECT_EQ(answer.bytes, "");
    EXPECT_EQ(answer.problem, "404");
}

TEST_F(Fetch, WhatIsCutShortOrTooLargeIsBroken) {
    const OneAnswer cut("HTTP/1.1 200 OK\r\nContent-Length: 60\r\n\r\nabc");
    const FetchAnswer part = fetch(cut.address());
    EXPECT_EQ(part.outcome, FetchOutcome::broken);
    EXPECT_EQ(part.bytes, "");
    EXPECT_NE(part.problem, "");
    const OneAnswer large("HTTP/1.1 200 OK\r\n\r\n" + std::string(1000, 'x'));
    const FetchAnswer whole = fetch(large.address(), {.most_bytes = 999});
    EXPECT_EQ(whole.outcome, FetchOutcome::broken);
    EXPECT_EQ(whole.problem, "has more than 999 bytes");
}

TEST_F(Fetch, SilenceEnds) {
    const OneAnswer server("");
    EXPECT_EQ(fetch(server.address()).outcome, FetchOutcome::broken);
}

TEST_F(Fetch, NobodyThereIsUnreachable) {
    std::string address;
    {
        const OneAnswer gone("");
        address = gone.address();
        EXPECT_EQ(fetch(address).outcome, FetchOutcome::broken);
    }
    EXPECT_EQ(fetch(address).outcome, FetchOutcome::unreachable);
    const FetchAnswer unknown = fetch("http://nowhere.invalid/file");
    EXPECT_EQ(unknown.outcome, FetchOutcome::unreachable);
    EXPECT_THAT(unknown.problem, HasSubstr("nowhere.invalid"));
}

TEST_F(Fetch, OtherKindsOfAddressesAreRefused) {
    for (const char* address : {"file:///etc/hostname", "ftp://127.0.0.1/file", "no address"})
        EXPECT_EQ(fetch(address).bytes, "") << address;
}

}  // namespace
}  // namespace skyloop::test
