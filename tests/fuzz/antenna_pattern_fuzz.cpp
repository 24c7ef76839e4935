// Any bytes as an antenna's table: a clear error, or finite gains in every direction.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "world/propagation/antenna_and_noise.hpp"

namespace {

void expect(bool promise) {
    if (!promise) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const auto pattern = AntennaPattern::parse({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (!pattern) {
        expect(pattern.error().code == ErrorCode::input && pattern.error().message.starts_with("fuzz.csv:"));
        return 0;
    }
    for (const double azimuth : {0.0, 123.0, 359.9})
        for (const double elevation : {-90.0, 0.0, 12.3, 90.0})
            expect(std::isfinite(pattern->gain({Angle::degrees(azimuth), Angle::degrees(elevation)}).value()));
    return 0;
}
