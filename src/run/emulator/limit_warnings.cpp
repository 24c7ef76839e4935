#include "detail/limit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geo/frames.hpp"
#include "firmware/state_tracker.hpp"

namespace skyloop {
namespace {

constexpr double longest_look_s = 3600;

// What a receiver without errors believes.
Fix fix_of(const TruthState& truth, const Geoid* geoid) {
    Fix fix;
    fix.position = truth.geodetic;
    if (geoid != nullptr) fix.geoid_undulation = geoid->undulation(truth.geodetic.latitude, truth.geodetic.longitude);
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    fix.velocity = {enu.y(), enu.x(), -enu.z()};
    fix.speed = MetresPerSecond(std::hypot(enu.x(), enu.y()));
    return fix;
}

std::string which_limit(const firmware::BoardProfile& board, std::uint64_t model, const Fix& fix) {
    firmware::BoardProfile of_all = board;
    of_all.export_limits = firmware::ExportLimits::off;
    if (firmware::within_limits(of_all, model, fix)) return "its export_limits";
    of_all.dynamic_limits = false;
    return firmware::within_limits(of_all, model, fix) ? "the limits of its dynamic_model"
                                                       : "500 m/s, from which on no receiver does";
}

}  // namespace

std::optional<std::string> limit_warning(const PathUnderLimits& path) {
    const TrajectorySettings& way = trajectory_of(path.scenario, path.receiver);
    if (std::holds_alternative<LiveSettings>(way)) return std::nullopt;
    const auto vehicle = make_trajectory(way, path.start);
    const bool moves = !std::holds_alternative<FixedSettings>(way);
    const double run = path.end ? difference(*path.end, path.start).value() : longest_look_s;
    const double step = std::max(1.0, run / longest_look_s);
    const auto looks = moves ? static_cast<int>(run / step) + 1 : 1;
    const std::uint64_t model = firmware::dynamic_model_number(path.dynamic_model);
    std::optional<std::pair<double, Fix>> first;
    int beyond = 0;
    for (int i = 0; i < looks; ++i) {
        const Fix fix = fix_of(vehicle->at(advanced(path.start, Seconds(i * step))), path.geoid);
        if (firmware::within_limits(path.board, model, fix)) continue;
        if (!first) first = {i * step, fix};
        ++beyond;
    }
    if (!first) return std::nullopt;
    const Fix& fix = first->second;
    const double height = above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
    const std::string how_long =
        beyond == looks ? "in the whole run"
                        : fmt::format("in {:.2g} % of the run, from {:.0f} s on", 100.0 * beyond / looks, first->first);
    return fmt::format("{} tells no fix {}: {:.0f} m above the sea at {:.0f} m/s is beyond {}", path.board.name,
                       how_long, height, std::hypot(fix.speed.value(), fix.velocity.down),
                       which_limit(path.board, model, fix));
}

}  // namespace skyloop
