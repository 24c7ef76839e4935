/// Any bytes as an IONEX file: read or refused with a sentence; what is read can be looked up everywhere.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "world/rinex/ionex_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto maps = read_ionex(text, "fuzz");
    if (!maps) {
        if (maps.error().message.empty()) std::abort();
        return 0;
    }
    for (int latitude = -90; latitude <= 90; latitude += 30)
        for (int longitude = -180; longitude <= 180; longitude += 45)
            for (const IonosphereMap& map : maps->maps)
                vertical_content(*maps, {Angle::degrees(latitude), Angle::degrees(longitude)},
                                 map.time + std::chrono::minutes(7));
    return 0;
}
