#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/middle.hpp"
#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/observed/ulog.hpp"

namespace skyloop {
namespace {

// PX4-Autopilot, msg/SensorGps.msg: fix_type.
FixType ulog_fix_type(int type) {
    switch (type) {
        case 2:
            return FixType::fix_2d;
        case 3:
            return FixType::fix_3d;
        case 4:
            return FixType::dgnss;
        case 5:
            return FixType::rtk_float;
        case 6:
            return FixType::rtk_fixed;
        case 8:
            return FixType::dead_reckoning;  // "extrapolated"
        default:
            return FixType::none;
    }
}

// The microseconds of UTC since 1970 as GPS time; nothing for a clock that was not set.
std::optional<GpsTime> ulog_time(double utc_us) {
    constexpr double since_2000_us = 946684800e6, until_2100_us = 4102444800e6;
    if (!(utc_us > since_2000_us && utc_us < until_2100_us)) return std::nullopt;
    return from_posix(std::chrono::microseconds(static_cast<std::int64_t>(utc_us)), LeapSeconds::announced());
}

class UlogEpochs {
public:
    UlogEpochs(const UlogStream& stream, const Geoid* geoid) : stream_(stream), geoid_(geoid) {}
    Result<void> read(ObservedLog& log);

private:
    std::optional<double> boot_offset_us() const;
    ObservedEpoch epoch_of(const UlogRecord& record);
    void place(const UlogRecord& record, ObservedEpoch& epoch);

    const UlogStream& stream_;
    const Geoid* geoid_;
    std::size_t from_sea_level_ = 0;
};

// UTC less the time since boot: the middle one of the records that have a fix (FEEDS.md 1.7).
std::optional<double> UlogEpochs::boot_offset_us() const {
    std::vector<double> offsets;
    for (const ByteSpan bytes : stream_.records) {
        const UlogRecord record(stream_.fields, bytes);
        const double utc = record.value({"time_utc_usec", "time_gps_usec"}).value_or(0);
        const double boot = record.value("timestamp").value_or(0);
        if (ulog_time(utc) && std::isfinite(boot)) offsets.push_back(utc - boot);
    }
    if (offsets.empty()) return std::nullopt;
    return middle_of(offsets);
}

void UlogEpochs::place(const UlogRecord& record, ObservedEpoch& epoch) {
    const bool degrees = record.has("latitude_deg");
    const double scale = degrees ? 1 : 1e-7, metres = record.has("altitude_msl_m") ? 1 : 1e-3;
    const auto latitude = record.value({"latitude_deg", "lat"}), longitude = record.value({"longitude_deg", "lon"});
    if (!latitude || !longitude) return;
    const auto ellipsoid = record.value({"altitude_ellipsoid_m", "alt_ellipsoid"});
    const auto msl = record.value({"altitude_msl_m", "alt"});
    if (ellipsoid && (*ellipsoid != 0 || !msl)) {
        epoch.place = observed_place(*latitude * scale, *longitude * scale, *ellipsoid * metres);
        return;
    }
    if (!msl) return;
    epoch.place = observed_place(*latitude * scale, *longitude * scale, *msl * metres);
    if (!epoch.place) return;
    ++from_sea_level_;
    if (geoid_)
        epoch.place->height.above_ellipsoid += geoid_->undulation(epoch.place->latitude, epoch.place->longitude);
}

ObservedEpoch UlogEpochs::epoch_of(const UlogRecord& record) {
    ObservedEpoch epoch;
    epoch.type = ulog_fix_type(observed_number(record.value("fix_type")));
    epoch.satellites_used = observed_number(record.value("satellites_used"));
    const auto accuracy = [&](std::string_view name) -> std::optional<Metres> {
        const auto value = record.value(name);
        return value && std::isfinite(*value) ? std::optional(Metres(*value)) : std::nullopt;
    };
    epoch.horizontal_accuracy = accuracy("eph");
    epoch.vertical_accuracy = accuracy("epv");
    if (epoch.type == FixType::none) return epoch;
    place(record, epoch);
    const auto north = record.value("vel_n_m_s"), east = record.value("vel_e_m_s"), down = record.value("vel_d_m_s");
    const bool valid = record.value("vel_ned_valid").value_or(1) != 0;
    if (epoch.place && valid && north && east && down && std::isfinite(*north + *east + *down))
        epoch.velocity = VelocityNed{*north, *east, *down};
    return epoch;
}

Result<void> UlogEpochs::read(ObservedLog& log) {
    const auto offset = boot_offset_us();
    std::size_t on_boot_clock = 0, undated = 0;
    for (const ByteSpan bytes : stream_.records) {
        const UlogRecord record(stream_.fields, bytes);
        auto time = ulog_time(record.value({"time_utc_usec", "time_gps_usec"}).value_or(0));
        if (!time && offset) {
            time = ulog_time(*offset + record.value("timestamp").value_or(0));
            ++on_boot_clock;
        }
        if (!time) {
            ++undated;
            continue;
        }
        ObservedEpoch epoch = epoch_of(record);
        epoch.time = *time;
        log.epochs.push_back(std::move(epoch));
    }
    add_note(log, undated, "records have no UTC and were left out");
    add_note(log, on_boot_clock, "records without UTC were dated by the autopilot's clock");
    if (from_sea_level_ > 0 && !geoid_)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} heights above sea level alone, and the geoid's grid is not there; expected "
                                "alt_ellipsoid in {}",
                                log.name, from_sea_level_, stream_.topic));
    add_note(log, from_sea_level_, "heights above sea level were taken above EGM96");
    return {};
}

}  // namespace

Result<ObservedLog> read_ulog(ByteSpan bytes, const std::string& name, const ObservedReading& reading) {
    // In the order of preference; of one receiver the topic with more records tells more (the logger thins them out).
    const auto parsed = parse_ulog(bytes, name, {"vehicle_gps_position", "sensor_gps"});
    if (!parsed) return fail(parsed.error());
    const UlogStream* best = nullptr;
    for (const UlogStream& stream : parsed->streams)
        if (stream.instance == reading.receiver && (!best || stream.records.size() > best->records.size()))
            best = &stream;
    if (!best || best->records.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: a ULog without records of vehicle_gps_position or sensor_gps of receiver {}; "
                                "expected some",
                                name, reading.receiver));
    ObservedLog log;
    log.name = name;
    log.format = "ULog";
    log.receiver = fmt::format("{} of instance {}{}", best->topic, best->instance,
                               parsed->hardware.empty() ? "" : ", autopilot " + parsed->hardware);
    if (auto read = UlogEpochs(*best, reading.geoid).read(log); !read) return fail(read.error());
    add_note(log, parsed->dropouts, fmt::format("dropouts of the logger, {} ms together", parsed->dropout_ms));
    add_note(log, parsed->cut_records, "records that are cut or of a wrong length were left out");
    add_note(log, parsed->skipped_bytes, "bytes of damage were passed over");
    return finish_log(std::move(log), reading);
}

}  // namespace skyloop
