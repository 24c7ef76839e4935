#include "study/analysis/sky_listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/core/json.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline study {
namespace {

const Arrival* arrival_of(const SkyExtras& extras, SatelliteId id) {
    if (!extras.arrivals) return nullptr;
    const auto& all = extras.arrivals->satellites;
    const auto found = std::find_if(all.begin(), all.end(), [id](const Arrival& a) { return a.id == id; });
    return found == all.end() ? nullptr : &*found;
}

bool used_in_fix(const Fix& fix, SatelliteId id) {
    return std::any_of(fix.satellites.begin(), fix.satellites.end(),
                       [id](const SatelliteStatus& s) { return s.id == id && s.used; });
}

std::optional<Dop> dop_of_used(const SkyListing& listing) {
    std::vector<SkyDirection> directions;
    for (const SkyRow& row : listing.rows)
        if (row.used) directions.push_back({row.view.azimuth, row.view.elevation});
    return dilution_of_precision(directions);
}

// 359.96° is shown as 0.0°, not as 360.0°.
double shown_azimuth(Angle azimuth, double step) {
    const double degrees = azimuth.deg();
    return degrees >= 360 - step / 2 ? 0 : degrees;
}

std::string doppler_cell(const SatelliteInView& satellite, int decimals) {
    const std::optional<Hertz> doppler = first_doppler(satellite);
    return doppler ? fmt::format("{:.{}f}", doppler->value(), decimals) : std::string();
}

std::string cn0_cell(const std::optional<DbHz>& cn0, int decimals) {
    return cn0 ? fmt::format("{:.{}f}", cn0->value(), decimals) : std::string();
}

// A terminal shows what is not known as a dash.
std::string dashed(std::string cell) { return cell.empty() ? "-" : std::move(cell); }

// What a satellite's first path tells, for one that is not in line of sight.
struct FirstPathCells {
    std::string line_of_sight, paths, reflections, excess;
};
FirstPathCells first_path_cells(const SkyRow& row, int decimals) {
    if (!row.scene) return {};
    FirstPathCells cells{row.scene->line_of_sight ? "1" : "0", std::to_string(row.scene->paths.size()), {}, {}};
    if (row.scene->reception() != Reception::reflected) return cells;
    const ReflectedPath& first = row.scene->paths.front();
    cells.reflections = std::to_string(first.surfaces.size());
    cells.excess = fmt::format("{:.{}f}", first.excess.value(), decimals);
    return cells;
}

Json place_json(const Geodetic& place) {
    return {{"lat_deg", place.latitude.deg()},
            {"lon_deg", place.longitude.deg()},
            {"height_m", place.height.above_ellipsoid.value()}};
}

Json path_json(const ReflectedPath& path) {
    Json json{{"reflections", path.surfaces.size()},
              {"excess_m", path.excess.value()},
              {"excess_rate_mps", path.excess_rate.value()},
              {"loss_db", path.loss.value()},
              {"arrival_azimuth_deg", path.arrival.azimuth.deg()},
              {"arrival_elevation_deg", path.arrival.elevation.deg()}};
    json["points"] = Json::array();
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        Json point{{"surface", surface_kind_names[static_cast<std::size_t>(path.surfaces[i])]}};
        point.update(place_json(path.places[i]));
        const Eigen::Vector3d& p = path.points[i];
        point.update({{"east_m", p.x()}, {"north_m", p.y()}, {"up_m", p.z()}});
        json["points"].push_back(std::move(point));
    }
    return json;
}

void add_scene_json(Json& json, const SceneReception& scene) {
    json["reception"] = reception_names[static_cast<std::size_t>(scene.reception())];
    json["line_of_sight"] = scene.line_of_sight;
    json["paths"] = Json::array();
    for (const ReflectedPath& path : scene.paths)
        json["paths"].push_back(path_json(path));
}

std::string sky_text_row(const SkyRow& row, bool with_scene) {
    const SatelliteInView& s = row.view;
    std::string text =
        fmt::format("{:<10}{:>9.1f}{:>11.1f}{:>12.1f}{:>13.1f}{:>11}{:>10}  {:<10}", to_string(s.id),
                    shown_azimuth(s.azimuth, 0.1), s.elevation.deg(), s.range.value() / 1000, s.range_rate.value(),
                    dashed(doppler_cell(s, 0)), dashed(cn0_cell(row.cn0, 1)), s.healthy ? "healthy" : "unhealthy");
    if (!with_scene) return text + (row.used ? "yes\n" : "no\n");
    const FirstPathCells cells = first_path_cells(row, 2);
    const std::string_view reception =
        row.scene ? reception_names[static_cast<std::size_t>(row.scene->reception())] : "-";
    return text + fmt::format("{:<6}{:<15}{:>5}{:>13}{:>11}\n", row.used ? "yes" : "no", reception, dashed(cells.paths),
                              dashed(cells.reflections), dashed(cells.excess));
}

std::string sky_text_heading(const SkyListing& listing, bool with_scene) {
    const WeekAndTow gps = week_and_tow(listing.time);
    std::string text =
        fmt::format("{}  (GPS week {}, {:.3f} s)  at {:.7f}, {:.7f}, {:.2f} m  mask {:.4g} deg\n",
                    utc_text(listing.time, 3), gps.week, gps.tow_seconds(), listing.place.latitude.deg(),
                    listing.place.longitude.deg(), listing.place.height.above_ellipsoid.value(), listing.mask.deg());
    text += fmt::format("{:<10}{:>9}{:>11}{:>12}{:>13}{:>11}{:>10}  {:<10}", "satellite", "azimuth", "elevation",
                        "range", "range rate", "Doppler", "C/N0", "health");
    text += with_scene
                ? fmt::format("{:<6}{:<15}{:>5}{:>13}{:>11}\n", "used", "arrives", "paths", "reflections", "excess")
                : "used\n";
    text += fmt::format("{:<10}{:>9}{:>11}{:>12}{:>13}{:>11}{:>10}", "", "deg", "deg", "km", "m/s", "Hz", "dB-Hz");
    return text + (with_scene ? fmt::format("{:>62}\n", "m") : "\n");
}

Json satellite_json(const SkyRow& row) {
    const SatelliteInView& s = row.view;
    const WeekAndTow toe = week_and_tow(s.toe);
    Json json{{"satellite", to_string(s.id)},   {"system", constellation_name(s.id.constellation)},
              {"azimuth_deg", s.azimuth.deg()}, {"elevation_deg", s.elevation.deg()},
              {"range_m", s.range.value()},     {"range_rate_mps", s.range_rate.value()}};
    const std::optional<Hertz> doppler = first_doppler(s);
    json["doppler_hz"] = doppler ? Json(doppler->value()) : Json(nullptr);
    json["cn0_dbhz"] = row.cn0 ? Json(row.cn0->value()) : Json(nullptr);
    json["healthy"] = s.healthy;
    json["used"] = row.used;
    json["toe"] = {{"gps_week", toe.week}, {"tow_s", toe.tow_seconds()}};
    json["iode"] = s.iode;
    if (row.scene) add_scene_json(json, *row.scene);
    return json;
}

}  // namespace

std::size_t SkyListing::used() const {
    return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const SkyRow& r) { return r.used; }));
}

SkyListing sky_listing(const TruthState& truth, const SkyView& sky, Angle mask, const SkyExtras& extras) {
    SkyListing listing;
    listing.time = truth.time;
    listing.place = truth.geodetic;
    listing.mask = mask;
    for (const SatelliteInView& satellite : sky.satellites) {
        SkyRow row{satellite, std::nullopt, satellite.healthy && satellite.elevation >= mask};
        if (const Arrival* arrival = arrival_of(extras, satellite.id)) {
            row.cn0 = arrival->cn0;
            row.used = row.used && arrival->paths > 0;
        }
        if (extras.scene && listing.rows.size() < extras.scene->size())
            row.scene = (*extras.scene)[listing.rows.size()];
        row.used = row.used && !(row.scene && row.scene->reception() == Reception::blocked);
        if (extras.fix) row.used = used_in_fix(*extras.fix, satellite.id);
        listing.rows.push_back(row);
    }
    listing.dop = dop_of_used(listing);
    if (extras.fix) listing.dop = extras.fix->has_position() ? std::optional(extras.fix->dop) : std::nullopt;
    return listing;
}

std::optional<Hertz> first_doppler(const SatelliteInView& satellite) {
    if (satellite.signals.empty()) return std::nullopt;
    return Hertz(-satellite.range_rate.value() * satellite.signals.front().carrier.value() / speed_of_light);
}

std::string sky_text(const SkyListing& listing) {
    const bool with_scene =
        std::any_of(listing.rows.begin(), listing.rows.end(), [](const SkyRow& row) { return row.scene.has_value(); });
    std::string text = sky_text_heading(listing, with_scene);
    for (const SkyRow& row : listing.rows)
        text += sky_text_row(row, with_scene);
    text += fmt::format("{} above the horizon, {} used", listing.rows.size(), listing.used());
    if (!listing.dop) return text + "; no DOP: fewer than four used satellites or all in one plane\n";
    const Dop& d = *listing.dop;
    return text + fmt::format("; GDOP {:.2f}  PDOP {:.2f}  HDOP {:.2f}  VDOP {:.2f}  TDOP {:.2f}\n", d.gdop, d.pdop,
                              d.hdop, d.vdop, d.tdop);
}

std::string sky_json(const SkyListing& listing) {
    const WeekAndTow gps = week_and_tow(listing.time);
    Json json{{"time_utc", utc_text(listing.time, 3)}, {"gps_week", gps.week}, {"tow_s", gps.tow_seconds()}};
    json["position"] = place_json(listing.place);
    json["mask_deg"] = listing.mask.deg();
    json["satellites"] = Json::array();
    for (const SkyRow& row : listing.rows)
        json["satellites"].push_back(satellite_json(row));
    json["visible"] = listing.rows.size();
    json["used"] = listing.used();
    json["dop"] = nullptr;
    if (const auto& d = listing.dop)
        json["dop"] = {{"gdop", d->gdop}, {"pdop", d->pdop}, {"hdop", d->hdop}, {"vdop", d->vdop}, {"tdop", d->tdop}};
    return json.dump(2) + "\n";
}

std::string sky_csv(std::span<const SkyListing> listings) {
    std::string text =
        "time_utc,satellite,azimuth_deg,elevation_deg,range_m,range_rate_mps,doppler_hz,cn0_dbhz,healthy,used,"
        "toe_gps_week,toe_tow_s,iode,line_of_sight,paths,reflections,excess_m\n";
    for (const SkyListing& listing : listings) {
        const std::string time = utc_text(listing.time, 3);
        for (const SkyRow& row : listing.rows) {
            const SatelliteInView& s = row.view;
            const WeekAndTow toe = week_and_tow(s.toe);
            const FirstPathCells city = first_path_cells(row, 4);
            fmt::format_to(std::back_inserter(text),
                           "{},{},{:.6f},{:.6f},{:.3f},{:.4f},{},{},{:d},{:d},{},{:.3f},{},{},{},{},{}\n", time,
                           to_string(s.id), shown_azimuth(s.azimuth, 1e-6), s.elevation.deg(), s.range.value(),
                           s.range_rate.value(), doppler_cell(s, 3), cn0_cell(row.cn0, 2), s.healthy, row.used,
                           toe.week, toe.tow_seconds(), s.iode, city.line_of_sight, city.paths, city.reflections,
                           city.excess);
        }
    }
    return text;
}

std::string tracks_csv(std::span<const SatelliteTrack> tracks) {
    std::vector<std::pair<SatelliteId, const TrackPoint*>> rows;
    for (const SatelliteTrack& track : tracks)
        for (const TrackPoint& point : track.points)
            rows.emplace_back(track.satellite, &point);
    std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second->time, a.first) < std::pair(b.second->time, b.first);
    });
    std::string text = "time_utc,satellite,x_m,y_m,z_m\n";
    for (const auto& [satellite, point] : rows) {
        const Eigen::Vector3d& p = point->position.vector();
        fmt::format_to(std::back_inserter(text), "{},{},{:.3f},{:.3f},{:.3f}\n", utc_text(point->time, 3),
                       to_string(satellite), p.x(), p.y(), p.z());
    }
    return text;
}

}  // namespace skyloop::inline study
