#include "detail/dataflash_places.hpp"

#include <cmath>

#include "base/core/std_additions.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline motion {
namespace {

GlobalSample moved_place(const GlobalSample& origin, const LocalSample& local) {
    GlobalSample there = on_ardupilot_map(origin, *local.place);
    there.ns = local.ns;
    return there;
}

// The origin that brings the metres to the degrees; nothing when one in twenty places stays 0.3 m away.
std::optional<GlobalSample> fitted_origin(const std::vector<GlobalSample>& globals, const VectorSeries& places) {
    constexpr double most_m = 0.3;
    constexpr std::size_t fewest = 3;
    std::vector<std::pair<GlobalSample, Eigen::Vector3d>> pairs;
    for (const GlobalSample& global : globals)
        if (const auto place = places.at(global.ns)) pairs.emplace_back(global, *place);
    if (pairs.size() < fewest) return std::nullopt;
    std::vector<double> latitudes, longitudes, heights, misses;
    for (const auto& [global, ned] : pairs) {
        latitudes.push_back(global.latitude_deg - ned.x() / ardupilot_metres_per_degree);
        heights.push_back(global.height_m + ned.z());
    }
    GlobalSample origin{0, middle_of(latitudes), 0, middle_of(heights)};
    for (const auto& [global, ned] : pairs)
        longitudes.push_back(global.longitude_deg -
                             ned.y() / ardupilot_metres_per_degree_east(origin.latitude_deg, ned.x()));
    origin.longitude_deg = middle_of(longitudes);
    for (const auto& [global, ned] : pairs) {
        const GlobalSample there = moved_place(origin, {global.ns, ned, {}});
        const double north = (there.latitude_deg - global.latitude_deg) * ardupilot_metres_per_degree;
        const double east =
            (there.longitude_deg - global.longitude_deg) * ardupilot_metres_per_degree_east(global.latitude_deg, 0);
        misses.push_back(Eigen::Vector3d(north, east, there.height_m - global.height_m).norm());
    }
    const auto nearly_all = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() * 19 / 20);
    std::nth_element(misses.begin(), nearly_all, misses.end());
    return *nearly_all <= most_m ? std::optional(origin) : std::nullopt;
}

std::optional<FlightRow> row_at(const GlobalSample& sample) {
    return flight_row(sample.ns, sample.latitude_deg, sample.longitude_deg, sample.height_m);
}

std::optional<GlobalSample> global_sample(const DataflashRecord& record, std::int64_t ns) {
    const auto latitude = record.value("Lat"), longitude = record.value("Lng"), height = record.value("Alt");
    if (!latitude || !longitude || !height || !flight_row(ns, *latitude, *longitude, *height)) return std::nullopt;
    return GlobalSample{ns, *latitude, *longitude, *height};
}

LocalSample local_sample(const DataflashRecord& record, std::int64_t ns) {
    constexpr double farthest_m = 1e6;
    LocalSample sample{ns, {}, logged_velocity(record.value("VN"), record.value("VE"), record.value("VD"))};
    const auto north = record.value("PN"), east = record.value("PE"), down = record.value("PD");
    if (!north || !east || !down) return sample;
    const Eigen::Vector3d place(*north, *east, *down);
    if (place.cwiseAbs().maxCoeff() <= farthest_m) sample.place = place;
    return sample;
}

void add_turn(AttitudeSeries& turns, std::int64_t ns, const std::optional<Eigen::Quaterniond>& turn) {
    if (turn) turns.add(ns, *turn);
}

std::optional<Eigen::Quaterniond> record_angles(const DataflashRecord& record) {
    return logged_angles(record.value("Roll"), record.value("Pitch"), record.value("Yaw"));
}

std::optional<Eigen::Quaterniond> record_quaternion(const DataflashRecord& record) {
    return logged_quaternion(record.value("Q1"), record.value("Q2"), record.value("Q3"), record.value("Q4"));
}

int small_number(const std::optional<double>& number) {
    return number && *number >= 0 && *number < 16 ? static_cast<int>(*number) : 0;
}

}  // namespace

std::vector<FlightRow> joined_rows(const std::vector<GlobalSample>& globals, const std::vector<LocalSample>& locals,
                                   const std::optional<GlobalSample>& origin) {
    VectorSeries places, velocities;
    for (const LocalSample& local : locals) {
        if (local.place) places.add(local.ns, *local.place);
        if (local.velocity) velocities.add(local.ns, *local.velocity);
    }
    places.sort();
    velocities.sort();
    std::vector<FlightRow> rows;
    if (const auto from = globals.empty() ? origin : fitted_origin(globals, places)) {
        for (const LocalSample& local : locals) {
            auto row = local.place ? row_at(moved_place(*from, local)) : std::nullopt;
            if (!row) continue;
            row->velocity_ned = local.velocity;
            rows.push_back(*row);
        }
        return rows;
    }
    for (const GlobalSample& global : globals) {
        auto row = row_at(global);
        if (!row) continue;
        row->velocity_ned = velocities.at(global.ns);
        rows.push_back(*row);
    }
    return rows;
}

void DataflashStart::take(const DataflashRecord& record, std::int64_t ns) {
    const std::string& name = record.name();
    if (name.starts_with("SIM")) return take_simulation(record, ns);
    if (name.starts_with("GP")) return take_receiver(record, ns);
    if (name.starts_with("XK") || name.starts_with("NK")) return take_filter(record, ns);
    if (name == "ATT") return add_turn(turns, ns, record_angles(record));
    const auto place = name == "POS" || name == "ORGN" ? global_sample(record, ns) : std::nullopt;
    if (!place) return;
    if (name == "POS") estimated.push_back(*place);
    if (name == "ORGN" && record.value("Type").value_or(1) == 0) origin = *place;
}

void DataflashStart::take_simulation(const DataflashRecord& record, std::int64_t ns) {
    if (record.name() == "SIM2") {
        simulated_motion.push_back(local_sample(record, ns));
    } else if (record.name() == "SIM") {
        if (const auto place = global_sample(record, ns)) simulated.push_back(*place);
        const auto turn = record_quaternion(record);
        add_turn(simulated_turns, ns, turn ? turn : record_angles(record));
    }
}

// Old logs number the cores by the name; only the first one's are read there.
void DataflashStart::take_filter(const DataflashRecord& record, std::int64_t ns) {
    const std::string& name = record.name();
    const std::string kind = name.substr(0, 1) + "KF1";
    const int core = small_number(record.raw({"C"}));
    if (name == kind) {
        DataflashCore& of = cores[{kind, core}];
        of.places.push_back(local_sample(record, ns));
        add_turn(of.angles, ns, record_angles(record));
    } else if (name.substr(1) == "KQ" || name.substr(1) == "KQ1") {
        add_turn(cores[{kind, core}].quaternions, ns, record_quaternion(record));
    } else if (name.substr(1) == "KF4") {
        if (const auto told = record.raw({"PI"}); told && core == 0) ++primary[small_number(told)];
    }
}

void DataflashStart::take_receiver(const DataflashRecord& record, std::int64_t ns) {
    const std::string& name = record.name();
    const bool second = name == "GPS2" || name == "GPA2";
    if (!second && name != "GPS" && name != "GPA") return;
    DataflashReceiver& receiver = receivers[second ? 1 : small_number(record.raw({"I"}))];
    if (name.starts_with("GPA")) {
        if (const auto undulation = dataflash_undulation(record))
            receiver.undulations_mm.push_back(std::llround(*undulation * 1e3));
        return;
    }
    const auto [told, time] = dataflash_fix(record);
    const auto gps_ns = time ? std::optional(time->time_since_epoch().count()) : std::nullopt;
    if (gps_ns && told.type >= FixType::fix_3d) offsets_3d.push_back(*gps_ns - ns);
    if (gps_ns) offsets.push_back(*gps_ns - ns);
    if (!told.place) return;
    FlightRow row{ns, *told.place};
    if (told.velocity)
        row.velocity_ned = logged_velocity(told.velocity->north, told.velocity->east, told.velocity->down);
    receiver.epochs.push_back({row, gps_ns});
}

}  // namespace skyloop::inline motion
