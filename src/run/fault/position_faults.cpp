// Errors of the solution itself: they are made before the firmware sees the epoch, and so pass through its own logic.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/core/random.hpp"
#include "detail/fault_catalogue.hpp"

namespace skyloop::inline run {
namespace {

// Farther is no error of a solution.
constexpr double farthest_m = 1e6;
constexpr double fastest_error_mps = 1e4;

constexpr double usual_step_m = 50, usual_ramp_mps = 1, usual_velocity_bias_mps = 2;  // north

// Their components have no standards: a north that nobody asked for beside an east that somebody did would be a
// surprise.
constexpr ParameterSpec offset_part(std::string_view name, std::string_view meaning) {
    return number_parameter(name, no_standard, -farthest_m, farthest_m, meaning);
}
constexpr ParameterSpec velocity_part(std::string_view name, std::string_view meaning) {
    return number_parameter(name, no_standard, -fastest_error_mps, fastest_error_mps, meaning);
}
constexpr ParameterList offset_parameters{
    offset_part("east_m", "east of the truth, m; 0 when it is not given"),
    offset_part("north_m", "north, m; 50 when none of the three is given, else 0"),
    offset_part("up_m", "up, m; 0 when it is not given")};
constexpr ParameterList velocity_parameters(std::string_view north_meaning) {
    return {velocity_part("east_mps", "east of the truth, m/s; 0 when it is not given"),
            velocity_part("north_mps", north_meaning), velocity_part("up_mps", "up, m/s; 0 when it is not given")};
}

// An offset east, north, up.
struct Offset {
    double east = 0, north = 0, up = 0;
};

// @param north where no component is given
Offset read_vector(const Parameters& p, const std::string& unit, double north) {
    const auto e = p.optional_number("east_" + unit), n = p.optional_number("north_" + unit),
               u = p.optional_number("up_" + unit);
    if (!e && !n && !u) return {0, north, 0};
    return {e.value_or(0), n.value_or(0), u.value_or(0)};
}

Offset read_offset(const Parameters& parameters) { return read_vector(parameters, "m", usual_step_m); }

Offset operator*(const Offset& offset, double factor) {
    return {offset.east * factor, offset.north * factor, offset.up * factor};
}

void shift_place(Fix& fix, const Offset& by) {
    if (fix.has_position()) fix.position = displaced(fix.position, by.east, by.north, by.up);
}

void add_velocity(Fix& fix, const Offset& more) {
    const VelocityNed& v = fix.velocity;
    put_velocity(fix, {v.north + more.north, v.east + more.east, v.down - more.up});
}

Result<Fault> make_position_step(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::epoch>([offset = read_offset(parameters)](Epoch& epoch, const FaultMoment& moment) {
        shift_place(epoch.fix, offset * moment.strength);
    });
}

Result<Fault> make_position_ramp(const Parameters& parameters, const FaultContext&) {
    const Offset rate = read_vector(parameters, "mps", usual_ramp_mps);
    const double most = parameters.number("most_m");
    const bool velocity_too = parameters.flag("velocity_too");
    return fault_of<&Fault::epoch>([=](Epoch& epoch, const FaultMoment& moment) {
        const double speed = std::hypot(rate.east, rate.north, rate.up);
        const double wanted = moment.since_start.value();
        const double seconds = speed > 0 ? std::min(wanted, most / speed) : 0;
        shift_place(epoch.fix, rate * (seconds * moment.strength));
        if (!velocity_too || !epoch.fix.has_position()) return;
        // How fast that offset changes: by itself up to its limit, and along the ramps.
        const Offset more = rate * ((seconds < wanted ? 0 : moment.strength) + seconds * moment.strength_rate);
        add_velocity(epoch.fix, more);
    });
}

// A random walk: its variance grows with time, however often there is an epoch.
class RandomWalk {
public:
    RandomWalk(const Parameters& parameters, const FaultContext& context)
        : horizontal_(parameters.number("horizontal_m_per_sqrt_s")),
          vertical_(parameters.number("vertical_m_per_sqrt_s")),
          random_(context.stream("drift")) {}
    Offset at(GpsTime now) {
        const double step = last_ ? std::sqrt(std::max(0.0, difference(now, *last_).value())) : 0;
        last_ = now;
        place_.east += horizontal_ * step * random_.normal();
        place_.north += horizontal_ * step * random_.normal();
        place_.up += vertical_ * step * random_.normal();
        return place_;
    }

private:
    double horizontal_, vertical_;
    RandomStream random_;
    std::optional<GpsTime> last_;
    Offset place_;
};

Result<Fault> make_drift(const Parameters& parameters, const FaultContext& context) {
    return fault_of<&Fault::epoch>(
        [walk = RandomWalk(parameters, context)](Epoch& epoch, const FaultMoment& moment) mutable {
            shift_place(epoch.fix, walk.at(moment.now) * moment.strength);
        });
}

class Wander {
public:
    Wander(const Parameters& parameters, const FaultContext& context)
        : east_(horizontal(parameters), context.stream("wander.east")),
          north_(horizontal(parameters), context.stream("wander.north")),
          up_({parameters.number("vertical_m"), time_of(parameters)}, context.stream("wander.up")) {}
    Offset at(GpsTime now) {
        const Seconds step(last_ ? std::max(0.0, difference(now, *last_).value()) : 0);
        last_ = now;
        return {east_.advance(step), north_.advance(step), up_.advance(step)};
    }

private:
    static Seconds time_of(const Parameters& p) { return Seconds(p.number("correlation_time_s")); }
    static GaussMarkovParameters horizontal(const Parameters& p) { return {p.number("horizontal_m"), time_of(p)}; }
    GaussMarkov east_, north_, up_;
    std::optional<GpsTime> last_;
};

Result<Fault> make_wander(const Parameters& parameters, const FaultContext& context) {
    return fault_of<&Fault::epoch>(
        [wander = Wander(parameters, context)](Epoch& epoch, const FaultMoment& moment) mutable {
            shift_place(epoch.fix, wander.at(moment.now) * moment.strength);
        });
}

Result<Fault> make_velocity_bias(const Parameters& parameters, const FaultContext&) {
    const Offset bias = read_vector(parameters, "mps", usual_velocity_bias_mps);
    return fault_of<&Fault::epoch>([bias](Epoch& epoch, const FaultMoment& moment) {
        if (!epoch.fix.has_position()) return;
        add_velocity(epoch.fix, bias * moment.strength);
    });
}

Result<Fault> make_height_bias(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::epoch>([height = parameters.number("height_m")](Epoch& epoch, const FaultMoment& moment) {
        if (!epoch.fix.has_position()) return;
        epoch.fix.position.height.above_ellipsoid += Metres(height * moment.strength);
    });
}

void scale_dop(Dop& dop, double factor) {
    for (double* d : {&dop.gdop, &dop.pdop, &dop.hdop, &dop.vdop, &dop.tdop, &dop.edop, &dop.ndop})
        *d *= factor;
}

Result<Fault> make_biased_good_dop(const Parameters& parameters, const FaultContext&) {
    const Offset offset = read_offset(parameters);
    const double hdop = parameters.number("hdop"), accuracy = parameters.number("accuracy_m");
    return fault_of<&Fault::epoch>([=](Epoch& epoch, const FaultMoment& moment) {
        Fix& fix = epoch.fix;
        if (!fix.has_position()) return;
        shift_place(fix, offset * moment.strength);
        if (fix.dop.hdop > 0) scale_dop(fix.dop, hdop / fix.dop.hdop);
        fix.horizontal_accuracy = Metres(accuracy);
        fix.vertical_accuracy = Metres(1.5 * accuracy);  // as the vertical of a good sky is to its horizontal
    });
}

Result<Fault> make_accuracy_scale(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::epoch>([factor = parameters.number("factor")](Epoch& epoch, const FaultMoment& moment) {
        Fix& fix = epoch.fix;
        const double scale = std::pow(factor, moment.strength);
        fix.horizontal_accuracy = fix.horizontal_accuracy * scale;
        fix.vertical_accuracy = fix.vertical_accuracy * scale;
        fix.speed_accuracy = fix.speed_accuracy * scale;
        fix.course_accuracy = fix.course_accuracy * scale;
        fix.time_accuracy = fix.time_accuracy * scale;
    });
}

constexpr ParameterSpec spread(std::string_view name, double standard, std::string_view meaning) {
    return number_parameter(name, standard, 0, farthest_m, meaning);
}

constexpr auto place_error_kinds = std::to_array<FaultKind>(
    {{"position_step", "The position lies off by a constant vector, at once.",
      "A change of the satellites in use, or of ambiguities or corrections.", offset_parameters, make_position_step},
     {"position_ramp", "The position moves away from the true one at a constant speed.",
      "A slow capture by false signals, or a clock or orbit that goes wrong.",
      velocity_parameters("north, m/s; 1 when none of the three is given, else 0") +
          ParameterList{number_parameter("most_m", farthest_m, 0, farthest_m, "the error grows no more beyond this, m"),
                        flag_parameter("velocity_too", false, "the velocity tells of the ramp as well")},
      make_position_ramp},
     {"drift",
      "The position walks away at random: its error grows with the square root of time.",
      "A receiver that filters heavily while it has few satellites.",
      {spread("horizontal_m_per_sqrt_s", 1, "1 σ of east and of north, m/√s"),
       spread("vertical_m_per_sqrt_s", 1.5, "1 σ of the height, m/√s")},
      make_drift},
     {"wander",
      "The position wanders around the true one: a Gauss-Markov process on each axis.",
      "Multipath of a vehicle at rest, and what is left of the ionosphere.",
      {spread("horizontal_m", 5, "1 σ of east and of north, m"), spread("vertical_m", 8, "1 σ of the height, m"),
       number_parameter("correlation_time_s", 60, 0.01, 1e6, "after which it has forgotten itself, s")},
      make_wander},
     {"biased_good_dop", "The position lies off while DOP and accuracies say that all is well.",
      "Reflected signals that agree with each other, or false ones: geometry knows nothing of them.",
      offset_parameters +
          ParameterList{
              number_parameter("hdop", 0.6, 0.1, 99, "HDOP that is told; the other DOPs follow"),
              number_parameter("accuracy_m", 0.8, 0.001, farthest_m, "horizontal accuracy that is told, 1 σ, m")},
      make_biased_good_dop}});

constexpr auto motion_and_quality_kinds = std::to_array<FaultKind>(
    {{"height_bias",
      "The height lies off by a constant.",
      "A wrong geoid or antenna height, or an ionosphere that is not modelled.",
      {number_parameter("height_m", 30, -farthest_m, farthest_m, "above the true solution, m")},
      make_height_bias},
     {"velocity_bias", "The velocity lies off by a constant vector; the position stays right.",
      "Doppler shifts of reflected signals, or a filter tuned for another vehicle.",
      velocity_parameters("north, m/s; 2 when none of the three is given, else 0"), make_velocity_bias},
     FaultKind{
         "accuracy_scale",
         "The accuracies that the receiver tells of itself are too small, or too large.",
         "Receivers estimate their accuracy from residuals, which reflected signals need not raise.",
         {number_parameter("factor", 0.1, 0.001, 1000, "times the estimates; below 1 optimistic, above 1 pessimistic")},
         make_accuracy_scale}
         .that_needs(accuracy_report)});

}  // namespace

std::vector<FaultKind> position_fault_kinds() {
    return all_kinds_of(FaultLayer::solution, {place_error_kinds, motion_and_quality_kinds, report_fault_kinds()});
}

}  // namespace skyloop::inline run
