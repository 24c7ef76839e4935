// A field's declaration is a name, and perhaps a scale and the number that stands for nothing.
#include "receiver/protocol/field.hpp"

using namespace skyloop;

double control(const I4<"lat_deg*1e-7">& field) { return field.value(); }

#ifdef MUST_NOT_COMPILE
static_assert(field_format("lat_deg*0.125").scaled);
#endif
