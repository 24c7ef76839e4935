// Any bytes as a scenario: mistakes of one line each, or settings that can be run.
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/scenario/scenario_file.hpp"

namespace {

using namespace skyloop;

void check_place(const Geodetic& place) {
    require(std::abs(place.latitude.deg()) <= 90 && std::abs(place.longitude.deg()) <= 180 + 1e-9);
    const double height = place.height.above_ellipsoid.value();
    require(height >= -1e4 - 1e-3 && height <= 1e7 + 1e-3);
}

void check_trajectory(const TrajectorySettings& trajectory) {
    if (const auto* fixed = std::get_if<FixedSettings>(&trajectory)) check_place(fixed->at);
    if (const auto* circle = std::get_if<CircleSettings>(&trajectory)) {
        check_place(circle->shape.centre);
        require(circle->shape.radius > Metres(0) && std::isfinite(circle->shape.speed.value()));
    }
    if (const auto* path = std::get_if<WaypointSettings>(&trajectory)) {
        require(path->corners.size() >= 2);
        for (const Waypoint& corner : path->corners) {
            check_place(corner.place);
            require(corner.speed > MetresPerSecond(0) && corner.hold >= Seconds(0));
        }
    }
    if (const auto* generated = std::get_if<GeneratedSettings>(&trajectory)) {
        check_place(generated->path.origin);
        require(generated->shape != nullptr);
        for (const double t : {-1.0, 0.0, 1.0, 77.7, 3600.0}) {
            const LocalMotion motion = generated->shape->at(t);
            require(motion.position.allFinite() && motion.velocity.allFinite() && std::isfinite(motion.heading));
        }
    }
}

// Each line begins with the file, a line and a column.
void check_mistakes(const std::string& message) {
    require(!message.empty());
    std::istringstream lines(message);
    for (std::string line; std::getline(lines, line);) {
        require(line.starts_with("fuzz.toml:") && line.size() < 2000);
        require(line.size() > 10 && line[10] >= '0' && line[10] <= '9');
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Result<Scenario> scenario = read_scenario({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (!scenario) {
        // A table of an antenna's that is named may not be there.
        require(scenario.error().code != ErrorCode::usage);
        check_mistakes(scenario.error().message);
        return 0;
    }
    check_trajectory(scenario->trajectory);
    require(scenario->run.speed > 0 && std::isfinite(scenario->run.speed));
    require(!scenario->run.duration || *scenario->run.duration > Seconds(0));
    const Angle mask = scenario->sky.elevation_mask.value_or(Angle());
    require(mask >= Angle() && mask <= Angle::degrees(90));
    for (const AtmosphericLayer& layer : scenario->atmosphere.layers)
        require(layer.top > layer.base);
    for (const CloudDeck& cloud : scenario->atmosphere.clouds)
        require(cloud.top > cloud.base && cloud.density_g_m3 >= 0);
    for (const std::string& warning : scenario->warnings)
        require(is_one_line(warning));
    return 0;
}
