// Time is the caller's: what comes out depends on what was said when, not on how time was cut up.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "led_run.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario_file.hpp"
#include "support/oracle_table.hpp"

namespace {

using namespace skyloop::test;

// Faults of wire and firmware among it, and a model with noise.
constexpr std::string_view eventful = R"(
[run]
start = 2026-03-01T12:00:00Z
seed = 11
[trajectory]
kind = "circle"
centre = [46.4775, 30.7326, 77]
radius_m = 300
speed_mps = 14
[[receiver]]
board = "ublox-m8"
rate_hz = 5
baud = 38400
[[fault]]
kind = "byte_loss"
at_s = 2
for_s = 3
probability = 0.02
[[fault]]
kind = "bit_flips"
between_s = [1, 4]
for_s = 2
probability = 0.001
[[fault]]
kind = "outage"
at_s = 6
for_s = 1.5
)";

std::string led_in_steps(std::int64_t until, const std::vector<std::int64_t>& steps) {
    LedRun run(eventful);
    std::string all;
    std::int64_t now = 0;
    for (std::size_t i = 0; now < until; ++i) {
        now = std::min(until, now + steps[i % steps.size()]);
        run.advance(now);
        all += run.read();
    }
    return all;
}

std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    return content.str();
}

// What `skyloop simulate` leaves of its first port.
std::string simulated_bytes(std::string_view text, double seconds) {
    using namespace skyloop;
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("skyloop-api-{}", ::getpid());
    auto scenario = read_scenario(text, "test.toml");
    EXPECT_TRUE(scenario) << scenario.error().message;
    scenario->run.duration = Seconds(seconds);
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.record = folder;
    auto assembly = assemble(*scenario, {{built_data()}}, mode);
    EXPECT_TRUE(assembly) << assembly.error().message;
    EXPECT_TRUE(assembly->emulator->begin());
    const std::atomic<bool> stop{false};
    assembly->emulator->run_until(*assembly->end, stop);
    std::string bytes = bytes_of_file(folder / "port0.out");
    std::filesystem::remove_all(folder);
    return bytes;
}

std::string ubx_poll_version() {
    const auto frame = skyloop::encode_frame({0x0A, 0x04}, {});
    return {frame.begin(), frame.end()};
}

TEST(LedTime, StretchesOfAnyLengthGiveTheSameBytes) {
    const std::string whole = led_in_steps(9 * led_s, {9 * led_s});
    ASSERT_GT(whole.size(), 9000U);
    EXPECT_EQ(led_in_steps(9 * led_s, {20 * led_ms}), whole);
    EXPECT_EQ(led_in_steps(9 * led_s, {1'234'567, 100 * led_ms, 1}), whole);
}

TEST(LedTime, GivesTheBytesThatASimulationGives) {
    const std::string simulated = simulated_bytes(eventful, 9);
    const std::string led = led_in_steps(9 * led_s, {16'666'667});
    ASSERT_GT(simulated.size(), 9000U);
    EXPECT_EQ(led, simulated);
}

TEST(LedTime, FromEventToEventNothingIsLeftOut) {
    LedRun run(eventful);
    std::string all;
    sky_progress progress = run.progress_at(0);
    int events = 0;
    while (progress.next_event_ns < 9 * led_s && events < 100'000) {
        EXPECT_GT(progress.next_event_ns, progress.now_ns);
        progress = run.progress_at(progress.next_event_ns);
        all += run.read();
        ++events;
    }
    run.advance(9 * led_s);
    all += run.read();
    EXPECT_EQ(all, led_in_steps(9 * led_s, {9 * led_s}));
    EXPECT_LT(events, 9 * 1000);
}

TEST(LedTime, BytesComeAsALineBringsThem) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\nbaud = 9600\n");
    std::size_t bytes = 0;
    bool some = false;
    for (std::int64_t now = 0; now <= 3 * led_s; now += 10 * led_ms) {
        run.advance(now);
        const std::size_t come = run.read().size();
        EXPECT_LE(come, 10U) << "in 10 ms at " << now;  // 9.6 bytes
        bytes += come;
        some = some || come >= 9;
    }
    EXPECT_TRUE(some);
    EXPECT_GT(bytes, 1000U);
}

TEST(LedTime, TheEpochAtTheInstantItselfBelongsToIt) {
    LedRun run;
    sky_progress progress = run.progress_at(0);
    EXPECT_EQ(progress.epochs, 1U);
    EXPECT_EQ(progress.ports, 1U);
    EXPECT_EQ(progress.now_ns, 0);
    progress = run.progress_at(200 * led_ms);
    EXPECT_EQ(progress.epochs, 2U);
    EXPECT_EQ(run.progress_at(200 * led_ms).epochs, 2U);
    progress = run.progress_at(399 * led_ms);
    EXPECT_EQ(progress.epochs, 2U);
    EXPECT_GT(progress.bytes_pending, 0U);
    EXPECT_EQ(progress.ports_pending, 1U);
    EXPECT_EQ(run.read().size(), progress.bytes_pending);
    EXPECT_EQ(run.fix().sim_time_ns, 200 * led_ms);
}

TEST(LedTime, BelongsToTheCallersClock) {
    sky_create_info info = led_info(nullptr);
    info.start_sim_ns = 5'000 * led_s;
    LedRun run(info, ideal_scenario);
    EXPECT_EQ(sky_advance(run, 4'999 * led_s, nullptr), SKY_E_TIME);
    EXPECT_EQ(run.progress_at(5'001 * led_s).now_ns, 5'001 * led_s);
    EXPECT_EQ(run.fix().sim_time_ns, 5'001 * led_s);
}

TEST(LedTime, DoesNotGoBackNorTooFar) {
    LedRun run;
    run.advance(led_s);
    EXPECT_EQ(sky_advance(run, led_s - 1, nullptr), SKY_E_TIME);
    EXPECT_EQ(run.last_error(), "999999999 ns lies before the present, 1000000000 ns");
    EXPECT_EQ(sky_advance(run, 86'402 * led_s, nullptr), SKY_E_TIME);
    for (const std::int64_t time : {INT64_MIN, INT64_MAX, INT64_MAX - 1})
        EXPECT_EQ(sky_advance(run, time, nullptr), SKY_E_TIME) << time;
    run.advance(led_s);
}

TEST(LedTime, ACommandMayEndTheRun) {
    LedRun run;
    run.advance(led_s);
    ASSERT_EQ(sky_command(run, R"({"command": "stop"})"), SKY_OK);
    EXPECT_EQ(run.progress_at(2 * led_s).now_ns, led_s);
    EXPECT_EQ(sky_advance(run, 3 * led_s, nullptr), SKY_E_STATE);
    EXPECT_EQ(run.fix().sim_time_ns, led_s);
}

TEST(LedTime, OfARunThatHasEndedIsOverForAllThatLeadsIt) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\n[[command]]\nkind = \"stop\"\nat_s = 1.5\n");
    const sky_progress progress = run.progress_at(2 * led_s);
    EXPECT_EQ(progress.now_ns, 1'500 * led_ms);
    EXPECT_EQ(progress.epochs, 2U);
    EXPECT_NE(run.read().find("RMC"), std::string::npos);
    const sky_truth truth = truth_there(led_s, 46, 30, 100);
    EXPECT_EQ(sky_set_truth(run, &truth), SKY_E_STATE);
    EXPECT_EQ(sky_command(run, R"({"command": "note", "text": "x"})"), SKY_E_STATE);
    EXPECT_EQ(sky_set_baud(run, 0, 9600), SKY_E_STATE);
    EXPECT_EQ(sky_set_los(run, 0, nullptr, 0, sizeof(sky_los)), SKY_E_STATE);
    EXPECT_EQ(sky_write(run, 0, "x", 1), SKY_E_STATE);
    EXPECT_EQ(sky_advance(run, 2 * led_s, nullptr), SKY_E_STATE);
    EXPECT_EQ(run.last_error(), "the run has ended: a command of the scenario, or of the caller, has stopped it");
    EXPECT_EQ(run.fix().epochs, 2U);
}

TEST(LedBytes, ReachTheReceiverAtTheSpeedOfTheLine) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\nbaud = 9600\nsentences = [\"RMC\"]\n");
    run.advance(500 * led_ms);
    run.read();
    const std::string poll = ubx_poll_version();  // 8 bytes: 8.3 ms
    run.write(poll);
    run.advance(508 * led_ms);
    EXPECT_EQ(run.read(), "");
    run.advance(900 * led_ms);
    const std::string answer = run.read();
    EXPECT_NE(answer.find(std::string("\xB5\x62\x0A\x04", 4)), std::string::npos);
}

// The receiver's answers depend on when its bytes set out alone.
TEST(LedBytes, AnswersDoNotDependOnTheStretches) {
    const auto talk = [](std::int64_t step) {
        LedRun run(eventful);
        std::string all;
        for (std::int64_t now = 0; now < 5 * led_s;) {
            const std::int64_t next = (now / led_s + 1) * led_s + 123'457;
            run.write(ubx_poll_version());
            for (; now < next; all += run.read()) {
                now = std::min(next, now + step);
                run.advance(now);
            }
        }
        return all;
    };
    const std::string coarse = talk(led_s);
    EXPECT_NE(coarse.find(std::string("\xB5\x62\x0A\x04", 4)), std::string::npos);
    EXPECT_EQ(talk(7'654'321), coarse);
}

TEST(LedBytes, OfTwoSpeedsAreGarbage) {
    LedRun run;
    ASSERT_EQ(sky_set_baud(run, 0, 9600), SKY_OK);
    run.advance(2 * led_s);
    EXPECT_EQ(run.read().find("$GNRMC"), std::string::npos);
    ASSERT_EQ(sky_set_baud(run, 0, 38400), SKY_OK);
    run.advance(4 * led_s);
    const std::string heard = run.read();
    EXPECT_NE(heard.find("RMC"), std::string::npos);
    ASSERT_EQ(sky_set_baud(run, 0, 0), SKY_OK);
    EXPECT_EQ(sky_set_baud(run, 0, 50'000'001), SKY_E_RANGE);
    EXPECT_EQ(sky_set_baud(run, 7, 9600), SKY_E_ARG);
}

TEST(LedBytes, MoreThanAMegabyteDoesNotWait) {
    LedRun run;
    run.advance(0);
    const std::string much(700'000, 'x');
    EXPECT_EQ(sky_write(run, 0, much.data(), much.size()), 700'000);
    EXPECT_EQ(sky_write(run, 0, much.data(), much.size()), (1 << 20) - 700'000);
    EXPECT_EQ(sky_write(run, 0, much.data(), much.size()), 0);
    run.advance(2 * led_s);
    EXPECT_GT(sky_write(run, 0, much.data(), much.size()), 0);
}

TEST(LedBytes, EachReceiverHasItsPorts) {
    LedRun run(R"(
[model]
name = "ideal"
[[receiver]]
name = "front"
board = "ublox-m9"
port = ["pty", "usb=tcp:1"]
[[receiver]]
name = "rear"
board = "ublox-m8"
)");
    const sky_progress progress = run.progress_at(3 * led_s);
    EXPECT_EQ(progress.ports, 3U);
    EXPECT_EQ(progress.ports_pending, 7U);
    EXPECT_EQ(progress.epochs, run.fix(0).epochs + run.fix(1).epochs);
    for (std::uint32_t port = 0; port < 3; ++port)
        EXPECT_NE(run.read(port).find("RMC"), std::string::npos) << port;
    char byte = 0;
    EXPECT_EQ(sky_read(run, 3, &byte, 1), SKY_E_ARG);
    EXPECT_EQ(sky_write(run, 3, &byte, 1), SKY_E_ARG);
    const std::string ports = run.query("ports");
    EXPECT_NE(ports.find(R"({"port":1,"receiver":0,"receiver_name":"front","name":"usb","baud":null)"),
              std::string::npos)
        << ports;
}

}  // namespace
