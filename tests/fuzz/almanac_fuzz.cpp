// Any bytes as an almanac: a clear error or usable records, never a crash, a hang or an orbit that is no number.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/almanac_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto records = read_almanac(text, "fuzz.alm", to_gps_time(2243, 0.0));
    if (!records) {
        const std::string& message = records.error().message;
        require(records.error().code == ErrorCode::input && message.starts_with("fuzz.alm:"));
        require(message.find('\n') == std::string::npos);
        return 0;
    }
    require(!records->empty() && is_almanac(text));
    for (const KeplerEphemeris& record : *records) {
        const SatelliteState state = satellite_state(record, record.toe + std::chrono::hours(100));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
        require(std::isfinite(state.clock_bias));
    }
    const NavigationData orbits({records->begin(), records->end()}, std::nullopt, "fuzz.alm");
    require(orbits.satellites_at(records->front().toe) > 0);
    return 0;
}
