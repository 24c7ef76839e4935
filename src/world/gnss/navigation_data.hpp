/// Recorded broadcast orbits: every record of every satellite, and the rule that picks one.
/// A GPS constellation that needs no file.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// How a record is chosen (MODELS.md 3.3 and D-02).
struct EphemerisSelection {
    EphemerisRule rule = EphemerisRule::nearest;
    /// Largest age of any record: t − toe (forward) or |t − toe| (nearest); nothing: each system's own.
    std::optional<Seconds> validity = std::nullopt;

    [[nodiscard]] Seconds validity_of(const Ephemeris& record) const;
};

/// The largest age of a system's records: GPS, QZSS and NavIC 7200 s, Galileo 14 400 s, BeiDou 21 600 s, GLONASS 1800 s
/// (MODELS.md 3.3), SBAS 360 s (DO-229, table A-25), almanacs a week.
Seconds usual_validity(const Ephemeris& record);

/// The records of one satellite, ascending by toe; of those with the same toe the last one read comes last. All come
/// from one kind of message.
struct SatelliteRecords {
    SatelliteId satellite;
    std::vector<Ephemeris> records;
};

/// A source of orbits made of recorded ephemerides.
class NavigationData : public NavigationSource {
public:
    /// @param records in any order; repetitions of one (satellite, toe, iode) are kept once, the last of them
    /// @param description for people: the name of the file or files
    ///
    /// Messages of a satellite are not mixed: of Galileo I/NAV is taken, and F/NAV only when it has no record of I/NAV;
    /// of GPS, QZSS and BeiDou CNAV and its like only when it has no record of LNAV, D1 or D2; an almanac serves a
    /// satellite only when it has no ephemeris.
    NavigationData(const std::vector<Ephemeris>& records, const BroadcastIonosphere& ionosphere,
                   std::string description, EphemerisSelection selection = {});

    [[nodiscard]] std::vector<SatelliteId> satellites() const override;
    /// The record that the rule picks. Forward: the newest healthy one with 0 ≤ time − toe ≤ validity. Nearest: the one
    /// with the smallest |time − toe| ≤ validity, healthy or not; of two equally near ones the newer.
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    /// From the first toe (forward), or `validity` before it (nearest), to `validity` after the last; nothing when
    /// there are no records.
    [[nodiscard]] std::optional<TimeSpan> span() const override;
    [[nodiscard]] std::string description() const override { return description_; }

    /// The first toe of all records; nothing when there are none.
    [[nodiscard]] std::optional<GpsTime> first_epoch() const;
    [[nodiscard]] const std::vector<SatelliteRecords>& records() const { return satellites_; }
    [[nodiscard]] std::size_t record_count() const;
    [[nodiscard]] const EphemerisSelection& selection() const { return selection_; }
    /// How many satellites have a record for `time`.
    [[nodiscard]] std::size_t satellites_at(GpsTime time) const;

private:
    [[nodiscard]] const Ephemeris* find(const SatelliteRecords& satellite, GpsTime time) const;

    std::vector<SatelliteRecords> satellites_;  // ascending by satellite
    BroadcastIonosphere ionosphere_;
    std::string description_;
    EphemerisSelection selection_;
};

/// The record moved by `days` whole days: toe and toc keep their time of day, and omega0 takes up the change of the
/// time of week, so that every ECEF position at the same time of day stays what it was.
KeplerEphemeris moved_by_days(const KeplerEphemeris& record, std::int64_t days);
/// The same for a record of any system; of GLONASS the time of day is that of UTC.
Ephemeris moved_by_days(const Ephemeris& record, std::int64_t days);

/// A copy of `data` moved by the whole number of days that gives the most satellites at `start`; among equals by the
/// one that leaves the most data after `start`. Fails with `usage` when no move brings data to the time of day of
/// `start`.
Result<NavigationData> rebased(const NavigationData& data, GpsTime start);

/// One place in an orbital plane of the nominal constellation.
struct NominalSlot {
    std::string_view name;            ///< plane and place: "A1", "B1F"
    double argument_of_latitude_deg;  ///< at 1993-07-01T00:00:00
};

/// 31 healthy GPS satellites on circular orbits in six planes, at all times.
///
/// The 24 slots and the three expanded ones (27 satellites) are those of the GPS Standard Positioning Service
/// Performance Standard, 4th edition (2008), section 3.2, tables 3.2-1 and 3.2-2: inclination 55°, semi-major axis
/// 26 559.7 km. The 24 were held against a second print of the table; the six places of the expanded slots were not.
/// The other four satellites, named A5, B5, C5 and E5, are ours: each stands in the middle of the widest gap of its
/// plane. Satellites are numbered 1 … 31 in the order of slots(). Clocks are perfect. Motion is secular: the two-body
/// mean motion and the regression of the nodes, so that the sky keeps the true constellation's geometry, not its true
/// positions.
class NominalConstellation : public NavigationSource {
public:
    [[nodiscard]] std::vector<SatelliteId> satellites() const override;
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    /// A record with toe at the even hour of GPS time at or before `time`; positions run on smoothly from one record to
    /// the next. Nothing for a satellite without a slot.
    [[nodiscard]] std::optional<KeplerEphemeris> record(SatelliteId satellite, GpsTime time) const;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return "nominal GPS constellation"; }

    /// Satellite number n stands in slot n − 1.
    static std::span<const NominalSlot> slots();

private:
    BroadcastIonosphere ionosphere_;  // it says nothing of it
};

}  // namespace skyloop::inline world
