#include "run/emulator/antenna_path.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "base/core/std_additions.hpp"
#include "base/geo/attitude.hpp"
#include "base/geo/local_frame.hpp"
#include "motion/trajectory/shaped_path.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "run/emulator/assembly.hpp"

namespace skyloop::inline run {
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

namespace {

// What takes east, north and up of one place to those of another.
Eigen::Matrix3d turn_between(const Geodetic& from, const Geodetic& to) {
    const LocalFrame here(from), there(to);
    Eigen::Matrix3d turn;
    for (int axis = 0; axis < turn.cols(); ++axis)
        turn.col(axis) = there.to_ecef(here.to_enu(Displacement<Ecef>(Eigen::Vector3d::Unit(axis)))).vector();
    return turn;
}

}  // namespace

std::unique_ptr<Trajectory> MovedPath::moved(std::unique_ptr<Trajectory> path, const Geodetic& place, GpsTime now) {
    if (auto* again = dynamic_cast<MovedPath*>(path.get())) {
        again->move(place, now);
        return path;
    }
    std::unique_ptr<MovedPath> first(new MovedPath(std::move(path)));
    first->move(place, now);
    return first;
}

void MovedPath::move(const Geodetic& place, GpsTime now) {
    const TruthState unmoved = path_->at(now);
    const Geodetic before = to_geodetic(to_ + Displacement<Ecef>(turn_ * (unmoved.position - from_).vector()));
    turn_ = turn_between(before, place) * turn_;
    from_ = unmoved.position;
    to_ = to_ecef(place);
}

TruthState MovedPath::at(GpsTime time) const {
    TruthState state = path_->at(time);
    state.position = to_ + Displacement<Ecef>(turn_ * (state.position - from_).vector());
    state.velocity = Velocity<Ecef>(turn_ * state.velocity.vector());
    state.geodetic = to_geodetic(state.position);
    return state;
}

std::unique_ptr<Trajectory> make_trajectory(const TrajectorySettings& settings, GpsTime start) {
    return std::visit(Overloaded{
                          [](const FixedSettings& fixed) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<FixedPoint>(fixed.at);
                          },
                          [&](const WaypointSettings& path) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<Waypoints>(start, path.corners);
                          },
                          [&](const CircleSettings& circle) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<Circle>(start, circle.shape);
                          },
                          [](const FileSettings& file) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<SharedPath>(file.way);
                          },
                          [](const LiveSettings& live) -> std::unique_ptr<Trajectory> {
                              // The vehicle that every receiver has left has no source.
                              if (!live.path) return std::make_unique<FixedPoint>(live.at.value_or(FixedSettings().at));
                              return std::make_unique<SharedPath>(live.path);
                          },
                          [&](const GeneratedSettings& generated) -> std::unique_ptr<Trajectory> {
                              const GeneratedPath& path = generated.path;
                              return std::make_unique<ShapedPath>(advanced(start, path.start_delay),
                                                                  GeodesicPlane(path.origin), generated.shape,
                                                                  path.vehicle.kind);
                          },
                      },
                      settings);
}

std::unique_ptr<Trajectory> make_antenna_path(const Scenario& scenario, const SimulationSetup& setup) {
    return make_antenna_path(scenario, setup.receiver,
                             make_trajectory(trajectory_of(scenario, setup.receiver), setup.start));
}

std::unique_ptr<Trajectory> make_antenna_path(const Scenario& scenario, std::size_t receiver,
                                              std::unique_ptr<Trajectory> vehicle) {
    const auto& [forward, right, down] = scenario.receivers.at(receiver).antenna_offset;
    const AntennaOffset offset{forward, right, down};
    if (offset == AntennaOffset{}) return vehicle;
    const Angle heading = std::visit([](const auto& path) { return path.heading; }, trajectory_of(scenario, receiver));
    return std::make_unique<LeverArm>(std::move(vehicle), offset, heading);
}

std::optional<Geodetic> place_before_start(const Scenario& scenario, std::size_t receiver, const TruthState& now) {
    const ReceiverEntry& entry = scenario.receivers.at(receiver);
    if (entry.start == StartKind::cold || (entry.start == StartKind::hot && !entry.power_up)) return std::nullopt;
    const auto* live = std::get_if<LiveSettings>(&trajectory_of(scenario, receiver));
    if (live != nullptr && !live->at) return std::nullopt;
    return now.geodetic;
}

}  // namespace skyloop::inline run
