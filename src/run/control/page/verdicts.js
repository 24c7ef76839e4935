// What the scenario expects of the run: whether it has come true so far, and by what evidence.
import { byId, make, mark, say } from "./dom.js";

// As the program calls them; "not run" is a probe in virtual time.
const marks = { passed: "good", failed: "bad", undecided: "warn" };
const order = ["failed", "undecided", "pending", "passed", "not run"];

function countText(verdicts) {
    return order.map((state) => [verdicts.filter((verdict) => verdict.state === state).length, state])
        .filter(([count]) => count > 0).map(([count, state]) => `${count} ${state}`).join(", ");
}

function item(verdict) {
    const state = make("span", { class: "badge" }, verdict.state);
    mark(state, "state", marks[verdict.state] ?? "");
    const name = verdict.name || verdict.what;
    const told = make("div", {}, make("b", {}, name), verdict.what && verdict.what !== name ? make("small", {}, verdict.what) : null,
        verdict.detail ? make("small", { class: "evidence" }, verdict.detail) : null);
    return make("li", {}, state, told);
}

/** @param verdicts of the last snapshot, in the scenario's order */
export function showVerdicts(verdicts) {
    byId("verdict-panel").hidden = verdicts.length === 0;
    byId("nav-verdicts").hidden = verdicts.length === 0;
    mark(byId("nav-verdicts"), "active", verdicts.some((verdict) => verdict.state === "failed"));
    const list = byId("verdicts");
    const key = JSON.stringify(verdicts);
    if (list.dataset.key === key) return;
    list.dataset.key = key;
    say(byId("verdict-count"), countText(verdicts));
    list.replaceChildren(...verdicts.map(item));
}
