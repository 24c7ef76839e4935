/// Parts of a run with surroundings of their own: by way, by time, or by place.
#pragma once

#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "world/propagation/channel_parameters.hpp"

namespace skyloop::inline world {

/// Metres travelled since the run began.
struct StretchOfWay {
    Metres from{0}, to{std::numeric_limits<double>::infinity()};
};

/// Seconds since the run began.
struct StretchOfTime {
    Seconds from{0}, to{std::numeric_limits<double>::infinity()};
};

/// A polygon on the Earth, smaller than a country; heights do not matter.
class EarthPolygon {
public:
    using Ring = std::vector<Geodetic>;  ///< corners; the last is joined to the first
    explicit EarthPolygon(Ring outer, std::vector<Ring> holes = {});
    [[nodiscard]] const Ring& outer() const { return outer_; }
    [[nodiscard]] const std::vector<Ring>& holes() const { return holes_; }
    /// Whether a place may be inside, by the box around the polygon.
    [[nodiscard]] bool may_hold(const Geodetic& place) const;

private:
    Ring outer_;
    std::vector<Ring> holes_;
    Angle south_, north_, east_, west_;  ///< longitudes from the first corner's
};

/// Inside one of some polygons.
struct StretchOfPlace {
    std::vector<EarthPolygon> polygons;
};

/// Where its surroundings hold. They come over a ramp behind its beginning and go over one before its end.
struct SurroundingsStretch {
    ChannelParameters channel;
    std::variant<StretchOfWay, StretchOfTime, StretchOfPlace> extent;
    double ramp = 0;  ///< m, of a StretchOfTime s
};

/// An antenna on its way.
struct Whereabouts {
    Geodetic place;
    std::optional<Angle> heading{};  ///< azimuth of the motion; nothing: none yet
    MetresPerSecond speed;
    Metres travelled;
    Seconds elapsed{0};
};

/// How far an antenna is into a stretch.
struct StretchPlace {
    double weight = 0;           ///< of its surroundings, 0 … 1 over the ramps
    bool inside = false;         ///< ends included
    double since = 0, left = 0;  ///< way from its beginning and to its end, straight on, m
};
StretchPlace place_in(const SurroundingsStretch& stretch, const Whereabouts& antenna);

/// Fails (`input`) when the outer ring has fewer than three corners, has no area, or crosses itself: "has …; expected
/// …".
Result<void> check_polygon(const EarthPolygon& polygon);

}  // namespace skyloop::inline world
