// Colours that drawings share, and the light and dark schemes.
import { byId } from "./dom.js";

const schemes = ["auto", "light", "dark"];

/** Classes of C/N0, dB-Hz: from each value up. What a receiver loses first stands first. */
export const cn0Classes = [
    { from: 0, name: "<25" },
    { from: 25, name: "25–32" },
    { from: 32, name: "32–40" },
    { from: 40, name: "≥40" },
];

/** The class of a C/N0, or "none". */
export function cn0Class(value) {
    if (!Number.isFinite(value)) return "none";
    return String(cn0Classes.findLastIndex((c) => value >= c.from));
}

let colours = null;

/** Colours of style.css for canvases, by name: colour("truth") is --truth. */
export function colour(name) {
    colours ??= getComputedStyle(document.documentElement);
    return colours.getPropertyValue(`--${name}`).trim();
}

const darkSystem = matchMedia("(prefers-color-scheme: dark)");

function show(scheme) {
    const dark = scheme === "auto" ? darkSystem.matches : scheme === "dark";
    document.documentElement.dataset.scheme = dark ? "dark" : "light";
    byId("scheme").textContent = { auto: "Auto", light: "Light", dark: "Dark" }[scheme];
}

function stored() {
    try {
        const scheme = localStorage.getItem("skyloop.scheme");
        return schemes.includes(scheme) ? scheme : "auto";
    } catch {
        return "auto"; // storage is forbidden: the page works without
    }
}

/** @param redraw called when colours have changed */
export function watchScheme(redraw) {
    let scheme = stored();
    const change = () => {
        colours = null;
        show(scheme);
        redraw();
    };
    show(scheme);
    byId("scheme").onclick = () => {
        scheme = schemes[(schemes.indexOf(scheme) + 1) % schemes.length];
        try {
            localStorage.setItem("skyloop.scheme", scheme);
        } catch {
            // not kept
        }
        change();
    };
    darkSystem.addEventListener("change", change);
}
