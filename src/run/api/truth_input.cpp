#include "detail/truth_input.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <span>
#include <string_view>

#include "motion/trajectory/live_path.hpp"

namespace skyloop {
namespace {

constexpr std::uint32_t positions = SKY_POS_ECEF | SKY_POS_LLA_ELLIPSOID | SKY_POS_LLA_MSL | SKY_POS_LOCAL_NED;
constexpr std::uint32_t known_fields = positions | SKY_VEL | SKY_ACC | SKY_ATT | SKY_RATE | SKY_RESET;
constexpr double quaternion_tolerance = 0.05;  // FEEDS.md 3.1
constexpr double farthest_m = 1e7;             // of local metres: beyond it they are in another unit

struct NamedNumbers {
    std::uint32_t field;
    std::string_view name;
    std::span<const double> numbers;
};

Answer<void> check_numbers(const sky_truth& t) {
    for (const NamedNumbers& one : {NamedNumbers{positions, "pos", t.pos}, NamedNumbers{SKY_VEL, "vel_ned", t.vel_ned},
                                    NamedNumbers{SKY_ACC, "acc_ned", t.acc_ned}, NamedNumbers{SKY_ATT, "q_nb", t.q_nb},
                                    NamedNumbers{SKY_RATE, "rate_frd", t.rate_frd}}) {
        if ((t.fields & one.field) == 0) continue;
        for (std::size_t i = 0; i < one.numbers.size(); ++i)
            if (!std::isfinite(one.numbers[i]))
                return refuse(SKY_E_RANGE,
                              fmt::format("{}[{}] is {}; expected a finite number", one.name, i, one.numbers[i]));
    }
    return {};
}

Answer<void> check_below(const char* name, double size, const char* unit, double limit) {
    if (size < limit) return {};
    return refuse(SKY_E_RANGE, fmt::format("{} is {:g} {}; expected less than {:g}", name, size, unit, limit));
}

Answer<Position<Ecef>> place_of_degrees(const double (&pos)[3], Metres undulation) {
    constexpr double lowest_m = -1e4, highest_m = 1e6;  // FEEDS.md 3.1
    if (!(pos[2] >= lowest_m && pos[2] < highest_m))
        return refuse(SKY_E_RANGE, fmt::format("pos: height is {:g} m; expected -10 000 to 1 000 000", pos[2]));
    const auto place = place_from_degrees(pos[0], pos[1], pos[2] + undulation.value());
    if (!place) return refuse(SKY_E_RANGE, "pos: " + place.error());
    return to_ecef(*place);
}

Answer<Position<Ecef>> position_of(const sky_truth& truth, const TruthFrames& frames) {
    const auto& pos = truth.pos;
    switch (truth.fields & positions) {
        case SKY_POS_ECEF:
            return Position<Ecef>(pos[0], pos[1], pos[2]);
        case SKY_POS_LLA_ELLIPSOID:
            return place_of_degrees(pos, Metres(0));
        case SKY_POS_LLA_MSL: {
            if (frames.geoid == nullptr)
                return refuse(SKY_E_STATE,
                              "SKY_POS_LLA_MSL needs the geoid, which was not found: see the log of sky_create()");
            if (const auto place = place_of_degrees(pos, Metres(0)); !place) return place;
            return place_of_degrees(
                pos, frames.geoid->undulation(Angle::degrees(pos[0]), Angle::degrees(std::remainder(pos[1], 360))));
        }
        default:
            if (!(std::hypot(pos[0], pos[1], pos[2]) < farthest_m))
                return refuse(SKY_E_RANGE, fmt::format("pos is {:g} m from the origin; expected less than {:g} m",
                                                       std::hypot(pos[0], pos[1], pos[2]), farthest_m));
            return frames.local->to_ecef(Position<Enu>(pos[1], pos[0], -pos[2]));
    }
}

Answer<Attitude> attitude_of(const double (&q)[4]) {
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    if (std::abs(turn.norm() - 1) > quaternion_tolerance)
        return refuse(SKY_E_RANGE, fmt::format("q_nb has the length {:g}; expected 1", turn.norm()));
    return Attitude(turn);
}

// Beyond them a path takes its own estimate for what was told.
Answer<void> check_motion(const sky_truth& t) {
    const double acceleration = (t.fields & SKY_ACC) != 0 ? Eigen::Vector3d(t.acc_ned).stableNorm() : 0;
    const double turn_rate = (t.fields & SKY_RATE) != 0 ? Eigen::Vector3d(t.rate_frd).stableNorm() : 0;
    if (auto soft = check_below("acc_ned", acceleration, "m/s²", LivePath::hardest_mps2); !soft) return soft;
    return check_below("rate_frd", turn_rate, "rad/s", LivePath::fastest_turn_radps);
}

}  // namespace

Answer<TruthSample> truth_sample(const sky_truth& truth, const TruthFrames& frames) {
    if ((truth.fields & ~known_fields) != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("fields is {:#x}, of which {:#x} is not known to this version",
                                                     truth.fields, truth.fields & ~known_fields));
    if (truth.reserved != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("reserved is {:#x}; expected 0", truth.reserved));
    if (std::popcount(truth.fields & positions) != 1)
        return refuse(SKY_E_ARG, fmt::format("fields is {:#x}; expected exactly one SKY_POS_…", truth.fields));
    if (const auto finite = check_numbers(truth); !finite) return refuse(finite.error());
    if (const auto usable = check_motion(truth); !usable) return refuse(usable.error());
    const auto position = position_of(truth, frames);
    if (!position) return refuse(position.error());
    TruthSample sample;
    sample.position = *position;
    sample.jump = (truth.fields & SKY_RESET) != 0;
    const LocalFrame own(to_geodetic(*position));
    const LocalFrame& axes = (truth.fields & SKY_POS_LOCAL_NED) != 0 ? *frames.local : own;
    const auto turned = [&](const double(&ned)[3]) { return axes.to_ecef(Velocity<Enu>(ned[1], ned[0], -ned[2])); };
    if ((truth.fields & SKY_VEL) != 0) sample.velocity = turned(truth.vel_ned);
    if ((truth.fields & SKY_ACC) != 0) sample.acceleration = turned(truth.acc_ned).vector();
    if ((truth.fields & SKY_RATE) != 0) sample.turn_rate = Eigen::Vector3d(truth.rate_frd);
    if ((truth.fields & SKY_ATT) == 0) return sample;
    const auto attitude = attitude_of(truth.q_nb);
    if (!attitude) return refuse(attitude.error());
    sample.attitude = *attitude;
    return sample;
}

}  // namespace skyloop
