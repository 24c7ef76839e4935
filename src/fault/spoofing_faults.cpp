#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> spoofing_fault_kinds() { return {}; }

}  // namespace skyloop
