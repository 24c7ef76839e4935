#include "receiver/pvt/sbas_data.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace skyloop::inline receiver {
namespace {

constexpr Seconds mask_lasts{600}, grid_mask_lasts{1200}, bound_lasts{18}, long_term_lasts{360}, grid_lasts{600};
constexpr Seconds bar_lasts{60};
constexpr int any_issue = 3;  // of a bound, whatever its correction

bool is_fresh(GpsTime then, GpsTime now, Seconds lasts) { return difference(now, then) <= lasts; }

// Of a number in a mask, whose numbers ascend.
std::optional<std::size_t> place_in(const std::vector<int>& mask, int number) {
    const auto found = std::ranges::lower_bound(mask, number);
    if (found == mask.end() || *found != number) return std::nullopt;
    return static_cast<std::size_t>(found - mask.begin());
}

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace

void SbasData::hear(const Subframe& subframe, bool test_mode) {
    const auto message = decode_sbas(subframe.words);
    if (!message) return;
    const GpsTime time = subframe.end - std::chrono::seconds(1);
    const auto* bar = std::get_if<SbasDoNotUse>(&*message);
    if (bar == nullptr) {
        take(*message, time);
    } else if (bar->test && test_mode) {
        take(*bar->test, time);
    } else {
        *this = SbasData();
        barred_ = time;
    }
}

void SbasData::take(const SbasMessage& message, GpsTime time) {
    const auto fast = [&](const auto& m) {
        for (std::size_t i = 0; i < m.satellites.size(); ++i)
            take_fast(static_cast<std::size_t>(m.block) * sbas_block + i,
                      {m.satellites[i], m.iodf, m.iodp, time, time});
    };
    std::visit(Overloaded{[&](const SbasPrnMask& m) {
                              mask_ = {m, time};
                          },
                          [&](const SbasFastCorrections& m) { fast(m); },
                          [&](const SbasIntegrity& m) { take_integrity(m, time); },
                          [&](const SbasFastDegradation& m) {
                              ageing_ = {m, time};
                          },
                          [&](const SbasGridMask& m) {
                              grid_masks_[m.band] = {m, time};
                          },
                          [&](const SbasMixedCorrections& m) {
                              fast(m);
                              take_long_term(m.long_term, time);
                          },
                          [&](const SbasLongTermCorrections& m) {
                              for (const SbasLongTermHalf& half : m.halves)
                                  take_long_term(half, time);
                          },
                          [&](const SbasIonosphere& m) {
                              grid_[{m.band, m.block}] = {m, time};
                          },
                          [](const auto&) {}},
               message);
}

void SbasData::take_integrity(const SbasIntegrity& message, GpsTime time) {
    for (auto& [index, fast] : fast_) {
        const int iodf = message.iodf[std::min(index / sbas_block, message.iodf.size() - 1)];
        if (index >= message.udrei.size() || (iodf != any_issue && iodf != fast.iodf)) continue;
        fast.correction.udrei = message.udrei[index];
        fast.bounded = time;
    }
}

void SbasData::take_long_term(const SbasLongTermHalf& half, GpsTime time) {
    for (const SbasLongTermCorrection& c : half.satellites)
        if (c.number > 0) long_term_[static_cast<std::size_t>(c.number - 1)] = {{c, half.iodp}, time};
}

std::optional<std::size_t> SbasData::index_of(SatelliteId satellite, GpsTime time) const {
    const std::optional<int> slot = sbas_mask_slot(satellite);
    if (!slot || !mask_ || !is_fresh(mask_->time, time, mask_lasts)) return std::nullopt;
    return place_in(mask_->message.slots, *slot);
}

std::optional<SbasCorrection> SbasData::correction(SatelliteId satellite, GpsTime time) const {
    if (barred_ && is_fresh(*barred_, time, bar_lasts)) return std::nullopt;
    const auto index = index_of(satellite, time);
    if (!index) return std::nullopt;
    const auto fast = fast_.find(*index);
    const auto slow = long_term_.find(*index);
    if (fast == fast_.end() || slow == long_term_.end()) return std::nullopt;
    const Fast& f = fast->second;
    const auto& [c, iodp] = slow->second.message;
    const int issue = mask_->message.iodp;
    if (f.iodp != issue || iodp != issue || f.correction.udrei >= udrei_not_monitored) return std::nullopt;
    const bool told = ageing_ && ageing_->message.iodp == issue && *index < ageing_->message.indicators.size();
    const Seconds lasts = sbas_fast_timeout(told ? ageing_->message.indicators[*index] : 0);
    if (!is_fresh(f.time, time, lasts) || !is_fresh(f.bounded, time, bound_lasts) ||
        !is_fresh(slow->second.time, time, long_term_lasts))
        return std::nullopt;
    SbasCorrection result{c.iode,
                          {c.position_m[0], c.position_m[1], c.position_m[2]},
                          c.clock_s,
                          Metres(f.correction.range_m),
                          f.correction.udrei};
    if (c.time_of_day_s == 0) return result;
    // Of the day: t_0 is at most half of one away.
    const double of_day = std::chrono::duration<double>(time.time_since_epoch() % std::chrono::days(1)).count();
    const double since = std::remainder(of_day - c.time_of_day_s, 86400.0);
    result.orbit_m += since * Eigen::Vector3d(c.velocity_mps[0], c.velocity_mps[1], c.velocity_mps[2]);
    result.clock_s += since * c.clock_drift;
    return result;
}

std::optional<double> SbasData::delay(const SbasGridPoint& point, GpsTime time) const {
    const SbasMaskPlace place = sbas_mask_place(point);
    const auto mask = grid_masks_.find(place.band);
    if (mask == grid_masks_.end() || !is_fresh(mask->second.time, time, grid_mask_lasts)) return std::nullopt;
    const std::optional<std::size_t> index = place_in(mask->second.message.points, place.number);
    if (!index) return std::nullopt;
    const auto block = grid_.find({place.band, static_cast<int>(*index / SbasIonosphere::size)});
    if (block == grid_.end() || block->second.message.iodi != mask->second.message.iodi) return std::nullopt;
    const SbasGridDelay& told = block->second.message.points[*index % SbasIonosphere::size];
    const bool usable = is_fresh(block->second.time, time, grid_lasts) && told.givei != givei_not_monitored;
    return usable ? told.vertical_m : std::nullopt;
}

std::optional<Metres> SbasData::ionosphere(const Geodetic& place, const SkyDirection& direction, GpsTime time) const {
    const Geodetic ground{place.latitude, place.longitude, {}};
    const auto cell = sbas_cell(pierce_point(sbas_shell, ground, direction));
    if (!cell) return std::nullopt;
    std::array<std::optional<double>, 4> corners;
    std::ranges::transform(cell->corners(), corners.begin(), [&](const auto& p) { return delay(p, time); });
    const double x = cell->east, y = cell->north;
    // Without one corner, the plane through the others on their side of it (A.4.4.10.3).
    const auto is_missing = [](const auto& corner) { return !corner; };
    const auto missing = std::ranges::count_if(corners, is_missing);
    if (missing > 1) return std::nullopt;
    if (missing == 1) {
        const auto gap = static_cast<std::size_t>(std::ranges::find_if(corners, is_missing) - corners.begin());
        const double towards_gap = (gap == 0 || gap == 3 ? x : 1 - x) + (gap <= 1 ? y : 1 - y);
        if (towards_gap > 1) return std::nullopt;
        corners[gap] = *corners[(gap + 1) % 4] + *corners[(gap + 3) % 4] - *corners[(gap + 2) % 4];
    }
    const std::array<double, 4> weights{x * y, (1 - x) * y, (1 - x) * (1 - y), x * (1 - y)};
    double vertical = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        vertical += weights[i] * *corners[i];
    return Metres(vertical * single_layer_mapping(sbas_shell, direction.elevation));
}

}  // namespace skyloop::inline receiver
