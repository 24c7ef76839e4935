#include "detail/navigation_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace skyloop::inline world::rinex {
namespace {

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

constexpr std::string_view what_is_read = "navigation data (RINEX 2.00-2.12, 3.00-3.05 or 4.00-4.02)";

// Version 2 has a file type for each system.
std::optional<Constellation> version_2_system(char type, char system) {
    // The system may follow, as from version 3 on.
    if (type == 'N') return constellation_from_letter(system).value_or(Constellation::gps);
    using enum Constellation;
    static constexpr std::array<std::pair<char, Constellation>, 7> of_one_system{
        {{'G', glonass}, {'H', sbas}, {'E', galileo}, {'L', galileo}, {'J', qzss}, {'Q', qzss}, {'C', beidou}}};
    for (const auto& [letter, its_system] : of_one_system)
        if (letter == type) return its_system;
    return std::nullopt;
}

// What a file of this type holds when it is not what is read, or an empty text.
std::string other_content(int major, char type, char system) {
    if (type == 'O') return "a file of observations (type 'O')";
    if (type == 'M') return "a file of meteorological data (type 'M')";
    if (major == 2 ? !version_2_system(type, system).has_value() : type != 'N')
        return fmt::format("file type {}", in_quotes(std::string_view(&type, 1)));
    if (major == 2 || system == 'M' || system == ' ' || constellation_from_letter(system)) return {};
    return fmt::format("satellite system {}", in_quotes(std::string_view(&system, 1)));
}

// The values of one header line as they accumulate to a NavigationHeader.
class HeaderReading {
public:
    explicit HeaderReading(std::string_view name) : name_(name) {}

    void take(const Line& line) {
        const std::string_view label = header_label(line.text);
        if (label == "ION ALPHA") coefficients(line, 2, pairs_[0].alpha);
        if (label == "ION BETA") coefficients(line, 2, pairs_[0].beta);
        if (label == "IONOSPHERIC CORR") ionosphere(line);
        if (label == "TIME SYSTEM CORR") time_correction(line, {5, 22, 38, 45});
        if (label == "DELTA-UTC: A0,A1,T,W") time_correction(line, {3, 22, 41, 50});
        if (label == "CORR TO SYSTEM TIME") time_correction(line, {21, 40, 60, 60});
        if (label == "LEAP SECONDS") leap_seconds(line);
        if (std::find(known_labels.begin(), known_labels.end(), label) == known_labels.end()) unknown(line);
    }
    [[nodiscard]] const std::optional<Line>& first_unknown() const { return first_unknown_; }

    // Completes what the first line has told.
    [[nodiscard]] NavigationHeader finish(NavigationHeader header) {
        header.leap_seconds = leap_seconds_;
        BroadcastIonosphere& ionosphere = header.ionosphere;
        const std::array targets{&ionosphere.gps, &ionosphere.qzss, &ionosphere.beidou, &ionosphere.navic};
        for (std::size_t i = 0; i < targets.size(); ++i) {
            if (pairs_[i].alpha && pairs_[i].beta)
                if (const KlobucharCoefficients told{*pairs_[i].alpha, *pairs_[i].beta};
                    told != KlobucharCoefficients{})
                    *targets[i] = told;
            if (pairs_[i].alpha.has_value() != pairs_[i].beta.has_value() && warnings_.empty())
                warnings_.push_back(
                    fmt::format("{}: found only one of the two lines of ionosphere coefficients{}; expected alpha and "
                                "beta; none used",
                                name_, i == 0 ? "" : fmt::format(" of {}", klobuchar_letters[i])));
        }
        if (galileo_)
            if (const std::array told{(*galileo_)[0], (*galileo_)[1], (*galileo_)[2]}; told != std::array<double, 3>{})
                ionosphere.galileo = told;
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
    struct CoefficientPair {
        Coefficients alpha, beta;
    };
    // Of the systems with Klobuchar's model, in the order of pairs_.
    static constexpr std::array<std::string_view, 4> klobuchar_letters{"GPS", "QZS", "BDS", "IRN"};

    void ionosphere(const Line& line) {
        if (line.text.starts_with("GAL")) return coefficients(line, 5, galileo_);
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (!line.text.starts_with(klobuchar_letters[i]) || line.text.size() < 4) continue;
            if (line.text[3] == 'A') coefficients(line, 5, pairs_[i].alpha);
            if (line.text[3] == 'B') coefficients(line, 5, pairs_[i].beta);
        }
    }
    // Nobody uses these, but a damaged one is told. Columns of a0, a1, the reference's time of week and its week; the
    // line is as long as the last of them at most.
    void time_correction(const Line& line, const std::array<std::size_t, 4>& at) {
        const std::string_view content = columns(line.text, 0, 60);
        if (is_blank(content)) return;
        const auto a0 = real_field(columns(content, at[0], at[1] - at[0]));
        const auto a1 = real_field(columns(content, at[1], at[2] - at[1] > 19 ? 19 : at[2] - at[1]));
        const auto tow = real_field(columns(content, at[2], at[3] - at[2]));
        const auto week = whole_field(columns(content, at[3], at[0] == 5 ? 5 : 9));
        if (!a0 || !a1 || !tow || !week)
            warn_field(line, at[0], columns(content, at[0], 60 - at[0]), "a time system correction");
    }
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
        const auto announced = announced_leap_seconds(line.text);
        if (!announced) return warn_field(line, 0, columns(line.text, 0, 6), "the number of leap seconds");
        if (*announced) leap_seconds_ = *announced;
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
    std::array<CoefficientPair, 4> pairs_;
    Coefficients galileo_;
    std::optional<int> leap_seconds_;
    std::vector<std::string> warnings_;
    std::optional<Line> first_unknown_;
    int unknown_ = 0;
};

}  // namespace

Result<NavigationHeader> read_header(LineReader& lines, std::string_view name) {
    const auto first = read_version_line(lines, name, what_is_read, ", or the first line of a YUMA or SEM almanac");
    if (!first) return fail(first.error());
    NavigationHeader header;
    header.version = first->version;
    const char type = first->line.text[20], system = first->line.text[40];
    const std::string other = other_content(header.major(), type, system);
    if (!other.empty()) return refused(name, first->line.number, other, what_is_read);
    header.system = version_2_system(type, system).value_or(Constellation::gps);

    HeaderReading reading(name);
    while (const std::optional<Line> line = lines.next()) {
        if (header_label(line->text) == end_label) return reading.finish(std::move(header));
        reading.take(*line);
    }
    const std::optional<Line>& unknown = reading.first_unknown();
    if (unknown)
        return refused(name, unknown->number, fmt::format("{} in a header without an end", in_quotes(unknown->text)),
                       "a header line, or 'END OF HEADER' before the records");
    return refused(name, lines.number(), "the end of the file within the header", "'END OF HEADER' and records");
}

}  // namespace skyloop::inline world::rinex
