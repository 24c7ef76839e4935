#include "detail/observation_columns.hpp"

#include <algorithm>
#include <string_view>

namespace skyloop::rinex {
namespace {

// A band of a system and the attributes of its codes, the best first (RINEX 3.05, tables 12 to 18). In version 2 the
// band alone names the observation, and P is a code of its own.
struct SignalBand {
    Constellation system;
    Signal signal;
    char band;
    std::string_view attributes;
};

using enum Constellation;
constexpr std::array signal_bands{
    SignalBand{gps, Signal::l1, '1', "CPWYSLXMD"}, SignalBand{gps, Signal::l2, '2', "LXSWPCDYM"},
    SignalBand{gps, Signal::l5, '5', "QXI"},       SignalBand{qzss, Signal::l1, '1', "CESLXZB"},
    SignalBand{qzss, Signal::l2, '2', "LXS"},      SignalBand{qzss, Signal::l5, '5', "QXIPZD"},
    SignalBand{galileo, Signal::l1, '1', "CXBZA"}, SignalBand{galileo, Signal::e5b, '7', "QXI"},
    SignalBand{galileo, Signal::l5, '5', "QXI"},   SignalBand{beidou, Signal::b1i, '2', "IXQ"},
    SignalBand{beidou, Signal::e5b, '7', "IXQ"},   SignalBand{beidou, Signal::b3i, '6', "IXQA"},
    SignalBand{beidou, Signal::l5, '5', "PXD"},    SignalBand{glonass, Signal::g1, '1', "CP"},
    SignalBand{glonass, Signal::g2, '2', "CP"},    SignalBand{sbas, Signal::l1, '1', "C"},
    SignalBand{navic, Signal::l5, '5', "AXCB"},
};

int column_of(std::span<const std::string> types, const std::string& type) {
    const auto found = std::find(types.begin(), types.end(), type);
    return found == types.end() ? -1 : static_cast<int>(found - types.begin());
}

void add_code(std::vector<CodeColumns>& codes, std::span<const std::string> types, char range,
              const std::string& code) {
    const CodeColumns c{column_of(types, range + code), column_of(types, "L" + code), column_of(types, "D" + code),
                        column_of(types, "S" + code)};
    if (c.pseudorange >= 0 || c.phase >= 0 || c.doppler >= 0) codes.push_back(c);
}

// Version 2: "C1" and "P1" share phase, Doppler and strength.
void add_codes_of_version_2(std::vector<CodeColumns>& codes, std::span<const std::string> types, const SignalBand& b) {
    const auto add_band = [&](char band) {
        const bool precise_first = b.signal == Signal::l2;
        add_code(codes, types, precise_first ? 'P' : 'C', std::string(1, band));
        add_code(codes, types, precise_first ? 'C' : 'P', std::string(1, band));
    };
    add_band(b.band);
    if (b.signal == Signal::b1i) add_band('1');
}

}  // namespace

std::vector<SignalColumns> signal_columns(Constellation system, std::span<const std::string> types, double version) {
    std::vector<SignalColumns> result;
    for (const SignalBand& b : signal_bands) {
        if (b.system != system) continue;
        SignalColumns signal{b.signal, {}};
        if (version < 3) {
            add_codes_of_version_2(signal.codes, types, b);
        } else {
            for (const char attribute : b.attributes)
                add_code(signal.codes, types, 'C', std::string{b.band, attribute});
            // From 3.03 on "1X" is B1C.
            if (b.signal == Signal::b1i)
                for (const char attribute : std::string_view(version < 3.025 ? "IXQ" : "I"))
                    add_code(signal.codes, types, 'C', std::string{'1', attribute});
        }
        if (!signal.codes.empty()) result.push_back(std::move(signal));
    }
    std::sort(result.begin(), result.end(),
              [](const SignalColumns& a, const SignalColumns& b) { return a.signal < b.signal; });
    return result;
}

}  // namespace skyloop::rinex
