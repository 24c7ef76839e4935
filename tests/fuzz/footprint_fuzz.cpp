// Any numbers as an outline with holes: triangles of its points, within its box, never a crash or a hang.
#include <cmath>
#include <cstdint>
#include <cstring>

#include "require.hpp"
#include "world/city/footprint.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    Footprint footprint;
    std::vector<Eigen::Vector2d>* ring = &footprint.outer;
    // Pairs of bytes are places on a coarse grid, where points repeat and edges cross; 255 255 begins a hole.
    for (std::size_t i = 0; i + 1 < size; i += 2) {
        if (data[i] == 255 && data[i + 1] == 255)
            ring = &footprint.holes.emplace_back();
        else
            ring->emplace_back(data[i], data[i + 1]);
    }
    std::size_t points = footprint.outer.size();
    for (const auto& hole : footprint.holes)
        points += hole.size();
    for (const auto& triangle : triangulated(footprint))
        for (const std::uint32_t corner : triangle)
            require(corner < points);
    CityModel city;
    const bool added = add_extruded(city, footprint, 0, 10);
    require(added == !city.triangles.empty());
    for (const CityTriangle& triangle : city.triangles)
        for (const std::uint32_t corner : triangle.corners)
            require(city.vertices.at(corner).allFinite());
    return 0;
}
