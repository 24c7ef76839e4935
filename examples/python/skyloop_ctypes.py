"""skyloop_ctypes.py [SECONDS [SCENARIO]]: skyloop from Python, without anything but the standard library.

Flies a circle, reads the receiver's bytes and prints its fix as JSON. The class Emulator is all that a simulator in
Python needs; SKYLOOP_LIBRARY names the library where the loader does not find it.
"""
import ctypes
import ctypes.util
import json
import math
import os
import sys

ABI_MAJOR = 0
POS_LLA_ELLIPSOID, VEL = 2, 16
CREATE_SEED = 1


class CreateInfo(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("abi_major", ctypes.c_uint32), ("set", ctypes.c_uint32),
                ("reserved", ctypes.c_uint32), ("scenario_text", ctypes.c_char_p), ("scenario_file", ctypes.c_char_p),
                ("data_dir", ctypes.c_char_p), ("record_dir", ctypes.c_char_p), ("start_utc", ctypes.c_char_p),
                ("log", ctypes.c_void_p), ("log_user", ctypes.c_void_p), ("error", ctypes.c_char_p),
                ("error_capacity", ctypes.c_uint64), ("start_sim_ns", ctypes.c_int64), ("seed", ctypes.c_uint64),
                ("origin_lla", ctypes.c_double * 3)]


class Truth(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("fields", ctypes.c_uint32), ("sim_time_ns", ctypes.c_int64),
                ("vehicle", ctypes.c_uint32), ("reserved", ctypes.c_uint32), ("pos", ctypes.c_double * 3),
                ("vel_ned", ctypes.c_double * 3), ("acc_ned", ctypes.c_double * 3), ("q_nb", ctypes.c_double * 4),
                ("rate_frd", ctypes.c_double * 3)]


class Progress(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("ports", ctypes.c_uint32), ("epochs", ctypes.c_uint64),
                ("now_ns", ctypes.c_int64), ("next_event_ns", ctypes.c_int64), ("bytes_pending", ctypes.c_uint64),
                ("ports_pending", ctypes.c_uint64)]


class SkyloopError(Exception):
    """A call gave a negative status."""


def load_library():
    """The library, with the types of the functions that are used here."""
    name = os.environ.get("SKYLOOP_LIBRARY") or ctypes.util.find_library("skyloop") or "libskyloop.so.0"
    library = ctypes.CDLL(name)
    if library.sky_abi_version() >> 16 != ABI_MAJOR:
        raise SkyloopError(f"{name} is ABI {library.sky_abi_version() >> 16}; expected {ABI_MAJOR}")
    handle, size = ctypes.c_void_p, ctypes.c_size_t
    library.sky_create.argtypes = [ctypes.POINTER(CreateInfo), ctypes.POINTER(handle)]
    library.sky_destroy.argtypes = [handle]
    library.sky_destroy.restype = None
    library.sky_set_truth.argtypes = [handle, ctypes.POINTER(Truth)]
    library.sky_advance.argtypes = [handle, ctypes.c_int64, ctypes.POINTER(Progress)]
    for function in (library.sky_read, library.sky_write):
        function.argtypes = [handle, ctypes.c_uint32, ctypes.c_char_p, size]
        function.restype = ctypes.c_int64
    library.sky_command.argtypes = [handle, ctypes.c_char_p]
    library.sky_query.argtypes = [handle, ctypes.c_char_p, ctypes.c_char_p, size]
    library.sky_query.restype = ctypes.c_int64
    library.sky_last_error.argtypes = [handle, ctypes.c_char_p, size]
    library.sky_last_error.restype = ctypes.c_int64
    return library


class Emulator:
    """One run. Times are nanoseconds of the caller's clock, which begins at 0."""

    def __init__(self, scenario_text=None, scenario_file=None, start_utc="2026-03-01T12:00:00Z", seed=1):
        self.library = load_library()
        self.handle = ctypes.c_void_p()
        error = ctypes.create_string_buffer(512)
        info = CreateInfo(struct_size=ctypes.sizeof(CreateInfo), abi_major=ABI_MAJOR, set=CREATE_SEED, seed=seed,
                          scenario_text=scenario_text and scenario_text.encode(),
                          scenario_file=scenario_file and os.fsencode(scenario_file), start_utc=start_utc.encode(),
                          error=ctypes.cast(error, ctypes.c_char_p), error_capacity=len(error))
        status = self.library.sky_create(ctypes.byref(info), ctypes.byref(self.handle))
        if status != 0:
            raise SkyloopError(f"sky_create gave {status}: {error.value.decode()}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.library.sky_destroy(self.handle)
        self.handle = ctypes.c_void_p()

    def checked(self, status):
        """The status, unless it is an error."""
        if status >= 0:
            return status
        sentence = ctypes.create_string_buffer(1024)
        self.library.sky_last_error(self.handle, sentence, len(sentence))
        raise SkyloopError(f"status {status}: {sentence.value.decode()}")

    def set_truth(self, time_ns, latitude, longitude, height, velocity_ned):
        """Degrees, metres above the ellipsoid, m/s."""
        truth = Truth(struct_size=ctypes.sizeof(Truth), fields=POS_LLA_ELLIPSOID | VEL, sim_time_ns=time_ns,
                      pos=(latitude, longitude, height), vel_ned=tuple(velocity_ned))
        self.checked(self.library.sky_set_truth(self.handle, ctypes.byref(truth)))

    def advance(self, time_ns):
        progress = Progress(struct_size=ctypes.sizeof(Progress))
        self.checked(self.library.sky_advance(self.handle, time_ns, ctypes.byref(progress)))
        return progress

    def read(self, port=0):
        """All bytes that have left the port."""
        buffer, read = ctypes.create_string_buffer(4096), b""
        while count := self.checked(self.library.sky_read(self.handle, port, buffer, len(buffer))):
            read += buffer.raw[:count]
        return read

    def write(self, data, port=0):
        return self.checked(self.library.sky_write(self.handle, port, data, len(data)))

    def command(self, **members):
        self.checked(self.library.sky_command(self.handle, json.dumps(members).encode()))

    def query(self, what):
        """"status", "config", "ports", "faults" or "commands"."""
        buffer = ctypes.create_string_buffer(4096)
        while (size := self.checked(self.library.sky_query(self.handle, what.encode(), buffer, len(buffer)))) >= len(buffer):
            buffer = ctypes.create_string_buffer(size + 1)
        return json.loads(buffer.value)


def circle(time_s, radius=100.0, speed=10.0):
    """Latitude, longitude and velocity on a circle round Odessa."""
    metres_per_degree = 111_195.0
    turned = speed / radius * time_s
    latitude = 46.4774 + radius * math.cos(turned) / metres_per_degree
    longitude = 30.7326 + radius * math.sin(turned) / (metres_per_degree * math.cos(math.radians(46.4774)))
    return latitude, longitude, (-speed * math.sin(turned), speed * math.cos(turned), 0.0)


def main(words):
    seconds = float(words[1]) if len(words) > 1 else 10
    received = 0
    with Emulator(scenario_file=words[2] if len(words) > 2 else None) as emulator:
        for step in range(int(seconds * 50) + 1):
            latitude, longitude, velocity = circle(step * 0.02)
            emulator.set_truth(step * 20_000_000, latitude, longitude, 77.0, velocity)
            emulator.advance(step * 20_000_000)
            received += len(emulator.read())
        receiver = emulator.query("status")["receivers"][0]
    print(json.dumps({"bytes": received, "epochs": receiver["epochs"], "fix": receiver["fix"],
                      "error": receiver["error"]}))


if __name__ == "__main__":
    main(sys.argv)
