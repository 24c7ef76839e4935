#include "detail/correction_damage.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "base/geo/geodetic.hpp"
#include "detail/fault_catalogue.hpp"
#include "detail/terrestrial_frame.hpp"
#include "firmware/core/reference_data.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"
#include "world/propagation/smooth_noise.hpp"

namespace skyloop::inline run {
namespace {

constexpr double place_unit_m = 1e-4;
// Echoes of a standing antenna change as satellites move: within minutes.
constexpr double multipath_cell_s = 60;
constexpr int glonass_biases = 1230;

using Coordinates = std::array<std::int64_t, 3>;

Position<Ecef> place_of(const Coordinates& told) {
    const auto at = [&](std::size_t axis) { return place_unit_m * static_cast<double>(told[axis]); };
    return {at(0), at(1), at(2)};
}

Coordinates coordinates_of(const Position<Ecef>& place) {
    Coordinates told;
    for (std::size_t axis = 0; axis < told.size(); ++axis)
        told[axis] = std::llround(place.vector()[static_cast<Eigen::Index>(axis)] / place_unit_m);
    return told;
}

// 1005 and 1006: all but the coordinates stays.
Bytes with_coordinates(ByteSpan payload, const Coordinates& told) {
    constexpr int before = 34, between = 2, width = 38;
    BitReader in(payload);
    BitWriter out;
    const auto copy = [&](int bits) { out.put(in.get(bits), bits); };
    copy(before);
    for (std::size_t axis = 0; axis < told.size(); ++axis) {
        in.skip(width);
        out.put_signed(told[axis], width);
        if (axis + 1 < told.size()) copy(between);
    }
    copy(static_cast<int>(8 * payload.size() - out.size()));
    return encode_rtcm3(out.bytes());
}

// Of observations that can be used; leap seconds shift the time of GLONASS by a few seconds at most, all alike.
std::optional<GpsTime> epoch_of(const Rtcm3Message& message, GpsTime now) {
    constexpr int leap_seconds = 18;
    if (const auto msm = decode_msm(message)) return firmware::told_time(msm->number, msm->epoch, now, leap_seconds);
    if (const auto old = decode_legacy(message); old && is_extended_legacy(old->number))
        return firmware::told_time(old->number, old->epoch, now, leap_seconds);
    return std::nullopt;
}

}  // namespace

CorrectionDamage::CorrectionDamage(std::uint64_t seed, const std::string& stream)
    : losses_(seed, stream + ".corrections"), seed_(seed), stream_(stream) {}

void CorrectionDamage::set(const CorrectionConditions& conditions) {
    if (conditions.least_period.value() <= 0) passed_.reset();
    if (!conditions.frozen) {
        cut_.reset();
        kept_.reset();
        kept_messages_.clear();
    }
    active_ = conditions != CorrectionConditions{};
    conditions_ = conditions;
}

Bytes CorrectionDamage::change(Bytes frame, GpsTime now) {
    if (conditions_.loss > 0 && losses_.uniform() < conditions_.loss) return {};
    const auto message = parse_rtcm3(frame);
    if (!message) return frame;
    if (message->number == glonass_biases && conditions_.without_glonass_biases) return {};
    const auto epoch = epoch_of(*message, now);
    if (!epoch) return with_place_changed(*message, std::move(frame), now);
    if (!is_due(*epoch)) return {};
    if (conditions_.frozen) frame = frozen(std::move(frame), message->number, *epoch);
    const auto observed = parse_rtcm3(frame);
    return observed ? with_multipath(*observed, std::move(frame), now) : frame;
}

// All messages of an epoch pass, or none does.
bool CorrectionDamage::is_due(GpsTime epoch) {
    constexpr Seconds clock_error{1e-3};
    const bool soon =
        passed_ && epoch > *passed_ && difference(epoch, *passed_) < conditions_.least_period - clock_error;
    if (!soon) passed_ = epoch;
    return !soon;
}

// Of the epoch that was under way only a part may be left.
Bytes CorrectionDamage::frozen(Bytes frame, int number, GpsTime epoch) {
    if (!cut_) cut_ = epoch;
    if (epoch == *cut_) return frame;
    if (!kept_) kept_ = epoch;
    if (epoch == *kept_) kept_messages_[number] = frame;
    const auto kept = kept_messages_.find(number);
    return kept == kept_messages_.end() ? Bytes{} : kept->second;
}

Position<Ecef> CorrectionDamage::told(const Position<Ecef>& place, GpsTime now) const {
    Position<Ecef> told = place;
    if (conditions_.told_in) told = conditions_.told_in->told(told, now);
    PlaceOffset sum;
    for (const PlaceOffset& offset : conditions_.displaced) {
        sum.east_m += offset.east_m;
        sum.north_m += offset.north_m;
        sum.up_m += offset.up_m;
    }
    return sum == PlaceOffset{} ? told : to_ecef(displaced(to_geodetic(told), sum.east_m, sum.north_m, sum.up_m));
}

Bytes CorrectionDamage::with_place_changed(const Rtcm3Message& message, Bytes frame, GpsTime now) const {
    if (conditions_.displaced.empty() && !conditions_.told_in) return frame;
    if (const auto station = decode_station(message))
        return with_coordinates(message.payload, coordinates_of(told(place_of(station->position), now)));
    auto moving = decode_moving_station(message);
    if (!moving) return frame;
    moving->position = coordinates_of(told(place_of(moving->position), now));
    return encode(*moving);
}

double CorrectionDamage::multipath(std::string_view of, int number, int satellite, GpsTime now) const {
    const std::uint64_t key = noise_key(seed_, fmt::format("{}.{}.{}.{}", stream_, of, number, satellite));
    return smooth_noise<1>(key, {difference(now, GpsTime{}).value() / multipath_cell_s});
}

Bytes CorrectionDamage::with_multipath(const Rtcm3Message& message, Bytes frame, GpsTime now) const {
    const double code_m = conditions_.code_multipath.value(), phase_m = conditions_.phase_multipath.value();
    if (code_m <= 0 && phase_m <= 0) return frame;
    const auto spoil = [&](double& range, std::optional<double>& phase, int satellite, int signal) {
        range += code_m * multipath(fmt::format("code{}", signal), message.number, satellite, now);
        if (phase) *phase += phase_m * multipath(fmt::format("phase{}", signal), message.number, satellite, now);
    };
    if (auto msm = decode_msm(message)) {
        for (Rtcm3MsmCell& cell : msm->cells)
            spoil(cell.range_m, cell.phase_range_m, cell.satellite, cell.signal);
        return encode(*msm);
    }
    auto old = decode_legacy(message);
    if (!old) return frame;
    for (Rtcm3LegacySatellite& s : old->satellites) {
        if (s.l1.range_m) spoil(*s.l1.range_m, s.l1.phase_range_m, s.satellite, 1);
        if (s.l2 && s.l2->range_m) spoil(*s.l2->range_m, s.l2->phase_range_m, s.satellite, 2);
    }
    return encode(*old);
}

}  // namespace skyloop::inline run
