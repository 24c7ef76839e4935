#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> receiver_fault_kinds() { return {}; }

}  // namespace skyloop
