// Handles: how they begin and fail, that they do not meet each other, and what they are told and tell as JSON.
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <locale>
#include <nlohmann/json.hpp>
#include <thread>

#include "led_run.hpp"

namespace {

using namespace skyloop::test;
using Json = nlohmann::json;

constexpr std::string_view noisy_scenario = "[run]\nseed = 21\n[[receiver]]\nrate_hz = 5\nbaud = 115200\n";

sky_status create_status(sky_create_info info, std::string* why = nullptr) {
    char text[512] = "";
    info.error = text;
    info.error_capacity = sizeof text;
    sky_emulator* emulator = nullptr;
    const sky_status status = sky_create(&info, &emulator);
    EXPECT_EQ(emulator != nullptr, status == SKY_OK);
    sky_destroy(emulator);
    if (why != nullptr) *why = text;
    return status;
}

TEST(LedHandle, SaysItsVersion) {
    EXPECT_EQ(sky_abi_version(), std::uint32_t{SKY_ABI_MAJOR} << 16 | SKY_ABI_MINOR);
    sky_destroy(nullptr);
}

// What a program built for ABI 0.1 has laid out. These numbers never change.
TEST(LedHandle, StructuresAreLaidOutAsEver) {
    EXPECT_EQ(sizeof(sky_create_info), 16 + 5 * 8 + 8 + 8 + 8 + 8 + 8 + 8 + 24U);
    EXPECT_EQ(sizeof(sky_truth), 152U);
    EXPECT_EQ(offsetof(sky_truth, pos), 24U);
    EXPECT_EQ(sizeof(sky_progress), 48U);
    EXPECT_EQ(sizeof(sky_fix), 144U);
    EXPECT_EQ(sizeof(sky_sat), 28U);
    EXPECT_EQ(sizeof(sky_los), 40U);
}

TEST(LedHandle, IsNotMadeOfWhatIsWrong) {
    std::string why;
    EXPECT_EQ(create_status(led_info("[model]\nname = \"perfect\"\n"), &why), SKY_E_PARSE);
    EXPECT_NE(why.find("scenario_text:2:8"), std::string::npos) << why;
    EXPECT_EQ(create_status(led_info("[[receiver]]\nboard = \"no-such-board\"\n"), &why), SKY_E_PARSE);
    EXPECT_NE(why.find("no-such-board"), std::string::npos) << why;
    sky_create_info info = led_info(nullptr);
    info.scenario_file = "/no/such/file.toml";
    EXPECT_EQ(create_status(info, &why), SKY_E_IO);
    EXPECT_NE(why.find("/no/such/file.toml"), std::string::npos) << why;
    info = led_info("");
    info.start_utc = "yesterday";
    EXPECT_EQ(create_status(info, &why), SKY_E_PARSE);
    EXPECT_NE(why.find("start_utc"), std::string::npos) << why;
    info = led_info("");
    info.abi_major = SKY_ABI_MAJOR + 1;
    EXPECT_EQ(create_status(info), SKY_E_UNSUPPORTED);
    info = led_info("");
    info.set = 1U << 31U;
    EXPECT_EQ(create_status(info), SKY_E_UNSUPPORTED);
    info = led_info("");
    info.reserved = 1;
    EXPECT_EQ(create_status(info, &why), SKY_E_UNSUPPORTED);
    EXPECT_EQ(why, "reserved is 0x1; expected 0");
    info = led_info("");
    info.struct_size = 8;
    EXPECT_EQ(create_status(info), SKY_E_ARG);
    info = led_info("");
    info.set = SKY_CREATE_ORIGIN;
    info.origin_lla[0] = std::nan("");
    EXPECT_EQ(create_status(info), SKY_E_RANGE);
    info = led_info("");
    EXPECT_EQ(sky_create(&info, nullptr), SKY_E_ARG);
    sky_emulator* emulator = nullptr;
    EXPECT_EQ(sky_create(nullptr, &emulator), SKY_E_ARG);
}

TEST(LedHandle, ASentenceIsCutWhereThereIsNoRoom) {
    sky_create_info info = led_info("[model]\nname = \"perfect\"\n");
    char text[8] = "#######";
    info.error = text;
    info.error_capacity = 5;
    sky_emulator* emulator = nullptr;
    EXPECT_EQ(sky_create(&info, &emulator), SKY_E_PARSE);
    EXPECT_EQ(std::string(text, 8), std::string("scen\0##\0", 8));
    LedRun run;
    ASSERT_EQ(sky_query(run, "statos", nullptr, 0), SKY_E_UNSUPPORTED);
    const std::string whole = run.last_error();
    EXPECT_EQ(sky_last_error(run, text, 5), static_cast<std::int64_t>(whole.size()));
    EXPECT_EQ(text, whole.substr(0, 4));
    EXPECT_EQ(sky_last_error(run, nullptr, 0), static_cast<std::int64_t>(whole.size()));
}

TEST(LedHandle, SaysWhatIsWrongWithTheSizeOfItsStructure) {
    char text[128] = "#";
    sky_create_info info = led_info("");
    info.error = text;
    info.error_capacity = sizeof text;
    info.struct_size = offsetof(sky_create_info, start_sim_ns);
    sky_emulator* emulator = nullptr;
    EXPECT_EQ(sky_create(&info, &emulator), SKY_E_ARG);
    EXPECT_EQ(std::string(text), "struct_size is 88; expected 128 to 4096");
    EXPECT_EQ(sky_create(&info, nullptr), SKY_E_ARG);
    EXPECT_EQ(std::string(text), "out is null");
    // Nothing is read behind a size that was never set.
    for (const std::uint32_t size : {0U, 80U, 0xCCCCCCCCU}) {
        text[0] = '#';
        info.struct_size = size;
        EXPECT_EQ(sky_create(&info, &emulator), SKY_E_ARG);
        EXPECT_EQ(text[0], '#');
    }
    info.struct_size = sizeof info;
    EXPECT_EQ(sky_create(&info, &emulator), SKY_OK);
    EXPECT_EQ(std::string(text), "");
    sky_destroy(emulator);
}

TEST(LedHandle, TellsWhatALedRunLeavesOut) {
    ToldSentences told(SKY_LOG_WARNING);
    sky_create_info info = led_info(nullptr);
    told.listen(info);
    LedRun run(info, R"(
[trajectory]
kind = "live"
source = "udp-json:29990"
[[receiver]]
[[receiver]]
[[output]]
to = "json-tcp:9000"
[[expect]]
what = "fix within 60 s of the start of the run"
)");
    EXPECT_EQ(told.count("[[expect]]: a led run is not judged"), 1);
    EXPECT_EQ(told.count("[[output]]: a led run tells other programs nothing; skyloop run does that"), 1);
    EXPECT_EQ(told.count("source: nobody listens to udp-json:29990 in a led run"), 1);
}

TEST(LedHandle, WithoutAHandleNothingIsDone) {
    EXPECT_EQ(sky_advance(nullptr, 0, nullptr), SKY_E_ARG);
    EXPECT_EQ(sky_read(nullptr, 0, nullptr, 0), SKY_E_ARG);
    EXPECT_EQ(sky_query(nullptr, "status", nullptr, 0), SKY_E_ARG);
    EXPECT_EQ(sky_last_error(nullptr, nullptr, 0), SKY_E_ARG);
    LedRun run;
    EXPECT_EQ(sky_command(run, nullptr), SKY_E_ARG);
    EXPECT_EQ(sky_query(run, nullptr, nullptr, 0), SKY_E_ARG);
    EXPECT_EQ(sky_get_fix(run, 0, nullptr), SKY_E_ARG);
    EXPECT_EQ(sky_read(run, 0, nullptr, 3), SKY_E_ARG);
    sky_progress progress{};
    EXPECT_EQ(sky_advance(run, 0, &progress), SKY_E_ARG);
    sky_fix fix{};
    fix.struct_size = 12;
    EXPECT_EQ(sky_get_fix(run, 0, &fix), SKY_E_ARG);
    fix.struct_size = sizeof fix;
    EXPECT_EQ(sky_get_fix(run, 1, &fix), SKY_E_ARG);
    EXPECT_EQ(run.fix().epochs, 0U);
}

TEST(LedHandle, SameCallsGiveTheSameBytes) {
    LedRun one(noisy_scenario), two(noisy_scenario);
    const std::string bytes = fly_circle(one, 5 * led_s, 10 * led_ms);
    ASSERT_GT(bytes.size(), 2000U);
    EXPECT_EQ(fly_circle(two, 5 * led_s, 10 * led_ms), bytes);
    sky_create_info info = led_info(nullptr);
    info.set = SKY_CREATE_SEED;
    info.seed = 22;
    LedRun other(info, noisy_scenario);
    EXPECT_NE(fly_circle(other, 5 * led_s, 10 * led_ms), bytes);
    info.seed = 21;
    LedRun again(info, noisy_scenario);
    EXPECT_EQ(fly_circle(again, 5 * led_s, 10 * led_ms), bytes);
}

TEST(LedHandle, ManyInManyThreadsDoNotMeet) {
    const auto fly = [] {
        LedRun run(noisy_scenario);
        return fly_circle(run, 3 * led_s, 20 * led_ms);
    };
    const std::string alone = fly();
    std::vector<std::string> bytes(4);
    std::vector<std::thread> threads;
    for (std::string& mine : bytes)
        threads.emplace_back([&] { mine = fly(); });
    for (std::thread& thread : threads)
        thread.join();
    for (const std::string& mine : bytes)
        EXPECT_EQ(mine, alone);
}

TEST(LedHandle, ForTwoAtOnceIsBusyAndUnharmed) {
    LedRun run(noisy_scenario);
    std::atomic<bool> done{false};
    std::atomic<int> busy{0}, taken{0};
    std::thread other([&] {
        char bytes[16];
        while (!done) {
            const auto count = sky_read(run, 0, bytes, sizeof bytes);
            EXPECT_TRUE(count >= 0 || count == SKY_E_BUSY);
            (count == SKY_E_BUSY ? busy : taken)++;
        }
    });
    std::int64_t now = 0;
    while (now < 36000 * led_s && (busy == 0 || taken == 0)) {
        const sky_status status = sky_advance(run, now + led_s, nullptr);
        EXPECT_TRUE(status == SKY_OK || status == SKY_E_BUSY);
        if (status == SKY_OK) now += led_s;
    }
    done = true;
    other.join();
    EXPECT_GT(busy, 0);
    EXPECT_GT(taken, 0);
    EXPECT_EQ(run.progress_at(now).now_ns, now);
}

TEST(LedHandle, IsBusyForItsOwnLogFunction) {
    struct Caller {
        sky_emulator* emulator = nullptr;
        std::vector<sky_status> answers{};
    } caller;
    sky_create_info info = led_info(noisy_scenario.data());
    info.log_user = &caller;
    info.log = [](void* user, std::int32_t, const char*) {
        auto& told = *static_cast<Caller*>(user);
        if (told.emulator != nullptr) told.answers.push_back(sky_advance(told.emulator, 99 * led_s, nullptr));
    };
    ASSERT_EQ(sky_create(&info, &caller.emulator), SKY_OK);
    const sky_truth truth = truth_there(0, 46, 30, 100);
    ASSERT_EQ(sky_set_truth(caller.emulator, &truth), SKY_OK);
    EXPECT_EQ(sky_advance(caller.emulator, 9 * led_s, nullptr), SKY_OK);  // tells that the vehicle stands still
    EXPECT_EQ(caller.answers, std::vector<sky_status>{SKY_E_BUSY});
    sky_destroy(caller.emulator);
}

// What the program around us has done to its own streams is not ours.
TEST(LedHandle, DoesNotSpeakTheCallersLocale) {
    struct Commas : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const auto fly = [] {
        LedRun run(noisy_scenario);
        return fly_circle(run, 2 * led_s, 20 * led_ms) + run.query("status");
    };
    const std::string plain = fly();
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Commas));
    const std::string with_commas = fly();
    std::locale::global(before);
    EXPECT_EQ(with_commas, plain);
}

TEST(LedCommand, BeginsAFaultNow) {
    LedRun run(noisy_scenario);
    run.advance(2 * led_s);
    ASSERT_EQ(run.fix().type, SKY_FIX_3D);
    ASSERT_EQ(sky_command(run, R"({"command": "start_fault", "kind": "outage", "name": "tunnel", "for_s": 3})"), SKY_OK)
        << run.last_error();
    run.advance(4 * led_s);
    EXPECT_LE(run.fix().type, SKY_FIX_DEAD_RECKONING);
    const Json status = Json::parse(run.query("status"));
    ASSERT_EQ(status["timeline"].size(), 1U);
    EXPECT_EQ(status["timeline"][0]["name"], "tunnel");
    EXPECT_EQ(status["timeline"][0]["begins_s"], 2.0);
    EXPECT_EQ(status["timeline"][0]["active"], true);
    EXPECT_EQ(status["elapsed_s"], 4.0);
    EXPECT_EQ(sky_command(run, R"({"command": "stop_fault", "fault": "tunnel"})"), SKY_OK);
    run.advance(20 * led_s);
    EXPECT_EQ(run.fix().type, SKY_FIX_3D);
}

TEST(LedCommand, ThatMakesNoSenseIsRefused) {
    LedRun run(noisy_scenario);
    const std::vector<std::pair<const char*, sky_status>> cases{
        {"", SKY_E_PARSE},
        {"[1]", SKY_E_PARSE},
        {R"({"command": "fly"})", SKY_E_PARSE},
        {R"({"command": "start_fault", "kind": "jam"})", SKY_E_PARSE},
        {R"({"command": "pause"})", SKY_E_UNSUPPORTED},
        {R"({"command": "speed", "factor": 2})", SKY_E_UNSUPPORTED},
        {R"({"command": "restart", "start": "cold", "receiver": "nobody"})", SKY_E_ARG},
        {R"({"command": "stop_fault", "fault": "nothing"})", SKY_E_ARG}};
    for (const auto& [text, status] : cases) {
        EXPECT_EQ(sky_command(run, text), status) << text;
        EXPECT_FALSE(run.last_error().empty());
    }
    for (int i = 0; i < 256; ++i)
        ASSERT_EQ(sky_command(run, R"({"command": "note", "text": "x"})"), SKY_OK) << run.last_error();
    EXPECT_EQ(sky_command(run, R"({"command": "note", "text": "x"})"), SKY_E_STATE);
    run.advance(0);
    EXPECT_EQ(sky_command(run, R"({"command": "note", "text": "x"})"), SKY_OK);
}

TEST(LedQuery, TellsTheRunAsJson) {
    LedRun run(noisy_scenario);
    const Json before = Json::parse(run.query("status"));
    EXPECT_EQ(before["receivers"][0]["epochs"], 0);
    run.advance(3 * led_s);
    const Json status = Json::parse(run.query("status"));
    EXPECT_EQ(status["receivers"][0]["epochs"], 16);
    EXPECT_EQ(status["receivers"][0]["fix"]["type"], "3d");
    EXPECT_NEAR(status["receivers"][0]["fix"]["place"]["lat_deg"], run.fix().lat_deg, 1e-12);
    EXPECT_EQ(status["receivers"][0]["satellites"].size(), run.satellites().size());
    EXPECT_EQ(status["dialogue"].size(), 0U);
    const Json config = Json::parse(run.query("config"));
    EXPECT_EQ(config["seed"], 21);
    EXPECT_EQ(config["start_utc"], "2026-03-01T12:00:00.000Z");
    EXPECT_EQ(config["abi"], "0.1");
    EXPECT_GT(Json::parse(run.query("faults")).size(), 20U);
    EXPECT_GT(Json::parse(run.query("commands")).size(), 5U);
    char small[4] = "###";
    EXPECT_GT(sky_query(run, "status", small, sizeof small), 3);
    EXPECT_EQ(std::string(small), "###");
    EXPECT_EQ(sky_query(run, "statos", nullptr, 0), SKY_E_UNSUPPORTED);
    EXPECT_NE(run.last_error().find("did you mean"), std::string::npos) << run.last_error();
}

// "sequence" has a digit more from 10 on: whoever has measured the text is not to find another.
TEST(LedQuery, TellsTheSameUntilTheRunGoesOn) {
    LedRun run(noisy_scenario);
    run.advance(led_s);
    const std::string status = run.query("status");
    for (int i = 0; i < 12; ++i)
        ASSERT_EQ(run.query("status"), status);
    ASSERT_EQ(sky_command(run, R"({"command": "note", "text": "x"})"), SKY_OK);
    run.advance(led_s);
    const Json later = Json::parse(run.query("status"));
    EXPECT_GT(later["sequence"], Json::parse(status)["sequence"]);
    EXPECT_NE(later["events"], Json::parse(status)["events"]);
}

TEST(LedRecording, ThatCannotBeWrittenIsTold) {
    const auto folder = std::filesystem::temp_directory_path() / ("skyloop-full-" + std::to_string(::getpid()));
    const std::string path = folder.string();
    for (const std::int64_t seconds : {2, 60}) {
        std::filesystem::create_directories(folder);
        std::filesystem::create_symlink("/dev/full", folder / "satellites.csv");
        ToldSentences told(SKY_LOG_ERROR);
        sky_create_info info = led_info(nullptr);
        told.listen(info);
        info.record_dir = path.c_str();
        {
            LedRun run(info, noisy_scenario);
            // What is short waits in memory until the end.
            EXPECT_EQ(sky_advance(run, seconds * led_s, nullptr), seconds < 10 ? SKY_OK : SKY_E_IO);
            EXPECT_TRUE(told.all.empty());
        }
        EXPECT_EQ(told.count("satellites.csv: cannot be written"), 1) << seconds;
        std::filesystem::remove_all(folder);
    }
}

TEST(LedRecording, IsLeftWhenTheHandleIs) {
    const auto folder = std::filesystem::temp_directory_path() / ("skyloop-led-" + std::to_string(::getpid()));
    sky_create_info info = led_info(nullptr);
    const std::string path = folder.string();
    info.record_dir = path.c_str();
    std::string bytes;
    {
        LedRun run(info, noisy_scenario);
        bytes = fly_circle(run, 2 * led_s, 20 * led_ms);
    }
    std::ifstream file(folder / "port0.out", std::ios::binary);
    const std::string kept((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(kept, bytes);
    std::ifstream summary(folder / "run.json");
    EXPECT_EQ(Json::parse(summary)["seed"], 21);
    info.set = SKY_CREATE_ORIGIN;
    info.origin_lla[0] = 100;
    EXPECT_EQ(create_status(info), SKY_E_RANGE);
    std::ifstream refused(folder / "port0.out", std::ios::binary);
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(refused)), {}), bytes) << "a refused call changes nothing";
    info.set = 0;
    std::filesystem::remove_all(folder);
    info.record_dir = "/proc/nowhere";
    EXPECT_EQ(create_status(info), SKY_E_IO);
}

}  // namespace
