#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/observed/dataflash.hpp"

namespace skyloop {
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
    const auto status = static_cast<std::size_t>(observed_number(record.value({"Status"})));
    told.is_solution = true;
    told.type = status < types.size() ? types[status] : FixType::none;
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

}  // namespace skyloop
