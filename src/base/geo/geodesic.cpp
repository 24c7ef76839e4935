#include "base/geo/geodesic.hpp"

#include <GeographicLib/Geodesic.hpp>

namespace skyloop {

GeodesicPoint geodesic_direct(const Geodetic& start, Angle azimuth, Metres distance) {
    double latitude = 0;
    double longitude = 0;
    double end_azimuth = 0;
    double reduced_length = 0;
    GeographicLib::Geodesic::WGS84().Direct(start.latitude.deg(), start.longitude.deg(), azimuth.deg(),
                                            distance.value(), latitude, longitude, end_azimuth, reduced_length);
    return {Angle::degrees(latitude), Angle::degrees(longitude), Angle::degrees(end_azimuth), Metres(reduced_length)};
}

GeodesicLeg geodesic_between(const Geodetic& from, const Geodetic& to) {
    double length = 0;
    double azimuth = 0;
    double end_azimuth = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude.deg(), from.longitude.deg(), to.latitude.deg(),
                                             to.longitude.deg(), length, azimuth, end_azimuth);
    return {Metres(length), Angle::degrees(azimuth)};
}

}  // namespace skyloop
