/// NeQuick-G: the three-dimensional ionosphere model that is driven by the Galileo broadcast.
#pragma once

#include "base/geo/geodetic.hpp"
#include "world/gnss/nequick_tables.hpp"
#include "world/gnss/ntcm_g.hpp"

namespace skyloop {

/// The effective ionisation level Az of a receiver, solar flux units: a0 + a1 μ + a2 μ² with its modified dip latitude
/// μ in degrees, held within 0 … 400; default_ionisation_level where none is given (NeQuick-G document, effective
/// ionisation level).
double nequick_ionisation(const EffectiveIonisation& broadcast, Angle modified_dip_latitude);

/// The slant electron content from a receiver to a satellite above its horizon (European Commission, Ionospheric
/// Correction Algorithm for Galileo Single Frequency Users, issue 1.2), integrated along a straight ray over a sphere
/// of 6371.2 km; delay by ionosphere_group_delay(). The month is that of the tables.
/// @param ut_hours 0 … 24
Tecu nequick_slant_content(const NequickTables& tables, const EffectiveIonisation& broadcast, const Geodetic& receiver,
                           const Geodetic& satellite, double ut_hours);

}  // namespace skyloop
