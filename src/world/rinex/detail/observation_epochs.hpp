/// Epochs of RINEX observation files: their first lines and the records of their satellites.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "fields.hpp"
#include "observation_header.hpp"

namespace skyloop::inline world::rinex {

/// The first line of an epoch.
struct EpochHead {
    std::optional<GpsTime> time;  ///< the calendar as written, read as if it were GPST; events may have none
    int flag = 0;                 ///< 0 … 6 (RINEX 3.05, table A3)
    int count = 0;                ///< of the satellites, or of the lines that follow
    [[nodiscard]] bool event() const { return flag >= 2 && flag <= 5; }
};

/// Reads it, or nothing: flags 0, 1 and 6 need a time.
std::optional<EpochHead> epoch_head(std::string_view line, int major);

/// The observations of one satellite at one epoch: one line, of version 2 one for each five.
class SatelliteRecord {
public:
    SatelliteRecord(SatelliteId satellite, std::span<const Line> lines, int major)
        : satellite_(satellite), lines_(lines), major_(major) {}
    [[nodiscard]] SatelliteId satellite() const { return satellite_; }
    /// Sixteen columns, fewer where the line ends.
    [[nodiscard]] std::string_view field(int index) const;

private:
    SatelliteId satellite_;
    std::span<const Line> lines_;
    int major_;
};

/// What was wrong with a field.
struct BadField {
    std::string text;
    std::string expected;
};

/// Turns records into observations; remembers phases from epoch to epoch.
class SignalReading {
public:
    /// Every phase is broken: the receiver had no power.
    void break_all();
    /// The phases of one satellite are broken.
    void break_phases(SatelliteId satellite);

    /// Appends what was measured of the satellite. @param channel of GLONASS @param bad takes fields that cannot be
    /// read
    void append(const SatelliteRecord& record, const SystemLayout& layout, int channel, Observations& epoch,
                std::vector<BadField>& bad);

private:
    struct PhaseHistory {
        GpsTime since;
        std::size_t code = 0;
        bool broken = false;
    };
    void follow_phase(Observation& observation, GpsTime time, std::size_t code);

    std::map<std::pair<SatelliteId, Signal>, PhaseHistory> phases_;
};

}  // namespace skyloop::inline world::rinex
