// The places of PX4's local position: metres from a reference on the Earth.
#pragma once

#include <Eigen/Core>

#include "flight_log.hpp"
#include "receiver/observed/ulog.hpp"

namespace skyloop::inline motion {

// Reads the records of vehicle_local_position or its groundtruth. Resets of the filter are no motion: what came before
// one is moved by what it changed, so that the end of the log stays where it was told.
class UlogLocalPlaces {
public:
    // @param is_truth a simulator's own, whose flags of validity are not always set
    UlogLocalPlaces(const UlogStream& stream, bool is_truth) : stream_(stream), is_truth_(is_truth) {}
    // Metres from a place that the log does not tell, as on a table or indoors, laid out from an origin; heights are
    // above the ellipsoid. Taken as they stand, whether the autopilot trusts them or not.
    UlogLocalPlaces(const UlogStream& stream, const Geodetic& origin)
        : stream_(stream), is_truth_(false), origin_(origin) {}
    std::vector<FlightRow> read();
    [[nodiscard]] std::size_t resets() const { return resets_; }
    // Records that the autopilot itself does not trust.
    [[nodiscard]] std::size_t untrusted() const { return untrusted_; }
    [[nodiscard]] double farthest_reset_m() const { return farthest_m_; }

private:
    [[nodiscard]] bool flag(const UlogRecord& record, std::string_view name) const {
        return is_truth_ || record.value(name).value_or(0) != 0;
    }
    void undo_resets(const UlogRecord& record);
    std::optional<FlightRow> row_of(const UlogRecord& record);
    [[nodiscard]] bool is_trusted(const UlogRecord& record) const {
        return flag(record, "xy_valid") && flag(record, "z_valid") && flag(record, "xy_global") &&
               flag(record, "z_global");
    }

    const UlogStream& stream_;
    bool is_truth_;
    std::optional<Geodetic> origin_{};
    std::optional<ByteSpan> after_;  // the record behind, of those that are used
    std::vector<FlightRow> rows_;    // last one first
    Eigen::Vector3d moved_ = Eigen::Vector3d::Zero();
    std::size_t resets_ = 0, untrusted_ = 0;
    double farthest_m_ = 0;
};

}  // namespace skyloop::inline motion
