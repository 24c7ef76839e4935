/// Any bytes as plans of QGroundControl: one clear line or a route that can be flown, never a crash or a hang.
#include "track_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return skyloop::read_any_track(data, size, "fuzz.plan");
}
