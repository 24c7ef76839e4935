// Messages on the wires, decoded, both ways; and what has happened.
import { once } from "./canvas.js";
import { byId, make, say } from "./dom.js";
import { clock } from "./format.js";

const mostKept = 1500; // of each direction: a receiver says far more than its client
const mostShown = 250;

function time(seconds) {
    return `${clock(seconds)}.${String(Math.floor((Math.abs(seconds) % 1) * 10))}`;
}

export class Dialogue {
    constructor() {
        this.lines = [];
        this.held = null;
        this.names = [];
        this.paint = once(() => this.draw());
        for (const id of ["dialogue-from", "dialogue-protocol", "dialogue-text"])
            byId(id).addEventListener("input", this.paint);
        byId("dialogue-hold").onclick = () => this.hold(this.held === null);
        byId("dialogue-clear").onclick = () => {
            this.lines = [];
            if (this.held) this.held = [];
            this.paint();
        };
    }

    /** A held list stands still to be read; new lines are kept behind it. */
    hold(held) {
        this.held = held ? [...this.lines] : null;
        byId("dialogue-hold").setAttribute("aria-pressed", String(held));
        say(byId("dialogue-hold"), held ? "Go on" : "Hold");
        this.paint();
    }

    add(lines, receivers) {
        this.names = receivers;
        if (!lines.length) return;
        // Numbers begin anew with the program; after a lost connection the rings come whole.
        const last = this.lines.at(-1)?.seq ?? 0;
        const anew = lines.at(-1).seq < last;
        if (anew) this.lines = [];
        const fresh = anew ? lines : lines.filter((line) => line.seq > last);
        this.lines.push(...fresh);
        this.forget();
        this.offerProtocols(fresh);
        if (this.held !== null) return;
        if (anew) this.paint();
        else this.prepend(fresh);
    }

    forget() {
        for (const from of ["client", "receiver"]) {
            let surplus = this.lines.filter((line) => line.from === from).length - mostKept;
            if (surplus > 0) this.lines = this.lines.filter((line) => line.from !== from || surplus-- <= 0);
        }
    }

    // What stands there stays, so that it can be opened and marked while more comes.
    prepend(fresh) {
        const list = byId("dialogue");
        list.prepend(...fresh.filter(this.matches()).slice(-mostShown).reverse().map((line) => this.row(line)));
        while (list.children.length > mostShown) list.lastElementChild.remove();
        this.count();
    }

    offerProtocols(lines) {
        const select = byId("dialogue-protocol");
        const known = new Set([...select.options].map((option) => option.value));
        for (const { protocol } of lines)
            if (!known.has(protocol)) {
                known.add(protocol);
                select.append(make("option", { value: protocol }, protocol));
            }
    }

    matches() {
        const from = byId("dialogue-from").value;
        const protocol = byId("dialogue-protocol").value;
        const text = byId("dialogue-text").value.trim().toLowerCase();
        return (line) =>
            (!from || line.from === from) &&
            (!protocol || line.protocol === protocol) &&
            (!text || `${line.name} ${line.text} ${line.hex}`.toLowerCase().includes(text));
    }

    count() {
        const source = this.held ?? this.lines;
        const fitting = source.filter(this.matches()).length;
        say(byId("dialogue-count"), fitting === source.length ? `${fitting} kept` : `${fitting} of ${source.length}`);
        byId("dialogue-none").hidden = fitting > 0;
    }

    draw() {
        const fitting = (this.held ?? this.lines).filter(this.matches());
        byId("dialogue").replaceChildren(...fitting.slice(-mostShown).reverse().map((line) => this.row(line)));
        this.count();
    }

    row(line) {
        const client = line.from === "client";
        const several = this.names.length > 1 ? `${this.names[line.receiver] ?? line.receiver} ` : "";
        const name = line.name || line.protocol;
        const text = line.text.replace(/^(NMEA|UBX|RTCM\S*) \S+ /, "");
        const summary = make("summary", {},
            make("span", { class: "line-time" }, time(line.t_s)),
            make("span", { class: "line-from" }, several + (client ? "client →" : "← receiver")),
            make("span", { class: "line-name" }, name),
            make("span", { class: "line-text" }, text));
        const more = make("p", { class: "line-more" }, line.text, make("br"), `${line.bytes} bytes: `,
            make("code", {}, line.hex));
        return make("li", { class: `line from-${line.from}` }, make("details", {}, summary, more));
    }
}

/** What has happened, newest first. Returns the function that takes new lines. */
export function setUpEvents() {
    let last = 0;
    return (events) => {
        const list = byId("events");
        if (events.length && events.at(-1).seq < last) {
            list.replaceChildren();
            last = 0;
        }
        for (const event of events.filter((line) => line.seq > last)) {
            list.prepend(make("li", {}, make("span", { class: "line-time" }, time(event.t_s)),
                make("b", {}, event.what), " ", event.text));
            last = event.seq;
        }
        while (list.children.length > 200) list.lastElementChild.remove();
        byId("events-none").hidden = list.children.length > 0;
    };
}
