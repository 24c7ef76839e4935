#include "skyloop/rinex/navigation_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "fields.hpp"
#include "navigation_header.hpp"
#include "navigation_record.hpp"
#include "skyloop/base/text_file.hpp"

namespace skyloop {
namespace rinex {
namespace {

// What is wrong with records of one kind: the first of them in words, and how many there are.
struct DefectTally {
    std::string first;
    int count = 0;
    void add(std::string sentence) {
        if (count++ == 0) first = std::move(sentence);
    }
};

class NavigationReading {
public:
    NavigationReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<NavigationFile> read() {
        Result<NavigationHeader> header = read_header(lines_, name_);
        if (!header) return fail(header.error());
        major_ = header->major();
        file_.version = header->version;
        file_.klobuchar = header->klobuchar;
        file_.leap_seconds = header->leap_seconds;
        file_.warnings = std::move(header->warnings);

        advance();
        while (line_) {
            if (major_ >= 4)
                block();
            else
                record();
        }
        if (file_.records.empty()) return nothing_read();
        warn();
        return std::move(file_);
    }

private:
    void advance() {
        do
            line_ = lines_.next();
        while (line_ && is_blank(line_->text));
    }
    // A line that continues the record at hand.
    [[nodiscard]] bool continues() const { return line_ && !begins_record(line_->text, major_); }
    void skip_record() {
        do
            advance();
        while (continues());
    }

    // Version 4: "> EPH G02 LNAV" and the lines up to the next ">".
    void block() {
        if (!line_->text.starts_with('>')) return stray();
        const Line head = *line_;
        const std::string_view type = trimmed(columns(head.text, 2, 4));
        const std::optional<SatelliteId> satellite = parse_satellite(columns(head.text, 6, 3));
        const std::string_view message = trimmed(columns(head.text, 10, 4));
        advance();
        if (type == "EPH" && satellite && message == "LNAV" && is_read(*satellite) && line_ &&
            begins_record(line_->text, major_))
            return record();
        if (type == "EPH" && satellite && !is_read(*satellite))
            ++file_.skipped.other_systems[satellite->constellation];
        else if (type == "ION" && satellite && satellite->constellation == Constellation::gps && message == "LNAV")
            ionosphere();
        else if (type == "EPH" && satellite && message != "LNAV" && !message.empty())
            ++file_.skipped.messages[std::string(message)];
        else if (type == "STO" || type == "EOP" || type == "ION")
            ++file_.skipped.messages[std::string(type)];
        else
            defective_.add(sentence(head.number, in_quotes(head.text), "a block header such as '> EPH G02 LNAV'"));
        while (line_ && !line_->text.starts_with('>'))
            advance();
    }

    // GPS coefficients of a version 4 block: epoch and three of them, four, one.
    void ionosphere() {
        std::array<double, 8> values{};
        bool good = true;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t field = i + 1;  // the epoch takes the first place
            if (field % 4 == 0) advance();
            const std::size_t column = i < 3 ? 23 + 19 * i : 4 + 19 * (field % 4);
            const auto value = line_ ? real_field(columns(line_->text, column, 19)) : std::nullopt;
            good = good && value && line_->text.starts_with(' ');
            values[i] = value.value_or(0);
        }
        if (!good)
            tally(file_.skipped.defective, defective_, lines_.number(), "a damaged ionosphere block",
                  "eight coefficients in three lines");
        else if (!file_.klobuchar)
            file_.klobuchar = {{values[0], values[1], values[2], values[3]},
                               {values[4], values[5], values[6], values[7]}};
    }

    static bool is_read(SatelliteId satellite) {
        return satellite.constellation == Constellation::gps || satellite.constellation == Constellation::qzss;
    }

    void record() {
        if (continues()) return stray();
        const Line first = *line_;
        const std::optional<SatelliteId> satellite = record_satellite(first.text, major_);
        if (!satellite) {
            tally(file_.skipped.defective, defective_, first.number, in_quotes(columns(first.text, 0, 3)),
                  major_ == 2 ? "a satellite number" : "a satellite such as 'G07'");
            return skip_record();
        }
        if (!is_read(*satellite)) {
            ++file_.skipped.other_systems[satellite->constellation];
            return skip_record();
        }
        lnav(*satellite, first);
    }

    void lnav(SatelliteId satellite, const Line& first) {
        std::array<Line, lnav_lines> lines{first};
        std::size_t count = 1;
        // Within a record a blank line is one whose fields are all blank.
        for (line_ = lines_.next(); count < lnav_lines && continues(); line_ = lines_.next())
            lines[count++] = *line_;
        if (line_ && is_blank(line_->text)) advance();
        if (count < lnav_lines)
            return tally(file_.skipped.incomplete, incomplete_, first.number,
                         fmt::format("a record of {} cut off after {} of its lines", to_string(satellite), count),
                         fmt::format("{} lines", lnav_lines));
        auto read = read_lnav_record(satellite, lines, major_);
        if (read) return file_.records.push_back(*read);
        ++file_.skipped.defective;
        defective_.add(fmt::format("{}:{}:{}: found {}; expected {}", name_, read.error().line, read.error().column,
                                   read.error().found, read.error().expected));
    }

    void stray() {
        stray_.add(sentence(line_->number, in_quotes(line_->text), "the first line of a record"));
        advance();
    }

    [[nodiscard]] std::string sentence(int line, std::string_view found, std::string_view expected) const {
        return fmt::format("{}:{}: found {}; expected {}", name_, line, found, expected);
    }
    void tally(int& counter, DefectTally& tally, int line, std::string_view found, std::string_view expected) const {
        ++counter;
        tally.add(sentence(line, found, expected));
    }

    [[nodiscard]] std::string other_systems() const {
        std::vector<std::string> parts;
        for (const auto& [constellation, count] : file_.skipped.other_systems)
            parts.push_back(fmt::format("{} of {}", count, constellation_title(constellation)));
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    Result<NavigationFile> nothing_read() const {
        for (const DefectTally* t : {&defective_, &incomplete_, &stray_})
            if (t->count > 0) return fail(ErrorCode::input, t->first + "; no record could be read");
        if (!file_.skipped.other_systems.empty())
            return fail(ErrorCode::input,
                        sentence(lines_.number(), fmt::format("only records of other systems ({})", other_systems()),
                                 "records of GPS or QZSS"));
        return fail(ErrorCode::input, sentence(lines_.number(), "the end of the file and no ephemeris",
                                               "records of GPS or QZSS after the header"));
    }

    void warn() {
        const auto defects = [&](const DefectTally& t, std::string_view what) {
            if (t.count == 0) return;
            file_.warnings.push_back(
                fmt::format("{}; {} skipped{}", t.first, what,
                            t.count > 1 ? fmt::format(", and {} more likewise", t.count - 1) : ""));
        };
        defects(defective_, "record");
        defects(incomplete_, "record");
        defects(stray_, "line");
        if (!file_.skipped.other_systems.empty())
            file_.warnings.push_back(fmt::format(
                "{}: skipped records of other systems ({}): this version reads GPS and QZSS", name_, other_systems()));
        if (!file_.skipped.messages.empty())
            file_.warnings.push_back(
                fmt::format("{}: skipped other messages ({}): this version reads LNAV ephemerides", name_, messages()));
    }
    [[nodiscard]] std::string messages() const {
        std::vector<std::string> parts;
        for (const auto& [message, count] : file_.skipped.messages)
            parts.push_back(fmt::format("{} {}", count, in_quotes(message)));
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    LineReader lines_;
    std::string_view name_;
    int major_ = 2;
    std::optional<Line> line_;
    NavigationFile file_;
    DefectTally defective_;
    DefectTally incomplete_;
    DefectTally stray_;
};

}  // namespace
}  // namespace rinex

Result<NavigationFile> read_navigation(std::string_view text, std::string_view name) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    return rinex::NavigationReading(text, name).read();
}

Result<NavigationFile> read_navigation_file(const std::filesystem::path& path) {
    const Result<std::string> text = read_text_file(path);
    if (!text) return fail(text.error());
    return read_navigation(*text, path.string());
}

}  // namespace skyloop
