#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "log_parts.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

// ArduPilot, libraries/AP_Logger/LogStructure.h, as FEEDS.md 1.8 sums it up.
constexpr std::uint8_t dataflash_head_1 = 0xA3, dataflash_head_2 = 0x95, dataflash_fmt = 128;
constexpr std::size_t dataflash_fmt_length = 89, dataflash_head = 3;

std::size_t dataflash_size(char letter) {
    static constexpr std::string_view one = "bBM", two = "hHcCg", four = "iIeELfn", eight = "qQd";
    if (one.find(letter) != std::string_view::npos) return 1;
    if (two.find(letter) != std::string_view::npos) return 2;
    if (four.find(letter) != std::string_view::npos) return 4;
    if (eight.find(letter) != std::string_view::npos) return 8;
    return letter == 'a' || letter == 'Z' ? 64 : letter == 'N' ? 16 : 0;
}

std::string_view text_in(ByteSpan bytes, std::size_t at, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + at, size);
    return text.substr(0, text.find('\0'));
}

struct DataflashColumn {
    char letter = 0;
    std::size_t offset = 0;
    std::optional<double> multiplier;  // by FMTU; nothing: by the letter
};

// What a type of record is called and holds.
struct DataflashFormat {
    std::string name;
    std::size_t length = 0;  // with the head
    std::vector<std::string> order;
    std::map<std::string, DataflashColumn, std::less<>> columns;
    std::string instance;  // the column that numbers the receiver
};

double raw_value(ByteSpan record, const DataflashColumn& column) {
    const std::size_t at = column.offset;
    switch (column.letter) {
        case 'b':
            return number_at<std::int8_t>(record, at);
        case 'B':
        case 'M':
            return record[at];
        case 'h':
        case 'c':
            return number_at<std::int16_t>(record, at);
        case 'H':
        case 'C':
            return number_at<std::uint16_t>(record, at);
        case 'i':
        case 'e':
        case 'L':
            return number_at<std::int32_t>(record, at);
        case 'I':
        case 'E':
            return number_at<std::uint32_t>(record, at);
        case 'q':
            return static_cast<double>(number_at<std::int64_t>(record, at));
        case 'Q':
            return static_cast<double>(number_at<std::uint64_t>(record, at));
        case 'f':
            return static_cast<double>(number_at<float>(record, at));
        case 'd':
            return number_at<double>(record, at);
        default:
            return 0;
    }
}

// FMTU, MULT: the multiplier of an id, of which ArduPilot keeps the list in LogStructure.h (log_Multipliers).
std::optional<double> multiplier_of(char id) {
    switch (id) {
        case '-':
        case '?':
        case '0':
        case '1':
            return 1;
        case 'A':
            return 1e-1;
        case 'B':
            return 1e-2;
        case 'C':
            return 1e-3;
        case 'D':
            return 1e-4;
        case 'E':
            return 1e-5;
        case 'F':
            return 1e-6;
        case 'G':
            return 1e-7;
        case 'I':
            return 1e-9;
        case '2':
            return 1e2;
        case '!':
            return 3.6;
        case '/':
            return 3600;
        default:
            return std::nullopt;
    }
}

class DataflashReader {
public:
    DataflashReader(ByteSpan bytes, const std::string& name, const LogReading& reading)
        : bytes_(bytes), reading_(reading) {
        log_.name = name;
        log_.format = "DataFlash";
    }
    Result<ReceiverLog> read();

private:
    void take_format(ByteSpan record);
    void take_units(ByteSpan record);
    void take(const DataflashFormat& format, ByteSpan record);
    void take_gps(const DataflashFormat& format, ByteSpan record);
    void take_accuracy(const DataflashFormat& format, ByteSpan record);
    [[nodiscard]] bool asked(const DataflashFormat& format, ByteSpan record, std::string_view base) const;
    // A column in SI units, by the first of these names that there is.
    [[nodiscard]] static std::optional<double> value(const DataflashFormat& format, ByteSpan record,
                                                     std::initializer_list<std::string_view> names);
    Result<void> add_undulations();

    ByteSpan bytes_;
    const LogReading& reading_;
    ReceiverLog log_;
    std::array<std::optional<DataflashFormat>, 256> formats_;
    std::optional<double> undulation_;  // as the receiver last told it, m
    std::vector<bool> on_sea_level_;    // of each epoch: its height is not yet one above the ellipsoid
    std::size_t skipped_ = 0, cut_ = 0, undated_ = 0, gps_records_ = 0;
};

Result<ReceiverLog> DataflashReader::read() {
    std::size_t at = 0;
    while (at + dataflash_head <= bytes_.size()) {
        const std::uint8_t type = bytes_[at + 2];
        const bool head = bytes_[at] == dataflash_head_1 && bytes_[at + 1] == dataflash_head_2;
        const std::size_t length = type == dataflash_fmt ? dataflash_fmt_length
                                   : formats_[type]      ? formats_[type]->length
                                                         : 0;
        if (!head || length == 0) {
            ++at;
            ++skipped_;
            continue;
        }
        if (at + length > bytes_.size()) {
            ++cut_;
            break;
        }
        const ByteSpan record = bytes_.subspan(at, length);
        if (type == dataflash_fmt)
            take_format(record);
        else
            take(*formats_[type], record);
        at += length;
    }
    if (gps_records_ == 0)
        return fail(ErrorCode::input,
                    fmt::format("{}: a DataFlash log without GPS records of receiver {}; expected some", log_.name,
                                reading_.receiver));
    if (auto added = add_undulations(); !added) return fail(added.error());
    log_.receiver = fmt::format("GPS records of instance {}", reading_.receiver);
    add_note(log_, undated_, "GPS records without a week were left out");
    add_note(log_, skipped_, "bytes that begin no record were passed over");
    add_note(log_, cut_, "record is cut by the end of the file");
    return finish_log(std::move(log_));
}

void DataflashReader::take_format(ByteSpan record) {
    DataflashFormat format;
    const std::uint8_t type = record[3];
    format.length = record[4];
    format.name = text_in(record, 5, 4);
    const std::string_view letters = text_in(record, 9, 16);
    std::string_view names = text_in(record, 25, 64);
    std::size_t offset = dataflash_head;
    for (const char letter : letters) {
        const std::size_t size = dataflash_size(letter);
        const std::size_t end = std::min(names.find(','), names.size());
        const std::string column(names.substr(0, end));
        names.remove_prefix(std::min(end + 1, names.size()));
        if (size == 0 || offset + size > format.length) return;  // makes no sense: its records are passed over
        format.columns[column] = {letter, offset, {}};
        format.order.push_back(column);
        offset += size;
    }
    if (format.length < dataflash_head || type == dataflash_fmt) return;
    if ((format.name == "GPS" || format.name == "GPA") && format.columns.contains("I")) format.instance = "I";
    formats_[type] = std::move(format);
}

// FMTU: TimeUS, type, 16 units, 16 multipliers.
void DataflashReader::take_units(ByteSpan record) {
    constexpr std::size_t length = dataflash_head + 8 + 1 + 16 + 16;
    if (record.size() < length) return;
    auto& format = formats_[record[dataflash_head + 8]];
    if (!format) return;
    const std::string_view units = text_in(record, dataflash_head + 9, 16);
    const std::string_view multipliers = text_in(record, dataflash_head + 25, 16);
    for (std::size_t i = 0; i < format->order.size(); ++i) {
        if (i < units.size() && units[i] == '#') format->instance = format->order[i];
        if (i < multipliers.size()) format->columns[format->order[i]].multiplier = multiplier_of(multipliers[i]);
    }
}

std::optional<double> DataflashReader::value(const DataflashFormat& format, ByteSpan record,
                                             std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) {
        const auto found = format.columns.find(name);
        if (found == format.columns.end()) continue;
        const DataflashColumn& column = found->second;
        // Scaled by the letter in old logs, by FMTU in new ones, never by both.
        static constexpr std::string_view hundredths = "cCeE";
        const double by_letter = hundredths.find(column.letter) != std::string_view::npos ? 1e-2
                                 : column.letter == 'L'                                   ? 1e-7
                                                                                          : 1;
        const double result = raw_value(record, column) * column.multiplier.value_or(by_letter);
        if (std::isfinite(result)) return result;
    }
    return std::nullopt;
}

// GPS and GPA of old logs, GPS2 and GPA2 (GPB) for the second receiver; an instance in new ones.
bool DataflashReader::asked(const DataflashFormat& format, ByteSpan record, std::string_view base) const {
    if (!format.name.starts_with(base)) return false;
    if (!format.instance.empty() && format.name == base) {
        const auto number = value(format, record, {format.instance});
        return number && *number == static_cast<double>(reading_.receiver);
    }
    if (reading_.receiver == 0) return format.name == base;
    return format.name == fmt::format("{}{}", base, reading_.receiver + 1);
}

void DataflashReader::take(const DataflashFormat& format, ByteSpan record) {
    if (format.name == "FMTU") return take_units(record);
    if (asked(format, record, "GPS")) return take_gps(format, record);
    if (asked(format, record, "GPA")) return take_accuracy(format, record);
}

void DataflashReader::take_gps(const DataflashFormat& format, ByteSpan record) {
    ++gps_records_;
    // Milliseconds of the week under any multiplier are what the raw number says.
    const auto raw = [&](std::initializer_list<std::string_view> names) -> std::optional<double> {
        for (const std::string_view name : names)
            if (const auto found = format.columns.find(name); found != format.columns.end())
                return raw_value(record, found->second);
        return std::nullopt;
    };
    const double week = raw({"GWk", "Week"}).value_or(0), ms = raw({"GMS", "TimeMS"}).value_or(-1);
    if (!(week > 0 && week < 10000 && ms >= 0 && ms < 1000.0 * seconds_per_week)) {
        ++undated_;
        return;
    }
    static constexpr std::array types{FixType::none,  FixType::none,      FixType::fix_2d,   FixType::fix_3d,
                                      FixType::dgnss, FixType::rtk_float, FixType::rtk_fixed};
    LogEpoch epoch;
    epoch.time = to_gps_time(static_cast<std::int64_t>(week), ms / 1000);
    const auto status = static_cast<std::size_t>(std::max(0.0, value(format, record, {"Status"}).value_or(0)));
    epoch.type = status < types.size() ? types[status] : FixType::none;
    epoch.satellites_used = static_cast<int>(value(format, record, {"NSats"}).value_or(0));
    const auto latitude = value(format, record, {"Lat"}), longitude = value(format, record, {"Lng"});
    const auto altitude = value(format, record, {"Alt"});
    if (epoch.type != FixType::none && latitude && longitude && altitude) {
        epoch.place = logged_place(*latitude, *longitude, *altitude);
        const auto speed = value(format, record, {"Spd"}), course = value(format, record, {"GCrs"});
        const auto down = value(format, record, {"VZ"});
        if (epoch.place && speed && course && down) {
            const double azimuth = Angle::degrees(*course).rad();
            epoch.velocity = VelocityNed{*speed * std::cos(azimuth), *speed * std::sin(azimuth), *down};
        }
    }
    if (epoch.place && undulation_) epoch.place->height.above_ellipsoid += Metres(*undulation_);
    on_sea_level_.push_back(epoch.place && !undulation_);
    log_.epochs.push_back(std::move(epoch));
}

// GPA follows the GPS record of its sample. Und is sea level less ellipsoid: the undulation with its sign changed.
void DataflashReader::take_accuracy(const DataflashFormat& format, ByteSpan record) {
    if (const auto und = value(format, record, {"Und"}); und && *und != 0 && std::abs(*und) < 200) undulation_ = -*und;
    if (log_.epochs.empty()) return;
    if (const auto h = value(format, record, {"HAcc"})) log_.epochs.back().horizontal_accuracy = Metres(*h);
    if (const auto v = value(format, record, {"VAcc"})) log_.epochs.back().vertical_accuracy = Metres(*v);
}

// What came before the receiver told its undulation takes the one it told in the end, else that of the grid.
Result<void> DataflashReader::add_undulations() {
    std::size_t from_grid = 0;
    for (std::size_t i = 0; i < log_.epochs.size(); ++i) {
        auto& place = log_.epochs[i].place;
        if (!place || !on_sea_level_[i]) continue;
        if (undulation_) {
            place->height.above_ellipsoid += Metres(*undulation_);
        } else if (reading_.geoid) {
            place->height.above_ellipsoid += reading_.geoid->undulation(place->latitude, place->longitude);
            ++from_grid;
        } else {
            return fail(ErrorCode::input,
                        fmt::format("{}: heights above sea level alone, and the geoid's grid is not there; expected "
                                    "GPA records with Und",
                                    log_.name));
        }
    }
    add_note(log_, from_grid, "heights above sea level were taken above EGM96");
    return {};
}

}  // namespace

bool is_dataflash(ByteSpan bytes) {
    return bytes.size() >= dataflash_head && bytes[0] == dataflash_head_1 && bytes[1] == dataflash_head_2;
}

Result<ReceiverLog> read_dataflash(ByteSpan bytes, const std::string& name, const LogReading& reading) {
    return DataflashReader(bytes, name, reading).read();
}

}  // namespace skyloop
