// Two points do not add; a point and a displacement do.
#include "base/geo/frames.hpp"

using namespace skyloop;

Position<Ecef> control(const Position<Ecef>& a, const Displacement<Ecef>& b) { return a + b; }

#ifdef MUST_NOT_COMPILE
auto bad(const Position<Ecef>& a, const Position<Ecef>& b) { return a + b; }
#endif
