#include "firmware/core/told_heading.hpp"

#include <cmath>
#include <utility>

namespace skyloop::firmware {

std::optional<ToldHeading> told_heading(const NavigationState& state, HeadingSource otherwise) {
    const auto& relative = state.epoch.relative;
    if (relative && relative->base_moves)
        return ToldHeading{Angle::radians(std::atan2(relative->east_m, relative->north_m)), HeadingSource::antennas};
    const bool by_course = otherwise == HeadingSource::course && state.fix_ok;
    const bool by_compass = otherwise == HeadingSource::attitude;
    const std::optional<Angle> other = by_course    ? state.course
                                       : by_compass ? state.epoch.compass_heading
                                                    : std::nullopt;
    return other ? std::optional(ToldHeading{*other, otherwise}) : std::nullopt;
}

std::optional<double> TurnRate::follow(const std::optional<ToldHeading>& told, GpsTime time) {
    constexpr double longest_s = 2, minute_s = 60;
    const auto before = std::exchange(last_, told);
    const double passed = difference(time, std::exchange(when_, time)).value();
    if (!told || !before || told->from != before->from || passed <= 0 || passed > longest_s) return std::nullopt;
    const double turned = std::remainder((told->heading - before->heading).deg(), 360.0);
    return turned / passed * minute_s;
}

}  // namespace skyloop::firmware
