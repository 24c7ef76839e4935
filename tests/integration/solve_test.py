"""`skyloop solve`: fixes of observation files, where they go and what is told of what cannot be solved."""
import csv
import io
import pathlib
import re
import socket
import subprocess
import unittest

from session import SHARED, SKYLOOP, open_folder, skyloop

VELOCITY = ("vel_north_mps", "vel_east_mps", "vel_down_mps", "speed_mps", "course_deg")


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def solved(folder, *arguments):
    """The rows for the observations of a run, and what was said beside them."""
    done = skyloop("solve", folder / "observations.rnx", *arguments)
    return rows_of(done.stdout), done.stderr


class Solve(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = open_folder()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        scenario = cls.folder / "moves.toml"
        scenario.write_text('[run]\nstart = 2026-03-01T12:00:00Z\n[sky]\nconstellations = ["gps"]\n[trajectory]\nkind = "circle"\ncentre = [46.5, 30.7, 50]\n'
                            'radius_m = 200\nspeed_mps = 20\n', encoding="utf-8")
        skyloop("simulate", scenario, "--board", "ublox-f9p", "--duration", 5, "--out", cls.folder)
        cls.nav = ["--nav", cls.folder / "navigation.rnx"]

    def rewrite(self, change, run=None):
        """A folder with the observations of a run, the common one by default, as `change` leaves their lines."""
        temporary = open_folder()
        self.addCleanup(temporary.cleanup)
        lines = ((run or self.folder) / "observations.rnx").read_text(encoding="ascii").splitlines(keepends=True)
        folder = pathlib.Path(temporary.name)
        (folder / "observations.rnx").write_text("".join(map(change, lines)), encoding="ascii")
        return folder

    def test_standard_output_keeps_what_it_holds(self):
        command = [SKYLOOP, "solve", self.folder / "observations.rnx", *self.nav, "--quiet"]
        path = self.folder / "log.csv"
        for mode in ("w", "a"):
            path.write_text("kept\n" if mode == "a" else "", encoding="ascii")
            with open(path, mode, encoding="ascii") as log:
                if mode == "w":
                    log.write("kept\n")
                    log.flush()
                subprocess.run(command, stdout=log, check=True, timeout=60)
                log.write("tail\n")
            lines = path.read_text(encoding="ascii").splitlines()
            self.assertEqual((lines[0], lines[1][:8], len(lines), lines[-1]), ("kept", "time_utc", 8, "tail"), mode)

    def test_standard_output_may_be_a_socket(self):
        ours, theirs = socket.socketpair()
        with ours, theirs:
            subprocess.run([SKYLOOP, "solve", self.folder / "observations.rnx", *self.nav], stdout=theirs, check=True,
                           stderr=subprocess.DEVNULL, timeout=60)
            theirs.close()
            with ours.makefile(encoding="ascii") as stream:
                self.assertEqual(len(rows_of(stream.read())), 5)

    def test_a_velocity_is_told_where_one_was_measured(self):
        rows, _ = solved(self.folder, *self.nav)
        self.assertTrue(all(abs(float(row["speed_mps"]) - 20) < 1 for row in rows))
        still = self.rewrite(lambda line: re.sub(r" D(?=\d)", " X", line) if "OBS TYPES" in line else line)
        rows, _ = solved(still, *self.nav)
        self.assertEqual(len(rows), 5)
        for row in rows:
            self.assertEqual(row["fix_type"], "3d")
            self.assertEqual({row[name] for name in VELOCITY}, {""})
        # What reads such tables knows that an empty cell tells nothing.
        path = still / "solved.csv"
        solved(still, *self.nav, "--out", path)
        self.assertEqual(skyloop("solve", still / "observations.rnx", *self.nav, "--out", "-").stdout, path.read_text())
        track = skyloop("trajectory", path).stdout
        self.assertIn("velocity: by the places of the rows", " ".join(track.split()))
        self.assertIn("5 fixes", skyloop("compare", path, path).stdout)

    def test_systems_are_solved_whatever_their_signals_are(self):
        # L2 is left of a receiver of two carriers.
        other = self.rewrite(lambda line: re.sub(r" [CLDS]1C", " X1C", line) if "OBS TYPES" in line else line)
        every, _ = solved(other, *self.nav)
        named, text = solved(other, *self.nav, "--systems", "gps")
        self.assertEqual(named, every)
        self.assertGreater(int(named[0]["satellites_used"]), 4)
        self.assertNotIn("no observations", text)
        _, text = solved(other, *self.nav, "--systems", "gps,galileo")
        self.assertIn("no observations of galileo", text)

    def test_files_without_strengths_are_solved_beyond_their_first_records(self):
        hours = self.folder / "hours"
        skyloop("simulate", self.folder / "moves.toml", "--board", "ublox-f9p", "--rate", 0.02, "--duration", 3 * 3600, "--out", hours)

        def without_strengths(line):
            if "OBS TYPES" in line:
                return re.sub(r" S(?=\d)", " X", line)
            if re.match(r"[A-Z]\d\d", line):
                return re.sub(r"(\.\d{3}.)\d", r"\1 ", line)
            return line

        rows, _ = solved(self.rewrite(without_strengths, hours), "--nav", hours / "navigation.rnx")
        self.assertGreater(len(rows), 200)
        self.assertEqual({row["fix_type"] for row in rows}, {"3d"})

    def test_orbits_of_another_day_are_told_of(self):
        path = self.folder / "other_day.sp3"
        start = "2023  1  1  0 {:2d}  0.00000000"
        head = ["#dP" + start.format(0) + "      12 ORBIT IGS20 FIT  IGS", "## 2243      0.00000000   300.00000000 59945 0.0",
                "+    1   G01", "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"]
        rows = [line for k in range(12) for line in
                ("*  " + start.format(5 * k), f"PG01{15000.0 + k:14.6f}{10000.0:14.6f}{19000.0:14.6f}{100.0:14.6f}")]
        path.write_text("\n".join([*head, *rows, "EOF", ""]), encoding="ascii")
        rows, text = solved(self.folder, "--sp3", path)
        self.assertEqual({row["fix_type"] for row in rows}, {"none"})
        self.assertRegex(text, "are not all in the time of the precise orbits, 2022-12-31T23:59:42Z to 2023-01-01T00:54:42Z")
        self.assertIn("no orbits of gps at the time of the observations", text)

    def test_speaks_of_no_run(self):
        folder = SHARED / "receivers/hk_tst_static_20200603"
        if not folder.is_dir():
            self.skipTest(f"shared data absent: {folder}")
        done = skyloop("solve", folder / "2020_06_03_TST_03.obs.gz", "--nav", folder / "hksc155c.20b", "--out", "/dev/null")
        self.assertIn("986 with a fix", done.stderr)
        self.assertNotIn("the run", done.stderr)
        self.assertNotIn("--start", done.stderr)


if __name__ == "__main__":
    unittest.main()
