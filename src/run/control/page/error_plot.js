// Errors over time: reported minus true, by decades, with the faults behind them.
import { colour } from "./appearance.js";
import { context, once, polyline } from "./canvas.js";
import { byId } from "./dom.js";
import { roundMetres } from "./format.js";
import { drawSolutions, solutionsHeight, solutionsText } from "./solutions.js";
import { drawTimes, takeGridPen, timeWindow } from "./time_axis.js";

const left = 58;
const right = 10;
const top = 8;
const bottom = 22;
const least = 0.1; // m; what is smaller is drawn there …
const leastCorrected = 0.001; // … of a receiver that takes corrections
const gap = 6; // between the errors and the kinds of solution below

export class ErrorPlot {
    constructor() {
        this.canvas = byId("errors");
        this.span = Number(byId("error-span").value);
        byId("error-span").onchange = (event) => {
            this.span = Number(event.target.value);
            this.paint();
        };
        this.paint = once(() => this.draw());
        new ResizeObserver(this.paint).observe(this.canvas);
    }

    /** @param now s of the run */
    show(history, bars, now) {
        Object.assign(this, { history, bars, now });
        this.paint();
    }

    draw() {
        const area = context(this.canvas);
        if (!area || !this.history) return;
        const { pen, width, height } = area;
        const { begin, span } = timeWindow(this.history, this.span, this.now);
        // One from before the window, so that lines come in from its edge.
        const from = this.history.samples.findIndex((sample) => sample.time >= begin);
        const samples = from < 0 ? [] : this.history.samples.slice(Math.max(from - 1, 0));
        const largest = samples.reduce((m, s) => Math.max(m, s.horizontal ?? 0, s.up ?? 0, s.claimed ?? 0), 10);
        this.least = this.history.corrected ? leastCorrected : least;
        const decades = Math.ceil(Math.log10(Math.min(largest, 1e8) / this.least) - 1e-9);
        const x = (time) => left + ((time - begin) / span) * (width - left - right);
        const low = height - bottom - (this.history.corrected ? solutionsHeight + gap : 0);
        const y = (value) => low - (Math.log10(Math.max(value, this.least) / this.least) / decades) * (low - top);
        this.drawBehind(pen, { x, low, width, samples, begin });
        this.drawGrid(pen, { x, y, low, height, width, decades, begin, span });
        this.drawSolutions(pen, { x, low, width });
        pen.save();
        pen.beginPath();
        pen.rect(left, 0, width - left - right, height);
        pen.clip();
        const line = (name, value, wide, dash = []) => {
            pen.strokeStyle = colour(name);
            pen.lineWidth = wide;
            pen.setLineDash(dash);
            polyline(pen, samples.map((s) => (s[value] === null ? null : [x(s.time), Math.max(y(s[value]), 1)])));
        };
        line("claimed", "claimed", 1.5, [5, 4]);
        line("vertical", "up", 1.5);
        line("fix", "horizontal", 2.5);
        pen.restore();
        pen.setLineDash([]);
    }

    // Only where corrections have come in: else there is nothing to tell but whether there is a fix.
    drawSolutions(pen, { x, low, width }) {
        const { corrected, solutions } = this.history;
        if (corrected) drawSolutions(pen, solutions, { x, left, right: width - right, top: low + gap });
        this.canvas.setAttribute("aria-label",
            corrected ? `Error over time; solution ${solutionsText(solutions)}` : "Error over time");
    }

    drawBehind(pen, { x, low, width, samples, begin }) {
        const band = (from, to, name) => {
            const [a, b] = [Math.max(x(from), left), Math.min(x(to), width - right)];
            if (b <= a) return;
            pen.fillStyle = colour(name);
            pen.fillRect(a, top, Math.max(b - a, 1), low - top);
        };
        for (const bar of this.bars)
            if (bar.what === "fault" && bar.begins_s !== null && bar.begins_s <= this.now)
                band(bar.begins_s, bar.active ? this.now : Math.min(bar.ends_s ?? this.now, this.now), "fault-soft");
        for (let i = 0; i < samples.length; ++i)
            if (!samples[i].ok)
                band(Math.max(samples[i].time, begin), samples[i + 1]?.time ?? this.now, "nofix-soft");
    }

    drawGrid(pen, { x, y, low, height, width, decades, begin, span }) {
        takeGridPen(pen);
        pen.textAlign = "right";
        pen.beginPath();
        const every = Math.ceil((decades + 1) / Math.max(Math.floor((low - top) / 20), 2));
        for (let decade = 0; decade <= decades; decade += every) {
            const value = this.least * 10 ** decade;
            const at = Math.round(y(value)) + 0.5;
            pen.moveTo(left, at);
            pen.lineTo(width - right, at);
            pen.fillText(roundMetres(value), left - 6, Math.max(at, 8));
        }
        pen.stroke();
        drawTimes(pen, { x, begin, span, now: this.now, left, right: width - right, top, bottom: height - bottom });
    }
}
