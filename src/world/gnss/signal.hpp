/// Signals, their carriers and the group delays that broadcasts give for them.
/// Which blocks of satellites send under the PRNs of GPS, and with that which civil signals.
/// What a jammer leaves of a signal.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "base/core/std_additions.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// A carrier of one or more systems.
enum class Signal {
    l1,   ///< GPS, QZSS and SBAS L1, Galileo E1, BeiDou B1C
    l2,   ///< GPS and QZSS L2
    l5,   ///< GPS, QZSS, SBAS and NavIC L5, Galileo E5a, BeiDou B2a
    e5b,  ///< Galileo E5b, BeiDou B2I and B2b
    e6,   ///< Galileo E6, QZSS L6
    b1i,  ///< BeiDou B1I
    b3i,  ///< BeiDou B3I
    g1,   ///< GLONASS L1 by channel
    g2,   ///< GLONASS L2 by channel
};
/// As board and scenario files write them, in the order of Signal.
inline constexpr std::array<std::string_view, 9> signal_names{"L1", "L2", "L5", "E5b", "E6", "B1I", "B3I", "G1", "G2"};

/// The signal that a single-frequency receiver takes: L1, E1, B1I, G1; of NavIC L5.
Signal first_signal(Constellation constellation);

/// Whether a satellite of BeiDou sends B1C and B2a: BeiDou-3 does, from C19 on, without its geostationary ones
/// (BDS-SIS-ICD-B1C-1.0 and B2a-1.0, 1).
bool sends_modern_signals(SatelliteId beidou);

/// @param frequency_channel of GLONASS: 1602 + 0.5625 k and 1246 + 0.4375 k MHz (ICD L1, L2 GLONASS, table 3.1)
Hertz carrier_frequency(Signal signal, int frequency_channel = 0);

/// The signals that are emulated for a system, first first_signal(), then that of SecondBand::l2, where there is one:
/// L1, L2, L5; E1, E5b, E5a; B1I, B2I, B3I, B2a; G1, G2; of SBAS L1, of NavIC L5.
std::span<const Signal> emulated_signals(Constellation constellation);
inline constexpr std::size_t most_signals = 4;

/// The band of what a receiver of two frequencies tracks besides the first signals.
enum class SecondBand {
    l2,  ///< L2C, E5b, B2I, G2
    l5,  ///< L5, E5a, B2a
};

/// Nothing for a system that sends none in that band, or none besides its first.
std::optional<Signal> second_signal(Constellation constellation, SecondBand band);

/// The band of a signal in RINEX 3 observation codes, then the attributes that it may have, the best first
/// (RINEX 3.05, tables 12 to 18): "5QXI" of GPS L5 is 5Q, 5X and 5I. Nothing for a signal that is not emulated.
std::optional<std::string_view> rinex_signal_codes(Constellation constellation, Signal signal);
/// Band and attribute of the first of these, which is the one that u-blox receivers track: "1C" of GPS L1, L2C long,
/// E1-C, E5a-Q, E5b-Q, B2a's pilot.
std::optional<std::string_view> rinex_signal_code(Constellation constellation, Signal signal);

/// A signal as a satellite sends it.
struct TransmittedSignal {
    Signal signal = Signal::l1;
    Hertz carrier;
    Seconds group_delay;  ///< sent_group_delay()
};
using TransmittedSignals = InplaceVector<TransmittedSignal, most_signals>;

/// The emulated signals of the satellite of a record: of GPS what its block sends (gps_sends()); no B2I of BeiDou-3,
/// and B2a of its MEO and IGSO satellites alone.
/// @param record tells the GLONASS channel, the group delays and the time
TransmittedSignals transmitted_signals(const Ephemeris& record);

/// What a user of one signal subtracts from the broadcast clock, s, or nothing where the record does not tell.
/// GPS, QZSS: TGD, times (f1/f2)² for L2 (IS-GPS-200, 20.3.3.3.3.2). Galileo: BGD of the message's pair, times (f1/f)²
/// for the second of the pair (OS SIS ICD 2.0, 5.1.5). BeiDou: TGD1 for B1I, TGD2 for B2I, 0 for B3I (B1I ICD,
/// 5.2.4.10). GLONASS: 0 for G1, −Δτ_n for G2. SBAS: 0. Almanacs: 0.
std::optional<Seconds> group_delay(const Ephemeris& record, Signal signal);

/// What the emulated satellite's hardware delays a signal by against its clock: group_delay(), and 0 where the record
/// does not tell, as of GPS L5. Who sends and who solves take both this, so that they agree. Nothing for a signal that
/// is not emulated.
std::optional<Seconds> sent_group_delay(const Ephemeris& record, Signal signal);

/// The same as group_delay() of clocks in tables, as those of SP3 files. They belong to the combination without
/// ionosphere of L1 and L2, E1 and E5a, B1I and B3I, G1 and G2: of BeiDou, and of Galileo's I/NAV, another clock than
/// the broadcast's. (Over 36 satellites of 2023-01-01 BeiDou's clocks of CODE differ from the broadcast ones by 3.06
/// TGD1; the pair B1I and B3I gives 2.94.)
std::optional<Seconds> table_group_delay(const Ephemeris& record, Signal signal);

/// What the clock of such a table is behind that of the record: group_delay() less table_group_delay(), as far as the
/// record tells.
Seconds table_clock_delay(const Ephemeris& record);

/// Whether the satellite that has a PRN at a time sends L1, L2C or L5. Of the blocks, IIR-M is the first with L2C, IIF
/// the first with L5 (IS-GPS-200, IS-GPS-705). A satellite counts from its launch on; one that will come under a PRN of
/// today's Block IIR sends what that sends.
/// @param prn 1 … 32; above it: all signals
bool gps_sends(int prn, Signal signal, GpsTime when);

/// A jammer's spectrum against that of the signal: how well a correlator rejects it (MODELS.md 7.7, Q).
enum class JammerKind {
    narrow_band,  ///< Q 1
    matched,      ///< Q 1.5: the spectrum of the signal
    wide_band,    ///< Q 2.2
};
/// Its Q.
constexpr double rejection_quality(JammerKind kind) {
    return std::array{1.0, 1.5, 2.2}[static_cast<std::size_t>(kind)];
}

/// Power of a signal in an isotropic antenna that J/S refers to (MODELS.md 7.7).
inline constexpr DecibelWatts nominal_signal_power{-157};

/// How well a correlator rejects an interference (Kaplan and Hegarty, table of Q).
struct InterferenceRejection {
    double quality = 1.5;  ///< Q, rejection_quality()
    Hertz chip_rate{1.023e6};
};

/// Effective C/N0 under an interference J/S stronger than the signal:
/// −10 log10(10^(−C/N0/10) + 10^(J/S/10)/(Q R_c)) (Kaplan and Hegarty, Understanding GPS, chapter on interference;
/// MODELS.md 7.7).
DbHz cn0_under_interference(DbHz cn0, Decibels jammer_to_signal, const InterferenceRejection& rejection = {});

}  // namespace skyloop::inline world
