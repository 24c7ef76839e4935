#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> time_fault_kinds() { return {}; }

}  // namespace skyloop
