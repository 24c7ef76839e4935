"""Writes one flight as the logs of autopilots and receivers, by nothing but struct and the published layouts.

write_flights.py FOLDER: truth.csv (GPS time in ns, degrees, metres above the ellipsoid, m/s north east down, degrees of
roll, pitch, yaw) and the logs. The geoid of the flight lies 48 m above the ellipsoid everywhere.
"""

import math
import pathlib
import struct
import sys

UNDULATION = 48.0
POSIX = 1709640000  # 2024-03-05T12:00:00Z
GPS_EPOCH_POSIX, LEAP = 315964800, 18
GPS_NS = (POSIX - GPS_EPOCH_POSIX + LEAP) * 10**9
WEEK, TOW_MS = divmod(GPS_NS // 10**6, 604800000)
BOOT_US = 12_500_000  # the autopilot's clock at POSIX
LAT0, LON0 = 47.0, 8.5
SPHERE = 6371000.0
FLAT = 111318.845


def truth(seconds):
    """The place, velocity and attitude: a circle of 50 m at 10 m/s that climbs."""
    turn = seconds * 0.2
    north, east = 50 * math.sin(turn), 50 * (1 - math.cos(turn))
    lat = LAT0 + north / FLAT
    lon = LON0 + east / (FLAT * math.cos(math.radians((lat + LAT0) / 2)))
    yaw = (math.degrees(turn) + 180) % 360 - 180
    return dict(lat=lat, lon=lon, h=500 + 0.5 * seconds, vn=10 * math.cos(turn), ve=10 * math.sin(turn), vd=-0.5,
                roll=20.0, pitch=3.0 * math.sin(turn), yaw=yaw, north=north, east=east)


def quaternion(state):
    r, p, y = (math.radians(state[name]) / 2 for name in ("roll", "pitch", "yaw"))
    cr, sr, cp, sp, cy, sy = math.cos(r), math.sin(r), math.cos(p), math.sin(p), math.cos(y), math.sin(y)
    return (cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy)


def e7(degrees):
    return round(degrees * 1e7)


TIMES = [i / 10 for i in range(101)]


# PX4 ULog -------------------------------------------------------------------------------------------------------------

def ulog_message(kind, payload):
    return struct.pack("<HB", len(payload), ord(kind)) + payload


def ulog(definitions, records):
    """@param definitions by topic: (format text, struct format); records: (topic, values)"""
    out = bytes([0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35, 1]) + struct.pack("<Q", BOOT_US)
    for topic, (text, _) in definitions.items():
        out += ulog_message("F", f"{topic}:{text}".encode())
    ids = {topic: number for number, topic in enumerate(definitions)}
    for topic, number in ids.items():
        out += ulog_message("A", struct.pack("<BH", 0, number) + topic.encode())
    for topic, values in records:
        out += ulog_message("D", struct.pack("<H", ids[topic]) + struct.pack("<" + definitions[topic][1], *values))
    return out


def on_sphere(lat, lon):
    """PX4's azimuthal map from LAT0, LON0: metres north and east."""
    a, b, d = math.radians(lat), math.radians(LAT0), math.radians(lon - LON0)
    c = math.acos(min(1.0, math.sin(b) * math.sin(a) + math.cos(b) * math.cos(a) * math.cos(d)))
    k = 1.0 if c < 1e-9 else c / math.sin(c)
    return (k * (math.cos(b) * math.sin(a) - math.sin(b) * math.cos(a) * math.cos(d)) * SPHERE,
            k * math.cos(a) * math.sin(d) * SPHERE)


LOCAL = ("uint64_t timestamp;double ref_lat;double ref_lon;float x;float y;float z;float[2] delta_xy;float delta_z;"
         "float vx;float vy;float vz;float ref_alt;bool xy_valid;bool z_valid;bool v_xy_valid;bool v_z_valid;"
         "uint8_t xy_reset_counter;uint8_t z_reset_counter;bool xy_global;bool z_global;uint8_t[4] _padding0;",
         "Qdd3f2ff3ff4?2B2?")
ATTITUDE = ("uint64_t timestamp;float[4] q;uint8_t[4] _padding0;", "Q4f")
OLD_GPS = ("uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t alt;int32_t alt_ellipsoid;"
           "float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;bool vel_ned_valid;", "QQ4i3fB?")
NEW_GPS = ("uint64_t timestamp;uint64_t time_utc_usec;double latitude_deg;double longitude_deg;double altitude_msl_m;"
           "double altitude_ellipsoid_m;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;"
           "bool vel_ned_valid;", "QQ4d3fB?")


def ulog_local(indoors=False):
    """The filter is 2 m north, 1 m east and 3 m low until its reset after 4 s. Indoors it knows no place on the Earth."""
    nan = float("nan")
    reference = (nan, nan, nan) if indoors else (LAT0, LON0, 500 - UNDULATION)
    records = [("vehicle_attitude", (BOOT_US - 50000, *quaternion(truth(-0.05))))]
    for t in TIMES:
        s, us = truth(t), BOOT_US + round(t * 1e6)
        drift, counter = ((2, 1, 3), 0) if t < 4 else ((0, 0, 0), 1)
        x, y = on_sphere(s["lat"], s["lon"])
        z = 500 - s["h"]
        records.append(("vehicle_local_position",
                        (us, *reference[:2], x + drift[0], y + drift[1], z + drift[2], -2, -1, -3, s["vn"], s["ve"],
                         s["vd"], reference[2], True, True, True, True, counter, counter, not indoors,
                         not indoors)))
        q = quaternion(truth(t + 0.05))
        records.append(("vehicle_attitude", (us + 50000, *q)))
        if round(t * 10) % 10 == 0 and not indoors:
            records.append(("vehicle_gps_position",
                            (us, POSIX * 10**6 + round(t * 1e6), e7(s["lat"]), e7(s["lon"]),
                             round((s["h"] - UNDULATION) * 1e3), round(s["h"] * 1e3), s["vn"], s["ve"], s["vd"], 3,
                             True)))
    return ulog({"vehicle_local_position": LOCAL, "vehicle_attitude": ATTITUDE, "vehicle_gps_position": OLD_GPS},
                records)


def ulog_indoors():
    return ulog_local(indoors=True)


def ulog_receiver():
    records = []
    for t in TIMES:
        s, us = truth(t), BOOT_US + round(t * 1e6)
        records.append(("sensor_gps", (us, POSIX * 10**6 + round(t * 1e6), s["lat"], s["lon"], s["h"] - UNDULATION,
                                       s["h"], s["vn"], s["ve"], s["vd"], 3, True)))
    return ulog({"sensor_gps": NEW_GPS}, records)


# ArduPilot DataFlash --------------------------------------------------------------------------------------------------

LETTERS = dict(b="b", B="B", h="h", H="H", c="h", C="H", i="i", I="I", e="i", E="I", L="i", q="q", Q="Q", f="f", d="d",
               N="16s", Z="64s")


class Dataflash:
    def __init__(self):
        self.out, self.types = b"", {}
        self.define("FMT", "BBnNZ", "Type,Length,Name,Format,Columns", 128)

    def define(self, name, letters, columns, number=None):
        number = number or 129 + len(self.types)
        packing = "<" + "".join(LETTERS.get(letter, "4s") for letter in letters)
        self.types[name] = (number, packing)
        body = struct.pack("<BB4s16s64s", number, 3 + struct.calcsize(packing), name.encode(), letters.encode(),
                           columns.encode())
        self.out += bytes([0xA3, 0x95, 128]) + body

    def units(self, name, units, multipliers):
        self.put("FMTU", 0, self.types[name][0], units.encode(), multipliers.encode())

    def put(self, name, *values):
        number, packing = self.types[name]
        self.out += bytes([0xA3, 0x95, number]) + struct.pack(packing, *values)


def gps_of(t):
    return (TOW_MS + round(t * 1e3)), WEEK


def dataflash_new():
    """With FMTU, two cores of the filter of which the second one is primary, and two starts."""
    log = Dataflash()
    log.define("FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds")
    log.define("GPS", "QBBIHBcLLeffB", "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,U")
    log.define("POS", "QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt")
    log.define("XKF1", "QBccCfffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD")
    log.define("XKF4", "QBb", "TimeUS,C,PI")
    log.define("ATT", "QccC", "TimeUS,Roll,Pitch,Yaw")
    log.units("GPS", "s#---SmDUmnh-", "F----0BGGB00-")
    log.units("POS", "sDUmmm", "FGG000")
    log.units("XKF1", "s#ddhnnnnmmm", "F-BBB0000000")
    log.units("XKF4", "s#-", "F--")
    log.units("ATT", "sddh", "FBBB")
    for t in TIMES:
        s = truth(t)
        us = BOOT_US + round(t * 1e6) if t < 6 else 1_000_000 + round((t - 6) * 1e6)
        angles = round(s["roll"] * 100), round(s["pitch"] * 100), round(s["yaw"] % 360 * 100)
        log.put("ATT", us, *angles)
        for core, wrong in ((0, 40), (1, 0)):
            log.put("XKF1", us, core, *angles, s["vn"] + wrong, s["ve"], s["vd"], 0, s["north"] + wrong, s["east"],
                    500 - s["h"])
        log.put("XKF4", us, 0, 1)
        log.put("POS", us, e7(s["lat"]), e7(s["lon"]), s["h"] - UNDULATION, 0, 0)
        if round(t * 10) % 2 == 0:
            ms, week = gps_of(t)
            log.put("GPS", us, 0, 3, ms, week, 12, 80, e7(s["lat"]), e7(s["lon"]),
                    round((s["h"] - UNDULATION) * 100), 10, 0, 1)
    return log.out


def dataflash_old():
    """Without FMTU: letters scale. GPS, GPA with the undulation and ATT alone."""
    log = Dataflash()
    log.define("GPS", "QBIHBcLLefff", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ")
    log.define("GPA", "QCCCf", "TimeUS,VDop,HAcc,VAcc,Und")
    log.define("ATT", "QccC", "TimeUS,Roll,Pitch,Yaw")
    for t in TIMES:
        s, us = truth(t), BOOT_US + round(t * 1e6)
        ms, week = gps_of(t)
        log.put("GPS", us, 3, ms, week, 9, 80, e7(s["lat"]), e7(s["lon"]), round((s["h"] - UNDULATION) * 100),
                math.hypot(s["vn"], s["ve"]), math.degrees(math.atan2(s["ve"], s["vn"])), s["vd"])
        log.put("GPA", us, 100, 100, 100, -UNDULATION)
        log.put("ATT", us, round(s["roll"] * 100), round(s["pitch"] * 100), round(s["yaw"] % 360 * 100))
    return log.out


def dataflash_simulated():
    """A simulation's truth; its receiver is 100 m off and gives the time alone."""
    log = Dataflash()
    log.define("GPS", "QBIHBcLLefff", "TimeUS,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ")
    log.define("SIM", "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4")
    log.define("SIM2", "Qdddfff", "TimeUS,PN,PE,PD,VN,VE,VD")
    for t in TIMES:
        s, us = truth(t), BOOT_US + round(t * 1e6)
        log.put("SIM", us, 0, 0, 0, s["h"] - UNDULATION, e7(s["lat"]), e7(s["lon"]), *quaternion(s))
        log.put("SIM2", us, s["north"], s["east"], 500 - s["h"], s["vn"], s["ve"], s["vd"])
        if round(t * 10) % 2 == 0:
            ms, week = gps_of(t)
            log.put("GPS", us, 3, ms, week, 9, 80, e7(s["lat"] + 0.001), e7(s["lon"]), 50000, 0, 0, 0)
    return log.out


# MAVLink telemetry log ------------------------------------------------------------------------------------------------

EXTRA = {0: 50, 2: 137, 30: 39, 31: 246, 32: 185, 33: 104, 49: 39, 108: 32, 253: 83}


def x25(data):
    crc = 0xFFFF
    for byte in data:
        tmp = byte ^ (crc & 0xFF)
        tmp = (tmp ^ (tmp << 4)) & 0xFF
        crc = (crc >> 8) ^ (tmp << 8) ^ (tmp << 3) ^ (tmp >> 4)
    return crc & 0xFFFF


class Tlog:
    def __init__(self, version):
        self.out, self.version, self.sequence = b"", version, 0

    def put(self, t, message, payload, system=1, late=0.0):
        stamp = POSIX * 10**6 + round((t + late) * 1e6)
        if self.version == 2:
            payload = payload.rstrip(b"\0") or b"\0"
            body = bytes([len(payload), 0, 0, self.sequence % 256, system, 1]) + message.to_bytes(3, "little") + payload
        else:
            body = bytes([len(payload), self.sequence % 256, system, 1, message]) + payload
        self.sequence += 1
        frame = bytes([0xFD if self.version == 2 else 0xFE]) + body + struct.pack("<H", x25(body + bytes([EXTRA[message]])))
        self.out += struct.pack(">Q", stamp) + frame


def boot_ms(t):
    return BOOT_US // 1000 + round(t * 1e3)


def heartbeat(kind, autopilot):
    return struct.pack("<IBBBBB", 0, kind, autopilot, 1, 4, 3)


def tlog_global():
    """Version 2, with a ground station, a second vehicle, a message that nobody here knows, and SYSTEM_TIME."""
    log = Tlog(2)
    for t in TIMES:
        s = truth(t)
        late = 0.02 + (round(t * 10) * 7 % 11) * 0.01
        if round(t * 10) % 10 == 0:
            log.put(t, 0, heartbeat(6, 8), system=255)
            log.put(t, 0, heartbeat(2, 12))
            log.put(t, 2, struct.pack("<QI", POSIX * 10**6 + round(t * 1e6), boot_ms(t)), late=late)
            log.put(t, 253, struct.pack("<B50s", 6, b"hello"), late=late)
        log.put(t, 33, struct.pack("<IiiiihhhH", boot_ms(t), 10**8, 10**8, 10**5, 0, 0, 0, 0, 0), system=9, late=late)
        log.put(t, 33, struct.pack("<IiiiihhhH", boot_ms(t), e7(s["lat"]), e7(s["lon"]),
                                   round((s["h"] - UNDULATION) * 1e3), 0, round(s["vn"] * 100), round(s["ve"] * 100),
                                   round(s["vd"] * 100), 65535), late=late)
        log.put(t, 30, struct.pack("<I6f", boot_ms(t), *(math.radians(s[n]) for n in ("roll", "pitch", "yaw")), 0, 0, 0),
                late=late)
    return log.out


def tlog_local():
    """Version 1; UTC by the stamps alone, of which one in ten is not late. ArduPilot starts anew after 6 s."""
    log = Tlog(1)
    log.put(0, 0, heartbeat(2, 3))
    log.put(0, 49, struct.pack("<iii", e7(LAT0), e7(LON0), round((500 - UNDULATION) * 1e3)))
    for i, t in enumerate(TIMES):
        s = truth(t)
        ms = boot_ms(t) if t < 6 else 1000 + round((t - 6) * 1e3)
        late = 0.0 if i % 10 == 5 else 0.05
        log.put(t, 32, struct.pack("<I6f", ms, s["north"], s["east"], 500 - s["h"], s["vn"], s["ve"], s["vd"]), late=late)
        log.put(t, 31, struct.pack("<I7f", ms, *quaternion(s), 0, 0, 0), late=late)
    return log.out


def tlog_simulated():
    """SIM_STATE as ArduPilot sends it: 1e7 times the degrees in the floats, and no time."""
    log = Tlog(2)
    log.put(0, 0, heartbeat(2, 3))
    for t in TIMES:
        s = truth(t)
        log.put(t, 108, struct.pack("<4f9f8f", *quaternion(s), *[0] * 9, e7(s["lat"]), e7(s["lon"]),
                                    s["h"] - UNDULATION, 0, 0, s["vn"], s["ve"], s["vd"]))
    return log.out


# u-blox UBX -----------------------------------------------------------------------------------------------------------

def ubx(kind, number, payload):
    body = struct.pack("<BBH", kind, number, len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 255
        b = (b + a) & 255
    return b"\xb5\x62" + body + bytes([a, b])


def nav_pvt(t, flags=1):
    """The receiver writes times just before a second as the second and negative nanoseconds."""
    s = truth(t)
    tow = TOW_MS + round(t * 1e3)
    second = math.floor(t + 0.05)
    nano = round((t - second) * 1e9)
    return ubx(1, 7, struct.pack("<IHBBBBBBIiBBBB", tow, 2024, 3, 5, 12, 0, second, 7, 20, nano, 3, flags, 0, 12)
               + struct.pack("<4i2I", e7(s["lon"]), e7(s["lat"]), round(s["h"] * 1e3),
                             round((s["h"] - UNDULATION) * 1e3), 900, 1200)
               + struct.pack("<5iIIHHI", *(round(s[n] * 1e3) for n in ("vn", "ve", "vd")), 10000, 0, 100, 100, 120, 0, 0)
               + struct.pack("<ihH", 0, 0, 0))


def ubx_log():
    """With NAV-ATT, NMEA in between, an epoch without a fix and one that is damaged."""
    out = b"$GPTXT,01,01,02,hello*1C\r\n"
    for i, t in enumerate(TIMES):
        s = truth(t)
        frame = nav_pvt(t, flags=0 if i == 50 else 1)
        out += frame if i != 60 else frame[:40] + bytes([frame[40] ^ 1]) + frame[41:]
        if i != 60:
            out += ubx(1, 5, struct.pack("<I4B3i3I", TOW_MS + round(t * 1e3), 0, 0, 0, 0, round(s["roll"] * 1e5),
                                         round(s["pitch"] * 1e5), round(s["yaw"] % 360 * 1e5), 1000, 1000, 1000))
    return out


FLIGHTS = {"local.ulg": ulog_local, "indoors.ulg": ulog_indoors, "receiver.ulg": ulog_receiver, "new.bin": dataflash_new,
           "old.bin": dataflash_old, "simulated.bin": dataflash_simulated, "global.tlog": tlog_global, "local.tlog": tlog_local,
           "simulated.tlog": tlog_simulated, "log.ubx": ubx_log}


def main(folder):
    folder = pathlib.Path(folder)
    with open(folder / "truth.csv", "w", encoding="ascii") as file:
        for t in TIMES:
            s = truth(t)
            print(GPS_NS + round(t * 1e9), *(repr(s[n]) for n in ("lat", "lon", "h", "vn", "ve", "vd", "roll", "pitch",
                                                                   "yaw")), sep=",", file=file)
    for name, write in FLIGHTS.items():
        (folder / name).write_bytes(write())


if __name__ == "__main__":
    main(sys.argv[1])
