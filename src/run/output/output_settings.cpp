#include "run/output/output_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::array<std::string_view, 4> way_names{"udp", "tcp", "tcp-to", "file"};
constexpr std::array<std::string_view, 10> option_names{"receiver", "when",    "system", "component", "id",
                                                        "eph",      "station", "msm",    "every_s",   "ephemerides_s"};

template <std::size_t count>
std::optional<std::size_t> index_in(const std::array<std::string_view, count>& names, std::string_view name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
}

std::string known_schemes() {
    return "gps-input:HOST:PORT hil-gps:HOST:PORT msp-tcp:[HOST:]PORT msp-tcp-to:HOST:PORT json-udp:HOST:PORT "
           "json-tcp:[HOST:]PORT json-file:PATH rtcm-tcp:[HOST:]PORT rtcm-udp:HOST:PORT rtcm-file:PATH";
}

/// @return the sentence of what is wrong; empty: nothing
template <class Value, std::size_t count>
std::string take_word(std::string_view key, std::string_view text, const std::array<std::string_view, count>& names,
                      Value& value) {
    const auto index = index_in(names, text);
    if (!index)
        return fmt::format("{} '{}' is unknown; expected one of {}{}", key, text, fmt::join(names, " "),
                           did_you_mean(text, names));
    value = static_cast<Value>(*index);
    return {};
}

struct WholeRange {
    int least, most;
};
template <class Value>
std::string take_number(std::string_view key, std::string_view text, const WholeRange& range, Value& value) {
    const auto number = number_in<int>(text);
    if (!number || *number < range.least || *number > range.most)
        return fmt::format("{} '{}': expected a whole number from {} to {}", key, text, range.least, range.most);
    value = static_cast<Value>(*number);
    return {};
}

std::string take_rtcm_option(std::string_view key, std::string_view value, OutputSettings& settings) {
    if (key == "station") return take_number(key, value, {0, 4095}, settings.station);
    if (key == "msm") return take_number(key, value, {4, 7}, settings.msm);
    if (key == "every_s") return take_number(key, value, {1, 3600}, settings.every_s);
    if (key == "ephemerides_s") return take_number(key, value, {0, 3600}, settings.ephemerides_s);
    return fmt::format("option '{}' is unknown; expected one of {}{}", key, fmt::join(option_names, " "),
                       did_you_mean(key, option_names));
}

std::string take_option(std::string_view key, std::string_view value, OutputSettings& settings) {
    if (const auto foreign = foreign_option(settings.format, key); !foreign.empty()) return foreign;
    if (key == "receiver") {
        settings.receiver = value;
        return value.empty() ? "receiver is empty; expected a name" : "";
    }
    if (key == "when") return take_word(key, value, output_moment_names, settings.when);
    if (key == "system") return take_number(key, value, {1, 255}, settings.system);
    if (key == "component") return take_number(key, value, {1, 255}, settings.component);
    if (key == "id") return take_number(key, value, {0, 255}, settings.id);
    if (key == "eph") return take_word(key, value, hil_gps_accuracy_names, settings.eph);
    return take_rtcm_option(key, value, settings);
}

std::string take_scheme(std::string_view scheme, OutputSettings& settings) {
    // The longest format that the scheme begins with: none begins with another.
    for (std::size_t i = 0; i < output_format_names.size(); ++i) {
        if (!scheme.starts_with(output_format_names[i])) continue;
        settings.format = static_cast<OutputFormat>(i);
        std::string_view way = scheme.substr(output_format_names[i].size());
        const bool mavlink = settings.format == OutputFormat::gps_input || settings.format == OutputFormat::hil_gps;
        if (way.empty() && mavlink) return {};
        const auto index = way.starts_with('-') ? index_in(way_names, way.substr(1)) : std::nullopt;
        if (!index) break;
        settings.way = static_cast<OutputWay>(*index);
        return {};
    }
    return fmt::format("'{}' is no output; expected {}", scheme, known_schemes());
}

std::string take_target(std::string_view target, OutputSettings& settings) {
    if (settings.way == OutputWay::file) {
        settings.path = target;
        return target.empty() ? "the path is missing; expected a path, or - for standard output" : "";
    }
    auto address = parse_tcp_address(target);
    if (!address) return address.error().message;
    settings.address = std::move(*address);
    if (settings.way == OutputWay::tcp_server) return {};
    if (target.find(':') == std::string_view::npos) return "the host is missing; expected HOST:PORT";
    return settings.address.port == 0 ? "port 0 cannot be sent to; expected 1 to 65535" : "";
}

// Whether what follows a comma is an option: in the name of a file it need not be one.
bool is_option(std::string_view piece, OutputWay way) {
    const std::size_t equals = piece.find('=');
    if (way != OutputWay::file) return true;
    return equals != std::string_view::npos && index_in(option_names, piece.substr(0, equals)).has_value();
}

// The formats that have an option which not all have.
std::vector<OutputFormat> formats_of(std::string_view key) {
    if (key == "system" || key == "component") return {OutputFormat::gps_input, OutputFormat::hil_gps};
    if (key == "id") return {OutputFormat::gps_input, OutputFormat::hil_gps, OutputFormat::msp};
    if (key == "eph") return {OutputFormat::hil_gps};
    if (key == "station" || key == "msm" || key == "every_s" || key == "ephemerides_s") return {OutputFormat::rtcm};
    return {};
}

std::string_view name_of(OutputFormat format) { return output_format_names[static_cast<std::size_t>(format)]; }

}  // namespace

std::string foreign_option(OutputFormat format, std::string_view key) {
    const std::vector<OutputFormat> formats = formats_of(key);
    if (formats.empty() || std::find(formats.begin(), formats.end(), format) != formats.end()) return {};
    std::vector<std::string_view> names;
    for (const OutputFormat one : formats)
        names.push_back(name_of(one));
    return fmt::format("'{}' is an option of {}; {} does not have it", key, fmt::join(names, ", "), name_of(format));
}

Result<OutputSettings> parse_output_uri(std::string_view text) {
    OutputSettings settings;
    const auto refused = [&](const std::string& sentence) {
        return fail(ErrorCode::usage, fmt::format("output '{}': {}", text, sentence));
    };
    const std::size_t colon = std::min(text.find(':'), text.size());
    if (const auto wrong = take_scheme(text.substr(0, colon), settings); !wrong.empty()) return refused(wrong);
    if (settings.format == OutputFormat::json) settings.when = OutputMoment::epoch;
    std::set<std::string_view> taken;
    std::string_view rest = colon < text.size() ? text.substr(colon + 1) : std::string_view();
    for (std::size_t comma = rest.rfind(','); comma != std::string_view::npos; comma = rest.rfind(',')) {
        const std::string_view piece = rest.substr(comma + 1);
        if (!is_option(piece, settings.way)) break;
        const std::size_t equals = piece.find('=');
        if (equals == std::string_view::npos) return refused(fmt::format("'{}': expected KEY=VALUE", piece));
        const std::string_view key = piece.substr(0, equals);
        if (!taken.insert(key).second) return refused(fmt::format("'{}' is there twice; expected it once", key));
        const auto wrong = take_option(key, piece.substr(equals + 1), settings);
        if (!wrong.empty()) return refused(wrong);
        rest = rest.substr(0, comma);
    }
    if (const auto wrong = take_target(rest, settings); !wrong.empty()) return refused(wrong);
    settings.uri = text.substr(0, colon + 1 + rest.size());
    return settings;
}

Result<std::vector<bool>> told_receivers(const OutputSettings& settings, const std::vector<std::string>& names) {
    std::vector<bool> told(names.size(), settings.receiver.empty() && settings.format == OutputFormat::json);
    if (settings.receiver.empty()) {
        if (!told.empty()) told.front() = true;
        return told;
    }
    const auto found = std::find(names.begin(), names.end(), settings.receiver);
    if (found == names.end())
        return fail(ErrorCode::usage,
                    fmt::format("output '{}': receiver '{}' is no receiver of this scenario; expected one of {}",
                                settings.uri, settings.receiver, fmt::join(names, ", ")));
    told[static_cast<std::size_t>(found - names.begin())] = true;
    return told;
}

}  // namespace skyloop::inline run
