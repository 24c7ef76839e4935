#include "run/control/control_client.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>

namespace skyloop::test {
namespace {

using boost::asio::ip::tcp;

/// Answers one request with these bytes, each in a segment of its own.
void answer_slowly(tcp::acceptor& acceptor, std::string_view answer) {
    tcp::socket peer = acceptor.accept();
    peer.set_option(tcp::no_delay(true));
    std::string request;
    boost::asio::read_until(peer, boost::asio::dynamic_buffer(request), "\r\n\r\n");
    for (const char& byte : answer) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        boost::asio::write(peer, boost::asio::buffer(&byte, 1));
    }
}

Result<ControlResponse> answer_to_ask(std::string_view answer) {
    boost::asio::io_context io;
    tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
    std::thread server([&] { answer_slowly(acceptor, answer); });
    ControlOptions options;
    options.port = acceptor.local_endpoint().port();
    auto response = ControlClient(options).ask({"GET", "/api/status"});
    server.join();
    return response;
}

TEST(ControlClient, ReadsAnAnswerInChunksByteByByte) {
    const std::string head = "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n";
    const auto nothing = answer_to_ask(head + "0\r\n\r\n");
    ASSERT_TRUE(nothing) << nothing.error().message;
    EXPECT_EQ(nothing->body, "");
    const auto something = answer_to_ask(head + "2\r\n{}\r\n0\r\n\r\n");
    ASSERT_TRUE(something) << something.error().message;
    EXPECT_EQ(something->body, "{}");
}

TEST(ControlClient, TellsOfAnAnswerThatEndsBeforeItsBody) {
    EXPECT_FALSE(answer_to_ask("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n"));
    EXPECT_FALSE(answer_to_ask("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\n0\r\n"));
}

}  // namespace
}  // namespace skyloop::test
