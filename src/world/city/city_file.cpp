#include "world/city/city_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "detail/city_text.hpp"

namespace skyloop::inline world {
namespace {

tl::unexpected<Error> axes_misread(std::string_view text) {
    return fail(ErrorCode::usage,
                fmt::format("axes '{}': expected which of x, y and z point east, north and up, each once, each with an "
                            "optional minus, such as x,y,z or x,-z,y",
                            shown(text)));
}

}  // namespace

Result<FileAxes> FileAxes::parse(std::string_view text) {
    FileAxes axes;
    unsigned seen = 0;
    std::string_view rest = text;
    for (std::size_t i = 0; i < 3; ++i) {
        const bool minus = rest.starts_with('-');
        if (minus) rest.remove_prefix(1);
        if (rest.empty() || rest.front() < 'x' || rest.front() > 'z') return axes_misread(text);
        axes.axis[i] = rest.front() - 'x';
        axes.sign[i] = minus ? -1 : 1;
        seen |= 1U << axes.axis[i];
        rest.remove_prefix(1);
        if (i == 2) break;
        if (!rest.starts_with(',')) return axes_misread(text);
        rest.remove_prefix(1);
    }
    if (!rest.empty() || seen != 7) return axes_misread(text);
    return axes;
}

namespace {

// What triangles of each kind span; corners that are no numbers do not count.
struct CityExtent {
    std::array<std::size_t, 3> triangles{};
    std::array<double, 3> lowest_of_kind;
    Eigen::Vector3d lowest, highest;

    explicit CityExtent(const CityModel& city) {
        const double infinite = std::numeric_limits<double>::infinity();
        lowest_of_kind.fill(infinite);
        lowest.setConstant(infinite);
        highest.setConstant(-infinite);
        for (const CityTriangle& triangle : city.triangles) {
            const auto kind = static_cast<std::size_t>(triangle.kind);
            ++triangles[kind];
            for (const std::uint32_t corner : triangle.corners) {
                const Eigen::Vector3d& place = city.vertices[corner];
                if (!place.allFinite()) continue;
                lowest = lowest.cwiseMin(place);
                highest = highest.cwiseMax(place);
                lowest_of_kind[kind] = std::min(lowest_of_kind[kind], place.z());
            }
        }
    }
};

void doubt_units(const CityExtent& city, std::vector<std::string>& doubts) {
    const Eigen::Vector3d extent = city.highest - city.lowest;
    const double width = std::max(extent.x(), extent.y());
    const bool buildings = city.triangles[0] + city.triangles[1] > 0;
    if (buildings && extent.z() <= 3)
        doubts.push_back(
            fmt::format("the whole city is {:.2f} m tall; are the units or the axes others than assumed?", extent.z()));
    else if (extent.z() > 1500 && width < 100 * extent.z())
        doubts.push_back(
            fmt::format("the city is {:.0f} m tall; are the units or the axes others than assumed?", extent.z()));
    if (width < 10) doubts.push_back(fmt::format("the whole city is {:.2f} m wide; are the units others?", width));
    if (width > 100'000)
        doubts.push_back(
            fmt::format("the city is {:.0f} km wide; are the units others, or some corners astray?", width / 1000));
}

}  // namespace

std::vector<std::string> doubts_about(const CityModel& city) {
    const CityExtent extent(city);
    std::vector<std::string> doubts;
    if (!(extent.lowest.x() <= extent.highest.x())) return doubts;
    doubt_units(extent, doubts);
    const Eigen::Vector3d middle = (extent.lowest + extent.highest) / 2;
    if (const double away = middle.head<2>().norm(); away > 50'000)
        doubts.push_back(
            fmt::format("the middle of the city is {:.0f} km from its origin; are its coordinates those of a map? "
                        "scene.file_origin tells which of a mesh lie at the origin",
                        away / 1000));
    if (extent.triangles[0] == 0 && extent.triangles[1] > 0)
        doubts.emplace_back("the city has roofs but no wall; nothing reflects where only walls do");
    const auto& [wall, roof, ground] = extent.lowest_of_kind;
    if (extent.triangles[0] > 0 && extent.triangles[2] > 0 && wall < ground - 50)
        doubts.push_back(fmt::format("walls reach {:.0f} m below the lowest ground", ground - wall));
    return doubts;
}

}  // namespace skyloop::inline world
