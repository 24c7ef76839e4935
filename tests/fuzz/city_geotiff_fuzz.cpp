/// Any bytes as a GeoTIFF: read or refused with a sentence; what is read is in range.
#include "city_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    return check_city(data, size, parse_geotiff);
}
