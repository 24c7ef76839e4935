// Any bytes as an SP3 file: a clear error or a table that can be interpolated, never a crash, a hang or a position that
// is no number.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "world/rinex/precise_orbit_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto file = read_precise_orbits(text, "fuzz.sp3");
    if (!file) {
        const std::string& message = file.error().message;
        require(file.error().code == ErrorCode::input && message.starts_with("fuzz.sp3:"));
        require(message.find('\n') == std::string::npos);
        return 0;
    }
    require(file->epochs >= 2 && file->orbits.spacing() > Nanoseconds(0));
    for (const auto& [satellite, samples] : file->orbits.samples())
        for (const GpsTime time : {samples.front().time, samples.back().time,
                                   samples.front().time + (samples.back().time - samples.front().time) / 3}) {
            const auto state = file->orbits.state(satellite, time);
            require(!state || (state->position.vector().allFinite() && state->velocity.vector().allFinite()));
            require(!state || !state->clock_bias || std::isfinite(*state->clock_bias));
        }
    return 0;
}
