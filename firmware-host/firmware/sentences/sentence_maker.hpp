/// What receivers that send sentences have in common.
#pragma once

#include <vector>

#include "firmware/core/maker.hpp"
#include "firmware/sentences/sentence_settings.hpp"

namespace skyloop::firmware {

/// A sentence that a board can send.
struct BoardSentence {
    UbxMessageId id;
    std::size_t index;  ///< in nmea_sentence_names
};
/// In the order in which they leave.
std::vector<BoardSentence> board_sentences(const BoardProfile& board);
/// The id of a sentence, "GGA"; nothing for a name that stands for none.
std::optional<UbxMessageId> sentence_message(std::string_view name);
/// Every how many epochs the board sends one from the factory on; 0: never.
std::uint64_t factory_rate(const BoardProfile& board, std::size_t sentence);
/// Whether a sentence leaves with an epoch. @param every so many
bool is_due(const BoardSentence& sentence, std::uint64_t every, const EpochMessages& made,
            const FirmwareFaults& faults);

/// Sends sentences by their rates, and understands nothing. State: settings.
class SentenceMaker : public Maker {
public:
    SentenceMaker(const BoardProfile& board, const ReceiverOptions& options, bool reports_dead_reckoning = true,
                  std::span<const OwnSetting> own = {});

    [[nodiscard]] const ReceiverConfig& config() const override;
    [[nodiscard]] std::uint64_t revision() const override { return settings_.revision(); }
    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override;
    DueMessages due(PortId port, EpochMessages& made, const FirmwareFaults& faults) override;
    void restart(bool keeps_ram) override;
    void lose_battery() override { settings_.clear(in_battery); }
    void forget_settings() override;
    void set_speed(std::uint32_t baud) override { settings_.set(in_ram, SentenceSettings::baud(PortId::uart1), baud); }
    [[nodiscard]] bool takes_speed(std::uint32_t baud) const override { return takes_baud(board(), baud); }
    [[nodiscard]] std::string stored_text() const override { return settings_.persistent_text(); }
    Result<void> restore(const std::string& text, const std::string& name) override {
        return settings_.restore(text, name);
    }

protected:
    [[nodiscard]] SentenceSettings& settings() { return settings_; }
    [[nodiscard]] const SentenceSettings& settings() const { return settings_; }
    /// Puts in what a maker's own settings say, after all the others.
    virtual void adjust(ReceiverConfig&) const {}

private:
    SentenceSettings settings_;
    std::vector<BoardSentence> sentences_;
    bool reports_dead_reckoning_;
    mutable ReceiverConfig config_;
    mutable std::optional<std::uint64_t> config_revision_;
};

}  // namespace skyloop::firmware
