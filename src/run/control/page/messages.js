// How many messages of each name went which way, and how often they come at the moment.
import { byId, make, say } from "./dom.js";
import { Rates } from "./rates.js";

const rateSpan = 5; // s of the run over which a rate is taken

function rowParts(message) {
    const client = message.from === "client";
    const [wire, count, rate] = Array.from({ length: 3 }, () => make("td"));
    count.className = rate.className = "number";
    const name = make("th", { scope: "row" }, message.name || message.protocol);
    const way = make("td", { class: "line-from" }, client ? "client →" : "← receiver");
    const element = make("tr", { class: `from-${message.from}` }, name, way, wire, count, rate);
    return { element, wire, count, rate };
}

/** Returns the function that shows the messages of a receiver, by its number, at a time of the run. */
export function setUpMessages() {
    const rates = new Rates(rateSpan);
    const rows = new Map();
    const keyOf = ({ receiver, wire, from, protocol, name }) => [receiver, wire, from, protocol, name].join(" ");
    return (status, number) => {
        // Of all receivers, so that the rates of another one are there when it is chosen.
        const rateOf = new Map(status.messages.map((message) => {
            const key = keyOf(message);
            return [key, rates.of(key, message.count, status.elapsed_s)];
        }));
        const messages = status.messages.filter((message) => message.receiver === number);
        const { wires } = status.receivers[number];
        byId("messages").dataset.wires = wires.length > 1 ? "several" : "one";
        for (const message of messages) {
            const key = keyOf(message);
            if (!rows.has(key)) rows.set(key, rowParts(message));
            const parts = rows.get(key);
            say(parts.wire, wires[message.wire]?.port ?? String(message.wire));
            say(parts.count, String(message.count));
            say(parts.rate, rateOf.get(key).toFixed(1));
        }
        const wanted = messages.map((message) => rows.get(keyOf(message)).element);
        const body = byId("message-rows");
        // Only when another one comes: what stands there can be marked and read.
        if (wanted.length !== body.children.length || wanted.some((row, index) => body.children[index] !== row))
            body.replaceChildren(...wanted);
        byId("messages-none").hidden = messages.length > 0;
    };
}
