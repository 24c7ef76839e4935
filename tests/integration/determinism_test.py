"""The same scenario and seed give the same files; another seed gives others."""
import csv
import hashlib
import pathlib
import unittest

from session import SHARED, open_folder, skyloop

FILES = ("fixes.csv", "satellites.csv", "port0.out", "port0.times")
MEASURED = ("observations.rnx", "navigation.rnx")
COLUMNS = {
    "fixes.csv": "time_utc,gps_week,tow_s,true_lat_deg,true_lon_deg,true_height_m,lat_deg,lon_deg,height_m,east_error_m,"
                 "north_error_m,up_error_m,vel_north_mps,vel_east_mps,vel_down_mps,speed_mps,course_deg,fix_type,"
                 "satellites_used,satellites_visible,gdop,pdop,hdop,vdop,tdop,h_acc_m,v_acc_m,s_acc_mps,t_acc_m,clock_bias_m,"
                 "true_clock_bias_m,sigma_uere_m,error_scale_m",
    "satellites.csv": "time_utc,satellite,azimuth_deg,elevation_deg,range_m,line_of_sight,paths,excess_path_m,iono_delay_m,"
                      "tropo_delay_m,gas_loss_db,cloud_loss_db,rain_loss_db,cn0_dbhz,pseudorange_m,used,orbit_clock_error_m,"
                      "multipath_m,code_noise_m,phase_noise_m,doppler_noise_hz,foliage_loss_db,antenna_gain_dbic,"
                      "power_offset_db,interference_loss_db,amplitude_scintillation,phase_scintillation_rad,residual_m,"
                      "false_range_m,state,shadowing_db,fading_db,free_space_loss_db,iono_loss_db,reflection_loss_db,"
                      "received_power_dbw",
}


def digests(*arguments, files=FILES):
    """The digest of each file of an hour at 1 Hz, and the text of the tables' first lines."""
    with open_folder() as folder:
        skyloop("simulate", "--out", folder, "--duration", 3600, *arguments)
        content = {name: pathlib.Path(folder, name).read_bytes() for name in files}
    lines = {name: content[name].splitlines() for name in COLUMNS}
    return {name: hashlib.sha256(data).hexdigest() for name, data in content.items()}, lines


class DeterminismTest(unittest.TestCase):
    def check(self, *arguments, files=FILES):
        first, lines = digests(*arguments, "--seed", 7, files=files)
        again, _ = digests(*arguments, "--seed", 7, files=files)
        other, _ = digests(*arguments, "--seed", 8, files=files)
        self.assertEqual(first, again)
        self.assertNotEqual(first["fixes.csv"], other["fixes.csv"])
        self.assertNotEqual(first["port0.out"], other["port0.out"])
        if files == FILES:
            self.assertEqual(first["satellites.csv"], other["satellites.csv"], "the noise must not touch the sky")
        else:
            self.assertNotEqual(first["observations.rnx"], other["observations.rnx"])
            self.assertEqual(first["navigation.rnx"], other["navigation.rnx"], "nor what the satellites send")
        self.assertEqual(len(lines["fixes.csv"]), 3601)
        for name, columns in COLUMNS.items():
            self.assertEqual(lines[name][0].decode(), columns)
            for line in lines[name]:
                self.assertEqual(line.count(b","), columns.count(","))

    def test_nominal_constellation(self):
        self.check("--start", "2026-03-01T00:00:00Z", "--model", "baseline")

    def test_real_navigation_data(self):
        navigation = SHARED / "nav/brdc1820.10n"
        if not navigation.exists():
            self.skipTest(f"shared data absent: {navigation}")
        self.check("--nav", navigation, "--start", "2010-07-01T12:00:00Z", "--at", "46.4775,30.7326,77", "--model",
                   "baseline")

    def test_two_runs_under_one_sky(self):
        """What the sky does hardly differs over 1.1 km; what receivers add is their own."""
        with open_folder() as folder:
            base, rover = (self.satellites(pathlib.Path(folder, name), *words) for name, words in (
                ("base", ("--set", "run.receiver_seed=1", "--at", "48.137,11.575,560")),
                ("rover", ("--set", "run.receiver_seed=2", "--at", "48.147,11.575,560"))))
            stranger = self.satellites(pathlib.Path(folder, "stranger"), "--set", "run.sky_seed=8", "--at", "48.137,11.575,560")
        self.assertGreater(len(base), 500)
        self.assertLess(len(set(base) ^ set(rover)), 0.01 * len(base), "at the horizon")
        for key in set(base) & set(rover):
            row, there = base[key], rover[key]
            if float(row["elevation_deg"]) < 5:  # where a hundredth of a degree is much
                continue
            # But for a hundredth of a degree of elevation.
            for column in ("orbit_clock_error_m", "iono_delay_m", "tropo_delay_m"):
                value = float(row[column])
                self.assertAlmostEqual(value, float(there[column]), delta=1e-3 + 0.005 * abs(value), msg=(key, column))
        self.assertFalse(any(self.same(base, rover, name) for name in ("multipath_m", "code_noise_m", "phase_noise_m")))
        self.assertFalse(any(self.same(base, stranger, name) for name in ("orbit_clock_error_m", "tropo_delay_m")))

    def test_receivers_at_one_place_under_one_sky(self):
        with open_folder() as folder:
            one, other = (self.satellites(pathlib.Path(folder, f"of{seed}"), "--set", f"run.receiver_seed={seed}")
                          for seed in (1, 2))
        for key, row in one.items():
            for column in ("range_m", "orbit_clock_error_m", "iono_delay_m", "tropo_delay_m"):
                self.assertEqual(row[column], other[key][column], (key, column))

    def test_two_starts_under_one_sky(self):
        """Two processes, the second begins an hour and a half later: the same orbits, clocks and air to the last digit."""
        with open_folder() as folder:
            early = self.satellites(pathlib.Path(folder, "early"), "--rate", "0.1", duration=5460)
            late = self.satellites(pathlib.Path(folder, "late"), "--rate", "0.1", start="2026-03-01T13:30:00Z")
        common = set(early) & set(late)
        self.assertGreater(len(common), 50)
        for key in common:
            for column in ("range_m", "orbit_clock_error_m", "iono_delay_m", "tropo_delay_m"):
                self.assertEqual(early[key][column], late[key][column], (key, column))

    @staticmethod
    def same(one, other, column):
        return all(one[key][column] == other[key][column] for key in set(one) & set(other))

    def satellites(self, folder, *words, start="2026-03-01T12:00:00Z", duration=60):
        """{(time, satellite): row} of satellites.csv."""
        skyloop("simulate", "--out", folder, "--duration", duration, "--start", start, "--set", "run.sky_seed=7", *words)
        with open(folder / "satellites.csv", encoding="ascii") as file:
            return {(row["time_utc"], row["satellite"]): row for row in csv.DictReader(file)}

    def test_a_receiver_that_measures(self):
        self.check("--start", "2026-03-01T00:00:00Z", files=FILES + MEASURED)


if __name__ == "__main__":
    unittest.main(verbosity=2)
