#!/usr/bin/env python3
"""A whole simulator in one page: a point mass that flies a square on the position it decodes from skyloop's port.

    skyloop run closed_loop.toml            # kind = "live", source = "tcp-json:29990", clock = "lock_step"
    point_mass.py --tty TTY --steps 3000

Truth goes out as JSON lines (docs/feeds.md), the receiver's NMEA comes in. With --realtime the truth goes by UDP on the wall
clock and nobody waits for anybody.
"""
import argparse
import json
import math
import os
import select
import socket
import sys
import time
import tty

ORIGIN = (46.4774, 30.7326, 77.0)  # degrees, metres above the ellipsoid
CORNERS = [(0, 0), (60, 0), (60, 60), (0, 60)]  # north, east of the origin, m
STEP_S = 0.02
RADIUS = 6371000.0


def checked_fields(line):
    """The fields of a sentence, or None where its checksum does not hold."""
    if not line.startswith("$") or "*" not in line:
        return None
    body, _, told = line[1:].partition("*")
    value = 0
    for character in body:
        value ^= ord(character)
    return body.split(",") if told.strip().upper() == f"{value:02X}" else None


def degrees(text, hemisphere):
    """ddmm.mmmm as degrees."""
    point = text.index(".")
    value = float(text[:point - 2]) + float(text[point - 2:]) / 60
    return -value if hemisphere in "SW" else value


class Ears:
    """The autopilot's receiver driver: the last position that was decoded."""

    def __init__(self):
        self.rest, self.position, self.velocity, self.fixes = "", None, (0.0, 0.0), 0

    def hear(self, piece):
        self.rest += piece.decode("ascii", "replace")
        *lines, self.rest = self.rest.split("\n")
        for line in lines:
            fields = checked_fields(line.strip())
            if fields and fields[0][2:] == "RMC" and fields[2] == "A":
                speed = float(fields[7] or 0) * 1852 / 3600
                course = math.radians(float(fields[8] or 0))
                self.velocity = (speed * math.cos(course), speed * math.sin(course))
            if fields and fields[0][2:] == "GGA" and fields[6] not in "0":
                north = math.radians(degrees(fields[2], fields[3]) - ORIGIN[0]) * RADIUS
                east = math.radians(degrees(fields[4], fields[5]) - ORIGIN[1]) * RADIUS * math.cos(math.radians(ORIGIN[0]))
                self.position = (north, east)
                self.fixes += 1


class PointMass:
    """Flies to the corners one after the other, by what it believes where it is."""

    def __init__(self):
        self.position, self.velocity, self.acceleration, self.corner, self.laps = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], 1, 0

    def steer(self, ears):
        """A proportional law on the decoded position and velocity; 6 m/s and 3 m/s² at most."""
        if ears.position is None:
            self.acceleration = [0.0, 0.0]
            return
        error = [CORNERS[self.corner][i] - ears.position[i] for i in (0, 1)]
        far = math.hypot(*error)
        if far < 5:
            self.corner = (self.corner + 1) % len(CORNERS)
            self.laps += self.corner == 1
        wish = [e * min(0.5, 6 / max(far, 1e-9)) for e in error]
        push = [1.0 * (wish[i] - ears.velocity[i]) for i in (0, 1)]
        limit = min(1.0, 3 / max(math.hypot(*push), 1e-9))
        self.acceleration = [limit * p for p in push]

    def step(self):
        for i in (0, 1):
            self.position[i] += self.velocity[i] * STEP_S + self.acceleration[i] * STEP_S ** 2 / 2
            self.velocity[i] += self.acceleration[i] * STEP_S

    def truth(self, t):
        north, east = self.position
        lat = ORIGIN[0] + math.degrees(north / RADIUS)
        lon = ORIGIN[1] + math.degrees(east / RADIUS / math.cos(math.radians(ORIGIN[0])))
        return {"type": "truth", "v": 1, "t_ns": round(t * 1e9), "lla": [lat, lon, ORIGIN[2]], "h_ref": "ell",
                "vel_ned": [*self.velocity, 0.0], "acc_ned": [*self.acceleration, 0.0]}


def read_exactly(tty_fd, count, patience=20):
    """The bytes that the step has put out: no more and no less, so that every run hears the same."""
    piece, end = b"", time.monotonic() + patience
    while len(piece) < count and time.monotonic() < end:
        if select.select([tty_fd], [], [], 0.2)[0]:
            piece += os.read(tty_fd, count - len(piece))
    if len(piece) < count:
        raise SystemExit(f"{count} bytes were announced, {len(piece)} came")
    return piece


def fly_in_steps(where, tty_fd, steps):
    """Lock-step: truth and a step out, the answer in. @return the flown positions and all bytes heard"""
    link = socket.create_connection(where, timeout=30)
    answers = link.makefile("r")
    mass, ears, path, heard = PointMass(), Ears(), [], b""
    for k in range(steps):
        t = k * STEP_S
        lines = [mass.truth(t), {"type": "step", "t_ns": round(t * 1e9)}]
        link.sendall("".join(json.dumps(line) + "\n" for line in lines).encode())
        while (answer := json.loads(answers.readline()))["type"] != "stepped":
            pass
        piece = read_exactly(tty_fd, answer["bytes"])
        heard += piece
        ears.hear(piece)
        path.append(tuple(mass.position))
        mass.steer(ears)
        mass.step()
    link.sendall(b'{"type":"bye"}\n')
    answers.close()
    link.close()
    return path, heard, ears, mass


def fly_in_real_time(where, tty_fd, seconds):
    """On the wall clock. @return positions, the largest distance from the square, and what was heard"""
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    mass, ears, path = PointMass(), Ears(), []
    begin = time.monotonic()
    for k in range(int(seconds / STEP_S)):
        t = k * STEP_S
        while (left := begin + t - time.monotonic()) > 0:
            if select.select([tty_fd], [], [], left)[0]:
                ears.hear(os.read(tty_fd, 65536))
        link.sendto((json.dumps(mass.truth(t)) + "\n").encode(), where)
        path.append(tuple(mass.position))
        mass.steer(ears)
        mass.step()
    link.close()
    return path, ears, mass


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--tty", required=True)
    options.add_argument("--port", type=int, default=29990)
    options.add_argument("--steps", type=int, default=3000)
    options.add_argument("--realtime", action="store_true")
    chosen = options.parse_args()
    tty_fd = os.open(chosen.tty, os.O_RDWR | os.O_NOCTTY)
    tty.setraw(tty_fd)
    where = ("127.0.0.1", chosen.port)
    if chosen.realtime:
        path, ears, mass = fly_in_real_time(where, tty_fd, chosen.steps * STEP_S)
    else:
        path, _, ears, mass = fly_in_steps(where, tty_fd, chosen.steps)
    print(json.dumps({"fixes": ears.fixes, "laps": mass.laps, "last": path[-1],
                      "farthest": max(math.hypot(p[0] - 30, p[1] - 30) for p in path)}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
