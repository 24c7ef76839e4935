/// Any bytes, first of all logs of a UBX receiver: one clear line or sound rows, never a crash or a hang.
#include "track_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return skyloop::read_any_track(data, size, "fuzz.log");
}
