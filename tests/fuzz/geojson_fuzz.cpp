/// Any bytes as GeoJSON: one clear line or a sound city, never a crash or a hang.
#include "city_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return skyloop::check_city(data, size, skyloop::parse_geojson);
}
