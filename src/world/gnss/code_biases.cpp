#include "world/gnss/code_biases.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace skyloop::inline world {
namespace {

// The codes whose combination without ionosphere the clock belongs to.
struct ClockPair {
    Constellation constellation;
    std::string_view first, second;
    Signal first_signal, second_signal;
};
constexpr std::array clock_pairs{ClockPair{Constellation::gps, "C1W", "C2W", Signal::l1, Signal::l2},
                                 ClockPair{Constellation::galileo, "C1C", "C5Q", Signal::l1, Signal::l5},
                                 ClockPair{Constellation::galileo, "C1X", "C5X", Signal::l1, Signal::l5},
                                 ClockPair{Constellation::beidou, "C2I", "C6I", Signal::b1i, Signal::b3i},
                                 ClockPair{Constellation::glonass, "C1P", "C2P", Signal::g1, Signal::g2},
                                 ClockPair{Constellation::glonass, "C1C", "C2C", Signal::g1, Signal::g2},
                                 ClockPair{Constellation::qzss, "C1C", "C2L", Signal::l1, Signal::l2}};

using CodeValues = std::map<std::string_view, double>;

// Every code that differences lead to from one of them on, which counts as 0.
CodeValues joined_from(std::string_view start, const std::vector<const CodeBias*>& differences) {
    CodeValues values{{start, 0.0}};
    for (bool found = true; found;) {
        found = false;
        for (const CodeBias* d : differences) {
            const auto code = values.find(d->code), other = values.find(d->other);
            if ((code == values.end()) == (other == values.end())) continue;
            if (code == values.end())
                values[d->code] = other->second + d->seconds;
            else
                values[d->other] = code->second - d->seconds;
            found = true;
        }
    }
    return values;
}

CodeValues by_differences(Constellation constellation, const std::vector<const CodeBias*>& differences) {
    for (const ClockPair& pair : clock_pairs) {
        if (pair.constellation != constellation) continue;
        CodeValues values = joined_from(pair.first, differences);
        const auto second = values.find(pair.second);
        if (second == values.end()) continue;
        const double ratio =
            carrier_frequency(pair.first_signal).value() / carrier_frequency(pair.second_signal).value();
        // The pair's combination of 0 and of the second's value.
        const double combined = -second->second / (ratio * ratio - 1);
        for (auto& [code, value] : values)
            value -= combined;
        return values;
    }
    return {};
}

}  // namespace

std::optional<Seconds> CodeBiases::of(SatelliteId satellite, Signal signal, GpsTime time) const {
    const auto own = biases_.find(satellite);
    const auto codes = rinex_signal_codes(satellite.constellation, signal);
    if (own == biases_.end() || !codes) return std::nullopt;
    CodeValues singles;
    std::vector<const CodeBias*> differences;
    for (const CodeBias& bias : own->second) {
        if (time < bias.from || (bias.until && time >= *bias.until)) continue;
        if (bias.other.empty())
            singles[bias.code] = bias.seconds;
        else
            differences.push_back(&bias);
    }
    const CodeValues values = singles.empty() ? by_differences(satellite.constellation, differences) : singles;
    for (const char attribute : codes->substr(1)) {
        const std::string code{'C', codes->front(), attribute};
        if (const auto found = values.find(code); found != values.end()) return Seconds(found->second);
    }
    return std::nullopt;
}

}  // namespace skyloop::inline world
