"""A node of DroneCAN on an SLCAN pty against what ArduPilot's driver and its server of node ids need of it."""
import argparse
import os
import shlex
import subprocess
import sys
import time

import can_bus
import receiver

FIX2, AUXILIARY, NODE_STATUS, ALLOCATION, GNSS_STATUS = 1063, 1061, 341, 1, 20003
GET_NODE_INFO, RESTART, OPCODE, GET_SET = 1, 5, 10, 11
GIVEN_ID = 125  # what ArduPilot gives at first
MAGIC = 0xACCE551B1E
UNIX_OF_GPS_MS = 315964800000 - 18000  # AP_GPS: UNIX_OFFSET_MSEC
WEEK_MS = 7 * 86400 * 1000


def check(good, what):
    if not good:
        raise AssertionError(what)


def start(bus, *arguments, duration=120):
    return receiver.Emulator("--board", "dronecan-generic", "--at", ",".join(map(str, receiver.PLACE)), "--start",
                             receiver.START, "--model", "ideal", "--duration", duration, "--port", f"dronecan:{bus}",
                             *arguments)


def gets_an_id(bus):
    """Six, six and four bytes of the unique id; before it has one a node says nothing else."""
    bus.run(2.5)
    asked = bus.all(ALLOCATION)
    check(len(asked) >= 2 and all(t.source == 0 and t.fields()["first"] for t in asked),
          f"without a server: expected requests each 0.6 to 1 s, came {asked}")
    check(len(asked) == len(bus.came), "a node without an id said something else")
    bus.server = (b"", GIVEN_ID)
    bus.run(6, lambda: bus.all(NODE_STATUS))
    check(bus.granted, "the node did not get through with its unique id")
    check(bus.all(NODE_STATUS), "no NodeStatus within 6 s of a server")
    check(bus.all(NODE_STATUS)[0].source == GIVEN_ID, f"source {bus.all(NODE_STATUS)[0].source}, expected {GIVEN_ID}")


def is_well(bus):
    """NodeStatus each second, OK and operational, and the unique id that the server has with this node id."""
    bus.came.clear()
    bus.run(4.2)
    came = bus.all(NODE_STATUS)
    check(4 <= len(came) <= 5, f"{len(came)} NodeStatus in 4.2 s")
    for transfer in came:
        status = transfer.fields()
        check(status["health"] == 0 and status["mode"] == 0, f"NodeStatus {status}")
    info = bus.ask(GET_NODE_INFO, GIVEN_ID)
    check(info is not None, "no answer to GetNodeInfo")
    check(bytes(info["unique_id"]) == bus.granted[-1], "the unique id is not that of the allocation")
    check(bytes(info["name"]) == b"org.skyloop.gnss", f"name {bytes(info['name'])}")


def has_fixes(bus, rate):
    came = bus.all(FIX2)
    check(len(came) >= 0.9 * 4.2 * rate, f"{len(came)} Fix2 in 4.2 s, expected {rate} a second")
    check(can_bus.lost(came) == 0, f"{can_bus.lost(came)} Fix2 lost")
    fix = came[-1].fields()
    check(fix["status"] == 3, f"status {fix['status']}, expected 3")
    place = fix["latitude"] * 1e-8, fix["longitude"] * 1e-8, fix["height"] * 1e-3
    check(all(abs(a - b) < c for a, b, c in zip(place, receiver.PLACE, (1e-5, 1e-5, 1))), f"place {place}")
    check(fix["msl"] != fix["height"], "no undulation")
    check(len(fix["covariance"]) == 6, f"{len(fix['covariance'])} covariances, ArduPilot reads six")
    check(all(0 <= value < 100 for value in can_bus.accuracy(fix["covariance"])), f"covariances {fix['covariance']}")
    check(fix["standard"] == 2, "the time is not UTC")
    check(fix["timestamp"] > fix["gnss_timestamp"] > 0, "ArduPilot does not correct the time of such stamps")
    week, tow = divmod(fix["gnss_timestamp"] // 1000 - UNIX_OF_GPS_MS, WEEK_MS)
    check(week == 2408, f"week {week}, expected 2408")  # 2026-03-01 is its Sunday
    check(0 < tow < 600_000, f"time of week {tow} ms")
    check(bus.all(AUXILIARY) and bus.all(AUXILIARY)[-1].fields()["hdop"] < 5, "no HDOP by Auxiliary")
    check(not bus.all(GNSS_STATUS), "gnss.Status came, and gates arming from then on")


def is_configured(bus):
    """GPS_AUTO_CONFIG of 2 and more: no data counts until the parameter was read, set and saved."""
    for name in (b"GPS_TYPE", b"GPS1_TYPE", b"GPS_MB_ONLY_PORT"):
        told = bus.ask(GET_SET, GIVEN_ID, name=name)
        check(told is not None and bytes(told["name"]) == name, f"GetSet {name}: {told}")
    told = bus.ask(GET_SET, GIVEN_ID, name=b"GPS_TYPE", value_kind=1, value_integer=17)
    check(told["value_integer"] == 17, f"GPS_TYPE set: {told}")
    check(bus.ask(OPCODE, GIVEN_ID, opcode=0)["ok"] == 1, "save is refused")
    check(bus.ask(RESTART, GIVEN_ID, magic=1)["ok"] == 0, "a restart without the magic number")
    check(bus.ask(RESTART, GIVEN_ID, magic=MAGIC)["ok"] == 1, "a restart is refused")
    bus.came.clear()
    bus.granted.clear()
    bus.run(10, lambda: bus.all(NODE_STATUS))
    check(bus.granted and bus.all(NODE_STATUS), "the node did not come back")
    told = bus.ask(GET_SET, GIVEN_ID, name=b"GPS_TYPE")
    check(told["value_integer"] == 17, f"GPS_TYPE after a restart: {told}")
    told = bus.ask(GET_SET, GIVEN_ID, name=b"NO_SUCH")
    check(told is not None and not told["name"], f"a parameter that is not there: {told}")


def has_what_drivers_need(emulator, bus, begin=lambda: None, end=lambda: None):
    try:
        begin()
        gets_an_id(bus)
        is_well(bus)
        has_fixes(bus, 5)
        end()
        check(not bus.bad, f"damaged transfers: {bus.bad}")
    finally:
        bus.close()
    code = emulator.stop()
    check(code == 0, f"skyloop ended {code}: {emulator.log}")


def needs_of_ardupilot():
    with receiver.open_folder() as folder:
        with start(f"slcan:pty:{folder}/can0") as emulator:
            bus = can_bus.Bus(emulator.tty)

            def opens():
                answers = bus.open()
                check(answers == [b"\r", b"\a", b"\r", b"\r"], f"the adapter said {answers}")
            has_what_drivers_need(emulator, bus, begin=opens, end=lambda: is_configured(bus))


def by_multicast():
    """In a network of this process's own, where no other bus is disturbed."""
    with start("mcast:3") as emulator:
        has_what_drivers_need(emulator, can_bus.MulticastBus(3))


def in_own_network():
    """Plays by_multicast() in a network namespace; says so by name where there can be none."""
    own = ["unshare", "--user", "--map-root-user", "--net", "sh", "-c"]
    try:
        subprocess.run([*own, "ip link set lo up"], check=True, capture_output=True, timeout=20)
    except (OSError, subprocess.SubprocessError) as error:
        receiver.skip(f"no network namespace can be made for UDP multicast: {error}")
    command = shlex.join([sys.executable, __file__, "--inside"])
    subprocess.run([*own, f"ip link set lo up && exec {command}"], check=True, timeout=90)


def fifty_hertz(seconds):
    with receiver.open_folder() as folder:
        with start(f"slcan:pty:{folder}/can0", "--rate", 50, duration=seconds + 60) as emulator:
            bus = can_bus.Bus(emulator.tty)
            try:
                bus.open()
                bus.server = (b"", GIVEN_ID)
                bus.run(10, lambda: bus.all(FIX2))
                bus.came.clear()
                began = time.monotonic()
                bus.run(seconds)
                came, took = bus.all(FIX2), time.monotonic() - began
                check(abs(len(came) - 50 * took) <= 0.02 * 50 * took + 5, f"{len(came)} Fix2 in {took:.1f} s at 50 Hz")
                gone = can_bus.lost(came) + can_bus.lost(bus.all(AUXILIARY)) + can_bus.lost(bus.all(NODE_STATUS))
                check(gone == 0 and not bus.bad, f"{gone} transfers lost, damaged: {bus.bad[:5]}")
                print(f"{len(came)} Fix2 in {took:.1f} s, none lost")
            finally:
                bus.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=float(os.environ.get("SKYLOOP_SOAK_SECONDS", "5")),
                        help="how long 50 Hz are listened to")
    parser.add_argument("--part", choices=("needs", "rate", "multicast"), default="needs")
    parser.add_argument("--inside", action="store_true", help="of the network that multicast is played in")
    options = parser.parse_args()
    if options.inside:
        by_multicast()
    elif options.part == "needs":
        needs_of_ardupilot()
    elif options.part == "rate":
        fifty_hertz(options.seconds)
    else:
        in_own_network()


if __name__ == "__main__":
    main()
