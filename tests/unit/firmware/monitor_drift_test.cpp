// How monitors move without interference: as far as those in records do, by module and by seed.
#include "firmware/core/monitor_drift.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

BoardProfile module_of_serial(int last_byte, int generation = 9) {
    BoardProfile board;
    board.name = "module";
    board.identity.generation = generation;
    board.identity.unique_id = {1, 2, 3, 4, static_cast<std::uint8_t>(last_byte)};
    return board;
}

struct DriftSeries {
    std::vector<double> indicator, gain, noise;
    std::vector<int> counts;
};

DriftSeries drift_series(const BoardProfile& board, std::uint64_t seed, int seconds = 3600) {
    MonitorDrift drift(board, seed);
    DriftSeries series;
    for (int i = 0; i < seconds; ++i) {
        drift.advance(GpsTime{} + i * 1s);
        const QuietBand band = drift.upper();
        series.indicator.push_back(band.indicator);
        series.gain.push_back(band.gain);
        series.noise.push_back(band.noise);
        series.counts.push_back(drift.gain_count(band.gain));
    }
    return series;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

double spread_of(const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *most - *least;
}

double correlation_after_1s(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double product = 0, square = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        product += (values[i] - mean) * (values[i + 1] - mean);
        square += (values[i] - mean) * (values[i] - mean);
    }
    return product / square;
}

TEST(MonitorDrift, StaysWhereRecordsAre) {
    for (const int module : {1, 2, 3, 4, 5}) {
        const DriftSeries series = drift_series(module_of_serial(module), 7);
        EXPECT_GE(*std::min_element(series.indicator.begin(), series.indicator.end()), 0);
        EXPECT_LE(*std::max_element(series.indicator.begin(), series.indicator.end()), 30);
        EXPECT_LE(spread_of(series.noise), 10.001) << "5 either way";
        EXPECT_GT(spread_of(series.noise), 7) << "it moves";
        EXPECT_LE(spread_of(series.gain), 200.001) << "100 either way";
        EXPECT_GT(spread_of(series.gain), 140);
        EXPECT_THAT(series.noise, testing::Each(testing::AllOf(testing::Ge(60), testing::Le(114))));
        EXPECT_THAT(series.gain, testing::Each(testing::AllOf(testing::Ge(2300), testing::Le(5100))));
    }
}

TEST(MonitorDrift, GainsComeInTheStepsOfTheGeneration) {
    for (const auto& [generation, step] : {std::pair{7, 73}, {8, 78}, {9, 117}, {10, 117}}) {
        const DriftSeries series = drift_series(module_of_serial(1, generation), 7);
        std::set<int> counts(series.counts.begin(), series.counts.end());
        EXPECT_THAT(counts, testing::Each(testing::ResultOf([step = step](int count) { return count % step; }, 0)));
        EXPECT_GT(counts.size(), 1U);
    }
    const MonitorDrift drift(module_of_serial(1), 1);
    EXPECT_EQ(drift.gain_count(-5), 0);
    EXPECT_EQ(drift.gain_count(1e6), 8190);
    EXPECT_EQ(drift.gain_count(4900), 4914) << "of a ZED-F9R";
}

TEST(MonitorDrift, NoiseAndGainAreSlowAndTheIndicatorIsNot) {
    const DriftSeries series = drift_series(module_of_serial(1), 7);
    EXPECT_NEAR(correlation_after_1s(series.noise), std::exp(-1 / 15.0), 0.02);
    EXPECT_NEAR(correlation_after_1s(series.gain), std::exp(-1 / 30.0), 0.02);
    EXPECT_NEAR(correlation_after_1s(series.indicator), std::exp(-1 / 3.0), 0.05);
}

TEST(MonitorDrift, IsTheSameForASeedAndAnotherForOthers) {
    const BoardProfile board = module_of_serial(1);
    const DriftSeries first = drift_series(board, 7, 20);
    EXPECT_EQ(drift_series(board, 7, 20).noise, first.noise);
    EXPECT_NE(drift_series(board, 8, 20).noise, first.noise);
}

TEST(MonitorDrift, LevelsAreTheModules) {
    const auto level = [](const BoardProfile& board, std::uint64_t seed) {
        return mean_of(drift_series(board, seed, 20000).noise);
    };
    EXPECT_NEAR(level(module_of_serial(1), 7), level(module_of_serial(1), 8), 0.4) << "whatever the run";
    std::set<int> levels;
    for (const int module : {1, 2, 3, 4, 5, 6})
        levels.insert(static_cast<int>(level(module_of_serial(module), 7)));
    EXPECT_GE(levels.size(), 4U);
    BoardProfile nameless = module_of_serial(1), other = nameless;
    nameless.identity.unique_id.clear();
    other.identity.unique_id.clear();
    other.name = "another";
    EXPECT_GT(std::abs(level(nameless, 7) - level(other, 7)), 0.5) << "without a serial number by the name";
    nameless.usb.emplace().serial = other.usb.emplace().serial = "3047941";
    EXPECT_EQ(level(nameless, 7), level(other, 7)) << "of its USB port";
}

TEST(MonitorDrift, WarmsUp) {
    MonitorDrift drift(module_of_serial(1), 7);
    drift.advance(GpsTime{});
    EXPECT_NEAR(drift.temperature(Seconds(1e6)) - drift.temperature(Seconds(0)), 5, 1e-9);
    EXPECT_NEAR(drift.temperature(Seconds(1e6)), 28, 7);
}

TEST(MonitorDrift, TimeThatGoesBackChangesNothing) {
    MonitorDrift drift(module_of_serial(1), 7);
    drift.advance(GpsTime{} + 10s);
    const double noise = drift.upper().noise;
    const std::uint64_t dice = drift.dice();
    drift.advance(GpsTime{} + 5s);
    EXPECT_EQ(drift.upper().noise, noise);
    EXPECT_EQ(drift.dice(), dice);
}

}  // namespace
}  // namespace skyloop::firmware
