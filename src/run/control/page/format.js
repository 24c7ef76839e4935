// Numbers as people read them.

/** 3.14159 -> "3.14": three figures, and no more than that for large ones. */
export function figures(value, count = 3) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e6 || size < 1e-3)) return value.toExponential(1).replace("-", "−");
    const digits = size === 0 ? 0 : Math.max(0, count - 1 - Math.floor(Math.log10(size)));
    return value.toFixed(Math.min(digits, 3)).replace("-", "−");
}

/** Metres with a fitting unit. */
export function metres(value) {
    if (!Number.isFinite(value)) return "–";
    return Math.abs(value) >= 1000 ? `${figures(value / 1000)} km` : `${figures(value)} m`;
}

/** A round number of metres: 0.1 -> "0.1 m", 5000 -> "5 km". */
export function roundMetres(value) {
    const unit = value >= 1000 ? ["km", 1000] : ["m", 1];
    return `${Number((value / unit[1]).toPrecision(3))} ${unit[0]}`;
}

/** Bytes with a fitting unit, thousands as on a wire. */
export function bytes(count) {
    if (count < 1000) return `${Math.round(count)} B`;
    return count < 1e6 ? `${figures(count / 1e3)} kB` : `${figures(count / 1e6)} MB`;
}

/** 3723.4 -> "1:02:03"; 63 -> "1:03". */
export function clock(seconds) {
    if (!Number.isFinite(seconds)) return "–";
    const sign = seconds < 0 ? "−" : "";
    const whole = Math.floor(Math.abs(seconds));
    const two = (number) => String(number).padStart(2, "0");
    const hours = Math.floor(whole / 3600);
    const minutes = Math.floor(whole / 60) % 60;
    return hours ? `${sign}${hours}:${two(minutes)}:${two(whole % 60)}` : `${sign}${minutes}:${two(whole % 60)}`;
}

/** "2026-03-01T09:00:05.200Z" -> "2026-03-01 09:00:05 UTC". */
export function utc(text) {
    return `${text.slice(0, 10)} ${text.slice(11, 19)} UTC`;
}

/** 2408, 32453.2 -> "GPS week 2408, TOW 32453 s": a time of week as clocks show it, not rounded. */
export function gpsTime(week, timeOfWeek) {
    return `GPS week ${week}, TOW ${Math.floor(timeOfWeek)} s`;
}

/** 0.4 -> "40 %". */
export function percent(share) {
    return `${Math.round(share * 100)} %`;
}

/** "receiver_silent" -> "receiver silent". */
export function words(name) {
    return name.replaceAll("_", " ");
}

/** A tick step of 1, 2 or 5 times a power of ten, at least as large as asked for. */
export function roundStep(least) {
    const power = 10 ** Math.floor(Math.log10(Math.max(least, 1e-9)));
    return power * [1, 2, 5, 10].find((factor) => factor * power >= least * 0.9999);
}

/** As `roundStep`, on clocks: 1, 2, 5, 10, 15, 30 s, minutes, hours. */
export function clockStep(least) {
    const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 21600, 43200, 86400];
    return steps.find((step) => step >= least) ?? 86400 * Math.ceil(least / 86400);
}
