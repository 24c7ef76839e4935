#!/usr/bin/env python3
"""A ROS 2 node between a simulation in ROS and skyloop, in both directions.

Truth in: nav_msgs/Odometry or geometry_msgs/PoseStamped become lines of skyloop-truth/1, sent by UDP to a scenario whose
[trajectory] has kind = "live" and source = "udp-json:29990".

Receiver out: lines of skyloop-epoch/1, from skyloop run --output json-tcp:9000, become sensor_msgs/NavSatFix and
geometry_msgs/TwistStamped.

    python3 json_bridge.py --ros-args -p origin:=[47.3977,8.5456,488.0] -p odometry_topic:=/model/x500/odometry

Only main() needs ROS: everything above it works on anything that has the fields of the messages.
"""
import json
import math
import socket
import threading
import time

# sensor_msgs/NavSatStatus and NavSatFix.
NO_FIX, FIX, SBAS_FIX, GBAS_FIX = -1, 0, 1, 2
COVARIANCE_UNKNOWN, COVARIANCE_APPROXIMATED = 0, 1
SERVICES = {"G": 1, "R": 2, "C": 4, "E": 8}
STATUS = {"2d": FIX, "3d": FIX, "dgnss": SBAS_FIX, "rtk_float": GBAS_FIX, "rtk_fixed": GBAS_FIX}
SECOND_NS = 1_000_000_000


def stamp_ns(stamp):
    """builtin_interfaces/Time as whole nanoseconds."""
    return stamp.sec * SECOND_NS + stamp.nanosec


def origin_statement(origin, height_reference="ell"):
    """Where the local frame begins: latitude and longitude in degrees, height in metres above "ell" or "msl"."""
    return {"type": "origin", "lla": [float(part) for part in origin], "h_ref": height_reference}


def pose_statement(header, pose, vehicle="0"):
    """geometry_msgs/Pose in an east, north, up frame whose origin has been told (REP 103). ROS writes quaternions x, y, z, w."""
    p, q = pose.position, pose.orientation
    return {"type": "truth", "v": 1, "id": vehicle, "t_ns": stamp_ns(header.stamp), "enu": [p.x, p.y, p.z],
            "q_flu_enu": [q.w, q.x, q.y, q.z]}


def odometry_statement(message, vehicle="0"):
    """nav_msgs/Odometry: the pose as above, the twist in the body's forward, left, up."""
    statement = pose_statement(message.header, message.pose.pose, vehicle)
    v, w = message.twist.twist.linear, message.twist.twist.angular
    statement["vel_frd"] = [v.x, -v.y, -v.z]
    statement["rate_frd"] = [w.x, -w.y, -w.z]
    return statement


def is_finite(value):
    """Whether all numbers in a statement are."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, dict):
        return all(map(is_finite, value.values()))
    return not isinstance(value, list) or all(map(is_finite, value))


class TruthSender:
    """Statements to skyloop, by UDP. The origin is told anew each second: who listens later knows it, too."""

    def __init__(self, host, port, origin, height_reference="ell"):
        self.to = (host, port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.origin = origin_statement(origin, height_reference)
        self.told_at = -math.inf
        self.skipped = 0

    def send(self, statement):
        if not is_finite(statement):
            self.skipped += 1
            return
        text = json.dumps(statement) + "\n"
        if time.monotonic() - self.told_at >= 1:
            text = json.dumps(self.origin) + "\n" + text
            self.told_at = time.monotonic()
        self.socket.sendto(text.encode(), self.to)

    def close(self):
        self.socket.close()


def time_of(epoch):
    """GPS time as ROS counts: seconds and nanoseconds since 1970, UTC."""
    leap_seconds = epoch["fix"]["leap_seconds"] if epoch["fix"] else 18
    ns = (315964800 + epoch["gps_week"] * 604800 - leap_seconds) * SECOND_NS + round(epoch["tow_s"] * 1e9)
    return divmod(ns, SECOND_NS)


def fill_header(header, epoch, frame_id):
    header.frame_id = frame_id
    header.stamp.sec, header.stamp.nanosec = time_of(epoch)


def fill_fix(message, epoch, frame_id):
    """sensor_msgs/NavSatFix of a line of skyloop-epoch/1; the altitude is above the ellipsoid, as the message wants it."""
    fix = epoch["fix"]
    fill_header(message.header, epoch, frame_id)
    valid = fix is not None and fix["ok"] and fix["type"] in STATUS
    message.status.status = STATUS[fix["type"]] if valid else NO_FIX
    message.status.service = 0
    for satellite in epoch["satellites"]:
        if satellite["used"]:
            message.status.service |= SERVICES.get(satellite["id"][0], 0)
    if not valid:
        message.latitude = message.longitude = message.altitude = math.nan
        message.position_covariance_type = COVARIANCE_UNKNOWN
        return message
    message.latitude, message.longitude, message.altitude = fix["lat_deg"], fix["lon_deg"], fix["height_m"]
    horizontal, vertical = fix["h_acc_m"] ** 2 / 2, fix["v_acc_m"] ** 2
    message.position_covariance = [horizontal, 0.0, 0.0, 0.0, horizontal, 0.0, 0.0, 0.0, vertical]
    message.position_covariance_type = COVARIANCE_APPROXIMATED
    return message


def fill_twist(message, epoch, frame_id):
    """geometry_msgs/TwistStamped: east, north, up. Nothing without a velocity."""
    if epoch["fix"] is None or epoch["fix"]["velocity_mps"] is None:
        return None
    fill_header(message.header, epoch, frame_id)
    velocity = epoch["fix"]["velocity_mps"]
    linear = message.twist.linear
    linear.x, linear.y, linear.z = velocity["east"], velocity["north"], -velocity["down"]
    return message


class EpochReader:
    """Calls back with each epoch that skyloop tells, on a thread of its own; calls skyloop again when it is gone."""

    def __init__(self, host, port, callback):
        self.where, self.callback = (host, port), callback
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.stopped.is_set():
            try:
                with socket.create_connection(self.where, timeout=1) as connection:
                    self.read(connection)
            except OSError:
                pass
            self.stopped.wait(0.5)

    def read(self, connection):
        rest = b""
        while not self.stopped.is_set():
            try:
                piece = connection.recv(65536)
            except TimeoutError:
                continue
            if not piece:
                return
            *lines, rest = (rest + piece).split(b"\n")
            for line in lines:
                epoch = json.loads(line)
                if epoch.get("schema") == "skyloop-epoch/1":
                    self.callback(epoch)

    def stop(self):
        self.stopped.set()
        self.thread.join()


def main():
    import rclpy
    from geometry_msgs.msg import PoseStamped, TwistStamped
    from nav_msgs.msg import Odometry
    from rclpy.qos import qos_profile_sensor_data
    from sensor_msgs.msg import NavSatFix

    rclpy.init()
    node = rclpy.create_node("skyloop_bridge")

    def parameter(name, default):
        return node.declare_parameter(name, default).value

    frame_id, receiver = parameter("frame_id", "gps"), parameter("receiver", "receiver0")
    sender = TruthSender(parameter("truth_host", "127.0.0.1"), parameter("truth_port", 29990),
                         parameter("origin", [47.3977, 8.5456, 488.0]), parameter("height_reference", "ell"))
    vehicle, odometry, pose = (parameter("vehicle", "0"), parameter("odometry_topic", "/odom"), parameter("pose_topic", ""))
    if pose:
        node.create_subscription(PoseStamped, pose, lambda m: sender.send(pose_statement(m.header, m.pose, vehicle)),
                                 qos_profile_sensor_data)
    else:
        node.create_subscription(Odometry, odometry, lambda m: sender.send(odometry_statement(m, vehicle)),
                                 qos_profile_sensor_data)
    fixes, twists = node.create_publisher(NavSatFix, "fix", 10), node.create_publisher(TwistStamped, "vel", 10)

    def publish(epoch):
        if epoch["receiver"] != receiver:
            return
        fixes.publish(fill_fix(NavSatFix(), epoch, frame_id))
        twist = fill_twist(TwistStamped(), epoch, frame_id)
        if twist:
            twists.publish(twist)

    reader = EpochReader(parameter("epoch_host", "127.0.0.1"), parameter("epoch_port", 9000), publish)
    try:
        rclpy.spin(node)
    finally:
        reader.stop()
        sender.close()
        node.destroy_node()


if __name__ == "__main__":
    main()
