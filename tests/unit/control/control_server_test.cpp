#include "run/control/control_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "run/control/control_client.hpp"
#include "snapshots.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using testing::HasSubstr;
using testing::StartsWith;

/// A server at a free port over a board that a test fills.
struct ServerRig {
    CommandQueue commands;
    StatusBoard board{{"test", control_start, std::nullopt, small_snapshot().timeline}, nullptr};
    std::unique_ptr<ControlServer> server;
    ControlOptions options;

    explicit ServerRig(ControlOptions wanted = {}) : options(std::move(wanted)) {
        auto started = ControlServer::start(options, {commands, board, "{\"roofs\":[]}", "1.2.3", {"front"}});
        EXPECT_TRUE(started) << started.error().message;
        if (!started) return;
        server = std::move(*started);
        options.port = server->port();
    }
    [[nodiscard]] ControlClient client() const { return ControlClient(options); }
    [[nodiscard]] int status(const ControlRequest& request) const {
        const auto response = client().ask(request);
        return response ? response->status : -1;
    }
};

/// A client that behaves as no library lets one.
class RawClient {
public:
    explicit RawClient(std::uint16_t port, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        if (receive_buffer > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int at_once = 1;
        ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;
    ~RawClient() { ::close(socket_); }

    /// How many bytes went out.
    std::size_t send(const std::string& text) {
        std::size_t sent = 0;
        while (sent < text.size()) {
            pollfd one{socket_, POLLOUT, 0};
            if (::poll(&one, 1, 3000) <= 0) break;
            const ssize_t count = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (count <= 0) break;
            sent += static_cast<std::size_t>(count);
        }
        return sent;
    }
    void half_close() { ::shutdown(socket_, SHUT_WR); }
    /// What comes until the server hangs up, or for so long.
    std::string read_all(std::chrono::milliseconds patience = 4s) {
        std::string text;
        const auto until = Clock::now() + patience;
        while (Clock::now() < until) {
            pollfd one{socket_, POLLIN, 0};
            if (::poll(&one, 1, 50) <= 0) continue;
            char bytes[4096];
            const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
            if (count <= 0) break;
            text.append(bytes, static_cast<std::size_t>(count));
        }
        return text;
    }

private:
    int socket_;
};

std::string plain_get(const std::string& path) {
    return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
}

TEST(ControlAddress, IsAPortOrAHostAndAPort) {
    EXPECT_EQ(parse_control_address("8080")->port, 8080);
    EXPECT_EQ(parse_control_address("8080")->host, "127.0.0.1");
    EXPECT_EQ(parse_control_address("0.0.0.0:1")->host, "0.0.0.0");
    EXPECT_EQ(parse_control_address("[::1]:80")->host, "::1");
    for (const char* wrong : {"", "x", "65536", "-1", "host:", ":80", "::1:80", "80 "}) {
        const auto address = parse_control_address(wrong);
        ASSERT_FALSE(address) << wrong;
        EXPECT_EQ(address.error().code, ErrorCode::usage);
        EXPECT_THAT(address.error().message, HasSubstr("expected [HOST:]PORT"));
    }
}

TEST(ControlServer, AnswersAndQueues) {
    const auto rig = std::make_unique<ServerRig>();
    EXPECT_EQ(rig->status({"GET", "/api/status"}), 200);
    EXPECT_EQ(rig->status({"GET", "/api/scene"}), 200);
    EXPECT_EQ(rig->status({"POST", "/api/commands", {}, R"({"command":"pause"})"}), 202);
    const auto taken = rig->commands.take();
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].verb, CommandVerb::pause);
    EXPECT_EQ(taken[0].source, "http");
    EXPECT_EQ(rig->status({"POST", "/api/commands", {}, "{"}), 422);
    EXPECT_EQ(rig->status({"GET", "/api/status", {{"Host", "evil.example"}}}), 421);
    EXPECT_EQ(rig->status({"GET", "/api/status", {{"Origin", "http://evil.example"}}}), 403);
    EXPECT_THAT(rig->server->url(), StartsWith("http://127.0.0.1:"));
}

// As the loop does it: commands first, then the board is looked at.
TEST(ControlServer, TellsOfWhatWasAcceptedBefore) {
    const auto rig = std::make_unique<ServerRig>();
    std::atomic<bool> stop{false};
    std::thread loop([&] {
        while (!stop) {
            for (const Command& command : rig->commands.take())
                rig->board.on_command({control_start, command.parameters.text("text"), command, {}});
            rig->board.look(control_start);
            std::this_thread::sleep_for(3ms);
        }
    });
    for (int i = 0; i < 20; ++i) {
        const std::string note = "note-" + std::to_string(i);
        EXPECT_EQ(rig->status({"POST", "/api/commands", {}, R"({"command":"note","text":")" + note + "\"}"}), 202);
        const auto told = rig->client().ask({"GET", "/api/status"});
        ASSERT_TRUE(told);
        EXPECT_THAT(told->body, HasSubstr(note + " by http"));
    }
    stop = true;
    loop.join();
}

TEST(ControlServer, KnowsBothNamesOfAFaultThatWasBegun) {
    const auto rig = std::make_unique<ServerRig>();
    for (const char* path : {"/api/faults/noise", "/api/faults/noise%202"}) {
        EXPECT_EQ(rig->status({"POST", "/api/faults", {}, R"({"kind":"bit_flips","name":"noise"})"}), 202);
        EXPECT_EQ(rig->status({"DELETE", path}), 202) << path;
    }
    EXPECT_EQ(rig->status({"DELETE", "/api/faults/noise%203"}), 404);
}

TEST(ControlServer, FailsWhereItCannotListen) {
    const ServerRig rig;
    CommandQueue commands;
    const auto second = ControlServer::start(rig.options, {commands, rig.board, {}, {}, {}});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::outside);
    EXPECT_THAT(second.error().message, HasSubstr("cannot listen at 127.0.0.1:"));
    const auto token = ControlServer::start({"127.0.0.1", 0, "two words"}, {commands, rig.board, {}, {}, {}});
    ASSERT_FALSE(token);
    EXPECT_EQ(token.error().code, ErrorCode::usage);
}

TEST(ControlServer, MakesATokenOffLoopback) {
    ServerRig rig({"0.0.0.0", 0, ""});
    EXPECT_EQ(rig.server->token().size(), 32U);
    rig.options.host = "127.0.0.1";
    EXPECT_EQ(rig.status({"GET", "/api/status"}), 401);
    rig.options.token = rig.server->token();
    EXPECT_EQ(rig.status({"GET", "/api/status"}), 200);
    rig.options.token.back() = rig.options.token.back() == '0' ? '1' : '0';
    EXPECT_EQ(rig.status({"GET", "/api/status"}), 401);
    const auto stream = rig.client().watch(10, [](std::string_view) { return false; });
    ASSERT_FALSE(stream);
    EXPECT_THAT(stream.error().message, HasSubstr("401"));
}

TEST(ControlServer, RefusesWhatIsTooLargeOrNoRequest) {
    const ServerRig rig;
    RawClient large(rig.server->port());
    large.send("POST /api/commands HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 10485760\r\n\r\n" +
               std::string(10485760, ' '));
    EXPECT_THAT(large.read_all(), StartsWith("HTTP/1.1 413 "));
    RawClient chunked(rig.server->port());
    chunked.send("POST /api/commands HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n20000\r\n" +
                 std::string(0x20000, ' ') + "\r\n0\r\n\r\n");
    EXPECT_THAT(chunked.read_all(), StartsWith("HTTP/1.1 413 "));
    RawClient headers(rig.server->port());
    headers.send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n");
    EXPECT_THAT(headers.read_all(), StartsWith("HTTP/1.1 431 "));
    RawClient noise(rig.server->port());
    noise.send("\x01\x02 this is no HTTP\r\n\r\n");
    const std::string told = noise.read_all();
    EXPECT_THAT(told, StartsWith("HTTP/1.1 400 "));
    EXPECT_THAT(told, HasSubstr("{\"error\":"));
    EXPECT_EQ(rig.status({"GET", "/api/status"}), 200);
}

TEST(ControlServer, ReadsABodyInChunksByteByByte) {
    const ServerRig rig;
    const std::string head =
        "POST /api/commands HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nConnection: close\r\n"
        "Transfer-Encoding: chunked\r\n\r\n";
    const auto answer = [&](std::string_view body) {
        RawClient client(rig.server->port());
        client.send(head);
        for (const char byte : body) {
            std::this_thread::sleep_for(2ms);  // or they come as one
            client.send(std::string(1, byte));
        }
        return client.read_all();
    };
    EXPECT_THAT(answer("13\r\n{\"command\":\"pause\"}\r\n0\r\n\r\n"), StartsWith("HTTP/1.1 202 "));
    EXPECT_THAT(answer("0\r\n\r\n"), StartsWith("HTTP/1.1 422 "));
    EXPECT_THAT(answer("0\r\nx: 1\r\n\r\n"), StartsWith("HTTP/1.1 422 "));
    EXPECT_EQ(rig.status({"GET", "/api/status"}), 200);
}

TEST(ControlServer, TellsAClientThatWaitsWithItsBodyToGoOn) {
    const auto rig = std::make_unique<ServerRig>();
    const std::string body = R"({"command":"pause"})";
    const auto head = [&](const std::string& host, std::size_t length) {
        return "POST /api/commands HTTP/1.1\r\nHost: " + host +
               "\r\nContent-Type: application/json\r\nConnection: close\r\nExpect: 100-Continue\r\nContent-Length: " +
               std::to_string(length) + "\r\n\r\n";
    };
    RawClient client(rig->server->port());
    client.send(head("127.0.0.1", body.size()));
    EXPECT_EQ(client.read_all(500ms), "HTTP/1.1 100 Continue\r\n\r\n");
    client.send(body);
    EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 202 "));
    EXPECT_EQ(rig->commands.take().size(), 1U);
    RawClient foreign(rig->server->port());
    foreign.send(head("evil.example", body.size()));
    EXPECT_THAT(foreign.read_all(), StartsWith("HTTP/1.1 421 ")) << "before it has sent its body";
    RawClient large(rig->server->port());
    large.send(head("127.0.0.1", 10485760));
    EXPECT_THAT(large.read_all(), StartsWith("HTTP/1.1 413 "));
}

// RFC 9110, section 8.6: the length is that of the answer to GET.
TEST(ControlServer, TellsTheLengthOfWhatHeadAsksForAndSendsNothingOfIt) {
    const auto rig = std::make_unique<ServerRig>();
    const std::string got = [&] {
        RawClient client(rig->server->port());
        client.send(plain_get("/page.js"));
        return client.read_all();
    }();
    const std::size_t body = got.find("\r\n\r\n") + 4;
    RawClient client(rig->server->port());
    // A second request on the same connection shows that the first answer has ended where its client thinks it has.
    client.send(
        "HEAD /page.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nHEAD /api/scene HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        "Connection: close\r\n\r\n");
    const std::string told = client.read_all();
    EXPECT_THAT(told, HasSubstr("Content-Length: " + std::to_string(got.size() - body) + "\r\n"));
    const std::size_t second = told.find("\r\n\r\n") + 4;
    EXPECT_THAT(told.substr(second), StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(told.find("\r\n\r\n", second) + 4, told.size());
}

TEST(ControlServer, AnswersOneWhoHasClosedHisHalf) {
    const ServerRig rig;
    RawClient half(rig.server->port());
    half.send("GET /api/timeline HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    half.half_close();
    EXPECT_THAT(half.read_all(), StartsWith("HTTP/1.1 200 "));
    RawClient silent(rig.server->port());
    silent.half_close();
    EXPECT_EQ(silent.read_all(), "");
}

TEST(ControlServer, HasRoomForSixteen) {
    const ServerRig rig;
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 16; ++i)
        clients.push_back(std::make_unique<RawClient>(rig.server->port()));
    RawClient late(rig.server->port());
    EXPECT_THAT(late.read_all(), StartsWith("HTTP/1.1 503 "));
    clients.clear();
    int status = -1;  // the server sees them go a moment later
    for (int i = 0; i < 100 && status != 200; ++i) {
        std::this_thread::sleep_for(20ms);
        status = rig.status({"GET", "/api/status"});
    }
    EXPECT_EQ(status, 200);
}

TEST(ControlServer, RefusesAFloodPolitely) {
    const ServerRig rig;
    std::string flood;
    const std::string body = R"({"command":"pause"})";
    for (int i = 0; i < 300; ++i)
        flood +=
            "POST /api/commands HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: " +
            std::to_string(body.size()) + "\r\n\r\n" + body;
    RawClient client(rig.server->port());
    client.send(flood + plain_get("/api/timeline"));
    const std::string answers = client.read_all();
    const auto count = [&](const std::string& status) {
        std::size_t found = 0;
        for (std::size_t at = answers.find(status); at != std::string::npos; at = answers.find(status, at + 1))
            ++found;
        return found;
    };
    EXPECT_EQ(count("HTTP/1.1 202 "), 256U);
    EXPECT_EQ(count("HTTP/1.1 429 "), 44U);
    EXPECT_EQ(count("HTTP/1.1 200 "), 1U);
}

/// Publishes snapshots as a loop would, faster than anybody wants them.
class Publisher {
public:
    explicit Publisher(StatusBoard& board)
        : thread_([this, &board] {
              for (int i = 0; !stop_.load(); ++i) {
                  board.publish_now(control_start + std::chrono::milliseconds(5 * i));
                  std::this_thread::sleep_for(5ms);
              }
          }) {}
    ~Publisher() {
        stop_ = true;
        thread_.join();
    }

private:
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(ControlServer, StreamsAtTheRateThatIsAskedFor) {
    ServerRig rig;
    const Publisher publisher(rig.board);
    std::vector<double> elapsed;
    const auto begin = Clock::now();
    const auto stream = rig.client().watch(10, [&](std::string_view text) {
        EXPECT_EQ(rig.board.watchers(), 1);
        elapsed.push_back(nlohmann::json::parse(text)["elapsed_s"].get<double>());
        return elapsed.size() < 8;
    });
    EXPECT_TRUE(stream) << stream.error().message;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    EXPECT_EQ(elapsed.size(), 8U);
    EXPECT_GT(seconds, 0.65);  // never faster than 10 Hz, whatever the machine is doing
    EXPECT_LT(seconds, 5);
    EXPECT_GT(elapsed.back(), elapsed.front());
    for (int i = 0; i < 100 && rig.board.watchers() > 0; ++i)
        std::this_thread::sleep_for(20ms);
    EXPECT_EQ(rig.board.watchers(), 0);
}

TEST(ControlServer, RefusesAStreamOfAnotherRateOrSite) {
    const ServerRig rig;
    const auto refused = rig.client().watch(11, [](std::string_view) { return false; });
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("400"));
    RawClient foreign(rig.server->port());
    foreign.send(
        "GET /api/stream HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://evil.example\r\nConnection: Upgrade\r\n"
        "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    EXPECT_THAT(foreign.read_all(), StartsWith("HTTP/1.1 403 "));
}

TEST(ControlServer, GoesOnBesideAStreamThatIsNotRead) {
    ServerRig rig;
    const Publisher publisher(rig.board);
    RawClient slow(rig.server->port(), 4096);
    slow.send(
        "GET /api/stream?rate=10 HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    for (int i = 0; i < 20; ++i) {
        std::this_thread::sleep_for(20ms);
        EXPECT_EQ(rig.status({"GET", "/api/status"}), 200);
    }
    rig.server.reset();  // hangs up on it without waiting
    EXPECT_EQ(rig.board.watchers(), 0);
}

}  // namespace
}  // namespace skyloop::test
