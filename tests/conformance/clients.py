"""The scripted clients by the names that the tests have."""
import adafruit
import ardupilot
import betaflight
import gpsd_probes
import inav
import kumar_ros
import px4
import septentrio
import sparkfun
import tracker
import u_center
import ubloxcfg
import unicore

CLIENTS = {
    "adafruit": adafruit.Adafruit,
    "ardupilot": ardupilot.ArduPilot,
    "ardupilot_keys": ardupilot.ArduPilotKeys,
    "ardupilot_nmea": ardupilot.ArduPilotNmea,
    "ardupilot_sbf": septentrio.ArduPilotSbf,
    "betaflight": betaflight.Betaflight,
    "ardupilot_unicore": unicore.ArduPilotUnicore,
    "ardupilot_unicore_moving": unicore.ArduPilotUnicoreMoving,
    "gpsd_probes": gpsd_probes.GpsdProbes,
    "inav": inav.Inav,
    "kumar_ros": kumar_ros.KumarRos,
    "px4": px4.Px4,
    "px4_9600": px4.Px4At9600,
    "px4_gps_sbf": septentrio.Px4GpsSbf,
    "px4_gps_sbf_moving": septentrio.Px4GpsSbfMoving,
    "px4_systems": px4.Px4Systems,
    "px4_ublox6": px4.Px4Ublox6,
    "px4_nmea": px4.Px4Nmea,
    "px4_septentrio": septentrio.Px4Septentrio,
    "px4_unicore": unicore.Px4Unicore,
    "ros_septentrio": septentrio.RosSeptentrio,
    "rtkbase_unicore": unicore.RtkBase,
    "sparkfun": sparkfun.SparkFun,
    "sparkfun_unicore": unicore.SparkFunUnicore,
    "tracker": tracker.Tracker,
    "u_center": u_center.UCenter,
    "ubloxcfg": ubloxcfg.UbloxCfg,
}
