"""A real JSBSim as a source: a ball thrown north-east, by its FlightGear packets and by its lines."""
import math
import os
import pathlib
import select
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from heard import Recording

JSBSIM = os.environ.get("SKYLOOP_JSBSIM") or shutil.which("JSBSim") or shutil.which("/usr/games/JSBSim")
LATITUDE, LONGITUDE, FOOT = 47.3977, 8.5456, 0.3048
HEIGHT, SPEED = 10000 * FOOT, 300 * FOOT
ROLL, PITCH, YAW = 20, 10, 45

BALL = """<?xml version="1.0"?>
<fdm_config name="ball" version="2.0" release="BETA">
 <fileheader><author>skyloop</author><filecreationdate>2026-01-01</filecreationdate><version>1</version></fileheader>
 <metrics>
  <wingarea unit="FT2">1</wingarea><wingspan unit="FT">1</wingspan><chord unit="FT">1</chord>
  <htailarea unit="FT2">0</htailarea><htailarm unit="FT">0</htailarm>
  <vtailarea unit="FT2">0</vtailarea><vtailarm unit="FT">0</vtailarm>
  <location name="AERORP" unit="IN"><x>0</x><y>0</y><z>0</z></location>
  <location name="EYEPOINT" unit="IN"><x>0</x><y>0</y><z>0</z></location>
  <location name="VRP" unit="IN"><x>0</x><y>0</y><z>0</z></location>
 </metrics>
 <mass_balance>
  <ixx unit="SLUG*FT2">10</ixx><iyy unit="SLUG*FT2">10</iyy><izz unit="SLUG*FT2">10</izz>
  <emptywt unit="LBS">50</emptywt>
  <location name="CG" unit="IN"><x>0</x><y>0</y><z>0</z></location>
 </mass_balance>
 <ground_reactions/><propulsion/><flight_control name="none"/><aerodynamics/>
 %s
</fdm_config>
"""
START = f"""<?xml version="1.0"?>
<initialize name="start">
 <latitude unit="DEG" type="geodetic">{LATITUDE}</latitude><longitude unit="DEG">{LONGITUDE}</longitude>
 <altitude unit="FT">10000</altitude>
 <ubody unit="FT/SEC">300</ubody><vbody unit="FT/SEC">0</vbody><wbody unit="FT/SEC">0</wbody>
 <phi unit="DEG">{ROLL}</phi><theta unit="DEG">{PITCH}</theta><psi unit="DEG">{YAW}</psi>
</initialize>
"""
# The host by its name: JSBSim asks the domain name service for the name of an address, and gives up without one.
PACKETS = """<output name="localhost" type="FLIGHTGEAR" protocol="UDP" port="%d" rate="50">
  <time type="simulation" resolution="1e-6"/></output>"""
PROPERTIES = ("simulation/sim-time-sec position/lat-geod-deg position/long-gc-deg position/h-sl-ft velocities/v-north-fps "
              "velocities/v-east-fps velocities/v-down-fps attitude/phi-rad attitude/theta-rad attitude/psi-rad").split()
LINES = ("""<output name="localhost" type="SOCKET" protocol="TCP" port="%d" rate="50">""" +
         "".join(f"<property>{name}</property>" for name in PROPERTIES) + "</output>")


def simulate(output, port):
    """JSBSim for two seconds of flight; its folder and process."""
    folder = tempfile.TemporaryDirectory()
    root = pathlib.Path(folder.name)
    for part in ("engine", "systems", "scripts", "aircraft/ball"):
        (root / part).mkdir(parents=True)
    (root / "aircraft/ball/ball.xml").write_text(BALL % (output % port))
    (root / "aircraft/ball/start.xml").write_text(START)
    process = subprocess.Popen([JSBSIM, f"--root={root}", "--aircraft=ball", "--initfile=start", "--end=2", "--realtime"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=root)
    return folder, process


class JsbsimSource(unittest.TestCase):
    def record(self, output, listener, patience=15):
        recording = Recording()
        folder, process = simulate(output, listener.getsockname()[1])
        with folder:
            end = time.monotonic() + patience
            sockets = [listener]
            while time.monotonic() < end and (process.poll() is None or recording.pieces == []):
                for ready in select.select(sockets, [], [], 0.2)[0]:
                    if ready is listener and listener.type == socket.SOCK_STREAM:
                        sockets.append(listener.accept()[0])
                        continue
                    data = ready.recv(65536)
                    if data:
                        recording.add(data)
                    else:
                        sockets.remove(ready)
                        ready.close()
            process.kill()
            process.wait()
        for left in sockets:
            left.close()
        return recording

    def check_flight(self, samples, place_m):
        """A ball: north-east and up at first, faster down by g; places and velocities belong together."""
        self.assertGreater(len(samples), 30)
        first = samples[0]
        for found, wanted in zip(first["angles"], (ROLL, PITCH, YAW)):
            self.assertAlmostEqual(found, wanted, delta=0.5)
        horizontal = SPEED * math.cos(math.radians(PITCH))
        for sample in samples:
            self.assertAlmostEqual(sample["ned"][0], horizontal * math.sqrt(0.5), delta=1)
            self.assertAlmostEqual(sample["ned"][1], horizontal * math.sqrt(0.5), delta=1)
        start = first["time"] / 1e9
        self.assertAlmostEqual(first["ned"][2], -SPEED * math.sin(math.radians(PITCH)) + 9.8 * start, delta=0.5)
        span = (samples[-1]["time"] - first["time"]) / 1e9
        self.assertGreater(span, 0.5)
        self.assertAlmostEqual((samples[-1]["ned"][2] - first["ned"][2]) / span, 9.79, delta=0.1)
        north = (samples[-1]["place"][0] - first["place"][0]) * 111183
        self.assertAlmostEqual(north, (first["ned"][0] + samples[-1]["ned"][0]) / 2 * span, delta=place_m)
        up = samples[-1]["place"][2] - first["place"][2]
        self.assertAlmostEqual(up, -(first["ned"][2] + samples[-1]["ned"][2]) / 2 * span, delta=place_m)
        self.assertAlmostEqual(first["place"][2], HEIGHT, delta=15)

    def test_flightgear_packets(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
            listener.bind(("127.0.0.1", 0))
            heard = self.record(PACKETS, listener).read_by("flightgear")
        self.assertEqual([line for line in heard if "refused" in line], [])
        # The first packets show that its time is one.
        self.assertEqual([line["time"] for line in heard[:3]], [None] * 3)
        self.check_flight(heard[3:], 0.5)

    def test_lines(self):
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            listener.listen(1)
            heard = self.record(LINES, listener).read_by("jsbsim")
        self.assertEqual([line for line in heard if "refused" in line], [])
        self.check_flight(heard, 1.5)


if __name__ == "__main__":
    if not JSBSIM:
        print("integration/jsbsim_source is skipped: there is no JSBSim; apt-get install flightgear")
        sys.exit(77)
    unittest.main()
