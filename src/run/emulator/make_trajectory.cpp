#include "base/core/overloaded.hpp"
#include "motion/trajectory/shaped_path.hpp"
#include "motion/trajectory/shared_path.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/lever_arm.hpp"

namespace skyloop {

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

}  // namespace skyloop
