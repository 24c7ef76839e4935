#include "detail/terrestrial_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <proj.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace skyloop::inline run {
namespace {

// From ITRF2014, as EPSG's registry has them (epsg.org): with the motion of the plates.
constexpr std::array<const char*, std::size(terrestrial_frame_names)> operation_codes{"8405", "8970", "9682", "8049"};

double decimal_year(GpsTime time) {
    constexpr double first_year = 1980 + 5.0 / 366, year_s = 365.25 * 86400;
    return first_year + difference(time, GpsTime{}).value() / year_s;
}

}  // namespace

Result<std::shared_ptr<const TerrestrialFrame>> TerrestrialFrame::find(std::string_view name) {
    const auto* const found = std::find(std::begin(terrestrial_frame_names), std::end(terrestrial_frame_names), name);
    if (found == std::end(terrestrial_frame_names))
        return fail(ErrorCode::usage, fmt::format("'{}' is no frame; expected one of {}", name,
                                                  fmt::join(terrestrial_frame_names, ", ")));
    const auto at = static_cast<std::size_t>(found - std::begin(terrestrial_frame_names));
    auto frame = std::make_shared<TerrestrialFrame>();
    frame->context_ = {proj_context_create(), proj_context_destroy};
    proj_log_level(frame->context_.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(frame->context_.get(), 0);
    frame->operation_ = {proj_create_from_database(frame->context_.get(), "EPSG", operation_codes.at(at),
                                                   PJ_CATEGORY_COORDINATE_OPERATION, 0, nullptr),
                         proj_destroy};
    if (!frame->operation_)
        return fail(ErrorCode::outside,
                    fmt::format("PROJ {} does not know the way to {} (EPSG:{}): install the package proj-data",
                                proj_info().version, name, operation_codes.at(at)));
    return std::shared_ptr<const TerrestrialFrame>(std::move(frame));
}

Position<Ecef> TerrestrialFrame::told(const Position<Ecef>& itrf, GpsTime time) const {
    const auto& at = itrf.vector();
    const PJ_COORD to = proj_trans(operation_.get(), PJ_FWD, proj_coord(at.x(), at.y(), at.z(), decimal_year(time)));
    return std::isfinite(to.xyz.x) ? Position<Ecef>{to.xyz.x, to.xyz.y, to.xyz.z} : itrf;
}

}  // namespace skyloop::inline run
