// Points of different frames have no difference.
#include "base/geo/frames.hpp"

using namespace skyloop;

Displacement<Enu> control(const Position<Enu>& a, const Position<Enu>& b) { return a - b; }

#ifdef MUST_NOT_COMPILE
auto bad(const Position<Enu>& a, const Position<Ecef>& b) { return a - b; }
#endif
