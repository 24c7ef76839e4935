#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> reception_fault_kinds() { return {}; }

}  // namespace skyloop
