#!/usr/bin/env python3
"""Flies a circle and tells skyloop of it, as JSON lines over UDP: send_truth.py [PORT [SECONDS]]."""
import json
import math
import socket
import sys
import time

PORT = int(sys.argv[1]) if len(sys.argv) > 1 else 29990
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else math.inf
RATE_HZ, RADIUS_M, SPEED_MPS = 50, 100, 15

sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
origin = {"type": "origin", "lla": [48.1374, 11.5755, 520.0], "h_ref": "msl"}
begin, count = time.monotonic(), 0
while count / RATE_HZ < SECONDS:
    t, angle = count / RATE_HZ, count / RATE_HZ * SPEED_MPS / RADIUS_M
    truth = {"type": "truth", "v": 1, "t": t, "seq": count,
             "ned": [RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle), -50],
             "vel_ned": [-SPEED_MPS * math.sin(angle), SPEED_MPS * math.cos(angle), 0],
             "rpy_deg": [13, 0, math.degrees(angle) + 90]}
    lines = ([origin] if count % RATE_HZ == 0 else []) + [truth]
    sender.sendto("".join(json.dumps(line) + "\n" for line in lines).encode(), ("127.0.0.1", PORT))
    count += 1
    time.sleep(max(0, begin + count / RATE_HZ - time.monotonic()))
