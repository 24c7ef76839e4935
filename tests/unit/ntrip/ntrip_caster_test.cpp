#include "wire/ntrip/ntrip_caster.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "base/core/file_descriptor.hpp"
#include "ntrip_peers.hpp"
#include "wire/ntrip/ntrip_messages.hpp"

namespace skyloop {
namespace {

using test::CasterBench;
using test::comes_true;
using test::here;

// A client by hand.
class RawClient {
public:
    explicit RawClient(const NtripCaster& caster, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        if (receive_buffer > 0)
            ::setsockopt(socket_.value(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in where{};
        where.sin_family = AF_INET;
        where.sin_port = htons(caster.address().port);
        where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::connect(socket_.value(), reinterpret_cast<sockaddr*>(&where), sizeof where), 0);
    }
    void say(std::string_view text) const { (void)::send(socket_.value(), text.data(), text.size(), MSG_NOSIGNAL); }
    // Until it is there, or the caster has hung up, or 5 s are over.
    std::string hear(std::string_view wanted) {
        while (heard_.find(wanted) == std::string::npos && look()) {
        }
        return heard_;
    }
    // All until the caster hangs up.
    std::string hear_all() {
        while (look()) {
        }
        return heard_;
    }

private:
    bool look() {
        pollfd ready{socket_.value(), POLLIN, 0};
        if (::poll(&ready, 1, 5000) <= 0) return false;
        char piece[4096];
        const ssize_t count = ::recv(socket_.value(), piece, sizeof piece, 0);
        if (count <= 0) return false;
        heard_.append(piece, static_cast<std::size_t>(count));
        return true;
    }

    FileDescriptor socket_;
    std::string heard_;
};

std::string get(std::string_view mount, int version, const std::string& user = "", const std::string& gga = "") {
    NtripAddress address;
    address.user = user.substr(0, user.find(':'));
    if (!user.empty()) address.password = user.substr(user.find(':') + 1);
    return ntrip_request_text(address, mount, version, gga);
}

TEST(NtripCaster, ServesBothVersions) {
    CasterBench bench;
    RawClient old(*bench.caster), two(*bench.caster);
    old.say(get("BASE", 1));
    two.say(get("BASE", 2));
    old.hear("\r\n\r\n");
    two.hear("\r\n\r\n");
    ASSERT_TRUE(comes_true([&] { return bench.caster->counts().clients == 2; }));
    bench.send("corrections");
    EXPECT_TRUE(old.hear("corrections").ends_with("ICY 200 OK\r\n\r\ncorrections"));
    EXPECT_NE(two.hear("corrections\r\n").find("\r\n\r\nb\r\ncorrections\r\n"), std::string::npos);
    EXPECT_EQ(bench.caster->counts().bytes, 22U);
}

TEST(NtripCaster, HasASourceTable) {
    CasterBench bench;
    for (const int version : {1, 2}) {
        RawClient client(*bench.caster);
        client.say(get("", version));
        const std::string text = client.hear_all();
        EXPECT_NE(text.find("\r\n\r\nSTR;BASE;"), std::string::npos) << text;
        EXPECT_TRUE(text.ends_with("ENDSOURCETABLE\r\n"));
    }
    EXPECT_EQ(bench.caster->counts().refused, 0U);
}

TEST(NtripCaster, HearsWhereClientsAre) {
    CasterBench bench;
    RawClient old(*bench.caster), two(*bench.caster);
    old.say(get("BASE", 1) + std::string(here) + "\r\nnonsense\r\n");
    two.say(get("BASE", 2, "", std::string(here)));
    ASSERT_TRUE(comes_true([&] { return bench.source->positions().size() == 2; }));
    old.say(std::string(2000, 'x'));
    old.say("\r\n" + std::string(here));
    old.say("\r\n");
    ASSERT_TRUE(comes_true([&] { return bench.source->positions().size() == 3; }));
    for (const std::string& position : bench.source->positions())
        EXPECT_EQ(position, here);
}

TEST(NtripCaster, AsksForPasswords) {
    CasterBench bench(std::map<std::string, std::string>{{"rover", "secret"}});
    for (const int version : {1, 2}) {
        for (const char* wrong : {"", "rover:wrong", "other:secret", "rover:"}) {
            RawClient client(*bench.caster);
            client.say(get("BASE", version, wrong));
            EXPECT_NE(client.hear_all().find("401 Unauthorized"), std::string::npos) << wrong;
        }
        RawClient client(*bench.caster);
        client.say(get("BASE", version, "rover:secret"));
        EXPECT_NE(client.hear("\r\n\r\n").find("200 OK"), std::string::npos);
    }
    EXPECT_EQ(bench.caster->counts().refused, 8U);
    EXPECT_EQ(bench.caster->counts().served, 2U);
}

TEST(NtripCaster, RefusesWhatIsNoRequest) {
    CasterBench bench;
    for (const auto& [request, answer] :
         {std::pair<std::string, std::string>{"nonsense\r\n\r\n", "400 Bad Request"},
          {"SOURCE secret /BASE\r\nSource-Agent: NTRIP x\r\n\r\n", "400 Bad Request"},
          {"POST /BASE HTTP/1.1\r\nHost: a\r\n\r\n", "405 Method Not Allowed"},
          {get("BASF", 2), "404 Not Found"},
          {get("BASF", 1), "SOURCETABLE 200 OK"},
          {"GET /BASE HTTP/1.1\r\nA: " + std::string(9000, 'a') + "\r\n\r\n", "431 "}}) {
        RawClient client(*bench.caster);
        client.say(request);
        EXPECT_NE(client.hear_all().find(answer), std::string::npos) << request;
    }
    EXPECT_EQ(bench.caster->counts().refused, 6U);
    EXPECT_EQ(bench.caster->counts().clients, 0U);
}

TEST(NtripCaster, DropsSlowReadersAlone) {
    CasterBench bench;
    RawClient slow(*bench.caster, 4096), good(*bench.caster);
    slow.say(get("BASE", 1));
    good.say(get("BASE", 1));
    ASSERT_TRUE(comes_true([&] { return bench.caster->counts().clients == 2; }));
    const std::string piece(20000, 'x');
    std::string wanted;
    for (int i = 0; i < 100 && bench.caster->counts().slow == 0; ++i) {
        bench.send(piece + std::to_string(i) + "|");
        good.hear(std::to_string(i) + "|");
    }
    EXPECT_EQ(bench.caster->counts().slow, 1U);
    EXPECT_EQ(bench.caster->counts().clients, 1U);
    bench.send("still here");
    EXPECT_TRUE(good.hear("still here").ends_with("still here"));
}

TEST(NtripCaster, LetsOthersInWhenThoseThatAskHaveGone) {
    CasterBench bench;
    auto askers = std::make_unique<std::vector<RawClient>>();
    for (int i = 0; i < NtripCaster::most_asking; ++i)
        askers->emplace_back(*bench.caster);
    RawClient late(*bench.caster);
    late.say(get("BASE", 1));
    askers.reset();
    EXPECT_TRUE(late.hear("\r\n\r\n").starts_with("ICY 200 OK"));
}

TEST(NtripCaster, HasRoomFor200) {
    CasterBench bench;
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < NtripCaster::most_clients; ++i) {
        clients.push_back(std::make_unique<RawClient>(*bench.caster));
        clients.back()->say(get("BASE", 1 + i % 2));
        clients.back()->hear("\r\n\r\n");
    }
    RawClient late(*bench.caster);
    late.say(get("BASE", 2));
    EXPECT_NE(late.hear_all().find("503 Service Unavailable"), std::string::npos);
    bench.send("for all");
    for (auto& client : clients)
        EXPECT_NE(client->hear("for all").find("for all"), std::string::npos);
    clients.clear();
    EXPECT_TRUE(comes_true([&] { return bench.caster->counts().clients == 0; }));
}

TEST(NtripCaster, RefusesWhereAMountPointHasNoRoom) {
    CasterBench bench;
    bench.source->fill();
    for (const int version : {1, 2}) {
        RawClient client(*bench.caster);
        client.say(get("BASE", version));
        EXPECT_TRUE(client.hear_all().starts_with("HTTP/1.1 503 Service Unavailable\r\n"));
    }
    EXPECT_EQ(bench.caster->counts().refused, 2U);
    EXPECT_EQ(bench.caster->counts().served, 0U);
}

TEST(NtripCaster, SaysWhereItCannotListen) {
    CasterBench first;
    NtripCasterSettings settings;
    settings.address.port = first.caster->address().port;
    const auto second = NtripCaster::start(std::move(settings));
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::outside);
    EXPECT_TRUE(second.error().message.starts_with("caster 127.0.0.1:")) << second.error().message;
}

}  // namespace
}  // namespace skyloop
