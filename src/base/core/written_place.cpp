#include "base/core/written_place.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/core/words.hpp"

namespace skyloop::inline base {
namespace {

constexpr std::string_view place_blanks = " \t";

struct Hemisphere {
    Coordinate which;
    std::string_view letter, word;
    double sign;
};
constexpr std::array hemispheres{
    Hemisphere{Coordinate::latitude, "n", "north", 1}, Hemisphere{Coordinate::latitude, "s", "south", -1},
    Hemisphere{Coordinate::longitude, "e", "east", 1}, Hemisphere{Coordinate::longitude, "w", "west", -1}};

bool is_small_letter(char c) { return c >= 'a' && c <= 'z'; }
bool is_letters(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_small_letter);
}

// Marks of degrees, minutes and seconds, in UTF-8 and Latin-1, as '*', ''' and '"'.
std::string with_plain_marks(std::string text) {
    constexpr std::array<std::pair<std::string_view, char>, 8> marks{{{"\xC2\xB0", '*'},
                                                                      {"\xC2\xBA", '*'},
                                                                      {"\xE2\x80\xB2", '\''},
                                                                      {"\xE2\x80\x99", '\''},
                                                                      {"\xE2\x80\xB3", '"'},
                                                                      {"\xE2\x80\x9D", '"'},
                                                                      {"''", '"'},
                                                                      {"\xB0", '*'}}};
    for (const auto& [mark, plain] : marks)
        for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1))
            text.replace(at, mark.size(), 1, plain);
    return text;
}

// Takes the letters at one end away. False: they are of no hemisphere of this coordinate, or a second such word.
bool take_letters(std::string_view& text, bool front, Coordinate which, std::optional<double>& sign) {
    const std::size_t count =
        front ? static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_small_letter) - text.begin())
              : static_cast<std::size_t>(std::find_if_not(text.rbegin(), text.rend(), is_small_letter) - text.rbegin());
    if (count == 0) return true;
    const std::string_view letters = front ? text.substr(0, count) : text.substr(text.size() - count);
    if (sign) return false;
    sign = hemisphere_sign(letters, which);
    front ? text.remove_prefix(count) : text.remove_suffix(count);
    text = trimmed(text, place_blanks);
    return sign.has_value();
}

// Degrees, minutes and seconds without a sign.
std::optional<double> sexagesimal_degrees(std::string_view text) {
    constexpr std::string_view marks = "*'\"";
    constexpr std::array<double, 3> parts{1, 60, 3600};
    double degrees = 0;
    bool decimals = false;
    for (std::size_t i = 0; i == 0 || !text.empty(); ++i) {
        double value = 0;
        if (i == parts.size() || decimals || text.empty() || text.front() < '0' || text.front() > '9')
            return std::nullopt;
        const auto [end, status] =
            std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
        if (status != std::errc() || (i > 0 && value >= 60)) return std::nullopt;
        const auto length = static_cast<std::size_t>(end - text.data());
        decimals = text.substr(0, length).find('.') != std::string_view::npos;
        degrees += value / parts.at(i);
        text.remove_prefix(length);
        text = trimmed(text, place_blanks);
        if (!text.empty() && (text.front() == marks[i] || text.front() == ':')) text.remove_prefix(1);
        text = trimmed(text, place_blanks);
    }
    return degrees;
}

// Letters and digits alone, in lower case: "N/S", "N-S" and "n_s" are one name.
std::string bare_name(std::string_view text) {
    std::string bare = lower_case(text);
    std::erase_if(bare, [](char c) { return !is_small_letter(c) && !(c >= '0' && c <= '9'); });
    return bare;
}

bool drop_prefix(std::string_view& text, std::string_view prefix) {
    const bool there = text.starts_with(prefix);
    if (there) text.remove_prefix(prefix.size());
    return there;
}

// Whether a column is called as those are that give a hemisphere: "N/S", "NS indicator", "lat_dir", "Longitude E/W".
bool is_called_hemisphere(std::string_view column, Coordinate which) {
    const bool latitude = which == Coordinate::latitude;
    constexpr std::array<std::string_view, 12> words{"",    "dir", "direction", "hem",    "hemi",     "hemisphere",
                                                     "ref", "ind", "indicator", "letter", "cardinal", "sign"};
    const std::string bare = bare_name(column);
    std::string_view rest = bare;
    drop_prefix(rest, "gps");
    const bool of_place = latitude ? drop_prefix(rest, "latitude") || drop_prefix(rest, "lat")
                                   : drop_prefix(rest, "longitude") || drop_prefix(rest, "long") ||
                                         drop_prefix(rest, "lon") || drop_prefix(rest, "lng");
    const bool of_letters = latitude ? drop_prefix(rest, "northsouth") || drop_prefix(rest, "ns")
                                     : drop_prefix(rest, "eastwest") || drop_prefix(rest, "ew");
    return (of_letters || (of_place && !rest.empty())) && std::find(words.begin(), words.end(), rest) != words.end();
}

std::string_view cell_of(const LineCells& cells, std::size_t column) {
    return column < cells.size() ? cells[column] : std::string_view();
}

}  // namespace

std::optional<double> hemisphere_sign(std::string_view text, Coordinate which) {
    const std::string lower = lower_case(text);
    const auto* const found = std::find_if(hemispheres.begin(), hemispheres.end(), [&](const Hemisphere& one) {
        return one.which == which && (one.letter == lower || one.word == lower);
    });
    return found == hemispheres.end() ? std::nullopt : std::optional(found->sign);
}

std::optional<double> written_degrees(std::string_view text, Coordinate which) {
    const std::string plain = with_plain_marks(lower_case(text));
    std::string_view rest = trimmed(plain, place_blanks);
    std::optional<double> letter;
    if (!take_letters(rest, true, which, letter) || !take_letters(rest, false, which, letter)) return std::nullopt;
    const bool minus = rest.starts_with('-');
    if (minus || rest.starts_with('+')) rest.remove_prefix(1);
    if (minus && letter && *letter > 0) return std::nullopt;
    const auto degrees = sexagesimal_degrees(rest);
    if (!degrees) return std::nullopt;
    return minus || letter.value_or(1) < 0 ? -*degrees : *degrees;
}

bool HemisphereColumns::is_of(Coordinate which, std::size_t column, const LineCells& cells) const {
    if (column == places_[0] || column == places_[1]) return false;
    const std::string cell = lower_case(cell_of(cells, column));
    const std::size_t place = places_[static_cast<std::size_t>(which)];
    const bool beside = column == place + 1 || column + 1 == place;
    if (is_called_hemisphere(names_[column], which)) return is_letters(cell);
    return beside && hemisphere_sign(cell, which).has_value();
}

void HemisphereColumns::find(const LineCells& cells) {
    found_ = true;
    others_.resize(names_.size());
    for (const Coordinate which : {Coordinate::latitude, Coordinate::longitude})
        for (std::size_t column = 0; column < names_.size(); ++column)
            if (auto& found = columns_[static_cast<std::size_t>(which)]; !found && is_of(which, column, cells))
                found = column;
}

void HemisphereColumns::look_at_others(const LineCells& cells, std::size_t line) {
    for (std::size_t column = 0; column < names_.size(); ++column) {
        const std::string_view cell = cell_of(cells, column);
        Letters& letters = others_[column];
        if (cell.empty() || letters.others || column == columns_[0] || column == columns_[1]) continue;
        const bool named = bare_name(names_[column]).find("hemi") != std::string::npos && is_letters(lower_case(cell));
        const auto* const found = std::find_if(hemispheres.begin(), hemispheres.end(), [&](const Hemisphere& one) {
            return one.letter == lower_case(cell) && one.letter != cell;  // in capitals
        });
        const bool letter = found != hemispheres.end() && letters.which.value_or(found->which) == found->which;
        letters.others = !letter && !named;
        if (letter) letters.which = found->which;
        if (letters.first_line > 0 || !(named || (letter && found->sign < 0))) continue;
        letters.first_line = line;
        letters.cell = cell;
    }
}

tl::expected<std::array<double, 2>, std::string> HemisphereColumns::place(const LineCells& cells,
                                                                          std::array<double, 2> numbers,
                                                                          std::size_t line) {
    // Receivers without a fix write zeros, and anything for the letters.
    if (numbers[0] == 0 && numbers[1] == 0) return numbers;
    if (!found_) find(cells);
    look_at_others(cells, line);
    for (const Coordinate which : {Coordinate::latitude, Coordinate::longitude}) {
        const auto i = static_cast<std::size_t>(which);
        negative_[i] |= numbers[i] < 0;
        if (!columns_[i]) continue;
        const std::string_view cell = cell_of(cells, *columns_[i]);
        const auto sign = hemisphere_sign(cell, which);
        if (!sign)
            return tl::make_unexpected(fmt::format("{:.40} is '{:.40}'; expected {}", names_[*columns_[i]], cell,
                                                   which == Coordinate::latitude ? "N or S" : "E or W"));
        if (numbers[i] < 0 && *sign > 0)
            return tl::make_unexpected(
                fmt::format("{:.40} is '{:.40}', and {:.40} is '{:.40}'; expected a sign and a letter that agree",
                            names_[places_[i]], cell_of(cells, places_[i]), names_[*columns_[i]], cell));
        if (*sign < 0 && numbers[i] > 0) numbers[i] = -numbers[i];
    }
    return numbers;
}

std::optional<std::string> HemisphereColumns::not_understood() const {
    for (std::size_t column = 0; column < others_.size(); ++column) {
        const Letters& letters = others_[column];
        if (letters.others || letters.first_line == 0) continue;
        const auto i = static_cast<std::size_t>(letters.which.value_or(Coordinate::latitude));
        if (letters.which && (columns_[i] || negative_[i])) continue;
        return fmt::format(
            "the column '{:.40}' has '{:.40}' (first in line {}), which may be a hemisphere; expected N or S under "
            "N/S, E or W under E/W, or a sign before the degrees",
            names_[column], letters.cell, letters.first_line);
    }
    return std::nullopt;
}

std::vector<std::string> HemisphereColumns::notes(std::vector<std::string> unused) const {
    std::vector<std::string> notes;
    for (const Coordinate which : {Coordinate::latitude, Coordinate::longitude}) {
        const auto& column = columns_[static_cast<std::size_t>(which)];
        if (!column) continue;
        std::erase(unused, names_[*column]);
        notes.push_back(fmt::format("{} is taken as the hemisphere of {}", names_[*column],
                                    names_[places_[static_cast<std::size_t>(which)]]));
    }
    if (!unused.empty()) notes.push_back(fmt::format("columns without a meaning here: {}", fmt::join(unused, ", ")));
    return notes;
}

}  // namespace skyloop::inline base
