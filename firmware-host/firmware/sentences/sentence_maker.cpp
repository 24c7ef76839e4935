#include "firmware/sentences/sentence_maker.hpp"

#include <algorithm>

namespace skyloop::firmware {

std::vector<BoardSentence> board_sentences(const BoardProfile& board) {
    std::vector<BoardSentence> sentences;
    for (const UbxMessageId id : board.messages) {
        const auto* const found = std::ranges::find(nmea_sentence_ids, id.id);
        if (id.message_class == class_nmea && found != std::end(nmea_sentence_ids))
            sentences.push_back({id, static_cast<std::size_t>(found - std::begin(nmea_sentence_ids))});
    }
    return sentences;
}

std::optional<UbxMessageId> sentence_message(std::string_view name) {
    const auto* const found = std::ranges::find(nmea_sentence_names, name);
    if (found == std::end(nmea_sentence_names)) return std::nullopt;
    return UbxMessageId{class_nmea, nmea_sentence_ids[found - std::begin(nmea_sentence_names)]};
}

std::uint64_t factory_rate(const BoardProfile& board, std::size_t sentence) {
    const auto found = std::ranges::find(board.sentences, static_cast<NmeaSentence>(sentence), &SentenceRate::sentence);
    return found == board.sentences.end() ? 0 : static_cast<std::uint64_t>(found->every_epochs);
}

bool is_due(const BoardSentence& sentence, std::uint64_t every, const EpochMessages& made,
            const FirmwareFaults& faults) {
    return every != 0 && made.state().epoch_index % every == 0 && !faults.withheld.contains(sentence.id);
}

SentenceMaker::SentenceMaker(const BoardProfile& board, const ReceiverOptions& options, bool reports_dead_reckoning,
                             std::span<const OwnSetting> own)
    : Maker(board),
      settings_(board, options, own),
      sentences_(board_sentences(board)),
      reports_dead_reckoning_(reports_dead_reckoning) {}

const ReceiverConfig& SentenceMaker::config() const {
    if (config_revision_ == settings_.revision()) return config_;
    config_ = settings_.config();
    config_.reports_dead_reckoning = reports_dead_reckoning_;
    adjust(config_);
    config_revision_ = settings_.revision();
    return config_;
}

CommandOutcome SentenceMaker::receive(const StreamPiece&, const Situation&) { return {}; }

DueMessages SentenceMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages due;
    const PortConfig& of_port = config().port(port);
    if (!of_port.on || !of_port.out.nmea) return due;
    for (const BoardSentence& sentence : sentences_) {
        if (!is_due(sentence, settings_.value(SentenceSettings::rate(sentence.index, port)), made, faults)) continue;
        const std::vector<Bytes>& messages = made.of(sentence.id, port, {});
        due.frames.insert(due.frames.end(), messages.begin(), messages.end());
    }
    return due;
}

void SentenceMaker::restart(bool keeps_ram) {
    if (!keeps_ram) settings_.reload();
}

void SentenceMaker::forget_settings() {
    settings_.clear(in_battery | in_flash);
    settings_.reload();
}

}  // namespace skyloop::firmware
