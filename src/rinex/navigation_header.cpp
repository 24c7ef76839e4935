#include "navigation_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace skyloop::rinex {
namespace {

constexpr std::string_view version_label = "RINEX VERSION / TYPE";
constexpr std::string_view end_label = "END OF HEADER";

// Every label of the navigation headers of RINEX 2.00 to 4.02, so that a misspelt one is noticed.
constexpr std::array<std::string_view, 18> known_labels{
    "PGM / RUN BY / DATE",
    "COMMENT",
    "ION ALPHA",
    "ION BETA",
    "DELTA-UTC: A0,A1,T,W",
    "LEAP SECONDS",
    "CORR TO SYSTEM TIME",
    "IONOSPHERIC CORR",
    "TIME SYSTEM CORR",
    "REC # / TYPE / VERS",
    "D-UTC A0,A1,T,W,S,U",
    "DOI",
    "LICENSE OF USE",
    "STATION INFORMATION",
    "MERGED FILE",
    "MARKER NAME",
    "MARKER NUMBER",
    "APPROX POSITION XYZ",
};

constexpr std::string_view what_is_read = "GPS navigation data (RINEX 2.00-2.12, 3.00-3.05 or 4.00-4.02)";

std::string_view label_of(std::string_view line) { return trimmed(columns(line, 60, 20)); }

tl::unexpected<Error> header_error(std::string_view name, int line, std::string_view found, std::string_view expected) {
    return fail(ErrorCode::input, fmt::format("{}:{}: found {}; expected {}", name, line, found, expected));
}

bool supported(double version) {
    return (version >= 2.0 && version < 2.125) || (version >= 3.0 && version < 3.055) ||
           (version >= 4.0 && version < 4.025);
}

// What a file of this type holds when it is not what is read, or an empty text.
std::string other_content(int major, char type, char system) {
    if (type == 'O') return "a file of observations (type 'O')";
    if (type == 'M') return "a file of meteorological data (type 'M')";
    if (major == 2 && type == 'G') return "a GLONASS navigation file (type 'G')";
    if (major == 2 && type == 'H') return "an SBAS navigation file (type 'H')";
    if (major == 2 && type == 'E') return "a Galileo navigation file (type 'E')";
    if (type != 'N') return fmt::format("file type {}", in_quotes(std::string_view(&type, 1)));
    if (major == 2 || system == 'G' || system == 'J' || system == 'M' || system == ' ') return {};
    if (const auto constellation = constellation_from_letter(system))
        return fmt::format("{} {} navigation file (system '{}')", system == 'S' ? "an" : "a",
                           constellation_title(*constellation), system);
    return fmt::format("satellite system {}", in_quotes(std::string_view(&system, 1)));
}

Result<double> read_version(const Line& line, std::string_view name) {
    if (label_of(line.text) != version_label)
        return header_error(name, line.number, line.text.empty() ? "an empty line" : in_quotes(line.text),
                            fmt::format("a RINEX header, its label '{}' in columns 61-80", version_label));
    const std::string_view field = columns(line.text, 0, 20);
    const std::optional<double> version = real_field(field);
    if (!version || !supported(*version))
        return header_error(name, line.number, fmt::format("RINEX version {}", in_quotes(field)), what_is_read);
    const char type = line.text[20];
    const char system = line.text[40];
    const std::string other = other_content(static_cast<int>(*version), type, system);
    if (!other.empty()) return header_error(name, line.number, other, what_is_read);
    return *version;
}

// The values of one header line as they accumulate to a NavigationHeader.
class HeaderReading {
public:
    explicit HeaderReading(std::string_view name) : name_(name) {}

    void take(const Line& line) {
        const std::string_view label = label_of(line.text);
        if (label == "ION ALPHA") coefficients(line, 2, alpha_);
        if (label == "ION BETA") coefficients(line, 2, beta_);
        if (label == "IONOSPHERIC CORR" && line.text.starts_with("GPSA")) coefficients(line, 5, alpha_);
        if (label == "IONOSPHERIC CORR" && line.text.starts_with("GPSB")) coefficients(line, 5, beta_);
        if (label == "LEAP SECONDS") leap_seconds(line);
        if (std::find(known_labels.begin(), known_labels.end(), label) == known_labels.end()) unknown(line);
    }
    [[nodiscard]] const std::optional<Line>& first_unknown() const { return first_unknown_; }

    [[nodiscard]] NavigationHeader finish(double version) {
        NavigationHeader header;
        header.version = version;
        header.leap_seconds = leap_seconds_;
        if (alpha_ && beta_) header.klobuchar = KlobucharCoefficients{*alpha_, *beta_};
        if (alpha_.has_value() != beta_.has_value() && warnings_.empty())
            warnings_.push_back(
                fmt::format("{}: found only one of the two lines of ionosphere coefficients; expected alpha and "
                            "beta; none used",
                            name_));
        if (first_unknown_)
            warnings_.push_back(
                fmt::format("{}:{}: found {} without a known label in columns 61-80; expected a RINEX header "
                            "line; {} passed over",
                            name_, first_unknown_->number, in_quotes(first_unknown_->text),
                            unknown_ == 1 ? "1 line" : fmt::format("{} lines", unknown_)));
        header.warnings = std::move(warnings_);
        return header;
    }

private:
    using Coefficients = std::optional<std::array<double, 4>>;

    void coefficients(const Line& line, std::size_t first, Coefficients& target) {
        if (target || is_blank(columns(line.text, first, 48))) return;
        std::array<double, 4> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t column = first + 12 * i;
            const std::string_view field = columns(line.text, column, 12);
            const std::optional<double> value = real_field(field);
            if (!value) return warn_field(line, column, field, "an ionosphere coefficient");
            values[i] = *value;
        }
        target = values;
    }
    void leap_seconds(const Line& line) {
        // Columns 25-27 may name the time scale; BDT counts leap seconds from another epoch.
        if (is_blank(columns(line.text, 0, 6)) || columns(line.text, 24, 3) == "BDS") return;
        const std::optional<int> value = whole_field(columns(line.text, 0, 6));
        if (value && *value >= 0 && *value < 1000)
            leap_seconds_ = value;
        else
            warn_field(line, 0, columns(line.text, 0, 6), "the number of leap seconds");
    }
    void warn_field(const Line& line, std::size_t column, std::string_view field, std::string_view expected) {
        warnings_.push_back(fmt::format("{}:{}:{}: found {}; expected {}; line passed over", name_, line.number,
                                        column + 1, in_quotes(field), expected));
    }
    void unknown(const Line& line) {
        if (is_blank(line.text)) return;
        if (!first_unknown_) first_unknown_ = line;
        ++unknown_;
    }

    std::string_view name_;
    Coefficients alpha_;
    Coefficients beta_;
    std::optional<int> leap_seconds_;
    std::vector<std::string> warnings_;
    std::optional<Line> first_unknown_;
    int unknown_ = 0;
};

}  // namespace

Result<NavigationHeader> read_header(LineReader& lines, std::string_view name) {
    std::optional<Line> line = lines.next();
    while (line && is_blank(line->text))
        line = lines.next();
    if (!line) return header_error(name, lines.number(), "an empty file", what_is_read);
    const Result<double> version = read_version(*line, name);
    if (!version) return fail(version.error());

    HeaderReading reading(name);
    while ((line = lines.next())) {
        if (label_of(line->text) == end_label) return reading.finish(*version);
        reading.take(*line);
    }
    const std::optional<Line>& unknown = reading.first_unknown();
    if (unknown)
        return header_error(name, unknown->number,
                            fmt::format("{} in a header without an end", in_quotes(unknown->text)),
                            "a header line, or 'END OF HEADER' before the records");
    return header_error(name, lines.number(), "the end of the file within the header", "'END OF HEADER' and records");
}

}  // namespace skyloop::rinex
