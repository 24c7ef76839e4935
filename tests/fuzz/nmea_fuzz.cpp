// NMEA: any byte stream through the splitter, the parser, the decoder and back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "skyloop/protocol/nmea_decode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const NmeaFormat format{.version = NmeaVersion::v4_11};
    SentenceSplitter splitter;
    for (const std::string& line : splitter.feed({data, size})) {
        const auto message = decode_nmea(line);
        if (!message) continue;
        // What we write we must be able to read.
        if (!decode_nmea(encode(*message, format))) std::abort();
    }
    (void)decode_nmea(std::string_view(reinterpret_cast<const char*>(data), size));
    return 0;
}
