"""`skyloop fetch-nav` against a server that has the paths of the mirrors, and `--nav auto`, which takes what the cache has."""
import datetime
import gzip
import http.server
import math
import os
import pathlib
import shutil
import socket
import ssl
import subprocess
import threading
import tomllib
import unittest

from session import ROOT, open_folder, skyloop

DAY = datetime.date(2024, 3, 5)
NAME = "BRDC_20240650000_01D_MN.rnx.gz"
HEADER = "     3.04           N: GNSS NAV DATA    M: MIXED            RINEX VERSION / TYPE\n" + " " * 60 + "END OF HEADER\n"


def gps_record(number, toe):
    """A record of a satellite on a circular orbit, in the six planes of the constellation."""
    week, tow = divmod((toe - datetime.datetime(1980, 1, 6)).total_seconds(), 604800)
    axis = 26559710.0
    motion = math.sqrt(3.986005e14 / axis**3)
    seconds = (toe - datetime.datetime(2024, 3, 3)).total_seconds()
    plane, place = number % 6, number // 6
    anomaly = math.remainder(place * 2 * math.pi / 5.3 + plane * 0.5 + motion * seconds, 2 * math.pi)
    node = math.remainder(plane * math.pi / 3, 2 * math.pi)
    rows = [(1, 0, 0, anomaly), (0, 1e-3, 0, math.sqrt(axis)), (tow, 0, node, 0), (0.96, 0, 0, 0), (0, 1, week, 0), (2, 0, 0, 1), (tow - 3600, 4)]
    first = f"G{number:02} {toe:%Y %m %d %H %M %S}" + "".join(f"{0:19.12E}" for _ in range(3))
    return "\n".join([first, *("    " + "".join(f"{value:19.12E}" for value in row) for row in rows), ""])


def navigation(day, hours=range(0, 24, 2), satellites=31):
    """The text of the file of a day."""
    midnight = datetime.datetime.combine(day, datetime.time())
    return HEADER + "".join(gps_record(number, midnight + datetime.timedelta(hours=hour))
                            for hour in hours for number in range(1, satellites + 1))


def packed(day, **how):
    return gzip.compress(navigation(day, **how).encode("ascii"), mtime=0)


class Server:
    """Has `files` by path: bytes, a number (a status), a text (another address), or (bytes, how many are promised)."""

    def __init__(self, context=None):
        self.files, self.asked = {}, []
        server = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                server.asked.append(self.path)
                self.answer(server.files.get(self.path, 404))

            def answer(self, file):
                if isinstance(file, (int, str)):
                    self.send_response(file if isinstance(file, int) else 302)
                    if isinstance(file, str):
                        self.send_header("Location", file)
                    self.send_header("Content-Length", "0")
                    self.end_headers()
                    return
                body, promised = file if isinstance(file, tuple) else (file, len(file))
                self.send_response(200)
                self.send_header("Content-Length", str(promised))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        self.http = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        if context:
            self.http.socket = context.wrap_socket(self.http.socket, server_side=True)
        self.thread = threading.Thread(target=self.http.serve_forever, daemon=True)
        self.thread.start()
        self.base = f"http{'s' if context else ''}://127.0.0.1:{self.http.server_address[1]}"

    def close(self):
        self.http.shutdown()
        self.http.server_close()
        self.thread.join()


def mirror_patterns():
    with open(ROOT / "data/navigation_mirrors.toml", "rb") as file:
        mirrors = tomllib.load(file)["mirror"]
    return {mirror["name"]: mirror["addresses"] for mirror in mirrors}


def path_of(pattern):
    """What stands behind the host, on the day."""
    for mark, text in (("{year}", "2024"), ("{yy}", "24"), ("{doy}", "065")):
        pattern = pattern.replace(mark, text)
    return "/" + pattern.split("/", 3)[3]


PATHS = [path_of(pattern) for patterns in mirror_patterns().values() for pattern in patterns]


class WithServer(unittest.TestCase):
    """A server, a cache, and all mirrors led there."""

    def setUp(self):
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.server = Server()
        self.addCleanup(self.server.close)
        patterns = [pattern for patterns in mirror_patterns().values() for pattern in patterns]
        here = ["/".join([self.server.base, pattern.split("/", 3)[3]]) for pattern in patterns]
        self.env = {name: value for name, value in os.environ.items() if not name.lower().endswith("_proxy")}
        self.env |= {"XDG_CACHE_HOME": str(self.folder / "cache"), "HOME": str(self.folder), "SKYLOOP_NAV_MIRRORS": " ".join(here)}
        self.cached = self.folder / "cache/skyloop/navigation" / NAME

    def fetch(self, *arguments, code=0, date=DAY, **env):
        done = skyloop("fetch-nav", *(["--date", date] if date else []), *arguments, check=False, env={**self.env, **env})
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def refused(self, *arguments, code=1, **env):
        """The one line that says why there is no file."""
        done = self.fetch(*arguments, code=code, **env)
        self.assertEqual((done.stdout, done.stderr.count("\n")), ("", 1), done.stderr)
        self.assertFalse(self.cached.exists())
        return done.stderr


class FetchNav(WithServer):
    def test_found_and_cached(self):
        self.server.files[PATHS[0]] = packed(DAY)
        done = self.fetch()
        self.assertEqual(done.stdout, f"{self.cached}\n")
        self.assertIn("2024-03-05: 31 satellites of gps, 372 records, from http://127.0.0.1", done.stderr)
        self.assertEqual(self.cached.read_bytes(), packed(DAY))
        self.assertEqual(self.server.asked, PATHS[:1])
        done = self.fetch()
        self.assertEqual((done.stdout, self.server.asked), (f"{self.cached}\n", PATHS[:1]), "no second request")
        self.assertIn("from the cache", done.stderr)
        self.assertEqual([path.name for path in self.cached.parent.iterdir()], [NAME])

    def test_to_a_folder(self):
        self.server.files[PATHS[0]] = packed(DAY)
        done = self.fetch("--to", self.folder / "here/there")
        self.assertEqual(done.stdout, f"{self.folder}/here/there/{NAME}\n")
        self.assertEqual((self.folder / "here/there" / NAME).read_bytes(), self.cached.read_bytes())

    def test_moved(self):
        self.server.files[PATHS[0]] = "/elsewhere/" + NAME
        self.server.files["/elsewhere/" + NAME] = packed(DAY)
        self.fetch()
        self.assertEqual(self.server.asked, [PATHS[0], "/elsewhere/" + NAME])
        self.assertTrue(self.cached.exists())

    def test_moved_in_a_circle_and_to_what_is_no_web(self):
        self.server.files |= {PATHS[0]: PATHS[0], PATHS[1]: "file:///etc/hostname"}
        told = self.refused()
        self.assertIn(f"{PATHS[0]}: Maximum (5) redirects followed", told)
        self.assertRegex(told, rf"{PATHS[1]}: Protocol .file. (not supported|disabled)")

    def test_gone_from_all_but_the_last(self):
        self.server.files |= {path: status for path, status in zip(PATHS, (404, 410, 403, 500, 404))}
        self.server.files[PATHS[-1]] = packed(DAY)
        self.fetch()
        self.assertEqual(self.server.asked, PATHS)

    def test_gone_from_all(self):
        self.assertEqual(self.refused(), "skyloop: no navigation file of 2024-03-05: "
                         + "; ".join(f"{self.server.base}{path}: 404" for path in PATHS) + "\n")

    def test_cut_short(self):
        whole = packed(DAY)
        self.server.files |= {PATHS[0]: (whole[:3000], len(whole)), PATHS[1]: whole[:3000], PATHS[2]: b"",
                              PATHS[3]: packed(DAY, hours=range(0, 12, 2)), PATHS[4]: whole[:-1]}
        told = self.refused()
        self.assertRegex(told, rf"{PATHS[0]}: (transfer closed|end of response) with \d+ bytes (remaining|missing)")
        self.assertIn(f"{PATHS[1]}: ", told)
        self.assertIn(f"{PATHS[2]}: found ''; expected a file packed by gzip", told)
        self.assertIn(f"{PATHS[3]}: ends at 2024-03-05T12:00:00Z; expected the whole day", told)
        self.assertIn(f"{PATHS[4]}: ", told)

    def test_damaged(self):
        whole = bytearray(packed(DAY))
        whole[-6] ^= 1  # of its CRC-32
        self.server.files[PATHS[0]] = bytes(whole)
        self.assertIn(f"{PATHS[0]}: ", self.refused())

    def test_something_else(self):
        self.server.files |= {PATHS[0]: b"<!DOCTYPE html><title>Earthdata Login</title>", PATHS[1]: gzip.compress(b"<html>"),
                              PATHS[2]: packed(DAY, satellites=12)}
        told = self.refused()
        self.assertIn(f"{PATHS[0]}: found '<!DOCTYPE html><titl'; expected a file packed by gzip", told)
        self.assertIn(f"{PATHS[1]}:1: ", told)
        self.assertIn(f"{PATHS[2]}: has orbits of 12 GPS satellites at 00:00; expected at least 24", told)

    def test_wrong_day(self):
        self.server.files[PATHS[0]] = packed(DAY - datetime.timedelta(days=1))
        self.assertIn(f"{PATHS[0]}: its records are of 2024-03-04; expected 2024-03-05", self.refused())

    def test_no_network(self):
        with socket.socket() as closed:
            closed.bind(("127.0.0.1", 0))  # and does not listen
            nobody = f"http://127.0.0.1:{closed.getsockname()[1]}/{{year}}{{doy}}.gz"
            told = self.refused("--mirror", nobody, "--mirror", "http://nowhere.invalid/{doy}.gz", "--mirror", nobody + "/again")
        self.assertRegex(told, r"^skyloop: no network: 127\.0\.0\.1:\d+, nowhere\.invalid cannot be reached \(.*nowhere\.invalid.*\)\n$")

    @unittest.skipUnless(shutil.which("openssl"), "openssl is not installed")
    def test_a_stranger_by_https(self):
        key, certificate = self.folder / "key.pem", self.folder / "cert.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate, "-days", "1",
                        "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1"], check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key)
        stranger = Server(context)
        self.addCleanup(stranger.close)
        stranger.files["/2024065.gz"] = packed(DAY)
        told = self.refused("--mirror", stranger.base + "/{year}{doy}.gz")
        self.assertRegex(told, r"2024065\.gz: server certificate verification failed")
        self.assertEqual(stranger.asked, [])

    def test_a_cached_file_needs_no_network(self):
        self.cached.parent.mkdir(parents=True)
        self.cached.write_bytes(packed(DAY))
        self.fetch(SKYLOOP_NAV_MIRRORS="http://nowhere.invalid/{doy}.gz")
        self.assertEqual(self.server.asked, [])

    def test_a_broken_file_of_the_cache_is_fetched_anew(self):
        self.cached.parent.mkdir(parents=True)
        self.cached.write_bytes(packed(DAY)[:500])
        self.server.files[PATHS[0]] = packed(DAY)
        self.assertIn("it is fetched anew", self.fetch().stderr)
        self.assertEqual(self.cached.read_bytes(), packed(DAY))

    def test_a_cache_that_cannot_be_written(self):
        self.server.files[PATHS[0]] = packed(DAY)
        (self.folder / "file").write_text("")
        wrong = {"XDG_CACHE_HOME": str(self.folder / "file")}
        self.assertIn("the cache cannot be written", self.refused(**wrong))
        self.assertEqual(self.server.asked, [])
        done = self.fetch("--to", self.folder, **wrong)
        self.assertEqual((done.stdout, done.stderr.count("the cache cannot be written")), (f"{self.folder}/{NAME}\n", 1))
        self.assertEqual((self.folder / NAME).read_bytes(), packed(DAY))
        self.assertIn("neither XDG_CACHE_HOME nor HOME", self.refused(XDG_CACHE_HOME="", HOME=""))

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_a_read_only_cache(self):
        self.server.files[PATHS[0]] = packed(DAY)
        self.cached.parent.mkdir(parents=True)
        self.cached.parent.chmod(0o555)
        self.addCleanup(self.cached.parent.chmod, 0o755)
        self.assertIn("the cache cannot be written", self.refused())

    def test_a_folder_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        self.assertIn("cannot be made a folder", self.refused("--to", self.folder / "file/below"))
        self.assertEqual(self.server.asked, [])

    def test_a_day_that_is_not_over(self):
        today = datetime.datetime.now(datetime.timezone.utc).date()
        path = f"/{today:%Y%j}.gz"
        mirror = self.server.base + "/{year}{doy}.gz"
        self.server.files[path] = packed(today, hours=[0])
        done = self.fetch("--mirror", mirror, date=None)
        self.assertIn(f"records up to {today}T02:00:00Z, from", done.stderr)
        self.server.files[path] = packed(today, hours=[0, 2])
        self.assertIn(f"records up to {today}T04:00:00Z, from", self.fetch("--mirror", mirror, date=None).stderr)
        self.server.files[path] = 404
        done = self.fetch("--mirror", mirror, date=None)
        self.assertIn(f"records up to {today}T04:00:00Z, from the cache", done.stderr)
        self.assertIn(f"{path}: 404", done.stderr)
        self.assertEqual(self.server.asked, [path] * 3)

    def test_mirrors_by_name_and_words_that_are_none(self):
        self.assertIn("--mirror 'bgk'; expected bkg, ign, cddis or an address; did you mean 'bkg'?", self.refused("--mirror", "bgk", code=2))
        self.assertIn("SKYLOOP_NAV_MIRRORS: 'ftp://x/{doy}'; expected an address", self.refused(code=2, SKYLOOP_NAV_MIRRORS="ftp://x/{doy}"))
        self.assertIn("--mirror 'http://x/{day}'; expected", self.refused("--mirror", "http://x/{day}", code=2))
        self.assertIn("--date '2024-02-30'; expected a day such as 2023-01-01", self.refused(code=2, date="2024-02-30"))
        self.assertIn("--date 2150-01-01: lies ahead; expected a day up to", self.refused(code=2, date="2150-01-01"))
        self.assertEqual(self.server.asked, [])


class NavAuto(WithServer):
    """Runs take the file of the start's day, without the network."""

    def setUp(self):
        super().setUp()
        self.cached.parent.mkdir(parents=True)
        self.cached.write_bytes(packed(DAY))

    def run_at(self, start, *arguments):
        done = skyloop("simulate", "--nav", "auto", "--start", start, "--duration", 5, "--out", self.folder / "out", *arguments, env=self.env)
        self.assertEqual(self.server.asked, [])
        return done.stderr, (self.folder / "out/fixes.csv").read_text(encoding="ascii")

    def test_the_cached_file(self):
        told, fixes = self.run_at("2024-03-05T12:00:00Z")
        self.assertIn(f"navigation: {NAME}, of the cache", told)
        self.assertNotIn("warning", told)
        named = skyloop("simulate", "--nav", self.cached, "--start", "2024-03-05T12:00:00Z", "--duration", 5, "--out", self.folder / "named")
        self.assertEqual(fixes, (self.folder / "named/fixes.csv").read_text(encoding="ascii"))
        self.assertNotIn("of the cache", named.stderr)

    def test_the_nominal_sky(self):
        told, fixes = self.run_at("2024-03-06T12:00:00Z")
        self.assertRegex(told, r"the sky is the nominal one: .*BRDC_20240660000_01D_MN\.rnx\.gz: no navigation file of this day; "
                               r"skyloop fetch-nav --date 2024-03-06 gets it")
        skyloop("simulate", "--start", "2024-03-06T12:00:00Z", "--duration", 5, "--out", self.folder / "nominal")
        self.assertEqual(fixes, (self.folder / "nominal/fixes.csv").read_text(encoding="ascii"))

    def test_a_file_that_ends_before_the_start(self):
        self.cached.write_bytes(packed(DAY, hours=[0, 2]))
        told, _ = self.run_at("2024-03-05T12:00:00Z")
        self.assertRegex(told, rf"the sky is the nominal one: .*{NAME}: ends before the start of the run; skyloop fetch-nav")

    def test_a_key_of_a_scenario(self):
        scenario = self.folder / "auto.toml"
        scenario.write_text('[sky]\nnavigation = "auto"\n[run]\nstart = 2024-03-05T12:00:00Z\n', encoding="utf-8")
        self.assertIn(NAME, skyloop("check", scenario, env=self.env).stdout)
        digest = [skyloop("check", scenario, "--verbose", env=env).stdout for env in (self.env, {**self.env, "XDG_CACHE_HOME": "/nowhere"})]
        self.assertNotEqual(*digest)
        scenario.write_text('[sky]\nnavigation = ["auto", "x.rnx"]\n', encoding="utf-8")
        self.assertIn('sky.navigation: has files beside "auto"; expected either', skyloop("check", scenario, check=False, env=self.env).stderr)
        refused = skyloop("check", "--nav", "auto", "--rebase-nav", check=False, env=self.env)
        self.assertIn('"auto" takes those of the run\'s own day', refused.stderr)

    def test_a_campaign_names_its_file(self):
        scenario = self.folder / "many.toml"
        scenario.write_text('[sky]\nnavigation = "auto"\n[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 2\n', encoding="utf-8")
        done = skyloop("campaign", "plan", scenario, "--seeds", "1-2", check=False, env=self.env)
        self.assertEqual(done.returncode, 2)
        self.assertIn('many.toml:2:14: sky.navigation: "auto" is what the cache of a machine holds; expected the path', done.stderr)

    def test_solve(self):
        skyloop("simulate", "--nav", self.cached, "--start", "2024-03-05T12:00:00Z", "--duration", 5, "--out", self.folder / "seen")
        observations = self.folder / "seen/observations.rnx"
        done = skyloop("solve", observations, "--nav", "auto", env=self.env)
        self.assertEqual(done.stdout, skyloop("solve", observations, "--nav", self.cached).stdout)
        self.assertIn("5 with a fix", done.stderr)
        self.cached.unlink()
        done = skyloop("solve", observations, "--nav", "auto", check=False, env=self.env)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^skyloop: .*BRDC_20240650000_01D_MN\.rnx\.gz: no navigation file of this day; skyloop fetch-nav --date 2024-03-05 gets it\n$")
        done = skyloop("solve", observations, "--nav", "auto", "--nav", "x", check=False, env=self.env)
        self.assertIn("--nav auto: has files beside it; expected either", done.stderr)


if __name__ == "__main__":
    unittest.main()
