// Sentences of clients: each line of the input goes to a receiver of every personality. Answers are whole sentences,
// and the store keeps every item in its range.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>

#include "firmware/config/config_handler.hpp"
#include "firmware/nmea_commands.hpp"

namespace {

using namespace skyloop;
using namespace skyloop::firmware;

BoardProfile board_of(Personality personality) {
    BoardProfile board;
    board.personality = personality;
    board.constellations = {Constellation::gps, Constellation::sbas, Constellation::glonass};
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb};
    board.quirks.answers_unknown_nmea = true;
    board.identity.version_answers = {"$PMTK705,AXN_1.30,0145,x,", "$PQVERNO,R,y", "$PAIR020,z"};
    return board;
}

void check_answers(const CommandOutcome& outcome) {
    for (const Bytes& answer : outcome.answers) {
        const std::string text = to_string(answer);
        if (!text.ends_with("\r\n") || !parse_sentence(text)) std::abort();
    }
    for (const UbxMessageId message : outcome.polled)
        if (message.message_class != 0xF0 && message.message_class != 0xF1) std::abort();
}

void check_values(const BoardProfile& board, const ConfigValues& values) {
    for (const auto& [item, value] : values)
        if (!is_in_range(board, item, value)) std::abort();
    if (!is_consistent(board, values)) std::abort();
}

void check_store(const BoardProfile& board, const ConfigStore& store) {
    const ConfigValues& factory = store.values(ConfigLayer::factory);
    const ConfigValues& ram = store.values(ConfigLayer::ram);
    if (ram == factory) return;  // checked when it was made
    if (ram.size() != factory.size()) std::abort();
    for (const auto& [item, value] : ram)
        if (!factory.contains(item)) std::abort();
    check_values(board, ram);
}

struct Known {
    BoardProfile board;
    ConfigValues factory;
};

Known known_of(Personality personality) {
    Known known{board_of(personality), {}};
    known.factory = factory_config(known.board);
    check_values(known.board, known.factory);
    return known;
}

void talk_to(Personality personality, const std::vector<std::string>& lines) {
    static std::map<Personality, Known> all;
    if (!all.contains(personality)) all.emplace(personality, known_of(personality));
    const auto& [board, factory] = all.at(personality);
    ConfigStore store(factory);
    for (const std::string& line : lines) {
        // The checksum of a mutated line is seldom right: its body counts.
        const std::string whole = Sentence(line.substr(1, line.rfind('*') - 1)).finish();
        const auto sentence = parse_sentence(whole);
        if (!sentence) continue;
        check_answers(execute_sentence(*sentence, board, store, PortId::uart1));
        check_answers(execute_sentence(*sentence, board, store, PortId::usb));
    }
    check_store(board, store);
    store.reload();
    check_store(board, store);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    for (const Personality personality : {Personality::mute, Personality::ublox, Personality::mtk, Personality::airoha})
        talk_to(personality, lines);
    return 0;
}
