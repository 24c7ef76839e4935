/// x².
#pragma once

namespace skyloop::inline receiver {

inline double square(double x) { return x * x; }

}  // namespace skyloop::inline receiver
