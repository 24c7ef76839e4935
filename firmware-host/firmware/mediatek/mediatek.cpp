// MediaTek's PMTK (RECEIVER.md 5.8). What a client sets outlives a restart, but not the battery.
#include "firmware/mediatek/mediatek.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/number_text.hpp"
#include "firmware/sentences/numbered_commands.hpp"

namespace skyloop::firmware {
namespace {

constexpr ConfigLayers pmtk_layers = in_ram | in_battery;

enum class PmtkFlag { invalid = 0, unsupported = 1, failed = 2, done = 3 };

struct PmtkCommand : NumberedCommand {
    void acknowledge(PmtkFlag flag, const std::string& more = {}) {
        answer(fmt::format("PMTK001,{},{}{}", number, static_cast<int>(flag), more));
    }
};

void accept_pmtk(PmtkCommand& c) { c.acknowledge(PmtkFlag::done); }

// 161: stopped (0) or asleep (1), which differ in what they draw.
void stand_by(PmtkCommand& c) {
    if (!c.argument_within(0, 0, 1)) return c.acknowledge(PmtkFlag::invalid);
    c.acknowledge(PmtkFlag::done);
    c.outcome.sleep = SleepRequest{.wakes = wake_by_every_pin | wake_by_usb};
}

// 101 hot, 102 warm, 103 cold, 104 cold with factory settings: no acknowledgement, the start sentences follow.
void restart_pmtk(PmtkCommand& c) {
    constexpr int hot = 101, warm = 102, factory = 104;
    const StartKind kind = c.number == hot ? StartKind::hot : c.number == warm ? StartKind::warm : StartKind::cold;
    c.outcome.reset = Reset{Reset::Kind::software, Forgotten::of(kind)};
    if (c.number != factory) return;
    c.store.clear(in_battery | in_flash);
    c.store.reload();
}

// 220 and 300: the time between two fixes, ms.
void set_interval(PmtkCommand& c) {
    constexpr int shortest = 100, longest = 10000;
    const auto period = c.argument_within(0, shortest, longest);
    if (!period) return c.acknowledge(PmtkFlag::invalid);
    c.acknowledge(c.set_fix_interval(pmtk_layers, *period) ? PmtkFlag::done : PmtkFlag::failed);
}

void tell_interval(PmtkCommand& c) {
    c.acknowledge(PmtkFlag::done);
    c.answer(fmt::format("PMTK500,{},0,0,0.0,0.0", c.store.value(SentenceSettings::fix_interval_ms)));
}

// 251: no acknowledgement, the new speed holds at once; 0 is the factory's.
void set_speed(PmtkCommand& c) {
    const auto baud = c.argument(0);
    const std::uint32_t item = c.speed_item();
    if (!baud || *baud < 0) return c.acknowledge(PmtkFlag::invalid);
    const std::uint64_t wanted =
        *baud == 0 ? c.store.stored(ConfigLayer::factory, item).value_or(0) : static_cast<std::uint64_t>(*baud);
    if (wanted == 0 || !takes_baud(c.board, wanted)) return c.acknowledge(PmtkFlag::invalid);
    c.store.set(pmtk_layers, item, wanted);
}

// The places of 314 and 514; those that are empty belong to sentences that are not emulated.
constexpr std::array<std::string_view, 19> sentence_places{
    "GLL", "RMC", "VTG", "GGA", "GSA", "GSV", "GRS", "GST", "", "", "", "", "", "", "", "", "", "ZDA", ""};

void set_sentences(PmtkCommand& c) {
    constexpr int most = 5;
    constexpr std::size_t fewest = 17;
    const auto& fields = c.sentence.fields;
    const bool defaults = fields.size() == 1 && fields[0] == "-1";
    if (!defaults && (fields.size() < fewest || fields.size() > sentence_places.size()))
        return c.acknowledge(PmtkFlag::invalid);
    for (std::size_t i = 0; !defaults && i < fields.size(); ++i)
        if (!c.argument_within(i, 0, most)) return c.acknowledge(PmtkFlag::invalid);
    for (std::size_t i = 0; i < sentence_places.size(); ++i) {
        const auto item = c.sentence_item(sentence_places[i]);
        if (!item || (!defaults && i >= fields.size())) continue;
        const std::uint64_t rate = defaults ? c.store.stored(ConfigLayer::factory, *item).value_or(0)
                                            : static_cast<std::uint64_t>(*c.argument(i));
        c.store.set(pmtk_layers, *item, rate);
    }
    c.acknowledge(PmtkFlag::done);
}

void tell_sentences(PmtkCommand& c) {
    std::string body = "PMTK514";
    for (std::size_t i = 0; i < sentence_places.size(); ++i) {
        const auto item = c.sentence_item(sentence_places[i]);
        body += fmt::format(",{}", item ? c.store.value(*item) : 0);
    }
    c.acknowledge(PmtkFlag::done);
    c.answer(body);
}

void set_corrections(PmtkCommand& c) {
    const auto source = c.argument_within(0, 0, 2);
    if (!source) return c.acknowledge(PmtkFlag::invalid);
    set_correction_source(c.store, c.from, static_cast<AidingSource>(*source));
    c.acknowledge(PmtkFlag::done);
}

void tell_corrections(PmtkCommand& c) {
    c.acknowledge(PmtkFlag::done);
    c.answer(fmt::format("PMTK501,{}", static_cast<int>(correction_source(c.store, c.from))));
}

void set_sbas(PmtkCommand& c) {
    const auto on = c.argument_within(0, 0, 1);
    if (!on) return c.acknowledge(PmtkFlag::invalid);
    const bool taken = c.set_systems(pmtk_layers, {{Constellation::sbas, *on == 1}});
    c.acknowledge(taken ? PmtkFlag::done : PmtkFlag::failed);
}

void tell_sbas(PmtkCommand& c) {
    c.acknowledge(PmtkFlag::done);
    c.answer(fmt::format("PMTK513,{}", c.store.value(SentenceSettings::system(Constellation::sbas))));
}

// 353,gps,glonass,galileo,galileo full,beidou.
void set_constellations(PmtkCommand& c) {
    constexpr Constellation in_order[] = {Constellation::gps, Constellation::glonass, Constellation::galileo,
                                          Constellation::galileo, Constellation::beidou};
    constexpr std::size_t full_galileo = 3;
    std::vector<std::pair<Constellation, bool>> wanted;
    std::string echo;
    for (std::size_t i = 0; i < std::size(in_order); ++i) {
        const bool given = i < c.sentence.fields.size();
        const auto on = given ? c.argument_within(i, 0, 1) : std::optional(0);
        if (!on) return c.acknowledge(PmtkFlag::invalid);
        echo += fmt::format(",{}", *on);
        if (i == full_galileo)
            wanted.back().second = wanted.back().second || *on == 1;
        else
            wanted.emplace_back(in_order[i], *on == 1);
    }
    const bool taken = c.set_systems(pmtk_layers, wanted);
    c.acknowledge(taken ? PmtkFlag::done : PmtkFlag::failed, taken ? echo : "");
}

// 386 and 397: slower than this, m/s, the position is held.
void set_speed_threshold(PmtkCommand& c) {
    constexpr double most = 2.0, per_step = 100.0;
    const std::string_view field = c.sentence.field(0);
    const auto threshold = number_in<double>(field);
    if (!threshold || *threshold < 0 || *threshold > most) return c.acknowledge(PmtkFlag::invalid);
    c.store.set(pmtk_layers, SentenceSettings::held_below_cmps,
                static_cast<std::uint64_t>(std::llround(*threshold * per_step)));
    c.acknowledge(PmtkFlag::done);
}

void tell_version(PmtkCommand& c) {
    c.outcome.answers = version_answers(c.board, "PMTK");
    if (c.outcome.answers.empty()) c.acknowledge(PmtkFlag::unsupported);
}

// 869, the receiver's own orbit prediction: taken, without effect.
constexpr CommandRow<PmtkCommand> pmtk_rows[] = {
    {0, accept_pmtk},
    {101, restart_pmtk},
    {102, restart_pmtk},
    {103, restart_pmtk},
    {104, restart_pmtk},
    {161, stand_by},
    {220, set_interval},
    {251, set_speed},
    {300, set_interval},
    {301, set_corrections},
    {313, set_sbas},
    {314, set_sentences},
    {353, set_constellations},
    {386, set_speed_threshold},
    {397, set_speed_threshold},
    {400, tell_interval},
    {401, tell_corrections},
    {413, tell_sbas},
    {414, tell_sentences},
    {605, tell_version},
    {869, accept_pmtk},
};

CommandOutcome execute_pmtk(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                            PortId from) {
    constexpr std::string_view version = "PQVERNO";
    PmtkCommand command{{sentence, board, store, from}};
    if (sentence.address == version && sentence.field(0) == "R") {
        command.outcome.answers = version_answers(board, version);
        return command.outcome;
    }
    const auto number = command_number(sentence, "PMTK");
    if (!number) return {};
    command.number = *number;
    const auto* row = std::ranges::find(pmtk_rows, *number, &CommandRow<PmtkCommand>::number);
    if (row == std::end(pmtk_rows))
        command.acknowledge(PmtkFlag::unsupported);
    else
        row->execute(command);
    return command.outcome;
}

}  // namespace

std::unique_ptr<Maker> make_mediatek(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<NumberedCommandMaker>(board, options, execute_pmtk);
}

Abilities mediatek_abilities(const BoardProfile&) {
    return {.choice = Abilities::MessageChoice::rates, .time = true, .calendar = true, .own_prefix = "PMTK"};
}

}  // namespace skyloop::firmware
