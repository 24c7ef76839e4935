// How the receiver is, to be read from some metres away: the fix, its error, interference, lateness.
import { byId, mark, say } from "./dom.js";
import { clock, figures, metres } from "./format.js";

const fixWords = {
    none: "NO FIX", dead_reckoning: "DR ONLY", "2d": "2D FIX", "3d": "3D FIX", dgnss: "DGNSS FIX",
    rtk_float: "RTK FLOAT", rtk_fixed: "RTK FIXED", time_only: "TIME ONLY",
};

// As UBX-NAV-STATUS, spoofDetState, and UBX-MON-RF, jammingState, have them.
const spoofingWords = ["unknown", "none", "indicated", "multiple"];
const jammingWords = ["unknown", "none", "warning", "critical"];

// What of the corrections is in the solution.
const solutionWords = { none: "not used", differential: "DGNSS", float: "RTK float", fixed: "RTK fixed" };
const mostRatio = 1000; // that is told

const lateEnough = 20; // ms after which an epoch is late

// Three times what it claims: the receiver does not know how wrong it is.
function judged(error, claimed) {
    if (!claimed || !(error > 3 * claimed) || error < 5) return "";
    return error < 20 ? "warn" : "bad";
}

// What the receiver claims of an error, and how the satellites' geometry dilutes it.
function ownView(claimed, name, dilution) {
    const claim = claimed ? `claims ${metres(claimed)}` : "no claim";
    return dilution === undefined ? claim : `${claim}, ${name}\u00a0${figures(dilution, 2)}`;
}

function age(seconds) {
    return seconds < 100 ? `${seconds.toFixed(1)} s` : clock(seconds);
}

function millimetres(value) {
    return value.toFixed(3).replace(/^-(?=0\.0*$)/, "").replace("-", "−");
}

function card(id, text, state = "") {
    say(byId(`${id}-value`), text);
    mark(byId(id), "state", state);
}

/** What the receiver tells of a base station; "–" for what it does not. */
export function showCorrections({ corrections }) {
    const baseline = corrections?.baseline;
    mark(byId("corrections"), "state", corrections?.solution === "none" ? "warn" : "");
    const tell = (name, text) => say(byId(`corrections-${name}`), text ?? "–");
    tell("solution", solutionWords[corrections?.solution]);
    tell("age", corrections && age(corrections.age_s));
    tell("base", corrections && String(corrections.station));
    tell("length", baseline && metres(baseline.length_m));
    tell("vector", baseline && `${[baseline.north_m, baseline.east_m, baseline.down_m].map(millimetres).join(", ")} m`);
    tell("ratio", baseline?.ratio && (baseline.ratio < mostRatio ? figures(baseline.ratio) : `>${mostRatio}`));
}

/** "fix", "poor" (a position out of the receiver's own limits, or extrapolated) or "nofix". */
export function fixState(receiver) {
    const { type, ok } = receiver.fix;
    if (type === "none" || type === "time_only") return "nofix";
    return ok && type !== "dead_reckoning" ? "fix" : "poor";
}

export function showState(receiver) {
    const { fix, error } = receiver;
    const state = fixState(receiver);
    mark(byId("fix"), "state", state);
    const word = fixWords[fix.type] ?? fix.type.toUpperCase();
    say(byId("fix-word"), word);
    mark(byId("fix-word"), "long", word.length > 6);
    const inView = receiver.satellites.length;
    const extrapolated = fix.type === "dead_reckoning" ? "dead reckoning; " : "";
    const told = extrapolated || (state === "poor" ? "not within the receiver's limits; " : "");
    say(byId("fix-told"), `${told}${fix.satellites_used} of ${inView} satellites used`);
    const horizontal = error ? Math.hypot(error.east_m, error.north_m) : NaN;
    const claimed = fix.h_acc_m;
    card("error", metres(horizontal), judged(horizontal, claimed));
    say(byId("error-more"), ownView(claimed, "HDOP", fix.dop?.h));
    card("height", error ? metres(error.up_m) : "–");
    say(byId("height-more"), ownView(fix.v_acc_m, "VDOP", fix.dop?.v));
    card("speed", fix.speed_mps === undefined ? "–" : `${fix.speed_mps.toFixed(1)} m/s`);
    say(byId("speed-more"), `truly ${receiver.true_speed_mps.toFixed(1)} m/s`);
    card("jamming", jammingWords[receiver.jamming_state] ?? "–", ["", "", "warn", "bad"][receiver.jamming_state]);
    say(byId("jamming-more"), `noise +${figures(Math.max(receiver.interference_db, 0), 2)} dB`);
    card("spoofing", spoofingWords[receiver.spoofing] ?? "–", receiver.spoofing >= 2 ? "bad" : "");
    card("late", `${receiver.lateness_ms.toFixed(receiver.lateness_ms < 10 ? 1 : 0)} ms`,
        receiver.lateness_ms > lateEnough ? "warn" : "");
    say(byId("late-more"), `${receiver.rate_hz} Hz, epoch ${receiver.epochs}`);
}
