// The page: takes snapshots from the program and hands them to its parts.
import { watchScheme } from "./appearance.js";
import { ask, attempt } from "./ask.js";
import { setUpBars } from "./bars.js";
import { follow, get, post } from "./connection.js";
import { Deviation } from "./deviation.js";
import { Dialogue, setUpEvents } from "./dialogue.js";
import { byId, make, mark, say } from "./dom.js";
import { ErrorPlot } from "./error_plot.js";
import { Faults } from "./faults.js";
import { History } from "./history.js";
import { setUpKeys } from "./keyboard.js";
import { setUpMessages } from "./messages.js";
import { Pace } from "./pace.js";
import { setUpSkyPlot } from "./sky_plot.js";
import { fixState, showCorrections, showState } from "./state.js";
import { StatePlot } from "./states.js";
import { Timeline } from "./timeline.js";
import { TrackMap } from "./track.js";
import { showVerdicts } from "./verdicts.js";
import { setUpWires } from "./wires.js";

const rate = 5; // snapshots a second

async function moveTo(place) {
    const at = [Number(place.lat_deg.toFixed(7)), Number(place.lon_deg.toFixed(7))];
    if (current) at.push(Number(current.truth.height_m.toFixed(2)));
    const agreed = await ask({
        title: "Move the vehicle there?",
        text: `Latitude ${at[0]}°, longitude ${at[1]}°. Its path goes on from there.`,
        yes: "Move",
    });
    if (agreed) await attempt(() => post("/api/commands", { command: "move_to", at }), "moved");
}

let current = null; // the receiver that is shown
let chosen = 0;
const histories = new Map();
const faults = new Faults();
const parts = {
    sky: setUpSkyPlot(),
    bars: setUpBars(),
    wires: setUpWires(),
    events: setUpEvents(),
    track: new TrackMap(moveTo),
    errors: new ErrorPlot(),
    states: new StatePlot(),
    deviation: new Deviation(),
    messages: setUpMessages(),
    timeline: new Timeline({ stop: (name) => faults.stop(name), start: (name) => faults.start(name) }),
    dialogue: new Dialogue(),
    pace: new Pace(),
};

function offerReceivers(names) {
    const select = byId("receiver");
    const key = JSON.stringify(names);
    if (select.dataset.key === key) return;
    select.dataset.key = key;
    select.replaceChildren(...names.map((name, index) => make("option", { value: index }, name)));
    chosen = Math.min(chosen, Math.max(names.length - 1, 0));
    select.value = String(chosen);
    byId("receiver-choice").hidden = names.length < 2;
}

function historyOf(name) {
    if (!histories.has(name)) histories.set(name, new History());
    return histories.get(name);
}

function showReceiver(status) {
    for (const receiver of status.receivers) historyOf(receiver.name).add(status.elapsed_s, receiver, status.speed);
    const receiver = status.receivers[chosen];
    if (!receiver || receiver.epochs === 0) return;
    current = receiver;
    showState(receiver);
    showCorrections(receiver);
    mark(document.body, "corrections", historyOf(receiver.name).corrected);
    say(byId("board"), receiver.board);
    document.title = `${byId("fix-word").textContent} – skyloop`;
    mark(document.body, "fix", fixState(receiver));
    parts.sky(receiver);
    parts.bars(receiver);
    parts.wires(receiver);
    parts.track.show(receiver, historyOf(receiver.name));
    parts.errors.show(historyOf(receiver.name), status.timeline, status.elapsed_s);
    parts.deviation.show(historyOf(receiver.name), status.elapsed_s);
    parts.states.show(historyOf(receiver.name), status.elapsed_s);
    parts.messages(status, chosen);
}

function show(status) {
    offerReceivers(status.receivers.map((receiver) => receiver.name));
    say(byId("title"), status.title.split("/").at(-1) || "run");
    parts.pace.show(status);
    faults.show(status);
    parts.timeline.show(status);
    parts.dialogue.add(status.dialogue, status.receivers.map((receiver) => receiver.name));
    parts.events(status.events);
    showVerdicts(status.verdicts);
    showReceiver(status);
}

async function loadOnce() {
    await attempt(() => faults.load());
    try {
        parts.track.setScene(await get("/api/scene"));
    } catch {
        // Nothing stands around: the map is blank.
    }
}

// No links: what stands behind the '#' of the address is the token.
for (const button of document.querySelectorAll("nav button"))
    button.onclick = () => byId(button.dataset.to).scrollIntoView();
byId("receiver").onchange = (event) => {
    chosen = Number(event.target.value);
};
watchScheme(() => {
    parts.track.paint();
    parts.errors.paint();
    parts.deviation.paint();
    parts.states.paint();
});
setUpKeys({
    " ": () => parts.pace.toggle(),
    s: () => parts.pace.step(),
    "/": () => {
        faults.choose(null);
        byId("fault-search").focus();
    },
    x: () => faults.stopAll(),
    m: () => byId("track").focus(),
    v: () => byId("verdicts").focus(),
    d: () => byId("dialogue-text").focus(),
    h: () => byId("dialogue-hold").click(),
});
follow(rate, {
    connected: () => {
        byId("lost").hidden = true;
        mark(document.body, "connected", true);
        if (!faults.kinds.length) loadOnce();
    },
    lost: (sentence) => {
        say(byId("lost"), sentence);
        byId("lost").hidden = false;
        mark(document.body, "connected", false);
    },
    snapshot: show,
});
