// A height above the ellipsoid becomes one above the sea only with an undulation.
#include "base/geo/geodetic.hpp"

using namespace skyloop;

MslHeight control(EllipsoidalHeight height, Metres undulation) { return above_sea_level(height, undulation); }

#ifdef MUST_NOT_COMPILE
MslHeight bad(EllipsoidalHeight height) { return height; }
#endif
