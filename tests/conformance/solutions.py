"""What clients ask of a stream of navigation solutions, once they have configured it."""
import collections

import receiver
import ubx


def of(items, message):
    """The frames of one kind."""
    return [i for i in items if isinstance(i, ubx.Frame) and i.is_a(message)]


def kinds(items):
    """How often each kind of item came, in words."""
    counts = collections.Counter(ubx.name(i.message) if isinstance(i, ubx.Frame) else type(i).__name__ for i in items)
    return ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())) or "nothing"


def check_kinds(client, items, wanted):
    """Nothing but the messages that the client enabled: others it would have to switch off."""
    good = {ubx.number(message) for message in wanted} | {0x0501, 0x0500}
    for item in items:
        is_good = item.message in good if isinstance(item, ubx.Frame) else not isinstance(item, ubx.Sentence)
        client.check(is_good, f"only {', '.join(wanted)}", item)


def check_solutions(client, items, period_ms, longest_gap_ms, seconds):
    """NAV-PVT of every epoch: rate, gaps, steps of iTOW, a fix, the right place and date."""
    frames = of(items, "NAV-PVT")
    least = int(seconds * 1000 / period_ms * 0.9)
    client.check(len(frames) >= least, f"at least {least} NAV-PVT in {seconds:g} s", kinds(items))
    solutions = [ubx.nav_pvt(frame.payload) for frame in frames]
    for before, after in zip(frames, frames[1:]):
        gap = (after.time - before.time) * 1000
        client.check(gap <= longest_gap_ms, f"a solution at least every {longest_gap_ms} ms", f"a gap of {gap:.0f} ms")
    for before, after in zip(solutions, solutions[1:]):
        step = (after["itow"] - before["itow"]) % 604_800_000
        client.check(step == period_ms and after["itow"] % period_ms == 0,
                     f"iTOW on the grid of {period_ms} ms, step by step", f"{before['itow']}, then {after['itow']}")
    mean = (frames[-1].time - frames[0].time) * 1000 / (len(frames) - 1)
    client.check(abs(mean - period_ms) < 0.075 * period_ms, f"a mean interval of {period_ms} ms", f"{mean:.1f} ms")
    check_fix(client, solutions[-1])
    return frames, solutions


def check_alive(client, items, longest_gap_ms):
    """A NAV-PVT, with a fix or without, at least so often: else the client says that the receiver is lost."""
    times = [frame.time for frame in of(items, "NAV-PVT")]
    client.check(bool(times), "NAV-PVT", kinds(items))
    gaps = [(b - a) * 1000 for a, b in zip(times, times[1:])]
    client.check(max(gaps, default=0) <= longest_gap_ms, f"NAV-PVT at least every {longest_gap_ms} ms",
                 f"a gap of {max(gaps, default=0):.0f} ms")


def check_fix(client, last):
    """A 3D fix at the place and date of the run, its time known."""
    client.check(last["fix_type"] == 3 and last["flags"] & 1, "fixType 3 with gnssFixOK",
                 f"fixType {last['fix_type']}, flags {last['flags']:02X}")
    client.check(last["valid"] & 7 == 7, "valid bits 0, 1 and 2 (date, time, fully resolved)",
                 f"valid {last['valid']:02X}")
    apart = receiver.metres_apart(last["latitude"] * 1e-7, last["longitude"] * 1e-7)
    client.check(apart < 20, "a position within 20 m of the scenario's", f"one {apart:.1f} m away")
    client.check(abs(last["height"] / 1000 - receiver.PLACE[2]) < 30, f"a height of {receiver.PLACE[2]} +- 30 m",
                 f"{last['height'] / 1000} m")
    date = (last["year"], last["month"], last["day"])
    client.check(date == receiver.START_DATE, f"the date {receiver.START_DATE}", date)
    client.check(last["satellites"] >= 4, "at least 4 satellites used", last["satellites"])


def check_each_epoch(client, items, wanted):
    """Every message of `wanted` comes once between two NAV-PVT, and in the same order in every epoch."""
    wanted = {ubx.number(message) for message in wanted} | {0x0107}
    order, epochs = [], []
    for item in items:
        if isinstance(item, ubx.Frame) and item.message in wanted:
            if item.message == 0x0107:
                epochs.append([])
            if epochs:
                epochs[-1].append(item.message)
    for epoch in epochs[1:-1]:
        order = order or epoch
        client.check(epoch == order and sorted(epoch) == sorted(wanted),
                     f"in every epoch, in one order: {' '.join(ubx.name(m) for m in sorted(wanted))}",
                     " ".join(ubx.name(m) for m in epoch))


def check_bursts(client, items, gap_ms, share):
    """Within an epoch no pause is longer than `gap_ms`, but for a share of epochs that a busy machine may break."""
    broken = total = 0
    for before, after in zip(items, items[1:]):
        if isinstance(after, ubx.Frame) and after.message in (0x0500, 0x0501):
            continue
        pause = (after.time - before.time - client.wire.seconds(after.size)) * 1000
        is_inside = isinstance(before, ubx.Frame) and isinstance(after, ubx.Frame) and same_epoch(before, after)
        if is_inside:
            total += 1
            broken += pause > gap_ms
    client.check(broken <= share * total, f"no pause of {gap_ms} ms inside a burst (at most {share:.0%} of them)",
                 f"{broken} pauses in {total} steps")


def same_epoch(before, after):
    """Whether two NAV frames carry the same time of week."""
    return before.message >> 8 == 1 and after.message >> 8 == 1 and before.payload[:4] == after.payload[:4]
