// Any sequence of calls of skyloop.h with any content of its structures: statuses that the header knows, time that does
// not go back, and not a byte beside the caller's own.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "require.hpp"
#include "skyloop.h"

namespace {

using skyloop::require;

// The bytes of the fuzzer, then zeros.
class Calls {
public:
    Calls(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    [[nodiscard]] bool done() const { return size_ == 0; }
    template <class T>
    T take() {
        T value{};
        const std::size_t count = std::min(sizeof value, size_);
        std::memcpy(&value, data_, count);
        data_ += count;
        size_ -= count;
        return value;
    }
    std::string text() {
        const std::size_t count = std::min<std::size_t>(take<std::uint8_t>(), size_);
        std::string value(reinterpret_cast<const char*>(data_), count);
        data_ += count;
        size_ -= count;
        return value;
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
};

void check_status(std::int64_t status) { require(status >= SKY_E_BUSY); }

// Mostly a plausible one, so that the run is reached; the rest is as it comes.
sky_truth any_truth(Calls& calls, std::int64_t now) {
    auto truth = calls.take<sky_truth>();
    const auto tame = calls.take<std::uint8_t>();
    if (tame & 1U) truth.struct_size = sizeof truth;
    if (tame & 2U) truth.fields = SKY_POS_LOCAL_NED | (truth.fields & (SKY_VEL | SKY_ACC | SKY_ATT | SKY_RESET));
    if (tame & 4U) truth.vehicle = 0;
    if (tame & 8U) truth.sim_time_ns = now + truth.sim_time_ns % 3'000'000'000;
    return truth;
}

void any_sky(sky_emulator* emulator, Calls& calls) {
    struct {
        std::array<sky_sat, 40> satellites{};
        std::uint64_t fence = 0x5AFE;
    } room;
    const std::size_t capacity = calls.take<std::uint8_t>() % (room.satellites.size() + 1);
    const auto count = sky_get_sats(emulator, 0, room.satellites.data(), capacity, sizeof(sky_sat));
    require(count >= 0 && room.fence == 0x5AFE);
    auto los = calls.take<sky_los>();
    if (capacity > 0 && count > 0) {
        los.gnss_id = room.satellites[0].gnss_id;
        los.sv_id = room.satellites[0].sv_id;
    }
    check_status(sky_set_los(emulator, calls.take<std::uint8_t>() % 2, &los, 1, sizeof los));
}

void any_bytes(sky_emulator* emulator, Calls& calls) {
    const std::string bytes = calls.text();
    const auto written = sky_write(emulator, calls.take<std::uint8_t>() % 2, bytes.data(), bytes.size());
    require(written == SKY_E_ARG || written <= static_cast<std::int64_t>(bytes.size()));
    std::array<char, 100> heard{};
    const auto read = sky_read(emulator, 0, heard.data(), heard.size());
    require(read >= 0 && read <= 100);
    check_status(sky_set_baud(emulator, 0, calls.take<std::uint32_t>()));
}

void any_text(sky_emulator* emulator, Calls& calls) {
    const std::string text = calls.text();
    check_status(sky_command(emulator, text.c_str()));
    check_status(sky_query(emulator, text.c_str(), nullptr, 0));
    require(sky_query(emulator, "status", nullptr, 0) > 0);
    std::array<char, 16> sentence{};
    require(sky_last_error(emulator, sentence.data(), sentence.size()) >= 0 && sentence.back() == '\0');
}

void any_advance(sky_emulator* emulator, Calls& calls, std::int64_t& now) {
    const auto wild = calls.take<std::int64_t>();
    sky_progress progress{};
    progress.struct_size = sizeof progress;
    // Seconds of epochs are enough for a call.
    const std::int64_t time = wild % 16 == 0 && (wild < now || wild > now + 86'401'000'000'000)
                                  ? wild
                                  : now + (wild & 0x7FFFFFFF) % 2'000'000'000;
    const sky_status status = sky_advance(emulator, time, &progress);
    check_status(status);
    if (status != SKY_OK && status != SKY_E_STATE) return;
    require(progress.now_ns >= now && progress.now_ns <= time && progress.next_event_ns >= progress.now_ns);
    now = progress.now_ns;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr int most_calls = 64;
    Calls calls(data, size);
    sky_create_info info{};
    info.struct_size = sizeof info;
    info.abi_major = SKY_ABI_MAJOR;
    info.scenario_text = "[model]\nname = \"ideal\"\n[[receiver]]\nboard = \"ublox-m8\"\n";
    info.start_utc = "2026-03-01T12:00:00Z";
    sky_emulator* emulator = nullptr;
    require(sky_create(&info, &emulator) == SKY_OK);
    std::int64_t now = 0;
    for (int i = 0; i < most_calls && !calls.done(); ++i)
        switch (calls.take<std::uint8_t>() % 5) {
            case 0: {
                const sky_truth truth = any_truth(calls, now);
                check_status(sky_set_truth(emulator, &truth));
                break;
            }
            case 1:
                any_sky(emulator, calls);
                break;
            case 2:
                any_bytes(emulator, calls);
                break;
            case 3:
                any_text(emulator, calls);
                break;
            default:
                any_advance(emulator, calls, now);
        }
    sky_destroy(emulator);
    return 0;
}
