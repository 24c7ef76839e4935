// The time of the run across a canvas.
import { colour } from "./appearance.js";
import { clock, clockStep } from "./format.js";

const leastSpan = 20; // s

/** The last `span` seconds of what a history has seen, all of it where that is 0: {begin, span} in s of the run. */
export function timeWindow(history, span, now) {
    const seen = Math.max(now - (history.samples[0]?.time ?? 0), leastSpan);
    const shown = span ? Math.min(span, seen) : seen;
    return { begin: Math.max(now - shown, 0), span: shown };
}

/** Makes a pen that of grids and their labels. */
export function takeGridPen(pen) {
    pen.strokeStyle = colour("grid");
    pen.fillStyle = colour("ink-soft");
    pen.lineWidth = 1;
    pen.textBaseline = "middle";
}

/** Lines from `top` to `bottom` at round times, with the times below; x(time), `left` and `right` in pixels. */
export function drawTimes(pen, { x, begin, span, now, left, right, top, bottom }) {
    const step = clockStep((span * 80) / (right - left));
    takeGridPen(pen);
    pen.textAlign = "center";
    pen.beginPath();
    for (let time = Math.max(Math.ceil(begin / step) * step, 0); time <= now; time += step) {
        const at = Math.round(x(time)) + 0.5;
        pen.moveTo(at, top);
        pen.lineTo(at, bottom);
        if (at > left + 12 && at < right - 8) pen.fillText(clock(time), at, bottom + 13);
    }
    pen.stroke();
}
