"""Receivers in streets: driven through Nagoya, and standing in a street canyon of Hong Kong.

Of Nagoya there are single points alone, solved above 30° and from 35 dB-Hz on; the simulated raw data are solved so, too.
"""

import statistics

from . import figures, geodesy, records

NAGOYA = "receivers/nagoya_20230711_drive"
NAGOYA_MASK, STRONG_ALONE = 30, ("pos1-snrmask_r=on", "pos1-snrmask_L1=" + ",".join(["35"] * 9))
CANYON = "receivers/hk_tst_static_20200603"
CANYON_MASK, RAIM = 15, ("pos1-posopt5=on",)


def reference(data):
    """{second: latitude, longitude, height} of the drive."""
    return records.solved(data / NAGOYA / "reference_1Hz.pos.gz")[0]


def write_track(data, path):
    records.write_track(path, reference(data))


def of_single(solved, truth):
    """Of ({second: place}, {second: satellites}) where the place of every second is known."""
    places, counts = solved
    result = figures.of_errors([geodesy.offset(places[second], place) if second in places else None
                                for second, place in sorted(truth.items())])
    if len(counts) < 2:
        return result
    used = records.by_second(counts)
    return result | figures.of_counts(used) | {"spread of sats": statistics.pstdev(figures.known(used))}


def nagoya(evidence):
    return of_single(evidence.single_from(NAGOYA_MASK, *STRONG_ALONE), reference(evidence.data))


def nagoya_record(evidence):
    return of_single(records.solved(evidence.data / NAGOYA / "rover_1Hz_spp.pos.gz"), reference(evidence.data))


def canyon(evidence):
    strengths = evidence.strengths
    place = evidence.setup.table()["trajectory"]["at"]
    result = of_single(evidence.single_from(CANYON_MASK, *RAIM), {second: place for second in strengths})
    result["fixes without RAIM"] = len(evidence.single_from(CANYON_MASK)[0]) / len(strengths)
    result |= figures.of_counts([len(epoch) for epoch in strengths.values()], "tracked")
    return result | figures.of_satellites(strengths.values()) | figures.of_strength_steps(list(strengths.values()))
