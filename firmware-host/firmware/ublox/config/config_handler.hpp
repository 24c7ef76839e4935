/// What a client configures: both ways, on one store.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/units.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/core/receiver_config.hpp"
#include "firmware/ublox/config/config_store.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {

/// What is said to a configuration message.
enum class Verdict {
    silence,      ///< nothing at all
    acknowledge,  ///< ACK-ACK
    refuse,       ///< ACK-NAK
};

/// What came of a configuration message: answers go out before the verdict.
struct ConfigOutcome {
    std::vector<Bytes> answers;  ///< whole frames
    Verdict verdict = Verdict::refuse;
    Seconds work{0};  ///< that the receiver needs before it answers, over its usual delay (flash, restart of tracking)
    std::vector<std::string> warnings{};  ///< texts that say why it refuses
};

/// CFG-VALSET, CFG-VALGET and CFG-VALDEL with their transactions (RECEIVER.md 3.4, 4.4).
/// State: the open transaction.
class ValueConfig {
public:
    ValueConfig(const BoardProfile& board, ConfigStore& store) : board_(board), store_(store) {}

    ConfigOutcome valset(ByteSpan payload);
    ConfigOutcome valget(ByteSpan payload);
    ConfigOutcome valdel(ByteSpan payload);
    /// Another configuration message came between: an open transaction is dropped.
    void cancel() { transaction_.reset(); }

private:
    /// What one message, or a transaction of several, is to change.
    struct Change {
        std::uint8_t layers = 0;
        bool deleting = false;
        ConfigValues items;  ///< when deleting, the values mean nothing
    };
    /// Does now what a message asks for, or adds it to a transaction.
    ConfigOutcome take(std::uint8_t transaction, Change change);
    ConfigOutcome apply(const Change& change);
    [[nodiscard]] ConfigOutcome refused_in_ram(const ConfigValues& ram) const;
    /// False, and nothing is forgotten, when that would spoil the next start.
    bool erase(const Change& change);
    /// The items that a wildcard means, or the one of this id; nothing when there is none.
    [[nodiscard]] std::vector<std::uint32_t> expanded(std::uint32_t key) const;
    [[nodiscard]] bool is_settable(std::uint32_t key, std::uint64_t value) const;
    [[nodiscard]] bool is_locked(const ConfigValues& items) const;

    const BoardProfile& board_;
    ConfigStore& store_;
    std::optional<Change> transaction_;
};

/// The legacy messages of class CFG, read from and written to the store (RECEIVER.md 3.3). Knows CFG-PRT, MSG, INF,
/// RATE, CFG, RXM, ANT, SBAS, NMEA, USB, ODO, NAVX5, NAV5, TP5, ITFM, GNSS, DGNSS, TMODE3, PMS and LOGFILTER; the board
/// says which of them it has, and which it only pretends to take.
class LegacyConfig {
public:
    LegacyConfig(const BoardProfile& board, ConfigStore& store) : board_(board), store_(store) {}

    /// A poll or a setting. @param from the port it came in by
    ConfigOutcome handle(UbxMessageId message, ByteSpan payload, PortId from);

private:
    const BoardProfile& board_;
    ConfigStore& store_;
};

/// The versions of NMEA as CFG-NMEA-PROTVER and as CFG-NMEA number them (F9 interface description, CFG-NMEA).
struct NumberedNmeaVersion {
    NmeaVersion version;
    std::uint8_t item, wire;
};
inline constexpr std::array<NumberedNmeaVersion, 5> numbered_nmea_versions{{{NmeaVersion::v2_1, 21, 0x21},
                                                                            {NmeaVersion::v2_3, 23, 0x23},
                                                                            {NmeaVersion::v4_0, 40, 0x40},
                                                                            {NmeaVersion::v4_10, 41, 0x41},
                                                                            {NmeaVersion::v4_11, 42, 0x4B}}};
/// By CFG-NMEA-MAINTALKERID. 0: by the systems; 6 stands for GI, which no receiver here has.
inline constexpr std::array<std::string_view, 8> numbered_talkers{"", "GP", "GL", "GN", "GA", "GB", "", "GQ"};

/// Whether VALGET and VALSET know an item, on a board that stores it.
bool is_on_the_wire(const BoardProfile& board, std::uint32_t key);

/// The factory configuration of a board: every item that it has.
ConfigValues factory_config(const BoardProfile& board);
/// The same with what a run's options change of it.
ConfigValues initial_config(const BoardProfile& board, const ReceiverOptions& options);

/// What the store says. Items that are as the factory left them leave `base` as it is.
ReceiverConfig receiver_config(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base = {});
/// Its part for measurement and solution.
ReceiverSettings settings_of(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base);

/// Whether values may stand together in RAM: each in its range, at least one major system enabled, a signal plan that
/// the board can track (RECEIVER.md 4.4).
bool is_consistent(const BoardProfile& board, const ConfigValues& ram);
/// The last of these: bands that go together, signals that exclude each other, the number of systems.
bool is_signal_plan(const BoardProfile& board, const ConfigValues& values);
/// Whether what is kept could not stand together at the next start, and did before.
bool spoils_start(const BoardProfile& board, const ConfigStore& before, const ConfigStore& after);
/// Whether one value is in the range of its item: enumerations, logicals, the board's speeds and rates.
bool is_in_range(const BoardProfile& board, std::uint32_t key, std::uint64_t value);
/// The first item whose value is not; null: all are.
const ConfigValues::value_type* first_out_of_range(const BoardProfile& board, const ConfigValues& values);

}  // namespace skyloop::firmware
