// A velocity of the level is turned into one of the Earth by its frame only.
#include "base/geo/simulator_frames.hpp"

using namespace skyloop;

Velocity<Ecef> control(const LevelFrame& frame, const Velocity<Level>& velocity) { return frame.to_ecef(velocity); }

#ifdef MUST_NOT_COMPILE
Velocity<Ecef> bad(const Velocity<Level>& velocity) { return velocity; }
#endif
