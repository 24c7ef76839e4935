// How each satellite's signals came over time: a row a satellite, a colour a state.
import { colour } from "./appearance.js";
import { context, once } from "./canvas.js";
import { byId, draw, make } from "./dom.js";
import { stateWords } from "./sky_plot.js";
import { drawTimes, timeWindow } from "./time_axis.js";

const rowHeight = 12;
const left = 34;
const right = 10;
const top = 4;
const bottom = 22;
const least = 8; // rows that there is room for
const pale = 0.45; // of a satellite that is not used

export class StatePlot {
    constructor() {
        this.canvas = byId("states");
        const span = byId("states-span");
        span.onchange = () => this.paint();
        this.paint = once(() => this.draw(Number(span.value)));
        new ResizeObserver(this.paint).observe(this.canvas);
        for (const [state, text] of Object.entries(stateWords)) {
            const mark = draw("svg", { viewBox: "0 0 12 12", class: "legend-mark", "aria-hidden": "true" });
            mark.append(draw("rect", { width: 12, height: 12, rx: 2, class: `state-${state}` }));
            byId("states-legend").append(make("li", {}, mark, text));
        }
        byId("states-legend").append(make("li", {}, "pale: not used"));
    }

    /** @param now s of the run */
    show(history, now) {
        Object.assign(this, { history, now });
        this.paint();
    }

    draw(wanted) {
        if (!this.history) return;
        const { begin, span } = timeWindow(this.history, wanted, this.now);
        const rows = [...this.history.states].sort().filter(([, stretches]) => stretches.at(-1).to >= begin);
        this.canvas.style.height = `${top + bottom + rowHeight * Math.max(rows.length, least)}px`;
        const area = context(this.canvas);
        if (!area) return;
        const { pen, width, height } = area;
        const x = (time) => left + ((time - begin) / span) * (width - left - right);
        drawTimes(pen, { x, begin, span, now: this.now, left, right: width - right, top, bottom: height - bottom });
        rows.forEach(([id, stretches], index) => {
            const y = top + index * rowHeight;
            pen.fillStyle = colour("ink");
            pen.textAlign = "right";
            pen.fillText(id, left - 6, y + rowHeight / 2);
            for (const { from, to, state, used } of stretches) {
                if (to < begin) continue;
                const first = Math.max(x(from), left);
                pen.globalAlpha = used ? 1 : pale;
                pen.fillStyle = colour(`state-${state}`);
                pen.fillRect(first, y + 1, Math.max(x(to) - first, 1), rowHeight - 2);
            }
            pen.globalAlpha = 1;
        });
        this.canvas.setAttribute("aria-label", `States of ${rows.length} satellites over time`);
    }
}
