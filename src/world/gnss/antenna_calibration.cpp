#include "world/gnss/antenna_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace skyloop::inline world {
namespace {

// Of a row of values from the first one on, at so many steps.
double between_points(const std::vector<double>& row, double steps) {
    if (row.empty()) return 0;
    const double last = static_cast<double>(row.size() - 1);
    const double at = std::clamp(steps, 0.0, last);
    const auto before = static_cast<std::size_t>(std::min(std::floor(at), std::max(last - 1, 0.0)));
    const std::size_t after = std::min(before + 1, row.size() - 1);
    const double part = at - static_cast<double>(before);
    return row[before] * (1 - part) + row[after] * part;
}

// MHz, by the bands of RINEX 3.05, tables 12 to 18.
double band_mhz(Constellation constellation, int band) {
    if (constellation == Constellation::glonass) {
        constexpr std::array glonass{0., 1602., 1246., 1202.025, 1600.995, 0., 1248.06};
        return static_cast<std::size_t>(band) < glonass.size() ? glonass.at(static_cast<std::size_t>(band)) : 0;
    }
    if (constellation == Constellation::beidou && band == 2) return 1561.098;
    if (constellation == Constellation::beidou && band == 6) return 1268.52;
    constexpr std::array others{0., 1575.42, 1227.60, 0., 0., 1176.45, 1278.75, 1207.14, 1191.795, 2492.028};
    return static_cast<std::size_t>(band) < others.size() ? others.at(static_cast<std::size_t>(band)) : 0;
}

}  // namespace

Metres PhaseCentre::variation(Angle zenith, std::optional<Angle> azimuth) const {
    const double steps = (zenith.deg() - first_zenith.deg()) / zenith_step.deg();
    if (!azimuth || by_azimuth.size() < 2) return Metres(between_points(by_zenith, steps));
    const double around = std::fmod(std::fmod(azimuth->deg(), 360) + 360, 360);
    const double at = around / 360 * static_cast<double>(by_azimuth.size() - 1);
    const auto before = std::min(static_cast<std::size_t>(at), by_azimuth.size() - 2);
    const double part = at - static_cast<double>(before);
    return Metres(between_points(by_azimuth[before], steps) * (1 - part) +
                  between_points(by_azimuth[before + 1], steps) * part);
}

const PhaseCentre* AntennaCalibration::at(Constellation constellation, Signal signal) const {
    const double wanted_mhz = carrier_frequency(signal).value() / 1e6;
    for (const Constellation system : {constellation, Constellation::gps}) {
        const PhaseCentre* nearest = nullptr;
        double distance = 0;
        for (const auto& [key, centre] : centres_) {
            if (key.first != system) continue;
            const double apart = std::abs(band_mhz(system, key.second) - wanted_mhz);
            if (nearest != nullptr && apart >= distance) continue;
            nearest = &centre;
            distance = apart;
        }
        if (nearest != nullptr) return nearest;
    }
    return nullptr;
}

const AntennaCalibration* SatelliteAntennas::of(SatelliteId satellite, GpsTime time) const {
    const auto own = periods_.find(satellite);
    if (own == periods_.end()) return nullptr;
    for (const Period& period : own->second)
        if (time >= period.from && (!period.until || time <= *period.until)) return &period.antenna;
    return nullptr;
}

std::string receiver_antenna_name(std::string_view name) {
    std::istringstream words{std::string(name)};
    std::string type, radome = "NONE";
    words >> type >> radome;
    // A failed reading empties what it was to fill.
    return type + " " + (radome.empty() ? "NONE" : radome);
}

}  // namespace skyloop::inline world
