#include "detail/compact_observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/core/files.hpp"
#include "detail/fields.hpp"

namespace skyloop::inline world::rinex {
namespace {

constexpr int highest_order = 9, most_types = 200;

// A series of whole numbers of which each is told by its difference to those before it.
class DifferenceArc {
public:
    // "3&23456789" begins a series with differences up to the third, "-12" goes on. False where neither can be.
    bool take(std::string_view field) {
        const bool begins = field.size() > 1 && field[1] == '&';
        if (begins) {
            order_ = field[0] - '0';
            known_ = 0;
            field.remove_prefix(2);
        }
        std::int64_t number = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
        const bool read = error == std::errc{} && end == field.data() + field.size() && is_small(number);
        if (!read || order_ < 0 || order_ > highest_order || (known_ == 0 && !begins)) return end_series();
        const auto added = static_cast<std::size_t>(std::min(known_, order_));
        std::array<std::int64_t, highest_order + 1> now{};
        now[added] = number;
        for (std::size_t i = added; i > 0; --i) {
            now[i - 1] = now[i] + differences_[i - 1];
            if (!is_small(now[i - 1])) return end_series();
        }
        differences_ = now;
        known_ = std::min(known_ + 1, order_ + 1);
        return true;
    }
    bool end_series() {
        known_ = 0;
        return false;
    }
    [[nodiscard]] bool any() const { return known_ > 0; }
    [[nodiscard]] std::int64_t value() const { return differences_[0]; }

private:
    // Ninth differences of numbers of 14 digits are smaller, and the sum of two such still is a number.
    static bool is_small(std::int64_t number) { return number < (1LL << 60) && number > -(1LL << 60); }

    int order_ = -1, known_ = 0;
    std::array<std::int64_t, highest_order + 1> differences_{};
};

// A text that is told by what differs from the one before: a blank where nothing does, '&' for a blank.
void apply_changes(std::string& text, std::string_view changes) {
    if (changes.size() > text.size()) text.resize(changes.size(), ' ');
    for (std::size_t i = 0; i < changes.size(); ++i)
        if (changes[i] != ' ') text[i] = changes[i] == '&' ? ' ' : changes[i];
}

// Nothing where it does not fit.
std::optional<std::string> decimal_field(std::int64_t value, int decimals, std::size_t width) {
    std::string digits = fmt::format("{:0{}}", value < 0 ? -value : value, decimals + 1);
    digits.insert(digits.size() - static_cast<std::size_t>(decimals), ".");
    if (value < 0) digits.insert(0, "-");
    if (digits.size() > width) return std::nullopt;
    return digits.insert(0, width - digits.size(), ' ');
}

struct CompactSatellite {
    std::vector<DifferenceArc> arcs;
    std::string flags;
};

class CompactReading {
public:
    CompactReading(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<std::string> read() {
        if (const auto begun = header(); !begun) return fail(begun.error());
        while (next()) {
            const bool escaped = version_ == 3 && line_.starts_with('&');
            if (escaped || is_blank(line_)) continue;
            if (const auto done = epoch(); !done) return fail(done.error());
            if (out_.size() > max_text_file_size)
                return refuse("more text than can be read", fmt::format("at most {} bytes", max_text_file_size));
        }
        return std::move(out_);
    }

private:
    using Refusal = tl::unexpected<Error>;

    [[nodiscard]] Refusal refuse(std::string_view found, std::string_view expected) const {
        return refused(name_, lines_.number(), found, expected);
    }
    [[nodiscard]] Refusal refuse_end(std::string_view where) const {
        return refuse(fmt::format("the end of the file within {}", where), "a whole compact RINEX file");
    }
    bool next() {
        const auto line = lines_.next();
        line_ = line ? line->text : std::string_view();
        return line.has_value();
    }
    // Without blanks at its end.
    void write(std::string_view line) {
        out_ += line.substr(0, line.find_last_not_of(' ') + 1);
        out_ += '\n';
    }

    Result<void> header() {
        next();
        version_ = columns(line_, 0, 20).starts_with("1.0") ? 1 : columns(line_, 0, 20).starts_with("3.") ? 3 : 0;
        if (version_ == 0)
            return refuse(fmt::format("compact RINEX version {}", in_quotes(columns(line_, 0, 20))), "1.0 or 3.0");
        next();  // by which program
        do {
            if (!next()) return refuse_end("the header");
            take_header_line();
        } while (header_label(line_) != "END OF HEADER");
        return {};
    }

    void take_header_line() {
        write(line_);
        const std::string_view label = header_label(line_);
        if (label == "# / TYPES OF OBSERV" && !is_blank(columns(line_, 0, 6)))
            types_[' '] = whole_field(columns(line_, 0, 6)).value_or(0);
        if (label == "SYS / # / OBS TYPES" && !line_.starts_with(' '))
            types_[line_[0]] = whole_field(columns(line_, 3, 3)).value_or(0);
    }

    // Where an epoch's flag, its count and the list of its satellites stand.
    [[nodiscard]] std::size_t flag_column() const { return version_ == 1 ? 28 : 31; }
    [[nodiscard]] std::size_t list_column() const { return version_ == 1 ? 32 : 41; }

    Result<void> epoch() {
        if (line_.starts_with(version_ == 1 ? '&' : '>')) {
            head_.clear();
            satellites_.clear();
        } else if (head_.empty()) {
            return refuse(in_quotes(line_), "an epoch that depends on none before it");
        }
        apply_changes(head_, line_);
        if (version_ == 3) head_[0] = '>';
        const std::string_view flag = columns(head_, flag_column(), 1);
        const auto count = whole_field(columns(head_, flag_column() + 1, 3));
        if (flag.empty() || std::string_view(" 0123456").find(flag) == std::string_view::npos || !count || *count < 0)
            return refuse(in_quotes(head_), "an epoch with its flag and the count of its satellites");
        return flag[0] > '1' ? event(*count) : measured(static_cast<std::size_t>(*count));
    }

    // Its lines stand as they were; the epoch behind it depends on none before.
    Result<void> event(int count) {
        write(head_);
        head_.clear();
        for (int i = 0; i < count; ++i) {
            if (!next()) return refuse_end("an event");
            take_header_line();
        }
        return {};
    }

    Result<void> measured(std::size_t count) {
        if (count > 0 && head_.size() + 2 < list_column() + 3 * count)
            return refuse(in_quotes(head_), fmt::format("the names of {} satellites", count));
        head_.resize(list_column() + 3 * count, ' ');
        if (!next()) return refuse_end("an epoch");
        if (const auto written = write_head(count); !written) return written;
        std::map<std::string, CompactSatellite> seen;
        for (std::size_t i = 0; i < count; ++i) {
            if (!next()) return refuse_end("an epoch");
            const std::string id = head_.substr(list_column() + 3 * i, 3);
            const auto types = types_.find(version_ == 1 ? ' ' : id[0]);
            if (types == types_.end() || types->second <= 0 || types->second > most_types)
                return refuse(fmt::format("satellite {}", in_quotes(id)), "one whose observation types are declared");
            CompactSatellite satellite = std::move(satellites_[id]);
            satellite.arcs.resize(static_cast<std::size_t>(types->second));
            if (const auto read = read_satellite(satellite); !read) return read;
            if (const auto written = write_satellite(satellite, id); !written) return written;
            seen[id] = std::move(satellite);
        }
        satellites_ = std::move(seen);
        return {};
    }

    // The line at hand tells the receiver's clock, or nothing.
    Result<void> write_head(std::size_t count) {
        constexpr std::size_t per_line = 36, clock_column = 68;
        if (line_.empty())
            clock_.end_series();
        else if (!clock_.take(line_))
            return refuse(in_quotes(line_), "the offset of the receiver's clock");
        const auto clock = version_ == 1 ? decimal_field(clock_.value(), 9, 12) : decimal_field(clock_.value(), 12, 15);
        if (clock_.any() && !clock) return refuse(in_quotes(line_), "a clock offset that fits RINEX");
        std::string first = head_.substr(0, version_ == 1 ? clock_column : list_column());
        if (clock_.any()) {
            first.resize(version_ == 1 ? clock_column : list_column(), ' ');
            first += *clock;
        }
        write(first);
        for (std::size_t at = clock_column; version_ == 1 && at < list_column() + 3 * count; at += per_line)
            write(std::string(list_column(), ' ') + head_.substr(at, per_line));
        return {};
    }

    // A field each, parted by single blanks, then what changed of the flags.
    Result<void> read_satellite(CompactSatellite& satellite) {
        std::string_view rest = line_;
        for (DifferenceArc& arc : satellite.arcs) {
            const std::string_view field = rest.substr(0, rest.find(' '));
            if (field.empty())
                arc.end_series();
            else if (!arc.take(field))
                return refuse(in_quotes(field), "the difference to an observation before it, or the start of a series");
            rest.remove_prefix(std::min(field.size() + 1, rest.size()));
        }
        satellite.flags.resize(2 * satellite.arcs.size(), ' ');
        if (rest.size() > satellite.flags.size())
            return refuse(in_quotes(rest), fmt::format("two flags for each of {} observations", satellite.arcs.size()));
        apply_changes(satellite.flags, rest);
        return {};
    }

    Result<void> write_satellite(CompactSatellite& satellite, const std::string& id) {
        constexpr std::size_t per_line = 5;
        std::string line = version_ == 1 ? std::string() : id;
        for (std::size_t i = 0; i < satellite.arcs.size(); ++i) {
            const DifferenceArc& arc = satellite.arcs[i];
            const auto field = arc.any() ? decimal_field(arc.value(), 3, 14) : std::string(14, ' ');
            if (!field) return refuse(fmt::format("{} thousandths", arc.value()), "an observation that fits RINEX");
            if (version_ == 1 && !arc.any()) satellite.flags.replace(2 * i, 2, "  ");
            line += *field + satellite.flags.substr(2 * i, 2);
            if (version_ == 1 && i % per_line == per_line - 1 && i + 1 < satellite.arcs.size()) {
                write(line);
                line.clear();
            }
        }
        write(line);
        return {};
    }

    LineReader lines_;
    std::string_view name_, line_;
    int version_ = 0;
    std::map<char, int> types_;  // how many, by the letter of the system; ' ' in version 1
    std::string head_;           // of the epoch before, in one line; empty: the next depends on none
    DifferenceArc clock_;
    std::map<std::string, CompactSatellite> satellites_;  // of the epoch before
    std::string out_;
};

}  // namespace

bool is_compact(std::string_view text) {
    const auto first = LineReader(text).next();
    return first && header_label(first->text).starts_with("CRINEX VERS");
}

Result<std::string> from_compact(std::string_view text, std::string_view name) {
    return CompactReading(text, name).read();
}

}  // namespace skyloop::inline world::rinex
