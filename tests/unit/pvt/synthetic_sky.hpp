/// Satellites of all systems and the measurements that a perfect receiver makes of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::test {

/// One record of each satellite, at all times.
class SyntheticSky : public NavigationSource {
public:
    explicit SyntheticSky(std::vector<Ephemeris> records) : records_(std::move(records)) {}
    std::vector<SatelliteId> satellites() const override {
        std::vector<SatelliteId> ids;
        for (const Ephemeris& r : records_)
            ids.push_back(satellite_of(r));
        std::sort(ids.begin(), ids.end());
        return ids;
    }
    std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override {
        if (time < known_from) return std::nullopt;
        for (const Ephemeris& r : records_)
            if (satellite_of(r) == satellite) return r;
        return std::nullopt;
    }
    const BroadcastIonosphere& ionosphere() const override { return air; }
    std::optional<TimeSpan> span() const override { return std::nullopt; }
    std::string description() const override { return "synthetic"; }

    std::vector<Ephemeris>& records() { return records_; }
    const std::vector<Ephemeris>& records() const { return records_; }
    BroadcastIonosphere air;
    GpsTime known_from;

private:
    std::vector<Ephemeris> records_;
};

inline KeplerEphemeris synthetic_record(SatelliteId id, GpsTime toe, int plane, int slot) {
    const bool geostationary = is_beidou_geo(id);
    const bool galileo = id.constellation == Constellation::galileo;
    KeplerEphemeris e;
    e.satellite = id;
    e.message = galileo ? NavigationMessage::inav : NavigationMessage::lnav;
    e.toe = toe;
    e.toc = toe;
    e.sqrt_a = std::sqrt(geostationary ? 42164e3 : (galileo ? 29600e3 : 26560e3));
    e.e = geostationary ? 0.0002 : 0.002 + 0.001 * slot;
    e.i0 = geostationary ? 0.08 : 0.96;
    e.omega0 = 2 * std::numbers::pi / 3 * plane + 0.3 * static_cast<double>(id.constellation);
    e.omega = 0.4;
    e.m0 = geostationary ? 1.1 * slot : 2 * std::numbers::pi / 8 * slot + 0.3 * plane;
    e.omega_dot = -8e-9;
    e.delta_n = 4e-9;
    e.cuc = 1e-6, e.cus = 8e-6, e.crc = 200, e.crs = -30, e.cic = 1e-7, e.cis = -1e-7;
    e.af0 = 1e-5 * (id.number % 60) - 4e-4;
    e.af1 = 3e-12 * (slot - 3);
    e.tgd = 1e-9 * (slot - 5);
    e.tgd2 = 1.4e-9 * (slot - 4);
    e.accuracy_m = 2;
    return e;
}

inline GlonassEphemeris synthetic_glonass(int number, GpsTime toe, int plane, int slot) {
    const KeplerEphemeris orbit = synthetic_record({Constellation::gps, number}, toe, plane, slot);
    const SatelliteState state = satellite_state(orbit, toe);
    GlonassEphemeris e;
    e.satellite = {Constellation::glonass, number};
    e.toe = toe;
    // Turned about the axis, so as not to stand where GPS satellites do.
    const Eigen::Vector3d r = state.position.vector();
    const Eigen::Vector3d v = state.velocity.vector();
    const Eigen::Vector3d rt(r.x() * 0.8 - r.y() * 0.6, r.x() * 0.6 + r.y() * 0.8, r.z());
    const Eigen::Vector3d vt(v.x() * 0.8 - v.y() * 0.6, v.x() * 0.6 + v.y() * 0.8, v.z());
    for (std::size_t i = 0; i < 3; ++i) {
        e.position_m[i] = rt[static_cast<Eigen::Index>(i)];
        e.velocity_mps[i] = vt[static_cast<Eigen::Index>(i)];
    }
    e.clock_bias = 2e-5 * number - 1e-4;
    e.clock_drift = 1e-12;
    e.frequency_channel = number % 7 - 3;
    return e;
}

/// 24 satellites each of the named systems. @param toe of all records
inline SyntheticSky synthetic_sky(GpsTime toe, const std::vector<Constellation>& systems) {
    std::vector<Ephemeris> records;
    for (const Constellation c : systems)
        for (int plane = 0; plane < 3; ++plane)
            for (int slot = 0; slot < 8; ++slot) {
                const int number = plane * 8 + slot + 1;
                if (c == Constellation::glonass)
                    records.emplace_back(synthetic_glonass(number, toe, plane, slot));
                else
                    records.emplace_back(synthetic_record({c, number}, toe, plane, slot));
            }
    return SyntheticSky(std::move(records));
}

inline const std::vector<Constellation> four_systems{Constellation::gps, Constellation::galileo, Constellation::beidou,
                                                     Constellation::glonass};

/// A receiver whose position is linear in time.
struct TrueReceiver {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // at `time`
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    GpsTime time;
    double clock_bias_m = 0;
    double clock_drift_mps = 0;

    Eigen::Vector3d position_at(double offset_s) const { return position + offset_s * velocity; }
};

struct TrueRange {
    double range = 0;           // m
    Eigen::Vector3d satellite;  // in the frame of reception
    double clock = 0, drift = 0;
};

/// The light-time equation, solved by itself.
inline TrueRange true_range(const Ephemeris& record, const TrueReceiver& receiver, double offset_s) {
    TrueRange r;
    double tau = 0.075;
    for (int i = 0; i < 8; ++i) {
        const SatelliteState s = satellite_state(record, receiver.time, Seconds(offset_s - tau));
        const double a = earth_rotation_rate * tau;
        const Eigen::Vector3d p = s.position.vector();
        r.satellite = {p.x() * std::cos(a) + p.y() * std::sin(a), p.y() * std::cos(a) - p.x() * std::sin(a), p.z()};
        r.range = (r.satellite - receiver.position_at(offset_s)).norm();
        r.clock = s.clock_bias;
        r.drift = s.clock_drift;
        tau = r.range / speed_of_light;
    }
    return r;
}

struct MeasureOptions {
    Angle mask = Angle::degrees(5);
    bool all_signals = false;
    std::optional<std::vector<double>> biases{};  // by clock: GPS, Galileo, BeiDou, GLONASS; m, beside the receiver's
};

/// What an errorless receiver measures. @param delay added to a pseudorange, m, by satellite, direction and carrier
template <class Delay>
Observations measure(const NavigationSource& sky, const TrueReceiver& receiver, const MeasureOptions& options,
                     const Delay& delay) {
    Observations all;
    all.receive_time = advanced(receiver.time, Seconds(receiver.clock_bias_m / speed_of_light));
    const LocalFrame frame(to_geodetic(Position<Ecef>(receiver.position)));
    for (const SatelliteId id : sky.satellites()) {
        const auto record = sky.ephemeris(id, receiver.time);
        if (!record) continue;
        const TrueRange now = true_range(*record, receiver, 0);
        const LookAngles look = frame.look_angles(Position<Ecef>(now.satellite));
        if (look.elevation < options.mask) continue;
        const double h = 0.05;
        const double rate =
            (true_range(*record, receiver, h).range - true_range(*record, receiver, -h).range) / (2 * h);
        double system_bias = 0;
        if (options.biases) {
            const std::size_t c = id.constellation == Constellation::galileo   ? 1
                                  : id.constellation == Constellation::beidou  ? 2
                                  : id.constellation == Constellation::glonass ? 3
                                                                               : 0;
            system_bias = (*options.biases)[c];
        }
        for (const TransmittedSignal& s : transmitted_signals(*record)) {
            Observation o;
            o.satellite = id;
            o.signal = s.signal;
            o.carrier = s.carrier;
            o.cn0 = DbHz(45);
            const SkyDirection direction{look.azimuth, look.elevation};
            o.pseudorange = Metres(now.range + receiver.clock_bias_m + system_bias - speed_of_light * now.clock +
                                   speed_of_light * s.group_delay.value() + delay(id, direction, s.carrier));
            const double wavelength = speed_of_light / s.carrier.value();
            o.carrier_phase = o.pseudorange->value() / wavelength + 1000;
            o.doppler = Hertz(-(rate + receiver.clock_drift_mps - speed_of_light * now.drift) / wavelength);
            all.signals.push_back(o);
            if (!options.all_signals) break;
        }
    }
    return all;
}

inline Observations measure(const NavigationSource& sky, const TrueReceiver& receiver,
                            const MeasureOptions& options = {}) {
    return measure(sky, receiver, options, [](const SatelliteId&, const SkyDirection&, Hertz) { return 0.0; });
}

inline TrueReceiver receiver_at(const Geodetic& place, GpsTime time) {
    TrueReceiver r;
    r.position = to_ecef(place).vector();
    r.time = time;
    r.clock_bias_m = 12345.678;
    r.clock_drift_mps = 42;
    return r;
}

/// Near the toe of the samples' records.
inline const GpsTime sample_time = to_gps_time(2300, 216000.0);

}  // namespace skyloop::test
