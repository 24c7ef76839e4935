#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/time/utc_time.hpp"
#include "receiver/observed/log_events.hpp"

namespace skyloop::inline receiver {
namespace {

std::string seconds_text(Nanoseconds span) { return fmt::format("{}", to_seconds(span).value()); }

// Text of a log inside a comment: one line, printable.
std::string plain_text(std::string_view text) {
    std::string plain;
    for (const char c : text.substr(0, 300))
        plain += c >= ' ' && c <= '~' ? c : '?';
    return plain;
}

std::string fault_text(const LogEvent& event) {
    const std::string when = fmt::format("at_s = {}\nfor_s = {}\n", seconds_text(event.at), seconds_text(event.lasts));
    const std::string comment = fmt::format("\n# In the log: {}.", plain_text(event.seen));
    const std::string of_satellite =
        event.satellite ? fmt::format("satellites = [\"{}\"]\n", to_string(*event.satellite)) : std::string();
    // fault.cn0_drop takes at most this.
    const double attenuation = std::min(100.0, std::round(event.drop_db * 10) / 10);
    switch (event.kind) {
        case LogEventKind::signals_lost:
            return fmt::format("{} Why the signals were gone it does not say.\n[[fault]]\nkind = \"outage\"\n{}",
                               comment, when);
        case LogEventKind::silent:
            return fmt::format(
                "{} The receiver, its wire or the logger may have been the cause.\n[[fault]]\nkind = "
                "\"receiver_silent\"\n{}",
                comment, when);
        case LogEventKind::fix_type:
            return fmt::format(
                "{} The type alone is told otherwise; places are those of the track.\n[[fault]]\nkind = "
                "\"wrong_fix_type\"\ntype = \"{}\"\n{}",
                comment, fix_type_name(event.type), when);
        case LogEventKind::drop:
            return fmt::format(
                "{} Attenuation and a jammer look alike; for the other one: kind = \"jamming\".\n[[fault]]\nkind = "
                "\"cn0_drop\"\nattenuation_db = {:g}\n{}",
                comment, attenuation, when);
        case LogEventKind::satellite_drop:
            return fmt::format("{}\n[[fault]]\nkind = \"cn0_drop\"\nattenuation_db = {:g}\n{}{}", comment, attenuation,
                               of_satellite, when);
        case LogEventKind::satellite_lost:
            return fmt::format("{}\n[[fault]]\nkind = \"outage\"\n{}{}", comment, of_satellite, when);
    }
    return {};
}

// The rows of the track. Places of epochs without signals are the receiver's guess: the path is bridged there.
std::string track_text(const ObservedLog& log, std::size_t& places) {
    const bool velocities = std::any_of(log.epochs.begin(), log.epochs.end(),
                                        [](const ObservedEpoch& epoch) { return epoch.velocity.has_value(); });
    std::string text = "gps_week,tow_s,lat_deg,lon_deg,h_ell_m";
    text += velocities ? ",vn_mps,ve_mps,vd_mps\n" : "\n";
    for (const ObservedEpoch& epoch : log.epochs) {
        if (!epoch.place || epoch.is_lost()) continue;
        ++places;
        const WeekAndTow split = week_and_tow(epoch.time);
        text +=
            fmt::format("{},{:.6f},{:.9f},{:.9f},{:.4f}", split.week, split.tow_seconds(), epoch.place->latitude.deg(),
                        epoch.place->longitude.deg(), epoch.place->height.above_ellipsoid.value());
        if (epoch.velocity)
            text += fmt::format(",{:.4f},{:.4f},{:.4f}\n", epoch.velocity->north, epoch.velocity->east,
                                epoch.velocity->down);
        else
            text += velocities ? ",,,\n" : "\n";
    }
    return text;
}

std::string trajectory_text(const ObservedLog& log, std::size_t places) {
    if (places > 1) return "[trajectory]\nkind = \"file\"\npath = \"track.csv\"\ntime = \"recorded\"\n";
    const auto at = std::find_if(log.epochs.begin(), log.epochs.end(),
                                 [](const ObservedEpoch& epoch) { return epoch.place && !epoch.is_lost(); });
    return fmt::format("# The log has one place.\n[trajectory]\nkind = \"fixed\"\nat = [{:.9f}, {:.9f}, {:.4f}]\n",
                       at->place->latitude.deg(), at->place->longitude.deg(),
                       at->place->height.above_ellipsoid.value());
}

std::string receiver_text(const ObservedLog& log, Nanoseconds period) {
    const double rate = std::clamp(1e9 / static_cast<double>(std::max<std::int64_t>(1, period.count())), 0.01, 100.0);
    std::string text = "[[receiver]]\n";
    if (log.board.empty())
        text += "# The log does not say which receiver it was; this is the default.\nboard = \"ublox-m8\"\n";
    else
        text += fmt::format("# By what the log says: {}.\nboard = \"{}\"\n", plain_text(log.receiver), log.board);
    return text + fmt::format("rate_hz = {:.6g}\n", rate);
}

}  // namespace

Result<LogScenario> scenario_of_log(const ObservedLog& log, const LogEvents& events) {
    LogScenario made;
    made.track = track_text(log, made.places);
    if (made.places == 0)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} epochs and none with a fix and a place; expected at least one", log.name,
                                log.epochs.size()));
    if (made.places == 1) made.track.clear();
    const GpsTime start = log.epochs.front().time;
    const Nanoseconds duration = log.epochs.back().time - start + events.period;
    made.scenario = fmt::format(
        "# Made by skyloop scenario-from of {}, a {} log of {} epochs.\n"
        "# Faults stand for what the log shows, to the epoch; what it does not show is not here. The sky is the "
        "nominal\n"
        "# GPS constellation until [sky] names the navigation data of that day.\n"
        "[run]\nstart = \"{}\"\nduration_s = {}\n\n{}\n{}",
        plain_text(log.name), log.format, log.epochs.size(), utc_text(start, 9), seconds_text(duration),
        trajectory_text(log, made.places), receiver_text(log, events.period));
    for (const LogEvent& event : events.events)
        made.scenario += fault_text(event);
    return made;
}

}  // namespace skyloop::inline receiver
