// The corpus begins with a log of PX4.
#include "log_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    skyloop::read_any_log({data, size});
    return 0;
}
