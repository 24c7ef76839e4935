/// A run behind skyloop.h, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "skyloop.h"
#include "support/truth_on_circle.hpp"

namespace skyloop::test {

inline constexpr std::int64_t led_ms = 1'000'000, led_s = 1'000'000'000;
inline constexpr const char* led_start = "2026-03-01T12:00:00Z";

/// Without noise, so that what comes out is what went in.
inline constexpr std::string_view ideal_scenario = R"(
[model]
name = "ideal"
[[receiver]]
rate_hz = 5
baud = 38400
)";

inline sky_create_info led_info(const char* text) {
    sky_create_info info{};
    info.struct_size = sizeof info;
    info.abi_major = SKY_ABI_MAJOR;
    info.scenario_text = text;
    info.start_utc = led_start;
    return info;
}

/// Keeps the sentences of a run's log that matter as much as `level`. Outlives the run.
class ToldSentences {
public:
    explicit ToldSentences(std::int32_t level) : level_(level) {}
    void listen(sky_create_info& info) {
        info.log_user = this;
        info.log = [](void* user, std::int32_t level, const char* sentence) {
            auto& self = *static_cast<ToldSentences*>(user);
            if (level == self.level_) self.all.emplace_back(sentence);
        };
    }
    /// How many of them have this in them.
    [[nodiscard]] std::ptrdiff_t count(std::string_view part) const {
        return std::count_if(all.begin(), all.end(),
                             [&](const std::string& one) { return one.find(part) != std::string::npos; });
    }
    std::vector<std::string> all{};

private:
    std::int32_t level_;
};

/// A handle that ends with its owner, and the calls that tests use most; those expect success.
class LedRun {
public:
    explicit LedRun(std::string_view text = ideal_scenario) : LedRun(led_info(std::string(text).c_str()), text) {}
    /// @param text takes the place of info.scenario_text
    LedRun(sky_create_info info, std::string_view text) {
        const std::string kept(text);
        char why[512] = "";
        info.scenario_text = kept.c_str();
        info.error = why;
        info.error_capacity = sizeof why;
        EXPECT_EQ(sky_create(&info, &emulator_), SKY_OK) << why;
    }
    ~LedRun() { sky_destroy(emulator_); }
    LedRun(const LedRun&) = delete;
    LedRun& operator=(const LedRun&) = delete;

    operator sky_emulator*() { return emulator_; }
    void advance(std::int64_t time) { ASSERT_EQ(sky_advance(emulator_, time, nullptr), SKY_OK) << last_error(); }
    sky_progress progress_at(std::int64_t time) {
        sky_progress progress{};
        progress.struct_size = sizeof progress;
        EXPECT_EQ(sky_advance(emulator_, time, &progress), SKY_OK) << last_error();
        return progress;
    }
    std::string read(std::uint32_t port = 0) {
        std::string all;
        char piece[1000];
        std::int64_t count = 0;
        while ((count = sky_read(emulator_, port, piece, sizeof piece)) > 0)
            all.append(piece, static_cast<std::size_t>(count));
        EXPECT_EQ(count, 0) << last_error();
        return all;
    }
    void write(std::string_view bytes, std::uint32_t port = 0) {
        EXPECT_EQ(sky_write(emulator_, port, bytes.data(), bytes.size()), static_cast<std::int64_t>(bytes.size()));
    }
    sky_fix fix(std::uint32_t receiver = 0) {
        sky_fix fix{};
        fix.struct_size = sizeof fix;
        EXPECT_EQ(sky_get_fix(emulator_, receiver, &fix), SKY_OK) << last_error();
        return fix;
    }
    std::vector<sky_sat> satellites(std::uint32_t receiver = 0) {
        std::vector<sky_sat> all(128);
        const auto count = sky_get_sats(emulator_, receiver, all.data(), all.size(), sizeof all[0]);
        EXPECT_GE(count, 0) << last_error();
        all.resize(static_cast<std::size_t>(std::max<std::int64_t>(count, 0)));
        return all;
    }
    std::string query(const char* what) {
        const auto size = sky_query(emulator_, what, nullptr, 0);
        EXPECT_GT(size, 0) << last_error();
        std::string text(static_cast<std::size_t>(std::max<std::int64_t>(size, 0)) + 1, '?');
        EXPECT_EQ(sky_query(emulator_, what, text.data(), text.size()), size);
        EXPECT_EQ(text.back(), '\0');
        text.pop_back();
        return text;
    }
    std::string last_error() {
        char text[1024] = "";
        EXPECT_GE(sky_last_error(emulator_, text, sizeof text), 0);
        return text;
    }

private:
    sky_emulator* emulator_ = nullptr;
};

/// At a place that does not move. Degrees, metres above the ellipsoid.
inline sky_truth truth_there(std::int64_t time, double latitude, double longitude, double height) {
    sky_truth truth{};
    truth.struct_size = sizeof truth;
    truth.fields = SKY_POS_LLA_ELLIPSOID | SKY_VEL;
    truth.sim_time_ns = time;
    truth.pos[0] = latitude;
    truth.pos[1] = longitude;
    truth.pos[2] = height;
    return truth;
}

/// Flies the circle with a sample every 20 ms, `step` after `step`; gives all bytes of the first port.
inline std::string fly_circle(sky_emulator* emulator, std::int64_t until, std::int64_t step) {
    std::string all;
    char piece[4096];
    std::int64_t said = -20 * led_ms;
    for (std::int64_t now = 0;; now = std::min(until, now + step)) {
        for (; said + 20 * led_ms <= now; said += 20 * led_ms) {
            const sky_truth truth = truth_on_circle(said + 20 * led_ms);
            EXPECT_EQ(sky_set_truth(emulator, &truth), SKY_OK);
        }
        EXPECT_EQ(sky_advance(emulator, now, nullptr), SKY_OK);
        while (const auto count = sky_read(emulator, 0, piece, sizeof piece))
            all.append(piece, static_cast<std::size_t>(count));
        if (now == until) return all;
    }
}

}  // namespace skyloop::test
