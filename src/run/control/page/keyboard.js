// Keys of the whole page. Where one types, they are letters.
import { byId, isTyping } from "./dom.js";

/** @param actions {key: function}, by what the key writes */
export function setUpKeys(actions) {
    byId("keys-open").onclick = () => byId("keys").showModal();
    const all = { ...actions, "?": () => byId("keys").showModal() };
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
        if (isTyping(event.target) || document.querySelector("dialog[open]")) return;
        // The space bar presses a button that has the focus.
        if (event.key === " " && event.target.closest?.("button, summary, a")) return;
        const action = all[event.key];
        if (!action) return;
        event.preventDefault();
        action();
    });
}
