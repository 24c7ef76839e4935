// Questions before something is done, and a line that says how it went.
import { byId } from "./dom.js";

/**
 * Asks for a confirmation. Escape and Cancel are a no.
 * @returns {Promise<boolean>}
 */
export function ask({ title, text, yes, danger = true }) {
    const dialog = byId("ask");
    byId("ask-title").textContent = title;
    byId("ask-text").textContent = text;
    const button = byId("ask-yes");
    button.textContent = yes;
    button.classList.toggle("danger", danger);
    dialog.returnValue = "no";
    dialog.showModal();
    button.focus();
    return new Promise((resolve) => {
        dialog.addEventListener("close", () => resolve(dialog.returnValue === "yes"), { once: true });
    });
}

let clearing = 0;

/** Says how something went, for some seconds. */
export function tell(sentence, kind = "good") {
    const line = byId("notice");
    line.textContent = sentence;
    line.dataset.kind = kind;
    line.hidden = false;
    clearTimeout(clearing);
    clearing = setTimeout(() => (line.hidden = true), kind === "bad" ? 12_000 : 5000);
}

/** Does what was asked for and says how it went. @returns whether it went well */
export async function attempt(action, success) {
    try {
        await action();
        if (success) tell(success);
        return true;
    } catch (error) {
        const silent = error.name === "TimeoutError" || error instanceof TypeError;
        tell(silent ? "The program does not answer." : error.message, "bad");
        return false;
    }
}
