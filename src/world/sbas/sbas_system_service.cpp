#include "detail/sbas_system_service.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

// Corrections are made once for each frame of the schedule, whichever satellite sends them.
constexpr std::chrono::seconds generation_period{6}, generation_lag{4};
constexpr int oldest_s = 9;    // with the last second of a frame
constexpr int sbas_issue = 1;  // of both masks: they stay what they are
constexpr std::size_t most_corrected_in_view = 20, per_message = 4, per_half = 2;
constexpr int first_prn = 100;  // of S00

// A quarter of the way in from each corner, and at the run's place where it is within: else in the middle.
std::vector<Geodetic> monitor_sites(const SbasServiceArea& area, const Geodetic& place) {
    const double height = area.north - area.south, width = area.east - area.west;
    std::vector<Geodetic> sites;
    for (const double up : {0.25, 0.75})
        for (const double right : {0.25, 0.75})
            sites.push_back(Geodetic::degrees(area.south + up * height, area.west + right * width, 0));
    sites.push_back(area.holds(place) ? place : Geodetic::degrees(area.south + height / 2, area.west + width / 2, 0));
    return sites;
}

std::vector<SatelliteId> corrected_satellites(const NavigationSource& navigation) {
    std::vector<SatelliteId> list;
    for (const SatelliteId id : navigation.satellites())
        if (id.constellation == Constellation::gps && sbas_mask_slot(id)) list.push_back(id);
    return list;
}

int floor_to(int value, int step) { return static_cast<int>(std::floor(static_cast<double>(value) / step)) * step; }

// What messages 7 and 10 tell of ageing; ours, for errors that last for hours and corrections that come every minute.
SbasDegradation degradation() {
    SbasDegradation m;
    m.b_rrc_m = 0.15;
    m.c_ltc_lsb_m = 0.15;
    m.c_ltc_v1_mps = 0.001;
    m.i_ltc_v1_s = 120;
    m.c_ltc_v0_m = 0.15;
    m.i_ltc_v0_s = 120;
    m.c_geo_lsb_m = 0.05;
    m.c_geo_v_mps = 0.0005;
    m.i_geo_s = 120;
    m.c_er_m = 7.5;
    m.c_iono_step_m = 0.1;
    m.i_iono_s = 300;
    m.c_iono_ramp_mps = 0.0005;
    return m;
}

}  // namespace

SbasSystemService::SbasSystemService(SbasSystem system, const World& world, IonosphereMonitor& ionosphere)
    : system_(system),
      navigation_(world.satellites.navigation),
      ionosphere_(ionosphere),
      corrected_(corrected_satellites(*navigation_)),
      bands_(bands_of(sbas_service_area(system))),
      monitor_(world.satellites, monitor_sites(sbas_service_area(system), world.place)) {}

// All points of squares that the area touches.
std::vector<SbasSystemService::Band> SbasSystemService::bands_of(const SbasServiceArea& area) {
    constexpr int caps = 9, step = 10;
    const int south = floor_to(area.south, 5), north = std::min(-floor_to(-area.north, 5), 55);
    const int top = area.north > 55 ? (area.north > 65 ? 75 : 65) : north;
    const int west = floor_to(area.west, step), east = -floor_to(-area.east, step);
    std::vector<Band> bands;
    for (int number = 0; number < caps; ++number) {
        Band band{number, {}, {}};
        const std::vector<SbasGridPoint>& all = sbas_band(number);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const SbasGridPoint& p = all[i];
            if (p.latitude < south || p.latitude > top || p.longitude < west || p.longitude > east) continue;
            band.points.push_back(static_cast<int>(i) + 1);
            band.places.push_back(p);
        }
        if (!band.points.empty()) bands.push_back(std::move(band));
    }
    return bands;
}

SbasTraffic SbasSystemService::traffic(int prn) const {
    constexpr std::size_t in_mixed = 6;
    constexpr int apart = 11;
    SbasTraffic t;
    const std::size_t satellites = std::max<std::size_t>(corrected_.size(), 1);
    t.fast_blocks = static_cast<int>((satellites + sbas_block - 1) / sbas_block);
    t.mixed_last = (satellites - 1) % sbas_block < in_mixed;
    for (const Band& band : bands_)
        t.grid_blocks.push_back(
            static_cast<int>((band.points.size() + SbasIonosphere::size - 1) / SbasIonosphere::size));
    t.long_term_messages = most_corrected_in_view / per_message;
    t.under_test = sbas_under_test(prn);
    t.first_slot = prn * apart;
    return t;
}

SbasFastCorrection SbasSystemService::fast_of(std::size_t index, GpsTime time) {
    if (index >= corrected_.size()) return {};
    const auto& seen = monitor_.at(time);
    const auto found = seen.find(corrected_[index]);
    if (found == seen.end()) return {};
    return {found->second.range_m, found->second.udrei};
}

// What messages 2 to 5 and 24 both begin with.
template <class Message>
void SbasSystemService::put_fast(Message& m, const SbasSlot& slot, GpsTime time) {
    m.block = slot.block;
    m.iodf = slot.iodf;
    m.iodp = sbas_issue;
    for (std::size_t i = 0; i < m.satellites.size(); ++i)
        m.satellites[i] = fast_of(static_cast<std::size_t>(slot.block) * sbas_block + i, time);
}

SbasFastCorrections SbasSystemService::fast_block(const SbasSlot& slot, GpsTime time) {
    SbasFastCorrections m;
    put_fast(m, slot, time);
    return m;
}

SbasMixedCorrections SbasSystemService::mixed(const SbasSlot& slot, GpsTime time) {
    SbasMixedCorrections m;
    put_fast(m, slot, time);
    m.long_term = long_term(static_cast<std::size_t>(slot.turn) * per_half, time, true);
    return m;
}

SbasIntegrity SbasSystemService::integrity(GpsTime start, GpsTime time) {
    SbasIntegrity m;
    for (std::size_t block = 0; block < m.iodf.size(); ++block)
        if (block * sbas_block < corrected_.size()) m.iodf[block] = SbasSchedule::iodf(start);
    for (std::size_t i = 0; i < m.udrei.size(); ++i)
        m.udrei[i] = fast_of(i, time).udrei;
    return m;
}

// Of the satellites in view, from the `first` on. @param around begins again behind the last one
SbasLongTermHalf SbasSystemService::long_term(std::size_t first, GpsTime time, bool around) {
    std::vector<std::pair<int, MonitoredSatellite>> seen;
    for (std::size_t i = 0; i < corrected_.size(); ++i) {
        const auto& monitored = monitor_.at(time);
        if (const auto found = monitored.find(corrected_[i]); found != monitored.end())
            seen.emplace_back(static_cast<int>(i) + 1, found->second);
    }
    SbasLongTermHalf half;
    half.iodp = sbas_issue;
    for (std::size_t i = 0; i < per_half; ++i) {
        const std::size_t index = around && !seen.empty() ? (first + i) % seen.size() : first + i;
        if (index >= seen.size()) continue;
        const auto& [number, satellite] = seen[index];
        SbasLongTermCorrection& c = half.satellites[i];
        c.number = number;
        c.iode = satellite.iode & 0xFF;
        for (int axis = 0; axis < 3; ++axis)
            c.position_m[static_cast<std::size_t>(axis)] = satellite.orbit_m[axis];
        c.clock_s = satellite.clock_s;
    }
    return half;
}

SbasIonosphere SbasSystemService::grid(const SbasSlot& slot, GpsTime time) {
    const Band& band = bands_[static_cast<std::size_t>(slot.band)];
    SbasIonosphere m;
    m.band = band.number;
    m.block = slot.block;
    m.iodi = sbas_issue;
    const std::size_t first = static_cast<std::size_t>(slot.block) * SbasIonosphere::size;
    for (std::size_t i = 0; i < m.points.size() && first + i < band.places.size(); ++i) {
        const IonosphereMonitor::Delay delay = ionosphere_.at(band.places[first + i], time);
        m.points[i].vertical_m = delay.vertical.value();
        m.points[i].givei = sbas_give_index(sbas_bound_factor * delay.deviation.value());
    }
    return m;
}

SbasAlmanacs SbasSystemService::almanacs(GpsTime time) const {
    constexpr int provider_shift = 4;
    SbasAlmanacs m;
    m.time_of_day_s = to_seconds(time.time_since_epoch() % std::chrono::days(1)).value();
    std::size_t count = 0;
    for (const SatelliteId id : navigation_->satellites()) {
        const int prn = id.number + first_prn;
        if (id.constellation != Constellation::sbas || sbas_system(prn) != system_ || count == m.satellites.size())
            continue;
        const auto record = navigation_->ephemeris(id, time);
        if (!record) continue;
        const Eigen::Vector3d position = satellite_state(*record, time).position.vector();
        m.satellites[count++] = {
            0, prn, static_cast<int>(system_) << provider_shift, {position.x(), position.y(), position.z()}, {}};
    }
    return m;
}

SbasServiceRegions SbasSystemService::regions() const {
    constexpr int useless_outside = 15;  // 100 times the bound
    const SbasServiceArea area = sbas_service_area(system_);
    SbasServiceRegions m;
    m.region_count = 1;
    m.udre_outside = useless_outside;
    m.regions[0] = {area.south, area.west, area.north, area.east, true};
    return m;
}

SbasMessage SbasSystemService::made(const SbasSlot& slot, const SbasEphemeris& own, GpsTime time) {
    switch (slot.type) {
        case 0:
            return SbasDoNotUse{fast_block(slot, time)};
        case 1: {
            SbasPrnMask m;
            m.iodp = sbas_issue;
            for (const SatelliteId id : corrected_)
                m.slots.push_back(*sbas_mask_slot(id));
            return m;
        }
        case 7: {
            SbasFastDegradation m;
            m.latency_s = oldest_s;
            m.iodp = sbas_issue;
            return m;
        }
        case 9:
            return sbas_navigation(own);
        case 10:
            return degradation();
        case 17:
            return almanacs(time);
        case 18: {
            const Band& band = bands_[static_cast<std::size_t>(slot.band)];
            return SbasGridMask{static_cast<int>(bands_.size()), band.number, sbas_issue, band.points};
        }
        case 25: {
            const std::size_t first = static_cast<std::size_t>(slot.block) * per_message;
            return SbasLongTermCorrections{{long_term(first, time, false), long_term(first + per_half, time, false)}};
        }
        case 26:
            return grid(slot, time);
        case 27:
            return regions();
        default:
            return SbasNull{};
    }
}

SbasMessage SbasSystemService::message(int prn, const SbasEphemeris& own, GpsTime start) {
    auto known = schedules_.find(prn);
    if (known == schedules_.end()) known = schedules_.emplace(prn, SbasSchedule(traffic(prn))).first;
    const SbasSlot slot = known->second.at(start);
    const GpsTime time(start.time_since_epoch() / generation_period * generation_period - generation_lag);
    if (slot.type == 6) return integrity(start, time);
    if (slot.type == 24) return mixed(slot, time);
    if (slot.type >= 2 && slot.type <= 5) return fast_block(slot, time);
    return made(slot, own, time);
}

}  // namespace skyloop::inline world
