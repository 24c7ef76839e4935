#include "../src/scene/plane_merge.hpp"
