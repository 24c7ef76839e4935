#include "world/gnss/signal.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::sys_days gps_epoch = 1980y / 1 / 6;
constexpr int last_prn = 32;

enum class Block { iir_m, iif_or_iii };

// A satellite under a PRN from its launch on, or where it had been launched long before, from when it got that PRN.
struct Satellite {
    int prn;
    std::chrono::sys_days from;
    Block block;
};

// Blocks IIR-M and IIF as in GPS World's almanac of active satellites (2018; launches in UTC), PRN 1 as in the IGS
// satellite metadata (SATELLITE/PRN), Block III by its announced launches. In order of PRN and time; a PRN that is not
// here has been of Block IIR or before so far. Left out are the months when SVN 49 tested other PRNs, unhealthy.
constexpr std::array launched{
    Satellite{1, 2009y / 3 / 24, Block::iir_m},         // SVN 49
    Satellite{1, 2011y / 7 / 16, Block::iif_or_iii},    // SVN 63
    Satellite{1, 2024y / 4 / 22, Block::iir_m},         // SVN 49
    Satellite{1, 2024y / 12 / 17, Block::iif_or_iii},   // SVN 80
    Satellite{3, 2014y / 10 / 29, Block::iif_or_iii},   // SVN 69
    Satellite{4, 2018y / 12 / 23, Block::iif_or_iii},   // SVN 74
    Satellite{5, 2009y / 8 / 17, Block::iir_m},         // SVN 50
    Satellite{6, 2014y / 5 / 17, Block::iif_or_iii},    // SVN 67
    Satellite{7, 2008y / 3 / 15, Block::iir_m},         // SVN 48
    Satellite{8, 2015y / 7 / 15, Block::iif_or_iii},    // SVN 72
    Satellite{9, 2014y / 8 / 2, Block::iif_or_iii},     // SVN 68
    Satellite{10, 2015y / 10 / 31, Block::iif_or_iii},  // SVN 73
    Satellite{11, 2021y / 6 / 17, Block::iif_or_iii},   // SVN 78
    Satellite{12, 2006y / 11 / 17, Block::iir_m},       // SVN 58
    Satellite{14, 2020y / 11 / 5, Block::iif_or_iii},   // SVN 77
    Satellite{15, 2007y / 10 / 17, Block::iir_m},       // SVN 55
    Satellite{17, 2005y / 9 / 26, Block::iir_m},        // SVN 53
    Satellite{18, 2019y / 8 / 22, Block::iif_or_iii},   // SVN 75
    Satellite{21, 2025y / 5 / 30, Block::iif_or_iii},   // SVN 81
    Satellite{23, 2020y / 6 / 30, Block::iif_or_iii},   // SVN 76
    Satellite{24, 2012y / 10 / 4, Block::iif_or_iii},   // SVN 65
    Satellite{25, 2010y / 5 / 28, Block::iif_or_iii},   // SVN 62
    Satellite{26, 2015y / 3 / 25, Block::iif_or_iii},   // SVN 71
    Satellite{27, 2013y / 5 / 15, Block::iif_or_iii},   // SVN 66
    Satellite{28, 2023y / 1 / 18, Block::iif_or_iii},   // SVN 79
    Satellite{29, 2007y / 12 / 20, Block::iir_m},       // SVN 57
    Satellite{30, 2014y / 2 / 21, Block::iif_or_iii},   // SVN 64
    Satellite{31, 2006y / 9 / 25, Block::iir_m},        // SVN 52
    Satellite{32, 2016y / 2 / 5, Block::iif_or_iii},    // SVN 70
};

// The rows of a PRN are [first_row[prn], first_row[prn + 1]).
constexpr auto first_row = [] {
    std::array<std::size_t, last_prn + 2> first{};
    for (std::size_t prn = 0; prn < first.size(); ++prn) {
        while (first[prn] < launched.size() && launched[first[prn]].prn < static_cast<int>(prn))
            ++first[prn];
    }
    return first;
}();

}  // namespace

bool gps_sends(int prn, Signal signal, GpsTime when) {
    if (signal == Signal::l1 || prn > last_prn) return true;
    const auto n = static_cast<std::size_t>(prn);
    const std::chrono::nanoseconds since_epoch = when.time_since_epoch();
    for (std::size_t row = first_row.at(n + 1); row > first_row.at(n); --row) {
        const Satellite& s = launched.at(row - 1);
        if (s.from - gps_epoch <= since_epoch) return signal == Signal::l2 || s.block == Block::iif_or_iii;
    }
    return false;
}

namespace {

// A delay of the first carrier as the second carrier of its pair has it: it grows with the square of the frequencies'
// ratio.
double second_carrier_delay(double delay, Signal second) {
    const double ratio = carrier_frequency_l1 / carrier_frequency(second).value();
    return delay * ratio * ratio;
}

// The broadcast tells the delay of S band, which is not emulated.
double navic_l5_delay(double delay_of_s_band) {
    constexpr double carrier_frequency_s = 2492.028e6;
    const double ratio = carrier_frequency_s / carrier_frequency_l5;
    return delay_of_s_band * ratio * ratio;
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
            return signal == Signal::l5 ? std::optional(navic_l5_delay(record.tgd)) : std::nullopt;
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

// What the combination of two signals without ionosphere is late against the record's clock, s.
double pair_delay(const Ephemeris& record, Signal first, Signal second) {
    const auto d1 = group_delay(record, first), d2 = group_delay(record, second);
    if (!d1 || !d2) return 0;
    const double ratio = carrier_frequency(first).value() / carrier_frequency(second).value();
    const double square = ratio * ratio;
    return (square * d1->value() - d2->value()) / (square - 1);
}

// The same as pair_delay() of the pair that tables of clocks belong to.
double table_pair_delay(const Ephemeris& record) {
    switch (satellite_of(record).constellation) {
        case Constellation::beidou:
            return pair_delay(record, Signal::b1i, Signal::b3i);
        case Constellation::glonass:
            return pair_delay(record, Signal::g1, Signal::g2);
        case Constellation::galileo: {
            // Of E1 and E5a a record has what E1 alone differs from the pair, whichever pair its clock belongs to.
            const auto* kepler = std::get_if<KeplerEphemeris>(&record);
            if (kepler == nullptr || kepler->message == NavigationMessage::almanac) return 0;
            return kepler_delay(*kepler, Signal::l1).value_or(0) - kepler->tgd;
        }
        default:
            return 0;
    }
}

constexpr int first_of_beidou_3 = 19;

// B2I is BeiDou-2's alone: on that carrier BeiDou-3 sends B2b, another signal.
bool sends_signal(SatelliteId satellite, Signal signal, GpsTime when) {
    if (satellite.constellation == Constellation::gps) return gps_sends(satellite.number, signal, when);
    if (satellite.constellation != Constellation::beidou) return true;
    if (signal == Signal::e5b) return satellite.number < first_of_beidou_3;
    return signal != Signal::l5 || sends_modern_signals(satellite);
}

}  // namespace

bool sends_modern_signals(SatelliteId beidou) { return beidou.number >= first_of_beidou_3 && !is_beidou_geo(beidou); }

std::span<const Signal> emulated_signals(Constellation constellation) {
    static constexpr std::array gps{Signal::l1, Signal::l2, Signal::l5};
    static constexpr std::array galileo{Signal::l1, Signal::e5b, Signal::l5};
    static constexpr std::array beidou{Signal::b1i, Signal::e5b, Signal::b3i, Signal::l5};
    static constexpr std::array glonass{Signal::g1, Signal::g2};
    static constexpr std::array sbas{Signal::l1};
    static constexpr std::array navic{Signal::l5};
    static constexpr std::array<std::span<const Signal>, constellation_names.size()> all{gps, sbas,    galileo, beidou,
                                                                                         gps, glonass, navic};
    return all[static_cast<std::size_t>(constellation)];
}

Signal first_signal(Constellation constellation) { return emulated_signals(constellation).front(); }

std::optional<Signal> second_signal(Constellation constellation, SecondBand band) {
    const std::span<const Signal> others = emulated_signals(constellation).subspan(1);
    if (others.empty()) return std::nullopt;
    if (band == SecondBand::l2) return others.front();
    return others.back() == Signal::l5 ? std::optional(Signal::l5) : std::nullopt;
}

Hertz carrier_frequency(Signal signal, int frequency_channel) {
    if (signal == Signal::g1) return Hertz(1602e6 + 562.5e3 * frequency_channel);
    if (signal == Signal::g2) return Hertz(1246e6 + 437.5e3 * frequency_channel);
    // In the order of Signal.
    static constexpr std::array<double, 7> without_channels{
        carrier_frequency_l1, carrier_frequency_l2, carrier_frequency_l5, 1207.14e6, 1278.75e6, 1561.098e6, 1268.52e6};
    return Hertz(without_channels[static_cast<std::size_t>(signal)]);
}

std::optional<std::string_view> rinex_signal_codes(Constellation constellation, Signal signal) {
    struct Codes {
        Constellation constellation;
        Signal signal;
        std::string_view codes;
    };
    using enum Constellation;
    static constexpr std::array<Codes, 17> all{{{gps, Signal::l1, "1CPWYSLXMD"},
                                                {gps, Signal::l2, "2LXSWPCDYM"},
                                                {gps, Signal::l5, "5QXI"},
                                                {qzss, Signal::l1, "1CESLXZB"},
                                                {qzss, Signal::l2, "2LXS"},
                                                {qzss, Signal::l5, "5QXIPZD"},
                                                {galileo, Signal::l1, "1CXBZA"},
                                                {galileo, Signal::e5b, "7QXI"},
                                                {galileo, Signal::l5, "5QXI"},
                                                {beidou, Signal::b1i, "2IXQ"},
                                                {beidou, Signal::e5b, "7IXQ"},
                                                {beidou, Signal::b3i, "6IXQA"},
                                                {beidou, Signal::l5, "5PXD"},
                                                {glonass, Signal::g1, "1CP"},
                                                {glonass, Signal::g2, "2CP"},
                                                {sbas, Signal::l1, "1C"},
                                                {navic, Signal::l5, "5AXCB"}}};
    for (const Codes& c : all)
        if (c.constellation == constellation && c.signal == signal) return c.codes;
    return std::nullopt;
}

std::optional<std::string_view> rinex_signal_code(Constellation constellation, Signal signal) {
    const auto codes = rinex_signal_codes(constellation, signal);
    return codes ? std::optional(codes->substr(0, 2)) : std::nullopt;
}

TransmittedSignals transmitted_signals(const Ephemeris& record) {
    const auto* glonass = std::get_if<GlonassEphemeris>(&record);
    const int channel = glonass ? glonass->frequency_channel : 0;
    TransmittedSignals signals;
    const SatelliteId satellite = satellite_of(record);
    for (const Signal signal : emulated_signals(satellite.constellation))
        if (sends_signal(satellite, signal, toe_of(record)))
            signals.push_back(
                {signal, carrier_frequency(signal, channel), sent_group_delay(record, signal).value_or(Seconds(0))});
    return signals;
}

std::optional<Seconds> group_delay(const Ephemeris& record, Signal signal) {
    std::optional<double> delay;
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) delay = kepler_delay(*kepler, signal);
    if (const auto* glonass = std::get_if<GlonassEphemeris>(&record)) delay = state_vector_delay(*glonass, signal);
    if (std::holds_alternative<SbasEphemeris>(record) && (signal == Signal::l1 || signal == Signal::l5)) delay = 0.0;
    if (!delay) return std::nullopt;
    return Seconds(*delay);
}

std::optional<Seconds> sent_group_delay(const Ephemeris& record, Signal signal) {
    const auto told = group_delay(record, signal);
    if (told) return told;
    const auto emulated = emulated_signals(satellite_of(record).constellation);
    if (std::find(emulated.begin(), emulated.end(), signal) == emulated.end()) return std::nullopt;
    return Seconds(0);
}

std::optional<Seconds> table_group_delay(const Ephemeris& record, Signal signal) {
    const auto delay = group_delay(record, signal);
    if (!delay) return std::nullopt;
    return Seconds(delay->value() - table_pair_delay(record));
}

Seconds table_clock_delay(const Ephemeris& record) { return Seconds(table_pair_delay(record)); }

DbHz cn0_under_interference(DbHz cn0, Decibels jammer_to_signal, const InterferenceRejection& rejection) {
    const double noise = std::pow(10, -cn0.value() / 10);
    const double jammer =
        std::pow(10, jammer_to_signal.value() / 10) / (rejection.quality * rejection.chip_rate.value());
    return DbHz(-10 * std::log10(noise + jammer));
}

}  // namespace skyloop::inline world
