/// The container of ArduPilot's logs.
///
/// Layout: ArduPilot, libraries/AP_Logger/LogStructure.h, as FEEDS.md 1.8 sums it up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline receiver {

struct DataflashType;

/// Where a column stands in a record, and how it is written.
struct DataflashColumn {
    const DataflashType* type = nullptr;  ///< by its letter
    std::size_t offset = 0;               ///< in the record, its head counted
    std::optional<double> multiplier{};   ///< by FMTU; nothing: by the letter
};

/// What a type of record is called and holds.
struct DataflashFormat {
    std::string name;
    std::size_t length = 0;  ///< with the head
    std::vector<std::string> order;
    std::map<std::string, DataflashColumn, std::less<>> columns;
    std::string instance;  ///< the column that numbers the receiver, the core, …; empty: none
};

/// One record, as long as the bytes and its reader live.
class DataflashRecord {
public:
    DataflashRecord(const DataflashFormat& format, ByteSpan bytes) : format_(format), bytes_(bytes) {}
    [[nodiscard]] const std::string& name() const { return format_.name; }
    /// The first of these columns that there is, scaled by its letter in old logs and by FMTU in new ones, never by
    /// both. Nothing where there is none or it is no finite number.
    [[nodiscard]] std::optional<double> value(std::initializer_list<std::string_view> names) const;
    [[nodiscard]] std::optional<double> value(std::string_view name) const { return value({name}); }
    /// The same without any scale: whole numbers whose multiplier says of which unit they are.
    [[nodiscard]] std::optional<double> raw(std::initializer_list<std::string_view> names) const;
    [[nodiscard]] bool has(std::string_view column) const { return format_.columns.contains(column); }
    /// Which receiver, core, … it is of; nothing for formats that do not number them.
    [[nodiscard]] std::optional<double> instance() const;

private:
    // A later FMT may have made the format another one.
    [[nodiscard]] bool is_inside(const DataflashColumn& column) const;

    const DataflashFormat& format_;
    ByteSpan bytes_;
};

/// What a record GPS says: without its time where it tells none, its height above the sea. Milliseconds of the week
/// under any multiplier are what the raw number says.
struct DataflashFix {
    ObservedEpoch told;
    std::optional<GpsTime> time;
};
DataflashFix dataflash_fix(const DataflashRecord& record);
/// What a record GPA says of the geoid, m above the ellipsoid: Und is sea level less ellipsoid, with its sign changed.
std::optional<double> dataflash_undulation(const DataflashRecord& record);

/// Whether the bytes begin as such a log does.
bool is_dataflash(ByteSpan bytes);

/// Gives the records of a log one after the other. What defines the others is taken and not given: FMT, FMTU. Bytes
/// that begin no known record are passed over and counted.
class DataflashReader {
public:
    explicit DataflashReader(ByteSpan bytes) : bytes_(bytes) {}
    /// The next record, or nothing at the end.
    std::optional<DataflashRecord> next();
    [[nodiscard]] std::size_t skipped_bytes() const { return skipped_; }
    [[nodiscard]] bool is_cut() const { return cut_; }  ///< the end of the file is inside a record

private:
    void take_format(ByteSpan record);
    void take_units(ByteSpan record);

    ByteSpan bytes_;
    std::array<std::optional<DataflashFormat>, 256> formats_;
    std::size_t at_ = 0, skipped_ = 0;
    bool cut_ = false;
};

}  // namespace skyloop::inline receiver
