// Sources: CASIC's protocol specification V4.2.0.3, section 1.6; Quectel's L76K GNSS Protocol Specification V1.1;
// answers as meshtastic/firmware (src/gps) and jclark/satpulse (gpshwtest/HW) have them.
#include "firmware/casic/commands.hpp"

#include <algorithm>
#include <array>

#include "firmware/casic/settings.hpp"
#include "firmware/sentences/numbered_commands.hpp"

namespace skyloop::firmware {
namespace {

using PcasCommand = NumberedCommand;

void save_pcas(PcasCommand& c) { save_casic(c.store); }

void set_pcas_speed(PcasCommand& c) {
    constexpr std::array<std::uint64_t, 6> speeds{4800, 9600, 19200, 38400, 57600, 115200};
    const auto index = c.argument_within(0, 0, static_cast<int>(speeds.size()) - 1);
    if (index) set_casic_speed(c.store, c.board, c.from, speeds[static_cast<std::size_t>(*index)]);
}

void set_pcas_interval(PcasCommand& c) {
    if (const auto period = c.argument_within(0, 1, 1000))
        set_casic_interval(c.store, c.board, static_cast<std::uint64_t>(*period));
}

// 03: every how many fixes a sentence comes, 0 to 9; one that is left out stays as it is. Sentences of places that are
// empty here (DHV, LPS, UTC) are not sent.
void set_pcas_sentences(PcasCommand& c) {
    constexpr std::array<std::string_view, 14> places{"GGA", "GLL", "GSA", "GSV", "RMC", "VTG", "ZDA",
                                                      "ANT", "",    "",    "",    "",    "",    "GST"};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto rate = c.argument_within(i, 0, 9);
        const auto item =
            places[i] == "ANT" ? std::optional(CasicKeys::antenna_text(c.from)) : c.sentence_item(places[i]);
        if (rate && item) c.store.set(in_ram, *item, static_cast<std::uint64_t>(*rate));
    }
}

void set_pcas_systems(PcasCommand& c) {
    if (const auto bits = c.argument_within(0, 1, 7)) set_casic_systems(c.store, static_cast<std::uint64_t>(*bits));
}

void set_pcas_version(PcasCommand& c) {
    const auto version = c.argument_within(0, 0, 9);
    constexpr std::array<std::uint64_t, 3> known{casic_nmea_4_10, casic_nmea_4_0, casic_nmea_2_2};
    if (version && std::ranges::find(known, static_cast<std::uint64_t>(*version)) != known.end())
        c.store.set(in_ram, CasicKeys::sentence_version, static_cast<std::uint64_t>(*version));
}

// 06: 0 firmware, 1 module, 2 systems, 3 customer, 5 loader; each is a text of the start.
void tell_pcas_version(PcasCommand& c) {
    constexpr std::array<std::string_view, 6> keys{"SW=", "HW=", "MO=", "CI=", "", "BS="};
    const auto index = c.argument_within(0, 0, static_cast<int>(keys.size()) - 1);
    const std::string_view key = index ? keys[static_cast<std::size_t>(*index)] : std::string_view();
    if (!key.empty()) c.outcome.answers = version_answers(c.board, "GPTXT,01,01,02," + std::string(key));
}

// 10: 0 hot, 1 warm, 2 cold, 3 cold with factory settings.
void restart_pcas(PcasCommand& c) {
    constexpr int warm = 1, factory = 3;
    const auto kind = c.argument_within(0, 0, factory);
    if (!kind) return;
    const StartKind start = *kind == 0 ? StartKind::hot : *kind == warm ? StartKind::warm : StartKind::cold;
    c.outcome.reset = Reset{Reset::Kind::software, Forgotten::of(start)};
    if (*kind == factory) c.store.clear(in_battery | in_flash);
}

void set_pcas_motion(PcasCommand& c) {
    if (const auto motion = c.argument_within(0, 0, 7)) set_casic_motion(c.store, static_cast<std::uint64_t>(*motion));
}

// 12: off for so many seconds, or until a byte comes.
void stand_by_pcas(PcasCommand& c) {
    constexpr int longest_s = 65535;
    if (const auto seconds = c.argument_within(0, 1, longest_s))
        c.outcome.sleep = SleepRequest{.length = std::chrono::seconds(*seconds), .wakes = wake_by_every_pin};
}

constexpr CommandRow<PcasCommand> pcas_rows[] = {
    {0, save_pcas},        {1, set_pcas_speed},   {2, set_pcas_interval}, {3, set_pcas_sentences},
    {4, set_pcas_systems}, {5, set_pcas_version}, {6, tell_pcas_version}, {10, restart_pcas},
    {11, set_pcas_motion}, {12, stand_by_pcas},
};

}  // namespace

CommandOutcome execute_pcas(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                            PortId from) {
    const auto number = command_number(sentence, "PCAS");
    if (!number) return {};
    PcasCommand command{sentence, board, store, from, *number};
    const auto* row = std::ranges::find(pcas_rows, *number, &CommandRow<PcasCommand>::number);
    if (row != std::end(pcas_rows)) row->execute(command);
    return command.outcome;
}

}  // namespace skyloop::firmware
