/// Orbits of four systems at any time, with eccentric orbits, wandering clocks and group delays: what a test needs that
/// must not depend on a file.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "world/gnss/constants.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {

/// Walker constellations of 24 (GPS, Galileo, BeiDou) and GLONASS as state vectors. Records are two hours apart, half
/// an hour for GLONASS; neighbouring records are the same orbit.
class FourSystems : public NavigationSource {
public:
    static constexpr int satellites_each = 24;

    explicit FourSystems(std::vector<Constellation> systems = {Constellation::gps, Constellation::galileo,
                                                               Constellation::beidou, Constellation::glonass})
        : systems_(std::move(systems)) {
        // Coefficients of an ordinary day (GPS 2004-01-01) and a medium Sun.
        ionosphere_.gps = KlobucharCoefficients{{0.1118e-7, -0.7451e-8, -0.5961e-7, 0.1192e-6},
                                                {0.1167e6, -0.2294e6, -0.1311e6, 0.1049e7}};
        ionosphere_.galileo = std::array{121.129893, 0.351254133, 0.0134635348};
    }
    [[nodiscard]] std::vector<SatelliteId> satellites() const override {
        std::vector<SatelliteId> all;
        for (const Constellation c : systems_)
            for (int n = 1; n <= satellites_each; ++n)
                // BeiDou's first numbers are geostationary.
                all.push_back({c, c == Constellation::beidou ? n + 10 : n});
        return all;
    }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId id, GpsTime time) const override {
        const bool glonass = id.constellation == Constellation::glonass;
        const Nanoseconds spacing = glonass ? std::chrono::minutes(30) : std::chrono::minutes(120);
        const GpsTime toe = toe_near(time, spacing);
        if (!glonass) return kepler(id, toe);
        return state_vector(id, toe);
    }
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return "four systems"; }

private:
    static GpsTime toe_near(GpsTime time, Nanoseconds spacing) {
        return GpsTime((time.time_since_epoch() + spacing / 2) / spacing * spacing);
    }
    static double radius_of(Constellation c) {
        if (c == Constellation::galileo) return 29600e3;
        if (c == Constellation::beidou) return 27906e3;
        if (c == Constellation::glonass) return 25510e3;
        return 26560e3;
    }
    static double gravity_of(Constellation c) {
        if (c == Constellation::galileo) return gravitational_constant_galileo;
        if (c == Constellation::beidou) return gravitational_constant_beidou;
        return gravitational_constant_gps;
    }

    static KeplerEphemeris kepler(SatelliteId id, GpsTime toe) {
        constexpr double turn = 2 * std::numbers::pi;
        const int n = id.constellation == Constellation::beidou ? id.number - 10 : id.number;
        const int plane = (n - 1) % 3, slot = (n - 1) / 3;
        const double system = static_cast<double>(static_cast<int>(id.constellation));
        const double since_epoch = std::chrono::duration<double>(toe.time_since_epoch()).count();
        KeplerEphemeris r;
        r.satellite = id;
        r.message = id.constellation == Constellation::galileo  ? NavigationMessage::inav
                    : id.constellation == Constellation::beidou ? NavigationMessage::d1
                                                                : NavigationMessage::lnav;
        r.toe = r.toc = toe;
        r.sqrt_a = std::sqrt(radius_of(id.constellation));
        r.e = 0.002 + 0.0005 * slot;
        r.i0 = 55.5 * std::numbers::pi / 180 + 0.05 * system;
        const double a = r.sqrt_a * r.sqrt_a;
        const double motion = std::sqrt(gravity_of(id.constellation) / (a * a * a));
        r.m0 = std::fmod(turn * (slot / 8.0 + plane / 24.0) + motion * since_epoch, turn);
        r.omega = 0.3 * plane;
        // omega0 counts from the start of the week of toe, in which the Earth has turned.
        const WeekAndTow at = week_and_tow(
            toe - (id.constellation == Constellation::beidou ? std::chrono::seconds(14) : std::chrono::seconds(0)));
        const double week_start = since_epoch - at.tow_seconds();
        r.omega0 = std::remainder(
            turn * plane / 3 + 0.4 * system - std::remainder(earth_rotation_rate * week_start, turn), turn);
        r.af0 = 1e-5 * (n - 12) + 1e-12 * std::fmod(since_epoch, 1e6);
        r.af1 = 1e-12;
        r.tgd = 2e-9 * (n % 5);
        r.tgd2 = 1e-9 * (n % 7);
        r.iode = r.iodc = static_cast<int>(static_cast<std::int64_t>(since_epoch / 7200) % 200);
        return r;
    }
    static GlonassEphemeris state_vector(SatelliteId id, GpsTime toe) {
        const SatelliteState state = satellite_state(kepler(id, toe), toe);
        GlonassEphemeris r;
        r.satellite = id;
        r.toe = toe;
        for (std::size_t i = 0; i < 3; ++i) {
            r.position_m[i] = state.position.vector()[static_cast<Eigen::Index>(i)];
            r.velocity_mps[i] = state.velocity.vector()[static_cast<Eigen::Index>(i)];
        }
        r.clock_bias = 1e-5 * (id.number - 12);
        r.clock_drift = 1e-12;
        r.frequency_channel = id.number % 14 - 7;
        return r;
    }

    std::vector<Constellation> systems_;
    BroadcastIonosphere ionosphere_;
};

}  // namespace skyloop::test
