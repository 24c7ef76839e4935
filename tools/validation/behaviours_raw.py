"""RXM-RAWX of the first band beside records: the deviations that a receiver tells, and what its raw data scatter by."""

import math
import statistics

from . import bands, figures, records, runs
from .row_bands import Behaviour, within

GALWAY = "receivers/galway_20181004_m8p_riverside"
SCATTERED = "ublox-f9p"  # that of an M8P stands in the table of riverside-raw
GPS, GALILEO, BEIDOU, GLONASS = 0, 2, 3, 6
FIRST_BAND = {GPS: (0,), GALILEO: (0, 1), BEIDOU: (0, 1), GLONASS: (0,)}
RECORDS = {  # board: scenario of tools/validate that stands for the record, the record and its systems, navigation
    "ublox-f9p": ("bend", "receivers/bend_f9t/F9T-L2-5min.ubx.gz", (GPS, GALILEO, BEIDOU), None),
    "ublox-m8p": ("riverside", f"{GALWAY}/rover1004.ubx.gz", (GPS, GLONASS),
                  (f"{GALWAY}/rover1004.nav.gz", f"{GALWAY}/glw1277m.18n.gz", f"{GALWAY}/glw1277m.18g.gz")),
}
RANGE, PHASE = 1, 2                 # of tracking_status
NO_PHASE_DEVIATION = 15
BIN_DB, LEAST_OF_BIN = 5, 60        # a bin has so many deviations at least
LEAST_WINDOWS = 3                   # and so many windows of code
FACTOR = 1.5
OUTPUT = (("receiver.0.config.CFG-UART1OUTPROT-UBX", "true"), ("receiver.0.config.CFG-MSGOUT-UBX_RXM_RAWX_UART1", 1))


def wavelength(measurement):
    frequency = {BEIDOU: 1561.098e6, GLONASS: 1602e6 + 562500 * (measurement["freq_id"] - 7)}
    return figures.SPEED_OF_LIGHT / frequency.get(measurement["gnss_id"], 1575.42e6)


def of_first_band(messages, systems):
    """(second, measurement) of all RXM-RAWX."""
    for name, fields in messages:
        if name == "RXM-RAWX" and fields["week"]:
            for measurement in fields["measurements"]:
                if measurement["gnss_id"] in systems and measurement["sig_id"] in FIRST_BAND[measurement["gnss_id"]]:
                    yield round(fields["tow_s"]), measurement


def strength_bin(strength):
    return int(strength // BIN_DB) * BIN_DB


def deviations(measurements):
    """{(quantity, C/N0): mean} in m, cycles, Hz."""
    bins = {}
    for _, m in measurements:
        low = strength_bin(m["cno_dbhz"])
        bins.setdefault(("prStd", low), []).append(0.01 * 2 ** (m["range_deviation_code"] & 15))
        bins.setdefault(("doStd", low), []).append(0.002 * 2 ** (m["doppler_deviation_code"] & 15))
        if m["phase_deviation_code"] & 15 != NO_PHASE_DEVIATION:
            bins.setdefault(("cpStd", low), []).append(0.004 * (m["phase_deviation_code"] & 15))
    return {key: statistics.fmean(values) for key, values in sorted(bins.items()) if len(values) >= LEAST_OF_BIN}


def arcs_of(measurements):
    """{satellite and signal: rows of (second, code m, carrier m, slipped, C/N0, range rate m/s)}."""
    satellites, locks = {}, {}
    for second, m in measurements:
        if m["tracking_status"] & (RANGE | PHASE) != RANGE | PHASE:
            continue
        name, length = (m["gnss_id"], m["sv_id"], m["sig_id"]), wavelength(m)
        slipped = m["lock_time_s"] < locks.get(name, 0)
        locks[name] = m["lock_time_s"]
        satellites.setdefault(name, []).append((second, m["range_m"], m["phase_cycles"] * length, slipped,
                                                m["cno_dbhz"], -m["doppler_hz"] * length))
    return satellites


def scatters(measurements):
    """{(quantity, C/N0): value}: white part and correlation of the code, Doppler noise."""
    satellites, bins, result = arcs_of(measurements), {}, {}
    # Elevations are not at hand; strength stands in their place.
    for _, strength, residuals in figures.code_windows({name: [row[:5] + (0,) for row in rows]
                                                        for name, rows in satellites.items()}):
        white = statistics.pstdev(figures.known(figures.differences(residuals))) / math.sqrt(2)
        bins.setdefault(strength_bin(strength), []).append((white, figures.autocorrelation(residuals, 1)))
    for low, windows in sorted(bins.items()):
        if len(windows) >= LEAST_WINDOWS:
            for quantity, values in zip(("code noise white", "code MP r1"), zip(*windows)):
                result[quantity, low] = statistics.median(values)
    rows = {name: [(row[0], row[2], row[3], row[5], row[4]) for row in rows] for name, rows in satellites.items()}
    noise = {}
    for strength, value in figures.doppler_residuals(rows):
        noise.setdefault(strength_bin(strength), []).append(value)
    return result | {("Doppler noise", low): 1000 * figures.robust_sigma(values)
                     for low, values in sorted(noise.items()) if len(values) >= LEAST_OF_BIN}


UNITS = {"prStd": "m", "cpStd": "cycles", "doStd": "Hz", "code noise white": "m", "code MP r1": "",
         "Doppler noise": "mm/s"}


def row_name(board, quantity, low):
    return f"{quantity} at {low} … {low + BIN_DB} dB-Hz, {board}"


def measures(board):
    return (deviations, scatters) if board == SCATTERED else (deviations,)


def figures_of(board, messages):
    """{(quantity, C/N0): value} of the systems that the record has."""
    measurements = list(of_first_band(messages, RECORDS[board][2]))
    return {key: value for measure in measures(board) for key, value in measure(measurements).items()}


def simulated(bench, board, seed):
    scenario, _, _, navigation = RECORDS[board]
    changes = (*OUTPUT, *((("sky.rebase_navigation", "true"),) if navigation is None else ()))
    with runs.run(bench, scenario, seed, changes, navigation or (runs.NAVIGATION,)) as outcome:
        return {row_name(board, *key): [value] for key, value in figures_of(board, outcome.messages(0)).items()}


def raw_bands(bench):
    result = {}
    for board, (_, record, _, _) in RECORDS.items():
        for (quantity, low), value in figures_of(board, records.messages(bench.program, bench.data / record)).items():
            if quantity in ("prStd", "cpStd", "doStd"):
                band = (value / FACTOR, value * FACTOR)
            else:
                band = bands.of_single(quantity, value)
            result[row_name(board, quantity, low)] = within(*band, UNITS[quantity])
    return result


BEHAVIOURS = (Behaviour("raw", simulated, raw_bands, tuple(RECORDS), short=("ublox-f9p",)),)
