"""One row for each table of figures: which record, which scenario stands for it, which figures, whence."""

import dataclasses
import functools
import statistics

from . import figures, gnss_logger, records, single_point, span, streets
from .simulation import Evidence, Setup

RIVER = "receivers/galway_20181004_m8p_riverside"
GARDEN = "receivers/galway_20181015_m8p_static"
TSUKUBA = "receivers/tsukuba_20210319_mosaic"
PHONE = "receivers/charleston_20160822_phone"
TREES = "receivers/aptos_20130223_lea6_trees"
APTOS = "receivers/aptos_20130214_lea6"
AREQUIPA = "receivers/areq_20100115"
LATER_ORBITS = "nav/BRDC00IGS_R_20240010000_01D_MN.rnx.gz"  # of another day, moved: no file of the day is at hand

SETUPS = {
    "trees": Setup("validation/trees.toml"),
    "garden": Setup("validation/garden.toml", (f"{GARDEN}/galway.nav",), systems="GR"),
    "bend": Setup("validation/bend.toml", (LATER_ORBITS,), rebase=True),
    "tsukuba": Setup("validation/tsukuba.toml", (f"{TSUKUBA}/SEPT078M.21P.gz",), systems="GEJ"),
    "riverside": Setup("validation/riverside.toml", (f"{RIVER}/rover1004.nav.gz", f"{RIVER}/glw1277m.18n.gz",
                                                     f"{RIVER}/glw1277m.18g.gz"), systems="GR"),
    "car": Setup("validation/car.toml", (LATER_ORBITS,), rebase=True, way=span.write_track),
    "phone": Setup("validation/phone.toml", (f"{PHONE}/hour2350.16n.gz",)),
    "nagoya": Setup("validation/nagoya.toml", (f"{streets.NAGOYA}/base.nav.gz",), systems="GRECJ",
                    way=streets.write_track),
    "canyon": Setup("validation/canyon.toml", tuple(f"{streets.CANYON}/hksc155{name}" for name in (
        "c.20n", "d.20n", "c.20g", "c.20b")), systems="GRC"),
    "aptos": Setup("aptos.toml"),
    "arequipa": Setup("arequipa.toml"),
}


def own_hour(told):
    return figures.of_position(records.by_second(told.position), (10, 60))


def trees(evidence):
    return own_hour(evidence.ubx)


def garden(evidence):
    told = evidence.ubx
    velocities = records.by_second(told.velocity)
    result = own_hour(told) | figures.of_counts(records.by_second(told.sats)) | figures.of_speed(told.speed.values())
    result["vel up std"] = statistics.stdev(row[2] for row in velocities if row)
    result["vel north r1"] = figures.autocorrelation([row and row[1] for row in velocities], 1)
    result["sAcc"] = statistics.median(told.values("s_acc"))
    result["pAcc 3D"] = statistics.median(told.values("p_acc"))
    return result


def bend(evidence):
    told = evidence.ubx
    result = own_hour(told) | figures.of_counts(records.by_second(told.sats)) | figures.of_speed(told.speed.values())
    for name, key in (("sAcc", "s_acc"), ("hAcc", "h_acc"), ("vAcc", "v_acc")):
        result[name] = statistics.median(told.values(key))
    result["hdop"] = statistics.fmean(told.values("hdop"))
    return result


def single(evidence):
    places, counts = evidence.single_from(10)
    return figures.of_position(records.by_second(places), (1, 10, 60)) | figures.of_counts(records.by_second(counts))


def raw(evidence):
    result = figures.of_code(evidence.rinex.code_rows(evidence.elevations))
    return result | figures.of_doppler(evidence.rinex.doppler_rows(evidence.elevations))


def river_nmea(evidence):
    told, solution = evidence.nmea, evidence.ubx
    result = figures.of_counts(records.by_second(solution.sats)) | figures.of_speed(told.speed.values())
    result["hdop"] = statistics.median(told.values("hdop"))
    return result | figures.of_strength(told.strengths.values())


def car(evidence):
    told, truth = evidence.nmea, span.read(evidence.data)[1]
    standing = [speed for second, speed in told.speed.items() if truth.get(second, 1) < 0.05]
    moving = [speed - truth[second] for second, speed in told.speed.items() if truth.get(second, 0) > 2]
    result = figures.of_counts(records.by_second(told.sats)) | figures.of_speed(standing)
    result["speed error moving"] = statistics.pstdev(moving)
    for share in (50, 95):
        result[f"hdop p{share}"] = figures.percentile(told.values("hdop"), share / 100)
    result |= figures.of_strength(told.strengths.values())
    return result | figures.of_strength_steps(list(told.strengths.values()))


def phone(evidence):
    """Its raw data solved, with low satellites too; and what the telephone tells."""
    places, counts = evidence.single_from(5)
    result = figures.of_position(records.by_second(places), (1, 10)) | figures.of_counts(records.by_second(counts))
    if evidence.log:
        accuracies, speeds = zip(*evidence.log.fixes)
    else:
        accuracies, speeds = evidence.fixes.values("h_acc"), evidence.fixes.speed.values()
    result |= figures.of_speed(speeds) | {"hAcc": statistics.median(accuracies)}
    result["C/N0 mean"] = statistics.fmean(strength for epoch in evidence.rinex.strengths.values()
                                           for strength in epoch.values())
    return result


def fixes_hour(evidence):
    """Standard deviation and correlation of the position alone, as the two first sites always had."""
    return {name: value for name, value in own_hour(evidence.fixes).items() if not name.startswith("d1")}


class Hours:
    """Positions alone: an hour of a table of them."""

    def __init__(self, rows):
        self.rows = rows


def of_hours(names):
    return lambda hour: {name: value for name, value in figures.of_position(hour.rows, (10, 60)).items()
                         if names(name)}


def position_hours(data, folder, pattern):
    return [Hours(hour) for path in sorted((data / folder).glob(pattern))
            for hour in records.hours_of(records.position_table(path, 2))]


def arequipa_hour(program, data):
    """The hour solved by our own engine with precise orbits."""
    folder = data / AREQUIPA
    return [Hours(records.solved_by(program, folder / "areq015o.10o.gz", folder / "igs15665.sp3"))]


@functools.lru_cache
def river_record(program, data, setup):
    log = data / RIVER / "rover1004.ubx.gz"
    return [Evidence(program, log, lambda scratch: single_point.convert(log, scratch), setup.files(data), setup, data)]


@functools.lru_cache
def phone_record(program, data, setup):
    log = gnss_logger.Log(next((data / PHONE).glob("pseudoranges_log_*.txt.gz")))
    evidence = Evidence(program, None, log.rinex_in, setup.files(data), setup, data)
    evidence.log = log
    return [evidence]


def stream_record(path):
    return lambda program, data, setup: [Evidence(program, data / path, None, (), setup, data)]


def rinex_record(path=None):
    return functools.lru_cache(lambda program, data, setup: [
        Evidence(program, None, path and data / path, setup.files(data), setup, data)])


tsukuba_record = rinex_record(f"{TSUKUBA}/SEPT078M.21O.gz")


@dataclasses.dataclass(frozen=True)
class Site:
    name: str
    title: str
    setup: str
    record: object              # (program, data, setup) → evidence of each hour or receiver
    measure: object             # evidence → figures, of a simulated run
    real: object = None         # the same of the record, where it differs
    of_table: tuple = ()        # figures whose band is that of bands.csv: they hang on how a few arcs are cut
    short: bool = True          # it is part of a short validation
    group: str = "suburbs and open sky"  # of sites whose figures have a total of their own

    def real_figures(self, program, data):
        measure = self.real or self.measure
        return [measure(evidence) for evidence in self.record(program, data, SETUPS[self.setup])]


def not_steps(name):
    return not name.startswith("d1")


SITES = (
    Site("trees", "Aptos B, LEA-6 under trees (14 h) / consumer forest", "trees",
         lambda program, data, setup: position_hours(data, TREES, "*.dlm.gz"), trees, of_hours(bool), short=False),
    Site("garden", "Galway garden, M8P own fixes 43 min / consumer residential", "garden",
         stream_record(f"{GARDEN}/base-20181015-1654.ubx.gz"), garden),
    Site("bend", "Bend, ZED-F9T 5 min / f9p open-sky", "bend", stream_record("receivers/bend_f9t/F9T-L2-5min.ubx.gz"),
         bend),
    Site("tsukuba", "SEPT, mosaic-X5 15 min G+E+J, same SPP / survey", "tsukuba", tsukuba_record, single),
    Site("riverside", "Galway riverside, M8P RAWX 20 min G+R, same SPP / consumer open-sky", "riverside", river_record,
         single),
    Site("riverside-raw", "M8P riverside raw / consumer open-sky", "riverside", river_record, raw,
         of_table=tuple(f"code MP std el {low}" for low in (0, 20, 30, 60))),
    Site("tsukuba-raw", "SEPT raw / survey", "tsukuba", tsukuba_record, raw),
    Site("phone-raw", "Phone 2016-08-22 raw / phone", "phone", phone_record, raw),
    Site("riverside-nmea", "M8P riverside NMEA / consumer open-sky", "riverside", river_record, river_nmea),
    Site("car", "F9K car, Mountain View / f9p suburban-drive, in a car", "car",
         stream_record(f"{span.FOLDER}/ublox-F9K.nmea.gz"), car),
    Site("phone", "Phone 2016-08-22 Charleston Park, GPS / phone", "phone", phone_record, phone),
    Site("aptos", "Aptos A, LEA-6 (10 h) / consumer residential", "aptos",
         lambda program, data, setup: position_hours(data, APTOS, "*.dlm"), fixes_hour, of_hours(not_steps), short=False,
         group="hours"),
    Site("arequipa", "Arequipa, UZ-12, one hour with precise orbits / survey", "arequipa",
         lambda program, data, setup: arequipa_hour(program, data), fixes_hour, of_hours(not_steps), short=False,
         group="hours"),
    Site("nagoya", "Drive through Nagoya, same SPP above 30° / survey urban", "nagoya", rinex_record(), streets.nagoya,
         streets.nagoya_record, group="streets"),
    Site("canyon", "F9P in a street canyon of Hong Kong, raw and same SPP / f9p urban-canyon", "canyon",
         rinex_record(f"{streets.CANYON}/2020_06_03_TST_03.obs.gz"), streets.canyon, group="streets"),
)
