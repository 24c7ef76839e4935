/// Phase centres of antennas, of satellites and of receivers.
#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// The phase centre of an antenna at one frequency. A range is measured as that to the mean phase centre and the
/// variation more (ANTEX 1.4).
struct PhaseCentre {
    /// From the reference point, m: of a receiver north, east, up; of a satellite along its axes x, y, z, from the
    /// centre of mass.
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    Angle first_zenith{}, zenith_step = Angle::degrees(5);
    /// Variations, m, from `first_zenith` on, whatever the azimuth; of a satellite by the nadir angle.
    std::vector<double> by_zenith{};
    /// The same for azimuths 0°, one step and so on to 360°; empty: the antenna is told to be the same all around.
    std::vector<std::vector<double>> by_azimuth{};

    /// Between the points along straight lines, beyond them as at the last. @param azimuth clockwise from north;
    /// nothing: the mean over all
    [[nodiscard]] Metres variation(Angle zenith, std::optional<Angle> azimuth = std::nullopt) const;
};

/// An antenna at all frequencies that were measured.
class AntennaCalibration {
public:
    /// @param band of RINEX observation codes: 1 of G01
    void add(Constellation constellation, int band, PhaseCentre centre) {
        centres_[{constellation, band}] = std::move(centre);
    }
    [[nodiscard]] bool empty() const { return centres_.empty(); }
    /// That of the signal, else of the nearest carrier of its system, else of the nearest of GPS; null: none of these.
    /// Files have no L5 of most satellites of GPS, and of many receivers' antennas GPS and GLONASS alone.
    [[nodiscard]] const PhaseCentre* at(Constellation constellation, Signal signal) const;

private:
    std::map<std::pair<Constellation, int>, PhaseCentre> centres_;
};

/// Antennas of satellites, which come and go under one number.
class SatelliteAntennas {
public:
    struct Period {
        GpsTime from;                  ///< the first instant that it is that satellite's
        std::optional<GpsTime> until;  ///< the last; nothing: to this day
        AntennaCalibration antenna;
    };
    void add(SatelliteId satellite, Period period) { periods_[satellite].push_back(std::move(period)); }
    /// Null where the file tells none of that time.
    [[nodiscard]] const AntennaCalibration* of(SatelliteId satellite, GpsTime time) const;
    [[nodiscard]] std::size_t size() const { return periods_.size(); }

private:
    std::map<SatelliteId, std::vector<Period>> periods_;
};

/// What a file of calibrations holds.
struct AntennaCatalogue {
    SatelliteAntennas satellites;
    std::map<std::string, AntennaCalibration, std::less<>> receivers;  ///< by receiver_antenna_name()
};

/// A name of an antenna and its radome as catalogues are searched: words of it by single blanks; one without a radome
/// gets "NONE".
std::string receiver_antenna_name(std::string_view name);

}  // namespace skyloop::inline world
