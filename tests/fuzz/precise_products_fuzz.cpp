// Any bytes as a RINEX clock file, a SINEX file of biases and an ANTEX file: a clear error or tables that can be used,
// never a crash, a hang or a value that is no number.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "world/gnss/signal.hpp"
#include "world/rinex/antenna_file.hpp"
#include "world/rinex/bias_file.hpp"
#include "world/rinex/clock_file.hpp"

namespace {

using namespace skyloop;

void require_clear(const Error& error) {
    require(error.code == ErrorCode::input && error.message.starts_with("fuzz:"));
    require(error.message.find('\n') == std::string::npos);
}

void use(const PreciseClocks& clocks) {
    require(clocks.spacing() > Nanoseconds(0));
    for (const auto& [satellite, rows] : clocks.samples())
        for (const GpsTime time :
             {rows.front().time, rows.back().time, rows.front().time + (rows.back().time - rows.front().time) / 3}) {
            const auto reading = clocks.at(satellite, time);
            require(!reading || (std::isfinite(reading->bias) && std::isfinite(reading->drift)));
        }
}

void use(const CodeBiases& biases) {
    for (const Constellation c : {Constellation::gps, Constellation::galileo, Constellation::glonass})
        for (const Signal signal : emulated_signals(c)) {
            const auto bias = biases.of({c, 1}, signal, to_gps_time(2111, 0));
            require(!bias || std::isfinite(bias->value()));
        }
}

void use(const AntennaCatalogue& antennas) {
    for (const auto& [name, antenna] : antennas.receivers)
        for (const Signal signal : {Signal::l1, Signal::g2}) {
            const PhaseCentre* const centre = antenna.at(Constellation::glonass, signal);
            if (centre == nullptr) continue;
            require(centre->offset.allFinite());
            for (const double angle : {-10.0, 0.0, 33.3, 720.0})
                require(std::isfinite(centre->variation(Angle::degrees(angle), Angle::degrees(angle)).value()));
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto look = [&](auto read) {
        const auto file = read(text, "fuzz");
        file ? use(*file) : require_clear(file.error());
    };
    look(read_clocks);
    look(read_biases);
    look(read_antennas);
    return 0;
}
