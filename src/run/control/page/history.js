// What the page has seen since it was opened: the stream tells of the moment alone.

import { solutionKind } from "./solutions.js";

const mostSamples = 12_000;
const mostStretches = 2000; // of a satellite, and of solutions
const longestGap = 2; // s of real time between snapshots of one stretch
const earthRadius = 6378137; // WGS 84, semi-major axis, m
const eccentricitySquared = 6.69437999014e-3; // WGS 84

/** East and north of a place from an origin, m: radii of curvature, good to centimetres over some kilometres. */
export function flat(place, origin) {
    const rad = Math.PI / 180;
    const sine = Math.sin(origin.lat_deg * rad);
    const w = 1 - eccentricitySquared * sine * sine;
    const meridian = (earthRadius * (1 - eccentricitySquared)) / w ** 1.5 + origin.height_m;
    const normal = earthRadius / Math.sqrt(w) + origin.height_m;
    const east = ((place.lon_deg - origin.lon_deg + 540) % 360) - 180;
    return {
        e: east * rad * normal * Math.cos(origin.lat_deg * rad),
        n: (place.lat_deg - origin.lat_deg) * rad * meridian,
    };
}

/** The place so far east and north of an origin: the inverse of `flat`. */
export function unflat(point, origin) {
    const unit = flat({ lat_deg: origin.lat_deg + 0.001, lon_deg: origin.lon_deg + 0.001 }, origin);
    return {
        lat_deg: origin.lat_deg + (point.n / unit.n) * 0.001,
        lon_deg: origin.lon_deg + (point.e / unit.e) * 0.001,
    };
}

// What goes on is the last stretch, longer; what is new or comes after a gap is another one.
function extend(stretches, { time, gap }, what) {
    const last = stretches.at(-1);
    const goesOn = last && time - last.to <= gap;
    if (goesOn) last.to = time;
    if (goesOn && Object.entries(what).every(([name, value]) => last[name] === value)) return;
    stretches.push({ from: time, to: time, ...what });
    if (stretches.length > mostStretches) stretches.shift();
}

/**
 * Samples of one receiver, in ascending time; of each satellite the stretches {from, to, state, used}, and those of the
 * kinds of solution {from, to, kind}.
 */
export class History {
    constructor() {
        this.clear();
    }

    clear() {
        this.samples = [];
        this.states = new Map();
        this.solutions = [];
        this.corrected = false; // corrections have come in
    }

    /** @param speed s of the run in one of real time */
    add(time, receiver, speed = 1) {
        const last = this.samples.at(-1);
        if (last && time < last.time) this.clear(); // the program has begun anew
        if (last && time === last.time) return;
        const moment = { time, gap: longestGap * Math.max(speed, 1) };
        for (const satellite of receiver.satellites) this.addState(moment, satellite);
        extend(this.solutions, moment, { kind: solutionKind(receiver.fix.type) });
        this.corrected ||= Boolean(receiver.corrections);
        const error = receiver.error;
        this.samples.push({
            time,
            truth: receiver.truth,
            fix: receiver.fix.place ?? null,
            ok: receiver.fix.ok,
            epoch: receiver.epoch_s,
            east: error?.east_m ?? null,
            north: error?.north_m ?? null,
            horizontal: error ? Math.hypot(error.east_m, error.north_m) : null,
            up: error ? Math.abs(error.up_m) : null,
            claimed: receiver.fix.h_acc_m ?? null,
        });
        if (this.samples.length > mostSamples) this.thin();
    }

    addState(moment, { id, state, used }) {
        if (!this.states.has(id)) this.states.set(id, []);
        extend(this.states.get(id), moment, { state, used });
    }

    /** Samples with a position from a time on, one of each epoch: snapshots may come faster than those. */
    positions(from) {
        return this.samples.filter((sample, index, all) =>
            sample.time >= from && sample.east !== null && sample.epoch !== all[index - 1]?.epoch);
    }

    // Every other one of the older half goes.
    thin() {
        const half = this.samples.length / 2;
        this.samples = this.samples.filter((sample, index) => index >= half || index % 2 === 0);
    }
}
