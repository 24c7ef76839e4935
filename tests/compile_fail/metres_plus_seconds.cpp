// Quantities of different units do not add.
#include "base/core/units.hpp"

using namespace skyloop;

Metres control(Metres a, Metres b) { return a + b; }

#ifdef MUST_NOT_COMPILE
auto bad(Metres a, Seconds b) { return a + b; }
#endif
