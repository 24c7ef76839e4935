/// The satellites above a place as a table: for a terminal, as JSON and as CSV.
/// Satellite tracks as a table.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/analysis/scene_sky.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/gnss/dop.hpp"
#include "world/sky/satellite_tracks.hpp"

namespace skyloop::inline study {

/// One satellite of the listing.
struct SkyRow {
    SatelliteInView view;
    std::optional<DbHz> cn0;
    bool used = false;
    std::optional<SceneReception> scene{};  ///< nothing without a city
};

/// The sky at one instant.
struct SkyListing {
    GpsTime time;
    Geodetic place;
    Angle mask;                ///< elevation mask
    std::vector<SkyRow> rows;  ///< in the order of the SkyView
    std::optional<Dop> dop;    ///< of the used satellites; nothing for fewer than four or a singular geometry

    [[nodiscard]] std::size_t used() const;
};

/// What is known beyond the geometry; each may be absent.
struct SkyExtras {
    const Arrivals* arrivals = nullptr;                  ///< C/N0 and hidden satellites
    const Fix* fix = nullptr;                            ///< which satellites were used and the DOP
    const std::vector<SceneReception>* scene = nullptr;  ///< what the city does, one for each satellite of the sky
};

/// The listing of `sky`. Without a fix every healthy satellite at or above `mask` that is not hidden, by
/// arrivals or by the city, counts as used.
SkyListing sky_listing(const TruthState& truth, const SkyView& sky, Angle mask, const SkyExtras& extras = {});

/// Doppler shift of the satellite's first signal, D = −ρ̇ f / c; nothing for a satellite that sends none.
std::optional<Hertz> first_doppler(const SatelliteInView& satellite);

/// An aligned table with a heading and a DOP line, ending in a newline.
std::string sky_text(const SkyListing& listing);
/// One JSON object, indented, ending in a newline. With a city each satellite has "line_of_sight", "reception" and
/// "paths", each of these with its surfaces, points and lengths.
std::string sky_json(const SkyListing& listing);
/// CSV with a header line, a row per satellite and instant:
/// time_utc,satellite,azimuth_deg,elevation_deg,range_m,range_rate_mps,doppler_hz,cn0_dbhz,healthy,used,toe_gps_week,
/// toe_tow_s,iode,line_of_sight,paths,reflections,excess_m (healthy, used, line_of_sight: 1 or 0; the last four are
/// empty without a city; reflections and excess_m are those of the first path of a satellite that is not in line of
/// sight).
std::string sky_csv(std::span<const SkyListing> listings);

/// All points as CSV, ascending by time and then by satellite: time_utc,satellite,x_m,y_m,z_m (metres, to a
/// millimetre).
std::string tracks_csv(std::span<const SatelliteTrack> tracks);

}  // namespace skyloop::inline study
