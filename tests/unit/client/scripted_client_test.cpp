// A scripted client's doing depends on when bytes reach it, not on how often somebody looks at it.
#include <gtest/gtest.h>

#include "client_bench.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

// What it has sent within a second, with the times; looked at every so often.
std::vector<std::pair<Nanoseconds, Bytes>> sent(Nanoseconds look_every, Nanoseconds first) {
    const auto client = std::move(*open_client("careful-ubx"));
    std::vector<std::pair<Nanoseconds, Bytes>> sent;
    for (Nanoseconds at = first; at < 1500ms; at += look_every) {
        if (at == 700ms) client->write(encode_frame(MonVer::message_id, {}));
        client->simulated_end()->tell_time(bench_start + at);
        if (Bytes bytes = client->read(); !bytes.empty()) sent.emplace_back(at, std::move(bytes));
    }
    return sent;
}

TEST(ScriptedClient, ActsEveryTenMillisecondsHoweverOftenItIsLookedAt) {
    const auto seldom = sent(10ms, 10ms), often = sent(1ms, 1ms), very_often = sent(250us, 250us);
    EXPECT_FALSE(seldom.empty());
    EXPECT_EQ(often, seldom);
    EXPECT_EQ(very_often, seldom);
}

TEST(ScriptedClient, SaysWhenItActsNext) {
    const auto client = std::move(*open_client("naive-nmea"));
    EXPECT_EQ(client->simulated_end()->acts_at(bench_start), bench_start + 10ms);
    EXPECT_EQ(client->simulated_end()->acts_at(bench_start + 1ns), bench_start + 10ms);
    EXPECT_EQ(client->simulated_end()->acts_at(bench_start + 9'999'999ns), bench_start + 10ms);
    EXPECT_EQ(client->simulated_end()->acts_at(bench_start + 10ms), bench_start + 20ms);
}

}  // namespace
}  // namespace skyloop::test
