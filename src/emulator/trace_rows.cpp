#include "trace_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

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

// The first of `items`, which ascend by satellite, that is of `id`.
template <class Item>
const Item* find_satellite(const std::vector<Item>& items, SatelliteId id, SatelliteId Item::*member) {
    const auto found = std::lower_bound(items.begin(), items.end(), id,
                                        [&](const Item& item, SatelliteId wanted) { return item.*member < wanted; });
    return found != items.end() && (*found).*member == id ? &*found : nullptr;
}

std::optional<double> measured_pseudorange(const Trace& trace, SatelliteId id) {
    const Observation* o = find_satellite(trace.epoch.observations.signals, id, &Observation::satellite);
    if (!o || !o->pseudorange) return std::nullopt;
    return o->pseudorange->value();
}

std::optional<double> ideal_pseudorange(const SatelliteInView& sky, const Arrival& arrival) {
    if (arrival.paths == 0) return std::nullopt;
    const double clock = speed_of_light * (sky.clock_bias.value() - sky.group_delay().value());
    return sky.range.value() - clock + arrival.iono_delay.value() + arrival.tropo_delay.value() +
           arrival.excess_path.value();
}

void append_arrival(fmt::memory_buffer& rows, const SatelliteInView& sky, const Arrival& arrival) {
    const auto out = std::back_inserter(rows);
    fmt::format_to(out, "{:.4f},{:.4f},{:.4f},{},{},{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},", sky.azimuth.deg(),
                   sky.elevation.deg(), sky.range.value(), arrival.line_of_sight ? 1 : 0, arrival.paths,
                   arrival.excess_path.value(), arrival.iono_delay.value(), arrival.tropo_delay.value(),
                   arrival.gas_loss.value(), arrival.cloud_loss.value(), arrival.rain_loss.value());
    if (arrival.cn0) fmt::format_to(out, "{:.2f}", arrival.cn0->value());
    rows.push_back(',');
}

void append_errors(fmt::memory_buffer& rows, const Arrival& arrival, const SignalTerms* terms) {
    const auto out = std::back_inserter(rows);
    fmt::format_to(out, "{:.4f},", arrival.signal_in_space_error.value());
    if (terms)
        fmt::format_to(out, "{:.4f},{:.4f},{:.5f},{:.4f},", terms->multipath.value(), terms->code_noise.value(),
                       terms->phase_noise.value(), terms->doppler_noise.value());
    else
        fmt::format_to(out, ",,,,");
    fmt::format_to(out, "{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},", arrival.foliage_loss.value(),
                   arrival.antenna_gain.value(), arrival.power_offset.value(), arrival.interference_loss.value(),
                   arrival.amplitude_scintillation, arrival.phase_scintillation.rad());
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
        fmt::format_to(out, "{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},", fix.dop.gdop,
                       fix.dop.pdop, fix.dop.hdop, fix.dop.vdop, fix.dop.tdop, fix.horizontal_accuracy.value(),
                       fix.vertical_accuracy.value(), fix.speed_accuracy.value(), fix.time_accuracy.value(),
                       fix.clock_bias.value());
    else
        fmt::format_to(out, ",,,,,,,,,,");
    fmt::format_to(out, "{:.4f}\n", trace.measurement.clock_bias.value());
    return fmt::to_string(row);
}

std::string satellite_rows(const Trace& trace) {
    const std::string time = utc_text(trace.truth.time);
    const bool measured = !trace.epoch.observations.signals.empty();
    fmt::memory_buffer rows;
    for (std::size_t i = 0; i < trace.sky.satellites.size(); ++i) {
        const SatelliteInView& sky = trace.sky.satellites[i];
        const Arrival& arrival = trace.arrivals.satellites[i];
        const SatelliteStatus* status = find_satellite(trace.epoch.fix.satellites, sky.id, &SatelliteStatus::id);
        const auto out = std::back_inserter(rows);
        fmt::format_to(out, "{},{},", time, to_string(sky.id));
        append_arrival(rows, sky, arrival);
        const auto pseudorange = measured ? measured_pseudorange(trace, sky.id) : ideal_pseudorange(sky, arrival);
        if (pseudorange) fmt::format_to(out, "{:.4f}", *pseudorange);
        fmt::format_to(out, ",{},", status && status->used ? 1 : 0);
        append_errors(rows, arrival, find_satellite(trace.measurement.signals, sky.id, &SignalTerms::satellite));
        if (status && status->residual) fmt::format_to(out, "{:.4f}", status->residual->value());
        rows.push_back('\n');
    }
    return fmt::to_string(rows);
}

}  // namespace skyloop
