#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "world/gnss/constants.hpp"
#include "world/gnss/nequick_g.hpp"
#include "world/propagation/ionosphere_truth.hpp"
#include "world/propagation/per_satellite.hpp"

namespace skyloop {
namespace {

constexpr Nanoseconds nequick_spacing = std::chrono::seconds(30);

Position<Ecef> carried_ahead(const SatelliteInView& satellite, Seconds dt) {
    const Eigen::Vector3d p = satellite.position_at_transmission.vector();
    const Eigen::Vector3d v = satellite.velocity_at_transmission.vector();
    const Eigen::Vector3d turn(0, 0, earth_rotation_rate);
    const double r = p.norm();
    const Eigen::Vector3d acceleration =
        -gravitational_constant_gps / (r * r * r) * p - 2 * turn.cross(v) - turn.cross(turn.cross(p));
    return Position<Ecef>(p + dt.value() * v + dt.value() * dt.value() / 2 * acceleration);
}

class NequickTruth : public IonosphereTruth {
public:
    NequickTruth(std::vector<NequickTables> months, const EffectiveIonisation& ionisation, LeapSeconds leap_seconds)
        : months_(std::move(months)), ionisation_(ionisation), leap_seconds_(std::move(leap_seconds)) {}

    Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) override {
        Content& content = contents_.of(satellite.id, [](SatelliteId) { return Content{}; });
        const std::int64_t knot = truth.time.time_since_epoch() / nequick_spacing;
        if (content.knot != knot) {
            content.from = content.knot + 1 == knot ? content.to : at(knot, satellite, truth);
            content.to = at(knot + 1, satellite, truth);
            content.knot = knot;
        }
        const double fraction =
            difference(truth.time, GpsTime(knot * nequick_spacing)).value() / to_seconds(nequick_spacing).value();
        return ionosphere_group_delay(content.from * (1 - fraction) + content.to * fraction, carrier);
    }

private:
    // At the two knots around the present.
    struct Content {
        std::int64_t knot = -2;
        Tecu from, to;
    };

    [[nodiscard]] Tecu at(std::int64_t knot, const SatelliteInView& satellite, const TruthState& truth) const {
        const GpsTime time(knot * nequick_spacing);
        const UtcTime utc = to_utc(time, leap_seconds_);
        const Geodetic there = to_geodetic(carried_ahead(satellite, difference(time, truth.time)));
        return nequick_slant_content(months_[utc.month - 1], ionisation_, truth.geodetic, there,
                                     utc.seconds_of_day() / 3600);
    }

    std::vector<NequickTables> months_;  // of the year, January first
    EffectiveIonisation ionisation_;
    LeapSeconds leap_seconds_;
    PerSatellite<Content> contents_;
};

constexpr std::array<const char*, 12> month_names{"January",   "February", "March",    "April",
                                                  "May",       "June",     "July",     "August",
                                                  "September", "October",  "November", "December"};

}  // namespace

Result<std::unique_ptr<IonosphereTruth>> make_nequick_truth(const EffectiveIonisation& ionisation,
                                                            const ModernContext& context) {
    // All of the year, for a run need not have an end.
    std::vector<NequickTables> months;
    for (const char* name : month_names) {
        auto read = read_nequick_tables(context.nequick_folder, static_cast<int>(months.size()) + 1);
        if (!read)
            return fail(read.error().code,
                        fmt::format("NeQuick-G has no tables for {}: {}", name, read.error().message));
        months.push_back(std::move(*read));
    }
    return std::make_unique<NequickTruth>(std::move(months), ionisation, context.leap_seconds);
}

}  // namespace skyloop
