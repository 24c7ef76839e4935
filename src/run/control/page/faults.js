// Faults and commands: the list of kinds, the form of one, and the question before it begins.
import { ask, attempt } from "./ask.js";
import { get, post, stopFault } from "./connection.js";
import { byId, make, mark, say } from "./dom.js";
import { formFor } from "./form.js";
import { percent, words } from "./format.js";

const layerTitles = {
    signals: "Signals", solution: "Solution", receiver: "Receiver", wire: "Wire", corrections: "Corrections",
    command: "Commands, at once",
};

// These have buttons of their own.
const elsewhere = ["start_fault", "stop_fault", "pause", "resume", "step", "speed", "stop"];

// Of every live fault; the program takes them beside the kind's own.
const timing = [
    { name: "for_s", type: "number", meaning: "else until it is stopped", standard: null, least: 0, most: 1e9 },
    { name: "ramp_in_s", type: "number", meaning: "grows to its full strength", standard: 0, least: 0, most: 1e9 },
    { name: "ramp_out_s", type: "number", meaning: "fades after its end", standard: 0, least: 0, most: 1e9 },
];

// What a fault works on; nothing chosen is everything, which is what one mostly wants.
function isSelector(spec) {
    return !spec.needed && /^(constellations|satellites|satellite_count|signals|(azimuth|elevation)_(from|to)_deg)$/.test(spec.name);
}

function summary(kind, values, receiver) {
    const shown = Object.entries(values).map(([name, value]) => `${name} = ${Array.isArray(value) ? value.join(", ") : value}`);
    return [receiver ? `on ${receiver}` : "on all receivers", ...shown].join(" · ");
}

function unlessStandard(kind, values) {
    const standards = new Map([...kind.parameters, ...timing].map((spec) => [spec.name, JSON.stringify(spec.standard)]));
    return Object.fromEntries(Object.entries(values).filter(([name, value]) => standards.get(name) !== JSON.stringify(value)));
}

export class Faults {
    constructor() {
        this.kinds = [];
        this.receivers = [];
        this.form = null;
        byId("fault-search").addEventListener("input", () => this.filter());
        byId("fault-search").addEventListener("keydown", (event) => this.searchKey(event));
        byId("fault-back").onclick = () => this.choose(null);
        byId("fault-form").addEventListener("submit", (event) => {
            event.preventDefault();
            this.begin();
        });
        byId("fault-form").addEventListener("keydown", (event) => {
            if (event.key === "Escape") this.choose(null);
        });
        byId("stop-all").onclick = () => this.stopAll();
    }

    async load() {
        const [faults, commands] = await Promise.all([get("/api/faults"), get("/api/commands")]);
        const actions = commands.filter((command) => !elsewhere.includes(command.name));
        this.kinds = [
            ...faults,
            ...actions.map((c) => ({ ...c, layer: "command", effect: c.meaning, cause: "", command: true })),
        ];
        const list = byId("fault-kinds");
        list.replaceChildren();
        for (const [layer, title] of Object.entries(layerTitles)) {
            const kinds = this.kinds.filter((kind) => kind.layer === layer);
            if (!kinds.length) continue;
            const buttons = kinds.map((kind) => {
                const button = make("button", { type: "button", class: "kind", title: kind.effect }, words(kind.name));
                button.dataset.kind = kind.name;
                button.onclick = () => this.choose(kind);
                return button;
            });
            const open = matchMedia("(min-width: 700px)").matches;
            list.append(make("details", { open }, make("summary", {}, title), make("div", { class: "kinds" }, ...buttons)));
        }
        this.filter();
    }

    filter() {
        const wanted = byId("fault-search").value.trim().toLowerCase().split(/\s+/);
        let any = false;
        for (const section of byId("fault-kinds").children) {
            let some = false;
            for (const button of section.querySelectorAll("button")) {
                const kind = this.kinds.find((each) => each.name === button.dataset.kind);
                const text = `${words(kind.name)} ${kind.name} ${kind.effect} ${kind.cause}`.toLowerCase();
                button.hidden = !wanted.every((word) => text.includes(word));
                some ||= !button.hidden;
            }
            section.hidden = !some;
            if (wanted[0]) section.open = true;
            any ||= some;
        }
        byId("fault-none").hidden = any;
    }

    // Enter takes the first that fits, as in a list of commands.
    searchKey(event) {
        if (event.key === "Enter") {
            // Or the same press would be one of the button that has the focus next.
            event.preventDefault();
            byId("fault-kinds").querySelector("details:not([hidden]) button:not([hidden])")?.click();
        }
        if (event.key === "Escape") {
            event.target.value = "";
            this.filter();
            event.target.blur();
        }
    }

    choose(kind) {
        const before = this.kind;
        this.kind = kind;
        byId("fault-choice").hidden = kind !== null;
        byId("fault-form").hidden = kind === null;
        if (!kind) {
            byId("fault-kinds").querySelector(`[data-kind="${before?.name}"]`)?.focus();
            return;
        }
        say(byId("fault-title"), words(kind.name));
        say(byId("fault-effect"), kind.effect);
        say(byId("fault-cause"), kind.cause);
        const several = this.receivers.length > 1 && (!kind.command || kind.of_receiver);
        const receiver = several
            ? [{ name: "receiver", type: "word", meaning: "not set: all", standard: "", choices: this.receivers }]
            : [];
        const [duration, ...ramps] = kind.command ? [] : timing;
        this.form = formFor([
            { specs: [duration, ...receiver, ...kind.parameters.filter((spec) => !isSelector(spec))].filter(Boolean) },
            { title: "Which satellites and signals", specs: kind.parameters.filter(isSelector) },
            { title: "Ramps", specs: ramps },
        ]);
        byId("fault-fields").replaceChildren(...this.form.elements);
        say(byId("fault-begin"), kind.command ? "Give command…" : "Begin fault…");
        (byId("fault-fields").querySelector("input, select") ?? byId("fault-begin")).focus();
        byId("fault-title").scrollIntoView({ block: "nearest" });
    }

    async begin() {
        const { kind } = this;
        const read = this.form.read();
        if (!read) return;
        const { receiver, ...values } = read;
        const told = unlessStandard(kind, values);
        const agreed = await ask({
            title: `${kind.command ? "Give command" : "Begin fault"}: ${words(kind.name)}?`,
            text: summary(kind, told, receiver),
            yes: kind.command ? "Give command" : "Begin fault",
        });
        if (!agreed) return;
        const whole = receiver ? { ...told, receiver } : told;
        const done = kind.command
            ? await attempt(() => post("/api/commands", { command: kind.name, ...whole }), `${words(kind.name)}: given`)
            : await attempt(() => post("/api/faults", { kind: kind.name, name: this.freeName(kind.name), ...whole }),
                `${words(kind.name)}: begun`);
        if (!done) return;
        byId("fault-search").value = "";
        this.filter();
        this.choose(null);
    }

    // Each live fault has its own row and its own Stop.
    freeName(kind) {
        const taken = new Set((this.bars ?? []).map((bar) => bar.name));
        if (!taken.has(kind)) return kind;
        let number = 2;
        while (taken.has(`${kind}-${number}`)) ++number;
        return `${kind}-${number}`;
    }

    async stop(name) {
        await attempt(() => stopFault(name), `${name}: stopped`);
    }

    async start(name) {
        const agreed = await ask({ title: `Begin ${name} now?`, text: "As the scenario describes it.", yes: "Begin fault" });
        if (agreed) await attempt(() => post("/api/commands", { command: "start_fault", fault: name }), `${name}: begun`);
    }

    async stopAll() {
        if (this.active?.length) await attempt(() => post("/api/commands", { command: "stop_fault" }), "all faults: stopped");
    }

    /** @param status the snapshot: which faults are at work */
    show(status) {
        this.bars = status.timeline;
        this.receivers = status.receivers.map((receiver) => receiver.name);
        const known = status.timeline.filter((bar) => bar.what === "fault");
        // One that fades while another of its name is at work is not worth a line of its own.
        this.active = known.filter((bar) => bar.active || (bar.strength > 0 && !known.some((other) => other.name === bar.name && other.active)));
        byId("stop-all").disabled = !this.active.some((bar) => bar.active);
        byId("active-none").hidden = this.active.length > 0;
        mark(byId("nav-faults"), "active", this.active.length > 0);
        say(byId("nav-faults"), this.active.length ? `Faults ${this.active.length}` : "Faults");
        const list = byId("active");
        const names = new Set(this.active.map((bar) => bar.name));
        for (const item of [...list.children]) if (!names.has(item.dataset.fault)) item.remove();
        for (const bar of this.active) this.showActive(list, bar, status.elapsed_s);
    }

    showActive(list, bar, now) {
        let item = [...list.children].find((each) => each.dataset.fault === bar.name);
        if (!item) {
            const stop = make("button", { type: "button", class: "danger", "aria-label": `Stop ${bar.name}` }, "Stop");
            stop.onclick = () => this.stop(bar.name);
            item = make("li", {}, make("b", {}, words(bar.name)), make("span", { class: "active-told" }),
                make("meter", { min: 0, max: 1, hidden: true, "aria-label": `Strength of ${bar.name}` }), stop);
            item.dataset.fault = bar.name;
            list.append(item);
        }
        const left = !bar.active ? "fading" : bar.ends_s !== null && bar.ends_s > now ? `${Math.ceil(bar.ends_s - now)} s left` : "until stopped";
        const strength = bar.strength < 0.995 ? `${percent(bar.strength)}, ` : "";
        say(item.querySelector(".active-told"), strength + left);
        const level = item.querySelector("meter");
        level.hidden = bar.strength >= 0.995;
        level.value = bar.strength;
        item.querySelector("button").disabled = !bar.active;
    }
}
