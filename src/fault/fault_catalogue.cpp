#include <algorithm>

#include "catalogue_parts.hpp"
#include "skyloop/fault/fault_kind.hpp"

namespace skyloop {

const std::vector<FaultKind>& fault_kinds() {
    static const std::vector<FaultKind> kinds =
        all_kinds_of({reception_fault_kinds, spoofing_fault_kinds, satellite_fault_kinds, position_fault_kinds,
                      time_fault_kinds, receiver_fault_kinds, wire_fault_kinds});
    return kinds;
}

const FaultKind* find_fault_kind(std::string_view name) {
    const std::vector<FaultKind>& kinds = fault_kinds();
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const FaultKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

}  // namespace skyloop
