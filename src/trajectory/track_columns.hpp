/// Which column of a track's table says what.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skyloop/base/result.hpp"

namespace skyloop {

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
    fix,  // below 2: no position
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
    /// Fails with `input`, without the name of the file, when a time or a place is missing.
    static Result<TrackColumns> of(std::span<const std::string_view> header);

    [[nodiscard]] const std::optional<TrackColumn>& operator[](TrackQuantity quantity) const {
        return columns_[static_cast<std::size_t>(quantity)];
    }
    [[nodiscard]] bool has(TrackQuantity quantity) const { return (*this)[quantity].has_value(); }
    /// Names that mean nothing here.
    [[nodiscard]] const std::vector<std::string>& unused() const { return unused_; }

private:
    Result<void> check() const;

    std::optional<TrackColumn> columns_[static_cast<std::size_t>(TrackQuantity::count)];
    std::vector<std::string> unused_;
};

}  // namespace skyloop
