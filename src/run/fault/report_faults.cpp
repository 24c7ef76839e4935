#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

#include "detail/fault_catalogue.hpp"

namespace skyloop::inline run {
namespace {

using firmware::NavigationState;

// All but the first and the last have a position.
constexpr std::span<const std::string_view> words_with_position(fix_type_names.data() + 1, fix_type_names.size() - 2);

FixType fix_type_of(std::string_view word) {
    const auto* const found = std::find(fix_type_names.begin(), fix_type_names.end(), word);
    return found == fix_type_names.end() ? FixType::none : static_cast<FixType>(found - fix_type_names.begin());
}

// With the type goes what follows from it: satellites in use, which nobody has without a fix or reckons on with, and
// the vector of a pair with its ambiguities, which there is with an RTK solution alone.
void claim_type(NavigationState& state, FixType type) {
    Fix& fix = state.epoch.fix;
    fix.type = type;
    state.fix_ok = fix.has_position();
    if (type == FixType::none || type == FixType::dead_reckoning)
        for (SatelliteStatus& s : fix.satellites) {
            s.used = false;
            s.residual.reset();
        }
    std::optional<RelativePosition>& pair = state.epoch.relative;
    if (type != FixType::rtk_fixed && type != FixType::rtk_float) pair.reset();
    if (pair) pair->fixed = type == FixType::rtk_fixed;
}

// A place from before: all of the solution but the time and what the sky looks like.
void put_old_solution(NavigationState& state, const NavigationState& old) {
    const Fix now = state.epoch.fix;
    Fix& fix = state.epoch.fix;
    fix = old.epoch.fix;
    fix.time = now.time;
    fix.leap_seconds = now.leap_seconds;
    fix.clock_bias = now.clock_bias;
    fix.clock_drift = now.clock_drift;
    fix.satellites = now.satellites;
    state.fix_ok = old.fix_ok;
    state.ever_had_fix = old.ever_had_fix;
    state.only_place_known = old.only_place_known;
    state.position_known = old.position_known;
    state.course = old.course;
    state.course_is_frozen = old.course_is_frozen;
}

Result<Fault> make_freeze(const Parameters& parameters, const FaultContext&) {
    const bool stands_still = parameters.text("velocity") == "zero";
    return fault_of<&Fault::report>(
        [stands_still, first = First<NavigationState>()](NavigationState& state, const FaultMoment&) mutable {
            put_old_solution(state, first.of(state));
            if (stands_still) put_velocity(state.epoch.fix, {});
        });
}

Result<Fault> make_stale_position(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::report>(
        [first = First<NavigationState>()](NavigationState& state, const FaultMoment&) mutable {
            put_old_solution(state, first.of(state));
            claim_type(state, FixType::none);
            state.old_position_shown = true;
        });
}

Result<Fault> make_wrong_fix_type(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::report>([type = fix_type_of(parameters.text("type"))](
                                        NavigationState& state, const FaultMoment&) { claim_type(state, type); });
}

Result<Fault> make_zero_position(const Parameters& parameters, const FaultContext&) {
    const FixType type = fix_type_of(parameters.text("type"));
    return fault_of<&Fault::report>([type](NavigationState& state, const FaultMoment&) {
        constexpr double geoid_at_zero_m = 17;  // EGM96 at 0° N 0° E
        claim_type(state, type);
        state.ever_had_fix = state.position_known = true;
        Fix& fix = state.epoch.fix;
        fix.position = Geodetic::degrees(0, 0, geoid_at_zero_m);
        fix.geoid_undulation = Metres(geoid_at_zero_m);
        put_velocity(fix, {});
    });
}

Result<Fault> make_rtk_transition(const Parameters& parameters, const FaultContext&) {
    const FixType type = fix_type_of(parameters.text("to"));
    const double east = parameters.number("east_m"), north = parameters.number("north_m"),
                 up = parameters.number("up_m");
    const double accuracy = parameters.number("accuracy_m");
    return fault_of<&Fault::report>([=](NavigationState& state, const FaultMoment& moment) {
        Fix& fix = state.epoch.fix;
        if (!fix.has_position()) return;
        claim_type(state, type);
        const double s = moment.strength;
        fix.position = displaced(fix.position, east * s, north * s, up * s);
        fix.horizontal_accuracy = Metres(accuracy);
        fix.vertical_accuracy = Metres(1.5 * accuracy);
        std::optional<RelativePosition>& pair = state.epoch.relative;
        if (!pair) return;
        pair->north_m += north * s;
        pair->east_m += east * s;
        pair->down_m -= up * s;
        pair->deviation = std::max(pair->deviation, Metres(accuracy / std::numbers::sqrt2));
        pair->down_deviation = std::max(pair->down_deviation, Metres(1.5 * accuracy));
    });
}

Result<Fault> make_heading_lost(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::report>([](NavigationState& state, const FaultMoment&) { state.epoch.relative.reset(); });
}

Result<Fault> make_heading_flipped(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::report>([](NavigationState& state, const FaultMoment&) {
        if (!state.epoch.relative) return;
        RelativePosition& r = *state.epoch.relative;
        r.north_m = -r.north_m;
        r.east_m = -r.east_m;
        r.down_m = -r.down_m;
    });
}

// Satellites that nobody sees have numbers that are free, first of the systems that the receiver tracks: sentences
// count no others.
void add_unseen_satellites(std::vector<SatelliteStatus>& satellites, int count) {
    struct System {
        Constellation constellation;
        int numbers;
    };
    using enum Constellation;
    std::vector<System> systems{{gps, 32}, {glonass, 24}, {galileo, 36}, {beidou, 63}};
    std::stable_partition(systems.begin(), systems.end(), [&](const System& system) {
        return std::any_of(satellites.begin(), satellites.end(),
                           [&](const auto& s) { return s.id.constellation == system.constellation; });
    });
    for (const auto& [constellation, numbers] : systems)
        for (int number = 1; number <= numbers && count > 0; ++number) {
            const SatelliteId id{constellation, number};
            if (std::any_of(satellites.begin(), satellites.end(), [&](const auto& s) { return s.id == id; })) continue;
            SatelliteStatus made_up;
            made_up.id = id;
            made_up.used = true;
            satellites.push_back(made_up);
            --count;
        }
    std::sort(satellites.begin(), satellites.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
}

Result<Fault> make_satellites_misreported(const Parameters& parameters, const FaultContext&) {
    const int count = static_cast<int>(parameters.number("count"));
    return fault_of<&Fault::report>([count](NavigationState& state, const FaultMoment&) {
        std::vector<SatelliteStatus>& satellites = state.epoch.fix.satellites;
        int used = state.epoch.fix.satellites_used();
        for (auto s = satellites.rbegin(); s != satellites.rend() && used > count; ++s)
            if (std::exchange(s->used, false)) --used;
        for (SatelliteStatus& s : satellites) {
            if (used >= count) break;
            if (!std::exchange(s.used, true)) ++used;
        }
        if (used < count) add_unseen_satellites(satellites, count - used);
        // GGA and GNS may count those that the solution left out too, which it knows by their residuals.
        for (SatelliteStatus& s : satellites)
            if (!s.used) s.residual.reset();
    });
}

Result<Fault> at_random_epochs(const Parameters& parameters, RandomStream random,
                               std::function<void(NavigationState&)> change) {
    return fault_of<&Fault::report>(
        [probability = parameters.number("probability"), drawn = std::move(random), change = std::move(change)](
            NavigationState& state, const FaultMoment& moment) mutable {
            if (drawn.uniform() < probability * moment.strength) change(state);
        });
}

Result<Fault> make_dropped_epochs(const Parameters& parameters, const FaultContext& context) {
    return at_random_epochs(parameters, context.stream("dropped"), [](NavigationState& state) { state.reports = 0; });
}

Result<Fault> make_duplicated_epochs(const Parameters& parameters, const FaultContext& context) {
    return at_random_epochs(parameters, context.stream("duplicated"),
                            [](NavigationState& state) { state.reports *= 2; });
}

Result<Fault> make_reordered_epochs(const Parameters& parameters, const FaultContext& context) {
    const Seconds delay(parameters.number("delay_s"));
    return at_random_epochs(parameters, context.stream("reordered"),
                            [delay](NavigationState& state) { state.report_delay += delay; });
}

constexpr ParameterSpec epoch_share(double standard) {
    return number_parameter("probability", standard, 0, 1, "of each epoch");
}

constexpr ParameterSpec step_parameter(std::string_view name, double standard, std::string_view meaning) {
    return number_parameter(name, standard, -1000, 1000, meaning);
}

constexpr std::string_view kept_velocities[] = {"kept", "zero"};

constexpr auto untrue_report_kinds = without_strength(std::to_array<FaultKind>(
    {{"freeze",
      "Position and velocity stay as they are while the time goes on.",
      "Firmware that hangs in its navigation while its output goes on.",
      {word_parameter("velocity", "kept", kept_velocities, "the velocity of before, or none")},
      make_freeze},
     {"stale_position",
      "The last position is sent on with quality 0 and without the flag of a fix.",
      "Receivers that keep their last place in view after the loss; naive drivers take it for a new one.",
      {},
      make_stale_position},
     {"zero_position",
      "Latitude and longitude are 0 while the flag of a fix is set.",
      "Interference: receivers that report a fix before they have a place (ArduPilot #33142).",
      {word_parameter("type", "3d", words_with_position, "type of fix that is told")},
      make_zero_position},
     {"wrong_fix_type",
      "The type of fix is told wrong, and with it what follows from it: satellites in use, the vector of a pair. "
      "Position, velocity and accuracies stay.",
      "Firmware that reckons on without satellites and says 3D, or drivers' mistakes with it.",
      {word_parameter("type", "2d", fix_type_names, "type of fix that is told")},
      make_wrong_fix_type}}));

constexpr auto rtk_kinds = std::to_array<FaultKind>(
    {{"rtk_transition",
      "The solution falls back to another type and steps with it, and back at the end.",
      "Corrections that stop, or ambiguities that are lost: RTK fixed becomes float (PX4 #21555).",
      {word_parameter("to", "rtk_float", words_with_position, "type of the solution meanwhile"),
       step_parameter("east_m", 0.4, "step east, m"), step_parameter("north_m", 0.3, "step north, m"),
       step_parameter("up_m", 0.6, "step up, m"),
       number_parameter("accuracy_m", 0.3, 0.001, 1000, "horizontal accuracy that is told, 1 σ, m")},
      make_rtk_transition}});

constexpr auto pair_and_count_kinds = without_strength(std::to_array<FaultKind>(
    {FaultKind{"heading_lost",
               "The vector between the antennas of a pair is gone.",
               "One of the two antennas is shaded, or its corrections do not arrive.",
               {},
               make_heading_lost}
         .that_needs(heading_report),
     FaultKind{"heading_flipped",
               "The vector between the antennas of a pair points the other way.",
               "Ambiguities fixed to wrong numbers on a short baseline, or antennas connected the wrong way round.",
               {},
               make_heading_flipped}
         .that_needs(heading_report),
     {"satellites_misreported",
      "The number of satellites in use is told wrong.",
      "Counts of signals instead of satellites, or of what is in view.",
      {whole_number_parameter("count", 0, 0, 40, "how many are told")},
      make_satellites_misreported}}));

constexpr auto epoch_fault_kinds = std::to_array<FaultKind>(
    {{"dropped_epochs",
      "Epochs are missing: none of their messages is sent.",
      "A receiver that cannot follow the rate that was asked of it.",
      {epoch_share(0.3)},
      make_dropped_epochs},
     {"duplicated_epochs",
      "Epochs are told twice, with the same time.",
      "Bridges and hubs that repeat, and receivers with two outputs on one line.",
      {epoch_share(1)},
      make_duplicated_epochs},
     {"reordered_epochs",
      "Epochs come late, after younger ones.",
      "Links over a network or a radio, and receivers under load.",
      {epoch_share(0.3), number_parameter("delay_s", 0.3, 0.001, 3600,
                                          "how much later, s; more than a period, or nothing is out of order")},
      make_reordered_epochs}});

}  // namespace

std::vector<FaultKind> report_fault_kinds() {
    return all_kinds_of(FaultLayer::solution,
                        {untrue_report_kinds, rtk_kinds, pair_and_count_kinds, epoch_fault_kinds});
}

}  // namespace skyloop::inline run
