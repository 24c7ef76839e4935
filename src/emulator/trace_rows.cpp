#include "trace_rows.hpp"

#include <fmt/format.h>

#include "skyloop/geo/local_frame.hpp"
#include "skyloop/gnss/constants.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

std::string utc_text(GpsTime time) { return format_utc(to_utc(time, LeapSeconds::announced())); }

void append_solution(fmt::memory_buffer& row, const Trace& trace) {
    const Fix& fix = trace.epoch.fix;
    const auto out = std::back_inserter(row);
    const Eigen::Vector3d error = LocalFrame(trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    fmt::format_to(out, "{:.9f},{:.9f},{:.4f},{:.4f},{:.4f},{:.4f},", fix.position.latitude.deg(),
                   fix.position.longitude.deg(), fix.position.height.above_ellipsoid.value(), error.x(), error.y(),
                   error.z());
    fmt::format_to(out, "{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},", fix.velocity.north, fix.velocity.east, fix.velocity.down,
                   fix.speed.value(), fix.course.deg());
}

}  // namespace

std::string fix_row(const Trace& trace) {
    const Fix& fix = trace.epoch.fix;
    const Geodetic& truth = trace.truth.geodetic;
    const WeekAndTow gps = week_and_tow(trace.truth.time);
    fmt::memory_buffer row;
    const auto out = std::back_inserter(row);
    fmt::format_to(out, "{},{},{:.3f},{:.9f},{:.9f},{:.4f},", utc_text(trace.truth.time), gps.week, gps.tow_seconds(),
                   truth.latitude.deg(), truth.longitude.deg(), truth.height.above_ellipsoid.value());
    if (fix.has_position())
        append_solution(row, trace);
    else
        fmt::format_to(out, ",,,,,,,,,,,");
    fmt::format_to(out, "{},{},{},", fix_type_name(fix.type), fix.satellites_used(), trace.sky.satellites.size());
    if (fix.has_position())
        fmt::format_to(out, "{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", fix.dop.gdop, fix.dop.pdop,
                       fix.dop.hdop, fix.dop.vdop, fix.dop.tdop, fix.horizontal_accuracy.value(),
                       fix.vertical_accuracy.value());
    else
        fmt::format_to(out, ",,,,,,\n");
    return fmt::to_string(row);
}

std::string satellite_rows(const Trace& trace) {
    const std::string time = utc_text(trace.truth.time);
    fmt::memory_buffer rows;
    const auto out = std::back_inserter(rows);
    for (std::size_t i = 0; i < trace.sky.satellites.size(); ++i) {
        const SatelliteInView& sky = trace.sky.satellites[i];
        const Arrival& arrival = trace.arrivals.satellites[i];
        const SatelliteStatus& status = trace.epoch.fix.satellites[i];
        const double clock = speed_of_light * (sky.clock_bias.value() - sky.group_delay().value());
        const double pseudorange = sky.range.value() - clock + arrival.iono_delay.value() +
                                   arrival.tropo_delay.value() + arrival.excess_path.value();
        fmt::format_to(out, "{},{},{:.4f},{:.4f},{:.4f},{},{},{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},", time,
                       to_string(sky.id), sky.azimuth.deg(), sky.elevation.deg(), sky.range.value(),
                       arrival.line_of_sight ? 1 : 0, arrival.paths, arrival.excess_path.value(),
                       arrival.iono_delay.value(), arrival.tropo_delay.value(), arrival.gas_loss.value(),
                       arrival.cloud_loss.value(), arrival.rain_loss.value());
        if (arrival.cn0) fmt::format_to(out, "{:.2f}", arrival.cn0->value());
        if (arrival.paths > 0)
            fmt::format_to(out, ",{:.4f},{}\n", pseudorange, status.used ? 1 : 0);
        else
            fmt::format_to(out, ",,0\n");
    }
    return fmt::to_string(rows);
}

}  // namespace skyloop
