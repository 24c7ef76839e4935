// The wires: what went over them, what did not arrive, what the client believes.
import { byId, make, mark, say } from "./dom.js";
import { bytes } from "./format.js";
import { Rates } from "./rates.js";

const rateSpan = 2; // s over which a rate is taken

// Of wires that were fine all the time, nothing is told.
const losses = [
    ["bytes_lost", "lost: the client did not read in time"],
    ["bytes_unheard", "unheard: nobody listened"],
    ["bytes_garbled", "garbled: at another speed"],
];

function wireParts() {
    const [state, name, told, out, back, trouble, belief] = Array.from({ length: 7 }, () => make("span"));
    name.className = "wire-name";
    told.className = "wire-told";
    trouble.className = "wire-trouble";
    state.className = "badge";
    belief.className = "wire-belief";
    const flow = make("dl", { class: "wire-flow" }, make("div", {}, make("dt", {}, "to the client"), make("dd", {}, out)),
        make("div", {}, make("dt", {}, "from the client"), make("dd", {}, back)));
    const element = make("li", {}, make("div", { class: "wire-head" }, name, state), told, flow, trouble, belief);
    return { element, state, name, told, out, back, trouble, belief };
}

/** Returns the function that shows a receiver's wires. */
export function setUpWires() {
    const rates = new Rates(rateSpan);
    let shown = [];
    return (receiver) => {
        const list = byId("wires");
        if (shown.length !== receiver.wires.length) {
            shown = receiver.wires.map(wireParts);
            list.replaceChildren(...shown.map((parts) => parts.element));
        }
        receiver.wires.forEach((wire, index) => {
            const parts = shown[index];
            const key = `${receiver.name} ${wire.port}`;
            say(parts.name, wire.port);
            say(parts.state, wire.connected ? "client connected" : "no client");
            mark(parts.state, "state", wire.connected ? "good" : "");
            say(parts.told, [wire.description, wire.baud ? `${wire.baud} bit/s` : null, wire.other_end].filter(Boolean).join(", "));
            const now = performance.now() / 1000; // a wire's bytes leave in real time
            const flow = (name) => `${bytes(wire[name])}, ${bytes(rates.of(`${key} ${name}`, wire[name], now))}/s`;
            say(parts.out, flow("bytes_out"));
            say(parts.back, flow("bytes_in"));
            const trouble = losses.filter(([name]) => wire[name] > 0).map(([name, text]) => `${bytes(wire[name])} ${text}`);
            if (wire.messages_dropped)
                trouble.push(`${wire.messages_dropped} messages dropped: the transmit buffer was full`);
            say(parts.trouble, trouble.join("; "));
            parts.trouble.hidden = trouble.length === 0;
            say(parts.belief, wire.belief ? `client ${wire.trusted ? "trusts" : "does not trust"}: ${wire.belief}` : "");
            mark(parts.belief, "state", wire.trusted ? "good" : "bad");
            parts.belief.hidden = !wire.belief;
        });
    };
}
