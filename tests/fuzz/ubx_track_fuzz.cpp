// The corpus begins with messages of a UBX receiver.
#include "flight_track_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skyloop::read_any_flight({data, size});
    return 0;
}
