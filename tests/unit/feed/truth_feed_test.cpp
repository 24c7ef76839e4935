#include "run/feed/truth_feed.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>

#include "base/core/file_descriptor.hpp"
#include "base/core/threads.hpp"
#include "dialect_bytes.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const GpsTime feed_start = GpsTime() + std::chrono::hours(24 * 365 * 46);

sockaddr_in loopback(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
}

// The other end: a socket of loopback.
struct Peer {
    explicit Peer(int type) : socket(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
        const int yes = 1;
        ::setsockopt(socket.value(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    }
    bool connect(std::uint16_t port) {
        const sockaddr_in to = loopback(port);
        return ::connect(socket.value(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    }
    std::uint16_t bind(std::uint16_t wanted = 0) {
        sockaddr_in own = loopback(wanted);
        socklen_t size = sizeof own;
        EXPECT_EQ(::bind(socket.value(), reinterpret_cast<const sockaddr*>(&own), size), 0);
        ::listen(socket.value(), 4);  // where it can
        ::getsockname(socket.value(), reinterpret_cast<sockaddr*>(&own), &size);
        return ntohs(own.sin_port);
    }
    void say(const std::string& text) const { (void)::send(socket.value(), text.data(), text.size(), MSG_NOSIGNAL); }
    [[nodiscard]] std::string hear(int patience_ms = 2000) const {
        pollfd wait{socket.value(), POLLIN, 0};
        if (::poll(&wait, 1, patience_ms) <= 0) return "";
        std::string text(65536, ' ');
        const auto size = ::recv(socket.value(), text.data(), text.size(), 0);
        text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
        return text;
    }
    [[nodiscard]] std::string hear_until(const std::string& word) const {
        std::string text;
        for (int i = 0; i < 20 && text.find(word) == std::string::npos; ++i)
            text += hear(300);
        return text;
    }
    FileDescriptor socket;
};

std::unique_ptr<TruthFeed> open_feed(const std::string& text, ClockMode clock = ClockMode::realtime) {
    const auto address = parse_feed_address(text);
    EXPECT_TRUE(address);
    FeedSettings settings;
    settings.clock = clock;
    settings.path.before = Geodetic::degrees(1, 2, 3);
    auto feed = TruthFeed::open(*address, settings);
    EXPECT_TRUE(feed) << feed.error().message;
    return std::move(*feed);
}

// Latitude 48 and some metres north.
std::string truth_line(double t, double north_m = 0, const std::string& more = "") {
    char text[300];
    std::snprintf(text, sizeof text, "{\"t\":%.6f,\"lla\":[%.10f,11,500],\"h_ref\":\"ell\"%s}\n", t,
                  48 + north_m / 111212.2, more.c_str());
    return text;
}

// Pumps until `done`, at most two seconds.
template <class Done>
bool pump_until(TruthFeed& feed, Done done) {
    for (int i = 0; i < 400; ++i) {
        feed.pump();
        if (done()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return false;
}

TEST(TruthFeed, HearsDatagramsAndPutsThemOnThePathOfTheFirstVehicle) {
    const auto feed = open_feed("udp-json:0");
    EXPECT_EQ(feed->description(), "udp-json:127.0.0.1:" + std::to_string(feed->port()));
    const auto any = feed->path(""), other = feed->path("other");
    Peer sender(SOCK_DGRAM);
    ASSERT_TRUE(sender.connect(feed->port()));
    feed->begin(feed_start, steady_clock_ns());
    sender.say(truth_line(1) + truth_line(1.02));
    sender.say(truth_line(1.04));
    ASSERT_TRUE(pump_until(*feed, [&] { return any->counts().samples == 3; }));
    EXPECT_EQ(feed->counts().messages, 2u);
    EXPECT_EQ(feed->counts().samples, 3u);
    EXPECT_FALSE(other->newest());
    sender.say(truth_line(1.06, 0, ",\"id\":\"other\""));
    sender.say(truth_line(1.06, 0, ",\"id\":\"third\""));
    ASSERT_TRUE(pump_until(*feed, [&] { return other->newest().has_value(); }));
    EXPECT_NEAR(other->at(*other->newest()).geodetic.latitude.deg(), 48, 1e-9);
}

TEST(TruthFeed, IsCalledByTheAddressThatPeopleKnow) {
    const std::string out = "mavlink-udpout:127.0.0.1:14551", asked = "xplane:127.0.0.1:49123";
    EXPECT_EQ(open_feed(out)->description(), out) << "not by the port that the system gave us";
    const auto feed = open_feed(asked);
    EXPECT_EQ(feed->description(), asked + " (own port " + std::to_string(feed->port()) + ")");
}

// X-Plane hears at 49000 and sends from 49001.
TEST(TruthFeed, HearsXPlaneAtWhicheverPortItAnswersFrom) {
    Peer hearing(SOCK_DGRAM), sending(SOCK_DGRAM), neighbour(SOCK_DGRAM);
    const auto feed = open_feed("xplane:127.0.0.1:" + std::to_string(hearing.bind()));
    const auto any = feed->path("");
    feed->begin(feed_start, steady_clock_ns());
    EXPECT_THAT(hearing.hear_until("RPOS"), HasSubstr("RREF"));
    sockaddr_in other = loopback(0);
    other.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
    ASSERT_EQ(::bind(neighbour.socket.value(), reinterpret_cast<const sockaddr*>(&other), sizeof other), 0);
    ASSERT_TRUE(sending.connect(feed->port()) && neighbour.connect(feed->port()));
    HandBytes pose;
    pose.text("RPOS4").f64s({11, 48, 500}).f32s({33, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const std::string packet(pose.bytes().begin(), pose.bytes().end());
    neighbour.say(packet);
    sending.say(packet);
    ASSERT_TRUE(pump_until(*feed, [&] { return any->counts().samples == 1 && feed->counts().strangers == 1; }));
    EXPECT_EQ(feed->counts().refused, 0u);
}

TEST(TruthFeed, AsksXPlaneFromAnotherPortWhereItsOwnIsTaken) {
    FeedAddress address = *parse_feed_address("xplane:127.0.0.1:49123");
    const auto one = TruthFeed::open(address, FeedSettings());
    ASSERT_TRUE(one) << one.error().message;
    address.own_port = (*one)->port();
    const auto other = TruthFeed::open(address, FeedSettings());
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_NE((*other)->port(), 0);
    EXPECT_NE((*other)->port(), (*one)->port());
}

TEST(TruthFeed, TellsOnceOfManyStrangersAndBinary) {
    const auto feed = open_feed("udp-json:0");
    const auto any = feed->path("");
    Peer sender(SOCK_DGRAM), stranger(SOCK_DGRAM);
    ASSERT_TRUE(sender.connect(feed->port()) && stranger.connect(feed->port()));
    feed->begin(feed_start, steady_clock_ns());
    std::mt19937 random(15);
    for (int i = 0; i < 300; ++i) {
        std::string noise(random() % 1400, ' ');
        for (char& c : noise)
            c = static_cast<char>(random());
        stranger.say(noise);
        if (i % 3 == 0) sender.say(truth_line(0.02 * i));
        if (i % 50 == 0) std::this_thread::sleep_for(2ms);
    }
    ASSERT_TRUE(pump_until(*feed, [&] { return any->counts().samples + any->counts().late == 100; }));
    EXPECT_GT(feed->counts().refused, 250u);
    const auto news = feed->take_news();
    ASSERT_LE(news.size(), 3u);
    EXPECT_THAT(news[0], HasSubstr("refused: line"));
    EXPECT_THAT(news[0], HasSubstr(feed->description()));
}

TEST(TruthFeed, FollowsTheSourcesTimeToItsNewestSample) {
    const auto feed = open_feed("udp-json:0", ClockMode::follow);
    const auto any = feed->path("");
    Peer sender(SOCK_DGRAM);
    ASSERT_TRUE(sender.connect(feed->port()));
    feed->begin(feed_start, steady_clock_ns());
    EXPECT_FALSE(feed->horizon());
    EXPECT_FALSE(feed->wait(1ms));
    sender.say(truth_line(7) + truth_line(7.5));
    EXPECT_TRUE(feed->wait(2s));
    ASSERT_TRUE(pump_until(*feed, [&] { return any->counts().samples == 2; }));
    EXPECT_EQ(feed->horizon(), feed_start + 500ms);
    sender.say("{\"type\":\"clock\",\"paused\":true}\n{\"type\":\"bye\"}\n");
    ASSERT_TRUE(pump_until(*feed, [&] { return feed->ended(); }));
    EXPECT_TRUE(feed->paused());
}

TEST(TruthFeed, StepsWithAClientOverTcpAndAnswersEach) {
    const auto feed = open_feed("tcp-json:0", ClockMode::lock_step);
    const auto path = feed->path("0");
    Peer client(SOCK_STREAM);
    ASSERT_TRUE(client.connect(feed->port()));
    EXPECT_THAT(client.hear(), HasSubstr("\"hello\""));
    feed->begin(feed_start, steady_clock_ns());
    // All at once: what comes after a step belongs after it.
    std::string all;
    for (int i = 0; i < 3; ++i)
        all += truth_line(0.02 * i) + "{\"type\":\"step\",\"t\":" + std::to_string(0.02 * (i + 1)) + "}\n";
    client.say(all);
    for (int i = 0; i < 3; ++i) {
        const GpsTime until = feed_start + 20ms * (i + 1);
        ASSERT_TRUE(pump_until(*feed, [&] { return feed->horizon() == until; })) << i;
        EXPECT_EQ(path->newest(), feed_start + 20ms * i);
        feed->stepped(100 + static_cast<std::uint64_t>(i));
        EXPECT_THAT(client.hear_until("stepped"), HasSubstr("\"bytes\":" + std::to_string(100 + i)));
    }
    client.say("{\"type\":\"step\",\"t\":0.06}\n");  // once more
    std::string answer;
    pump_until(*feed, [&] { return !(answer = client.hear(5)).empty(); });
    EXPECT_THAT(answer, HasSubstr("\"bytes\":0"));
}

TEST(TruthFeed, TakesEightClientsAndTellsOfTheNinth) {
    const auto feed = open_feed("tcp-json:0");
    std::vector<std::unique_ptr<Peer>> clients;
    for (int i = 0; i < 9; ++i) {
        clients.push_back(std::make_unique<Peer>(SOCK_STREAM));
        ASSERT_TRUE(clients.back()->connect(feed->port()));
        if (i < 8) {
            EXPECT_THAT(clients.back()->hear(), HasSubstr("hello")) << i;
        } else {
            EXPECT_EQ(clients.back()->hear(), "");
        }
    }
    clients[0]->say("what\n");
    EXPECT_THAT(clients[0]->hear_until("error"), HasSubstr("\"line\":1"));
    clients.erase(clients.begin());
    std::this_thread::sleep_for(200ms);
    Peer again(SOCK_STREAM);
    ASSERT_TRUE(again.connect(feed->port()));
    EXPECT_THAT(again.hear(), HasSubstr("hello"));
}

TEST(TruthFeed, ConnectsAgainWhenItsServerComesBack) {
    Peer server(SOCK_STREAM);
    const std::uint16_t port = server.bind();
    const auto feed = open_feed("json-to:127.0.0.1:" + std::to_string(port));
    const auto any = feed->path("");
    feed->begin(feed_start, steady_clock_ns());
    for (int round = 0; round < 2; ++round) {
        pollfd wait{server.socket.value(), POLLIN, 0};
        ASSERT_EQ(::poll(&wait, 1, 3000), 1) << round;
        const FileDescriptor accepted(::accept(server.socket.value(), nullptr, nullptr));
        const std::string line = truth_line(round) + "{\"half of a li";
        (void)::send(accepted.value(), line.data(), line.size(), 0);
        ASSERT_TRUE(pump_until(*feed, [&] { return any->counts().samples == static_cast<unsigned>(round) + 1; }));
    }
    EXPECT_EQ(feed->counts().refused, 0u);
}

TEST(TruthFeed, RelaysDatagramsUnmodifiedAndHearsOneSide) {
    Peer simulator(SOCK_DGRAM), near_end(SOCK_DGRAM), stranger(SOCK_DGRAM);
    FeedAddress address = *parse_feed_address("ardupilot-json:0,127.0.0.1:" + std::to_string(simulator.bind()));
    address.dialect = "json";
    FeedSettings settings;
    auto feed = TruthFeed::open(address, settings);
    ASSERT_TRUE(feed) << feed.error().message;
    const auto any = (*feed)->path("");
    (*feed)->begin(feed_start, steady_clock_ns());
    ASSERT_TRUE(near_end.connect((*feed)->port()) && stranger.connect((*feed)->port()));
    near_end.say(std::string("servo\0\x01", 7));
    sockaddr_in relay{};
    socklen_t size = sizeof relay;
    char buffer[100];
    ASSERT_EQ(
        ::recvfrom(simulator.socket.value(), buffer, sizeof buffer, 0, reinterpret_cast<sockaddr*>(&relay), &size), 7);
    EXPECT_EQ(std::string(buffer, 7), std::string("servo\0\x01", 7));
    stranger.say("me too");
    const std::string reply = truth_line(1);
    ::sendto(simulator.socket.value(), reply.data(), reply.size(), 0, reinterpret_cast<sockaddr*>(&relay), size);
    EXPECT_EQ(near_end.hear(), reply);
    ASSERT_TRUE(pump_until(**feed, [&] { return any->counts().samples == 1 && (*feed)->counts().strangers == 1; }));
    EXPECT_EQ((*feed)->counts().refused, 0u) << "the other direction is not heard";
    EXPECT_EQ(stranger.hear(50), "");
    // The first one is gone: an autopilot that was started again comes from another port.
    const std::int64_t gone_ns = steady_clock_ns();
    std::string taken;
    while (taken.empty() && steady_clock_ns() < gone_ns + 4'000'000'000) {
        stranger.say("begun anew");
        taken = simulator.hear(100);
    }
    EXPECT_EQ(taken, "begun anew");
}

TEST(TruthFeed, RelaysStreamsUnmodifiedUntilOneEndGoes) {
    Peer simulator(SOCK_STREAM);
    FeedAddress address = *parse_feed_address("px4:0,127.0.0.1:" + std::to_string(simulator.bind()));
    address.dialect = "json";
    auto feed = TruthFeed::open(address, FeedSettings());
    ASSERT_TRUE(feed) << feed.error().message;
    const auto any = (*feed)->path("");
    (*feed)->begin(feed_start, steady_clock_ns());
    for (int round = 1; round <= 2; ++round) {
        Peer near_end(SOCK_STREAM), side(SOCK_STREAM);
        ASSERT_TRUE(near_end.connect((*feed)->port()));
        pollfd wait{simulator.socket.value(), POLLIN, 0};
        ASSERT_EQ(::poll(&wait, 1, 3000), 1);
        side.socket = FileDescriptor(::accept(simulator.socket.value(), nullptr, nullptr));
        near_end.say("actuators");
        EXPECT_EQ(side.hear(), "actuators");
        std::string large(300000, 'x');
        large += "\n" + truth_line(round);
        std::thread sender([&] { side.say(large); });
        std::string got;
        while (got.size() < large.size()) {
            const std::string piece = near_end.hear();
            ASSERT_FALSE(piece.empty());
            got += piece;
        }
        sender.join();
        EXPECT_EQ(got, large);
        ASSERT_TRUE(pump_until(**feed, [&] { return any->counts().samples == static_cast<unsigned>(round); }));
    }
}

TEST(TruthFeed, HearsTheExampleSender) {
    const auto feed = open_feed("udp-json:0");
    const auto any = feed->path("");
    feed->begin(feed_start, steady_clock_ns());
    const std::string command =
        "python3 '" SKYLOOP_SOURCE_DIR "/examples/json/send_truth.py' " + std::to_string(feed->port()) + " 0.5";
    if (std::system("python3 -c '' 2>/dev/null") != 0) GTEST_SKIP() << "python3 is absent";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(pump_until(*feed, [&] { return any->counts().samples == 25; }));
    EXPECT_EQ(feed->counts().refused, 0u);
    EXPECT_EQ(feed->counts().lost, 0u);
    EXPECT_EQ(any->counts().jumps, 0u);
    EXPECT_NEAR(any->at(*any->newest()).velocity.length().value(), 15, 0.01);
}

TEST(TruthFeed, SaysWhyItCannotOpen) {
    const auto first = open_feed("udp-json:0");
    for (const std::string& text : {"udp-json:" + std::to_string(first->port()), std::string("tcp-json:192.0.2.1:5000"),
                                    std::string("mavlink-serial:/dev/no_such_line")}) {
        FeedAddress address = *parse_feed_address(text);
        address.dialect = "json";
        const auto feed = TruthFeed::open(address, {});
        ASSERT_FALSE(feed) << text;
        EXPECT_EQ(feed.error().code, ErrorCode::outside) << text;
        EXPECT_THAT(feed.error().message, HasSubstr(text));
    }
    FeedAddress unknown = *parse_feed_address("udp-json:0");
    unknown.dialect = "klingon";
    EXPECT_FALSE(TruthFeed::open(unknown, {}));
}

TEST(TruthFeed, DropsTheOldestOfWhatNobodyTakesAndCountsIt) {
    const auto feed = open_feed("udp-json:0", ClockMode::follow);
    Peer sender(SOCK_DGRAM);
    ASSERT_TRUE(sender.connect(feed->port()));
    std::string datagram;
    for (int i = 0; i < 400; ++i)
        datagram += truth_line(i);
    for (int i = 0; i < 100; ++i) {
        sender.say(datagram);
        std::this_thread::sleep_for(3ms);
    }
    for (int i = 0; i < 500 && (feed->counts().samples < 40000 || feed->counts().overflowed == 0); ++i)
        std::this_thread::sleep_for(10ms);
    EXPECT_EQ(feed->counts().samples, 40000u);
    EXPECT_GT(feed->counts().overflowed, 5000u);
    EXPECT_LT(feed->counts().overflowed, 40000u);
}

}  // namespace
}  // namespace skyloop
