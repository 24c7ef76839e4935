"""Places on WGS-84: geodetic and Cartesian, local axes, elevation; and small systems of equations."""

import math

A = 6378137.0
E2 = 0.00669437999014


def to_ecef(latitude, longitude, height):
    """Degrees and metres to metres."""
    sine, cosine = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
    normal = A / math.sqrt(1 - E2 * sine * sine)
    return [(normal + height) * cosine * math.cos(math.radians(longitude)),
            (normal + height) * cosine * math.sin(math.radians(longitude)), (normal * (1 - E2) + height) * sine]


def to_geodetic(x, y, z):
    """Metres to degrees and metres, to a tenth of a millimetre near the ground."""
    p = math.hypot(x, y)
    latitude = math.atan2(z, p * (1 - E2))
    for _ in range(6):
        sine = math.sin(latitude)
        normal = A / math.sqrt(1 - E2 * sine * sine)
        latitude = math.atan2(z + E2 * normal * sine, p)
    sine = math.sin(latitude)
    height = p * math.cos(latitude) + z * sine - A * math.sqrt(1 - E2 * sine * sine)
    return [math.degrees(latitude), math.degrees(math.atan2(y, x)), height]


def local(vector, latitude, longitude):
    """An ECEF vector in east, north, up."""
    sin_lat, cos_lat = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
    sin_lon, cos_lon = math.sin(math.radians(longitude)), math.cos(math.radians(longitude))
    x, y, z = vector
    return [-sin_lon * x + cos_lon * y, -sin_lat * cos_lon * x - sin_lat * sin_lon * y + cos_lat * z,
            cos_lat * cos_lon * x + cos_lat * sin_lon * y + sin_lat * z]


def elevation(satellite, place):
    """Degrees, of an ECEF position above the horizon of a geodetic place."""
    east, north, up = local([a - b for a, b in zip(satellite, to_ecef(*place))], *place[:2])
    return math.degrees(math.atan2(up, math.hypot(east, north)))


def offset(place, origin):
    """Metres east, north, up of a geodetic place from another."""
    return local([a - b for a, b in zip(to_ecef(*place), to_ecef(*origin))], *origin[:2])


def east_north_up(rows):
    """Three series of metres about the mean of rows of latitude, longitude, height; None stays None."""
    there = [row for row in rows if row is not None]
    latitude, longitude, height = (math.fsum(column) / len(there) for column in zip(*there))
    sine = math.sin(math.radians(latitude))
    meridian = A * (1 - E2) / (1 - E2 * sine * sine) ** 1.5
    parallel = A / math.sqrt(1 - E2 * sine * sine) * math.cos(math.radians(latitude))
    return [[None if row is None else math.radians(row[1] - longitude) * parallel for row in rows],
            [None if row is None else math.radians(row[0] - latitude) * meridian for row in rows],
            [None if row is None else row[2] - height for row in rows]]


def solve(matrix, right):
    """Gauss with pivots."""
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    size = len(rows)
    for column in range(size):
        pivot = max(range(column, size), key=lambda index: abs(rows[index][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        for index in range(size):
            if index != column:
                factor = rows[index][column] / rows[column][column]
                rows[index] = [a - factor * b for a, b in zip(rows[index], rows[column])]
    return [row[size] / row[index] for index, row in enumerate(rows)]
