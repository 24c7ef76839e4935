#include "receiver/observed/sbf_epochs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/protocol/known_sbf.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint32_t sbf_week_ms = 604'800'000, sbf_no_time = 0xFFFFFFFF;

bool says(double value) { return value > sbf_nothing / 2; }

// Mode of PVTGeodetic, bits 0-3 (and 7: 2D): 3 a place that was set by hand, 4 and 7 RTK fixed, 5 and 8 float, 6 SBAS,
// 10 precise point positioning.
FixType sbf_fix_type(unsigned mode, unsigned error) {
    constexpr unsigned two_dimensional = 0x80;
    if (error != 0) return FixType::none;
    static constexpr std::array types{FixType::none,      FixType::fix_3d,    FixType::dgnss,
                                      FixType::time_only, FixType::rtk_fixed, FixType::rtk_float,
                                      FixType::dgnss,     FixType::rtk_fixed, FixType::rtk_float};
    const std::size_t number = mode & 15u;
    const FixType type = number < types.size() ? types[number] : FixType::fix_3d;
    return type == FixType::fix_3d && (mode & two_dimensional) != 0 ? FixType::fix_2d : type;
}

void take_motion(const SbfPvtGeodetic& pvt, ObservedEpoch& epoch) {
    if (says(pvt.latitude) && says(pvt.longitude) && says(pvt.height))
        epoch.place =
            observed_place(Angle::radians(pvt.latitude).deg(), Angle::radians(pvt.longitude).deg(), pvt.height);
    if (says(pvt.vel_north) && says(pvt.vel_east) && says(pvt.vel_up))
        epoch.velocity = VelocityNed{pvt.vel_north, pvt.vel_east, -pvt.vel_up};
}

void take_motion(const SbfPvtCartesian& pvt, ObservedEpoch& epoch) {
    constexpr double deepest_m = 6.3e6;  // from the Earth's centre: below any place
    const Position<Ecef> point(pvt.x, pvt.y, pvt.z);
    if (epoch.place || !says(pvt.x) || !says(pvt.y) || !says(pvt.z) || point.vector().norm() < deepest_m) return;
    const Geodetic there = to_geodetic(point);
    epoch.place = observed_place(there.latitude.deg(), there.longitude.deg(), there.height.above_ellipsoid.value());
    if (!says(pvt.vx) || !says(pvt.vy) || !says(pvt.vz)) return;
    const Eigen::Vector3d enu = LocalFrame(there).to_enu(Velocity<Ecef>(pvt.vx, pvt.vy, pvt.vz)).vector();
    epoch.velocity = VelocityNed{enu.y(), enu.x(), -enu.z()};
}

const SbfPvtAccuracy* accuracy_of(const SbfPvtGeodetic& pvt) { return pvt.accuracy ? &*pvt.accuracy : nullptr; }
const SbfPvtAccuracy* accuracy_of(const SbfPvtCartesian& pvt) { return &pvt.accuracy; }

}  // namespace

template <class Block, class Taker>
void SbfEpochs::with(const SbfBlockView& block, Taker&& taker) {
    if (block.number != Block::block_number) return;
    const auto told = decode_sbf<Block>(block.body);
    const bool timed = told && told->time.tow != sbf_no_time && told->time.wnc != 0xFFFF;
    taken_.is_senseless = !told || (timed && (told->time.tow >= sbf_week_ms || told->time.wnc > last_gps_week));
    if (taken_.is_senseless) return;
    const GpsTime time = timed ? to_gps_time({told->time.wnc, std::chrono::milliseconds(told->time.tow)}) : GpsTime{};
    if (!under_way_ || under_way_->timed != timed || under_way_->time != time || (!timed && under_way_->is_solution)) {
        taken_.ended = end();
        under_way_.emplace();
        under_way_->time = time;
        under_way_->timed = timed;
    }
    taker(*told, *under_way_);
}

template <class Block>
void SbfEpochs::take_solution(const Block& pvt) {
    ObservedEpoch& epoch = *under_way_;
    epoch.is_solution = true;
    epoch.type = sbf_fix_type(pvt.mode, pvt.error);
    if (pvt.num_sv != 0xFF) epoch.satellites_used = pvt.num_sv;
    take_motion(pvt, epoch);
    const SbfPvtAccuracy* accuracy = accuracy_of(pvt);
    if (!accuracy) return;
    if (const auto twice = accuracy->h_accuracy.value()) epoch.horizontal_accuracy = Metres(*twice / 2);
    if (const auto twice = accuracy->v_accuracy.value()) epoch.vertical_accuracy = Metres(*twice / 2);
}

SbfEpochs::Taken SbfEpochs::take(const SbfBlockView& block) {
    with<SbfPvtGeodetic>(block, [this](const SbfPvtGeodetic& pvt, ObservedEpoch&) { take_solution(pvt); });
    with<SbfPvtCartesian>(block, [this](const SbfPvtCartesian& pvt, ObservedEpoch&) { take_solution(pvt); });
    with<SbfDop>(block, [](const SbfDop& dop, ObservedEpoch& epoch) {
        if (const auto hdop = dop.hdop.value()) epoch.hdop = hdop;
    });
    with<SbfAttEuler>(block, [](const SbfAttEuler& attitude, ObservedEpoch& epoch) {
        if (attitude.error == 0 && says(attitude.heading) && says(attitude.pitch) && says(attitude.roll))
            epoch.attitude = Attitude::roll_pitch_yaw(Angle::degrees(attitude.roll), Angle::degrees(attitude.pitch),
                                                      Angle::degrees(attitude.heading));
    });
    take_satellites(block);
    return std::exchange(taken_, {});
}

// Elevations come at another rate than the strengths.
void SbfEpochs::take_satellites(const SbfBlockView& block) {
    const auto stands_at = [this](std::uint8_t svid, std::optional<double> elevation_deg) {
        if (const auto id = satellite_from_sbf(svid); id && elevation_deg && std::abs(*elevation_deg) <= 90)
            elevations_.emplace_back(*id, static_cast<int>(std::lround(*elevation_deg)));
    };
    with<SbfChannelStatus>(block, [&](const SbfChannelStatus& status, ObservedEpoch&) {
        elevations_.clear();
        for (const SbfChannel& channel : status.channels)
            stands_at(channel.svid, channel.elevation.value());
    });
    with<SbfSatVisibility>(block, [&](const SbfSatVisibility& sky, ObservedEpoch&) {
        elevations_.clear();
        for (const SbfVisibleSatellite& satellite : sky.satellites)
            stands_at(satellite.svid, satellite.elevation.value());
    });
    with<SbfMeasEpoch>(block, [this](const SbfMeasEpoch& measured, ObservedEpoch& epoch) {
        epoch.lists_satellites = true;
        const auto add = [&](std::uint8_t svid, std::optional<double> cn0, std::uint8_t type, bool first) {
            // GPS P(Y) and a signal beyond 30 begin elsewhere; the strengths of P(Y) have no 10 added (4.2.1).
            const bool precise = (type & 31u) == 1 || (type & 31u) == 2;
            const auto id = satellite_from_sbf(svid);
            if (id && cn0)
                add_signal(epoch.signals,
                           {*id, *cn0 + (precise ? 0 : 10), {}, every_signal_ && !first ? 1 + (type & 31) : 0});
        };
        for (const SbfMeasuredSatellite& satellite : measured.satellites) {
            add(satellite.svid, satellite.cn0.value(), satellite.type, true);
            for (const SbfOtherSignal& other : satellite.others)
                add(satellite.svid, other.cn0.value(), other.type, false);
        }
    });
}

std::optional<ObservedEpoch> SbfEpochs::end() {
    if (!under_way_) return std::nullopt;
    for (ObservedSignal& signal : under_way_->signals) {
        const auto at = std::find_if(elevations_.begin(), elevations_.end(),
                                     [&](const auto& known) { return known.first == signal.id; });
        if (at != elevations_.end() && signal.number == 0) signal.elevation_deg = at->second;
    }
    return std::exchange(under_way_, std::nullopt);
}

}  // namespace skyloop::inline receiver
