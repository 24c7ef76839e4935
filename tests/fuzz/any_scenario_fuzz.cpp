// Any keys of a scenario, any faults in any world, led by the C interface: a sentence where it does not hold together,
// else a run in which every message stands, every number is one, time goes forward unless a fault says otherwise, and
// which is the same to the byte in other steps.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "any_scenario.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "require.hpp"
#include "run/fault/fault_kind.hpp"
#include "skyloop.h"

namespace {

using namespace skyloop;

constexpr std::int64_t run_ns = 8'000'000'000;

struct Destroy {
    void operator()(sky_emulator* emulator) const { sky_destroy(emulator); }
};
using Emulator = std::unique_ptr<sky_emulator, Destroy>;

// Null where the scenario was refused, which takes a sentence.
Emulator emulator_of(const std::string& toml, const char* start) {
    std::array<char, 4096> error{};
    sky_create_info info{};
    info.struct_size = sizeof info;
    info.abi_major = SKY_ABI_MAJOR;
    info.scenario_text = toml.c_str();
    info.start_utc = start;
    info.error = error.data();
    info.error_capacity = error.size();
    sky_emulator* emulator = nullptr;
    const sky_status status = sky_create(&info, &emulator);
    require((status == SKY_OK) == (emulator != nullptr));
    require(status == SKY_OK || (status != SKY_E_INTERNAL && error[0] != '\0'));
    return Emulator(emulator);
}

// What may be asked of the stream of one port.
struct StreamPromise {
    bool whole = true;      // no fault spoils bytes
    bool ascending = true;  // no fault moves time
};

StreamPromise promise_of(const AnyScenario& scenario) {
    constexpr std::string_view of_time[] = {
        "week_order",   "week_rollover",    "time_step",         "time_backwards", "time_drift",
        "clock_drift",  "reordered_epochs", "duplicated_epochs", "spoof_takeover", "meaconing",
        "changed_baud", "reboots",          "slow_cold_start",   "power_cut",      "reordered_messages"};
    StreamPromise promise;
    for (const std::string& fault : scenario.faults()) {
        const FaultKind* const kind = find_fault_kind(fault);
        if (kind == nullptr || kind->layer == FaultLayer::wire || fault == "changed_baud") promise.whole = false;
        for (const std::string_view name : of_time)
            if (fault == name) promise.ascending = false;
    }
    if (scenario.has_commands()) promise = {false, false};
    for (const std::string& board : scenario.boards())
        if (board == "septentrio-sbf" || board == "msp-gps" || board == "mavlink-gps-input") promise.whole = false;
    return promise;
}

// Listens to one port.
class Listener {
public:
    explicit Listener(StreamPromise promise) : promise_(promise) {}

    void hear(ByteSpan bytes) {
        heard.insert(heard.end(), bytes.begin(), bytes.end());
        for (const StreamPiece& piece : splitter_.feed(bytes)) {
            require(!promise_.whole || piece.kind != StreamKind::noise);
            if (piece.kind == StreamKind::nmea && promise_.whole) check_sentence(to_string(piece.bytes));
            if (piece.kind == StreamKind::ubx && promise_.whole) check_frame(*parse_frame(piece.bytes));
        }
    }

    Bytes heard;

private:
    static void check_sentence(const std::string& sentence) {
        require(sentence.starts_with("$GNTXT") || sentence.starts_with("$GPTXT") || sentence.starts_with("$P") ||
                (sentence.find("nan") == std::string::npos && sentence.find("inf") == std::string::npos));
    }
    void check_frame(const UbxFrameView& frame) {
        if (frame.id == RxmRawx::message_id) check_raw(decode_payload<RxmRawx>(frame.payload).value());
        if (frame.id != NavPvt::message_id) return;
        const NavPvt pvt = decode_payload<NavPvt>(frame.payload).value();
        require(std::abs(pvt.lat) <= 900'000'000 && std::abs(pvt.lon) <= 1'800'000'000);
        constexpr std::uint32_t week_ms = 604'800'000;
        require(pvt.i_tow < week_ms);
        const bool new_week = pvt.i_tow + week_ms / 2 < last_tow_;
        require(!promise_.ascending || new_week || pvt.i_tow >= last_tow_);
        last_tow_ = pvt.i_tow;
    }
    static void check_raw(const RxmRawx& raw) {
        require(std::isfinite(raw.rcv_tow));
        for (const RxmRawxItem& item : raw.measurements)
            require(std::isfinite(item.pr_mes) && std::isfinite(item.cp_mes) && std::isfinite(item.do_mes));
    }

    StreamPromise promise_;
    StreamSplitter splitter_;
    std::uint32_t last_tow_ = 0;
};

void check_numbers(sky_emulator* emulator, std::uint32_t receiver) {
    sky_fix fix{};
    fix.struct_size = sizeof fix;
    if (sky_get_fix(emulator, receiver, &fix) != SKY_OK || fix.epochs == 0) return;
    if (fix.type >= SKY_FIX_2D && fix.type != SKY_FIX_TIME_ONLY) {
        for (const double number : {fix.lat_deg, fix.lon_deg, fix.height_ellipsoid_m, fix.height_msl_m, fix.vel_ned[0],
                                    fix.vel_ned[1], fix.vel_ned[2], fix.error_enu_m[0], fix.error_enu_m[1]})
            require(std::isfinite(number));
        require(std::abs(fix.lat_deg) <= 90 && std::abs(fix.lon_deg) <= 180);
        require(fix.h_acc_m >= 0 && fix.v_acc_m >= 0 && fix.speed_acc_mps >= 0);
    }
    std::array<sky_sat, 64> satellites{};
    const auto count = sky_get_sats(emulator, receiver, satellites.data(), satellites.size(), sizeof(sky_sat));
    require(count >= 0);
    for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(count), satellites.size()); ++i)
        require(std::abs(satellites[i].el_deg) <= 90 && satellites[i].az_deg >= 0 && satellites[i].az_deg <= 360 &&
                satellites[i].cn0_dbhz >= 0 && satellites[i].cn0_dbhz < 100);
}

// The bytes of port 0 of a run in steps of so many nanoseconds.
Bytes lead(sky_emulator* emulator, std::int64_t step_ns, StreamPromise promise) {
    Listener listener(promise);
    for (const UbxMessageId id : {NavPvt::message_id, RxmRawx::message_id, UbxMessageId{0x01, 0x35}}) {
        const Bytes command = encode_frame(CfgMsgCurrentPort{id.message_class, id.id, 1});
        require(sky_write(emulator, 0, command.data(), command.size()) == static_cast<std::int64_t>(command.size()));
    }
    sky_progress progress{};
    progress.struct_size = sizeof progress;
    for (std::int64_t now = 0; now < run_ns;) {
        now = std::min(run_ns, now + step_ns);
        if (sky_advance(emulator, now, &progress) != SKY_OK) break;  // a command has ended it
        require(progress.now_ns <= now && progress.next_event_ns >= progress.now_ns);
        std::array<std::uint8_t, 4096> bytes;
        for (std::uint32_t port = 0; port < progress.ports; ++port)
            while (const auto count = sky_read(emulator, port, bytes.data(), bytes.size())) {
                require(count > 0);
                if (port == 0) listener.hear({bytes.data(), static_cast<std::size_t>(count)});
            }
        check_numbers(emulator, 0);
    }
    return listener.heard;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::array<const char*, 6> starts{"2026-03-01T12:00:00Z", "2024-03-09T23:59:38Z", "2016-12-31T23:59:55Z",
                                                "2019-04-06T23:59:38Z", "2024-02-28T23:59:55Z", "2038-11-20T23:59:40Z"};
    FuzzInput input({data, size});
    const std::uint8_t mode = input.byte();
    const char* const start = starts[mode % starts.size()];
    const AnyScenario scenario(input);
    const std::string toml = scenario.toml();
    if (std::getenv("SKYLOOP_FUZZ_SHOW") != nullptr) std::fputs(toml.c_str(), stderr);  // to understand a finding
    const Emulator emulator = emulator_of(toml, start);
    if (!emulator) return 0;
    const StreamPromise promise = promise_of(scenario);
    const Bytes heard = lead(emulator.get(), 1'000'000'000, promise);
    if (mode >= 192) require(lead(emulator_of(toml, start).get(), 370'000'000, promise) == heard);
    return 0;
}
