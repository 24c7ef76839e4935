#include "firmware/nmea_commands.hpp"

#include <algorithm>
#include <cmath>

#include "base/core/number_in.hpp"
#include "firmware/config/config_handler.hpp"
#include "firmware/config/signal_keys.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t rtcm3_protocol = 4;
// CFG-SBAS-USE_DIFFCORR (F9 interface description HPG 1.32).
constexpr std::uint32_t sbas_corrections = 0x1036'0004;

std::uint32_t enable_key(Constellation constellation) {
    for (const SystemKeys& system : system_keys_of_signals)
        if (system.constellation == constellation) return system.enable;
    return 0;
}

}  // namespace

CommandOutcome execute_sentence(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store,
                                PortId from) {
    switch (board.personality) {
        case Personality::mute:
        case Personality::msp:
        case Personality::msp_v1:
        case Personality::mavlink:
        case Personality::sbf:
            return {};
        case Personality::ublox:
            return execute_ublox(sentence, board, store, from);
        case Personality::mtk:
            return execute_pmtk(sentence, board, store, from);
        case Personality::airoha:
            return execute_pair(sentence, board, store, from);
    }
    return {};
}

std::optional<int> NumberedCommand::argument(std::size_t i) const { return number_in<int>(sentence.field(i)); }

void NumberedCommand::answer(const std::string& body) { outcome.answers.push_back(to_bytes(Sentence(body).finish())); }

int least_fix_interval(const BoardProfile& board) {
    return std::max(board.least_measurement_period_ms, static_cast<int>(std::ceil(1000.0 / board.max_rate_hz - 1e-6)));
}

std::vector<Bytes> version_answers(const BoardProfile& board, std::string_view prefix) {
    std::vector<Bytes> answers;
    for (const std::string_view answer : board.identity.version_answers)
        if (answer.starts_with('$') && answer.substr(1).starts_with(prefix))
            answers.push_back(to_bytes(Sentence(answer.substr(1)).finish()));
    return answers;
}

AidingSource correction_source(const ConfigStore& store, PortId from) {
    if (store.flag(sbas_corrections) && store.flag(enable_key(Constellation::sbas))) return AidingSource::sbas;
    return store.flag(key::in_protocol(from, rtcm3_protocol)) ? AidingSource::rtcm : AidingSource::none;
}

void set_correction_source(ConfigStore& store, PortId from, AidingSource source) {
    constexpr ConfigLayers layers = in_ram | in_battery;
    store.set(layers, sbas_corrections, source == AidingSource::sbas);
    store.set(layers, key::in_protocol(from, rtcm3_protocol), source == AidingSource::rtcm);
    if (source == AidingSource::sbas) store.set(layers, enable_key(Constellation::sbas), 1);
}

bool set_systems(const BoardProfile& board, ConfigStore& store, ConfigLayers layers,
                 const std::vector<std::pair<Constellation, bool>>& wanted) {
    ConfigValues after = store.values(ConfigLayer::ram);
    for (const auto& [constellation, on] : wanted)
        if (const auto item = after.find(enable_key(constellation)); item != after.end())
            item->second = on;
        else if (on)
            return false;
    if (!is_consistent(board, after)) return false;
    for (const auto& [constellation, on] : wanted)
        store.set(layers, enable_key(constellation), on);
    return true;
}

}  // namespace skyloop::firmware
