#include "skyloop/gnss/signal.hpp"

#include "skyloop/gnss/constants.hpp"

namespace skyloop {
namespace {

// A delay of the first carrier as the second carrier of its pair has it: it grows with the square of the frequencies'
// ratio.
double second_carrier_delay(double delay, Signal second) {
    const double ratio = carrier_frequency_l1 / carrier_frequency(second).value();
    return delay * ratio * ratio;
}

std::optional<double> galileo_delay(const KeplerEphemeris& record, Signal signal) {
    const bool fnav = record.message == NavigationMessage::fnav;
    const double delay = fnav ? record.tgd : record.tgd2;
    if (signal == Signal::l1) return delay;
    if (signal == (fnav ? Signal::l5 : Signal::e5b)) return second_carrier_delay(delay, signal);
    return std::nullopt;
}

std::optional<double> beidou_delay(const KeplerEphemeris& record, Signal signal) {
    if (signal == Signal::b1i) return record.tgd;
    if (signal == Signal::e5b) return record.tgd2;
    if (signal == Signal::b3i) return 0.0;
    return std::nullopt;
}

std::optional<double> kepler_delay(const KeplerEphemeris& record, Signal signal) {
    if (record.message == NavigationMessage::almanac) return 0.0;
    switch (record.satellite.constellation) {
        case Constellation::galileo:
            return galileo_delay(record, signal);
        case Constellation::beidou:
            return beidou_delay(record, signal);
        case Constellation::navic:
            return signal == Signal::l5 ? std::optional(record.tgd) : std::nullopt;
        default:
            if (signal == Signal::l1) return record.tgd;
            if (signal == Signal::l2) return second_carrier_delay(record.tgd, signal);
            return std::nullopt;
    }
}

std::optional<double> state_vector_delay(const GlonassEphemeris& record, Signal signal) {
    if (signal == Signal::g1) return 0.0;
    if (signal == Signal::g2) return -record.group_delay_l2;
    return std::nullopt;
}

}  // namespace

Signal first_signal(Constellation constellation) {
    switch (constellation) {
        case Constellation::beidou:
            return Signal::b1i;
        case Constellation::glonass:
            return Signal::g1;
        case Constellation::navic:
            return Signal::l5;
        default:
            return Signal::l1;
    }
}

Hertz carrier_frequency(Signal signal, int frequency_channel) {
    switch (signal) {
        case Signal::l1:
            return Hertz(carrier_frequency_l1);
        case Signal::l2:
            return Hertz(carrier_frequency_l2);
        case Signal::l5:
            return Hertz(carrier_frequency_l5);
        case Signal::e5b:
            return Hertz(1207.14e6);
        case Signal::e6:
            return Hertz(1278.75e6);
        case Signal::b1i:
            return Hertz(1561.098e6);
        case Signal::b3i:
            return Hertz(1268.52e6);
        case Signal::g1:
            return Hertz(1602e6 + 562.5e3 * frequency_channel);
        case Signal::g2:
            return Hertz(1246e6 + 437.5e3 * frequency_channel);
    }
    return Hertz(carrier_frequency_l1);
}

std::optional<Seconds> group_delay(const Ephemeris& record, Signal signal) {
    std::optional<double> delay;
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) delay = kepler_delay(*kepler, signal);
    if (const auto* glonass = std::get_if<GlonassEphemeris>(&record)) delay = state_vector_delay(*glonass, signal);
    if (std::holds_alternative<SbasEphemeris>(record) && (signal == Signal::l1 || signal == Signal::l5)) delay = 0.0;
    if (!delay) return std::nullopt;
    return Seconds(*delay);
}

}  // namespace skyloop
