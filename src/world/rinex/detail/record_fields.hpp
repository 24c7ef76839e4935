/// The fields of one record in RINEX text, taken one by one.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/time/gps_time.hpp"
#include "fields.hpp"

namespace skyloop::rinex {

/// Why a record cannot be used.
struct Defect {
    int line = 0;
    int column = 0;  ///< from 1
    std::string found;
    std::string expected;
};

/// Where a number stands in a record, what it is called and what a satellite can broadcast.
struct FieldRule {
    std::size_t line = 0, column = 0;  ///< column 0 … 3; of the first line 1 … 3, after the epoch
    std::string_view name;
    double least = 0, most = 0;
    bool required = false;  ///< blank is not 0
};

/// Takes numbers from the lines of a record and remembers the first defect; what comes after one is 0.
class RecordFields {
public:
    RecordFields(std::span<const Line> lines, int major);

    double number(const FieldRule& rule);
    int whole(const FieldRule& rule);
    /// The calendar epoch of the first line, in whatever time scale it is written, read as if it were GPST.
    GpsTime epoch();
    [[nodiscard]] bool blank(std::size_t line, std::size_t column) const;
    [[nodiscard]] std::size_t line_count() const { return lines_.size(); }

    /// Notes that the field at `line`, `column` cannot be.
    void refuse(std::size_t line, std::size_t column, std::string found, std::string expected);
    [[nodiscard]] const std::optional<Defect>& defect() const { return defect_; }

private:
    [[nodiscard]] std::size_t text_column(std::size_t line, std::size_t column) const;
    [[nodiscard]] std::string_view field(std::size_t line, std::size_t column) const;

    std::span<const Line> lines_;
    int major_;
    std::optional<Defect> defect_;
};

}  // namespace skyloop::rinex
