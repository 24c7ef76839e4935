// Rows of tables whose columns a dialect knows by their places or names.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/written_place.hpp"
#include "text_track.hpp"

namespace skyloop {
// Lines of cells, without empty lines and comments.
class TableCells {
public:
    // @param comments characters that begin one
    TableCells(const TrackFile& file, char separator, std::string_view comments)
        : name_(file.name), lines_(file.text), separator_(separator), comments_(comments) {}
    bool next();
    [[nodiscard]] const std::vector<std::string_view>& cells() const { return cells_; }
    [[nodiscard]] std::string_view text() const { return lines_.line(); }
    [[nodiscard]] std::size_t line() const { return lines_.number(); }
    // Takes the present line as the names of the columns.
    void take_names();
    // Fails where the row has more cells than there are names: a decimal comma made two of one.
    [[nodiscard]] Result<void> check_width() const;
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }  // in lower case
    // Of the column with this name, letters of either case; nothing: there is none.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    // Empty where the row has fewer cells or the column is not there.
    [[nodiscard]] std::string_view cell(std::optional<std::size_t> column) const;
    // Nothing for an empty cell and for "nan". Fails with NAME:LINE and the column for any other text.
    Result<std::optional<double>> number(std::optional<std::size_t> column) const;
    // The same of a latitude or longitude, whose cell may have a letter, minutes and seconds.
    Result<std::optional<double>> coordinate(std::optional<std::size_t> column, Coordinate which) const;
    // Latitude and longitude of the columns with these names, by the letters of the row too; nothing where one of them
    // is absent. All rows of a table are asked with the same names.
    Result<std::optional<std::array<double, 2>>> place(std::array<std::string_view, 2> names);
    [[nodiscard]] const HemisphereColumns& hemispheres() const { return hemispheres_; }
    // Cells from `first` on, all of them numbers.
    Result<std::vector<double>> numbers(std::size_t first, std::size_t count) const;
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const;

private:
    const std::string& name_;
    TextLines lines_;
    char separator_;
    std::string comments_;
    std::vector<std::string> names_;  // in lower case
    std::vector<std::string_view> cells_;
    std::optional<std::array<std::size_t, 2>> places_;
    HemisphereColumns hemispheres_;
};

// Nanoseconds since 1980 of POSIX seconds written with a fraction, to the digit; nothing outside GPS time.
std::optional<Nanoseconds> posix_since_1980(std::string_view seconds);
// Nanoseconds since 1980 of a GPS week and the time of week, s; nothing outside.
std::optional<Nanoseconds> week_since_1980(double week, double tow_s);

// Tables that are told by the names in their header.
bool is_named_dialect(std::string_view head);
Result<Track> read_named_dialect(const TrackFile& file);
Result<Track> read_gnss_logger(const TrackFile& file);
// Tables without a header, told by the shape of their rows.
bool is_shaped_dialect(const TrackFile& file);
Result<Track> read_shaped_dialect(const TrackFile& file);

}  // namespace skyloop
