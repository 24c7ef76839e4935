#include <fmt/format.h>

#include <algorithm>

#include "detail/catalogue_parts.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop {

const std::vector<FaultKind>& fault_kinds() {
    static const std::vector<FaultKind> kinds = [] {
        std::vector<FaultKind> all;
        for (const auto& layer :
             {reception_fault_kinds(), spoofing_fault_kinds(), satellite_fault_kinds(), position_fault_kinds(),
              time_fault_kinds(), receiver_fault_kinds(), wire_fault_kinds()})
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

std::vector<ParameterMistake> ramp_mistakes(const FaultKind& kind, const Parameters& values) {
    std::vector<ParameterMistake> mistakes;
    for (const char* key : {"ramp_in_s", "ramp_out_s"})
        if (!kind.has_strength && values.optional_number(key).value_or(0) > 0)
            mistakes.push_back({key, fmt::format("is {:g}, and {} is there or is not; expected no ramp",
                                                 *values.optional_number(key), kind.name)});
    return mistakes;
}

}  // namespace skyloop
