/// Latitudes and longitudes as tables write them: with a letter for the hemisphere beside the number or in a column of
/// its own, in degrees, minutes and seconds.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "base/core/table_text.hpp"

namespace skyloop::inline base {

/// Which of the two a number is; the place of each in a pair of them.
enum class Coordinate : std::size_t { latitude, longitude };

/// 1 for N, north, E and east, -1 for S, south, W and west, in letters of either case; nothing for other texts and for
/// those of the other coordinate.
std::optional<double> hemisphere_sign(std::string_view text, Coordinate which);

/// Signed degrees of "33.9S", "S 33 54.0", "33°54'36\"S" or "-33 54": up to three numbers, of which the last one may
/// have decimals. Nothing for other texts, and where sign and letter contradict each other.
std::optional<double> written_degrees(std::string_view text, Coordinate which);

/// The columns of one table that give the hemispheres of its places by letters: those with such a name ("N/S",
/// "lat_dir"), and those of any name beside the number. Which they are shows in the first row that has a place.
class HemisphereColumns {
public:
    HemisphereColumns() = default;
    /// @param names of all columns, as they stand
    /// @param places the columns of latitude and longitude
    HemisphereColumns(std::vector<std::string> names, std::array<std::size_t, 2> places)
        : names_(std::move(names)), places_(places) {}

    /// Latitude and longitude of a row with their signs, in the unit of `numbers`. Fails with what is wrong in it,
    /// without file and line.
    /// @param line for messages about the table as a whole
    tl::expected<std::array<double, 2>, std::string> place(const LineCells& cells, std::array<double, 2> numbers,
                                                           std::size_t line);
    /// After the last row: what is wrong with a column that may give hemispheres, and is not understood. Nothing: all
    /// is well.
    [[nodiscard]] std::optional<std::string> not_understood() const;
    /// What was made of the columns: of those that were understood, and of the others among these names.
    [[nodiscard]] std::vector<std::string> notes(std::vector<std::string> unused) const;

private:
    // What a column that is not understood has held so far.
    struct Letters {
        bool others = false;              // texts that are no letters of one coordinate
        std::optional<Coordinate> which;  // of its letters
        std::size_t first_line = 0;       // that turns a sign; 0: none
        std::string cell;                 // there
    };
    void find(const LineCells& cells);
    void look_at_others(const LineCells& cells, std::size_t line);
    [[nodiscard]] bool is_of(Coordinate which, std::size_t column, const LineCells& cells) const;

    std::vector<std::string> names_;
    std::array<std::size_t, 2> places_{};
    std::array<std::optional<std::size_t>, 2> columns_;
    std::vector<Letters> others_;
    std::array<bool, 2> negative_{};  // a number had a sign
    bool found_ = false;
};

}  // namespace skyloop::inline base
