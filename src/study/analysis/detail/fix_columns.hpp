/// Which column of a table of fixes says what, and in which unit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/written_place.hpp"

namespace skyloop {

/// Where a quantity stands in a row, and what its numbers are multiplied by: to degrees, metres or seconds.
struct FixColumn {
    std::size_t index = 0;
    double scale = 1;
};

/// The columns of a table.
struct FixColumns {
    bool named = false;  ///< the first line is a header, not a sample
    std::size_t count = 0;
    FixColumn latitude, longitude, height;
    std::optional<FixColumn> true_latitude, true_longitude, true_height;
    std::optional<FixColumn> fix_type, time, week, tow, used;
    HemisphereColumns hemispheres;  ///< of latitude and longitude; no others have such letters
    std::string above_sea;          ///< the name of a height that is told to be above the sea; empty: none is
    /// Of a table without a time: the columns whose names tell one all the same.
    std::vector<std::string> unread_times;

    [[nodiscard]] bool has_truth() const { return true_latitude && true_longitude && true_height; }

    /// Of a first line of names. Fails with what is wrong in it, without the file.
    static tl::expected<FixColumns, std::string> of(const std::vector<std::string_view>& header);
    /// Latitude, longitude and height, without a header.
    static FixColumns of_numbers();
};

}  // namespace skyloop
