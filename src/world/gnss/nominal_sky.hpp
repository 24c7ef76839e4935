/// Satellites of every system that need no file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "world/gnss/navigation_data.hpp"

namespace skyloop::inline world {

/// The satellites of the systems that are asked for, at all times: GPS as NominalConstellation, the others that were in
/// service on 2023-01-01, placed as their broadcast records of that day have them to 0.1° (IGS,
/// BRDC00IGS_R_20230010000_01D_MN) and moved on by secular motion: the nodes by the Earth's oblateness, the satellites
/// so that the ground track repeats as the system is built for. Orbits are circular but those of QZSS, geostationary
/// satellites stand still. Clocks and group delays are 0.
///
/// Revolutions while the Earth turns below the nodes: Galileo 17 in 10 (OS SIS ICD 2.0; European GNSS Service Centre,
/// reference constellation), BeiDou's MEO 13 in 7 (Open Service Performance Standard 3.0, section 3), GLONASS 17 in 8
/// (ICD L1, L2 GLONASS 5.1, section 3.3), QZSS and inclined geosynchronous orbits 1.
class NominalSky : public NavigationSource {
public:
    explicit NominalSky(const std::vector<Constellation>& systems);

    [[nodiscard]] std::vector<SatelliteId> satellites() const override { return satellites_; }
    /// A record as the system sends them, its time of reference at or before `time`, of GLONASS nearest to it.
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return description_; }

private:
    NominalConstellation gps_;
    std::vector<SatelliteId> satellites_;
    std::string description_;
    BroadcastIonosphere ionosphere_;  // it says nothing of it
};

}  // namespace skyloop::inline world
