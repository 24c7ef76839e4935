#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <thread>

#include "base/core/file_descriptor.hpp"
#include "base/core/threads.hpp"
#include "run/feed/truth_feed.hpp"

namespace skyloop {
namespace {

constexpr int load_vehicles = 64, load_rate_hz = 100, load_seconds = 3;
constexpr std::uint64_t most_under_way = 100;  // datagrams that the smallest buffer holds

// Each vehicle in a datagram of its own, spread over the period. @param taken how many the feed has
void send_load(std::uint16_t port, std::uint64_t& sent, const std::atomic<std::uint64_t>& taken) {
    const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port);
    ASSERT_EQ(::connect(socket.value(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    const auto begun = std::chrono::steady_clock::now();
    auto next = begun;
    double t = 0;
    constexpr int total = load_vehicles * load_rate_hz * load_seconds;
    for (int i = 0; i < total; ++i) {
        if (i % 8 == 0) {
            // A sender that was held up goes on at its rate: a burst of all that is due is another test.
            next = std::max(next + std::chrono::microseconds(1250), std::chrono::steady_clock::now());
            std::this_thread::sleep_until(next);
            // So is a machine that gives the feed no time at all.
            for (int waited = 0; sent > taken + most_under_way && waited < 30'000; ++waited)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            // So is a source whose clock stands still while it is held up.
            t = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        }
        char text[400];
        const int size = std::snprintf(text, sizeof text,
                                       "{\"id\":\"%d\",\"t\":%.6f,\"lla\":[%.9f,11.5,500],\"h_ref\":\"ell\","
                                       "\"vel_ned\":[10,0,0],\"q\":[1,0,0,0],\"rate_frd\":[0,0,0],\"seq\":%d}",
                                       i % load_vehicles, t, 48 + 10 * t / 111212.2, i / load_vehicles);
        // A full buffer of the sender is not what is measured: it waits.
        if (::send(socket.value(), text, static_cast<std::size_t>(size), 0) == size) ++sent;
    }
}

TEST(FeedLoad, LosesNothingOf64VehiclesAt100Hz) {
    std::atomic<double> cpu_s{-1};
    FeedSettings settings;
    settings.thread = [&](std::function<void()> work) {
        return std::thread([work = std::move(work), &cpu_s] {
            work();
            rusage used{};
            ::getrusage(RUSAGE_THREAD, &used);
            cpu_s = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                    static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1e-6;
        });
    };
    auto opened = TruthFeed::open(*parse_feed_address("udp-json:0"), settings);
    ASSERT_TRUE(opened) << opened.error().message;
    auto feed = std::move(*opened);
    std::vector<std::shared_ptr<LivePath>> paths;
    for (int i = 0; i < load_vehicles; ++i)
        paths.push_back(feed->path(std::to_string(i)));
    const GpsTime start = GpsTime() + std::chrono::hours(24 * 365 * 46);
    const std::int64_t begin_ns = steady_clock_ns();
    feed->begin(start, begin_ns);
    std::uint64_t sent = 0;
    std::atomic<std::uint64_t> taken{0};
    std::thread sender([&] { send_load(feed->port(), sent, taken); });
    constexpr std::uint64_t total = load_vehicles * load_rate_hz * load_seconds;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (taken < total && std::chrono::steady_clock::now() < patience) {
        feed->pump();
        taken = feed->counts().samples;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    sender.join();
    // A look takes a bounded share, and none while the feed's thread is at the inbox.
    const auto handed_over = [&] {
        std::uint64_t count = 0;
        for (const auto& path : paths)
            count += path->counts().samples;
        return count;
    };
    while (handed_over() < total && std::chrono::steady_clock::now() < patience)
        feed->pump();
    const FeedCounts counts = feed->counts();
    EXPECT_EQ(sent, total);
    EXPECT_EQ(counts.samples, total);
    EXPECT_EQ(counts.dropped_by_kernel, 0u);
    EXPECT_EQ(counts.overflowed, 0u);
    EXPECT_EQ(counts.lost, 0u);
    for (const auto& path : paths) {
        EXPECT_EQ(path->counts().samples, total / load_vehicles);
    }
    const double wall_s = static_cast<double>(steady_clock_ns() - begin_ns) * 1e-9;
    feed.reset();
    std::cout << "feed thread: " << 100 * cpu_s / wall_s << " % of a core at " << total / wall_s << " datagrams/s\n";
    EXPECT_GT(cpu_s, 0);
    EXPECT_LT(cpu_s / wall_s, 0.6);
}

}  // namespace
}  // namespace skyloop
