#include "detail/signal_traits.hpp"

#include <algorithm>

namespace skyloop {
namespace {

constexpr double boc_jitter_ratio = 0.6;

std::string_view name_of(Signal signal) {
    switch (signal) {
        case Signal::l1:
            return "L1";
        case Signal::l2:
            return "L2";
        case Signal::l5:
            return "L5";
        case Signal::e5b:
            return "E5b";
        case Signal::e6:
            return "E6";
        case Signal::b1i:
            return "B1I";
        case Signal::b3i:
            return "B3I";
        case Signal::g1:
            return "G1";
        case Signal::g2:
            return "G2";
    }
    return "";
}

double chip_rate_ratio_of(Signal signal) {
    switch (signal) {
        case Signal::l5:
        case Signal::e5b:
        case Signal::b3i:
            return 10;
        case Signal::e6:
            return 5;
        case Signal::b1i:
            return 2;
        case Signal::g1:
        case Signal::g2:
            return 0.511 / 1.023;
        case Signal::l1:
        case Signal::l2:
            break;
    }
    return 1;
}

}  // namespace

SignalTraits signal_traits(Constellation constellation, Signal signal) {
    SignalTraits traits{chip_rate_ratio_of(signal), 1, false, false};
    const bool galileo = constellation == Constellation::galileo;
    traits.boc = galileo && signal == Signal::l1;
    if (traits.boc) traits.jitter_ratio = boc_jitter_ratio;
    const bool navic = constellation == Constellation::navic;
    traits.pilot = galileo || signal == Signal::l2 || (signal == Signal::l5 && !navic);
    if (navic) traits.chip_rate_ratio = 1;  // SPS: BPSK(1) on L5 (IRNSS SIS ICD 1.1)
    if (constellation == Constellation::beidou && signal == Signal::e5b) traits.chip_rate_ratio = 2;  // B2I
    return traits;
}

CodeLoop code_loop_for(const CodeLoop& loop, const SignalTraits& traits) {
    CodeLoop result = loop;
    result.chip_rate = loop.chip_rate * traits.chip_rate_ratio;
    if (traits.chip_rate_ratio > 1)
        result.front_end_bandwidth = std::max(loop.front_end_bandwidth, result.chip_rate * 2);
    return result;
}

std::string signal_stream_name(std::string_view process, SatelliteId satellite, Signal signal) {
    std::string name(process);
    name += '.';
    name += to_string(satellite);
    name += '.';
    name += name_of(signal);
    return name;
}

}  // namespace skyloop
