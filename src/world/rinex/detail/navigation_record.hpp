/// One ephemeris in RINEX text.
/// The fields of one record in RINEX text, taken one by one.
/// A Kepler-type ephemeris of GPS, QZSS, Galileo, BeiDou or NavIC in RINEX text.
/// State vectors of GLONASS and SBAS satellites in RINEX text.
#pragma once

#include <tl/expected.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/time/gps_time.hpp"
#include "fields.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world::rinex {

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

/// How many lines a record has: the epoch with the clock, then orbit lines of four fields.
struct RecordLength {
    std::size_t least = 8;
    std::size_t most = 8;
};
inline constexpr std::size_t longest_record = 8;
/// GLONASS records have a fifth line from version 3.05 on.
constexpr RecordLength record_length(Constellation constellation) {
    if (constellation == Constellation::glonass) return {4, 5};
    if (constellation == Constellation::sbas) return {4, 4};
    return {8, 8};
}

/// What tells how a record is to be read.
struct RecordKind {
    SatelliteId satellite;
    int major = 3;                             ///< version
    std::optional<NavigationMessage> message;  ///< nothing: the record itself tells
};

/// True for a line on which a record begins: the lines that continue one begin with spaces.
bool begins_record(std::string_view line, int major);

/// The satellite that a record's first line names, or nothing. @param system of a version 2 file
std::optional<SatelliteId> record_satellite(std::string_view line, int major, Constellation system);

/// Reads the lines of one record.
tl::expected<Ephemeris, Defect> read_record(const RecordKind& kind, std::span<const Line> lines);

/// Reads eight lines (RINEX 3.05, tables A6, A8, A12, A14, A18).
tl::expected<KeplerEphemeris, Defect> read_kepler_record(const RecordKind& kind, RecordFields fields);

/// Reads four lines, or the five of version 3.05 and later (RINEX 3.05, table A10).
tl::expected<GlonassEphemeris, Defect> read_glonass_record(const RecordKind& kind, RecordFields fields);

/// Reads four lines (RINEX 3.05, table A16).
tl::expected<SbasEphemeris, Defect> read_sbas_record(const RecordKind& kind, RecordFields fields);

}  // namespace skyloop::inline world::rinex
