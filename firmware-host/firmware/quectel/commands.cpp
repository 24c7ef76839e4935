// PQTM commands. Sources: answers captured of an LG290P by jclark/satpulse, numbers of refusals from
// semuconsulting/pynmeagps, the commands of SparkFun's LG290P library and RTK Everywhere.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/quectel/quectel.hpp"
#include "firmware/sentences/numbered_commands.hpp"

namespace skyloop::firmware {
namespace {

constexpr double quectel_farthest_m = 7'000'000;

// Topics that are taken and told, without effect, as an LG290P tells them from the factory on.
struct QuectelTopic {
    std::string_view name, value;
};
constexpr std::array<QuectelTopic, 11> quectel_topics{{{"PQTMCFGPPS", "1,1,100,1,1,0"},
                                                       {"PQTMCFGSIGNAL", "07,03,0F,3F,0F,01"},
                                                       {"PQTMCFGRTCM", "4,0,-90.0,07,06,1,0"},
                                                       {"PQTMCFGRSID", "290"},
                                                       {"PQTMCFGPROT", "1,1,00000007,00000007"},
                                                       {"PQTMCFGCNRTHD", "10.0"},
                                                       {"PQTMCFGRTK", "1,1,120"},
                                                       {"PQTMCFGRTKSRCTYPE", "0,0"},
                                                       {"PQTMCFGPPP", "0"},
                                                       {"PQTMCFGNAVMODE", "0"},
                                                       {"PQTMCFGODO", "0,0.00"}}};
constexpr std::array<Constellation, 6> quectel_systems{Constellation::gps,     Constellation::glonass,
                                                       Constellation::galileo, Constellation::beidou,
                                                       Constellation::qzss,    Constellation::navic};

std::string fields_from(const SentenceView& sentence, std::size_t first) {
    std::string text;
    for (std::size_t i = first; i < sentence.fields.size(); ++i)
        text += (i == first ? "" : ",") + std::string(sentence.fields[i]);
    return text;
}

}  // namespace

const QuectelMaker::Row QuectelMaker::rows[] = {
    {"PQTMVERNO", &QuectelMaker::version},           {"PQTMUNIQID", &QuectelMaker::version},
    {"PQTMCFGUART", &QuectelMaker::port_speed},      {"PQTMCFGFIXRATE", &QuectelMaker::fix_rate},
    {"PQTMCFGMSGRATE", &QuectelMaker::message_rate}, {"PQTMCFGCNST", &QuectelMaker::systems},
    {"PQTMCFGRCVRMODE", &QuectelMaker::mode},        {"PQTMCFGSVIN", &QuectelMaker::survey},
    {"PQTMCFGELETHD", &QuectelMaker::elevation},     {"PQTMSAVEPAR", &QuectelMaker::save},
    {"PQTMRESTOREPAR", &QuectelMaker::restore_all},  {"PQTMSRR", &QuectelMaker::restart_all},
    {"PQTMHOT", &QuectelMaker::restart_all},         {"PQTMWARM", &QuectelMaker::restart_all},
    {"PQTMCOLD", &QuectelMaker::restart_all},        {"PQTMGNSSSTART", &QuectelMaker::start_navigation},
    {"PQTMGNSSSTOP", &QuectelMaker::stop_navigation}};

// "$PQTMx,OK[,…]", or "$PQTMx,ERROR,n".
void QuectelMaker::execute(const Command& command) {
    const auto* row = std::ranges::find(rows, command.sentence.address, &Row::name);
    Verdict verdict = Verdict::unsupported;
    if (row != std::end(rows))
        verdict = (this->*row->execute)(command);
    else if (std::ranges::find(quectel_topics, command.sentence.address, &QuectelTopic::name) != quectel_topics.end())
        verdict = topic(command);
    if (verdict == Verdict::said_already) return;
    if (verdict == Verdict::ok)
        answer(command, "OK");
    else
        answer(command, fmt::format("ERROR,{}", static_cast<int>(verdict)));
}

void QuectelMaker::answer(const Command& command, const std::string& fields) const {
    command.outcome.answers.push_back(
        to_bytes(Sentence(std::string(command.sentence.address) + "," + fields).finish()));
}

// The answer stands whole in the board's file.
QuectelMaker::Verdict QuectelMaker::version(const Command& command) {
    command.outcome.answers = version_answers(board(), std::string(command.sentence.address) + ",");
    return command.outcome.answers.empty() ? Verdict::unsupported : Verdict::said_already;
}

// "R[,1,n]" or "W,[1,n,]baud[,8,0,1,0]". What changes the port's own speed is answered as the board's quirk says.
QuectelMaker::Verdict QuectelMaker::port_speed(const Command& command) {
    const std::vector<PortId> uarts = uarts_of(board());
    const bool named = command.field(1) == "1" && command.sentence.fields.size() > 2;
    const auto number = named ? number_in<std::size_t>(command.field(2)) : std::nullopt;
    if (named && (!number || *number == 0 || *number > uarts.size())) return Verdict::wrong_parameter;
    const PortId port = number ? uarts[*number - 1] : command.asked.from;
    if (command.reads()) {
        const auto place = static_cast<std::size_t>(std::ranges::find(uarts, port) - uarts.begin());
        answer(command, fmt::format("OK,{},{},8,0,1,0", place + 1, settings().value(SentenceSettings::baud(port))));
        return Verdict::said_already;
    }
    const auto baud = number_in<std::uint32_t>(command.field(named ? 3 : 1));
    if (!command.writes() || !baud || !takes_baud(board(), *baud)) return Verdict::wrong_parameter;
    settings().set(in_ram, SentenceSettings::baud(port), *baud);
    command.outcome.verdict = to_bytes(Sentence(std::string(command.sentence.address) + ",OK").finish());
    return Verdict::said_already;
}

QuectelMaker::Verdict QuectelMaker::fix_rate(const Command& command) {
    if (command.reads()) {
        answer(command, fmt::format("OK,{}", coming(SentenceSettings::fix_interval_ms)));
        return Verdict::said_already;
    }
    constexpr std::array<int, 5> intervals{50, 100, 200, 500, 1000};
    const auto period = number_in<int>(command.field(1));
    if (!command.writes() || !period || std::ranges::find(intervals, *period) == intervals.end() ||
        !can_fix_each(board(), static_cast<std::uint64_t>(*period)))
        return Verdict::wrong_parameter;
    set_coming(SentenceSettings::fix_interval_ms, static_cast<std::uint64_t>(*period));
    return Verdict::ok;
}

// "R|W,[1,n,]NAME[,rate][,version]".
QuectelMaker::Verdict QuectelMaker::message_rate(const Command& command) {
    std::size_t name_at = 1;
    PortId port = command.asked.from;
    if (command.field(1) == "1") {
        const std::vector<PortId> uarts = uarts_of(board());
        const auto number = number_in<std::size_t>(command.field(2));
        if (!number || *number == 0 || *number > uarts.size()) return Verdict::wrong_parameter;
        port = uarts[*number - 1];
        name_at = 3;
    }
    return set_message_rate(command, name_at, port);
}

QuectelMaker::Verdict QuectelMaker::set_message_rate(const Command& command, std::size_t name_at, PortId port) {
    const std::string_view name = command.field(name_at);
    auto item = SentenceSettings::rate(name, port);
    const auto* const own = std::ranges::find(quectel_messages, name, &QuectelMessage::name);
    const std::size_t version_at = command.reads() ? name_at + 1 : name_at + 2;
    if (own != quectel_messages.end()) {
        if (command.field(version_at) != std::to_string(own->version)) return Verdict::wrong_parameter;
        if (name == "PQTMSVINSTATUS" && !is_base()) return Verdict::failed;
        item = QuectelKeys::rate(static_cast<std::size_t>(own - quectel_messages.begin()), port);
    }
    if (!item) return Verdict::wrong_parameter;
    if (command.reads()) {
        const std::string before = name_at == 3 ? fmt::format("1,{},", command.field(2)) : "";
        const std::string behind = own == quectel_messages.end() ? "" : fmt::format(",{}", own->version);
        answer(command, fmt::format("OK,{}{},{}{}", before, name, settings().value(*item), behind));
        return Verdict::said_already;
    }
    constexpr int most = 20;
    const auto rate = number_in<int>(command.field(name_at + 1));
    if (!command.writes() || !rate || *rate < 0 || *rate > most) return Verdict::wrong_parameter;
    settings().set(in_ram, *item, static_cast<std::uint64_t>(*rate));
    return Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::systems(const Command& command) {
    if (command.reads()) {
        std::string fields = "OK";
        for (const Constellation system : quectel_systems)
            fields += fmt::format(",{}", coming(SentenceSettings::system(system)));
        answer(command, fields);
        return Verdict::said_already;
    }
    if (!command.writes() || command.sentence.fields.size() != quectel_systems.size() + 1)
        return Verdict::wrong_parameter;
    std::vector<std::pair<Constellation, bool>> wanted;
    for (std::size_t i = 0; i < quectel_systems.size(); ++i) {
        const std::string_view on = command.field(i + 1);
        if (on != "0" && on != "1") return Verdict::wrong_parameter;
        wanted.emplace_back(quectel_systems[i], on == "1");
    }
    if (!settings().can_have(wanted)) return Verdict::failed;
    for (const auto& [system, on] : wanted)
        set_coming(SentenceSettings::system(system), on ? 1 : 0);
    return Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::mode(const Command& command) {
    if (command.reads()) {
        answer(command, fmt::format("OK,{}", coming(QuectelKeys::mode)));
        return Verdict::said_already;
    }
    const auto wanted = number_in<std::uint64_t>(command.field(1));
    if (!command.writes() || !wanted || (*wanted != quectel_rover && *wanted != quectel_base))
        return Verdict::wrong_parameter;
    set_coming(QuectelKeys::mode, *wanted);
    return Verdict::ok;
}

// "W,mode,positions,accuracy,x,y,z": 0 none, 1 a survey, 2 stands at x y z.
QuectelMaker::Verdict QuectelMaker::survey(const Command& command) {
    const auto axis_m = [&](std::size_t axis) {
        return quectel_axis_m(coming(QuectelKeys::metres(axis)), coming(QuectelKeys::rest(axis)));
    };
    constexpr double thousandths = 1000, largest = 4e6;
    if (command.reads()) {
        answer(command, fmt::format("OK,{},{},{:.1f},{:.4f},{:.4f},{:.4f}{}", coming(QuectelKeys::survey),
                                    coming(QuectelKeys::survey_positions),
                                    static_cast<double>(coming(QuectelKeys::survey_accuracy_mm)) / thousandths,
                                    axis_m(0), axis_m(1), axis_m(2), has_pair() ? "" : ",0.0"));
        return Verdict::said_already;
    }
    std::array<double, 6> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = number_in<double>(command.field(i + 1));
        if (!command.writes() || !number || !(std::abs(*number) <= quectel_farthest_m)) return Verdict::wrong_parameter;
        numbers[i] = *number;
    }
    const auto [kind, positions, accuracy, x, y, z] = numbers;
    if ((kind != 0 && kind != 1 && kind != 2) || positions < 0 || positions > largest || accuracy < 0 ||
        accuracy > 1000)
        return Verdict::wrong_parameter;
    set_coming(QuectelKeys::survey, static_cast<std::uint64_t>(kind));
    set_coming(QuectelKeys::survey_positions, static_cast<std::uint64_t>(positions));
    set_coming(QuectelKeys::survey_accuracy_mm, static_cast<std::uint64_t>(std::lround(accuracy * thousandths)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t rests =
            std::llround(numbers[axis + 3] * quectel_rests_per_metre) + quectel_axis_offset_m * quectel_rests_per_metre;
        set_coming(QuectelKeys::metres(axis), static_cast<std::uint64_t>(rests / quectel_rests_per_metre));
        set_coming(QuectelKeys::rest(axis), static_cast<std::uint64_t>(rests % quectel_rests_per_metre));
    }
    return Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::elevation(const Command& command) {
    if (command.reads()) {
        answer(command, fmt::format("OK,{:.1f}", static_cast<double>(settings().value(QuectelKeys::elevation))));
        return Verdict::said_already;
    }
    constexpr double highest = 90;
    const auto degrees = number_in<double>(command.field(1));
    if (!command.writes() || !degrees || !(*degrees >= -highest && *degrees <= highest))
        return Verdict::wrong_parameter;
    settings().set(in_ram, QuectelKeys::elevation, static_cast<std::uint64_t>(std::lround(std::max(0.0, *degrees))));
    return Verdict::ok;
}

// Kept until the next restart.
QuectelMaker::Verdict QuectelMaker::topic(const Command& command) {
    const auto* const factory = std::ranges::find(quectel_topics, command.sentence.address, &QuectelTopic::name);
    if (command.reads()) {
        const auto own = topics_.find(command.sentence.address);
        answer(command, fmt::format("OK,{}", own == topics_.end() ? std::string(factory->value) : own->second));
        return Verdict::said_already;
    }
    if (!command.writes() || command.sentence.fields.size() < 2) return Verdict::wrong_parameter;
    topics_[std::string(command.sentence.address)] = fields_from(command.sentence, 1);
    return Verdict::ok;
}

// What waits for a restart is saved, too.
QuectelMaker::Verdict QuectelMaker::save(const Command& command) {
    command.outcome.work += board().timing.flash_write;
    const ConfigValues in_force = settings().values(ConfigLayer::ram);
    for (const auto& [item, value] : in_force)
        settings().keep(item, coming(item));
    return Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::restore_all(const Command& command) {
    command.outcome.work += board().timing.flash_write;
    coming_.clear();
    settings().clear(in_battery | in_flash);
    return Verdict::ok;
}

// None is answered.
QuectelMaker::Verdict QuectelMaker::restart_all(const Command& command) {
    const std::string_view name = command.sentence.address;
    const bool whole = name == "PQTMSRR";
    const StartKind kind = name == "PQTMCOLD" ? StartKind::cold : name == "PQTMWARM" ? StartKind::warm : StartKind::hot;
    command.outcome.reset =
        Reset{whole ? Reset::Kind::software : Reset::Kind::navigation, whole ? Forgotten{} : Forgotten::of(kind)};
    return whole ? Verdict::said_already : Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::start_navigation(const Command& command) {
    command.outcome.navigating = true;
    return Verdict::ok;
}

QuectelMaker::Verdict QuectelMaker::stop_navigation(const Command& command) {
    command.outcome.navigating = false;
    return Verdict::ok;
}

// PAIR432: MSM 4 (0), 7 (1) or none (-1); PAIR434: 1005. In force at once.
bool QuectelMaker::correction_output(const SentenceView& sentence, CommandOutcome& outcome) {
    const auto number = command_number(sentence, "PAIR");
    constexpr int msm = 432, station = 434;
    if (number != msm && number != station) return false;
    const auto wanted = number_in<int>(sentence.field(0));
    const bool good = wanted && *wanted <= 1 && *wanted >= (number == msm ? -1 : 0);
    if (good && number == msm) settings().set(in_ram, QuectelKeys::msm, *wanted < 0 ? 0 : *wanted == 0 ? 4 : 7);
    if (good && number == station) settings().set(in_ram, QuectelKeys::station, static_cast<std::uint64_t>(*wanted));
    constexpr int parameter = 3;
    outcome.answers.push_back(to_bytes(Sentence(fmt::format("PAIR001,{},{}", *number, good ? 0 : parameter)).finish()));
    return true;
}

}  // namespace skyloop::firmware
