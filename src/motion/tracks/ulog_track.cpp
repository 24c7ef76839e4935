#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "detail/ulog_local.hpp"
#include "receiver/observed/ulog.hpp"

namespace skyloop::inline motion {
namespace {

// A height above the ellipsoid that differs from the one above the sea; simulators without a geoid write both alike.
bool global_tells_ellipsoid(const UlogStream& stream) {
    constexpr double least_m = 0.01;
    return std::any_of(stream.records.begin(), stream.records.end(), [&](ByteSpan bytes) {
        const UlogRecord record(stream.fields, bytes);
        const double above = record.value("alt_ellipsoid").value_or(0), sea = record.value("alt").value_or(0);
        return above != 0 && std::abs(above - sea) > least_m;
    });
}

class UlogTrack {
public:
    UlogTrack(const Ulog& log, const TrackFile& file) : log_(log), file_(file) {}
    Result<Track> read();

private:
    [[nodiscard]] const UlogStream* stream(std::string_view topic) const;
    void offer_local(std::string_view topic, bool is_truth);
    void tell_resets(std::string_view topic, const UlogLocalPlaces& places);
    void offer_from_origin();
    [[nodiscard]] tl::unexpected<Error> no_place() const;
    void offer_global(std::string_view topic, std::string_view velocities);
    void offer_receivers();
    void offer_receiver(const UlogStream& stream);
    void offer(std::string name, std::vector<FlightRow> rows);
    [[nodiscard]] VectorSeries velocities_of(std::string_view topic) const;
    std::string take_attitudes(bool of_truth);
    std::optional<std::int64_t> gps_offset();
    [[nodiscard]] std::optional<std::int64_t> offset_of(std::string_view topic, double least_fix) const;
    void learn_undulation();
    [[nodiscard]] std::string records_there() const;

    const Ulog& log_;
    const TrackFile& file_;
    std::vector<FlightOffer> offers_;
    FlightLog flight_;
};

// Of several instances the one with most records.
const UlogStream* UlogTrack::stream(std::string_view topic) const {
    const UlogStream* best = nullptr;
    for (const UlogStream& candidate : log_.streams)
        if (candidate.topic == topic && !candidate.records.empty() &&
            (!best || candidate.records.size() > best->records.size()))
            best = &candidate;
    return best;
}

void UlogTrack::offer(std::string name, std::vector<FlightRow> rows) {
    if (rows.size() > 1) offers_.push_back({std::move(name), {std::move(rows)}});
}

void UlogTrack::offer_local(std::string_view topic, bool is_truth) {
    const UlogStream* source = stream(topic);
    if (!source) return;
    UlogLocalPlaces places(*source, is_truth);
    offer(std::string(topic), places.read());
    tell_resets(topic, places);
}

void UlogTrack::tell_resets(std::string_view topic, const UlogLocalPlaces& places) {
    if (places.resets() > 0)
        flight_.notes.push_back(
            fmt::format("{} resets of {} by up to {:.2f} m are taken for errors of the filter: what "
                        "came before was moved",
                        places.resets(), topic, places.farthest_reset_m()));
}

// Without any place on the Earth: metres from an origin that the user tells.
void UlogTrack::offer_from_origin() {
    constexpr std::string_view topic = "vehicle_local_position";
    const UlogStream* source = stream(topic);
    if (!source || !file_.reading.origin) return;
    UlogLocalPlaces places(*source, *file_.reading.origin);
    auto rows = places.read();
    flight_.notes.push_back(fmt::format("no place on the Earth in it: {} is laid out from the origin", topic));
    tell_resets(topic, places);
    if (places.untrusted() > 0)
        flight_.notes.push_back(
            fmt::format("{} of {} records of {} say that they are not valid; they are taken as they "
                        "stand",
                        places.untrusted(), rows.size(), topic));
    offer(std::string(topic), std::move(rows));
}

tl::unexpected<Error> UlogTrack::no_place() const {
    constexpr std::string_view topic = "vehicle_local_position";
    const UlogStream* local = stream(topic);
    if (local && local->records.size() > 1)
        return fail(ErrorCode::input,
                    fmt::format("{}: a ULog without a place on the Earth ({}); expected trajectory.origin = [latitude, "
                                "longitude, height] (--origin), from where its {} are counted",
                                file_.name, records_there(), topic));
    return fail(ErrorCode::input,
                fmt::format("{}: a ULog without two records of a place on the Earth ({}); expected a valid "
                            "vehicle_local_position, vehicle_global_position or fixes of vehicle_gps_position or "
                            "sensor_gps",
                            file_.name, records_there()));
}

VectorSeries UlogTrack::velocities_of(std::string_view topic) const {
    VectorSeries velocities;
    const UlogStream* source = stream(topic);
    if (!source) return velocities;
    for (const ByteSpan bytes : source->records) {
        const UlogRecord record(source->fields, bytes);
        if (record.value("v_xy_valid").value_or(1) == 0 || record.value("v_z_valid").value_or(1) == 0) continue;
        const auto ns = flight_clock_ns(record.value("timestamp"));
        const auto velocity = logged_velocity(record.value("vx"), record.value("vy"), record.value("vz"));
        if (ns && velocity) velocities.add(*ns, *velocity);
    }
    velocities.sort();
    return velocities;
}

// Old logs have the velocity in it, later ones in the local position.
void UlogTrack::offer_global(std::string_view topic, std::string_view velocity_topic) {
    const UlogStream* source = stream(topic);
    if (!source) return;
    const bool ellipsoid = global_tells_ellipsoid(*source);
    const VectorSeries velocities = velocities_of(velocity_topic);
    std::vector<FlightRow> rows;
    std::optional<ByteSpan> before;
    for (const ByteSpan bytes : source->records) {
        const UlogRecord record(source->fields, bytes);
        const auto number = [&](std::string_view name) { return record.value(name).value_or(std::nan("")); };
        const auto ns = flight_clock_ns(record.value("timestamp"));
        if (!ns) continue;
        auto row = flight_row(*ns, number("lat"), number("lon"), number(ellipsoid ? "alt_ellipsoid" : "alt"));
        if (!row) continue;
        row->above_sea = !ellipsoid;
        row->velocity_ned = logged_velocity(record.value("vel_n"), record.value("vel_e"), record.value("vel_d"));
        if (!row->velocity_ned) row->velocity_ned = velocities.at(*ns);
        const auto reset = [&](std::string_view counter) {
            return UlogRecord(source->fields, *before).value(counter) != record.value(counter);
        };
        row->jump = before && (reset("lat_lon_reset_counter") || reset("alt_reset_counter"));
        rows.push_back(*row);
        before = bytes;
    }
    offer(std::string(topic), std::move(rows));
}

void UlogTrack::offer_receivers() {
    std::vector<const UlogStream*> receivers;
    for (const UlogStream& candidate : log_.streams)
        if (candidate.topic == "vehicle_gps_position" || candidate.topic == "sensor_gps")
            receivers.push_back(&candidate);
    std::stable_sort(receivers.begin(), receivers.end(),
                     [](const UlogStream* a, const UlogStream* b) { return a->records.size() > b->records.size(); });
    for (const UlogStream* receiver : receivers)
        offer_receiver(*receiver);
}

// What the receiver measured.
void UlogTrack::offer_receiver(const UlogStream& source) {
    std::vector<FlightRow> rows;
    for (const UlogFix& fix : ulog_fixes(source)) {
        const auto ns = flight_clock_ns(fix.boot_us);
        if (!ns || !fix.told.place || fix.told.type == FixType::none) continue;
        FlightRow& row = rows.emplace_back(FlightRow{*ns, *fix.told.place, fix.above_sea});
        if (const auto& velocity = fix.told.velocity)
            row.velocity_ned = logged_velocity(velocity->north, velocity->east, velocity->down);
    }
    offer(source.instance == 0 ? source.topic : fmt::format("{} {}", source.topic, source.instance), std::move(rows));
}

std::string UlogTrack::take_attitudes(bool of_truth) {
    for (const std::string_view topic : {"vehicle_attitude_groundtruth", "vehicle_attitude"}) {
        const UlogStream* source = stream(topic);
        if (!source || (!of_truth && topic != "vehicle_attitude")) continue;
        AttitudeSeries& attitudes = flight_.clocks.front().attitudes;
        for (const ByteSpan bytes : source->records) {
            const UlogRecord record(source->fields, bytes);
            const auto ns = flight_clock_ns(record.value("timestamp"));
            const auto turn = logged_quaternion(record.value("q[0]"), record.value("q[1]"), record.value("q[2]"),
                                                record.value("q[3]"));
            if (ns && turn) attitudes.add(*ns, *turn);
        }
        if (attitudes.size() > 0) return fmt::format(", attitudes those of {}", topic);
    }
    return {};
}

// UTC less the clock of the autopilot: the middle one of the records that have a fix (FEEDS.md 1.7).
std::optional<std::int64_t> UlogTrack::offset_of(std::string_view topic, double least_fix) const {
    std::vector<std::int64_t> offsets;
    for (const UlogStream& source : log_.streams) {
        if (source.topic != topic) continue;
        for (const ByteSpan bytes : source.records) {
            const UlogRecord record(source.fields, bytes);
            if (record.value("fix_type").value_or(least_fix) < least_fix) continue;
            const auto gps = gps_ns_of_posix_us(record.value({"time_utc_usec", "time_gps_usec"}).value_or(0));
            const auto ns = flight_clock_ns(record.value("timestamp"));
            if (gps && ns) offsets.push_back(*gps - *ns);
        }
    }
    return middle_offset(offsets);
}

std::optional<std::int64_t> UlogTrack::gps_offset() {
    constexpr double fix_3d = 3;
    for (const double least_fix : {fix_3d, 0.0})
        for (const std::string_view topic : {"vehicle_gps_position", "sensor_gps", "vehicle_global_position"})
            if (const auto offset = offset_of(topic, least_fix)) return offset;
    // A simulator in lock-step may count UTC itself.
    const std::int64_t first_ns = flight_.places.starts.front().front().ns;
    const std::int64_t first_us = first_ns / 1000;
    const auto gps_ns = gps_ns_of_posix_us(static_cast<double>(first_us));
    if (!gps_ns) return std::nullopt;
    flight_.notes.emplace_back("no receiver tells UTC; the log's own clock counts it");
    return *gps_ns - first_us * 1000;
}

// The receivers' geoid, for where the grid is not there.
void UlogTrack::learn_undulation() {
    std::vector<std::int64_t> undulations_mm;
    for (const UlogStream& source : log_.streams) {
        if (source.topic != "vehicle_gps_position" && source.topic != "sensor_gps") continue;
        for (const UlogFix& fix : ulog_fixes(source)) {
            constexpr double least_m = 1e-3, highest_m = 200;
            const double undulation_m = fix.undulation_m.value_or(0);
            if (std::abs(undulation_m) >= least_m && std::abs(undulation_m) < highest_m)
                undulations_mm.push_back(std::llround(undulation_m * 1e3));
        }
    }
    if (const auto middle = middle_offset(undulations_mm)) flight_.undulation_m = static_cast<double>(*middle) * 1e-3;
}

std::string UlogTrack::records_there() const {
    std::string there;
    for (const UlogStream& source : log_.streams)
        there += fmt::format("{}{} {}", there.empty() ? "" : ", ", source.records.size(), source.topic);
    return there.empty() ? "none of any topic that has one" : there;
}

Result<Track> UlogTrack::read() {
    offer_local("vehicle_local_position_groundtruth", true);
    offer_global("vehicle_global_position_groundtruth", "vehicle_local_position_groundtruth");
    const std::size_t of_truth = offers_.size();
    offer_local("vehicle_local_position", false);
    offer_global("vehicle_global_position", "vehicle_local_position");
    offer_receivers();
    if (offers_.empty()) offer_from_origin();
    const auto chosen = chosen_offer(offers_);
    if (!chosen) return no_place();
    flight_.name = file_.name;
    flight_.places = std::move(offers_[*chosen]);
    flight_.format = "ULog, " + flight_.places.name;
    flight_.clocks.resize(1);
    const std::string attitudes = take_attitudes(*chosen < of_truth);
    flight_.notes.insert(flight_.notes.begin(), told_choice(flight_.places, *chosen) + attitudes);
    flight_.clocks.front().gps_offset_ns = gps_offset();
    learn_undulation();
    add_count_note(flight_.notes, log_.dropouts,
                   fmt::format("dropouts of the logger, {} ms together", log_.dropout_ms));
    add_count_note(flight_.notes, log_.cut_records, "records that are cut or of a wrong length were left out");
    add_count_note(flight_.notes, log_.skipped_bytes, "bytes of damage were passed over");
    return track_of_flight(std::move(flight_), file_.reading.geoid);
}

}  // namespace

bool is_ulog_track(const TrackFile& file) { return is_ulog(file.bytes); }

Result<Track> read_ulog_track(const TrackFile& file) {
    const auto log = parse_ulog(file.bytes, file.name,
                                {"vehicle_local_position_groundtruth", "vehicle_global_position_groundtruth",
                                 "vehicle_attitude_groundtruth", "vehicle_local_position", "vehicle_global_position",
                                 "vehicle_attitude", "vehicle_gps_position", "sensor_gps"});
    if (!log) return fail(log.error());
    return UlogTrack(*log, file).read();
}

}  // namespace skyloop::inline motion
