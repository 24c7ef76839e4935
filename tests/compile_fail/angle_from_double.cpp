// An angle says whether it is meant in degrees or radians.
#include "base/core/units.hpp"

using namespace skyloop;

Angle control(double value) { return Angle::degrees(value); }

#ifdef MUST_NOT_COMPILE
Angle bad(double value) { return value; }
#endif
