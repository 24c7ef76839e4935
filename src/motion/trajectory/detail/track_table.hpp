/// Which column of a track's table says what.
// What is read from a cell of a table, and from several of its rows.
/// Dates beside counted times, as in tables that have a column of each.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {

/// What a column may say.
enum class TrackQuantity {
    since_start,  // s
    posix,        // s since 1970 without leap seconds
    utc,          // ISO 8601
    gps_week,     //
    tow,          // s
    latitude,     // deg
    longitude,    // deg
    height,       // m above the ellipsoid
    altitude,     // m above sea level
    x,
    y,
    z,  // m, ECEF
    north,
    east,
    down,
    up,      // m/s
    speed,   // m/s over ground
    course,  // deg
    climb,   // m/s
    roll,
    pitch,
    yaw,  // deg
    qw,
    qx,
    qy,
    qz,  // of the turn from the body (forward, right, down) to north, east, down
    local_north,
    local_east,
    local_up,
    local_down,  // m from an origin
    fix,         // below 2: no position
    reset,       // changes where the source begins anew
    count
};

/// A column that was found: its place in the row and what its numbers are multiplied by.
struct TrackColumn {
    std::size_t index = 0;
    double scale = 1;
    std::string name;
};

/// The columns of one table.
class TrackColumns {
public:
    /// @param header names, as they stand
    /// @param first_row its cells, which tell what a time without a unit is; may be empty
    /// Fails with `input`, without the name of the file, when a place is missing.
    static Result<TrackColumns> of(std::span<const std::string_view> header,
                                   std::span<const std::string_view> first_row);

    [[nodiscard]] const std::optional<TrackColumn>& operator[](TrackQuantity quantity) const {
        return columns_[static_cast<std::size_t>(quantity)];
    }
    [[nodiscard]] bool has(TrackQuantity quantity) const { return (*this)[quantity].has_value(); }
    /// Without one the rows are a route.
    [[nodiscard]] bool has_time() const { return has(TrackQuantity::since_start) || date() != nullptr; }
    /// The column that dates a row, of week and time of week the former; nullptr: none.
    [[nodiscard]] const TrackColumn* date() const {
        if (has(TrackQuantity::gps_week) && has(TrackQuantity::tow)) return &*(*this)[TrackQuantity::gps_week];
        for (const TrackQuantity quantity : {TrackQuantity::utc, TrackQuantity::posix})
            if (has(quantity)) return &*(*this)[quantity];
        return nullptr;
    }
    /// A place in metres from an origin, east, north and up or north, east and down.
    [[nodiscard]] bool has_local() const {
        return has(TrackQuantity::local_north) && has(TrackQuantity::local_east) &&
               (has(TrackQuantity::local_up) || has(TrackQuantity::local_down));
    }
    /// Names that were understood though they are not those of the format, and what for.
    [[nodiscard]] const std::vector<std::string>& understood() const { return understood_; }
    /// Names that mean nothing here.
    [[nodiscard]] const std::vector<std::string>& unused() const { return unused_; }

private:
    Result<void> check() const;
    bool take_bare_time(std::string_view name, std::size_t index, std::string_view cell);
    bool take_other_name(std::string_view name, std::size_t index);

    std::optional<TrackColumn> columns_[static_cast<std::size_t>(TrackQuantity::count)];
    std::vector<std::string> understood_, unused_;
};

// A line without blanks around it that is empty or a remark.
bool says_nothing(std::string_view plain);

// The first line of a text that holds a row; empty where none does.
std::string_view first_row_line(std::string_view text);

// A UTC time as ISO 8601 writes it; a zone may stand behind it (+01:00, +0100, +01).
Result<GpsTime> time_of_utc_cell(std::string_view text);

// What is wrong with a place that is not near the ground; nothing: it is.
std::optional<std::string> mistake_of_place(const Position<Ecef>& place);

// The number that the whole of a cell is, in the unit of its column's quantity. Latitudes and longitudes in degrees may
// have a letter, minutes and seconds. Nothing for any other text.
std::optional<double> number_of_cell(std::string_view text, const TrackColumn& column, TrackQuantity quantity);

/// Gathers what both clocks of a table say in its rows. State: these.
class TrackDates {
public:
    /// @param dated since the origin of GPS time
    void add(Nanoseconds counted, Nanoseconds dated);
    /// No row told both.
    [[nodiscard]] bool empty() const { return offsets_.empty(); }
    /// GPS time at which the count is 0: the middle of what the rows say, or where dates are cut to whole seconds the
    /// latest of it. Nothing where one row of ten is more than 2 s off: the clocks do not run together.
    [[nodiscard]] std::optional<Nanoseconds> of_count_zero() const;
    /// Makes counted times of rows times since the origin of GPS time, or leaves them; it is told by the names of both.
    void date(Track& track, const std::string& count, const std::string& date) const;

private:
    std::vector<Nanoseconds> offsets_;
    bool whole_seconds_ = true;
};

}  // namespace skyloop::inline motion
