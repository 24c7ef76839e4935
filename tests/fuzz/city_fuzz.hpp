/// What every reader of cities must hold, whatever the bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "require.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {

using CityParser = Result<CityFile> (*)(std::string_view, std::string_view, const CityFileSettings&);

inline void require_sound_model(const CityModel& model, const CityFileSettings& settings) {
    require(!model.triangles.empty() || !model.foliage.empty());
    require(model.triangles.size() <= settings.most_triangles);
    for (const Eigen::Vector3d& vertex : model.vertices)
        require(vertex.allFinite());
    for (const CityTriangle& triangle : model.triangles) {
        require(triangle.material < model.materials.size());
        for (const std::uint32_t corner : triangle.corners)
            require(corner < model.vertices.size());
    }
    for (const FoliageVolume& foliage : model.foliage)
        require(foliage.ring.size() >= 3 && foliage.base < foliage.top);
}

/// Aborts where a failure is not one sentence that names the file, a warning has more lines than one, a model is empty
/// or has more triangles than allowed, or a number is out of range.
inline int check_city(const std::uint8_t* data, std::size_t size, CityParser parse) {
    if (size > 100'000) return 0;
    CityFileSettings settings;
    settings.most_triangles = 20'000;
    const auto file = parse({reinterpret_cast<const char*>(data), size}, "fuzz", settings);
    if (!file) {
        const std::string& message = file.error().message;
        require(file.error().code == ErrorCode::input && message.starts_with("fuzz"));
        require(message.find('\n') == std::string::npos);
        return 0;
    }
    require_sound_model(file->model, settings);
    for (const std::string& warning : file->warnings)
        require(warning.find('\n') == std::string::npos);
    doubts_about(file->model);
    return 0;
}

}  // namespace skyloop
