#include "firmware/sentences/numbered_commands.hpp"

#include <cmath>

#include "base/core/number_text.hpp"

namespace skyloop::firmware {

std::optional<int> NumberedCommand::argument(std::size_t i) const { return number_in<int>(sentence.field(i)); }

void NumberedCommand::answer(const std::string& body) { outcome.answers.push_back(to_bytes(Sentence(body).finish())); }

std::optional<int> NumberedCommand::argument_within(std::size_t i, int least, int most) const {
    const auto value = argument(i);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

bool NumberedCommand::set_fix_interval(ConfigLayers layers, int period) {
    const int least =
        std::max(board.least_measurement_period_ms, static_cast<int>(std::ceil(1000.0 / board.max_rate_hz - 1e-6)));
    if (period < least) return false;
    store.set(layers, SentenceSettings::fix_interval_ms, static_cast<std::uint64_t>(period));
    return true;
}

std::optional<std::uint32_t> NumberedCommand::sentence_item(std::string_view name) const {
    return SentenceSettings::rate(name, from);
}

std::uint32_t NumberedCommand::speed_item() const {
    return SentenceSettings::baud(from == PortId::uart2 ? PortId::uart2 : PortId::uart1);
}

bool NumberedCommand::set_systems(ConfigLayers layers, const std::vector<std::pair<Constellation, bool>>& wanted) {
    if (!store.can_have(wanted)) return false;
    for (const auto& [constellation, on] : wanted)
        store.set(layers, SentenceSettings::system(constellation), on);
    return true;
}

CommandOutcome NumberedCommandMaker::receive(const StreamPiece& piece, const Situation& asked) {
    const std::string text = to_string(piece.bytes);
    if (piece.kind != StreamKind::nmea) return {};
    const auto sentence = parse_sentence(text);
    return sentence ? execute_(*sentence, board(), settings(), asked.from) : CommandOutcome{};
}

std::optional<int> command_number(const SentenceView& sentence, std::string_view prefix) {
    if (!sentence.address.starts_with(prefix)) return std::nullopt;
    const auto number = number_in<int>(sentence.address.substr(prefix.size()));
    return number && *number >= 0 && *number <= 999 ? number : std::nullopt;
}

std::vector<Bytes> version_answers(const BoardProfile& board, std::string_view prefix) {
    std::vector<Bytes> answers;
    for (const std::string_view answer : board.identity.version_answers)
        if (answer.starts_with('$') && answer.substr(1).starts_with(prefix))
            answers.push_back(to_bytes(Sentence(answer.substr(1)).finish()));
    return answers;
}

AidingSource correction_source(const SentenceSettings& store, PortId from) {
    const bool sbas = store.flag(SentenceSettings::system(Constellation::sbas));
    if (store.flag(SentenceSettings::sbas_corrections) && sbas) return AidingSource::sbas;
    return store.flag(SentenceSettings::rtcm_in(from)) ? AidingSource::rtcm : AidingSource::none;
}

void set_correction_source(SentenceSettings& store, PortId from, AidingSource source) {
    constexpr ConfigLayers layers = in_ram | in_battery;
    store.set(layers, SentenceSettings::sbas_corrections, source == AidingSource::sbas);
    store.set(layers, SentenceSettings::rtcm_in(from), source == AidingSource::rtcm);
    if (source == AidingSource::sbas) store.set(layers, SentenceSettings::system(Constellation::sbas), 1);
}

}  // namespace skyloop::firmware
