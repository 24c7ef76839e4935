#include "firmware/sentences/own_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/core/told_heading.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/sentences/nmea_report.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {
namespace {

using Value = std::optional<double> (*)(const NavigationState&, const BoardProfile&);

std::optional<double> of_place(const NavigationState& state, double value) {
    return state.fix_ok && state.epoch.fix.has_position() ? std::optional(value) : std::nullopt;
}
template <auto Member>
std::optional<double> accuracy(const NavigationState& state, const BoardProfile&) {
    return of_place(state, (state.epoch.fix.*Member).value());
}
double above_sea(const Fix& fix) { return (fix.position.height.above_ellipsoid - fix.geoid_undulation).value(); }

struct NamedValue {
    std::string_view name;
    Value value;
};
// What no sentence of the standard tells, or in another unit.
constexpr auto named_values = std::to_array<NamedValue>({
    {"altitude_ft",
     [](const NavigationState& s, const BoardProfile&) { return of_place(s, above_sea(s.epoch.fix) / 0.3048); }},
    {"altitude_m", [](const NavigationState& s, const BoardProfile&) { return of_place(s, above_sea(s.epoch.fix)); }},
    {"height_m", [](const NavigationState& s,
                    const BoardProfile&) { return of_place(s, s.epoch.fix.position.height.above_ellipsoid.value()); }},
    {"h_acc_m", accuracy<&Fix::horizontal_accuracy>},
    {"v_acc_m", accuracy<&Fix::vertical_accuracy>},
    {"s_acc_mps", accuracy<&Fix::speed_accuracy>},
    {"acc_m",
     [](const NavigationState& s, const BoardProfile&) {
         return of_place(s, std::hypot(s.epoch.fix.horizontal_accuracy.value(), s.epoch.fix.vertical_accuracy.value()));
     }},
    {"vel_north_mps",
     [](const NavigationState& s, const BoardProfile&) { return of_place(s, s.epoch.fix.velocity.north); }},
    {"vel_east_mps",
     [](const NavigationState& s, const BoardProfile&) { return of_place(s, s.epoch.fix.velocity.east); }},
    {"climb_mps",
     [](const NavigationState& s, const BoardProfile&) { return of_place(s, -s.epoch.fix.velocity.down); }},
    {"tdop", [](const NavigationState& s, const BoardProfile&) { return of_place(s, s.epoch.fix.dop.tdop); }},
    {"heading_deg",
     [](const NavigationState& s, const BoardProfile& board) -> std::optional<double> {
         const auto told = told_heading(s, board.style.heading);
         if (!told) return std::nullopt;
         const double degrees = std::fmod(told->heading.deg(), 360.0);
         return degrees < 0 ? degrees + 360 : degrees;
     }},
    {"tow_s",
     [](const NavigationState& s, const BoardProfile&) {
         return s.time.time ? std::optional(gps_stamp(s).tow_seconds()) : std::nullopt;
     }},
    {"week",
     [](const NavigationState& s, const BoardProfile&) {
         return s.time.date ? std::optional(static_cast<double>(gps_stamp(s).week)) : std::nullopt;
     }},
});

constexpr int most_decimals = 9, most_fields = 40;

// What stands in a pair of braces: a field of a sentence, or a named value.
struct Placeholder {
    std::optional<UbxMessageId> sentence{};
    std::size_t field = 0;
    const NamedValue* value = nullptr;
    int decimals = 1;
};

std::optional<Placeholder> placeholder(std::string_view text) {
    Placeholder found;
    const std::size_t point = text.find('.'), colon = text.find(':');
    if (point != text.npos) {
        found.sentence = sentence_message(text.substr(0, point));
        const auto field = number_in<int>(text.substr(point + 1));
        if (!found.sentence || !field || *field < 1 || *field > most_fields) return std::nullopt;
        found.field = static_cast<std::size_t>(*field) - 1;
        return found;
    }
    if (colon != text.npos) {
        const auto decimals = number_in<int>(text.substr(colon + 1));
        if (!decimals || *decimals < 0 || *decimals > most_decimals) return std::nullopt;
        found.decimals = *decimals;
    }
    const auto* const known = std::ranges::find(named_values, text.substr(0, colon), &NamedValue::name);
    if (known == named_values.end()) return std::nullopt;
    found.value = known;
    return found;
}

// The template with `fill` of what stands in each pair of braces; nothing where a brace has no other.
template <class Fill>
std::optional<std::string> filled(std::string_view text, Fill fill) {
    std::string out;
    while (!text.empty()) {
        const std::size_t open = text.find_first_of("{}");
        out += text.substr(0, open);
        if (open == text.npos) break;
        const std::size_t close = text.find_first_of("{}", open + 1);
        if (text[open] == '}' || close == text.npos || text[close] == '{') return std::nullopt;
        out += fill(text.substr(open + 1, close - open - 1));
        text.remove_prefix(close + 1);
    }
    return out;
}

std::string field_of(const Placeholder& found, EpochMessages& made, PortId port) {
    if (!found.sentence) {
        const ReportContext context = made.context(port);
        const auto value = found.value->value(context.state, context.board);
        return value ? fixed_decimals(*value, found.decimals) : std::string();
    }
    const std::vector<Bytes>& sentences = made.of(*found.sentence, port, {});
    if (sentences.empty()) return {};
    const std::string line = to_string(sentences.front());
    const auto sentence = parse_sentence(line);
    return sentence ? std::string(sentence->field(found.field)) : std::string();
}

// Behind the last of the sentences that it follows, else behind all.
std::size_t place_of(const OwnLine& line, const std::vector<ByteSpan>& frames) {
    if (!line.after) return frames.size();
    const std::string_view name = nmea_sentence_names[static_cast<std::size_t>(*line.after)];
    const auto is_it = [name](ByteSpan frame) {
        constexpr std::size_t at = 3;  // "$GN"
        return frame.size() > at + name.size() && frame[0] == '$' &&
               std::equal(name.begin(), name.end(), frame.begin() + at);
    };
    const auto last = std::find_if(frames.rbegin(), frames.rend(), is_it);
    return last == frames.rend() ? frames.size() : static_cast<std::size_t>(frames.rend() - last);
}

}  // namespace

std::optional<std::string> mistake_of_own_line(std::string_view text) {
    const bool plain = std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~' && c != '*'; });
    if (!plain || text.size() < 2 || text.front() != '$' || text.find('$', 1) != text.npos)
        return fmt::format("is '{}'; expected a sentence from '$' on, without checksum", text);
    std::optional<std::string> unknown;
    const auto note = [&](std::string_view name) {
        if (!unknown && !placeholder(name)) unknown = name;
        return std::string();
    };
    if (!filled(text, note)) return fmt::format("is '{}'; expected each '{{' to have its '}}'", text);
    if (!unknown) return std::nullopt;
    std::vector<std::string_view> names;
    for (const NamedValue& value : named_values)
        names.push_back(value.name);
    return fmt::format("has '{{{}}}'; expected a field of a sentence such as {{GGA.9}}, or one of {}{}", *unknown,
                       fmt::join(names, " "), did_you_mean(*unknown, names));
}

bool sends_sentences(MakerKind maker) {
    return maker != MakerKind::msp && maker != MakerKind::msp_v1 && maker != MakerKind::mavlink &&
           maker != MakerKind::dronecan;
}

void add_own_lines(DueMessages& due, EpochMessages& made, PortId port) {
    const ReportContext context = made.context(port);
    const PortConfig& of_port = context.config.port(port);
    if (!sends_sentences(context.board.maker) || !of_port.on || !of_port.out.nmea) return;
    for (const OwnLine& line : context.board.style.lines) {
        if (context.state.epoch_index % static_cast<std::uint64_t>(line.every_epochs) != 0) continue;
        const auto body = filled(std::string_view(line.text).substr(1), [&](std::string_view name) {
            const auto found = placeholder(name);
            return found ? field_of(*found, made, port) : std::string();
        });
        if (!body) continue;
        due.own.push_back(to_bytes(Sentence(*body).finish()));
        const auto place = due.frames.begin() + static_cast<std::ptrdiff_t>(place_of(line, due.frames));
        due.frames.insert(place, due.own.back());
    }
}

}  // namespace skyloop::firmware
