"""The scripted clients by the names that the tests have."""
import px4

CLIENTS = {
    "px4": px4.Px4,
    "px4_nmea": px4.Px4Nmea,
}
