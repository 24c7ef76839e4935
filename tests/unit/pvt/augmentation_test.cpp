// Corrections that SBAS satellites send: when they are at hand, and what they do.
#include "receiver/pvt/augmentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "plain_navigation.hpp"
#include "sbas_sender.hpp"
#include "world/gnss/sbas_service.hpp"

namespace skyloop {
namespace {

using test::error_of;
using test::later;
using test::plain;
using test::receiver_at;
using test::sample_time;
using test::SbasSender;
using test::SyntheticSky;
using test::TrueReceiver;

const Geodetic in_europe = test::antenna, in_america = Geodetic::degrees(-23.5, -46.6, 800);
constexpr double vertical_m = 2;

// GPS behind errors of 3 to 9 m, orbits and clocks that are off, and an ionosphere of 2 m; the sender tells all of it.
struct AugmentedRun {
    explicit AugmentedRun(const Geodetic& place)
        : receiver(receiver_at(place, sample_time)), engine(plain(FilterKind::none), {&sky}) {
        for (const SatelliteId id : sky.satellites())
            sender.told[id.number] = {3.0 + id.number % 7, 0, {1.5, -2.25, 0.125 * id.number}, 0x1p-31 * id.number};
        settings.sbas_ranging = false;
    }
    void hear(const std::vector<Subframe>& messages) { engine.hear(messages, settings); }
    void hear_everything(double second) { hear(sender.everything(advanced(sample_time, Seconds(second)))); }

    Fix at(double second) {
        const TrueReceiver now = later(receiver, second);
        const LocalFrame frame(to_geodetic(Position<Ecef>(now.position)));
        const auto delay = [&](SatelliteId id, const SkyDirection& d, Hertz) {
            const double flat = std::cos(d.elevation.rad());
            const Displacement<Enu> line(flat * std::sin(d.azimuth.rad()), flat * std::cos(d.azimuth.rad()),
                                         std::sin(d.elevation.rad()));
            const auto& told = sender.told.at(id.number);
            const Eigen::Vector3d orbit(told.orbit_m[0], told.orbit_m[1], told.orbit_m[2]);
            return errors.at(id.number) + frame.to_ecef(line).vector().dot(orbit) - speed_of_light * told.clock_s +
                   vertical_m * single_layer_mapping(sbas_shell, d.elevation);
        };
        if (errors.empty())
            for (const auto& [prn, told] : sender.told)
                errors[prn] = told.range_m;
        const Fix fix = engine.solve(test::measure(truth, now, {}, delay), settings);
        error = error_of(fix, now);
        return fix;
    }

    SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps});
    SyntheticSky truth = sky;
    SbasSender sender;
    std::map<int, double> errors;
    TrueReceiver receiver;
    NavigationEngine engine;
    ReceiverSettings settings;
    double error = 0;
};

TEST(Augmentation, TakesTheErrorsOffOnceAllOfItHasBeenHeard) {
    AugmentedRun run(in_europe);
    EXPECT_EQ(run.at(0).type, FixType::fix_3d);
    const double before = run.error;
    EXPECT_GT(before, 1);
    run.hear_everything(1);
    const Fix fix = run.at(1);
    EXPECT_EQ(fix.type, FixType::dgnss);
    EXPECT_EQ(fix.sbas_source, (SatelliteId{Constellation::sbas, 36}));
    EXPECT_LT(run.error, 0.01);
    for (const SatelliteStatus& s : fix.satellites) {
        if (!s.used) continue;
        ASSERT_TRUE(s.sbas);
        EXPECT_EQ(s.sbas->udre_index, 3);
        EXPECT_EQ(s.sbas->range_correction.value(), -(3.0 + s.id.number % 7));
        EXPECT_NEAR(s.sbas->ionosphere.value(), vertical_m * single_layer_mapping(sbas_shell, s.elevation), 0.01);
    }
}

TEST(Augmentation, NeedsEveryPartInWhateverOrder) {
    for (const int missing : {1, 2, 18, 25, 26}) {
        AugmentedRun run(in_europe);
        run.at(0);
        std::vector<Subframe> parts = run.sender.everything(advanced(sample_time, Seconds(1)));
        std::vector<Subframe> late;
        for (const Subframe& s : parts) {
            const int type = sbas_message_type(*decode_sbas(s.words));
            if (type == missing || (missing == 2 && type == 3)) late.push_back(s);
        }
        std::erase_if(parts, [&](const Subframe& s) {
            return std::ranges::any_of(late, [&](const Subframe& l) { return l.words == s.words; });
        });
        std::ranges::reverse(parts);
        run.hear(parts);
        EXPECT_EQ(run.at(1).type, FixType::fix_3d) << "without " << missing;
        run.hear(late);
        EXPECT_EQ(run.at(2).type, FixType::dgnss) << missing;
        EXPECT_LT(run.error, 0.01);
    }
}

TEST(Augmentation, TimesOut) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    EXPECT_EQ(run.at(17).type, FixType::dgnss);
    EXPECT_EQ(run.at(19).type, FixType::fix_3d) << "no bound is older than 18 s";
    const SbasSender& sender = run.sender;
    for (double second = 20; second <= 380; second += 10) {
        SbasIntegrity bounds;
        bounds.iodf.fill(3);
        bounds.udrei.fill(4);
        run.hear({sender.sent(bounds, advanced(sample_time, Seconds(second)))});
        EXPECT_EQ(run.at(second).type, second <= 180 ? FixType::dgnss : FixType::fix_3d) << "fast ones last for 180 s";
    }
    for (const auto& m : sender.fast())
        run.hear({sender.sent(m, advanced(sample_time, Seconds(390)))});
    EXPECT_EQ(run.at(390).type, FixType::fix_3d) << "slow ones for 360 s";
}

TEST(Augmentation, AgesAsMessageSevenSays) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    SbasFastDegradation ageing{4, 1, {}};
    ageing.indicators.fill(15);
    SbasIntegrity bounds;
    bounds.iodf.fill(3);
    bounds.udrei.fill(4);
    run.hear({run.sender.sent(ageing, advanced(sample_time, Seconds(2))),
              run.sender.sent(bounds, advanced(sample_time, Seconds(12)))});
    EXPECT_EQ(run.at(18).type, FixType::dgnss);
    EXPECT_EQ(run.at(20).type, FixType::fix_3d) << "18 s with indicator 15";
}

TEST(Augmentation, LeavesOutSatellitesThatAreNotToBeUsed) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    SbasIntegrity bounds;
    bounds.iodf = {0, 0, 3, 3};
    for (std::size_t i = 0; i < bounds.udrei.size(); ++i)
        bounds.udrei[i] = i % 6 == 0 ? udrei_do_not_use : 0;
    run.hear({run.sender.sent(bounds, advanced(sample_time, Seconds(2)))});
    for (const SatelliteStatus& s : run.at(2).satellites)
        if (s.used) {
            EXPECT_EQ(s.sbas.has_value(), s.id.number % 6 != 1) << s.id.number;
        }
    bounds.iodf = {2, 2, 3, 3};  // of corrections that were not heard
    bounds.udrei.fill(udrei_not_monitored);
    run.hear({run.sender.sent(bounds, advanced(sample_time, Seconds(3)))});
    EXPECT_TRUE(std::ranges::any_of(run.at(3).satellites, [](const auto& s) { return s.sbas.has_value(); }));
}

TEST(Augmentation, ServesWhereItsGridReachesAndWhereItIsWanted) {
    AugmentedRun unwanted(in_europe), far(in_america);
    unwanted.settings.sbas_corrections = false;
    for (AugmentedRun* run : {&unwanted, &far}) {
        run->at(0);
        run->hear_everything(1);
        const Fix fix = run->at(1);
        EXPECT_EQ(fix.type, FixType::fix_3d);
        EXPECT_FALSE(fix.sbas_source);
    }
}

TEST(Augmentation, CorrectsTheRecordThatIsMeant) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    run.at(1);
    // All satellites send other records, which are metres off; the corrections are still of the ones before.
    for (Ephemeris& r : run.sky.records()) {
        auto& record = std::get<KeplerEphemeris>(r);
        record.iode = 9;
        record.m0 += 2e-7;
        record.af0 += 1e-8 * (record.satellite.number % 3);
    }
    const Fix fix = run.at(2);
    EXPECT_EQ(fix.type, FixType::dgnss);
    EXPECT_LT(run.error, 0.02);
    for (auto& [prn, told] : run.sender.told)
        told.iode = 7;
    for (const auto& m : run.sender.slow())
        run.hear({run.sender.sent(m, advanced(sample_time, Seconds(3)))});
    EXPECT_EQ(run.at(3).type, FixType::fix_3d) << "a record that nobody has heard";
}

TEST(Augmentation, ForgetsASatelliteThatSaysNotToUseIt) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    run.hear({run.sender.sent(SbasDoNotUse{}, advanced(sample_time, Seconds(2)))});
    EXPECT_EQ(run.at(2).type, FixType::fix_3d);
    run.hear_everything(30);
    EXPECT_EQ(run.at(30).type, FixType::fix_3d) << "for a minute";
    run.hear_everything(63);
    EXPECT_EQ(run.at(63).type, FixType::dgnss);
}

TEST(Augmentation, TakesTestsWhereItsUserWantsThem) {
    for (const bool test_mode : {false, true}) {
        AugmentedRun run(in_europe);
        run.settings.sbas_test_mode = test_mode;
        run.at(0);
        std::vector<Subframe> messages = run.sender.everything(advanced(sample_time, Seconds(1)));
        for (Subframe& s : messages) {
            const auto message = *decode_sbas(s.words);
            const auto* fast = std::get_if<SbasFastCorrections>(&message);
            if (fast != nullptr && fast->block == 0) s = run.sender.sent(SbasDoNotUse{*fast}, s.end);
        }
        run.hear(messages);
        EXPECT_EQ(run.at(1).type, test_mode ? FixType::dgnss : FixType::fix_3d);
    }
}

TEST(Augmentation, StaysWithASatelliteAsLongAsItServes) {
    AugmentedRun run(in_europe);
    run.at(0);
    SbasSender other = run.sender;
    other.satellite.number = 23;
    run.hear_everything(1);
    EXPECT_EQ(run.at(1).sbas_source, run.sender.satellite);
    run.hear(other.everything(advanced(sample_time, Seconds(2))));
    EXPECT_EQ(run.at(2).sbas_source, run.sender.satellite);
    EXPECT_EQ(run.at(17.5).sbas_source, run.sender.satellite);
    EXPECT_EQ(run.at(18.5).sbas_source, other.satellite);
    EXPECT_FALSE(run.at(30).sbas_source);
}

TEST(Augmentation, BeginsAnewWithTheReceiver) {
    AugmentedRun run(in_europe);
    run.at(0);
    run.hear_everything(1);
    EXPECT_EQ(run.at(1).type, FixType::dgnss);
    ++run.settings.restarts;
    EXPECT_EQ(run.at(2).type, FixType::fix_3d);
}

// The plane through three points on their side of the diagonal, and nothing beyond it.
TEST(SbasData, TakesThreePointsOfASquare) {
    const GpsTime now = sample_time;
    const auto linear = [](double latitude, double longitude) {
        return 4 + 0.25 * (latitude - 45) + 0.5 * (longitude - 30);
    };
    for (const SbasGridPoint missing : {SbasGridPoint{50, 35}, {50, 30}, {45, 30}, {45, 35}}) {
        SbasSender sender;
        sender.delay = [&](const SbasGridPoint& p) {
            return p == missing ? std::nullopt : std::optional(std::clamp(linear(p.latitude, p.longitude), 0.0, 60.0));
        };
        SbasData data;
        for (const Subframe& s : sender.everything(now))
            data.hear(s, false);
        const SkyDirection zenith{Angle(), Angle::degrees(90)};
        for (const double latitude : {46.0, 47.0, 48.0, 49.0})
            for (const double longitude : {31.0, 32.0, 33.0, 34.0}) {
                const bool north = missing.latitude == 50, east = missing.longitude == 35;
                const double x = (longitude - 30) / 5, y = (latitude - 45) / 5;
                const bool reached = (east ? x : 1 - x) + (north ? y : 1 - y) <= 1 + 1e-9;
                const auto delay = data.ionosphere(Geodetic::degrees(latitude, longitude, 0), zenith, now);
                if (std::abs((east ? x : 1 - x) + (north ? y : 1 - y) - 1) < 1e-6) continue;
                ASSERT_EQ(delay.has_value(), reached) << latitude << ' ' << longitude;
                if (delay) {
                    EXPECT_NEAR(delay->value(), linear(latitude, longitude), 1e-9);
                }
            }
    }
}

TEST(SbasService, KnowsWhoseASatelliteIsAndWhereItServes) {
    EXPECT_EQ(sbas_system(133), SbasSystem::waas);
    EXPECT_EQ(sbas_system(136), SbasSystem::egnos);
    EXPECT_FALSE(sbas_system(140));
    const auto serves = [](SbasSystem system, double latitude, double longitude) {
        return sbas_service_area(system).holds(Geodetic::degrees(latitude, longitude, 0));
    };
    EXPECT_TRUE(serves(SbasSystem::waas, 40, -105));
    EXPECT_FALSE(serves(SbasSystem::egnos, 40, -105));
    EXPECT_TRUE(serves(SbasSystem::msas, 36, 140));
    EXPECT_TRUE(serves(SbasSystem::gagan, 13, 77));
    EXPECT_TRUE(sbas_under_test(126));
    EXPECT_FALSE(sbas_under_test(136));
}

}  // namespace
}  // namespace skyloop
