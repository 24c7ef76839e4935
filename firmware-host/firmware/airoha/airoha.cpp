// Airoha's PAIR (RECEIVER.md 5.9). What a client sets outlives a restart; 513 saves it for good.
#include "firmware/airoha/airoha.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/core/number_text.hpp"
#include "firmware/sentences/numbered_commands.hpp"

namespace skyloop::firmware {
namespace {

constexpr ConfigLayers pair_layers = in_ram | in_battery;
constexpr ConfigLayers at_next_start = in_battery;

enum class PairResult { done = 0, in_process = 1, failed = 2, unsupported = 3, busy = 4 };

struct PairCommand : NumberedCommand {
    void acknowledge(PairResult result) { answer(fmt::format("PAIR001,{:03},{}", number, static_cast<int>(result))); }
};

// 002 and 003: satellites are tracked, or nothing but commands is heard.
void switch_positioning(PairCommand& c) {
    constexpr int on = 2;
    c.acknowledge(PairResult::done);
    c.outcome.navigating = c.number == on;
}

// 004 hot, 005 warm, 006 cold, 007 cold with factory settings. What is stored comes in force with the restart itself,
// so that its acknowledgement still leaves at the old speed.
void restart_pair(PairCommand& c) {
    constexpr int hot = 4, warm = 5, factory = 7;
    c.acknowledge(PairResult::done);
    const StartKind kind = c.number == hot ? StartKind::hot : c.number == warm ? StartKind::warm : StartKind::cold;
    c.outcome.reset = Reset{Reset::Kind::software, Forgotten::of(kind)};
    if (c.number == factory) c.store.clear(in_battery | in_flash);
}

// 020 and 021, each with the answers of its own number.
void tell_pair_version(PairCommand& c) {
    c.acknowledge(PairResult::done);
    for (Bytes& answer : version_answers(c.board, fmt::format("PAIR{:03}", c.number)))
        c.outcome.answers.push_back(std::move(answer));
}

void set_fix_interval(PairCommand& c) {
    constexpr int longest = 1000;
    const auto period = c.argument_within(0, 0, longest);
    const bool taken = period && c.set_fix_interval(pair_layers, *period);
    c.acknowledge(taken ? PairResult::done : PairResult::failed);
}

void tell_fix_interval(PairCommand& c) {
    c.acknowledge(PairResult::done);
    c.answer(fmt::format("PAIR051,{}", c.store.value(SentenceSettings::fix_interval_ms)));
}

constexpr std::array<std::string_view, 10> sentence_types{"GGA", "GLL", "GSA", "GSV", "RMC",
                                                          "VTG", "ZDA", "GRS", "GST", "GNS"};

// The type asked for and its item; all of them for −1. Nothing of what is no type.
std::map<int, std::uint32_t> asked_types(const PairCommand& c) {
    constexpr int all = -1;
    std::map<int, std::uint32_t> items;
    const auto asked = c.argument(0);
    for (int type = 0; asked && type < static_cast<int>(sentence_types.size()); ++type) {
        if (*asked != all && *asked != type) continue;
        if (const auto item = c.sentence_item(sentence_types[static_cast<std::size_t>(type)])) items[type] = *item;
    }
    return items;
}

void set_sentence_rate(PairCommand& c) {
    constexpr int most = 20;
    const auto items = asked_types(c);
    const auto rate = c.argument_within(1, 0, most);
    if (items.empty() || !rate) return c.acknowledge(PairResult::failed);
    for (const auto& [type, item] : items)
        c.store.set(pair_layers, item, static_cast<std::uint64_t>(*rate));
    c.acknowledge(PairResult::done);
}

void tell_sentence_rate(PairCommand& c) {
    const auto items = asked_types(c);
    if (items.empty()) return c.acknowledge(PairResult::failed);
    c.acknowledge(PairResult::done);
    for (const auto& [type, item] : items)
        c.answer(fmt::format("PAIR063,{},{}", type, c.store.value(item)));
}

// 066,gps,glonass,galileo,beidou,qzss,navic: in force after the next start.
void set_pair_systems(PairCommand& c) {
    constexpr Constellation in_order[] = {Constellation::gps,    Constellation::glonass, Constellation::galileo,
                                          Constellation::beidou, Constellation::qzss,    Constellation::navic};
    std::vector<std::pair<Constellation, bool>> wanted;
    for (std::size_t i = 0; i < std::size(in_order) && i < c.sentence.fields.size(); ++i) {
        const auto on = c.argument_within(i, 0, 1);
        if (!on) return c.acknowledge(PairResult::failed);
        wanted.emplace_back(in_order[i], *on == 1);
    }
    const bool taken = !wanted.empty() && c.set_systems(at_next_start, wanted);
    c.acknowledge(taken ? PairResult::done : PairResult::failed);
}

// Airoha's modes and the dynamic models that come nearest: 0 normal, 1 fitness, 4 at rest, 5 drone, 7 swimming.
struct NavigationMode {
    int mode;
    std::uint64_t dynamic_model;
};
constexpr NavigationMode navigation_modes[] = {{0, 0}, {1, 3}, {4, 2}, {5, 8}, {7, 3}};

void set_navigation_mode(PairCommand& c) {
    const auto mode = c.argument(0);
    const auto* row = std::ranges::find(navigation_modes, mode.value_or(-1), &NavigationMode::mode);
    if (row == std::end(navigation_modes)) return c.acknowledge(PairResult::failed);
    c.store.set(pair_layers, SentenceSettings::dynamic_model, row->dynamic_model);
    c.acknowledge(PairResult::done);
}

void set_pair_corrections(PairCommand& c) {
    const auto source = c.argument_within(0, 0, 2);
    if (!source) return c.acknowledge(PairResult::failed);
    set_correction_source(c.store, c.from, static_cast<AidingSource>(*source));
    c.acknowledge(PairResult::done);
}

void set_pair_sbas(PairCommand& c) {
    const auto on = c.argument_within(0, 0, 1);
    const bool good = on && c.set_systems(pair_layers, {{Constellation::sbas, *on == 1}});
    c.acknowledge(good ? PairResult::done : PairResult::failed);
}

// What waits for the next start is saved too.
void save_pair(PairCommand& c) {
    for (const auto& [item, value] : c.store.values(ConfigLayer::ram))
        c.store.keep(item, c.store.stored(ConfigLayer::battery, item).value_or(value));
    c.acknowledge(PairResult::done);
}

// 864,0,0,baud: in force after the next start.
void set_pair_speed(PairCommand& c) {
    const auto baud = c.argument(2);
    if (c.argument(0) != 0 || c.argument(1) != 0 || !baud || *baud <= 0 ||
        !takes_baud(c.board, static_cast<std::uint64_t>(*baud)))
        return c.acknowledge(PairResult::failed);
    c.store.set(at_next_start, c.speed_item(), static_cast<std::uint64_t>(*baud));
    c.acknowledge(PairResult::done);
}

// 382: keeps the system from sleeping. Not emulated beyond the sleep after a start.
void lock_sleep(PairCommand& c) { c.acknowledge(c.argument_within(0, 0, 1) ? PairResult::done : PairResult::failed); }

constexpr CommandRow<PairCommand> pair_rows[] = {
    {2, switch_positioning}, {3, switch_positioning},   {4, restart_pair},       {5, restart_pair},
    {6, restart_pair},       {7, restart_pair},         {20, tell_pair_version}, {21, tell_pair_version},
    {50, set_fix_interval},  {51, tell_fix_interval},   {62, set_sentence_rate}, {63, tell_sentence_rate},
    {66, set_pair_systems},  {80, set_navigation_mode}, {382, lock_sleep},       {400, set_pair_corrections},
    {410, set_pair_sbas},    {513, save_pair},          {864, set_pair_speed},
};

// Its command processor sleeps for a while after a start, while sentences flow: hosts repeat PAIR382,1 until that is
// acknowledged (meshtastic/firmware, variants/nrf52840/tracker-t1000-e).
class AirohaMaker : public NumberedCommandMaker {
public:
    AirohaMaker(const BoardProfile& board, const ReceiverOptions& options)
        : NumberedCommandMaker(board, options, execute_pair), asleep_(options.power_up && has_sleep()) {}

    CommandOutcome receive(const StreamPiece& piece, const Situation& asked) override {
        if (asleep_ && !to_string(piece.bytes).starts_with("$PAIR382,1*")) return {};
        asleep_ = false;
        return NumberedCommandMaker::receive(piece, asked);
    }
    void follow(const NavigationState& state, GpsTime) override {
        if (state.since_boot >= board().timing.command_sleep) asleep_ = false;
    }
    void restart(bool keeps_ram) override {
        asleep_ = has_sleep();
        NumberedCommandMaker::restart(keeps_ram);
    }

private:
    [[nodiscard]] bool has_sleep() const { return board().timing.command_sleep > Seconds(0); }
    bool asleep_;
};

}  // namespace

CommandOutcome execute_pair(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                            PortId from) {
    const auto number = command_number(sentence, "PAIR");
    if (!number) return {};
    PairCommand command{{sentence, board, store, from, *number}};
    const auto* row = std::ranges::find(pair_rows, *number, &CommandRow<PairCommand>::number);
    if (row == std::end(pair_rows))
        command.acknowledge(PairResult::unsupported);
    else
        row->execute(command);
    return command.outcome;
}

std::unique_ptr<Maker> make_airoha(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<AirohaMaker>(board, options);
}

Abilities airoha_abilities(const BoardProfile&) {
    return {.choice = Abilities::MessageChoice::rates, .time = true, .calendar = true, .own_prefix = "PAIR"};
}

}  // namespace skyloop::firmware
