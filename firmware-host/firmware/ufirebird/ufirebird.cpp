// Sources: answers of a UC6580I as an emulator of it has them (software 6.1.1.1Build9074), meshtastic/firmware
// (src/gps/GPS.cpp) for what hosts say. Of CFGPRT, and of what the digits of CFGSYS mean, nothing was found.
#include "firmware/ufirebird/ufirebird.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/sentences/numbered_commands.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t systems_key = 5000, notices_key = 5001;
constexpr std::array<OwnSetting, 2> ufirebird_settings{{{systems_key, "cfgsys", 0x55155}, {notices_key, "notices", 3}}};
constexpr std::size_t ufirebird_longest_line = 240;  // invented

}  // namespace

/// A command while it is worked off: its name in capitals, its fields.
struct UfirebirdMaker::Command {
    std::string name;
    std::vector<std::string> fields;
    PortId from;
    CommandOutcome& outcome;

    void answer(const std::string& body) const { outcome.answers.push_back(to_bytes(Sentence(body).finish())); }
    void ok() const { answer("OK"); }
    void wrong_parameter() const { answer("FAIL,0"); }
};

UfirebirdMaker::UfirebirdMaker(const BoardProfile& board, const ReceiverOptions& options)
    : SentenceMaker(board, options, true, ufirebird_settings) {}

std::vector<StreamPiece> UfirebirdMaker::cut(PortUnit& unit, ByteSpan bytes, GpsTime) {
    std::vector<StreamPiece> pieces;
    for (const std::string& line : lines_.try_emplace(unit.id, ufirebird_longest_line).first->second.feed(bytes))
        if (line.find('$') != std::string::npos) pieces.push_back({StreamKind::command, to_bytes(line)});
    return pieces;
}

// A wrong checksum is answered; one that is not there is none.
CommandOutcome UfirebirdMaker::receive(const StreamPiece& piece, const Situation& asked) {
    CommandOutcome outcome;
    if (piece.kind != StreamKind::command) return outcome;
    const std::string line = to_string(piece.bytes);
    std::string body = line.substr(line.rfind('$') + 1);
    const std::size_t star = body.find('*');
    const bool summed = star != std::string::npos;
    const auto said = summed ? hexadecimal_number_in<unsigned>(std::string_view(body).substr(star + 1)) : std::nullopt;
    body.resize(std::min(star, body.size()));
    Command command{{}, {}, asked.from, outcome};
    std::string* word = &command.name;
    for (const char c : body) {
        if (c == ',')
            word = &command.fields.emplace_back();
        else
            *word += word == &command.name ? upper_case(c) : c;
    }
    const bool own = command.name == "PDTINFO" || command.name == "CFGSYS" || command.name == "CFGMSG";
    if (own && summed && said != nmea_checksum(body))
        command.answer("FAIL,1");
    else if (own)
        execute(command);
    return outcome;
}

void UfirebirdMaker::execute(Command& command) {
    if (command.name == "PDTINFO")
        command.outcome.answers = version_answers(board(), "PDTINFO");
    else if (command.name == "CFGSYS")
        systems(command);
    else
        rate(command);
}

// "CFGSYS" is asked, "CFGSYS,h35155" set: the receiver keeps it and starts anew.
void UfirebirdMaker::systems(Command& command) {
    if (command.fields.empty()) return command.answer(fmt::format("CFGSYS,H{:05X}", settings().value(systems_key)));
    const std::string& text = command.fields[0];
    const bool hexadecimal = text.size() > 1 && text.size() <= 9 && (text[0] == 'h' || text[0] == 'H');
    const auto number =
        hexadecimal ? hexadecimal_number_in<std::uint32_t>(std::string_view(text).substr(1)) : std::nullopt;
    if (!number || *number == 0) return command.wrong_parameter();
    settings().set(in_ram | in_flash, systems_key, *number);
    command.ok();
    command.outcome.reset = Reset{Reset::Kind::software, {}};
}

// "CFGMSG,class,id,rate[,port]": class 0 sentences, 6 notices.
void UfirebirdMaker::rate(Command& command) {
    constexpr std::array<std::string_view, 9> by_number{"GGA", "GLL", "GSA", "GSV", "RMC", "VTG", "ZDA", "GST", "GBS"};
    constexpr int of_sentences = 0, of_notices = 6, most = 20;
    std::array<int, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = i < command.fields.size() ? number_in<int>(command.fields[i]) : std::nullopt;
        if (!number || *number < 0 || *number > most) return command.wrong_parameter();
        numbers[i] = *number;
    }
    const auto [kind, id, rate] = numbers;
    if (kind == of_notices && id <= 1) {
        const std::uint64_t bit = std::uint64_t{1} << id;
        const std::uint64_t before = settings().value(notices_key);
        settings().set(in_ram, notices_key, rate == 0 ? before & ~bit : before | bit);
        return command.ok();
    }
    const bool known = kind == of_sentences && id < static_cast<int>(by_number.size());
    const auto item =
        known ? SentenceSettings::rate(by_number[static_cast<std::size_t>(id)], command.from) : std::nullopt;
    if (!item) return command.wrong_parameter();
    settings().set(in_ram, *item, static_cast<std::uint64_t>(rate));
    command.ok();
}

void UfirebirdMaker::restart(bool keeps_ram) {
    lines_.clear();
    SentenceMaker::restart(keeps_ram);
}

// Notices are texts; those of the start that the board has are whole sentences, and come whatever is set.
void UfirebirdMaker::adjust(ReceiverConfig& config) const {
    for (PortConfig& port : config.ports)
        if (settings().value(notices_key) != 3) port.nmea_texts = 0;
}

std::unique_ptr<Maker> make_ufirebird(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<UfirebirdMaker>(board, options);
}

Abilities ufirebird_abilities(const BoardProfile&) {
    return {
        .choice = Abilities::MessageChoice::rates, .time = true, .calendar = true, .more = {"OK", "FAIL", "PDTINFO"}};
}

}  // namespace skyloop::firmware
