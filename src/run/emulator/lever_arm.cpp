#include "run/emulator/lever_arm.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "base/geo/body_frame.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

constexpr double slowest_mps = 0.01;  // below it there is no course
constexpr double pi = std::numbers::pi;

}  // namespace

LeverArm::LeverArm(std::unique_ptr<Trajectory> vehicle, const AntennaOffset& offset, Angle heading_at_rest)
    : vehicle_(std::move(vehicle)), offset_(offset), heading_(heading_at_rest.rad()) {}

// Over ground, rad; nothing at rest.
std::optional<double> LeverArm::course(GpsTime time) const {
    const TruthState state = vehicle_->at(time);
    const Eigen::Vector3d enu = LocalFrame(state.geodetic).to_enu(state.velocity).vector();
    if (std::hypot(enu.x(), enu.y()) < slowest_mps) return std::nullopt;
    return std::atan2(enu.x(), enu.y());
}

// rad/s. A path that turns at a corner does so in no time, which is no rate. Before its beginning and behind its end it
// stands, or goes on as it is there: then the other side alone tells.
double LeverArm::yaw_rate(GpsTime time, double here) const {
    constexpr Nanoseconds step = std::chrono::milliseconds(5);
    constexpr double fastest_rad_per_s = 4 * pi;
    const auto before = course(time - step), after = course(time + step);
    const double came = before ? std::remainder(here - *before, 2 * pi) : 0;
    const double goes = after ? std::remainder(*after - here, 2 * pi) : 0;
    const double sides = came == 0 || goes == 0 ? 1 : 2;
    const double rate = (came + goes) / (sides * to_seconds(step).value());
    return std::abs(rate) > fastest_rad_per_s ? 0 : rate;
}

// R l from the vehicle to the antenna, and ω × l besides the vehicle's velocity (FEEDS.md 0).
TruthState LeverArm::turned_with(TruthState state) const {
    const Eigen::Vector3d arm(offset_.forward, offset_.right, offset_.down);
    const Eigen::Quaterniond to_ecef = body_to_ecef(state.orientation->attitude, state.geodetic);
    state.position = state.position + Displacement<Ecef>(to_ecef * arm);
    state.velocity = Velocity<Ecef>(state.velocity.vector() + to_ecef * state.orientation->turn_rate.cross(arm));
    state.geodetic = to_geodetic(state.position);
    return state;
}

TruthState LeverArm::at(GpsTime time) const {
    TruthState state = vehicle_->at(time);
    if (state.orientation) return turned_with(std::move(state));
    const auto moving = course(time);
    if (moving) heading_ = *moving;
    const double s = std::sin(heading_), c = std::cos(heading_);
    const double east = offset_.forward * s + offset_.right * c;
    const double north = offset_.forward * c - offset_.right * s;
    const double rate = moving ? yaw_rate(time, *moving) : 0;
    const LocalFrame frame(state.geodetic);
    // Clockwise from north: what lies ahead moves to the right.
    const Velocity<Ecef> swing = frame.to_ecef(Velocity<Enu>(rate * north, -rate * east, 0));
    state.position = state.position + frame.to_ecef(Displacement<Enu>(east, north, -offset_.down));
    state.velocity = Velocity<Ecef>(state.velocity.vector() + swing.vector());
    state.geodetic = to_geodetic(state.position);
    return state;
}

}  // namespace skyloop
