#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> wire_fault_kinds() { return {}; }

}  // namespace skyloop
