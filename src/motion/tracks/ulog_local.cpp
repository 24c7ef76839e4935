#include "detail/ulog_local.hpp"

#include <cmath>
#include <utility>

#include "detail/flight_log.hpp"

namespace skyloop::inline motion {
namespace {

bool differs(const UlogRecord& a, const UlogRecord& b, std::string_view field) {
    const std::optional<double> one = a.value(field), other = b.value(field);
    const bool both_unknown = one && other && std::isnan(*one) && std::isnan(*other);
    return one != other && !both_unknown;
}

}  // namespace

std::vector<FlightRow> UlogLocalPlaces::read() {
    for (auto bytes = stream_.records.rbegin(); bytes != stream_.records.rend(); ++bytes) {
        const UlogRecord record(stream_.fields, *bytes);
        if (!origin_ && !is_trusted(record)) continue;
        undo_resets(record);
        if (const auto row = row_of(record)) {
            untrusted_ += !flag(record, "xy_valid") || !flag(record, "z_valid");
            rows_.push_back(*row);
            after_ = *bytes;
        }
    }
    std::reverse(rows_.begin(), rows_.end());
    return std::move(rows_);
}

// Where the reference itself is another one, or the step is beyond any drift, the path begins anew behind. Metres from
// an origin that the user tells have no reference in the log: EKF2 publishes NaN, older versions left zeros.
void UlogLocalPlaces::undo_resets(const UlogRecord& record) {
    if (!after_) return;
    constexpr double longest_m = 10'000;
    const UlogRecord after(stream_.fields, *after_);
    const auto delta = [&](std::string_view name) { return after.value(name).value_or(std::nan("")); };
    Eigen::Vector3d change = Eigen::Vector3d::Zero();
    if (differs(record, after, "xy_reset_counter")) change = {delta("delta_xy[0]"), delta("delta_xy[1]"), 0};
    if (differs(record, after, "z_reset_counter")) change.z() = delta("delta_z");
    const bool new_reference = !origin_ && (differs(record, after, "ref_lat") || differs(record, after, "ref_lon") ||
                                            differs(record, after, "ref_alt"));
    if (new_reference || !(change.norm() <= longest_m)) {
        rows_.back().jump = true;
        moved_.setZero();
    } else if (change.norm() > 0) {
        moved_ += change;
        ++resets_;
        farthest_m_ = std::max(farthest_m_, change.norm());
    }
}

std::optional<FlightRow> UlogLocalPlaces::row_of(const UlogRecord& record) {
    const auto number = [&](std::string_view name) { return record.value(name).value_or(std::nan("")); };
    const auto ns = flight_clock_ns(record.value("timestamp"));
    const double latitude = origin_ ? origin_->latitude.deg() : number("ref_lat");
    const double longitude = origin_ ? origin_->longitude.deg() : number("ref_lon");
    const double height = origin_ ? origin_->height.above_ellipsoid.value() : number("ref_alt");
    if (!ns || (!origin_ && latitude == 0 && longitude == 0)) return std::nullopt;
    const Eigen::Vector3d ned = Eigen::Vector3d(number("x"), number("y"), number("z")) + moved_;
    const GlobalSample there = on_px4_map({*ns, latitude, longitude, height}, ned);
    auto row = flight_row(*ns, there.latitude_deg, there.longitude_deg, there.height_m);
    if (row && origin_) row->above_sea = false;
    if (row && flag(record, "v_xy_valid") && flag(record, "v_z_valid"))
        row->velocity_ned = logged_velocity(record.value("vx"), record.value("vy"), record.value("vz"));
    return row;
}

}  // namespace skyloop::inline motion
