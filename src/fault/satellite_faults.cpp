#include "catalogue_parts.hpp"

namespace skyloop {

std::vector<FaultKind> satellite_fault_kinds() { return {}; }

}  // namespace skyloop
