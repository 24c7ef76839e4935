"""The ROS bridge without ROS: its conversions on messages that have the fields alone, and its ends against a run."""
import importlib.util
import json
import math
import socket
import threading
import unittest
from types import SimpleNamespace

from session import ROOT, Emulator, open_folder

spec = importlib.util.spec_from_file_location("json_bridge", ROOT / "examples/ros/json_bridge.py")
bridge = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bridge)


def fields(**values):
    return SimpleNamespace(**values)


def vector(x=0.0, y=0.0, z=0.0):
    return fields(x=x, y=y, z=z)


def header():
    return fields(stamp=fields(sec=0, nanosec=0), frame_id="")


def nav_sat_fix():
    return fields(header=header(), status=fields(status=0, service=0), latitude=0.0, longitude=0.0, altitude=0.0,
                  position_covariance=[0.0] * 9, position_covariance_type=0)


def twist_stamped():
    return fields(header=header(), twist=fields(linear=vector(), angular=vector()))


def odometry(orientation=(0.0, 0.0, 0.0, 1.0)):
    """An nav_msgs/Odometry: its quaternion is x, y, z, w."""
    x, y, z, w = orientation
    message = fields(header=header(), pose=fields(pose=fields(position=vector(10.0, 20.0, 30.0),
                                                              orientation=fields(x=x, y=y, z=z, w=w))),
                     twist=fields(twist=fields(linear=vector(5.0, 1.0, 0.5), angular=vector(0.1, 0.2, 0.3))))
    message.header.stamp.sec, message.header.stamp.nanosec = 12, 345678901
    return message


class ConversionTest(unittest.TestCase):
    def test_odometry_is_a_statement_of_truth(self):
        half = math.sqrt(0.5)
        statement = bridge.odometry_statement(odometry((0.0, 0.0, half, half)), "drone1")
        self.assertEqual(statement, {"type": "truth", "v": 1, "id": "drone1", "t_ns": 12345678901, "enu": [10.0, 20.0, 30.0],
                                     "q_flu_enu": [half, 0.0, 0.0, half], "vel_frd": [5.0, -1.0, -0.5],
                                     "rate_frd": [0.1, -0.2, -0.3]})
        pose = bridge.pose_statement(odometry().header, odometry().pose.pose)
        self.assertNotIn("vel_frd", pose)
        self.assertEqual(pose["q_flu_enu"], [1.0, 0.0, 0.0, 0.0])

    def test_a_sender_tells_its_origin_and_nothing_that_is_not_finite(self):
        listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(5)
        self.addCleanup(listener.close)
        sender = bridge.TruthSender(*listener.getsockname(), [47.0, 8.0, 500], "msl")
        self.addCleanup(sender.close)
        broken = odometry()
        broken.pose.pose.position.y = math.nan
        sender.send(bridge.odometry_statement(broken))
        sender.send(bridge.odometry_statement(odometry()))
        sender.send(bridge.odometry_statement(odometry()))
        first, second = (listener.recv(2000).decode().splitlines() for _ in range(2))
        self.assertEqual(json.loads(first[0]), {"type": "origin", "lla": [47.0, 8.0, 500.0], "h_ref": "msl"})
        self.assertEqual([json.loads(line)["type"] for line in first[1:] + second], ["truth", "truth"])
        self.assertEqual(sender.skipped, 1)

    def test_without_a_fix_there_is_no_place(self):
        epoch = {"gps_week": 2304, "tow_s": 216018.25, "fix": None, "satellites": []}
        message = bridge.fill_fix(nav_sat_fix(), epoch, "gps")
        self.assertEqual((message.status.status, message.position_covariance_type), (-1, 0))
        self.assertTrue(math.isnan(message.latitude))
        self.assertEqual((message.header.stamp.sec, message.header.stamp.nanosec), (1709640000, 250000000))
        self.assertIsNone(bridge.fill_twist(twist_stamped(), epoch, "gps"))


class RunTest(unittest.TestCase):
    def test_epochs_of_a_run_become_fixes_and_twists(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        emulator = Emulator("--at", "47.3977,8.5456,488", "--start", "2024-03-05T12:00:00Z", "--port", "pty", "--rate", 5,
                            "--output", "json-tcp:0")
        self.addCleanup(emulator.__exit__)
        port = int(emulator.said(r"^output 0: json: 127.0.0.1:(\d+) \(tcp\)$"))
        epochs, enough = [], threading.Event()

        def take(epoch):
            epochs.append(epoch)
            if len(epochs) >= 5:
                enough.set()

        reader = bridge.EpochReader("127.0.0.1", port, take)
        self.addCleanup(reader.stop)
        self.assertTrue(enough.wait(20))
        for epoch in epochs[:5]:
            fix, twist = bridge.fill_fix(nav_sat_fix(), epoch, "gps"), bridge.fill_twist(twist_stamped(), epoch, "gps")
            self.assertEqual(fix.status.status, 0)
            self.assertTrue(fix.status.service & 1, "GPS among the systems used")
            self.assertAlmostEqual(fix.latitude, 47.3977, delta=2e-4)
            self.assertAlmostEqual(fix.altitude, 488, delta=30)
            self.assertAlmostEqual(sum(fix.position_covariance[:5]), epoch["fix"]["h_acc_m"] ** 2, places=6)
            self.assertEqual(fix.header.frame_id, "gps")
            self.assertGreaterEqual(fix.header.stamp.sec, 1709640000)
            self.assertEqual(twist.twist.linear.x, epoch["fix"]["velocity_mps"]["east"])
            self.assertEqual(twist.twist.linear.z, -epoch["fix"]["velocity_mps"]["down"])
        stamps = [divmod(bridge.stamp_ns(bridge.fill_fix(nav_sat_fix(), e, "gps").header.stamp), 200_000_000)[1] for e in epochs]
        self.assertEqual(set(stamps), {0}, "epochs stand on whole fifths of a second")
        emulator.stop()


if __name__ == "__main__":
    unittest.main(verbosity=2)
