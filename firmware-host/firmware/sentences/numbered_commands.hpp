/// What the numbered commands of MediaTek (PMTK) and Airoha (PAIR) have in common.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/sentences/sentence_maker.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

/// A command while it is answered.
struct NumberedCommand {
    const SentenceView& sentence;
    const BoardProfile& board;
    SentenceSettings& store;
    PortId from;
    int number = 0;
    CommandOutcome outcome{};

    [[nodiscard]] std::optional<int> argument(std::size_t i) const;
    /// Nothing as well for one that is not among least … most.
    [[nodiscard]] std::optional<int> argument_within(std::size_t i, int least, int most) const;
    /// @param body of a sentence, without "$" and checksum
    void answer(const std::string& body);
    /// The time between two fixes, ms. False, and nothing changed, for one that the board cannot do.
    bool set_fix_interval(ConfigLayers layers, int period);
    /// The rate of a sentence on the port; nothing for a name that stands for none.
    [[nodiscard]] std::optional<std::uint32_t> sentence_item(std::string_view name) const;
    /// The speed of the port, of UART1 where it has none.
    [[nodiscard]] std::uint32_t speed_item() const;
    /// False, and nothing changed, when none of the major systems would be left, or too many.
    bool set_systems(ConfigLayers layers, const std::vector<std::pair<Constellation, bool>>& wanted);
};

/// A row of the tables that say which function executes which command.
template <class Command>
struct CommandRow {
    int number;
    void (*execute)(Command&);
};

/// Sends sentences, and works off numbered commands.
class NumberedCommandMaker : public SentenceMaker {
public:
    using Execute = CommandOutcome (*)(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                                       PortId from);
    NumberedCommandMaker(const BoardProfile& board, const ReceiverOptions& options, Execute execute)
        : SentenceMaker(board, options), execute_(execute) {}
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;

private:
    Execute execute_;
};

/// The number of a command behind the maker's prefix, 0 … 999.
std::optional<int> command_number(const SentenceView& sentence, std::string_view prefix);

/// Where corrections come from, as MediaTek and Airoha number it.
enum class AidingSource { none = 0, rtcm = 1, sbas = 2 };
AidingSource correction_source(const SentenceSettings& store, PortId from);
void set_correction_source(SentenceSettings& store, PortId from, AidingSource source);

/// The board's version answers that begin with "$" and `prefix`, as sentences.
std::vector<Bytes> version_answers(const BoardProfile& board, std::string_view prefix);

}  // namespace skyloop::firmware
