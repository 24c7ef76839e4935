#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "detail/observation_header.hpp"

namespace skyloop::inline world::rinex {
namespace {

int column_of(std::span<const std::string> types, const std::string& type) {
    const auto found = std::find(types.begin(), types.end(), type);
    return found == types.end() ? -1 : static_cast<int>(found - types.begin());
}

void add_code(std::vector<CodeColumns>& codes, std::span<const std::string> types, char range,
              const std::string& code) {
    const CodeColumns c{column_of(types, range + code), column_of(types, "L" + code), column_of(types, "D" + code),
                        column_of(types, "S" + code)};
    if (c.pseudorange >= 0 || c.phase >= 0 || c.doppler >= 0) codes.push_back(c);
}

// In version 2 the band alone names the observation, and P is a code of its own: "C1" and "P1" share phase, Doppler and
// strength.
void add_codes_of_version_2(std::vector<CodeColumns>& codes, std::span<const std::string> types, Signal signal,
                            char band) {
    const auto add_band = [&](char one) {
        const bool precise_first = signal == Signal::l2;
        add_code(codes, types, precise_first ? 'P' : 'C', std::string(1, one));
        add_code(codes, types, precise_first ? 'C' : 'P', std::string(1, one));
    };
    add_band(band);
    if (signal == Signal::b1i) add_band('1');
}

// The signals of a system that can be found among its observation types, in the order of Signal.
// @param types "C1C", "L1C", … in the order of the fields; of version 2 "C1", "P2", …
// @param version of RINEX: 3.02 calls B1I "1I" where all others call it "2I"
std::vector<SignalColumns> signal_columns(Constellation system, std::span<const std::string> types, double version) {
    std::vector<SignalColumns> result;
    for (const Signal emulated : emulated_signals(system)) {
        const std::string_view codes = rinex_signal_codes(system, emulated).value();
        SignalColumns signal{emulated, {}};
        if (version < 3) {
            add_codes_of_version_2(signal.codes, types, emulated, codes[0]);
        } else {
            for (const char attribute : codes.substr(1))
                add_code(signal.codes, types, 'C', std::string{codes[0], attribute});
            // From 3.03 on "1X" is B1C.
            if (emulated == Signal::b1i)
                for (const char attribute : std::string_view(version < 3.025 ? "IXQ" : "I"))
                    add_code(signal.codes, types, 'C', std::string{'1', attribute});
        }
        if (!signal.codes.empty()) result.push_back(std::move(signal));
    }
    std::sort(result.begin(), result.end(),
              [](const SignalColumns& a, const SignalColumns& b) { return a.signal < b.signal; });
    return result;
}

constexpr std::string_view what_observations = "observations (RINEX 2.00-2.12, 3.00-3.05 or 4.00-4.02)";
constexpr std::size_t most_warnings = 20;

std::size_t index_of(Constellation system) { return static_cast<std::size_t>(system); }

// In the order of Constellation; SBAS keeps the time of GPS.
constexpr std::array<std::string_view, 7> time_systems{"GPS", "GPS", "GAL", "BDT", "QZS", "GLO", "IRN"};

}  // namespace

Result<void> ObservationHeaderReading::read(LineReader& lines) {
    if (auto version = version_line(lines); !version) return version;
    while (const std::optional<Line> line = lines.next()) {
        if (header_label(line->text) != "END OF HEADER") {
            take(*line);
            continue;
        }
        finish_layouts();
        const bool typed =
            std::any_of(layouts_.begin(), layouts_.end(), [](const SystemLayout& l) { return !l.types.empty(); });
        if (typed) return {};
        return refused(name_, line->number, "the end of the header",
                       major() == 2 ? "'# / TYPES OF OBSERV' before it" : "'SYS / # / OBS TYPES' before it");
    }
    return refused(name_, lines.number(), "the end of the file within the header", "'END OF HEADER' and epochs");
}

Result<void> ObservationHeaderReading::version_line(LineReader& lines) {
    const auto first = read_version_line(lines, name_, what_observations);
    if (!first) return fail(first.error());
    const auto& [line, version] = *first;
    if (line.text[20] != 'O')
        return refused(name_, line.number, fmt::format("file type {}", in_quotes(columns(line.text, 20, 1))),
                       what_observations);
    facts_.version = version;
    system_ = constellation_from_letter(line.text[40]).value_or(Constellation::gps);
    facts_.time_system = time_systems[index_of(system_)];
    return {};
}

void ObservationHeaderReading::change(const Line& line) {
    take(line);
    finish_layouts();
}

const SystemLayout* ObservationHeaderReading::layout(Constellation system) const {
    const SystemLayout& layout = layouts_[index_of(system)];
    return layout.types.empty() ? nullptr : &layout;
}

void ObservationHeaderReading::take(const Line& line) {
    const std::string_view label = header_label(line.text);
    if (!take_types(line, label)) take_facts(line, label);
}

bool ObservationHeaderReading::take_types(const Line& line, std::string_view label) {
    if (label == "# / TYPES OF OBSERV" && major() == 2) return types_of_version_2(line), true;
    if (label == "SYS / # / OBS TYPES" && major() >= 3) return types_of_version_3(line), true;
    if (label == "SYS / SCALE FACTOR" && major() >= 3) return scale_factors(line), true;
    return false;
}

void ObservationHeaderReading::take_facts(const Line& line, std::string_view label) {
    const auto words = [&](std::size_t first, std::size_t width) {
        return std::string(trimmed(columns(columns(line.text, 0, 60), first, width)));
    };
    if (label == "MARKER NAME") facts_.marker = words(0, 60);
    if (label == "REC # / TYPE / VERS") facts_.receiver = words(20, 20);
    if (label == "ANT # / TYPE") facts_.antenna = words(20, 20);
    if (label == "APPROX POSITION XYZ" || label == "ANTENNA: DELTA H/E/N") position(line);
    if (label == "LEAP SECONDS") leap_seconds(line);
    if (label == "TIME OF FIRST OBS") time_system(line);
    if (label == "GLONASS SLOT / FRQ #") glonass_channels(line);
    if (label != "INTERVAL") return;
    const std::optional<double> seconds = real_field(columns(line.text, 0, 10));
    if (!seconds || *seconds < 0) return warn(line, in_quotes(columns(line.text, 0, 10)), "an interval in seconds");
    if (*seconds > 0) facts_.interval = Seconds(*seconds);
}

void ObservationHeaderReading::types_of_version_2(const Line& line) {
    // One list for all systems; it is kept with GPS and copied at the end.
    const std::optional<int> count = whole_field(columns(line.text, 0, 6));
    if (!count || *count < 0 || *count > 999)
        return warn(line, in_quotes(columns(line.text, 0, 6)), "a number of observation types");
    if (!is_blank(columns(line.text, 0, 6))) {
        for (SystemLayout& l : layouts_)
            l = {};
        types_of_ = Constellation::gps;
        layouts_[index_of(*types_of_)].announced = static_cast<std::size_t>(*count);
    }
    add_types(line, 10, 6, 2, 9);
}

void ObservationHeaderReading::types_of_version_3(const Line& line) {
    if (!is_blank(columns(line.text, 0, 1))) {
        types_of_ = constellation_from_letter(line.text[0]);
        const std::optional<int> count = whole_field(columns(line.text, 3, 3));
        if (!types_of_ || !count || *count < 0) {
            types_of_.reset();
            return warn(line, in_quotes(columns(line.text, 0, 6)), "a system and its number of observation types");
        }
        layouts_[index_of(*types_of_)] = {};
        layouts_[index_of(*types_of_)].announced = static_cast<std::size_t>(*count);
    }
    add_types(line, 7, 4, 3, 13);
}

void ObservationHeaderReading::add_types(const Line& line, std::size_t first, std::size_t step, std::size_t width,
                                         std::size_t most) {
    if (!types_of_) return warn(line, in_quotes(columns(line.text, 0, 60)), "a list of types that begins with a count");
    auto& [types, announced, scale, signals] = layouts_[index_of(*types_of_)];
    const std::string_view content = columns(line.text, 0, 60);
    for (std::size_t i = 0; i < most && types.size() < announced; ++i) {
        const std::string_view type = trimmed(columns(content, first + step * i, width));
        if (type.empty()) break;
        types.emplace_back(type);
    }
    changed_ = true;
}

void ObservationHeaderReading::scale_factors(const Line& line) {
    if (!is_blank(columns(line.text, 0, 1))) {
        scaled_ = constellation_from_letter(line.text[0]);
        const std::optional<int> factor = whole_field(columns(line.text, 2, 4));
        factor_ = factor.value_or(0);
        if (!scaled_ || factor_ < 1) {
            scaled_.reset();
            return warn(line, in_quotes(columns(line.text, 0, 6)), "a system and a scale factor of 1 or more");
        }
    }
    if (!scaled_) return;
    SystemLayout& layout = layouts_[index_of(*scaled_)];
    layout.scale.resize(layout.types.size(), 1.0);
    std::vector<std::string_view> named = words_of(columns(columns(line.text, 0, 60), 6, 54));
    if (!is_blank(columns(line.text, 0, 1)) && !named.empty()) {
        constexpr int on_a_line = 12;
        const std::optional<int> count = whole_field(named.front());
        named.erase(named.begin());
        if (!count || std::min(*count, on_a_line) != static_cast<int>(named.size()))
            warn(line, fmt::format("{} observation types", named.size()), "as many as their count in front of them");
    }
    if (named.empty()) return layout.scale.assign(layout.types.size(), factor_);
    for (const std::string_view name : named) {
        const auto type = std::find_if(layout.types.begin(), layout.types.end(),
                                       [&](const std::string& one) { return trimmed(one) == name; });
        if (type == layout.types.end())
            warn(line, in_quotes(name), fmt::format("an observation type of {}", constellation_name(*scaled_)));
        else
            layout.scale[static_cast<std::size_t>(type - layout.types.begin())] = factor_;
    }
}

// Lists of types are used when they are complete: at the end of the header, or before the next epoch.
void ObservationHeaderReading::finish_layouts() {
    if (!changed_) return;
    changed_ = false;
    for (std::size_t i = 0; i < layouts_.size(); ++i)
        if (layouts_[i].types.size() != layouts_[i].announced)
            facts_.warnings.push_back(fmt::format("{}: found {} observation types of {}; expected the {} announced",
                                                  name_, layouts_[i].types.size(), constellation_names[i],
                                                  layouts_[i].announced));
    if (major() == 2) std::fill(layouts_.begin() + 1, layouts_.end(), SystemLayout(layouts_[0]));
    for (std::size_t i = 0; i < layouts_.size(); ++i) {
        SystemLayout& layout = layouts_[i];
        layout.scale.resize(layout.types.size(), 1.0);
        layout.signals = signal_columns(static_cast<Constellation>(i), layout.types, facts_.version);
    }
}

void ObservationHeaderReading::glonass_channels(const Line& line) {
    const std::string_view content = columns(line.text, 0, 60);
    for (std::size_t at = 4; at < 60; at += 7) {
        const std::string_view entry = columns(content, at, 6);
        if (is_blank(entry)) continue;
        const std::optional<SatelliteId> slot = parse_satellite(columns(entry, 0, 3));
        const std::optional<int> channel = whole_field(columns(entry, 3, 3));
        if (!slot || slot->constellation != Constellation::glonass || !channel || *channel < -13 || *channel > 24)
            return warn(line, in_quotes(entry), "a slot and its channel such as 'R03  5'");
        facts_.glonass_channels[slot->number] = *channel;
    }
}

void ObservationHeaderReading::position(const Line& line) {
    std::array<double, 3> v{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string_view field = columns(line.text, 14 * i, 14);
        const std::optional<double> value = real_field(field);
        if (!value) return warn(line, in_quotes(field), "three lengths in metres");
        v[i] = *value;
    }
    if (header_label(line.text) == "ANTENNA: DELTA H/E/N")
        facts_.antenna_delta = {Metres(v[0]), Metres(v[1]), Metres(v[2])};
    else if (v[0] != 0 || v[1] != 0 || v[2] != 0)
        facts_.approximate_position = Position<Ecef>(v[0], v[1], v[2]);
}

void ObservationHeaderReading::leap_seconds(const Line& line) {
    const auto announced = announced_leap_seconds(line.text);
    if (!announced) return warn(line, announced.error(), "the number of leap seconds");
    if (*announced) facts_.leap_seconds = *announced;
}

void ObservationHeaderReading::time_system(const Line& line) {
    const std::string_view system = trimmed(columns(line.text, 48, 3));
    if (system.empty()) return;
    if (std::find(time_systems.begin(), time_systems.end(), system) == time_systems.end())
        return warn(line, in_quotes(system), "a time system: GPS, GLO, GAL, QZS, BDT or IRN");
    facts_.time_system = std::string(system);
}

void ObservationHeaderReading::warn(const Line& line, std::string_view found, std::string_view expected) {
    if (facts_.warnings.size() >= most_warnings) return;
    facts_.warnings.push_back(
        fmt::format("{}:{}: found {}; expected {}; line passed over", name_, line.number, found, expected));
}

}  // namespace skyloop::inline world::rinex
