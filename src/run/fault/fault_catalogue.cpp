#include <fmt/format.h>

#include <algorithm>

#include "detail/fault_catalogue.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

const std::vector<FaultKind>& fault_kinds() {
    static const std::vector<FaultKind> kinds = [] {
        std::vector<FaultKind> all;
        for (const auto& layer :
             {reception_fault_kinds(), spoofing_fault_kinds(), satellite_fault_kinds(), authentication_fault_kinds(),
              position_fault_kinds(), time_fault_kinds(), receiver_fault_kinds(), can_receiver_fault_kinds(),
              wire_fault_kinds(), can_wire_fault_kinds(), correction_fault_kinds()})
            all.insert(all.end(), layer.begin(), layer.end());
        return all;
    }();
    return kinds;
}

const FaultKind* find_fault_kind(std::string_view name) {
    const std::vector<FaultKind>& kinds = fault_kinds();
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const FaultKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

namespace {

std::string lacking(const UsedReceiver& receiver, std::string_view lack) {
    return fmt::format("{} {}", receiver.board.name, lack);
}

// Words and texts of a parameter; none of one that is neither.
std::vector<std::string> values_of(const ParameterSpec& spec, const Parameters& parameters) {
    const bool single = spec.type == ParameterType::word || spec.type == ParameterType::text;
    if (!single) return parameters.texts(spec.name);
    const std::string text = parameters.text(spec.name);
    return text.empty() ? std::vector<std::string>() : std::vector{text};
}

// Whether it is there and not as it would be by itself.
bool is_changed(const ParameterSpec& spec, const Parameters& parameters) {
    const auto given = parameters.values().find(spec.name);
    return given != parameters.values().end() && given->second != spec.standard_value();
}

}  // namespace

IdleParts idle_parts(const FaultKind& kind, const Parameters& parameters, const UsedReceiver& receiver) {
    IdleParts idle;
    if (kind.need != nullptr && !kind.need->met(receiver)) {
        idle.whole = lacking(receiver, kind.need->lack);
        return idle;
    }
    for (const ParameterSpec& spec : kind.parameters) {
        if (spec.need != nullptr && is_changed(spec, parameters) && !spec.need->met(receiver))
            idle.parts.push_back({spec.name, {}, lacking(receiver, spec.need->lack)});
        if (spec.idle_value == nullptr) continue;
        const std::vector<std::string> values = values_of(spec, parameters);
        std::vector<IdlePart> of_this;
        for (const std::string& value : values)
            if (const std::string why = spec.idle_value(receiver, value); !why.empty())
                of_this.push_back({spec.name, value, lacking(receiver, why)});
        if (!of_this.empty() && of_this.size() == values.size()) {
            idle.whole = of_this.front().why;
            return idle;
        }
        idle.parts.insert(idle.parts.end(), of_this.begin(), of_this.end());
    }
    return idle;
}

std::vector<ParameterMistake> ramp_mistakes(const FaultKind& kind, const Parameters& values) {
    std::vector<ParameterMistake> mistakes;
    for (const char* key : {"ramp_in_s", "ramp_out_s"})
        if (!kind.has_strength && values.optional_number(key).value_or(0) > 0)
            mistakes.push_back({key, fmt::format("is {:g}, and {} is there or is not; expected no ramp",
                                                 *values.optional_number(key), kind.name)});
    return mistakes;
}

void silence(Arrival& arrival) {
    arrival.line_of_sight = false;
    arrival.paths = 0;
    arrival.reflections = 0;
    arrival.excess_path = Metres(0);
    arrival.excess_rate = MetresPerSecond(0);
    arrival.echoes.clear();
    arrival.cn0.reset();
    arrival.cut_off = true;
}

Edit<Epoch> detected_after(const Parameters& parameters) {
    const auto after = parameters.optional_number("detected_after_s");
    if (!after) return {};
    return [after = *after](Epoch& epoch, const FaultMoment& moment) {
        if (moment.since_start.value() >= after)
            epoch.front_end.spoofing = std::max(epoch.front_end.spoofing, SpoofingIndication::indicated);
    };
}

Result<std::optional<ToldPlace>> ToldPlace::read(const Parameters& parameters, std::string_view name) {
    const std::vector<double> numbers = parameters.numbers(name);
    if (numbers.empty()) return std::nullopt;
    if (numbers.size() < 2)
        return fail(ErrorCode::usage, fmt::format("{} has one number; expected latitude and longitude", name));
    const auto place = place_from_degrees(numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0);
    if (!place) return fail(ErrorCode::usage, fmt::format("{}: {}", name, place.error()));
    ToldPlace told;
    told.place_ = *place;
    told.has_height_ = numbers.size() > 2;
    return told;
}

Position<Ecef> ToldPlace::seen_from(const TruthState& truth) const {
    Geodetic place = place_;
    if (!has_height_) place.height = truth.geodetic.height;
    return to_ecef(place);
}

}  // namespace skyloop::inline run
