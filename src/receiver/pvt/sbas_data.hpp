/// What one SBAS satellite has told so far.
#pragma once

#include <Eigen/Core>

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "base/geo/geodetic.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/sbas_grid.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop::inline receiver {

/// What is told of one satellite just now.
struct SbasCorrection {
    int iode = 0;             ///< of the record that orbit and clock are of
    Eigen::Vector3d orbit_m;  ///< to be added to its position, ECEF
    double clock_s = 0;       ///< to be added to its clock
    Metres range;             ///< fast, to be added to the pseudorange
    int udre_index = 0;       ///< 0 … 13
};

/// Corrections by messages 1 to 7, 18, 24, 25 and 26 in whatever order they come: each part counts once the mask is
/// there that its issue names, and until it times out (DO-229, table A-25, en route: masks 600 s and 1200 s, bounds 18
/// s, fast corrections by message 7 or 180 s, slow ones 360 s, the ionosphere 600 s). What ages meanwhile is not
/// degraded, rates of fast corrections are not formed, as indicators of 0 have none (A.4.4.3), and message 27 is not
/// looked at: simplifications of ours. After message 0 nothing counts for a minute (A.4.4.1).
class SbasData {
public:
    /// A message of this satellite. @param test_mode message 0 is taken for what is tested by it
    void hear(const Subframe& subframe, bool test_mode);
    /// Corrections of orbit and clock; nothing without all parts, and for satellites that are not to be used.
    [[nodiscard]] std::optional<SbasCorrection> correction(SatelliteId satellite, GpsTime time) const;
    /// The slant delay at L1; nothing where the grid does not reach. Of four points around, three will do (A.4.4.10).
    [[nodiscard]] std::optional<Metres> ionosphere(const Geodetic& place, const SkyDirection& direction,
                                                   GpsTime time) const;

private:
    template <class Message>
    struct Heard {
        Message message;
        GpsTime time;
    };
    struct Fast {
        SbasFastCorrection correction;
        int iodf = 0, iodp = 0;
        GpsTime time, bounded;
    };
    void take(const SbasMessage& message, GpsTime time);
    void take_fast(std::size_t index, const Fast& fast) { fast_[index] = fast; }
    void take_integrity(const SbasIntegrity& message, GpsTime time);
    void take_long_term(const SbasLongTermHalf& half, GpsTime time);
    [[nodiscard]] std::optional<std::size_t> index_of(SatelliteId satellite, GpsTime time) const;
    [[nodiscard]] std::optional<double> delay(const SbasGridPoint& point, GpsTime time) const;

    std::optional<Heard<SbasPrnMask>> mask_;
    std::optional<Heard<SbasFastDegradation>> ageing_;
    std::map<std::size_t, Fast> fast_;                                                // by place in the mask
    std::map<std::size_t, Heard<std::pair<SbasLongTermCorrection, int>>> long_term_;  // the same; with its IODP
    std::map<int, Heard<SbasGridMask>> grid_masks_;                                   // by band
    std::map<std::pair<int, int>, Heard<SbasIonosphere>> grid_;                       // by band and block
    std::optional<GpsTime> barred_;                                                   // by message 0
};

}  // namespace skyloop::inline receiver
