/// What tests of readers share.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>

#include "world/city/city_file.hpp"

namespace skyloop::test {

inline std::size_t count_of(const CityModel& city, SurfaceKind kind) {
    std::size_t count = 0;
    for (const CityTriangle& triangle : city.triangles)
        count += triangle.kind == kind ? 1 : 0;
    return count;
}

/// Of all triangles, m².
inline double area_of(const CityModel& city) {
    double area = 0;
    for (const CityTriangle& triangle : city.triangles) {
        const auto& [a, b, c] = triangle.corners;
        area +=
            0.5 * (city.vertices.at(b) - city.vertices.at(a)).cross(city.vertices.at(c) - city.vertices.at(a)).norm();
    }
    return area;
}

/// The place of the highest corner.
inline Eigen::Vector3d highest_of(const CityModel& city) {
    Eigen::Vector3d highest(0, 0, -1e9);
    for (const Eigen::Vector3d& vertex : city.vertices)
        if (vertex.z() > highest.z()) highest = vertex;
    return highest;
}

/// Everything of a model is in range.
inline void expect_sound(const CityFile& file) {
    EXPECT_FALSE(file.model.triangles.empty());
    for (const Eigen::Vector3d& vertex : file.model.vertices)
        EXPECT_TRUE(vertex.allFinite());
    for (const CityTriangle& triangle : file.model.triangles) {
        EXPECT_LT(triangle.material, file.model.materials.size());
        for (const std::uint32_t corner : triangle.corners)
            EXPECT_LT(corner, file.model.vertices.size());
    }
}

/// The sentence of a failure with `input`; a success fails the test.
inline std::string refusal(const Result<CityFile>& result) {
    EXPECT_FALSE(result) << "was read";
    if (result) return "";
    EXPECT_EQ(result.error().code, ErrorCode::input);
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << "more than one line";
    return result.error().message;
}

inline bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace skyloop::test
