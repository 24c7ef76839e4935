// Any bytes as OpenStreetMap, XML or PBF: one clear line or a sound city, never a crash or a hang.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "skyloop/city/city_file.hpp"

namespace {

void require(bool promise) {
    if (!promise) std::abort();
}

void check(const skyloop::Result<skyloop::CityFile>& file) {
    using namespace skyloop;
    if (!file) {
        const std::string& message = file.error().message;
        require(file.error().code == ErrorCode::input && message.starts_with("fuzz"));
        require(message.find('\n') == std::string::npos);
        return;
    }
    const CityModel& city = file->model;
    require(!city.triangles.empty() || !city.foliage.empty());
    for (const Eigen::Vector3d& vertex : city.vertices)
        require(vertex.allFinite());
    for (const CityTriangle& triangle : city.triangles) {
        for (const std::uint32_t corner : triangle.corners)
            require(corner < city.vertices.size());
        require(triangle.material < city.materials.size());
    }
    for (const FoliageVolume& foliage : city.foliage)
        require(foliage.ring.size() >= 3 && foliage.base < foliage.top);
    for (const std::string& warning : file->warnings)
        require(warning.find('\n') == std::string::npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const bool xml = text.starts_with("<");
    check(skyloop::parse_osm(text, xml ? "osm" : "osm.pbf", "fuzz", {}));
    return 0;
}
