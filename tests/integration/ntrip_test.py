"""NTRIP: a base's corrections for anybody, by the caster of a run, and those of any caster for a rover. RTKLIB's str2str is
the peer on both sides."""
import base64
import json
import pathlib
import re
import select
import shutil
import socket
import ssl
import subprocess
import threading
import time
import unittest

from session import Emulator, open_folder, skyloop
from tcp_client_test import connect

PLACE = (46.4775, 30.7326, 77.0)
USER = ("rover", "se cret@1")
GGA = re.compile(rb"\$G[NP]GGA,[^*\r\n]*\*[0-9A-F]{2}")

# Both begin when they are started: a base's data of another time would be of no use.
RUN = f"""[run]
sky_seed = 3
[trajectory]
kind = "fixed"
at = [{PLACE[0]}, {PLACE[1]}, {PLACE[2]}]
"""
BASE = RUN.replace("sky_seed", "receiver_seed = 1\nsky_seed") + """[[receiver]]
name = "base"
board = "ublox-f9p"
port = "tcp:0"
baud = 460800
[receiver.config]
CFG-TMODE-MODE = 2
CFG-TMODE-POS_TYPE = 1
CFG-TMODE-LAT = 464775000
CFG-TMODE-LON = 307326000
CFG-TMODE-HEIGHT = 7700
CFG-TMODE-FIXED_POS_ACC = 100
CFG-MSGOUT-RTCM_3X_TYPE1005_UART1 = 5
CFG-MSGOUT-RTCM_3X_TYPE1074_UART1 = 1
CFG-MSGOUT-RTCM_3X_TYPE1094_UART1 = 1
CFG-MSGOUT-RTCM_3X_TYPE1124_UART1 = 1
[caster]
listen = "127.0.0.1:0"
"""
USERS = f'[caster.users]\n{USER[0]} = "{USER[1]}"\n'
ROVER = RUN.replace("sky_seed", "receiver_seed = 2\nsky_seed") + '[[receiver]]\nname = "rover"\nboard = "ublox-f9p"\nport = "tcp:0"\nbaud = 460800\n'


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def request(mount, version, user=None, more=""):
    """What a client asks, written by hand."""
    text = f"GET /{mount} HTTP/1.{version - 1}\r\nUser-Agent: NTRIP test/1\r\n"
    if version == 2:
        text += "Host: 127.0.0.1\r\nNtrip-Version: Ntrip/2.0\r\n"
    if user:
        text += f"Authorization: Basic {base64.b64encode(':'.join(user).encode()).decode()}\r\n"
    return (text + more + "\r\n").encode()


class Heard:
    """A connection and what has come by it."""

    def __init__(self, connection):
        self.connection, self.data, self.ended = connection, b"", False

    def until(self, wanted, patience=40):
        end = time.monotonic() + patience
        while not wanted(self.data):
            if self.ended or time.monotonic() > end:
                raise AssertionError(f"not heard what was waited for; the last of it: {self.data[-300:]!r}")
            if select.select([self.connection], [], [], 0.2)[0]:
                piece = self.connection.recv(65536)
                self.ended = not piece
                self.data += piece
        return self.data


def answer_to(port, text):
    """All that the caster says until it hangs up."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
        connection.sendall(text)
        data = b""
        while piece := connection.recv(65536):
            data += piece
    return data


def unchunked(data):
    """The body of an answer in chunks, as far as it is whole."""
    body, rest = b"", data.split(b"\r\n\r\n", 1)[1]
    while b"\r\n" in rest:
        size, rest = rest.split(b"\r\n", 1)
        count = int(size, 16)
        if len(rest) < count + 2:
            break
        body, rest = body + rest[:count], rest[count + 2:]
    return body


def messages_in(data):
    """Numbers of the RTCM messages of a stream, by skyloop's own reading, and how many bytes are in none."""
    with open_folder() as folder:
        path = pathlib.Path(folder, "heard.rtcm")
        path.write_bytes(data)
        told = skyloop("decode", "--format", "json", path)
    lines = map(json.loads, told.stdout.splitlines())
    numbers = [int(line["id"]) for line in lines if line.get("protocol") == "rtcm3"]
    return numbers, int(re.search(r"(\d+) of \d+ bytes skipped", told.stderr)[1])


def is_rtk(data):
    """A GGA sentence tells RTK, fixed or float."""
    return any(sentence.split(b",")[6] in (b"4", b"5") for sentence in GGA.findall(data))


class FakeCaster:
    """`play` is called with each connection and its request, on a thread of its own."""

    def __init__(self, play, context=None):
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port, self.play, self.context = self.server.getsockname()[1], play, context
        self.requests = []
        self.thread = threading.Thread(target=self.work, daemon=True)
        self.thread.start()

    def work(self):
        while True:
            try:
                connection, _ = self.server.accept()
            except OSError:
                return
            threading.Thread(target=self.serve, args=(connection,), daemon=True).start()

    def serve(self, connection):
        try:
            if self.context:
                connection = self.context.wrap_socket(connection, server_side=True)
            connection.settimeout(20)
            text = b""
            while b"\r\n\r\n" not in text:
                text += connection.recv(4096) or b"\r\n\r\n"
            self.requests.append(text)
            self.play(connection, text)
        except (OSError, AssertionError):
            pass  # the client has gone
        finally:
            connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.close()


class FolderTest(unittest.TestCase):
    """A test with a folder for its scenarios."""

    def setUp(self):
        folder = open_folder()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def scenario(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path


class NtripTest(FolderTest):
    def base(self, more="", *arguments):
        """A base with its caster, and the caster's port."""
        base = Emulator(self.scenario("base.toml", BASE + more), *arguments)
        self.addCleanup(base.__exit__)
        return base, int(base.said(r"^caster: 127\.0\.0\.1:(\d+) \("))

    def rover(self, uri, *arguments, text=ROVER):
        rover = Emulator(self.scenario("rover.toml", text), "--corrections", uri, *arguments)
        self.addCleanup(rover.__exit__)
        return rover

    def str2str(self, *arguments):
        peer = subprocess.Popen(["str2str", *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE)
        self.addCleanup(peer.communicate, timeout=20)
        self.addCleanup(peer.terminate)
        return peer

    def wait_for(self, condition, patience=40):
        end = time.monotonic() + patience
        while not condition():
            self.assertLess(time.monotonic(), end, "it does not come true")
            time.sleep(0.1)

    def test_a_rover_becomes_rtk_by_a_base(self):
        _, port = self.base(USERS)
        uri = f"ntrip://{USER[0]}:se%20cret%401@127.0.0.1:{port}/base"
        rover = self.rover(uri, "--record", self.folder / "run")
        with connect(rover.tty) as connection:
            Heard(connection).until(is_rtk)
        self.assertEqual(rover.stop(), 0)
        self.assertIn(f"port 1: ntrip://127.0.0.1:{port}/base (ntrip)", rover.log)
        self.assertNotIn("cret", rover.log)
        text = (self.folder / "run" / "run.json").read_text(encoding="utf-8")
        self.assertNotIn("cret", text)
        corrections = json.loads(text)["ports"][1]["corrections"]
        self.assertTrue(corrections["connected"])
        self.assertEqual((corrections["ntrip_version"], corrections["connections"]), (2, 1))
        self.assertGreater(corrections["messages"], 2)
        # What a caster has brought is heard again without one.
        skyloop("simulate", self.folder / "rover.toml", "--set", f"receiver.0.corrections={uri}", "--repeat", self.folder / "run",
                "--duration", 8, "--out", self.folder / "again")
        again = json.loads((self.folder / "again" / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(again["epochs"], 8)

    @needs("str2str")
    def test_str2str_hears_the_caster(self):
        _, port = self.base(USERS.replace(" ", "").replace("@", "_"))
        heard = self.folder / "heard.rtcm"
        self.str2str("-in", f"ntrip://rover:secret_1@127.0.0.1:{port}/base", "-out", f"file://{heard}")
        self.wait_for(lambda: heard.exists() and heard.stat().st_size > 4000)
        numbers, skipped = messages_in(heard.read_bytes())
        self.assertLessEqual({1005, 1074}, set(numbers))
        self.assertLess(skipped, 700)  # the last frame may be cut

    @needs("str2str")
    def test_str2str_casts_for_a_rover(self):
        _, port = self.base("")
        relay = free_port()
        self.str2str("-in", f"ntrip://127.0.0.1:{port}/base", "-out", f"ntripc://me:pw@:{relay}/RELAY")
        rover = self.rover(f"ntrip://me:pw@127.0.0.1:{relay}/RELAY", "--record", self.folder / "run")
        with connect(rover.tty) as connection:
            Heard(connection).until(is_rtk, 60)
        self.assertEqual(rover.stop(), 0)
        corrections = json.loads((self.folder / "run" / "run.json").read_text(encoding="utf-8"))["ports"][1]["corrections"]
        self.assertEqual(corrections["ntrip_version"], 1)

    def test_version_2_comes_in_chunks(self):
        _, port = self.base()
        with socket.create_connection(("127.0.0.1", port)) as connection:
            connection.sendall(request("base", 2))
            data = Heard(connection).until(lambda data: len(data) > 4000)
        head = data.split(b"\r\n\r\n")[0].decode()
        self.assertTrue(head.startswith("HTTP/1.1 200 OK\r\n"))
        for header in ("Ntrip-Version: Ntrip/2.0", "Content-Type: gnss/data", "Transfer-Encoding: chunked"):
            self.assertIn(header, head)
        numbers, skipped = messages_in(unchunked(data))
        self.assertEqual(skipped, 0)
        self.assertIn(1074, numbers)

    def test_the_source_table_tells_what_is_sent(self):
        _, port = self.base(USERS)
        with socket.create_connection(("127.0.0.1", port)) as connection:
            connection.sendall(request("base", 1, USER))
            Heard(connection).until(lambda data: data.count(b"\xd3\x00\x13\x3e\xd0") >= 3, 60)
            for version, begin in ((1, b"SOURCETABLE 200 OK\r\n"), (2, b"HTTP/1.1 200 OK\r\n")):
                told = answer_to(port, request("", version))
                self.assertTrue(told.startswith(begin), told)
                self.assertTrue(told.endswith(b"ENDSOURCETABLE\r\n"), told)
        fields = told.split(b"\r\n\r\n")[1].split(b"\r\n")[0].decode().split(";")
        self.assertEqual(fields[:4], ["STR", "base", "base (ublox-f9p)", "RTCM 3.3"])
        self.assertEqual(fields[4], "1005(5),1074(1),1094(1),1124(1)")
        self.assertEqual(fields[5:8], ["2", "GPS+GAL+BDS", "none"])
        self.assertEqual(fields[9:13], ["46.48", "30.73", "0", "0"])
        self.assertEqual(fields[15], "B")
        self.assertGreater(int(fields[17]), 1000)

    def test_refusals(self):
        base, port = self.base(USERS)
        for version in (1, 2):
            for user in (None, ("rover", "wrong"), ("other", USER[1])):
                told = answer_to(port, request("base", version, user))
                self.assertIn(b" 401 Unauthorized\r\n", told)
                self.assertIn(b"\r\nWWW-Authenticate: Basic realm=", told)
        self.assertTrue(answer_to(port, request("bass", 2)).startswith(b"HTTP/1.1 404 Not Found"))
        self.assertTrue(answer_to(port, request("bass", 1)).startswith(b"SOURCETABLE 200 OK"))
        self.assertTrue(answer_to(port, b"\x00\xff\r\n\r\n").startswith(b"HTTP/1.1 400 "))
        self.assertTrue(answer_to(port, request("base", 2, None, "A: " + 9000 * "a" + "\r\n")).startswith(b"HTTP/1.1 431 "))
        self.assertEqual(base.stop(), 0)

    def test_a_client_tells_where_it_is_and_calls_again(self):
        told = []

        def play(connection, _):
            connection.sendall(b"ICY 200 OK\r\n\r\n")
            heard = Heard(connection)
            try:
                told.append(GGA.findall(heard.until(lambda data: GGA.search(data)))[0])
            except AssertionError:
                pass  # hung up without a word; the next one comes

        with FakeCaster(play) as caster:
            rover = self.rover(f"ntrip://127.0.0.1:{caster.port}/M")
            self.wait_for(lambda: len(told) >= 2)
            rover.said(r"(/M: the caster has hung up; trying again)")
            self.assertEqual(rover.stop(), 0)
            self.assertIn(b"Ntrip-Version: Ntrip/2.0\r\n", caster.requests[0])
            self.assertIn(b"\r\nNtrip-GGA: $GNGGA,", caster.requests[-1])
        fields = told[0].split(b",")
        self.assertEqual((fields[2][:6], fields[4][:7]), (b"4628.6", b"03043.9"))

    def test_tls(self):
        key, certificate = self.folder / "key.pem", self.folder / "cert.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate, "-days", "1",
                        "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"], check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)

        def play(connection, _):
            connection.sendall(b"HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nContent-Type: gnss/data\r\n\r\nabc")
            Heard(connection).until(lambda _: False, 20)

        with FakeCaster(play, context) as caster:
            uri = f"ntrips://localhost:{caster.port}/M"
            stranger = self.rover(uri)
            stranger.said(r"(TLS: certificate verify failed)")
            stranger.stop()
            trusted = Emulator(self.folder / "rover.toml", "--corrections", uri, "--record", self.folder / "run",
                               env={"SSL_CERT_FILE": str(certificate)})
            self.addCleanup(trusted.__exit__)
            self.wait_for(lambda: caster.requests)
            time.sleep(1)
            trusted.stop()
            other = Emulator(self.folder / "rover.toml", "--corrections", uri.replace("localhost", "127.0.0.1"),
                             env={"SSL_CERT_FILE": str(certificate)})
            self.addCleanup(other.__exit__)
            other.said(r"(TLS: certificate verify failed)")
            other.stop()
        run = json.loads((self.folder / "run" / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(run["ports"][1]["corrections"]["bytes"], 3)

    def test_what_cannot_be_is_refused(self):
        rover = self.scenario("rover.toml", ROVER)

        def refused(*arguments, command="run"):
            done = skyloop(command, *arguments, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertNotIn("secret", done.stderr)
            return done.stderr

        self.assertIn("corrections 'ntrip://h': the mount point is missing; expected ntrip://[USER:PASSWORD@]HOST[:PORT]/MOUNT",
                      refused(rover, "--corrections", "ntrip://me:secret@h"))
        self.assertIn("has no port 'uart9'", refused(rover, "--corrections", "uart9=ntrip://me:secret@h/M"))
        wanted = "need time that passes; expected skyloop run, without --speed max"
        self.assertIn(wanted, refused(rover, "--corrections", "ntrip://me:secret@h/M", "--speed", "max"))
        self.assertIn(wanted, refused(rover, "--set", "receiver.0.corrections=ntrip://me:secret@h/M", "--duration", 5, "--out",
                                      self.folder / "out", command="simulate"))
        self.assertIn("no receiver of this run can send RTCM", refused("--board", "ublox-m8", "--port", "tcp:0", "--caster", "0"))
        self.assertIn("expected [HOST:]PORT", refused(rover, "--caster", "here"))
        deaf = Emulator("--board", "ublox-m8", "--port", "tcp:0", "--corrections", "uart2=ntrip://me:secret@127.0.0.1:1/M")
        self.addCleanup(deaf.__exit__)
        deaf.said(r"(ublox-m8 takes no corrections)")
        deaf.said(r"(ntrip://127\.0\.0\.1:1/M: cannot be reached: Connection refused; trying again)")
        deaf.stop()
        self.assertNotIn("secret", deaf.log)


if __name__ == "__main__":
    unittest.main(verbosity=2)
