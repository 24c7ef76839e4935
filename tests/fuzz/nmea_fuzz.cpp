// NMEA: any byte stream through the parser, the decoders and back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/nmea_pubx.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const NmeaFormat format{.version = NmeaVersion::v4_11};
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    for (std::string line; std::getline(stream, line);) {
        const auto sentence = parse_sentence(line);
        if (!sentence) continue;
        // What we write we must be able to read.
        const auto message = decode_nmea(*sentence);
        if (message && !decode_nmea(encode(*message, format))) std::abort();
        const auto pubx = decode_pubx(*sentence);
        if (!pubx) continue;
        const std::string again = std::visit([&](const auto& m) { return encode(m, format); }, *pubx);
        const auto reread = parse_sentence(again);
        if (!reread || !decode_pubx(*reread)) std::abort();
    }
    (void)decode_nmea(std::string_view(reinterpret_cast<const char*>(data), size));
    return 0;
}
