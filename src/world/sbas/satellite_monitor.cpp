#include "world/sbas/satellite_monitor.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/core/bytes.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop::inline world {
namespace {

constexpr double square_of(double x) { return x * x; }

constexpr std::chrono::seconds long_term_period{60};
constexpr Angle monitor_mask = Angle::degrees(5);
// Of a station's range, and of each part of an error without any measurement, m, 1 σ; ours.
constexpr double range_deviation = 0.02, error_deviation = 1;
// Steps and halves of the ranges of message 25 without velocity.
constexpr double orbit_step = 0.125, clock_step = 0x1p-31, fast_step = 0.125;
constexpr int orbit_most = 255, clock_most = 511, fast_most = 2047;
// What rounding to these steps leaves, m, 1 σ.
const double rounding_deviation = std::sqrt((2 * square_of(0.125) + square_of(clock_step * speed_of_light)) / 12);

double rounded(double value, double step, int most) {
    return static_cast<double>(quantised(value, step, -most, most)) * step;
}

// The satellites of GPS alone, which today's systems correct (EGNOS Open Service SDD 2.3, WAAS Performance Standard).
class GpsBroadcast : public NavigationSource {
public:
    explicit GpsBroadcast(std::shared_ptr<const NavigationSource> all) : all_(std::move(all)) {}
    [[nodiscard]] std::vector<SatelliteId> satellites() const override {
        std::vector<SatelliteId> list = all_->satellites();
        std::erase_if(list, [](SatelliteId id) { return id.constellation != Constellation::gps; });
        return list;
    }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override {
        return all_->ephemeris(satellite, time);
    }
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return all_->ionosphere(); }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return all_->span(); }
    [[nodiscard]] std::string description() const override { return all_->description(); }

private:
    std::shared_ptr<const NavigationSource> all_;
};

}  // namespace

SatelliteMonitor::SatelliteMonitor(Truth truth, const std::vector<Geodetic>& sites)
    : navigation_(std::make_shared<GpsBroadcast>(std::move(truth.navigation))),
      error_(std::move(truth.error)),
      precise_(std::move(truth.precise)) {
    for (const Geodetic& site : sites)
        sites_.push_back({{GpsTime(), to_ecef(site), Velocity<Ecef>(), site}, SkyObserver(precise_.get())});
}

// How much longer the present record's range is than that of the corrected one, its clock taken off.
std::optional<double> SatelliteMonitor::range_over_record(const SatelliteInView& satellite, GpsTime time,
                                                          const Eigen::Vector3d& line) const {
    const auto held = long_term_.find(satellite.id);
    if (held == long_term_.end()) return std::nullopt;
    const Ephemeris& record = held->second.record;
    if (toe_of(record) == satellite.toe && iode_of(record) == satellite.iode) return 0;
    const SatelliteState state = satellite_state(record, time, -satellite.travel_time);
    const double farther = line.dot(satellite.position_at_transmission.vector() - state.position.vector());
    return farther - speed_of_light * (satellite.clock_bias.value() - state.clock_bias);
}

SatelliteMonitor::SeenErrors SatelliteMonitor::look(GpsTime time) {
    SeenErrors seen;
    for (Site& site : sites_) {
        site.truth.time = time;
        const SkyView sky = site.observer.observe(site.truth, *navigation_);
        Arrivals arrivals = free_space(sky);
        error_.apply(arrivals, sky, site.truth);
        for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
            const SatelliteInView& s = sky.satellites[i];
            if (s.elevation < monitor_mask || !s.healthy) continue;
            const Eigen::Vector3d line =
                (s.position_at_transmission.vector() - site.truth.position.vector()).normalized();
            if (const auto more = range_over_record(s, time, line))
                seen[s.id].push_back({line, *more + arrivals.satellites[i].signal_in_space_error.value()});
        }
    }
    return seen;
}

void SatelliteMonitor::begin_minute(GpsTime minute) {
    minute_ = minute;
    long_term_.clear();
    for (const SatelliteId id : navigation_->satellites()) {
        const auto record = navigation_->ephemeris(id, minute);
        if (record && is_healthy(*record)) long_term_.insert({id, {*record}});
    }
    for (const auto& [id, errors] : look(minute)) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() / (error_deviation * error_deviation);
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        constexpr double weight = 1 / (range_deviation * range_deviation);
        for (const SeenError& e : errors) {
            const Eigen::Vector4d row(e.line.x(), e.line.y(), e.line.z(), -1);
            normal += weight * row * row.transpose();
            right += weight * e.range_m * row;
        }
        const Eigen::Vector4d solved = normal.ldlt().solve(right);
        LongTerm& held = long_term_.at(id);
        held.correction.iode = iode_of(held.record);
        for (int axis = 0; axis < 3; ++axis)
            held.correction.orbit_m[axis] = rounded(solved[axis], orbit_step, orbit_most);
        held.correction.clock_s = rounded(solved[3] / speed_of_light, clock_step, clock_most);
    }
}

const std::map<SatelliteId, MonitoredSatellite>& SatelliteMonitor::at(GpsTime time) {
    if (now_ == time) return satellites_;
    now_ = time;
    const GpsTime minute(time.time_since_epoch() / long_term_period * long_term_period);
    if (minute_ != minute) begin_minute(minute);
    satellites_.clear();
    for (const auto& [id, errors] : look(time)) {
        MonitoredSatellite satellite = long_term_.at(id).correction;
        std::vector<double> left;
        for (const SeenError& e : errors)
            left.push_back(e.range_m - e.line.dot(satellite.orbit_m) + speed_of_light * satellite.clock_s);
        const double mean = std::accumulate(left.begin(), left.end(), 0.0) / static_cast<double>(left.size());
        satellite.range_m = rounded(-mean, fast_step, fast_most);
        double squares = 0;
        for (const double metres : left)
            squares += square_of(metres + satellite.range_m);
        const double deviation = std::hypot(std::sqrt(squares / static_cast<double>(left.size())), rounding_deviation);
        satellite.udrei = sbas_udre_index(sbas_bound_factor * deviation);
        satellites_.insert({id, satellite});
    }
    return satellites_;
}

}  // namespace skyloop::inline world
