// Faults and commands over the time of the run, a row each.
import { byId, draw, make, mark, say } from "./dom.js";
import { clock, clockStep, percent, words } from "./format.js";

const ahead = 30; // s shown after now in a run without an end
const width = 1000;
const rowHeight = 26;

function groupOf(bars) {
    const rows = new Map();
    for (const bar of bars) {
        const key = `${bar.what} ${bar.name}`;
        rows.set(key, (rows.get(key) ?? []).concat(bar));
    }
    return [...rows.values()];
}

function stateOf(row, now) {
    if (row.some((bar) => bar.active)) return "active";
    if (row.some((bar) => bar.strength > 0)) return "fading";
    if (row.some((bar) => bar.begins_s === null || bar.begins_s > now)) return "planned";
    return "over";
}

const stateWords = { active: "active", fading: "fading", planned: "to come", over: "over" };

// What one reads beside a row: "active", "active, 40 %", "every 60 s".
function stateText(row, state) {
    const waits = row.find((bar) => bar.begins_s === null);
    if (state === "planned" && waits) return waits.words || "waits";
    const strength = Math.max(...row.map((bar) => bar.strength));
    return state === "fading" || (state === "active" && strength < 0.995)
        ? `${stateWords[state]}, ${percent(strength)}` : stateWords[state];
}

export class Timeline {
    /** @param act {stop(name), start(name)} */
    constructor(act) {
        this.act = act;
        this.key = "";
    }

    show(status) {
        const rows = groupOf(status.timeline);
        byId("timeline-none").hidden = rows.length > 0;
        byId("timeline-box").hidden = rows.length === 0;
        const last = Math.max(0, ...status.timeline.map((bar) => bar.ends_s ?? bar.begins_s ?? 0));
        this.end = status.span_s ?? Math.max(status.elapsed_s + ahead, Math.min(last * 1.05, status.elapsed_s * 4 + 600));
        // Rows with their buttons stay where they are while nothing but times changes: a finger may be on them.
        const key = JSON.stringify(rows.map((row) => [row[0].what, row[0].name, row[0].live]));
        if (key !== this.key) this.build(rows);
        this.key = key;
        this.drawScale(status.elapsed_s);
        rows.forEach((row, index) => this.update(this.rows[index], row, status.elapsed_s));
    }

    build(rows) {
        this.rows = rows.map((row) => {
            const [first] = row;
            const state = make("span", { class: "row-state" });
            const picture = draw("svg", {
                viewBox: `0 0 ${width} ${rowHeight}`, preserveAspectRatio: "none", class: "row-bars", "aria-hidden": "true",
            });
            const button = make("button", { type: "button", class: "small" });
            button.onclick = () => (button.dataset.does === "stop" ? this.act.stop : this.act.start)(first.name);
            const told = [words(first.kind), first.receiver ? `on ${first.receiver}` : null, first.live ? "live" : null];
            const name = make("span", { class: "row-name" }, make("b", {}, first.name),
                make("small", {}, told.filter((text) => text && text !== words(first.name)).join(", ")));
            return { element: make("li", { class: "row" }, name, picture, state, button), picture, state, button };
        });
        byId("timeline").replaceChildren(...this.rows.map((row) => row.element));
    }

    update(shown, row, now) {
        const state = stateOf(row, now);
        mark(shown.element, "state", state);
        say(shown.state, stateText(row, state));
        const [first] = row;
        const does = first.what === "command" ? "" : state === "active" ? "stop" : first.live ? "" : "start";
        mark(shown.button, "does", does);
        shown.button.classList.toggle("absent", does === "");
        shown.button.disabled = does === "";
        say(shown.button, does === "stop" ? "Stop" : "Begin");
        shown.button.setAttribute("aria-label", `${does === "stop" ? "Stop" : "Begin"} ${first.name}`);
        shown.picture.replaceChildren(...row.flatMap((bar) => this.barOf(bar, now)),
            draw("line", { x1: this.x(now), x2: this.x(now), y1: 0, y2: rowHeight, class: "now" }));
    }

    x(time) {
        return (width * Math.min(Math.max(time, 0), this.end)) / this.end;
    }

    barOf(bar, now) {
        if (bar.begins_s === null) return [];
        const from = this.x(bar.begins_s);
        if (bar.what === "command") return [draw("rect", { x: from - 2, y: 4, width: 5, height: 18, class: "bar-command" })];
        const to = bar.ends_s !== null && !(bar.active && bar.ends_s < now) ? bar.ends_s : bar.active ? now : this.end;
        const kind = bar.active ? "bar-active" : bar.strength > 0 ? "bar-fading" : bar.begins_s > now ? "bar-planned" : "bar-over";
        const shapes = [draw("rect", { x: from, y: 4, width: Math.max(this.x(to) - from, 3), height: 18, class: kind })];
        if (bar.active && bar.ends_s !== null && bar.ends_s > now)
            shapes.push(draw("rect", { x: from, y: 4, width: Math.max(this.x(now) - from, 3), height: 18, class: "bar-done" }));
        // How strong it is now, as a level at the end of what has passed.
        if (bar.strength > 0 && bar.strength < 0.995) {
            const height = rowHeight * bar.strength;
            shapes.push(draw("rect", { x: this.x(now) - 14, y: 0, width: 14, height: rowHeight, class: "level-ground" }),
                draw("rect", { x: this.x(now) - 14, y: rowHeight - height, width: 14, height, class: "level" }));
        }
        return shapes;
    }

    drawScale(now) {
        const step = clockStep(this.end / 8);
        const key = `${step} ${Math.round(this.end)}`;
        say(byId("timeline-now"), clock(now));
        if (key === this.scaleKey) return;
        this.scaleKey = key;
        const ticks = [];
        for (let time = 0; time <= this.end * 0.97; time += step) {
            const tick = make("span", {}, clock(time));
            tick.style.left = `${(100 * time) / this.end}%`;
            ticks.push(tick);
        }
        byId("timeline-scale").replaceChildren(...ticks);
    }
}
