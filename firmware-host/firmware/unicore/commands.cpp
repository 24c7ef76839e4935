// The commands of a Unicore receiver. Each is answered by "$command,<as typed>,response: OK", or by PARSING FAILD with
// its name in capitals (captures: "umlog", "SATSXXXXB COM1 1", "rtcm1230,com1,10").
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/unicore/commands.hpp"
#include "firmware/unicore/logs.hpp"
#include "firmware/unicore/unicore.hpp"

namespace skyloop::firmware {
namespace {

constexpr double answer_spread_s = 0.025;  // 40 to 65 ms in all (captures of jclark/satpulse)
constexpr double saving_s = 0.1;           // invented

// "$CMD*hh" is CMD where the checksum, NMEA's, is right; nothing where it is not. What has no dollar is the command.
std::optional<std::string> unwrapped(const std::string& line) {
    if (!line.starts_with('$')) return line;
    const std::size_t star = line.rfind('*');
    if (star == std::string::npos) return line.substr(1);
    const std::string body = line.substr(1, star - 1);
    const auto said = hexadecimal_number_in<unsigned>(std::string_view(line).substr(star + 1));
    return said && *said == nmea_checksum(body) ? std::optional(body) : std::nullopt;
}

std::span<const std::string> behind(const std::vector<std::string>& words, std::size_t first) {
    return std::span(words).subspan(std::min(first, words.size()));
}

Bytes unicore_config_line(const std::pair<std::string, std::string>& line) {
    return to_bytes(unicore_answer_line(fmt::format("$CONFIG,{},{}", line.first, line.second)));
}

}  // namespace

std::vector<std::string> unicore_words(std::string_view line) {
    std::vector<std::string> words(1);
    for (const char c : line) {
        const bool between = c == ' ' || c == ',' || c == '\t';
        if (between && !words.back().empty()) words.emplace_back();
        if (!between) words.back() += upper_case(c);
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

const UnicoreMaker::Row UnicoreMaker::rows[] = {{"MODE", &UnicoreMaker::mode},
                                                {"CONFIG", &UnicoreMaker::configure_topic},
                                                {"MASK", &UnicoreMaker::mask},
                                                {"UNMASK", &UnicoreMaker::unmask},
                                                {"LOG", &UnicoreMaker::log},
                                                {"UNLOG", &UnicoreMaker::remove_log},
                                                {"UNLOGALL", &UnicoreMaker::remove_all_logs},
                                                {"LOGLIST", &UnicoreMaker::list_logs},
                                                {"SAVECONFIG", &UnicoreMaker::save},
                                                {"FRESET", &UnicoreMaker::forget_all},
                                                {"RESET", &UnicoreMaker::reset}};

void UnicoreMaker::execute(const std::string& line, const Situation& asked, CommandOutcome& outcome) {
    const auto typed = unwrapped(line);
    const std::string shown = typed.value_or(line);
    const std::vector<std::string> words = unicore_words(shown);
    if (words.empty()) return;
    CommandOutcome made;
    const bool known = typed && line.size() < too_long_command && carry_out({shown, words, asked, made});
    outcome = known ? std::move(made) : CommandOutcome{};
    const std::string verdict =
        known ? std::string("OK") : fmt::format("PARSING FAILD NO MATCHING FUNC  {}", words.front());
    outcome.answers.insert(outcome.answers.begin(),
                           to_bytes(unicore_answer_line(fmt::format("$command,{},response: {}", shown, verdict))));
    outcome.work += Seconds(answer_spread_s * pauses_.uniform());
}

bool UnicoreMaker::carry_out(const Command& command) {
    for (const Row& row : rows)
        if (row.name == command.words.front()) return (this->*row.execute)(command);
    return named_log(command);
}

bool UnicoreMaker::take_setting(const std::vector<std::string>& words, PortId port) {
    if (words.empty()) return false;
    const auto rest = behind(words, 1);
    if (words.front() == "MODE") return set_mode(rest);
    if (words.front() == "MASK") return set_mask(rest);
    if (words.front() == "UNLOGALL") {
        now_.remove(std::nullopt, std::nullopt);
        return true;
    }
    if (words.front() != "CONFIG") return set_log(words, port);
    const auto named = words.size() > 2 ? com_port(board(), words[1]) : std::nullopt;
    return named ? set_port(*named, behind(words, 2)) : now_.set_topic(rest);
}

bool UnicoreMaker::mode(const Command& command) {
    if (command.words.size() > 1) {
        if (!set_mode(behind(command.words, 1))) return false;
        adopt();
        return true;
    }
    const UnicoreHeader header = unicore_header(command.asked.report, command.asked.now);
    // The head of a log, and a checksum in place of its CRC.
    const std::string text = unicore_log_line("MODE", header, fmt::format("MODE {},", now_.mode.words));
    command.outcome.answers.push_back(to_bytes(unicore_answer_line(text.substr(0, text.rfind('*')))));
    return true;
}

bool UnicoreMaker::set_mode(std::span<const std::string> words) {
    const auto wanted = unicore_mode(words);
    if (wanted) now_.mode = *wanted;
    return wanted.has_value();
}

// Alone: all topics. A new group of signals is kept, and the receiver starts with it.
bool UnicoreMaker::configure_topic(const Command& command) {
    const auto& words = command.words;
    if (words.size() == 1) {
        for (const auto& line : now_.topic_lines())
            command.outcome.answers.push_back(unicore_config_line(line));
        return true;
    }
    if (words.size() == 2) {
        std::size_t found = 0;
        for (const auto& line : now_.topic_lines())
            if (line.first == words[1]) {
                command.outcome.answers.push_back(unicore_config_line(line));
                ++found;
            }
        return found > 0;
    }
    if (!take_setting(words, command.asked.from)) return false;
    if (words[1] == "SIGNALGROUP") {
        saved_.set_topic(behind(words, 1));
        command.outcome.reset = Reset{Reset::Kind::software, {}};
    }
    adopt();
    return true;
}

// "115200 8 n 1": no other frames than these.
bool UnicoreMaker::set_port(PortId port, std::span<const std::string> words) {
    const auto baud = words.empty() ? std::nullopt : number_in<std::uint32_t>(words[0]);
    constexpr std::array<std::string_view, 3> frame{"8", "N", "1"};
    if (!baud || !takes_baud(board(), *baud) || words.size() > 1 + frame.size()) return false;
    for (std::size_t i = 1; i < words.size(); ++i)
        if (words[i] != frame[i - 1]) return false;
    now_.bauds[port] = *baud;
    return true;
}

// MASK alone is asked; "MASK 10", "MASK GLO", "MASK CN0 20". A mask of one system's elevation is taken, too, and has
// no effect.
bool UnicoreMaker::mask(const Command& command) {
    if (command.words.size() > 1) {
        if (!set_mask(behind(command.words, 1))) return false;
        adopt();
        return true;
    }
    const auto tell = [&](const std::string& words) {
        command.outcome.answers.push_back(unicore_config_line({"MASK", "MASK " + words}));
    };
    tell(fmt::format("{:.1f}", now_.mask_deg));
    if (now_.least_cn0) tell(fmt::format("CN0 {:.1f}", *now_.least_cn0));
    for (const std::string_view system : {"GPS", "BDS", "GLO", "GAL", "QZSS", "IRNSS"})
        if (now_.masked.contains(*masked_system(system))) tell(std::string(system));
    return true;
}

bool UnicoreMaker::set_mask(std::span<const std::string> words) {
    if (words.empty()) return false;
    if (const auto system = masked_system(words[0]); system && words.size() == 1) {
        now_.masked.insert(*system);
        return true;
    }
    constexpr double highest_deg = 90, strongest = 60;
    if (words[0] == "CN0") {
        const auto strength = words.size() > 1 ? number_in<double>(words[1]) : std::nullopt;
        if (!strength || *strength < 0 || *strength > strongest) return false;
        now_.least_cn0 = *strength;
        return true;
    }
    const auto elevation = number_in<double>(words[0]);
    if (!elevation || *elevation < -highest_deg || *elevation > highest_deg || words.size() > 2) return false;
    if (words.size() == 2) return masked_system(words[1]).has_value();
    now_.mask_deg = std::max(0.0, *elevation);
    return true;
}

bool UnicoreMaker::unmask(const Command& command) {
    const auto system = command.words.size() == 2 ? masked_system(command.words[1]) : std::nullopt;
    if (!system) return false;
    now_.masked.erase(*system);
    adopt();
    return true;
}

// "LOG [COMn] NAME [ONTIME s]".
bool UnicoreMaker::log(const Command& command) {
    std::vector<std::string> words(command.words.begin() + 1, command.words.end());
    std::erase(words, "ONTIME");
    if (!words.empty() && com_port(board(), words[0]) && words.size() > 1) std::swap(words[0], words[1]);
    if (words.empty()) return false;
    return named_log({command.line, words, command.asked, command.outcome});
}

// "NAME [COMn] [s]": without a period it comes once, to the port of the question.
bool UnicoreMaker::named_log(const Command& command) {
    const auto& words = command.words;
    const bool has_port = words.size() > 1 && com_port(board(), words[1]);
    const std::size_t period_at = has_port ? 2 : 1;
    if (words.size() <= period_at || words[period_at] == "ONCE") return send_once(command, words.front());
    if (!set_log(words, command.asked.from)) return false;
    adopt();
    return true;
}

bool UnicoreMaker::set_log(std::span<const std::string> words, PortId port) {
    const auto kind = words.empty() ? std::nullopt : unicore_log(board(), words[0]);
    const auto named = words.size() > 1 ? com_port(board(), words[1]) : std::nullopt;
    const std::size_t period_at = named ? 2 : 1;
    if (!kind || words.size() != period_at + 1) return false;
    const auto period = period_of(words[period_at]);
    if (!period) return false;
    now_.add({named.value_or(port), std::string(words[0]), *kind, *period});
    return true;
}

// In whole milliseconds, no more often than the board can.
std::optional<std::uint64_t> UnicoreMaker::period_of(std::string_view seconds) const {
    constexpr double longest_s = 65535, thousandths = 1000;
    const auto number = number_in<double>(seconds);
    if (!number || *number < 1 / board().max_rate_hz || *number > longest_s) return std::nullopt;
    return static_cast<std::uint64_t>(std::llround(*number * thousandths));
}

bool UnicoreMaker::send_once(const Command& command, std::string_view name) {
    const auto kind = unicore_log(board(), name);
    if (!kind) return false;
    // The body comes some seconds after a start alone (SparkFun_RTK_Everywhere).
    if (!has_started_) return true;
    EpochMessages made(command.asked.report);
    for (Bytes& message : unicore_messages(*kind, made, command.asked.from, {}, command.asked.now))
        command.outcome.answers.push_back(std::move(message));
    return true;
}

// "UNLOG [COMn] [NAME]": of the port of the question without another.
bool UnicoreMaker::remove_log(const Command& command) {
    const auto& words = command.words;
    std::size_t at = 1;
    PortId port = command.asked.from;
    if (words.size() > at)
        if (const auto named = com_port(board(), words[at])) {
            port = *named;
            ++at;
        }
    std::optional<UnicoreLogKind> kind;
    if (words.size() > at) kind = unicore_log(board(), words[at]);
    if (words.size() > at + 1 || (words.size() > at && !kind)) return false;
    now_.remove(port, kind);
    adopt();
    return true;
}

bool UnicoreMaker::remove_all_logs(const Command&) {
    now_.remove(std::nullopt, std::nullopt);
    adopt();
    return true;
}

// In the abbreviated form of NovAtel's logs (capture: jclark/satpulse, packet scanner tests).
bool UnicoreMaker::list_logs(const Command& command) {
    const UnicoreHeader header = unicore_header(command.asked.report, command.asked.now);
    std::string text =
        fmt::format("<LOGLIST {} {} {}.000000 {} {} {:.6f} 0 0 {}\r\n<\t{}\r\n", com_name(command.asked.from),
                    header.version, header.cpu_idle_percent, header.time_known ? "FINE" : "UNKNOWN", header.week,
                    header.tow_ms / 1000.0, header.leap_seconds, now_.logs.size());
    for (const UnicoreLog& one : now_.logs)
        text +=
            fmt::format("<\t{} {} {} \r\n", one.name, com_name(one.port), static_cast<double>(one.period_ms) / 1000);
    command.outcome.answers.push_back(to_bytes(text + "\r\n"));
    return true;
}

bool UnicoreMaker::save(const Command& command) {
    saved_ = now_;
    command.outcome.work += Seconds(saving_s);
    return true;
}

bool UnicoreMaker::forget_all(const Command& command) {
    saved_ = factory_;
    command.outcome.work += Seconds(saving_s);
    command.outcome.reset = Reset{Reset::Kind::hardware, Forgotten::of(StartKind::cold)};
    return true;
}

// "RESET [EPHEM ALMANAC IONUTC POSITION CLOCK ALL]".
bool UnicoreMaker::reset(const Command& command) {
    Forgotten forgotten;
    for (const std::string& word : behind(command.words, 1)) {
        if (word == "EPHEM")
            forgotten.ephemerides = true;
        else if (word == "ALMANAC")
            forgotten.almanac = true;
        else if (word == "IONUTC")
            forgotten.ionosphere = forgotten.utc = true;
        else if (word == "POSITION")
            forgotten.position = true;
        else if (word == "CLOCKDRIFT" || word == "XOPARAM")
            continue;
        else if (word == "ALL")
            forgotten = Forgotten::of(StartKind::cold);
        else
            return false;
    }
    command.outcome.reset = Reset{Reset::Kind::software, forgotten};
    return true;
}

}  // namespace skyloop::firmware
