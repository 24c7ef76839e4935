/// Frames of reference of national services, in which places of base stations may be told.
#pragma once

#include <memory>
#include <string_view>

#include "base/core/result.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"

struct pj_ctx;
struct PJconsts;

namespace skyloop::inline run {

inline constexpr std::string_view terrestrial_frame_names[] = {"etrf2000", "nad83-2011", "gda94", "gda2020"};

/// Coordinates by another frame than ITRF2014, by which orbits are broadcast to centimetres (WGS 84). Of one thread.
class TerrestrialFrame {
public:
    /// Fails with `usage` for a name that is none of terrestrial_frame_names, with `outside` where PROJ lacks its
    /// database.
    static Result<std::shared_ptr<const TerrestrialFrame>> find(std::string_view name);

    /// What a point of ITRF2014 is told as. @param time of the coordinates, since plates move
    [[nodiscard]] Position<Ecef> told(const Position<Ecef>& itrf, GpsTime time) const;

private:
    std::shared_ptr<pj_ctx> context_;
    std::shared_ptr<PJconsts> operation_;
};

}  // namespace skyloop::inline run
