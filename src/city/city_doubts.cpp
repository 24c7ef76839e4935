#include "skyloop/city/city_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop {

std::vector<std::string> doubts_about(const CityModel& city) {
    if (city.vertices.empty()) return {};
    Eigen::Vector3d lowest = city.vertices.front(), highest = lowest;
    for (const Eigen::Vector3d& vertex : city.vertices) {
        lowest = lowest.cwiseMin(vertex);
        highest = highest.cwiseMax(vertex);
    }
    const Eigen::Vector3d extent = highest - lowest;
    const double width = std::max(extent.x(), extent.y());
    std::vector<std::string> doubts;
    if (extent.z() <= 3)
        doubts.push_back(
            fmt::format("the whole city is {:.2f} m tall; are the units or the axes others than assumed?", extent.z()));
    else if (extent.z() > 1500 && width < 100 * extent.z())
        doubts.push_back(
            fmt::format("the city is {:.0f} m tall; are the units or the axes others than assumed?", extent.z()));
    if (width < 10) doubts.push_back(fmt::format("the whole city is {:.2f} m wide; are the units others?", width));
    if (width > 100'000)
        doubts.push_back(
            fmt::format("the city is {:.0f} km wide; are the units others, or some corners astray?", width / 1000));
    return doubts;
}

}  // namespace skyloop
