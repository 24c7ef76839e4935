#include "base/time/knotted_process.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace skyloop {
namespace {

using std::chrono::seconds;

const GpsTime knotted_start = to_gps_time(2361, 12345.0);

TEST(KnottedProcess, KeepsSigmaAndCorrelation) {
    double square = 0, lagged = 0;
    int count = 0;
    for (int run = 0; run < 200; ++run) {
        KnottedProcess process({2, Seconds(1800)}, seconds(60), RandomStream(5, "run " + std::to_string(run)));
        std::vector<double> values;
        for (int i = 0; i < 600; ++i)
            values.push_back(process.at(knotted_start + seconds(300) * i));
        for (std::size_t i = 0; i + 6 < values.size(); ++i, ++count) {
            square += values[i] * values[i];
            lagged += values[i] * values[i + 6];
        }
    }
    EXPECT_NEAR(std::sqrt(square / count), 2, 0.1);
    EXPECT_NEAR(lagged / square, std::exp(-1), 0.05);
}

TEST(KnottedProcess, KeepsShortCorrelationTimesToo) {
    for (const double memory : {0.1, 1., 10.}) {
        double square = 0, lagged = 0;
        int count = 0;
        for (int run = 0; run < 20; ++run) {
            KnottedProcess process({2, Seconds(memory)}, seconds(60), RandomStream(6, "run " + std::to_string(run)));
            double before = 0;
            for (int i = 0; i < 4000; ++i, ++count) {
                const double value = process.at(advanced(knotted_start, Seconds(memory * i)));
                square += value * value;
                lagged += value * before;
                before = value;
            }
        }
        EXPECT_NEAR(std::sqrt(square / count), 2, 0.06) << memory;
        EXPECT_NEAR(lagged / square, std::exp(-1), 0.03) << memory;
    }
}

TEST(KnottedProcess, DoesNotDependOnHowOftenItIsLookedAt) {
    KnottedProcess often({1, Seconds(600)}, seconds(30), RandomStream(1, "x"));
    KnottedProcess seldom({1, Seconds(600)}, seconds(30), RandomStream(1, "x"));
    for (int i = 0; i < 4000; ++i) {
        const double value = often.at(knotted_start + std::chrono::milliseconds(100) * i);
        if (i % 100 != 0) continue;
        EXPECT_EQ(seldom.at(knotted_start + std::chrono::milliseconds(100) * i), value);
    }
}

TEST(KnottedProcess, IsAFunctionOfTheTimeToTheBit) {
    for (const double memory : {0.0, 60.0, 600.0, 7200.0, 1e7}) {
        KnottedProcess often({1, Seconds(memory)}, seconds(60), RandomStream(1, "x"));
        for (int i = 0; i < 600; ++i) {
            const GpsTime then = knotted_start + seconds(47) * i;
            const double value = often.at(then);
            if (i % 7 != 0) continue;
            KnottedProcess late({1, Seconds(memory)}, seconds(60), RandomStream(1, "x"));
            EXPECT_EQ(late.at(then), value) << memory << " s, look " << i;
            EXPECT_EQ(late.rate(), often.rate());
        }
    }
}

TEST(KnottedProcess, IsThereBeforeTheEpochOfItsTime) {
    KnottedProcess early({1, Seconds(60)}, seconds(6), RandomStream(1, "x"));
    KnottedProcess late({1, Seconds(60)}, seconds(6), RandomStream(1, "x"));
    early.at(GpsTime(seconds(-100)));
    EXPECT_EQ(early.at(GpsTime(seconds(100))), late.at(GpsTime(seconds(100))));
}

TEST(KnottedProcess, ForgetsItselfAtTheRateThatItIsTold) {
    KnottedProcess process({1, Seconds(600)}, seconds(1), RandomStream(3, "x"));
    process.set_correlation_time(Seconds(5));
    double square = 0, lagged = 0, before = process.at(knotted_start);
    for (int i = 1; i < 20'000; ++i) {
        const double value = process.at(knotted_start + seconds(5) * i);
        square += value * value;
        lagged += value * before;
        before = value;
    }
    EXPECT_NEAR(square / 20'000, 1, 0.05);
    EXPECT_NEAR(lagged / square, std::exp(-1), 0.03);
}

TEST(KnottedProcess, IsSmoothAndKnowsItsRate) {
    KnottedProcess process({1, Seconds(600)}, seconds(30), RandomStream(2, "x"));
    double before = process.at(knotted_start), rate_before = process.rate();
    for (int i = 1; i < 3000; ++i) {
        const double value = process.at(knotted_start + std::chrono::milliseconds(100) * i);
        EXPECT_NEAR((value - before) / 0.1, (process.rate() + rate_before) / 2, 1e-5);
        EXPECT_NEAR(process.rate(), rate_before, 0.004);
        before = value;
        rate_before = process.rate();
    }
}

TEST(KnottedProcess, ForgetsOverALongAbsence) {
    double product = 0, square = 0;
    for (int run = 0; run < 2000; ++run) {
        KnottedProcess process({1, Seconds(600)}, seconds(60), RandomStream(7, "run " + std::to_string(run)));
        const double first = process.at(knotted_start);
        const double last = process.at(knotted_start + seconds(36000));
        product += first * last;
        square += last * last;
    }
    EXPECT_NEAR(product / 2000, 0, 0.1);
    EXPECT_NEAR(std::sqrt(square / 2000), 1, 0.06);
}

}  // namespace
}  // namespace skyloop
