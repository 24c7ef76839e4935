// A bare number is no length until somebody says so.
#include "base/core/units.hpp"

using namespace skyloop;

Metres control(double value) { return Metres(value); }

#ifdef MUST_NOT_COMPILE
Metres bad(double value) { return value; }
#endif
