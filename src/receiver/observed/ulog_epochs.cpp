#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/std_additions.hpp"
#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"
#include "receiver/observed/ulog.hpp"

namespace skyloop::inline receiver {
namespace {

// PX4-Autopilot, msg/SensorGps.msg: fix_type; 8 is "extrapolated".
constexpr std::array ulog_fix_types{FixType::none,      FixType::none,  FixType::fix_2d,
                                    FixType::fix_3d,    FixType::dgnss, FixType::rtk_float,
                                    FixType::rtk_fixed, FixType::none,  FixType::dead_reckoning};

// A height above the ellipsoid that differs from the one above the sea.
bool tells_ellipsoid(const std::vector<UlogFix>& fixes) {
    constexpr double least_m = 0.01;
    return std::any_of(fixes.begin(), fixes.end(),
                       [](const UlogFix& fix) { return std::abs(fix.undulation_m.value_or(0)) > least_m; });
}

// Its place has the height above the ellipsoid, if there is one.
UlogFix fix_of(const UlogRecord& record) {
    const double degree = record.has("latitude_deg") ? 1 : 1e-7, metre = record.has("altitude_msl_m") ? 1 : 1e-3;
    const auto number = [&](std::initializer_list<std::string_view> names) {
        const auto value = record.value(names);
        return value && std::isfinite(*value) ? value : std::nullopt;
    };
    UlogFix fix;
    fix.utc_us = number({"time_utc_usec", "time_gps_usec"});
    fix.boot_us = number({"timestamp"});
    fix.told.type = numbered_type(ulog_fix_types, observed_number(record.value("fix_type")));
    fix.told.is_solution = true;
    fix.told.satellites_used = observed_number(record.value("satellites_used"));
    if (const auto h = number({"eph"})) fix.told.horizontal_accuracy = Metres(*h);
    if (const auto v = number({"epv"})) fix.told.vertical_accuracy = Metres(*v);
    const auto latitude = number({"latitude_deg", "lat"}), longitude = number({"longitude_deg", "lon"});
    const auto above = number({"altitude_ellipsoid_m", "alt_ellipsoid"}), sea = number({"altitude_msl_m", "alt"});
    const bool ellipsoid = above && (*above != 0 || !sea);
    if (ellipsoid) fix.undulation_m = (*above - sea.value_or(0)) * metre;
    fix.above_sea = !ellipsoid;
    if (latitude && longitude && (ellipsoid || sea))
        fix.told.place = observed_place(*latitude * degree, *longitude * degree, (ellipsoid ? *above : *sea) * metre);
    const auto north = number({"vel_n_m_s"}), east = number({"vel_e_m_s"}), down = number({"vel_d_m_s"});
    if (record.value("vel_ned_valid").value_or(1) != 0 && north && east && down)
        fix.told.velocity = VelocityNed{*north, *east, *down};
    return fix;
}

// UTC less the time since boot: the middle one of the records that have a fix (FEEDS.md 1.7).
std::optional<double> boot_offset_us(const std::vector<UlogFix>& fixes) {
    std::vector<double> offsets;
    for (const UlogFix& fix : fixes)
        if (fix.utc_us && fix.boot_us && time_of_posix_us(*fix.utc_us)) offsets.push_back(*fix.utc_us - *fix.boot_us);
    if (offsets.empty()) return std::nullopt;
    return middle_of(offsets);
}

Result<void> add_epochs(const UlogStream& stream, const Geoid* geoid, ObservedLog& log) {
    const std::vector<UlogFix> fixes = ulog_fixes(stream);
    const auto offset = boot_offset_us(fixes);
    std::size_t on_boot_clock = 0, undated = 0, from_sea_level = 0;
    for (const UlogFix& fix : fixes) {
        auto time = time_of_posix_us(fix.utc_us.value_or(0));
        if (!time && offset) {
            time = time_of_posix_us(*offset + fix.boot_us.value_or(0));
            ++on_boot_clock;
        }
        if (!time) {
            ++undated;
            continue;
        }
        ObservedEpoch& epoch = log.epochs.emplace_back(fix.told);
        epoch.time = *time;
        if (!fix.above_sea || !epoch.place || epoch.type == FixType::none) continue;
        ++from_sea_level;
        if (geoid)
            epoch.place->height.above_ellipsoid += geoid->undulation(epoch.place->latitude, epoch.place->longitude);
    }
    add_note(log, undated, "records have no UTC and were left out");
    add_note(log, on_boot_clock, "records without UTC were dated by the autopilot's clock");
    if (from_sea_level > 0 && !geoid)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} heights above sea level alone, and the geoid's grid is not there; expected "
                                "alt_ellipsoid in {}",
                                log.name, from_sea_level, stream.topic));
    add_note(log, from_sea_level, "heights above sea level were taken above EGM96");
    return {};
}

}  // namespace

std::vector<UlogFix> ulog_fixes(const UlogStream& stream) {
    std::vector<UlogFix> fixes;
    for (const ByteSpan bytes : stream.records)
        fixes.push_back(fix_of(UlogRecord(stream.fields, bytes)));
    const bool ellipsoid = tells_ellipsoid(fixes);
    const bool types =
        std::any_of(fixes.begin(), fixes.end(), [](const UlogFix& fix) { return fix.told.type != FixType::none; });
    for (UlogFix& fix : fixes) {
        if (!ellipsoid) fix.above_sea = true;
        if (!types && fix.told.place) fix.told.type = FixType::fix_3d;
    }
    return fixes;
}

std::optional<GpsTime> time_of_posix_us(double microseconds) {
    constexpr double since_2000_us = 946684800e6, until_2100_us = 4102444800e6;
    if (!(microseconds > since_2000_us && microseconds < until_2100_us)) return std::nullopt;
    return from_posix(std::chrono::microseconds(static_cast<std::int64_t>(microseconds)), LeapSeconds::announced());
}

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
    if (auto added = add_epochs(*best, reading.geoid, log); !added) return fail(added.error());
    add_note(log, parsed->dropouts, fmt::format("dropouts of the logger, {} ms together", parsed->dropout_ms));
    add_note(log, parsed->cut_records, "records that are cut or of a wrong length were left out");
    add_note(log, parsed->skipped_bytes, "bytes of damage were passed over");
    return finish_log(std::move(log), reading);
}

}  // namespace skyloop::inline receiver
