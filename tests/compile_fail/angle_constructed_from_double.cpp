// Nor is an angle constructed from a bare number in so many words.
#include "base/core/units.hpp"

using namespace skyloop;

Angle control(double value) { return Angle::radians(value); }

#ifdef MUST_NOT_COMPILE
auto bad(double value) { return Angle(value); }
#endif
