// The channel of surroundings against its source: shares and changes of states (ITU-R P.681-11), fading against the
// closed forms of Rice and Clarke, and what satellites and antennas share.
#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "property/statistics.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/state_channel.hpp"

namespace {

using namespace skyloop;

constexpr SatelliteId walked_satellite{Constellation::gps, 7};
constexpr double l1_wavelength = speed_of_light / carrier_frequency_l1;

ChannelParameters surrounded_by(P681Environment environment) {
    ChannelParameters parameters;
    parameters.environment = environment;
    return parameters;
}

SkyDirection sky_direction(double azimuth_deg, double elevation_deg) {
    return {Angle::degrees(azimuth_deg), Angle::degrees(elevation_deg)};
}

ChannelPlace place_at(double east_m, double north_m = 0, double seconds = 0) {
    ChannelPlace place;
    place.east_north = {east_m, north_m};
    place.time = GpsTime(std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(seconds)));
    return place;
}

struct WalkedStates {
    double bad_share = 0, changes_per_metre = 0;
    std::vector<double> bad_ways, good_ways;  // m
};

// Along straight lines far from each other, each under dice of its own.
WalkedStates walk_through(P681Environment environment, double elevation_deg) {
    constexpr int lines = 24;
    constexpr double step = 0.5, length = 3000;
    WalkedStates result;
    double bad_metres = 0, changes = 0;
    for (int line = 0; line < lines; ++line) {
        StateChannel channel(surrounded_by(environment), 1000 + static_cast<std::uint64_t>(line));
        bool before = false;
        double since = -1;
        for (double way = 0; way < length; way += step) {
            const bool bad = channel.at(walked_satellite, sky_direction(15.0 * line, elevation_deg), place_at(way)).bad;
            bad_metres += bad ? step : 0;
            if (way > 0 && bad != before) {
                if (since >= 0) (before ? result.bad_ways : result.good_ways).push_back(way - since);
                since = way;
                changes += bad ? 1 : 0;
            }
            before = bad;
        }
    }
    result.bad_share = bad_metres / (lines * length);
    result.changes_per_metre = changes / (lines * length);
    return result;
}

struct WalkedCase {
    const char* name;
    P681Environment environment;
    double elevation_deg, bad_share;  // of the published table, worked out apart
};

class WalkedStateTest : public testing::TestWithParam<WalkedCase> {};

// P(bad) and the mean way from one change to the next are those of the table's log-normal durations.
TEST_P(WalkedStateTest, HasSharesAndChangesOfTheTable) {
    const WalkedCase& c = GetParam();
    const WalkedStates walked = walk_through(c.environment, c.elevation_deg);
    EXPECT_NEAR(walked.bad_share, c.bad_share, 0.05);
    for (const P681Row& row : p681_rows(c.environment)) {
        if (row.elevation_deg != c.elevation_deg) continue;
        const double cycle = row.good.mean_duration_m() + row.bad.mean_duration_m();
        EXPECT_NEAR(walked.changes_per_metre * cycle, 1, 0.15);
    }
    // The table's σ of ln m is 0.8 to 1.7.
    for (const auto& ways : {walked.bad_ways, walked.good_ways}) {
        std::vector<double> logarithms;
        for (const double way : ways)
            logarithms.push_back(std::log(way));
        const double centre = test::mean(logarithms);
        for (double& value : logarithms)
            value -= centre;
        EXPECT_GT(test::rms(logarithms), 0.6);
        EXPECT_LT(test::rms(logarithms), 1.8);
    }
}

INSTANTIATE_TEST_SUITE_P(Table, WalkedStateTest,
                         testing::Values(WalkedCase{"urban20", P681Environment::urban, 20, 0.77},
                                         WalkedCase{"urban30", P681Environment::urban, 30, 0.53},
                                         WalkedCase{"suburban20", P681Environment::suburban, 20, 0.55},
                                         WalkedCase{"village30", P681Environment::village, 30, 0.28},
                                         WalkedCase{"wooded30", P681Environment::wooded, 30, 0.42},
                                         WalkedCase{"wooded60", P681Environment::wooded, 60, 0.25},
                                         WalkedCase{"residential20", P681Environment::residential, 20, 0.11}),
                         [](const auto& walked) { return std::string(walked.param.name); });

struct RiceCase {
    double rice_factor, level_db;            // K; of the amplitude over its rms
    double crossings_per_metre, fade_share;  // worked out apart
};

// Amplitudes over their rms along short ways of many satellites in the open, with so strong a direct ray.
struct FadeStatistics {
    double crossings_per_metre = 0, fade_share = 0;
};

FadeStatistics fades_of(const RiceCase& c) {
    ChannelParameters parameters = surrounded_by(P681Environment::suburban);
    parameters.averaging = Seconds(0);
    StateChannel channel(parameters, 5);
    const double level = std::pow(10, c.level_db / 20), step = 0.004, length = 12;
    double crossings = 0, below = 0, samples = 0;
    for (int satellite = 1; satellite <= 63; ++satellite) {
        double before = 0;
        for (double way = 0; way < length; way += step) {
            const double turn = 0.1 * satellite;
            const ChannelSample sample = channel.at({Constellation::gps, satellite}, sky_direction(0, 60),
                                                    place_at(way * std::cos(turn), way * std::sin(turn)));
            std::complex<double> scattered;
            double power = 0;
            for (const ChannelEcho& echo : sample.echoes) {
                scattered += echo.gain;
                power += echo.power;
            }
            const double amplitude =
                std::abs(std::sqrt(c.rice_factor) + scattered / std::sqrt(power)) / std::sqrt(c.rice_factor + 1);
            if (way > 0 && before >= level && amplitude < level) ++crossings;
            below += amplitude < level ? 1 : 0;
            before = amplitude;
            ++samples;
        }
    }
    return {crossings / (samples * step), below / samples};
}

// Rice 1945: N/fd = √(2π(K+1)) r exp(−K − (K+1) r²) I0(2r √(K(K+1))), with fd = 1/λ per metre.
TEST(StateChannelFading, CrossesLevelsAsRicesFormulaHasIt) {
    for (const RiceCase& c : {RiceCase{0, -5, 5.40, 0.271}, RiceCase{0, -10, 3.77, 0.095},
                              RiceCase{std::pow(10, 0.5), -5, 2.08, 0.125}, RiceCase{10, -5, 0.536, 0.0238}}) {
        const double k = c.rice_factor, r = std::pow(10, c.level_db / 20);
        const double formula = std::sqrt(2 * std::numbers::pi * (k + 1)) * r * std::exp(-k - (k + 1) * r * r) *
                               std::cyl_bessel_i(0, 2 * r * std::sqrt(k * (k + 1))) / l1_wavelength;
        EXPECT_NEAR(formula / c.crossings_per_metre, 1, 0.02);
        const FadeStatistics fades = fades_of(c);
        EXPECT_NEAR(fades.crossings_per_metre / c.crossings_per_metre, 1, 0.12) << "K " << k << " " << c.level_db;
        EXPECT_NEAR(fades.fade_share / c.fade_share, 1, 0.12) << "K " << k << " " << c.level_db;
        // Average fade duration.
        EXPECT_NEAR(fades.fade_share / fades.crossings_per_metre / (c.fade_share / c.crossings_per_metre), 1, 0.12);
    }
}

// P(amplitude < r) of a direct ray of a constant amplitude with scattered rays of so much mean power (Rice 1945).
double rice_distribution(double r, double direct, double diffuse_power) {
    const boost::math::non_central_chi_squared square(2, 2 * direct * direct / diffuse_power);
    return boost::math::cdf(square, 2 * r * r / diffuse_power);
}

// P(amplitude < r) where the direct ray's decibels are normal (Loo 1985, equation 1).
double loo_distribution(double r, double mean_db, double deviation_db, double diffuse_db) {
    constexpr int pieces = 60;
    constexpr double farthest = 4, step = 2 * farthest / pieces;
    double sum = 0, weights = 0;
    for (int i = 0; i <= pieces; ++i) {
        const double x = -farthest + step * i, weight = std::exp(-x * x / 2);
        sum += weight *
               rice_distribution(r, std::pow(10, (mean_db + deviation_db * x) / 20), std::pow(10, diffuse_db / 10));
        weights += weight;
    }
    return sum / weights;
}

struct LooCase {
    const char* name;
    P681Environment environment;
    bool bad;
};

class LooTest : public testing::TestWithParam<LooCase> {};

// Away from changes Σ_A and MP follow M_A as the table has it (P.681-11, equations 20 and 21); then amplitudes at
// places far from each other lie as often below each quantile of Loo's distribution as its name says.
TEST_P(LooTest, HoldsWithinAState) {
    const LooCase& c = GetParam();
    constexpr double elevation_deg = 45;
    P681State state{};
    for (const P681Row& row : p681_rows(c.environment))
        if (row.elevation_deg == elevation_deg) state = c.bad ? row.bad : row.good;
    ASSERT_GT(state.shortest_m, 0);
    ChannelParameters parameters = surrounded_by(c.environment);
    parameters.averaging = Seconds(0);
    constexpr std::array quantiles{0.1, 0.25, 0.5, 0.75, 0.9};
    std::array<double, quantiles.size()> below{};
    double samples = 0;
    for (int line = 0; line < 60; ++line) {
        StateChannel channel(parameters, 500 + static_cast<std::uint64_t>(line));
        for (double way = 0; way < 6000; way += 60) {
            const auto sample = channel.at(walked_satellite, sky_direction(6.0 * line, elevation_deg), place_at(way));
            const double mean = (sample.direct - sample.shadowing).value();
            const double diffuse = state.diffuse_slope * mean + state.diffuse_db;
            if (sample.bad != c.bad || std::abs(sample.diffuse.value() - diffuse) > 1e-9) continue;  // on a ramp
            std::complex<double> sum = std::pow(10, sample.direct.value() / 20);
            for (const ChannelEcho& echo : sample.echoes)
                sum += echo.gain;
            const double deviation = std::max(state.shadowing_slope * mean + state.shadowing_db, 0.0);
            const double place = loo_distribution(std::abs(sum), mean, deviation, diffuse);
            for (std::size_t i = 0; i < quantiles.size(); ++i)
                below[i] += place < quantiles[i] ? 1 : 0;
            ++samples;
        }
    }
    EXPECT_GT(samples, 500);
    for (std::size_t i = 0; i < quantiles.size(); ++i)
        EXPECT_NEAR(below[i] / samples, quantiles[i], 0.04) << samples;
}

INSTANTIATE_TEST_SUITE_P(States, LooTest,
                         testing::Values(LooCase{"wooded_good", P681Environment::wooded, false},
                                         LooCase{"wooded_bad", P681Environment::wooded, true},
                                         LooCase{"urban_good", P681Environment::urban, false},
                                         LooCase{"urban_bad", P681Environment::urban, true}),
                         [](const auto& loo) { return std::string(loo.param.name); });

// Of two antennas d apart the scattered rays correlate as J0(2πd/λ) (Clarke 1968).
TEST(StateChannelFading, CorrelatesOverTwoAntennasAsBesselsFunction) {
    ChannelParameters parameters = surrounded_by(P681Environment::suburban);
    parameters.averaging = Seconds(0);
    StateChannel channel(parameters, 5);
    for (const double apart : {0.1 * l1_wavelength, 0.25 * l1_wavelength, 0.38 * l1_wavelength, 0.20}) {
        double products = 0, powers = 0;
        for (int satellite = 1; satellite <= 63; ++satellite)
            for (int i = 0; i < 60; ++i) {
                const double x = 1.7 * i;
                const auto one = channel.at({Constellation::gps, satellite}, sky_direction(0, 60), place_at(x));
                const auto other =
                    channel.at({Constellation::gps, satellite}, sky_direction(0, 60), place_at(x, apart));
                const auto a = one.echoes[0].gain / std::sqrt(one.echoes[0].power);
                const auto b = other.echoes[0].gain / std::sqrt(other.echoes[0].power);
                products += (a * std::conj(b)).real();
                powers += std::norm(a);
            }
        EXPECT_NEAR(products / powers, std::cyl_bessel_j(0, 2 * std::numbers::pi * apart / l1_wavelength), 0.08)
            << apart;
    }
}

// Obstacles are seen together by satellites near to each other, and by antennas of one vehicle.
struct SharedObstacles {
    double state_correlation = 0, level_correlation = 0;
};

SharedObstacles shared_by(double azimuth_apart_deg, double metres_apart) {
    std::vector<double> one_bad, other_bad, one_level, other_level;
    for (int line = 0; line < 30; ++line) {
        StateChannel channel(surrounded_by(P681Environment::wooded), 70 + static_cast<std::uint64_t>(line));
        for (double way = 0; way < 2000; way += 4) {
            const double azimuth = 12.0 * line;
            const auto one = channel.at(walked_satellite, sky_direction(azimuth, 30), place_at(way));
            const auto other = channel.at({Constellation::gps, 8}, sky_direction(azimuth + azimuth_apart_deg, 30),
                                          place_at(way, metres_apart));
            one_bad.push_back(one.bad);
            other_bad.push_back(other.bad);
            one_level.push_back(one.direct.value());
            other_level.push_back(other.direct.value());
        }
    }
    const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
        const double am = test::mean(a), bm = test::mean(b);
        double ab = 0, aa = 0, bb = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            ab += (a[i] - am) * (b[i] - bm);
            aa += (a[i] - am) * (a[i] - am);
            bb += (b[i] - bm) * (b[i] - bm);
        }
        return ab / std::sqrt(aa * bb);
    };
    return {correlation(one_bad, other_bad), correlation(one_level, other_level)};
}

TEST(StateChannelCorrelation, FallsWithTheAzimuthAndIsGoneAtThirtyDegrees) {
    EXPECT_GT(shared_by(3, 0).state_correlation, 0.8);
    const double at_fifteen = shared_by(15, 0).state_correlation;
    EXPECT_GT(at_fifteen, 0.15);
    EXPECT_LT(at_fifteen, 0.6);
    EXPECT_LT(std::abs(shared_by(45, 0).state_correlation), 0.08);
}

TEST(StateChannelCorrelation, IsHighForAntennasOfOneVehicle) {
    EXPECT_GT(shared_by(0, 0.2).level_correlation, 0.97);
    const double two_metres = shared_by(0, 2).level_correlation;
    EXPECT_GT(two_metres, 0.6);
    EXPECT_LT(two_metres, 0.97);
    EXPECT_LT(std::abs(shared_by(0, 500).level_correlation), 0.08);
}

// Log-normal with the table's Σ_A about M_A, and a correlation of 1/e at L_corr.
TEST(StateChannelShadowing, HasTheCorrelationLengthOfTheTable) {
    double length = 0;
    for (const P681Row& row : p681_rows(P681Environment::wooded))
        length += row.correlation_m / static_cast<double>(p681_rows(P681Environment::wooded).size());
    double same = 0, apart = 0, far = 0;
    for (int line = 0; line < 40; ++line) {
        StateChannel channel(surrounded_by(P681Environment::wooded), 300 + static_cast<std::uint64_t>(line));
        const auto at = [&](double way) {
            return channel.at(walked_satellite, sky_direction(9.0 * line, 40), place_at(way)).shadowing.value();
        };
        for (double way = 0; way < 1000; way += 2.3) {
            const double here = at(way);
            same += here * here;
            apart += here * at(way + length);
            far += here * at(way + 4 * length);
        }
    }
    EXPECT_NEAR(apart / same, std::exp(-1), 0.06);
    EXPECT_NEAR(far / same, 0, 0.06);
    EXPECT_GT(same, 0);
}

// At rest nothing is drawn anew: seconds change little, minutes much.
TEST(StateChannelAtRest, ChangesOverMinutes) {
    StateChannel channel(surrounded_by(P681Environment::wooded), 11);
    std::vector<double> level, second_later, minutes_later;
    for (int satellite = 0; satellite < 24; ++satellite)
        for (double t = 0; t < 7200; t += 30) {
            const auto at = [&](double time) {
                return channel
                    .at(walked_satellite, sky_direction(15.0 * satellite, 35), place_at(satellite * 500.0, 0, time))
                    .direct.value();
            };
            level.push_back(at(t));
            second_later.push_back(at(t + 1));
            minutes_later.push_back(at(t + 300));
        }
    const auto change = [&](const std::vector<double>& other) {
        std::vector<double> differences;
        for (std::size_t i = 0; i < level.size(); ++i)
            differences.push_back(other[i] - level[i]);
        return test::rms(differences);
    };
    EXPECT_LT(change(second_later), 0.1);  // dB
    EXPECT_GT(change(second_later), 0.001);
    EXPECT_GT(change(minutes_later), 1.5);
}

// What is asked for in between, or of others, changes nothing.
TEST(StateChannelOrder, DoesNotMatter) {
    const ChannelParameters parameters = surrounded_by(P681Environment::urban);
    StateChannel often(parameters, 3), rarely(parameters, 3);
    for (int second = 0; second < 20; ++second) {
        for (int tenth = 1; tenth < 10; ++tenth)
            for (int satellite = 1; satellite < 9; ++satellite)
                static_cast<void>(often.at({Constellation::gps, satellite}, sky_direction(40.0 * satellite, 25),
                                           place_at(10 * second + tenth, 0, second + 0.1 * tenth)));
        const ChannelPlace place = place_at(10 * second, 0, second);
        const ChannelSample a = often.at(walked_satellite, sky_direction(200, 40), place);
        const ChannelSample b = rarely.at(walked_satellite, sky_direction(200, 40), place);
        EXPECT_EQ(a.direct, b.direct);
        for (std::size_t i = 0; i < a.echoes.size(); ++i) {
            EXPECT_EQ(a.echoes[i].gain, b.echoes[i].gain);
            EXPECT_EQ(a.echoes[i].excess, b.echoes[i].excess);
        }
    }
}

TEST(P681Table, HasTheSharesThatFollowFromItsDurations) {
    struct Shares {
        P681Environment environment;
        std::vector<double> bad;
    };
    const Shares all[] = {{P681Environment::urban, {.77, .53, .27, .09, .01}},
                          {P681Environment::suburban, {.55, .20, .03, .07, .01}},
                          {P681Environment::village, {.44, .28, .12, .10, .03}},
                          {P681Environment::wooded, {.51, .42, .28, .25, .06}},
                          {P681Environment::residential, {.11, .10, .50, .35}}};
    for (const Shares& one : all) {
        const auto rows = p681_rows(one.environment);
        ASSERT_EQ(rows.size(), one.bad.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            EXPECT_NEAR(rows[i].bad_share(), one.bad[i], 0.0075);
    }
}

}  // namespace
