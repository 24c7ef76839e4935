/// The vector between the antennas of a pair that rides on one vehicle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/core/random.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/trace.hpp"

namespace skyloop::inline run {

/// How well a rover that measures nothing knows its vector to the base.
struct BaselineAccuracy {
    GaussMarkovParameters fixed{0.005, Seconds(30)};   ///< of each axis, m
    GaussMarkovParameters floating{0.3, Seconds(30)};  ///< of each axis, m, as long as the ambiguities are not whole
    double per_length = 1e-6;                          ///< more for each metre between the antennas
    Seconds time_to_fix{5};                            ///< both have had a fix, until the ambiguities are whole
    Seconds held_without_base{10};                     ///< ambiguities, after the base's last epoch (RECEIVER.md 4.12)
};

/// Makes the vector of a pair that measures nothing, from the truth and an error: the true vector plus three
/// first-order Gauss-Markov processes. Their numbers: ZED-F9P data sheet, RTK 1 cm + 1 ppm CEP, heading 0.4° at 1 m,
/// which 5 mm each axis give.
///
/// State: the errors, the base's last epoch, and since when both receivers have had a fix. All numbers are of streams
/// of their own.
class MovingBase {
public:
    explicit MovingBase(std::uint64_t seed, const BaselineAccuracy& accuracy = {});

    /// The vector at one instant; instants come in ascending order. Nothing while one of the two has
    /// no fix of its own.
    /// @param base,rover of the same instant
    std::optional<RelativePosition> relate(const Trace& base, const Trace& rover);
    /// An instant at which the base has no epoch, as one that is slower than its rover: the ambiguities of its last one
    /// are held for a while, unless the rover has no fix of its own.
    void hold(const Trace& rover);
    /// The rover's fix that its ambiguities make, rtk_float or rtk_fixed; nothing while there are none.
    [[nodiscard]] std::optional<FixType> fix_type() const;

private:
    void lose();

    BaselineAccuracy accuracy_;
    std::array<GaussMarkov, 3> fixed_, floating_;  // north, east, down
    std::optional<GpsTime> last_, both_since_;     // the base's last epoch; the first of those that both had a fix at
};

}  // namespace skyloop::inline run
