#include "receiver/logs/receiver_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/middle.hpp"
#include "detail/log_parts.hpp"
#include "receiver/logs/dataflash.hpp"
#include "receiver/logs/ulog.hpp"

namespace skyloop {
namespace {

// By the clock of epochs with a fix, where there are any: that of a receiver without one may be anything.
GpsTime middle_time(const std::vector<LogEpoch>& epochs) {
    std::vector<GpsTime> times, of_fixes;
    for (const LogEpoch& epoch : epochs) {
        times.push_back(epoch.time);
        if (!epoch.is_lost()) of_fixes.push_back(epoch.time);
    }
    return middle_of(of_fixes.empty() ? times : of_fixes);
}

}  // namespace

int logged_number(std::optional<double> value) {
    constexpr double most = 65535;
    return value && *value >= 0 && *value <= most ? static_cast<int>(*value) : 0;
}

std::optional<Geodetic> logged_place(double latitude_deg, double longitude_deg, double height_m) {
    // 0, 0 is where receivers put what they do not know.
    if (latitude_deg == 0 && longitude_deg == 0) return std::nullopt;
    const auto place = place_from_degrees(latitude_deg, longitude_deg, height_m);
    return place ? std::optional(*place) : std::nullopt;
}

void add_satellite(std::vector<LoggedSatellite>& satellites, const LoggedSatellite& satellite) {
    if (!(satellite.cn0_dbhz > 0)) return;
    const auto at = std::lower_bound(satellites.begin(), satellites.end(), satellite,
                                     [](const LoggedSatellite& a, const LoggedSatellite& b) { return a.id < b.id; });
    if (at == satellites.end() || at->id != satellite.id)
        satellites.insert(at, satellite);
    else if (satellite.cn0_dbhz > at->cn0_dbhz)
        *at = satellite;
}

void add_note(ReceiverLog& log, std::size_t count, const std::string& what) {
    if (count > 0) log.notes.push_back(fmt::format("{} {}", count, what));
}

Result<ReceiverLog> finish_log(ReceiverLog log, const LogReading& reading) {
    constexpr auto longest = std::chrono::hours(7 * 24);
    std::vector<LogEpoch>& epochs = log.epochs;
    if (!epochs.empty()) {
        const GpsTime middle = middle_time(epochs);
        const auto astray = [&](const LogEpoch& e) { return std::chrono::abs(e.time - middle) > longest; };
        add_note(log, std::erase_if(epochs, astray), "epochs more than a week from the middle one were left out");
    }
    if (!reading.for_track) put_epochs_in_order(log);
    if (epochs.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: no epoch of a receiver with a date and time ({}); expected NAV-PVT, NAV-SOL or "
                                "NAV-TIMEGPS, RMC and GGA, vehicle_gps_position or GPS records",
                                log.name, log.format));
    return log;
}

Result<ReceiverLog> read_receiver_log(ByteSpan bytes, const std::string& name, const LogReading& reading) {
    if (bytes.empty()) return fail(ErrorCode::input, fmt::format("{}: is empty; expected a receiver's log", name));
    if (is_ulog(bytes)) return read_ulog(bytes, name, reading);
    if (is_dataflash(bytes)) return read_dataflash(bytes, name, reading);
    return read_stream_log(bytes, name, reading);
}

}  // namespace skyloop
