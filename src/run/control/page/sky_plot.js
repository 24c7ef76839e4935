// The sky above the antenna: north up, zenith in the middle, colour by C/N0, shape by how the signal comes.
import { cn0Class, cn0Classes } from "./appearance.js";
import { byId, draw, make, say } from "./dom.js";
import { figures } from "./format.js";

const radius = 100;
const size = 7;

function place(satellite) {
    const distance = (radius * (90 - Math.max(satellite.el_deg, 0))) / 90;
    const azimuth = (satellite.az_deg * Math.PI) / 180;
    return { x: distance * Math.sin(azimuth), y: -distance * Math.cos(azimuth) };
}

function strongest(satellite) {
    const values = Object.values(satellite.cn0_dbhz);
    return values.length ? Math.max(...values) : NaN;
}

/** How a satellite's signal comes, by its `state`. */
export const stateWords = { line_of_sight: "line of sight", shadowed: "shadowed", reflected: "reflected", blocked: "blocked" };

function shape(state, attributes) {
    if (state === "line_of_sight") return draw("circle", { r: size, ...attributes });
    const half = size * 0.9;
    if (state === "shadowed")
        return draw("path", { d: `M${-half},${-half} H${half} V${half} H${-half} Z`, ...attributes });
    const s = size * 1.25;
    if (state === "reflected") return draw("path", { d: `M0,${-s} L${s},0 L0,${s} L${-s},0 Z`, ...attributes });
    const c = size * 0.62;
    return draw("path", { d: `M${-c},${-c} L${c},${c} M${c},${-c} L${-c},${c}`, ...attributes });
}

function satelliteMark(satellite) {
    const { x, y } = place(satellite);
    const cn0 = strongest(satellite);
    const told = [
        satellite.id,
        stateWords[satellite.state],
        Number.isFinite(cn0) ? `${cn0.toFixed(0)} dB-Hz` : "not tracked",
        satellite.paths > 1 ? `${satellite.paths} paths` : null,
        satellite.used ? "used" : "not used",
        satellite.healthy ? null : "unhealthy",
        `azimuth ${satellite.az_deg.toFixed(0)}°, elevation ${satellite.el_deg.toFixed(0)}°`,
    ];
    const label = draw("text", { y: size + 10.5, class: "sat-name" });
    label.textContent = satellite.id;
    const title = draw("title");
    title.textContent = told.filter(Boolean).join(", ");
    const group = draw("g", { transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`, class: `sat sat-${satellite.state}` });
    group.append(title);
    if (satellite.used) group.append(draw("circle", { r: size + 2.6, class: "sat-used" }));
    group.append(shape(satellite.state, { class: `cn0-${cn0Class(cn0)}` }), label);
    if (!satellite.healthy) group.append(draw("path", { d: `M${-size},${size} L${size},${-size}`, class: "sat-ill" }));
    return group;
}

function grid() {
    const group = draw("g", { class: "sky-grid" });
    for (const elevation of [0, 30, 60]) {
        const r = (radius * (90 - elevation)) / 90;
        group.append(draw("circle", { r }));
        if (!elevation) continue;
        const label = draw("text", { x: 2, y: -r + 9 });
        label.textContent = `${elevation}°`;
        group.append(label);
    }
    group.append(draw("path", { d: `M0,${-radius} V${radius} M${-radius},0 H${radius}` }));
    for (const [name, x, y] of [["N", 0, -111], ["E", 116, 4], ["S", 0, 120], ["W", -116, 4]]) {
        const label = draw("text", { x, y, class: "sky-side" });
        label.textContent = name;
        group.append(label);
    }
    return group;
}

function legendItem(symbol, text) {
    const picture = draw("svg", { viewBox: "-10 -10 20 20", class: "legend-mark", "aria-hidden": "true" }, ...symbol);
    return make("li", {}, picture, text);
}

/** Draws into #sky; returns the function that shows a receiver. */
export function setUpSkyPlot() {
    const sky = byId("sky");
    const satellites = draw("g");
    sky.append(grid(), satellites);
    const legend = byId("sky-legend");
    cn0Classes.forEach((one, index) =>
        legend.append(legendItem([draw("circle", { r: 8, class: `cn0-${index}` })], one.name)),
    );
    legend.append(make("li", { class: "break" }));
    for (const [state, text] of Object.entries(stateWords)) {
        const symbol = draw("g", { class: `sat-${state}` }, shape(state, { class: "cn0-none" }));
        legend.append(legendItem([symbol], text));
    }
    legend.append(legendItem([draw("circle", { r: size + 2.6, class: "sat-used" })], "used"));
    return (receiver) => {
        // The weak ones last: what is in trouble is not to be covered.
        const order = [...receiver.satellites].sort((a, b) => (strongest(b) || 0) - (strongest(a) || 0));
        satellites.replaceChildren(...order.map(satelliteMark));
        const used = receiver.satellites.filter((satellite) => satellite.used).length;
        sky.setAttribute("aria-label", `Sky: ${receiver.satellites.length} satellites, ${used} used`);
        const { dop } = receiver.fix;
        say(byId("sky-dop"), dop ? `PDOP ${figures(dop.p, 2)}` : "");
    };
}
