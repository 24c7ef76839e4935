/// What every reader of cities must hold, whatever the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "skyloop/city/city_file.hpp"

namespace skyloop {

using CityParser = Result<CityFile> (*)(std::string_view, std::string_view, const CityFileSettings&);

/// Aborts where a failure has no sentence, a model more triangles than allowed, or a number out of range.
inline int check_city(const std::uint8_t* data, std::size_t size, CityParser parse) {
    if (size > 100'000) return 0;
    CityFileSettings settings;
    settings.most_triangles = 20'000;
    const auto file = parse({reinterpret_cast<const char*>(data), size}, "fuzz", settings);
    if (!file) {
        if (file.error().message.empty() || file.error().message.find('\n') != std::string::npos) std::abort();
        return 0;
    }
    const CityModel& model = file->model;
    if (model.triangles.empty() || model.triangles.size() > settings.most_triangles) std::abort();
    for (const Eigen::Vector3d& vertex : model.vertices)
        if (!vertex.allFinite()) std::abort();
    for (const CityTriangle& triangle : model.triangles) {
        if (triangle.material >= model.materials.size()) std::abort();
        for (const std::uint32_t corner : triangle.corners)
            if (corner >= model.vertices.size()) std::abort();
    }
    doubts_about(model);
    return 0;
}

}  // namespace skyloop
