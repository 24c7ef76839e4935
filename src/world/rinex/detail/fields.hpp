/// Lines and fixed-column fields of RINEX text.
/// What is wrong with records of one kind.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skyloop::inline world::rinex {

/// Years of epochs: those of GPS time which 64-bit nanoseconds hold whole, so that all that a run writes is read back.
constexpr bool is_epoch_year(int year) { return year >= 1980 && year <= 2269; }

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
/// Without spaces at either end.
std::string_view trimmed(std::string_view text);
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
};

}  // namespace skyloop::inline world::rinex
