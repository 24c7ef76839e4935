/// A pair of receivers on one vehicle, faults of a scenario at the rover, and a client that asks and listens.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "support/run_parts.hpp"

namespace skyloop::test {

/// A whole message, or noise, as the client heard it.
struct HeardMessage {
    double at_s = 0;   ///< of the run, when its last byte came
    std::string name;  ///< "NAV-PVT", "GGA"; "noise"
    Bytes bytes;
    bool operator==(const HeardMessage& other) const { return name == other.name && bytes == other.bytes; }
};

/// For failures.
inline void PrintTo(const HeardMessage& message, std::ostream* out) { *out << message.name << " of " << message.at_s; }

/// The name of a piece of a stream.
inline std::string heard_name(const StreamPiece& piece) {
    if (piece.kind == StreamKind::ubx) return to_string(parse_frame(piece.bytes)->id);
    if (piece.kind == StreamKind::nmea) return to_string(piece.bytes).substr(3, 3);
    return "noise";
}

/// Configures the receiver at its factory's speed, then asks at another one, half a second after each full second, for
/// its version, some of its settings and its consent to one. Hears its line at its own speed alone.
class AskingClient : public Transport, public SimulatedEnd {
public:
    static constexpr std::uint32_t factory_speed = 38400, speed = 230400;

    /// @param again_at s of the run at which it configures the receiver anew; nothing: it sees no need
    AskingClient(GpsTime start, std::optional<double> again_at) : start_(start), now_(start), again_at_(again_at) {}

    std::size_t write(ByteSpan bytes) override {
        for (StreamPiece& piece : splitter_.feed(bytes)) {
            std::string name = heard_name(piece);
            heard_.push_back({difference(now_, start_).value(), std::move(name), std::move(piece.bytes)});
        }
        return bytes.size();
    }
    Bytes read() override { return std::exchange(outbox_, {}); }
    LineState line() override { return {true, speed_}; }
    SimulatedEnd* simulated_end() override { return this; }
    void tell_time(GpsTime now) override {
        now_ = now;
        const double run_s = difference(now, start_).value();
        if (configured_at_ && run_s > *configured_at_ + 0.1) speed_ = speed;
        if (!configured_at_ && run_s > 0.1) return configure(run_s);
        if (again_at_ && run_s > *again_at_) {
            again_at_.reset();
            return configure(run_s);
        }
        if (speed_ != speed || run_s < next_ask_s_) return;
        next_ask_s_ = std::floor(run_s) + 1.5;
        ask();
    }
    [[nodiscard]] std::optional<GpsTime> acts_at(GpsTime now) const override {
        return now + std::chrono::milliseconds(10);
    }
    [[nodiscard]] std::string description() const override { return "asking client"; }

    [[nodiscard]] const std::vector<HeardMessage>& heard() const { return heard_; }

private:
    static constexpr UbxMessageId wanted[] = {{0x01, 0x07}, {0x01, 0x03}, {0x01, 0x20}, {0x01, 0x3C}, {0x01, 0x26},
                                              {0x0A, 0x38}, {0x01, 0x35}, {0x02, 0x15}, {0x27, 0x09}, {0x02, 0x32}};
    static std::uint32_t key(std::string_view name) { return firmware::find_config_key(name)->id; }

    template <class Message>
    void send(const Message& message) {
        const Bytes frame = encode_frame(message);
        outbox_.insert(outbox_.end(), frame.begin(), frame.end());
    }
    void configure(double run_s) {
        speed_ = factory_speed;
        configured_at_ = run_s;
        CfgValset settings;
        settings.layers = 7;
        for (const UbxMessageId id : wanted)
            if (const auto rate = firmware::rate_key(id, firmware::PortId::uart1)) settings.pairs.push_back({*rate, 1});
        for (const char* name :
             {"CFG-ITFM-ENABLE", "CFG-HW-ANT_CFG_VOLTCTRL", "CFG-HW-ANT_CFG_SHORTDET", "CFG-HW-ANT_CFG_OPENDET"})
            settings.pairs.push_back({key(name), 1});
        settings.pairs.push_back({key("CFG-UART1-BAUDRATE"), speed});
        send(settings);
    }
    void ask() {
        const Bytes version = encode_frame({0x0A, 0x04}, {});
        outbox_.insert(outbox_.end(), version.begin(), version.end());
        CfgValgetPoll poll;
        poll.keys = {key("CFG-RATE-MEAS"), key("CFG-UART1-BAUDRATE"), key("CFG-NAVSPG-DYNMODEL"),
                     *firmware::rate_key({0x01, 0x07}, firmware::PortId::uart1)};
        send(poll);
        CfgValset settings;
        settings.layers = 1;
        settings.pairs.push_back({key("CFG-RATE-NAV"), 1});
        send(settings);
    }

    GpsTime start_, now_;
    std::optional<double> again_at_, configured_at_;
    double next_ask_s_ = 1.5;
    std::uint32_t speed_ = factory_speed;
    StreamSplitter splitter_;
    Bytes outbox_;
    std::vector<HeardMessage> heard_;
};

/// How the rover comes to its fixes: by a sensor model, by what it measures, and by corrections of a base besides.
enum class FaultBench { sensor, measuring, corrected };

/// What a run left behind.
struct BenchRun {
    std::vector<HeardMessage> heard;
    std::vector<std::pair<double, double>> speeds;  ///< s of the run, and simulated s per s of a live one

    /// What was heard from one time on, until another one, s of the run; of one name, or of all.
    [[nodiscard]] std::vector<HeardMessage> between(double from, double to, std::string_view name = {}) const {
        std::vector<HeardMessage> found;
        for (const HeardMessage& message : heard)
            if (message.at_s >= from && message.at_s < to && (name.empty() || message.name == name))
                found.push_back(message);
        return found;
    }
};

/// Times of all runs on the bench, s: the week of GPS ends at 35, the day of UTC at 53.
inline constexpr double bench_begin_s = 20, bench_end_s = 60;

/// The base of the bench "corrected" stands in the middle of the rover's circle.
inline constexpr double bench_latitude = 46.5, bench_longitude = 30.75, bench_height_m = 50;

/// A minute before the end of the week, on a slow circle.
inline std::string bench_scenario(FaultBench bench, const std::string& faults) {
    const std::string base =
        bench == FaultBench::corrected
            ? "[receiver.trajectory]\nkind = \"fixed\"\nat = [46.5, 30.75, 50]\n"
              "[[receiver]]\nname = \"rover\"\nboard = \"ublox-f9p\"\ncorrections_from = \"base\"\n"
            : "antenna_offset_m = [-0.5, 0, 0]\n"
              "[[receiver]]\nname = \"rover\"\nboard = \"ublox-f9p\"\nbase = \"base\"\n"
              "antenna_offset_m = [0.5, 0, 0]\n";
    return std::string("[run]\nstart = 2024-03-09T23:59:07Z\nseed = 5\n[model]\nname = \"") +
           (bench == FaultBench::sensor ? "baseline" : "modern") +
           "\"\n[trajectory]\nkind = \"circle\"\ncentre = [46.5, 30.75, 50]\nradius_m = 300\nspeed_mps = 3\n"
           "[[receiver]]\nname = \"base\"\nboard = \"ublox-f9p\"\n" +
           base + faults;
}

/// What makes a reference station of an F9P: its place, 1005, 1077 and 1230 at UART1.
inline Bytes reference_station_settings() {
    CfgValset settings;
    settings.layers = 1;
    const auto set = [&](std::string_view name, std::uint64_t value) {
        settings.pairs.push_back({firmware::find_config_key(name)->id, value});
    };
    constexpr std::uint64_t fixed = 2, by_angles = 1;
    set("CFG-TMODE-MODE", fixed);
    set("CFG-TMODE-POS_TYPE", by_angles);
    set("CFG-TMODE-LAT", static_cast<std::uint64_t>(bench_latitude * 1e7));
    set("CFG-TMODE-LON", static_cast<std::uint64_t>(bench_longitude * 1e7));
    set("CFG-TMODE-HEIGHT", static_cast<std::uint64_t>(bench_height_m * 100));
    set("CFG-UART1OUTPROT-NMEA", 0);
    set("CFG-UART1OUTPROT-RTCM3X", 1);
    for (const char* number : {"1005", "1077", "1230"})
        set(std::string("CFG-MSGOUT-RTCM_3X_TYPE") + number + "_UART1", 1);
    return encode_frame(settings);
}

/// Runs the bench for so long.
inline BenchRun bench_run(FaultBench bench, const std::string& faults, double length_s,
                          std::optional<double> configure_again_at = std::nullopt) {
    const Scenario scenario = emulator_scenario(bench_scenario(bench, faults));
    const GpsTime start = scenario.run.start.value();
    std::vector<Station> stations;
    auto client = std::make_unique<AskingClient>(start, configure_again_at);
    const AskingClient& ears = *client;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        Station::Parts parts = station_parts(scenario, i, start);
        parts.name = scenario.receivers[i].name;
        parts.seed = i + 1;
        parts.base = scenario.receivers[i].base;
        parts.corrections_from = scenario.receivers[i].corrections_from;
        parts.overheard = bench == FaultBench::corrected;
        if (parts.overheard && i == 0)
            parts.receiver.input(firmware::PortId::uart1, reference_station_settings(), start);
        if (parts.base) parts.moving_base.emplace(parts.seed);
        if (parts.name == "rover") {
            const auto port = firmware::PortId::uart1;
            parts.wires.push_back({port, Link(std::move(client), port_speed(parts.receiver, port))});
        }
        stations.emplace_back(std::move(parts));
    }
    Emulator emulator({std::move(stations), std::make_unique<VirtualPacer>(start)}, start);
    Director::Parts director;
    director.faults = scenario.faults;
    director.start = start;
    emulator.replace_director(Director(std::move(director)));
    BenchRun run;
    emulator.on_status([&](const Status& status) {
        run.speeds.emplace_back(difference(status.now, start).value(), emulator.director().speed());
    });
    emulator.run_until(advanced(start, Seconds(length_s)), std::atomic<bool>(false));
    run.heard = ears.heard();
    return run;
}

/// One fault as a scenario would have it, at the rover, for the bench's time.
inline std::string bench_fault(std::string_view kind, std::string_view parameters, double begin_s = bench_begin_s,
                               double end_s = bench_end_s) {
    const std::string receiver = kind == "clock_drift" ? "" : "receiver = \"rover\"\n";  // all have one clock
    return "[[fault]]\nkind = \"" + std::string(kind) + "\"\n" + receiver + "at_s = " + std::to_string(begin_s) +
           "\nfor_s = " + std::to_string(end_s - begin_s) + "\n" + std::string(parameters) + "\n";
}

/// The message of a type; nothing for others.
inline std::optional<NavPvt> pvt_of(const HeardMessage& message) {
    if (message.name != "NAV-PVT") return std::nullopt;
    return decode_payload<NavPvt>(parse_frame(message.bytes)->payload).value();
}

/// How far two reported positions lie apart, m.
inline double apart_m(const NavPvt& a, const NavPvt& b) {
    const auto place = [](const NavPvt& pvt) {
        return to_ecef(Geodetic::degrees(pvt.lat.value(), pvt.lon.value(), pvt.height.value()));
    };
    return (place(a) - place(b)).length().value();
}

}  // namespace skyloop::test
