// Ramps as a client sees them, one kind of each layer; and several faults at once, at random by a seed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "receiver/protocol/ubx_satellites.hpp"
#include "run/fault/fault_kind.hpp"
#include "support/fault_rows.hpp"

namespace skyloop::test {
namespace {

constexpr double lull = 0.05;  // s, between the last byte of one second and the first of the next

std::string ramped(std::string_view kind, std::string_view parameters) {
    return bench_fault(kind, std::string(parameters) + "\nramp_in_s = 10\nramp_out_s = 8", 20, 40);
}

// The share of its full strength that a fault shows: grown by 30 s, faded by 48 s.
void expect_ramp(const std::vector<double>& share, double tolerance) {
    ASSERT_GE(share.size(), 56U);
    for (std::size_t second = 3; second < 56; ++second) {
        const double s = static_cast<double>(second);
        const double in = std::clamp((s - 20) / 10, 0.0, 1.0), out = std::clamp((48 - s) / 8, 0.0, 1.0);
        EXPECT_NEAR(share[second], std::min(in, out), tolerance) << second << " s";
    }
}

std::map<int, int> strengths(const HeardMessage& message) {
    const NavSat told = decode_payload<NavSat>(parse_frame(message.bytes)->payload).value();
    std::map<int, int> strengths;
    for (const NavSatItem& satellite : told.satellites)
        if (satellite.cno > 0) strengths[satellite.gnss_id * 256 + satellite.sv_id] = satellite.cno;
    return strengths;
}

// dB, of the satellites that both runs track: the weakest are lost.
double mean_loss(const std::map<int, int>& sound, const std::map<int, int>& faulty) {
    double sum = 0, count = 0;
    for (const auto& [satellite, cn0] : faulty)
        if (const auto other = sound.find(satellite); other != sound.end()) sum += other->second - cn0, count += 1;
    return count > 0 ? sum / count : 0;
}

TEST(FaultRamps, OfTheSignalsWeakenTheStrengthsStepByStep) {
    const BenchRun run = bench_run(measuring, ramped("cn0_drop", "attenuation_db = 10"), 60);
    std::vector<double> share;
    for (double second = 0; second < 60; ++second) {
        const auto faulty = run.between(second - lull, second + 1 - lull, "NAV-SAT");
        const auto sound = sound_run(measuring).between(second - lull, second + 1 - lull, "NAV-SAT");
        const bool both = !faulty.empty() && !sound.empty();
        share.push_back(both ? mean_loss(strengths(sound.front()), strengths(faulty.front())) / 10 : std::nan(""));
    }
    expect_ramp(share, 0.15);  // C/N0 is told in whole dB-Hz, of some ten satellites
}

TEST(FaultRamps, OfTheSolutionMoveThePositionStepByStep) {
    const BenchRun run = bench_run(sensor, ramped("position_step", "north_m = 100"), 60);
    std::vector<double> share;
    for (double second = 0; second < 60; ++second) {
        const auto faulty = run.between(second - lull, second + 1 - lull, "NAV-PVT");
        const auto sound = sound_run(sensor).between(second - lull, second + 1 - lull, "NAV-PVT");
        const bool both = !faulty.empty() && !sound.empty();
        share.push_back(both ? apart_m(*pvt_of(faulty[0]), *pvt_of(sound[0])) / 100 : 0);
    }
    expect_ramp(share, 0.001);
}

// How much later a run heard its NAV-PVT than the sound one, as a share of the full delay.
std::vector<double> lags(const BenchRun& run, double full_s) {
    const auto faulty = run.between(0, 60, "NAV-PVT"), sound = sound_run(sensor).between(0, 60, "NAV-PVT");
    std::vector<double> share(60, 0);
    for (std::size_t i = 0; i < std::min(faulty.size(), sound.size()); ++i)
        share[static_cast<std::size_t>(sound[i].at_s)] = (faulty[i].at_s - sound[i].at_s) / full_s;
    return share;
}

TEST(FaultRamps, OfTheReceiverSlowItStepByStep) {
    expect_ramp(lags(bench_run(sensor, ramped("solution_latency", "delay_s = 0.5"), 60), 0.5), 0.06);
}

TEST(FaultRamps, OfTheWireDelayItsBytesStepByStep) {
    expect_ramp(lags(bench_run(sensor, ramped("wire_delay", "delay_s = 0.5"), 60), 0.5), 0.1);
}

/// Some faults that overlap.
struct Overlay {
    std::string toml;
    std::set<std::string> kinds;
    std::set<FaultLayer> layers;
    bool exact = true;  ///< every byte is the same afterwards
    bool has(std::initializer_list<const char*> names) const {
        return std::any_of(names.begin(), names.end(), [&](const char* name) { return kinds.contains(name); });
    }
};

// Two to four kinds, but those that a client has to mend; each within its own part of the bench's time, some ramped.
Overlay random_overlay(std::uint64_t seed, FaultBench bench) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t count) { return random() % count; };
    Overlay overlay;
    for (std::uint64_t count = 2 + below(3); overlay.kinds.size() < count;) {
        const FaultRow& row = fault_rows[below(std::size(fault_rows))];
        if (row.client_must_configure || row.seen_in == "pace" || (row.bench != sensor && row.bench != bench)) continue;
        if (!overlay.kinds.insert(std::string(row.kind)).second) continue;
        overlay.layers.insert(find_fault_kind(row.kind)->layer);
        overlay.exact = overlay.exact && row.bound_m < 0;
        const double begin = 20 + static_cast<double>(below(20)), end = begin + 5 + static_cast<double>(below(15));
        std::string parameters(row.parameters);
        if (below(2) == 0 && find_fault_kind(row.kind)->has_strength) parameters += "\nramp_in_s = 3\nramp_out_s = 4";
        overlay.toml += bench_fault(row.kind, parameters, begin, end);
    }
    return overlay;
}

// What a client may rely on whatever is wrong behind a sound wire.
void expect_sound_stream(const BenchRun& run, const Overlay& overlay) {
    double last_tow = -1;
    for (const HeardMessage& message : run.heard) {
        if (message.at_s < 2) continue;  // the speed is being found
        EXPECT_NE(message.name, "noise") << message.at_s << " s";
        if (message.name.size() == 3) {
            std::string text = to_string(message.bytes);
            EXPECT_EQ(text.find("nan"), std::string::npos) << text;
            EXPECT_EQ(text.find("inf"), std::string::npos) << text;
        }
        const auto pvt = pvt_of(message);
        if (!pvt) continue;
        EXPECT_LE(std::abs(pvt->lat), 900'000'000);
        EXPECT_LE(std::abs(pvt->lon), 1'800'000'000);
        if (overlay.has(
                {"week_order", "week_rollover", "time_step", "time_backwards", "time_drift", "reordered_epochs"}))
            continue;
        constexpr double week_ms = 604'800'000;
        const double tow = pvt->i_tow < 300'000'000 ? pvt->i_tow + week_ms : pvt->i_tow.raw;
        EXPECT_GE(tow, last_tow) << message.at_s << " s";
        last_tow = tow;
    }
}

class FaultCombinations : public testing::TestWithParam<int> {};

TEST_P(FaultCombinations, KeepTheStreamSoundAndEndWithoutResidue) {
    const FaultBench bench = GetParam() % 4 == 0 ? measuring : sensor;
    const Overlay overlay = random_overlay(static_cast<std::uint64_t>(GetParam()), bench);
    SCOPED_TRACE(overlay.toml);
    constexpr double length_s = 140, settled = 125 - lull;
    const BenchRun run = bench_run(bench, overlay.toml, length_s);
    const bool line_is_wrong = overlay.layers.contains(FaultLayer::wire) || overlay.has({"changed_baud"});
    if (!line_is_wrong) expect_sound_stream(run, overlay);
    const auto heard = run.between(settled, length_s - lull),
               sound = sound_run(bench).between(settled, length_s - lull);
    ASSERT_EQ(heard.size(), sound.size());
    for (std::size_t i = 0; i < heard.size(); ++i) {
        ASSERT_EQ(heard[i].name, sound[i].name) << i;
        ASSERT_TRUE(!overlay.exact || heard[i].bytes == sound[i].bytes)
            << heard[i].name << " of " << heard[i].at_s << " s";
        const auto pvt = pvt_of(heard[i]);
        EXPECT_TRUE(!pvt || apart_m(*pvt, *pvt_of(sound[i])) <= (bench == measuring ? 3 : 0.001)) << heard[i].at_s;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FaultCombinations, testing::Range(1, 25));

}  // namespace
}  // namespace skyloop::test
