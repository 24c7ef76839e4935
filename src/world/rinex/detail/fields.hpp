/// Lines and fixed-column fields of RINEX text.
/// What is wrong with records of one kind.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/words.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world::rinex {

/// A line without its end, and its number, from 1.
struct Line {
    std::string_view text;
    int number = 0;
};

/// Goes through the lines of a text; ends may be LF or CR LF, the last one may be missing.
class LineReader {
public:
    explicit LineReader(std::string_view text) : rest_(text) {}
    std::optional<Line> next();
    /// The next line that holds more than `blanks`.
    std::optional<Line> next_filled(std::string_view blanks = " ");
    /// The number of the last line given, at least 1.
    [[nodiscard]] int number() const { return number_ > 0 ? number_ : 1; }

private:
    std::string_view rest_;
    int number_ = 0;
};

/// Without the mark of UTF-8 that some editors put before everything.
std::string_view without_byte_order_mark(std::string_view text);
/// Columns `first` (from 0) and on, as far as the line goes.
std::string_view columns(std::string_view line, std::size_t first, std::size_t width);
inline bool is_blank(std::string_view text) { return trimmed(text).empty(); }

/// The words of a line, parted by blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);

/// The label of a header line, in columns 61-80.
inline std::string_view header_label(std::string_view line) { return trimmed(columns(line, 60, 20)); }

/// A real number with exponent D or E of either case, as F, D and E formats write it; 0 when blank; nothing when the
/// field holds something else, or a value that is not finite.
std::optional<double> real_field(std::string_view field);
/// A whole number, 0 when blank.
std::optional<int> whole_field(std::string_view field);

/// A calendar as the columns of an epoch hold it.
struct CalendarFields {
    std::optional<int> year, month, day, hour, minute;
    std::optional<double> second;
};
/// The year that the two digits of versions 1 and 2 stand for.
constexpr int full_year(int two_digits) { return two_digits + (two_digits >= 80 ? 1900 : 2000); }
/// The largest values of a clock that are read: some writers round up.
struct ClockLimits {
    int hour = 23, minute = 59;
    double second = 60;
};
/// The epoch, in whatever time scale it is written, read as if it were GPST; nothing where the fields tell none.
std::optional<GpsTime> calendar_epoch(const CalendarFields& fields, const ClockLimits& most);
/// Such an epoch of a time system ("BDT", "GLO", "UTC", "TAI"; all others are GPST) in GPST.
GpsTime epoch_in_gpst(GpsTime written, std::string_view time_system);

/// What a line LEAP SECONDS announces: nothing where it is blank, or counts from the epoch of BDT. Fails with what it
/// holds instead of a number of leap seconds, in quotation marks.
tl::expected<std::optional<int>, std::string> announced_leap_seconds(std::string_view line);

/// The line that a RINEX file begins with.
struct VersionLine {
    Line line;
    double version = 0;  ///< 2.00-2.12, 3.00-3.05 or 4.00-4.02
};
/// Reads the first line that is not blank. Fails with `input` where it is of another kind or version.
/// @param wanted what is read, in words
/// @param or_else what may stand there besides the line of a RINEX header, in words that go on: ", or …"
Result<VersionLine> read_version_line(LineReader& lines, std::string_view name, std::string_view wanted,
                                      std::string_view or_else = "");

/// "NAME:LINE: found …; expected …".
std::string at_line(std::string_view name, int line, std::string_view found, std::string_view expected);
/// The error `input` in these words.
tl::unexpected<Error> refused(std::string_view name, int line, std::string_view found, std::string_view expected);

/// The text in quotation marks, cut to a readable length, without control characters.
std::string in_quotes(std::string_view text);

/// The first defect of a kind in words, and how many there are.
struct DefectTally {
    std::string first;
    int count = 0;
    void add(std::string sentence) {
        if (count++ == 0) first = std::move(sentence);
    }
    /// Many records may fail; only the first needs words.
    template <class Words>
    void add_with(Words words) {
        if (count++ == 0) first = words();
    }
    /// Tells the first, what came of it, and how many more there are, if there are any.
    void warn(std::vector<std::string>& warnings, std::string_view outcome) const;
};

}  // namespace skyloop::inline world::rinex
