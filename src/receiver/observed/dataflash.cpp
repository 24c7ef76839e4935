#include "receiver/observed/dataflash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"

namespace skyloop::inline receiver {

/// What a letter of FMT says of a column.
struct DataflashType {
    char letter;
    std::size_t size;
    double (*read)(ByteSpan record, std::size_t at);
    double scale;  ///< in logs whose FMTU gives no multiplier
};

namespace {

// ArduPilot, libraries/AP_Logger/LogStructure.h, as FEEDS.md 1.8 sums it up.
constexpr std::uint8_t dataflash_head_1 = 0xA3, dataflash_head_2 = 0x95, dataflash_fmt = 128;
constexpr std::size_t dataflash_fmt_length = 89, dataflash_head = 3;

std::string_view text_in(ByteSpan bytes, std::size_t at, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + at, size);
    return text.substr(0, text.find('\0'));
}

// IEEE 754 binary16.
double half_number(std::uint16_t bits) {
    const int exponent = bits >> 10 & 0x1F, fraction = bits & 0x3FF;
    const double size = exponent == 0    ? std::ldexp(fraction, -24)
                        : exponent == 31 ? std::nan("")
                                         : std::ldexp(1024 + fraction, exponent - 25);
    return (bits & 0x8000) != 0 ? -size : size;
}

double half_at(ByteSpan bytes, std::size_t at) { return half_number(number_at<std::uint16_t>(bytes, at)); }
double no_number(ByteSpan, std::size_t) { return 0; }

template <class Number>
constexpr DataflashType number_type(char letter, double scale = 1) {
    return {letter, sizeof(Number), double_at<Number>, scale};
}
constexpr std::array<DataflashType, 21> dataflash_types{{
    number_type<std::int8_t>('b'),
    number_type<std::uint8_t>('B'),
    number_type<std::uint8_t>('M'),
    number_type<std::int16_t>('h'),
    number_type<std::uint16_t>('H'),
    number_type<std::int16_t>('c', 1e-2),
    number_type<std::uint16_t>('C', 1e-2),
    number_type<std::int32_t>('i'),
    number_type<std::uint32_t>('I'),
    number_type<std::int32_t>('e', 1e-2),
    number_type<std::uint32_t>('E', 1e-2),
    number_type<std::int32_t>('L', 1e-7),
    number_type<std::int64_t>('q'),
    number_type<std::uint64_t>('Q'),
    number_type<float>('f'),
    number_type<double>('d'),
    {'g', 2, half_at, 1},
    {'n', 4, no_number, 1},
    {'N', 16, no_number, 1},
    {'Z', 64, no_number, 1},
    {'a', 64, no_number, 1},
}};

// Nothing for a letter that is unknown.
const DataflashType* type_of(char letter) {
    const auto found = std::find_if(dataflash_types.begin(), dataflash_types.end(),
                                    [letter](const DataflashType& type) { return type.letter == letter; });
    return found == dataflash_types.end() ? nullptr : &*found;
}

// FMTU, MULT: the multiplier of an id, of which ArduPilot keeps the list in LogStructure.h (log_Multipliers).
std::optional<double> multiplier_of(char id) {
    static constexpr auto multipliers = std::to_array<std::pair<char, double>>({
        {'-', 1},
        {'?', 1},
        {'0', 1},
        {'1', 1e1},
        {'2', 1e2},
        {'A', 1e-1},
        {'B', 1e-2},
        {'C', 1e-3},
        {'D', 1e-4},
        {'E', 1e-5},
        {'F', 1e-6},
        {'G', 1e-7},
        {'I', 1e-9},
        {'!', 3.6},
        {'/', 3600},
    });
    for (const auto& [known, factor] : multipliers)
        if (known == id) return factor;
    return std::nullopt;
}

}  // namespace

std::optional<double> DataflashRecord::value(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names) {
        const auto found = format_.columns.find(name);
        if (found == format_.columns.end()) continue;
        const DataflashColumn& column = found->second;
        if (!is_inside(column)) continue;
        const double result = column.type->read(bytes_, column.offset) * column.multiplier.value_or(column.type->scale);
        if (std::isfinite(result)) return result;
    }
    return std::nullopt;
}

std::optional<double> DataflashRecord::raw(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
        if (const auto found = format_.columns.find(name); found != format_.columns.end() && is_inside(found->second))
            return found->second.type->read(bytes_, found->second.offset);
    return std::nullopt;
}

bool DataflashRecord::is_inside(const DataflashColumn& column) const {
    return column.offset + column.type->size <= bytes_.size();
}

std::optional<double> DataflashRecord::instance() const {
    return format_.instance.empty() ? std::nullopt : raw({format_.instance});
}

std::optional<DataflashRecord> DataflashReader::next() {
    while (at_ + dataflash_head <= bytes_.size()) {
        const std::uint8_t type = bytes_[at_ + 2];
        const bool head = bytes_[at_] == dataflash_head_1 && bytes_[at_ + 1] == dataflash_head_2;
        const std::size_t length = type == dataflash_fmt ? dataflash_fmt_length
                                   : formats_[type]      ? formats_[type]->length
                                                         : 0;
        if (!head || length == 0) {
            ++at_;
            ++skipped_;
            continue;
        }
        if (at_ + length > bytes_.size()) {
            cut_ = true;
            return std::nullopt;
        }
        const ByteSpan record = bytes_.subspan(at_, length);
        at_ += length;
        if (type == dataflash_fmt)
            take_format(record);
        else if (formats_[type]->name == "FMTU")
            take_units(record);
        else
            return DataflashRecord(*formats_[type], record);
    }
    return std::nullopt;
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
        const DataflashType* column_type = type_of(letter);
        const std::size_t end = std::min(names.find(','), names.size());
        const std::string column(names.substr(0, end));
        names.remove_prefix(std::min(end + 1, names.size()));
        // One that makes no sense: its records are passed over.
        if (!column_type || offset + column_type->size > format.length) return;
        format.columns[column] = {column_type, offset, {}};
        format.order.push_back(column);
        offset += column_type->size;
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

bool is_dataflash(ByteSpan bytes) {
    return bytes.size() >= dataflash_head && bytes[0] == dataflash_head_1 && bytes[1] == dataflash_head_2;
}

namespace {

class DataflashEpochs {
public:
    DataflashEpochs(const std::string& name, const ObservedReading& reading) : reading_(reading) {
        log_.name = name;
        log_.format = "DataFlash";
    }
    Result<ObservedLog> read(ByteSpan bytes);

private:
    void take_gps(const DataflashRecord& record);
    void take_accuracy(const DataflashRecord& record);
    [[nodiscard]] bool asked(const DataflashRecord& record, std::string_view base) const;
    Result<void> add_undulations();

    const ObservedReading& reading_;
    ObservedLog log_;
    std::optional<double> undulation_;  // as the receiver last told it, m
    std::vector<bool> on_sea_level_;    // of each epoch: its height is not yet one above the ellipsoid
    std::size_t undated_ = 0, gps_records_ = 0;
};

Result<ObservedLog> DataflashEpochs::read(ByteSpan bytes) {
    DataflashReader reader(bytes);
    while (const auto record = reader.next()) {
        if (asked(*record, "GPS"))
            take_gps(*record);
        else if (asked(*record, "GPA"))
            take_accuracy(*record);
    }
    if (gps_records_ == 0)
        return fail(ErrorCode::input,
                    fmt::format("{}: a DataFlash log without GPS records of receiver {}; expected some", log_.name,
                                reading_.receiver));
    if (auto added = add_undulations(); !added) return fail(added.error());
    log_.receiver = fmt::format("GPS records of instance {}", reading_.receiver);
    add_note(log_, undated_, "GPS records without a week were left out");
    add_note(log_, reader.skipped_bytes(), "bytes that begin no record were passed over");
    add_note(log_, reader.is_cut() ? 1 : 0, "record is cut by the end of the file");
    return finish_log(std::move(log_), reading_);
}

// GPS and GPA of old logs, GPS2 and GPA2 (GPB) for the second receiver; an instance in new ones.
bool DataflashEpochs::asked(const DataflashRecord& record, std::string_view base) const {
    if (!record.name().starts_with(base)) return false;
    if (const auto number = record.instance(); number && record.name() == base)
        return *number == static_cast<double>(reading_.receiver);
    if (reading_.receiver == 0) return record.name() == base;
    return record.name() == fmt::format("{}{}", base, reading_.receiver + 1);
}

void DataflashEpochs::take_gps(const DataflashRecord& record) {
    ++gps_records_;
    DataflashFix fix = dataflash_fix(record);
    if (!fix.time) return static_cast<void>(++undated_);
    ObservedEpoch& epoch = log_.epochs.emplace_back(std::move(fix.told));
    epoch.time = *fix.time;
    if (epoch.place && undulation_) epoch.place->height.above_ellipsoid += Metres(*undulation_);
    on_sea_level_.push_back(epoch.place && !undulation_);
}

// GPA follows the GPS record of its sample.
void DataflashEpochs::take_accuracy(const DataflashRecord& record) {
    if (const auto told = dataflash_undulation(record)) undulation_ = told;
    if (log_.epochs.empty()) return;
    if (const auto h = record.value({"HAcc"})) log_.epochs.back().horizontal_accuracy = Metres(*h);
    if (const auto v = record.value({"VAcc"})) log_.epochs.back().vertical_accuracy = Metres(*v);
}

// What came before the receiver told its undulation takes the one it told in the end, else that of the grid.
Result<void> DataflashEpochs::add_undulations() {
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

DataflashFix dataflash_fix(const DataflashRecord& record) {
    static constexpr std::array types{FixType::none,  FixType::none,      FixType::fix_2d,   FixType::fix_3d,
                                      FixType::dgnss, FixType::rtk_float, FixType::rtk_fixed};
    constexpr double first_week = 1000, last_week = 6000;
    DataflashFix fix;
    ObservedEpoch& told = fix.told;
    const double week = record.raw({"GWk", "Week"}).value_or(0), ms = record.raw({"GMS", "TimeMS"}).value_or(-1);
    if (week > first_week && week < last_week && ms >= 0 && ms < 1000.0 * seconds_per_week)
        fix.time = to_gps_time(static_cast<std::int64_t>(week), ms / 1000);
    told.is_solution = true;
    told.type = numbered_type(types, observed_number(record.value({"Status"})));
    told.satellites_used = observed_number(record.value({"NSats"}));
    const auto latitude = record.value({"Lat"}), longitude = record.value({"Lng"}), altitude = record.value({"Alt"});
    if (told.type == FixType::none || !latitude || !longitude || !altitude) return fix;
    told.place = observed_place(*latitude, *longitude, *altitude);
    const auto speed = record.value({"Spd"}), course = record.value({"GCrs"}), down = record.value({"VZ"});
    if (!told.place || !speed || !course || !down) return fix;
    const double azimuth = Angle::degrees(*course).rad();
    told.velocity = VelocityNed{*speed * std::cos(azimuth), *speed * std::sin(azimuth), *down};
    return fix;
}

std::optional<double> dataflash_undulation(const DataflashRecord& record) {
    constexpr double highest_m = 200;
    const auto und = record.value({"Und"});
    return und && *und != 0 && std::abs(*und) < highest_m ? std::optional(-*und) : std::nullopt;
}

Result<ObservedLog> read_dataflash(ByteSpan bytes, const std::string& name, const ObservedReading& reading) {
    return DataflashEpochs(name, reading).read(bytes);
}

}  // namespace skyloop::inline receiver
