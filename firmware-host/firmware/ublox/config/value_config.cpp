#include <algorithm>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "firmware/ublox/config/signal_keys.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::size_t most_items_of_an_answer = 64;
// Tracking starts anew in between (RECEIVER.md 4.2: 20 to 100 ms before the answer).
constexpr Seconds signal_change_work{0.05};
constexpr std::uint32_t lock_key = 0x10F60009, unlocked_group_1 = 0x30F6000A, unlocked_group_2 = 0x30F6000B;
constexpr std::uint32_t whole_group = 0xFFFF;

// Actions of a transaction (F9 interface description, section 3.10.26.2).
enum : std::uint8_t { no_transaction = 0, begin_transaction = 1, continue_transaction = 2, apply_transaction = 3 };

std::uint32_t group_of(std::uint32_t key) { return key >> 16 & 0xFF; }

// Everything: 0x0FFFFFFF, or 0x0FFF0000, which ArduPilot sends. Size bits are left aside.
bool means_everything(std::uint32_t key) {
    const std::uint32_t item = key & 0xFFFF;
    return (key & 0x8FFF'0000u) == 0x0FFF'0000u && (item == whole_group || item == 0);
}

bool means_a_group(std::uint32_t key) { return (key & 0x8F00'FFFFu) == whole_group; }

ConfigOutcome verdict(Verdict said) { return {.answers = {}, .verdict = said, .work = Seconds(0)}; }
ConfigOutcome refused() { return verdict(Verdict::refuse); }

std::optional<ConfigLayer> layer_of_number(std::uint8_t number) {
    for (const ConfigLayer layer : {ConfigLayer::ram, ConfigLayer::battery, ConfigLayer::flash, ConfigLayer::factory})
        if (static_cast<std::uint8_t>(layer) == number) return layer;
    return std::nullopt;
}

// What a board without these messages says to them; nothing when it has them.
std::optional<ConfigOutcome> answer_without_support(const BoardProfile& board) {
    switch (board.quirks.value_config) {
        case ValueConfigSupport::full:
            return std::nullopt;
        case ValueConfigSupport::refuse:
            return refused();
        case ValueConfigSupport::silence:
            break;
    }
    return verdict(Verdict::silence);
}

// None without a place to keep values in.
bool are_layers_of(const BoardProfile& board, ConfigLayers layers, ConfigLayers known) {
    if (!has_flash(board)) known &= static_cast<ConfigLayers>(~in_flash);
    return layers != 0 && (layers & ~known) == 0;
}

bool is_known_form(std::uint8_t version, std::uint8_t transaction) {
    return version == 0 || (version == 1 && transaction <= apply_transaction);
}

}  // namespace

std::vector<std::uint32_t> ValueConfig::expanded(std::uint32_t key) const {
    std::vector<std::uint32_t> items;
    const bool everything = means_everything(key);
    if (!everything && !means_a_group(key)) {
        if (is_on_the_wire(board_, key) && store_.has(key)) items.push_back(key);
        return items;
    }
    for (const auto& [item, value] : store_.values(ConfigLayer::factory))
        if ((everything || group_of(item) == group_of(key)) && is_on_the_wire(board_, item)) items.push_back(item);
    return items;
}

bool ValueConfig::is_settable(std::uint32_t key, std::uint64_t value) const {
    return is_on_the_wire(board_, key) && store_.has(key) && is_in_range(board_, key, value);
}

// A lock leaves up to two groups open (F9 interface description, CFG-SEC-CFG_LOCK).
bool ValueConfig::is_locked(const ConfigValues& items) const {
    if (!store_.flag(lock_key)) return false;
    return std::any_of(items.begin(), items.end(), [this](const auto& item) {
        const std::uint32_t group = group_of(item.first);
        return group != store_.value(unlocked_group_1) && group != store_.value(unlocked_group_2);
    });
}

ConfigOutcome ValueConfig::valset(ByteSpan payload) {
    if (const auto answer = answer_without_support(board_)) return *answer;
    const auto message = decode_payload<CfgValset>(payload);
    constexpr ConfigLayers known_layers = in_ram | in_battery | in_flash;
    const bool good = message && is_known_form(message->version, message->transaction) &&
                      are_layers_of(board_, message->layers, known_layers);
    if (!good) return cancel(), refused();
    Change change{.layers = message->layers, .deleting = false, .items = {}};
    for (const ConfigPair& pair : message->pairs) {
        const bool too_old =
            message->version == 0 && pair.key == key::health_l5 && board_.quirks.l5_health_by_version_1;
        if (too_old || !is_settable(pair.key, pair.value)) return cancel(), refused();
        change.items[pair.key] = cut_to_size(pair.key, pair.value);
    }
    return take(message->version == 0 ? std::uint8_t{no_transaction} : message->transaction.raw, std::move(change));
}

ConfigOutcome ValueConfig::valdel(ByteSpan payload) {
    if (const auto answer = answer_without_support(board_)) return *answer;
    const auto message = decode_payload<CfgValdel>(payload);
    constexpr ConfigLayers known_layers = in_battery | in_flash;
    const bool good = message && is_known_form(message->version, message->transaction) &&
                      are_layers_of(board_, message->layers, known_layers);
    if (!good) return cancel(), refused();
    Change change{.layers = message->layers, .deleting = true, .items = {}};
    for (const std::uint32_t key : message->keys) {
        const auto items = expanded(key);
        if (items.empty()) return cancel(), refused();
        for (const std::uint32_t item : items)
            change.items[item] = 0;
    }
    return take(message->version == 0 ? std::uint8_t{no_transaction} : message->transaction.raw, std::move(change));
}

ConfigOutcome ValueConfig::take(std::uint8_t transaction, Change change) {
    if (transaction == no_transaction) return cancel(), apply(change);
    if (transaction == begin_transaction) {
        if (is_locked(change.items)) return cancel(), refused();
        transaction_ = std::move(change);
        return verdict(Verdict::acknowledge);
    }
    const bool fits =
        transaction_ && transaction_->layers == change.layers && transaction_->deleting == change.deleting;
    if (!fits || is_locked(change.items)) return cancel(), refused();
    for (const auto& [key, value] : change.items)
        transaction_->items[key] = value;
    if (transaction == continue_transaction) return verdict(Verdict::acknowledge);
    const Change whole = std::move(*transaction_);
    return cancel(), apply(whole);
}

bool ValueConfig::erase(const Change& change) {
    ConfigStore after = store_;
    for (const auto& [key, value] : change.items)
        after.erase(change.layers, key);
    if (spoils_start(board_, store_, after)) return false;
    store_ = std::move(after);
    return true;
}

// As a ZED-F9P and an EVK-M101 word it (boards/README.md).
ConfigOutcome ValueConfig::refused_in_ram(const ConfigValues& ram) const {
    ConfigOutcome outcome = refused();
    if (!is_signal_plan(board_, ram)) outcome.warnings = {"inv sig cfg", "bad cfg RAM"};
    return outcome;
}

ConfigOutcome ValueConfig::apply(const Change& change) {
    if (is_locked(change.items)) return refused();
    ConfigOutcome outcome = verdict(Verdict::acknowledge);
    if ((change.layers & in_flash) && !change.items.empty()) outcome.work += board_.timing.flash_write;
    if (change.deleting) return erase(change) ? outcome : refused();
    ConfigValues ram = store_.values(ConfigLayer::ram);
    for (const auto& [key, value] : change.items)
        ram[key] = value;
    if ((change.layers & in_ram) && !is_consistent(board_, ram)) return refused_in_ram(ram);
    if (change.layers & (in_battery | in_flash)) {
        ConfigStore after = store_;
        for (const auto& [key, value] : change.items)
            after.set(change.layers, key, value);
        if (spoils_start(board_, store_, after)) return refused();
    }
    for (const auto& [key, value] : change.items) {
        const std::uint64_t before = store_.value(key);
        store_.set(change.layers, key, value);
        if (group_of(key) == signal_group && store_.value(key) != before)
            outcome.work = std::max(outcome.work, signal_change_work);
    }
    return outcome;
}

ConfigOutcome ValueConfig::valget(ByteSpan payload) {
    if (const auto answer = answer_without_support(board_)) return *answer;
    cancel();
    const auto message = decode_payload<CfgValgetPoll>(payload);
    const auto layer = message ? layer_of_number(message->layer) : std::nullopt;
    if (!layer || message->version != 0 || message->keys.empty()) return refused();
    if (board_.quirks.single_key_valget && message->keys.size() > 1) return refused();
    std::vector<ConfigPair> found;
    for (const std::uint32_t key : message->keys) {
        const auto items = expanded(key);
        // A group without items is not unknown: a ZED-F9P answers 0x1031FFFF and 0x1032FFFF with what group 31 has.
        if (items.empty() && !means_a_group(key)) return refused();
        for (const std::uint32_t item : items)
            if (const auto value = store_.stored(*layer, item)) found.push_back({item, *value});
    }
    const bool past_end = message->position >= found.size();
    if (found.empty() || (past_end && !board_.quirks.empty_valget_page)) return refused();
    const std::size_t skipped = std::min<std::size_t>(message->position, found.size());
    const std::size_t count = std::min(found.size() - skipped, most_items_of_an_answer);
    CfgValget answer{.version = 1, .layer = message->layer, .position = message->position, .pairs = {}};
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(skipped);
    answer.pairs.assign(first, first + static_cast<std::ptrdiff_t>(count));
    ConfigOutcome outcome = verdict(Verdict::acknowledge);
    outcome.answers.push_back(encode_frame(answer));
    return outcome;
}

}  // namespace skyloop::firmware
