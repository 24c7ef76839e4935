// Kinds of solution over time: a step for each, so that the colour need not tell it.
import { colour } from "./appearance.js";
import { clock } from "./format.js";

const kinds = { "2d": "single", "3d": "single", dgnss: "dgnss", rtk_float: "float", rtk_fixed: "fixed" };
const steps = { single: 0.25, dgnss: 0.5, float: 0.75, fixed: 1 }; // of the row's height
const words = { none: "no position", single: "single", dgnss: "DGNSS", float: "float", fixed: "fixed" };
const mostTold = 6;

/** The height of the row, pixels. */
export const solutionsHeight = 18;

/** The kind of solution that a type of fix is: "none", "single", "dgnss", "float", "fixed". */
export function solutionKind(type) {
    return kinds[type] ?? "none";
}

/** The row; x(time), `left`, `right` and `top` in pixels. @param stretches {from, to, kind}, ascending */
export function drawSolutions(pen, stretches, { x, left, right, top }) {
    const bottom = top + solutionsHeight;
    pen.fillStyle = colour("ink-soft");
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.fillText("fix", left - 6, top + solutionsHeight / 2);
    pen.textAlign = "center";
    for (const { from, to, kind } of stretches) {
        const [a, b] = [Math.max(x(from), left), Math.min(x(to), right)];
        if (b < left || !steps[kind]) continue;
        const height = solutionsHeight * steps[kind];
        pen.fillStyle = colour(`solution-${kind}`);
        pen.fillRect(a, bottom - height, Math.max(b - a, 1), height);
        if (pen.measureText(words[kind]).width + 8 > b - a) continue;
        pen.strokeStyle = colour("panel");
        pen.lineWidth = 3;
        pen.lineJoin = "round";
        pen.strokeText(words[kind], (a + b) / 2, top + solutionsHeight / 2);
        pen.fillStyle = colour("ink");
        pen.fillText(words[kind], (a + b) / 2, top + solutionsHeight / 2);
    }
}

/** The last of them in words: "single from 0:02, float from 0:05". */
export function solutionsText(stretches) {
    const news = stretches.filter(({ kind }, index) => kind !== stretches[index - 1]?.kind);
    return news.slice(-mostTold).map(({ from, kind }) => `${words[kind]} from ${clock(from)}`).join(", ");
}
