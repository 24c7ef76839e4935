#include "run/emulator/moving_base.hpp"

#include <fmt/format.h>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline run {
namespace {

std::array<GaussMarkov, 3> axes(const GaussMarkovParameters& parameters, std::uint64_t seed, std::string_view name) {
    const auto axis = [&](std::string_view letter) {
        return GaussMarkov(parameters, RandomStream(seed, fmt::format("moving_base.{}.{}", name, letter)));
    };
    return {axis("north"), axis("east"), axis("down")};
}

// Dead reckoning has lost the satellites that the vector is measured with.
bool has_own_fix(const Fix& fix) { return fix.has_position() && fix.type != FixType::dead_reckoning; }

}  // namespace

MovingBase::MovingBase(std::uint64_t seed, const BaselineAccuracy& accuracy)
    : accuracy_(accuracy),
      fixed_(axes(accuracy.fixed, seed, "fixed")),
      floating_(axes(accuracy.floating, seed, "float")) {}

// The ambiguities are searched anew.
void MovingBase::lose() { both_since_.reset(); }

void MovingBase::hold(const Trace& rover) {
    const bool old = last_ && difference(rover.truth.time, *last_) > accuracy_.held_without_base;
    if (old || !has_own_fix(rover.epoch.fix)) lose();
}

std::optional<FixType> MovingBase::fix_type() const {
    if (!last_ || !both_since_) return std::nullopt;
    return difference(*last_, *both_since_) >= accuracy_.time_to_fix ? FixType::rtk_fixed : FixType::rtk_float;
}

std::optional<RelativePosition> MovingBase::relate(const Trace& base, const Trace& rover) {
    const GpsTime now = rover.truth.time;
    const Seconds passed = last_ ? difference(now, *last_) : Seconds(0);
    last_ = now;
    for (auto* errors : {&fixed_, &floating_})
        for (GaussMarkov& error : *errors)
            error.advance(passed);
    if (!has_own_fix(base.epoch.fix) || !has_own_fix(rover.epoch.fix)) {
        lose();
        return std::nullopt;
    }
    if (!both_since_) both_since_ = now;

    const Displacement<Enu> truth = LocalFrame(base.truth.geodetic).to_enu(rover.truth.position - base.truth.position);
    RelativePosition relative;
    relative.fixed = fix_type() == FixType::rtk_fixed;
    const GaussMarkovParameters& parameters = relative.fixed ? accuracy_.fixed : accuracy_.floating;
    const auto& errors = relative.fixed ? fixed_ : floating_;
    const double deviation = parameters.sigma + accuracy_.per_length * truth.length().value();
    const double scale = parameters.sigma > 0 ? deviation / parameters.sigma : 0;
    relative.north_m = truth.vector().y() + scale * errors[0].value();
    relative.east_m = truth.vector().x() + scale * errors[1].value();
    relative.down_m = -truth.vector().z() + scale * errors[2].value();
    relative.deviation = relative.down_deviation = Metres(deviation);
    return relative;
}

}  // namespace skyloop::inline run
