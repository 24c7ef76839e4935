#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> position_fault_kinds() { return {}; }

}  // namespace skyloop
