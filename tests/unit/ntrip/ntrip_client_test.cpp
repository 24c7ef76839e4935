#include "wire/ntrip/ntrip_client.hpp"

#include <gtest/gtest.h>

#include "ntrip_peers.hpp"

namespace skyloop {
namespace {

using test::CasterBench;
using test::comes_true;
using test::here;

std::unique_ptr<NtripClient> client_of(const std::string& uri, int position_every_s = 10) {
    NtripClientSettings settings{parse_ntrip_uri(uri).value(), std::chrono::seconds(position_every_s), 1};
    auto client = std::make_unique<NtripClient>(std::move(settings));
    client->start();
    return client;
}

// What it tells first.
std::string news_of(NtripClient& client) {
    std::vector<std::string> news;
    comes_true([&] {
        news = client.take_news();
        return !news.empty();
    });
    return news.empty() ? "" : news.front();
}

TEST(NtripClient, HearsWhatACasterSends) {
    CasterBench bench(std::map<std::string, std::string>{{"me", "s@cret"}});
    const auto client = client_of(bench.uri("me:s%40cret@/BASE"));
    ASSERT_TRUE(comes_true([&] { return client->connected(); }));
    bench.send("corrections");
    std::string heard;
    EXPECT_TRUE(comes_true([&] {
        heard += to_string(client->take());
        return heard == "corrections";
    }));
    const NtripClientCounts counts = client->counts();
    EXPECT_EQ(counts.bytes, 11U);
    EXPECT_EQ(counts.version, 2);
    EXPECT_EQ(counts.connections, 1U);
    EXPECT_LT(counts.age_s, 10);
    EXPECT_TRUE(client->take_news().empty());
}

TEST(NtripClient, TellsWhereItIs) {
    CasterBench bench;
    const auto client = client_of(bench.uri("/BASE"), 1);
    ASSERT_TRUE(comes_true([&] { return client->connected(); }));
    client->tell_position(std::string(here));
    ASSERT_TRUE(comes_true([&] { return bench.source->positions().size() >= 2; }));
    EXPECT_EQ(bench.source->positions().front(), here);
    const auto silent = client_of(bench.uri("/BASE"), 0);
    EXPECT_FALSE(silent->wants_position());
}

TEST(NtripClient, SaysWhyItIsRefused) {
    CasterBench bench(std::map<std::string, std::string>{{"me", "secret"}});
    const std::string shown = bench.uri("/BASE");
    EXPECT_EQ(news_of(*client_of(bench.uri("me:wrong@/BASE"))),
              shown + ": user or password are refused (HTTP/1.1 401 Unauthorized); trying again");
    EXPECT_EQ(news_of(*client_of(shown)),
              shown + ": a user and a password are needed (HTTP/1.1 401 Unauthorized); trying again");
    EXPECT_EQ(news_of(*client_of(bench.uri("me:secret@/BASF"))),
              bench.uri("/BASF") + ": no such mount point; did you mean 'BASE'?; trying again");
    EXPECT_EQ(news_of(*client_of("ntrip://no.such.host.invalid/M")).substr(0, 83),
              "ntrip://no.such.host.invalid:2101/M: host 'no.such.host.invalid' is not known: Host");
    EXPECT_EQ(news_of(*client_of("ntrip://127.0.0.1:1/M")),
              "ntrip://127.0.0.1:1/M: cannot be reached: Connection refused; trying again");
}

TEST(NtripClient, CallsAgain) {
    auto bench = std::make_unique<CasterBench>();
    const std::uint16_t port = bench->caster->address().port;
    const auto client = client_of(bench->uri("/BASE"));
    ASSERT_TRUE(comes_true([&] { return client->connected(); }));
    bench.reset();
    const std::string lost = news_of(*client);
    EXPECT_TRUE(lost.ends_with("; trying again")) << lost;
    EXPECT_FALSE(client->connected());
    bench = std::make_unique<CasterBench>(std::map<std::string, std::string>(), port);
    ASSERT_TRUE(comes_true([&] { return client->connected(); }));
    EXPECT_EQ(client->counts().connections, 2U);
    bench->send("again");
    EXPECT_TRUE(comes_true([&] { return to_string(client->take()) == "again"; }));
}

TEST(NtripClient, LosesTheOldestOfWhatNobodyTakes) {
    CasterBench bench;
    const auto client = client_of(bench.uri("/BASE"));
    ASSERT_TRUE(comes_true([&] { return client->connected(); }));
    for (int i = 0; i < 10; ++i) {
        bench.send(std::string(10000, 'a'));
        const auto so_far = static_cast<std::uint64_t>(i + 1) * 10000;
        ASSERT_TRUE(comes_true([&] { return client->counts().bytes == so_far; }));
    }
    EXPECT_EQ(client->take().size(), 65536U);
    EXPECT_EQ(client->counts().bytes_lost, 100000U - 65536U);
}

}  // namespace
}  // namespace skyloop
