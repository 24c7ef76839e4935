#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "detail/fault_catalogue.hpp"
#include "detail/terrestrial_frame.hpp"
#include "detail/wire_fault.hpp"

namespace skyloop::inline run {
namespace {

// What neither takes corrections nor makes them is not hit.
std::string why_no_corrections(const UsedReceiver& receiver, std::string_view direction) {
    constexpr std::string_view sends_none = "sends no RTCM";
    if (direction != "to_client" && correction_input.met(receiver)) return {};
    if (direction != "to_receiver" && sends_rtcm(receiver.board)) return {};
    return std::string(direction == "to_client" ? sends_none : correction_input.lack);
}

constexpr ParameterSpec correction_direction =
    word_parameter("direction", "to_receiver", wire_directions,
                   "which corrections: those that the receiver takes in, those that it sends, or both")
        .judged_by(why_no_corrections);

// @param change of the corrections of a direction
template <class Change>
Fault of_corrections(const Parameters& parameters, Change change) {
    return worsened(parameters, [change](WireDirection& direction, const FaultMoment& moment) {
        change(direction.corrections, moment.strength);
    });
}

Result<Fault> make_base_misplaced(const Parameters& parameters, const FaultContext&) {
    const PlaceOffset off{parameters.number("east_m"), parameters.number("north_m"), parameters.number("up_m")};
    return of_corrections(parameters, [off](CorrectionConditions& corrections, double strength) {
        corrections.displaced.push_back({off.east_m * strength, off.north_m * strength, off.up_m * strength});
    });
}

Result<Fault> make_base_in_other_frame(const Parameters& parameters, const FaultContext&) {
    auto frame = TerrestrialFrame::find(parameters.text("frame"));
    if (!frame) return fail(frame.error());
    return of_corrections(parameters, [frame = std::move(*frame)](CorrectionConditions& corrections, double) {
        corrections.told_in = frame;
    });
}

Result<Fault> make_base_multipath(const Parameters& parameters, const FaultContext&) {
    const double code = parameters.number("code_m"), phase = parameters.number("phase_m");
    return of_corrections(parameters, [code, phase](CorrectionConditions& corrections, double strength) {
        const auto add = [&](Metres& sum, double more) { sum = Metres(std::hypot(sum.value(), more * strength)); };
        add(corrections.code_multipath, code);
        add(corrections.phase_multipath, phase);
    });
}

Result<Fault> make_lost(const Parameters& parameters, const FaultContext&) {
    return of_corrections(parameters, [p = parameters.number("probability")](auto& corrections, double strength) {
        combine(corrections.loss, p * strength);
    });
}

Result<Fault> make_late(const Parameters& parameters, const FaultContext&) {
    return of_corrections(parameters, [delay = parameters.number("delay_s")](auto& corrections, double strength) {
        corrections.delay += Seconds(delay * strength);
    });
}

Result<Fault> make_rare(const Parameters& parameters, const FaultContext&) {
    return of_corrections(parameters, [period = Seconds(parameters.number("period_s"))](auto& corrections, double) {
        corrections.least_period = std::max(corrections.least_period, period);
    });
}

template <bool CorrectionConditions::*flag>
Result<Fault> with_flag(const Parameters& parameters, const FaultContext&) {
    return of_corrections(parameters, [](CorrectionConditions& corrections, double) { corrections.*flag = true; });
}

Result<Fault> make_wrong_mount_point(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::wire>([name = parameters.text("of_receiver")](WireConditions& wire, const FaultMoment&) {
        wire.corrections_from = name;
    });
}

constexpr ParameterSpec place_offset(std::string_view name, double standard, std::string_view meaning) {
    return number_parameter(name, standard, -1e6, 1e6, meaning);
}

constexpr auto gradual_correction_kinds = std::to_array<FaultKind>({
    {"base_misplaced",
     "The base sends wrong coordinates of itself (1005, 1006, 4072.0). A rover's solution is off by the same vector, "
     "with unchanged accuracies; from about a kilometre on ambiguities no longer fit.",
     "A mistyped coordinate, a survey-in that ended early, a height of the marker given as that of the antenna.",
     {place_offset("east_m", 0, "error of the coordinates, m"), place_offset("north_m", 111, "the same, north"),
      place_offset("up_m", 0, "the same, up"), correction_direction},
     make_base_misplaced},
    {"base_multipath",
     "Every pseudorange and carrier phase of the base has an error that comes and goes within minutes. A rover's codes "
     "take it over, and it fixes late, wrong, or not at all.",
     "A base on a roof among railings and air conditioners, beside a car, under a tree.",
     {number_parameter("code_m", 2, 0, 100, "of pseudoranges, 1 σ, m"),
      number_parameter("phase_m", 0.01, 0, 0.1, "of carrier phases, 1 σ, m"), correction_direction},
     make_base_multipath},
    {"corrections_lost",
     "Messages of corrections are missing. As the age grows a rover goes from fixed to float, to differential, to a "
     "solution of its own, at the times of its board.",
     "A radio or a cellular link out of reach, a caster that is down, a tariff that is used up.",
     {number_parameter("probability", 1, 0, 1, "of each message to be missing"), correction_direction},
     make_lost},
    {"corrections_late",
     "Messages of corrections come late. A rover extrapolates them: its accuracies grow with their age.",
     "A congested link, a caster that buffers, a proxy between.",
     {number_parameter("delay_s", 10, 0, 3600, "by which each is late, s"), correction_direction},
     make_late},
});

constexpr auto switched_correction_kinds = without_strength(std::to_array<FaultKind>({
    {"corrections_frozen",
     "The observations of one epoch are repeated in place of fresh ones: their time stands still, and a rover ages as "
     "if nothing came.",
     "A caster that sends the rest of a buffer to whoever connects, a base whose firmware hangs.",
     {correction_direction},
     with_flag<&CorrectionConditions::frozen>},
    {"corrections_rare",
     "Observations come less often. Between them a rover extrapolates.",
     "A slow radio that a base is throttled for, or a service that saves traffic.",
     {number_parameter("period_s", 10, 0.1, 3600, "from one epoch that comes to the next, s, at least"),
      correction_direction},
     make_rare},
    {"glonass_biases_missing",
     "Message 1230 is missing: a rover does not know what the base's GLONASS codes are off by against its phases, and "
     "leaves the ambiguities of GLONASS open.",
     "A base of another make, or one whose operator left 1230 out.",
     {correction_direction},
     with_flag<&CorrectionConditions::without_glonass_biases>},
    {"base_in_other_frame",
     "The base sends its coordinates in a national frame, which moves with its plate: a rover's solution is off by "
     "the decimetres or metres between the two.",
     "A base surveyed against a national network while orbits are those of ITRF.",
     {word_parameter("frame", "etrf2000", terrestrial_frame_names, "of the coordinates"), correction_direction},
     make_base_in_other_frame},
    {"wrong_mount_point",
     "Corrections of another receiver of the run come in place of those of `corrections_from`. A rover follows the "
     "other station when the one that it knew has been silent for ten seconds.",
     "A mistyped or swapped mount point.",
     {text_parameter("of_receiver", "", "name of the receiver whose corrections come").that_is_needed()},
     make_wrong_mount_point},
}));

}  // namespace

std::vector<FaultKind> correction_fault_kinds() {
    return all_kinds_of(FaultLayer::corrections, {gradual_correction_kinds, switched_correction_kinds});
}

}  // namespace skyloop::inline run
