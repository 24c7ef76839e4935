#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <string_view>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "detail/recording_formats.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline run {
namespace {

// Fields of a file of comma-separated values, some of which have a row for each satellite and epoch of a run.
class CsvRows {
public:
    explicit CsvRows(std::size_t usual_length) { text_.reserve(usual_length); }
    CsvRows& text(std::string_view field) {
        text_.append(field);
        text_.push_back(',');
        return *this;
    }
    CsvRows& number(double value, int decimals) {
        const std::size_t begin = text_.size();
        append_fixed(text_, value, decimals);
        // What rounds to nothing has no sign.
        if (text_[begin] == '-' && text_.find_first_not_of("0.", begin + 1) == std::string::npos) text_.erase(begin, 1);
        text_.push_back(',');
        return *this;
    }
    CsvRows& number(const std::optional<double>& value, int decimals) {
        return value ? number(*value, decimals) : nothing();
    }
    CsvRows& whole(std::integral auto value) {
        fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},"), value);
        return *this;
    }
    CsvRows& nothing(std::size_t fields = 1) {
        text_.append(fields, ',');
        return *this;
    }
    void end_row() { text_.back() = '\n'; }
    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    std::string text_;
};

void append_solution(CsvRows& row, const Trace& trace) {
    const Fix& fix = trace.epoch.fix;
    const Eigen::Vector3d error = LocalFrame(trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    row.number(fix.position.latitude.deg(), 9).number(fix.position.longitude.deg(), 9);
    row.number(fix.position.height.above_ellipsoid.value(), 4);
    row.number(error.x(), 4).number(error.y(), 4).number(error.z(), 4);
    row.number(fix.velocity.north, 4).number(fix.velocity.east, 4).number(fix.velocity.down, 4);
    row.number(fix.speed.value(), 4).number(fix.course.deg(), 4);
}

void append_quality(CsvRows& row, const Fix& fix) {
    for (const double dilution : {fix.dop.gdop, fix.dop.pdop, fix.dop.hdop, fix.dop.vdop, fix.dop.tdop})
        std::isfinite(dilution) ? row.number(dilution, 3) : row.nothing();
    row.number(fix.horizontal_accuracy.value(), 3).number(fix.vertical_accuracy.value(), 3);
    row.number(fix.speed_accuracy.value(), 3).number(fix.time_accuracy.value(), 3);
    row.number(fix.clock_bias.value(), 4);
}

void append_error_scale(CsvRows& row, const Trace& trace) {
    if (trace.error_scale && trace.epoch.fix.has_position())
        row.number(trace.error_scale->sigma_uere.value(), 4).number(trace.error_scale->position_error.value(), 4);
    else
        row.nothing(2);
}

// The first of `items`, which ascend by satellite, that is not before `id`.
template <class Item>
auto first_of(const std::vector<Item>& items, SatelliteId id, SatelliteId Item::*member) {
    return std::lower_bound(items.begin(), items.end(), id,
                            [&](const Item& item, SatelliteId wanted) { return item.*member < wanted; });
}

const SatelliteStatus* find_status(const std::vector<SatelliteStatus>& all, SatelliteId id) {
    const auto found = first_of(all, id, &SatelliteStatus::id);
    return found != all.end() && found->id == id ? &*found : nullptr;
}

// Of the satellite's first signal, which the columns beside speak of: BeiDou's is not the first of the list.
template <class Item>
const Item* find_first_signal(const std::vector<Item>& items, SatelliteId id) {
    for (auto item = first_of(items, id, &Item::satellite); item != items.end() && item->satellite == id; ++item)
        if (item->signal == first_signal(id.constellation)) return &*item;
    return nullptr;
}

std::optional<double> measured_pseudorange(const Trace& trace, SatelliteId id) {
    const Observation* o = find_first_signal(trace.epoch.observations.signals, id);
    if (!o || !o->pseudorange) return std::nullopt;
    return o->pseudorange->value();
}

std::optional<double> ideal_pseudorange(const SatelliteInView& sky, const Arrival& arrival,
                                        const SatelliteStatus* status) {
    if (arrival.paths == 0 || !status || !status->cn0) return std::nullopt;  // not tracked
    const double clock = speed_of_light * (sky.clock_bias.value() - sky.group_delay().value());
    return sky.range.value() - clock + arrival.iono_delay.value() + arrival.tropo_delay.value() +
           arrival.excess_path.value();
}

void append_arrival(CsvRows& rows, const SatelliteInView& sky, const Arrival& arrival) {
    rows.number(sky.azimuth.deg(), 4).number(sky.elevation.deg(), 4).number(sky.range.value(), 4);
    rows.text(arrival.line_of_sight ? "1" : "0").whole(arrival.paths);
    rows.number(arrival.excess_path.value(), 4).number(arrival.iono_delay.value(), 4);
    rows.number(arrival.tropo_delay.value(), 4).number(arrival.gas_loss.value(), 5);
    rows.number(arrival.cloud_loss.value(), 5).number(arrival.rain_loss.value(), 5);
    arrival.cn0 ? rows.number(arrival.cn0->value(), 2) : rows.nothing();
}

void append_errors(CsvRows& rows, const Arrival& arrival, const SignalTerms* terms) {
    rows.number(arrival.signal_in_space_error.value(), 4);
    if (terms) {
        rows.number(terms->multipath.value(), 4).number(terms->code_noise.value(), 4);
        rows.number(terms->phase_noise.value(), 5).number(terms->doppler_noise.value(), 4);
    } else {
        rows.nothing(4);
    }
    rows.number(arrival.foliage_loss.value(), 3).number(arrival.antenna_gain.value(), 3);
    rows.number(arrival.power_offset.value(), 3).number(arrival.interference_loss.value(), 3);
    rows.number(arrival.amplitude_scintillation, 4).number(arrival.phase_scintillation.rad(), 4);
}

// What the other columns leave out of it.
void append_link_budget(CsvRows& rows, const Arrival& arrival) {
    rows.number(arrival.free_space_loss.value(), 5).number(arrival.iono_loss.value(), 5);
    rows.number(arrival.reflection_loss.value(), 5);
    const bool arrives = arrival.cn0 && arrival.received_power;
    arrives ? rows.number(arrival.received_power->value(), 5) : rows.nothing();
}

void append_fine_causes(CsvRows& rows, const Arrival& arrival) {
    const SignalArrival first = arrival.signals.empty() ? SignalArrival{} : arrival.signals.front();
    rows.number(first.satellite_antenna.value(), 4).number(first.receiver_antenna.value(), 4);
    rows.number(arrival.solid_tide.value(), 4).number(arrival.wind_up, 4);
}

}  // namespace

std::string fix_row(const Trace& trace) {
    const Fix& fix = trace.epoch.fix;
    const Geodetic& truth = trace.truth.geodetic;
    const WeekAndTow gps = week_and_tow(trace.truth.time);
    constexpr std::size_t usual_length = 500;
    CsvRows row(usual_length);
    row.text(utc_text(trace.truth.time, 3)).whole(gps.week).number(gps.tow_seconds(), 3);
    row.number(truth.latitude.deg(), 9).number(truth.longitude.deg(), 9);
    row.number(truth.height.above_ellipsoid.value(), 4);
    fix.has_position() ? append_solution(row, trace) : void(row.nothing(11));
    row.text(fix_type_name(fix.type)).whole(fix.satellites_used());
    row.whole(trace.sky.satellites.size());
    fix.has_position() ? append_quality(row, fix) : void(row.nothing(10));
    row.number(trace.measurement.clock_bias.value(), 4);
    append_error_scale(row, trace);
    row.end_row();
    return row.take();
}

std::string satellite_rows(const Trace& trace, bool precise) {
    const std::string time = utc_text(trace.truth.time, 3);
    constexpr std::size_t usual_length = 300;  // of a row
    CsvRows rows(usual_length * trace.sky.satellites.size());
    for (std::size_t i = 0; i < trace.sky.satellites.size(); ++i) {
        const SatelliteInView& sky = trace.sky.satellites[i];
        const Arrival& arrival = trace.arrivals.satellites[i];
        const SatelliteStatus* status = find_status(trace.epoch.fix.satellites, sky.id);
        rows.text(time).text(to_string(sky.id));
        append_arrival(rows, sky, arrival);
        rows.number(trace.measures ? measured_pseudorange(trace, sky.id) : ideal_pseudorange(sky, arrival, status), 4);
        rows.text(status && status->used ? "1" : "0");
        const SignalTerms* terms = find_first_signal(trace.measurement.signals, sky.id);
        append_errors(rows, arrival, terms);
        status && status->residual ? rows.number(status->residual->value(), 4) : rows.nothing();
        rows.number((arrival.false_range + (terms ? terms->false_code : Metres(0))).value(), 4);
        rows.text(reception_names.at(static_cast<std::size_t>(reception_of(arrival))));
        rows.number(arrival.direct_loss.value(), 2);
        rows.number((arrival.shadowing_loss - arrival.direct_loss).value(), 2);
        append_link_budget(rows, arrival);
        if (precise) append_fine_causes(rows, arrival);
        rows.end_row();
    }
    return rows.take();
}

Result<RinexRecording> RinexRecording::create(const std::filesystem::path& folder, const RinexRecordingSetup& setup) {
    RinexRecording recording(setup);
    const auto created = create_files(
        folder, {{&recording.observations_, "observations.rnx"}, {&recording.navigation_, "navigation.rnx"}});
    if (!created) return fail(created.error());
    recording.observations_.write(recording.writer_.header());
    recording.navigation_.write(navigation_header_text(setup.navigation));
    return recording;
}

void RinexRecording::record(const Trace& trace, const NavigationSource& broadcast) {
    for (const SatelliteInView& satellite : trace.sky.satellites) {
        const GpsTime now = trace.truth.time;
        const auto found = written_.find(satellite.id);
        if (found != written_.end() && found->second.toe == satellite.toe && found->second.issue == satellite.iode &&
            now < found->second.until)
            continue;
        Written& written = written_[satellite.id];
        written = {satellite.toe, satellite.iode, GpsTime::max()};
        auto record = broadcast.ephemeris(satellite.id, now);
        if (!record) continue;
        if (message_of(*record) == NavigationMessage::almanac) {
            record = ephemeris_of_almanac(std::get<KeplerEphemeris>(*record), now);
            written.until = toe_of(*record) + ephemeris_spacing / 2;
        }
        // Nobody is served by what has not been sent.
        navigation_.write(navigation_record_text(*record, std::min(now, toe_of(*record))));
    }
    if (!trace.epoch.observations.signals.empty()) observations_.write(writer_.epoch(trace.epoch.observations));
}

}  // namespace skyloop::inline run
