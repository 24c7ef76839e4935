// C/N0 of every signal: a group of bars a satellite, a colour a band.
import { byId, draw, make } from "./dom.js";

const narrowest = 8; // px, of a bar
const widest = 22;
const gap = 7;
const left = 30;
const top = 14;
const bottom = 20;
const leastHeight = 150;
const highest = 55; // dB-Hz

// RINEX 3.05, tables of observation codes: the digit of a code is its band; B1I of BeiDou is called 2.
function bandOf(constellation, code) {
    if (constellation === "C" && code[0] === "2") return "1";
    return { 1: "1", 2: "2", 4: "1", 3: "2", 5: "5", 7: "5", 8: "5", 6: "6" }[code[0]] ?? "1";
}

const bandNames = { 1: "L1, E1, B1", 2: "L2", 5: "L5, E5, B2", 6: "E6, B3" };

// Satellites without a name's width of bars take that much.
function unitsOf(satellite) {
    return Math.max(Object.keys(satellite.cn0_dbhz).length, 2);
}

/** Where things are, in pixels of the page. */
function layout(box, satellites) {
    const units = satellites.reduce((sum, satellite) => sum + unitsOf(satellite), 0);
    const spare = box.clientWidth - left - 4 - satellites.length * gap;
    const bar = Math.min(Math.max(spare / Math.max(units, 1), narrowest), widest);
    const height = Math.max(box.clientHeight - 6, leastHeight);
    const width = Math.max(left + 4 + satellites.length * gap + units * bar, box.clientWidth);
    const y = (value) => top + (height - top - bottom) * (1 - Math.min(Math.max(value, 0), highest) / highest);
    return { bar, width, height, y };
}

function scale({ width, y }) {
    const group = draw("g", { class: "bar-grid" });
    for (const value of [0, 10, 20, 30, 40, 50]) {
        group.append(draw("line", { x1: left - 4, x2: width, y1: y(value), y2: y(value) }));
        const label = draw("text", { x: left - 8, y: y(value) + 3.5 });
        label.textContent = value;
        group.append(label);
    }
    return group;
}

function satelliteBars(satellite, from, { bar, y }) {
    const signals = Object.entries(satellite.cn0_dbhz);
    const group = draw("g", { class: satellite.used ? "bars used" : "bars" });
    const middle = from + (unitsOf(satellite) * bar) / 2;
    const begin = middle - (signals.length * bar) / 2;
    signals.forEach(([code, value], index) => {
        const title = draw("title");
        title.textContent = `${satellite.id} ${code}: ${value.toFixed(1)} dB-Hz`;
        const place = { x: begin + index * bar, y: y(value), width: bar - 1, height: Math.max(y(0) - y(value), 1) };
        group.append(draw("rect", { ...place, class: `band-${bandOf(satellite.id[0], code)}` }, title));
    });
    const most = Math.max(...signals.map(([, value]) => value));
    const best = draw("text", { x: middle, y: y(most) - 3, class: "bar-value" });
    best.textContent = most.toFixed(0);
    const name = draw("text", { x: middle, y: y(0) + 14, class: "bar-name" });
    name.textContent = satellite.id;
    group.append(best, name);
    return group;
}

function legend(list, receiver) {
    const bands = new Map();
    for (const satellite of receiver.satellites)
        for (const code of Object.keys(satellite.cn0_dbhz)) {
            const band = bandOf(satellite.id[0], code);
            bands.set(band, (bands.get(band) ?? new Set()).add(code));
        }
    const rows = [...bands].sort().map(([band, codes]) => [band, [...codes].sort().join(", ")]);
    const key = JSON.stringify(rows);
    if (list.dataset.key === key) return;
    list.dataset.key = key;
    list.replaceChildren(
        ...rows.map(([band, codes]) => {
            const mark = draw("svg", { viewBox: "0 0 12 12", class: "legend-mark", "aria-hidden": "true" });
            mark.append(draw("rect", { width: 12, height: 12, rx: 2, class: `band-${band}` }));
            return make("li", {}, mark, `${bandNames[band]} (${codes})`);
        }),
        make("li", {}, "pale: not used"),
    );
}

/** Draws into #bars; returns the function that shows a receiver. */
export function setUpBars() {
    const svg = byId("bars");
    const box = svg.parentElement;
    return (receiver) => {
        const tracked = receiver.satellites
            .filter((satellite) => Object.keys(satellite.cn0_dbhz).length)
            .sort((a, b) => a.id.localeCompare(b.id));
        const frame = layout(box, tracked);
        svg.setAttribute("width", frame.width);
        svg.setAttribute("height", frame.height);
        svg.replaceChildren(scale(frame));
        let x = left;
        for (const satellite of tracked) {
            svg.append(satelliteBars(satellite, x, frame));
            x += unitsOf(satellite) * frame.bar + gap;
        }
        svg.setAttribute("aria-label", `C/N0 of ${tracked.length} satellites`);
        byId("bars-none").hidden = tracked.length > 0;
        legend(byId("bars-legend"), receiver);
    };
}
