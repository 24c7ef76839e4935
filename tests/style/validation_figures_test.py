"""The figures of tools/validate of series whose figures are known, and the bands around records."""

import math
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from validation import bands, behaviours_starts, behaviours_turns, figures, geodesy, row_bands  # noqa: E402


def noise(count, sigma, seed=1):
    source = random.Random(seed)
    return [source.gauss(0, sigma) for _ in range(count)]


class Series(unittest.TestCase):
    def test_correlation_of_white_noise_and_of_a_slow_wave(self):
        self.assertAlmostEqual(figures.autocorrelation(noise(20000, 3), 1), 0, delta=0.02)
        wave = [math.sin(2 * math.pi * index / 600) for index in range(60000)]
        self.assertAlmostEqual(figures.autocorrelation(wave, 150), 0, delta=0.01)
        self.assertAlmostEqual(figures.autocorrelation(wave, 10), math.cos(2 * math.pi / 60), delta=0.01)

    def test_a_gap_has_no_partner(self):
        self.assertEqual(figures.differences([1, None, 4, 6]), [None, None, 2])
        self.assertEqual(figures.of_counts([7, 7, None, 8, 9])["sat changes"], 0.5)

    def test_kurtosis_and_ranks(self):
        self.assertAlmostEqual(figures.kurtosis(noise(50000, 2)), 3, delta=0.1)
        self.assertEqual(figures.percentile([4, 1, 3, 2], 0.5), 2.5)

    def test_position_in_metres(self):
        north = [[53 + value / 111275, -9, 20] for value in noise(5000, 2)]
        result = figures.of_position(north, (1,))
        self.assertAlmostEqual(result["std N"], 2, delta=0.1)
        self.assertAlmostEqual(result["std E"], 0)

    def test_geodetic_and_back(self):
        for place in ([53.28, -9.06, 67.8], [-16.47, -71.49, 2489], [35.34, 139.52, 65.7]):
            for value, again in zip(place, geodesy.to_geodetic(*geodesy.to_ecef(*place))):
                self.assertAlmostEqual(value, again, places=6)


    def test_errors_of_fixes_that_come_and_go(self):
        result = figures.of_errors([(3, 4, 9), None, (0, 1, 0), (0, 3, 5)])
        self.assertEqual((result["fixes"], result["error p50"], result["d1 error p50"]), (0.75, 3, 2))
        self.assertEqual(figures.of_errors([None, None]), {"fixes": 0})
        self.assertAlmostEqual(geodesy.offset([53.2801, -9, 30], [53.28, -9, 20])[1], 11.1, delta=0.1)

    def test_satellites_together_and_one_by_one(self):
        epochs = [{"G01": (50, 45 + second % 2), "G02": (20, 30)} for second in range(100)]
        result = figures.of_satellites([*epochs, {"G03": (5, 20)}])
        self.assertEqual((result["C/N0 p5"], result["C/N0 p95"], result["C/N0 sd of a satellite"]), (30, 46, 0.25))
        self.assertEqual(figures.of_counts([4, 5, 5], "tracked")["tracked changes"], 0.5)


class Raw(unittest.TestCase):
    def test_white_code_without_its_quadratic(self):
        rows = [(t, 2e7 + 0.01 * t * t + value, 2e7 + 0.01 * t * t - 3e-5 * t * t, False, 45, 33)
                for t, value in enumerate(noise(1200, 0.3))]
        result = figures.of_code({"G01": rows})
        self.assertAlmostEqual(result["code noise white el 30"], 0.3, delta=0.03)
        self.assertAlmostEqual(result["code MP std el 30"], 0.3, delta=0.03)
        self.assertEqual(result["C/N0 el 30"], 45)

    def test_arcs_end_at_slips_gaps_and_jumps(self):
        rows = [(t, 0, 0 if t < 8 else 9, t == 3, 45, 33) for t in range(10) if t != 5]
        self.assertEqual([[row[0] for row in arc] for arc in figures.arcs(rows)], [[0, 1, 2], [3, 4], [6, 7], [8, 9]])

    def test_doppler_of_known_noise(self):
        satellites = {f"G{index:02d}": [(t, 100.0 * t, False, 100 + value, 50)
                                        for t, value in enumerate(noise(2000, 0.02, index))] for index in range(20)}
        self.assertAlmostEqual(figures.of_doppler(satellites)["Doppler noise mm/s el 50"], 20 / math.sqrt(2), delta=1)


class Bands(unittest.TestCase):
    def expect(self, name, values, low, high):
        band = bands.of_record(name, values)
        self.assertAlmostEqual(band[0], low)
        self.assertAlmostEqual(band[1], high)

    def test_around_one_record(self):
        self.expect("std E", [2], 1.4, 2.6)
        self.expect("d1 std E", [2], 1.4, 2.6)
        self.expect("r10 E", [0.9], 0.6, 1)
        self.expect("d1 r1 E", [0.4], 0.25, 0.55)
        self.expect("C/N0 el 30", [40], 38, 42)
        self.expect("C/N0 sd el 30", [3], 2, 4.5)
        self.expect("sats", [14], 13, 15)
        self.expect("sat changes", [0.1], 0.05, 0.2)
        self.expect("tracked", [14], 13, 15)
        self.expect("tracked changes", [0.1], 0.05, 0.2)
        self.expect("fixes", [0.6], 0.4, 0.9)
        self.expect("C/N0 p50", [40], 38, 42)
        self.expect("hdop p95", [1], 0.8, 1.2)
        self.expect("speed at rest p50", [0.004], 0.002, 0.008)
        self.expect("hAcc", [1.5], 1, 2.25)

    def test_of_several_hours(self):
        self.expect("std E", [2, 5, 3], 2, 5)
        self.expect("r60 E", [0.5, 0.55, 0.9], 0.4, 0.9)

    def test_none_around_nothing(self):
        self.assertIsNone(bands.of_record("speed at rest p50", [0]))
        self.assertIsNone(bands.of_record("std E", []))


class Behaviours(unittest.TestCase):
    def row(self, band, *values):
        return row_bands.Row("a row", band, [list(numbers) for numbers in values])

    def test_the_medians_of_the_seeds_count(self):
        self.assertTrue(self.row(row_bands.within(2, 12, "mm/s"), [1], [4], [50]).inside)
        self.assertFalse(self.row(row_bands.within(2, 12, "mm/s"), [1], [1.5], [4]).inside)
        self.assertEqual(self.row(row_bands.reported("s"), [1, 2], [3, 5], [2, 9]).text, "2 / 5 s")

    def test_what_was_not_measured_is_not_inside(self):
        for band in (row_bands.never("s"), row_bands.growing("s"), row_bands.at_most(3, "s")):
            self.assertFalse(self.row(band).inside)
            self.assertFalse(self.row(band, [float("nan")]).inside)

    def test_never_and_growing(self):
        self.assertTrue(self.row(row_bands.never("s"), [row_bands.NEVER]).inside)
        self.assertFalse(self.row(row_bands.never("s"), [200.0]).inside)
        self.assertTrue(self.row(row_bands.growing("s", 0.2), [2, 1.8, 5]).inside)
        self.assertFalse(self.row(row_bands.growing("s"), [2, 5, row_bands.NEVER]).inside)
        self.assertFalse(self.row(row_bands.growing("s"), [2, 1.8, 5]).inside)

    def test_a_known_lag(self):
        times = [index * 0.2 for index in range(600)]
        way = behaviours_turns.Curve(times, [[40 * math.sin(0.4 * t), 30 * math.cos(0.5 * t)] for t in times])
        speed = behaviours_turns.Curve(times[2:-2], behaviours_turns.rates(way.step, way.values))
        late = [(t, [16 * math.cos(0.4 * (t - 0.09)), -15 * math.sin(0.5 * (t - 0.09))]) for t in times[10:-10]]
        self.assertAlmostEqual(behaviours_turns.lag(speed, late), 90, delta=0.5)
        late = [(t, [40 * math.sin(0.4 * (t + 0.05)) + 3, 30 * math.cos(0.5 * (t + 0.05)) - 2]) for t in times[10:-10]]
        self.assertAlmostEqual(behaviours_turns.lag(way, late), -50, delta=0.5)

    def test_a_return(self):
        def told(time, fixed, sats):
            return behaviours_starts.runs.Told(time, fixed, False, sats, (), (), 1, 1, 1)

        every = [told(time, not 20 <= time < 33, min(20, 6 + 4 * max(time - 33, 0)) if time >= 33 else 20)
                 for time in range(60)]
        self.assertEqual(behaviours_starts.return_times(every, 10, 30), (3, 6))


if __name__ == "__main__":
    unittest.main()
