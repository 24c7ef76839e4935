// What a receiver that measures leaves behind: RINEX files that say what it measured, and every term in its column.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/time/utc_time.hpp"
#include "support/four_systems.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"
#include "world/rinex/observation_reader.hpp"
#include "world/rinex/rinex_writer.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::emulator_data;
using test::emulator_scenario;
using test::FourSystems;
using test::TemporaryFolder;

constexpr const char* receiver_of_four =
    "[[receiver]]\nboard = \"ublox-m9\"\nconstellations = [\"gps\", \"galileo\", \"beidou\", "
    "\"glonass\"]\ndual_frequency = true\n";

class ModernRecording : public testing::Test {
protected:
    // Two hours of records of four systems.
    ModernRecording() {
        const FourSystems systems;
        const GpsTime noon = to_gps_time({2024, 3, 5, 12, 0, 0, 0}, LeapSeconds::announced());
        std::vector<Ephemeris> records;
        for (const SatelliteId id : systems.satellites())
            for (int k = -2; k <= 4; ++k)
                if (const auto record = systems.ephemeris(id, noon + k * std::chrono::minutes(30)))
                    if (records.empty() || !(toe_of(records.back()) == toe_of(*record) &&
                                             satellite_of(records.back()) == satellite_of(*record)))
                        records.push_back(*record);
        NavigationTextHeader header;
        header.ionosphere = systems.ionosphere();
        header.leap_seconds = 18;
        header.date = noon;
        std::ofstream(folder_ / "four.rnx") << navigation_text(records, header);
    }
    std::string text(const std::string& rest, int duration = 20) const {
        return "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = " + std::to_string(duration) +
               "\n[sky]\nnavigation = \"" + (folder_ / "four.rnx").string() + "\"\n" + rest;
    }
    // Runs into folder/run and gives the trace of each epoch.
    std::vector<Trace> run(const std::string& scenario) {
        RunMode mode;
        mode.virtual_time = true;
        mode.open_ports = false;
        mode.record = folder_ / "run";
        auto assembly = assemble(emulator_scenario(scenario), emulator_data(), mode);
        EXPECT_TRUE(assembly) << assembly.error().message;
        if (!assembly) return {};
        EXPECT_TRUE(assembly->emulator->begin());
        std::vector<Trace> traces;
        assembly->emulator->on_status([&](const Status& status) { traces.push_back(*status.trace); });
        assembly->emulator->run_until(*assembly->end, false);
        assembly->emulator->recorder()->record_summary("{\"program\": \"skyloop\"}");
        EXPECT_FALSE(assembly->emulator->recorder()->failure());
        return traces;
    }
    [[nodiscard]] std::string recorded(const std::string& name) const { return content_of(folder_ / "run" / name); }
    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / "run" / name); }

    TemporaryFolder folder_;
};

// To the resolution of the format: 0.001 m, cycles, Hz and dB-Hz.
void expect_same(const Observation& read, const Observation& measured) {
    constexpr double half = 0.0005 + 1e-7;
    const std::string name = to_string(measured.satellite);
    EXPECT_EQ(read.satellite, measured.satellite);
    EXPECT_EQ(read.signal, measured.signal) << name;
    EXPECT_NEAR(read.carrier.value(), measured.carrier.value(), 1e-3) << name;
    EXPECT_NEAR(read.cn0.value(), measured.cn0.value(), half) << name;
    ASSERT_EQ(read.pseudorange.has_value(), measured.pseudorange.has_value()) << name;
    if (measured.pseudorange) {
        EXPECT_NEAR(read.pseudorange->value(), measured.pseudorange->value(), half) << name;
    }
    ASSERT_EQ(read.carrier_phase.has_value(), measured.carrier_phase.has_value()) << name;
    if (measured.carrier_phase) {
        EXPECT_NEAR(*read.carrier_phase, *measured.carrier_phase, half) << name;
    }
    ASSERT_EQ(read.doppler.has_value(), measured.doppler.has_value()) << name;
    if (measured.doppler) {
        EXPECT_NEAR(read.doppler->value(), measured.doppler->value(), half) << name;
    }
    if (measured.carrier_phase) {
        EXPECT_EQ(read.half_cycle_resolved, measured.half_cycle_resolved) << name;
    }
}

TEST_F(ModernRecording, ObservationsReadBackAreThoseOfTheReceiver) {
    const auto traces = run(text(receiver_of_four));
    ASSERT_EQ(traces.size(), 20U);
    const auto file = read_observations(recorded("observations.rnx"), "observations.rnx");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->warnings, testing::IsEmpty());
    EXPECT_EQ(file->skipped, SkippedObservations{});
    EXPECT_EQ(file->interval, Seconds(1));
    EXPECT_EQ(file->leap_seconds, 18);
    EXPECT_EQ(file->receiver.substr(0, 8), "ublox-m9");
    ASSERT_TRUE(file->approximate_position);
    EXPECT_LT((*file->approximate_position - traces[0].truth.position).length().value(), 1e-3);
    ASSERT_EQ(file->epochs.size(), traces.size());
    std::set<SystemSignal> seen;
    for (std::size_t k = 0; k < traces.size(); ++k) {
        const Observations& measured = traces[k].epoch.observations;
        EXPECT_LE(std::abs((file->epochs[k].receive_time - measured.receive_time).count()), 50) << "ns";
        ASSERT_EQ(file->epochs[k].signals.size(), measured.signals.size());
        for (std::size_t i = 0; i < measured.signals.size(); ++i) {
            expect_same(file->epochs[k].signals[i], measured.signals[i]);
            seen.insert({measured.signals[i].satellite.constellation, measured.signals[i].signal});
        }
    }
    EXPECT_EQ(seen.size(), 8U) << "two signals of each of four systems";
}

// In the file of a single station the first record of a satellite comes when it rises.
TEST_F(ModernRecording, TheHeaderHasTheChannelsOfSlotsThatComeLater) {
    const auto whole = read_navigation(content_of(folder_ / "four.rnx"), "four.rnx");
    ASSERT_TRUE(whole);
    const GpsTime later = to_gps_time({2024, 3, 5, 13, 0, 0, 0}, LeapSeconds::announced());
    std::vector<Ephemeris> records;
    std::map<int, int> channels;
    for (const Ephemeris& record : whole->records) {
        const auto* glonass = std::get_if<GlonassEphemeris>(&record);
        if (glonass && toe_of(record) < later) continue;
        if (glonass) channels[glonass->satellite.number] = glonass->frequency_channel;
        records.push_back(record);
    }
    ASSERT_GT(channels.size(), 5U);
    std::ofstream(folder_ / "four.rnx") << navigation_text(records, {});
    run(text(receiver_of_four, 3));
    const auto file = read_observations(recorded("observations.rnx"), "observations.rnx");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->glonass_channels, channels);
}

TEST_F(ModernRecording, NavigationReadBackIsWhatTheSatellitesSent) {
    const std::string scenario = text(receiver_of_four, 3600) + "rate_hz = 0.1\n";
    const auto traces = run(scenario);
    const auto source = load_navigation(emulator_scenario(scenario), {});
    ASSERT_TRUE(source);
    const auto file = read_navigation(recorded("navigation.rnx"), "navigation.rnx");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->warnings, testing::IsEmpty());
    EXPECT_EQ(file->leap_seconds, 18);
    ASSERT_TRUE(file->ionosphere.gps && file->ionosphere.galileo);
    EXPECT_NEAR(file->ionosphere.gps->alpha[0], 0.1118e-7, 1e-12);
    std::map<std::pair<SatelliteId, GpsTime>, const Ephemeris*> records;
    for (const Ephemeris& record : file->records)
        EXPECT_TRUE(records.insert({{satellite_of(record), toe_of(record)}, &record}).second) << "written once";
    std::size_t used = 0;
    for (const Trace& trace : traces)
        for (const SatelliteInView& satellite : trace.sky.satellites) {
            const auto sent = source->source->ephemeris(satellite.id, trace.truth.time);
            ASSERT_TRUE(sent) << to_string(satellite.id);
            const auto found = records.find({satellite.id, toe_of(*sent)});
            ASSERT_NE(found, records.end()) << to_string(satellite.id);
            const SatelliteState a = satellite_state(*sent, trace.truth.time);
            const SatelliteState b = satellite_state(*found->second, trace.truth.time);
            EXPECT_LT((a.position - b.position).length().value(), 1e-6) << to_string(satellite.id);
            EXPECT_NEAR(a.clock_bias, b.clock_bias, 1e-17) << to_string(satellite.id);
            ++used;
        }
    EXPECT_GT(used, 1000U);
    EXPECT_GT(records.size(), 60U) << "GLONASS changes its records within the hour";
}

// Its own time of applicability is days away from the run, where no reader takes an ephemeris.
TEST_F(ModernRecording, AnAlmanacIsWrittenAsTheEphemeridesOfTheRun) {
    constexpr int satellites = 12;
    std::string almanac;
    for (int i = 0; i < satellites; ++i)
        almanac += fmt::format(
            "******** Week  256 almanac for PRN-{0:02} ********\nID: {0:02}\nHealth: 000\nEccentricity: 0.0066\n"
            "Time of Applicability(s): 405504.0\nOrbital Inclination(rad): 0.989\nRate of Right Ascen(r/s): -7.5E-009\n"
            "SQRT(A)  (m 1/2): 5153.68\nRight Ascen at Week(rad): {1}\nArgument of Perigee(rad): -1.78\n"
            "Mean Anom(rad): {2}\nAf0(s): 0.9E-004\nAf1(s/s): 0.36E-011\nweek: 256\n\n",
            i + 1, 1.047 * (i % 6), 0.5 * i - 3);
    std::ofstream(folder_ / "yuma.txt") << almanac;
    const std::string scenario = "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 7500\n[sky]\nnavigation = \"" +
                                 (folder_ / "yuma.txt").string() + "\"\n[[receiver]]\nrate_hz = 0.1\n";
    run(scenario);
    const auto written = read_navigation_file(folder_ / "run" / "navigation.rnx");
    ASSERT_TRUE(written) << written.error().message;
    const GpsTime noon = to_gps_time({2024, 3, 5, 12, 0, 0, 0}, LeapSeconds::announced());
    const auto read = load_navigation(emulator_scenario(scenario), noon);
    ASSERT_TRUE(read);
    std::set<int> issues;
    for (const Ephemeris& record : written->records) {
        const SatelliteId id = satellite_of(record);
        EXPECT_LE(std::chrono::abs(toe_of(record) - noon - 1h), 1h + 18s) << to_string(id);
        const auto sent = read->source->ephemeris(id, toe_of(record));
        ASSERT_TRUE(sent) << to_string(id);
        for (const auto offset : {-1h, 0h, 1h}) {
            const GpsTime t = toe_of(record) + offset;
            const SatelliteState is = satellite_state(record, t), was = satellite_state(*sent, t);
            EXPECT_LT((is.position - was.position).length().value(), 1e-3) << to_string(id);
            EXPECT_NEAR(is.clock_bias, was.clock_bias, 1e-14);
        }
        issues.insert(iode_of(record));
    }
    EXPECT_EQ(issues.size(), 2u) << "of 12:00 and of 14:00";
}

TEST_F(ModernRecording, SensorModelsMeasureNothingAndRemoveWhatAnotherRunLeft) {
    run(text("", 2));
    EXPECT_TRUE(exists("observations.rnx"));
    EXPECT_TRUE(exists("navigation.rnx"));
    run(text("[model]\nname = \"baseline\"\n", 2));
    EXPECT_FALSE(exists("observations.rnx"));
    EXPECT_FALSE(exists("navigation.rnx"));
    run(text("[model]\nname = \"ideal\"\n", 2));
    EXPECT_FALSE(exists("observations.rnx"));
    EXPECT_TRUE(exists("satellites.csv"));
}

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& table) {
    const auto lines = test::lines_of(table);
    const auto names = test::cells_of(lines.at(0));
    std::vector<Row> rows;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const auto cells = test::cells_of(lines[k]);
        EXPECT_EQ(cells.size(), names.size());
        rows.emplace_back();
        for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i)
            rows.back()[names[i]] = cells[i];
    }
    return rows;
}

void expect_cell(const Row& row, const char* column, double value, double tolerance) {
    ASSERT_NE(row.at(column), "") << column;
    EXPECT_NEAR(std::stod(row.at(column)), value, tolerance) << column;
}

void expect_arrival(const Row& row, const Arrival& arrival) {
    expect_cell(row, "iono_delay_m", arrival.iono_delay.value(), 6e-5);
    expect_cell(row, "tropo_delay_m", arrival.tropo_delay.value(), 6e-5);
    expect_cell(row, "gas_loss_db", arrival.gas_loss.value(), 6e-6);
    expect_cell(row, "rain_loss_db", arrival.rain_loss.value(), 6e-6);
    expect_cell(row, "orbit_clock_error_m", arrival.signal_in_space_error.value(), 6e-5);
    expect_cell(row, "foliage_loss_db", arrival.foliage_loss.value(), 6e-4);
    expect_cell(row, "antenna_gain_dbic", arrival.antenna_gain.value(), 6e-4);
    expect_cell(row, "power_offset_db", arrival.power_offset.value(), 6e-4);
    expect_cell(row, "interference_loss_db", arrival.interference_loss.value(), 6e-4);
    expect_cell(row, "amplitude_scintillation", arrival.amplitude_scintillation, 6e-5);
    expect_cell(row, "phase_scintillation_rad", arrival.phase_scintillation.rad(), 6e-5);
    expect_cell(row, "false_range_m", arrival.false_range.value(), 6e-5);
}

constexpr const char* rough_world = R"toml(
[atmosphere]
rain_mm_h = 20
[model.modern.losses]
canopy_depth_m = 5
[model.modern.interference]
jammer_to_signal_db = 15
[model.modern.scintillation]
s4 = 0.3
sigma_phi_rad = 0.2
)toml";

TEST_F(ModernRecording, WithoutPowerNothingIsMeasured) {
    const auto traces = run(text("[[fault]]\nkind = \"power_cut\"\nat_s = 8.5\nfor_s = 10\nstart = \"hot\"\n", 40));
    ASSERT_EQ(traces.size(), 40U);
    for (std::size_t i = 0; i < traces.size(); ++i) {
        const bool off = i > 8 && i < 19;
        if (off || i == 7 || i > 30) {
            EXPECT_EQ(traces[i].epoch.fix.has_position(), !off) << i;
            EXPECT_EQ(traces[i].epoch.observations.signals.empty(), off) << i;
        }
    }
}

TEST_F(ModernRecording, AFaultOfAPseudorangeStandsInItsColumn) {
    run(text("[[fault]]\nkind = \"pseudorange_step\"\nat_s = 5.5\nstep_m = 60\n"));
    std::map<std::string, int> with_step;  // by the second
    for (const Row& row : rows_of(recorded("satellites.csv")))
        with_step[row.at("time_utc")] += row.at("false_range_m") == "60.0000" ? 1 : 0;
    int epoch = 0;
    for (const auto& [time, count] : with_step)
        EXPECT_EQ(count, epoch++ > 5 ? 1 : 0) << time;
    EXPECT_EQ(epoch, 20);
}

TEST_F(ModernRecording, EveryTermStandsInItsColumn) {
    const auto traces = run(text("[[receiver]]\nconstellations = [\"gps\", \"glonass\"]\n" + std::string(rough_world)));
    const auto rows = rows_of(recorded("satellites.csv"));
    std::size_t at = 0, tracked = 0, untracked = 0;
    for (const Trace& trace : traces)
        for (std::size_t i = 0; i < trace.sky.satellites.size(); ++i) {
            ASSERT_LT(at, rows.size());
            const Row& row = rows[at++];
            const SatelliteId id = trace.sky.satellites[i].id;
            ASSERT_EQ(row.at("satellite"), to_string(id));
            expect_arrival(row, trace.arrivals.satellites[i]);
            const auto& terms = trace.measurement.signals;
            const auto term = std::find_if(terms.begin(), terms.end(), [&](auto& t) { return t.satellite == id; });
            const auto& signals = trace.epoch.observations.signals;
            const auto seen = std::find_if(signals.begin(), signals.end(), [&](auto& o) { return o.satellite == id; });
            if (seen == signals.end()) {
                for (const char* column : {"pseudorange_m", "multipath_m", "code_noise_m", "phase_noise_m",
                                           "doppler_noise_hz", "residual_m"})
                    EXPECT_EQ(row.at(column), "") << column << " of " << to_string(id) << ", which is not tracked";
                EXPECT_EQ(row.at("used"), "0");
                ++untracked;
                continue;
            }
            ASSERT_NE(term, terms.end());
            expect_cell(row, "multipath_m", term->multipath.value(), 6e-5);
            expect_cell(row, "code_noise_m", term->code_noise.value(), 6e-5);
            expect_cell(row, "phase_noise_m", term->phase_noise.value(), 6e-6);
            expect_cell(row, "doppler_noise_hz", term->doppler_noise.value(), 6e-5);
            ASSERT_TRUE(seen->pseudorange);
            expect_cell(row, "pseudorange_m", seen->pseudorange->value(), 6e-5);
            ++tracked;
        }
    EXPECT_EQ(at, rows.size());
    EXPECT_GT(tracked, 50U);
    EXPECT_GT(untracked, 50U) << "Galileo and BeiDou stand in the sky all the same";
}

TEST_F(ModernRecording, WhereNothingIsTrackedThereIsNoPseudorange) {
    const auto traces = run(text("[model.modern.interference]\njammer_to_signal_db = 60\n", 3));
    const auto rows = rows_of(recorded("satellites.csv"));
    for (const Trace& trace : traces)
        EXPECT_THAT(trace.epoch.observations.signals, testing::IsEmpty());
    EXPECT_GT(rows.size(), 30U);
    for (const Row& row : rows)
        EXPECT_EQ(row.at("pseudorange_m"), "") << row.at("satellite");
}

// B2I stands before B1I among the measurements.
TEST_F(ModernRecording, RowsSpeakOfTheFirstSignalOfTwo) {
    const auto traces = run(text(receiver_of_four, 5));
    const auto rows = rows_of(recorded("satellites.csv"));
    std::size_t at = 0, told = 0;
    for (const Trace& trace : traces)
        for (const SatelliteInView& sky : trace.sky.satellites) {
            const Row& row = rows.at(at++);
            for (const Observation& o : trace.epoch.observations.signals)
                if (o.satellite == sky.id && o.signal == first_signal(sky.id.constellation) && o.pseudorange) {
                    expect_cell(row, "pseudorange_m", o.pseudorange->value(), 6e-5);
                    told += sky.id.constellation == Constellation::beidou ? 1 : 0;
                }
            for (const SignalTerms& terms : trace.measurement.signals)
                if (terms.satellite == sky.id && terms.signal == first_signal(sky.id.constellation))
                    expect_cell(row, "code_noise_m", terms.code_noise.value(), 6e-5);
        }
    EXPECT_GT(told, 10U);
}

TEST_F(ModernRecording, FixesTellTheClockAsSolvedAndAsItWas) {
    const auto traces = run(text(receiver_of_four));
    const auto rows = rows_of(recorded("fixes.csv"));
    ASSERT_EQ(rows.size(), traces.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const Fix& fix = traces[k].epoch.fix;
        ASSERT_TRUE(fix.has_position()) << "a hot start has a fix at its first epoch";
        expect_cell(rows[k], "s_acc_mps", fix.speed_accuracy.value(), 6e-4);
        expect_cell(rows[k], "t_acc_m", fix.time_accuracy.value(), 6e-4);
        expect_cell(rows[k], "clock_bias_m", fix.clock_bias.value(), 6e-5);
        expect_cell(rows[k], "true_clock_bias_m", traces[k].measurement.clock_bias.value(), 6e-5);
        EXPECT_NEAR(fix.clock_bias.value(), traces[k].measurement.clock_bias.value(), 30);
    }
}

}  // namespace
}  // namespace skyloop
