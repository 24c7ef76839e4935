/// Any bytes as OpenStreetMap, XML or PBF: one clear line or a sound city, never a crash or a hang.
#include "city_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    return check_city(data, size, [](std::string_view bytes, std::string_view name, const CityFileSettings& settings) {
        return parse_osm(bytes, bytes.starts_with("<") ? "osm" : "osm.pbf", name, settings);
    });
}
