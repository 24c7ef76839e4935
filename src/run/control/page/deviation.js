// Where the fix lay around the truth: errors east against north, and how far away half of them and nearly all are.
import { colour } from "./appearance.js";
import { context, once } from "./canvas.js";
import { byId, say } from "./dom.js";
import { metres, roundMetres, roundStep } from "./format.js";

const margin = 18; // pixels around the largest ring, for the sides' names
const least = 0.05; // m; no ring is drawn closer
const farthest = 3; // times CEP 95 %: what lies beyond would leave no room for the others

/** The quantile of a share of ascending values, linear between order statistics, as `skyloop compare` takes it. */
export function sortedQuantile(sorted, share) {
    const place = share * (sorted.length - 1);
    const below = Math.floor(place);
    const above = Math.min(below + 1, sorted.length - 1);
    return sorted[below] + (place - below) * (sorted[above] - sorted[below]);
}

/** Figures of horizontal errors {east, north}, all in metres; null where there are none. */
export function deviationFigures(errors) {
    if (!errors.length) return null;
    const radii = errors.map(({ east, north }) => Math.hypot(east, north)).sort((a, b) => a - b);
    const mean = (side) => errors.reduce((sum, error) => sum + error[side], 0) / errors.length;
    return {
        count: errors.length, cep50: sortedQuantile(radii, 0.5), cep95: sortedQuantile(radii, 0.95),
        largest: radii.at(-1), east: mean("east"), north: mean("north"),
    };
}

export class Deviation {
    constructor() {
        this.canvas = byId("deviation");
        byId("deviation-span").onchange = () => this.refresh();
        this.paint = once(() => this.draw());
        new ResizeObserver(this.paint).observe(this.canvas);
    }

    /** @param now s of the run */
    show(history, now) {
        Object.assign(this, { history, now });
        this.refresh();
    }

    refresh() {
        if (!this.history) return;
        const span = Number(byId("deviation-span").value);
        this.errors = this.history.positions(span ? this.now - span : 0);
        this.figures = deviationFigures(this.errors);
        this.tell();
        this.paint();
    }

    tell() {
        const f = this.figures;
        say(byId("deviation-count"), String(f?.count ?? 0));
        say(byId("deviation-cep50"), metres(f?.cep50));
        say(byId("deviation-cep95"), metres(f?.cep95));
        say(byId("deviation-largest"), metres(f?.largest));
        say(byId("deviation-east"), metres(f?.east));
        say(byId("deviation-north"), metres(f?.north));
        this.canvas.setAttribute("aria-label", f
            ? `Deviation: ${f.count} fixes, CEP 50 % ${metres(f.cep50)}, 95 % ${metres(f.cep95)}` : "Deviation: no fixes");
    }

    draw() {
        const area = context(this.canvas);
        if (!area || !this.errors) return;
        const { pen, width, height } = area;
        const f = this.figures;
        const reach = Math.max(f ? Math.min(f.largest, farthest * f.cep95) : 1, 2 * least);
        const step = roundStep(reach / 5);
        const rings = Math.ceil(reach / step - 1e-9);
        const scale = Math.max(Math.min(width, height) / 2 - margin, 1) / (rings * step); // pixels a metre
        // Half pixels, so that the axes are sharp.
        const [x, y] = [Math.round(width / 2) + 0.5, Math.round(height / 2) + 0.5];
        const at = ({ east, north }) => [x + east * scale, y - north * scale];
        say(byId("deviation-ring"), `a ring each ${roundMetres(step)}`);
        this.drawGrid(pen, { at, step, rings, scale });
        if (!f) return;
        this.drawFixes(pen, at);
        this.drawCircles(pen, at, scale);
    }

    drawGrid(pen, { at, step, rings, scale }) {
        const edge = rings * step;
        const [x, y] = at({ east: 0, north: 0 });
        pen.strokeStyle = colour("grid");
        pen.lineWidth = 1;
        for (let ring = 1; ring <= rings; ++ring) {
            pen.beginPath();
            pen.arc(x, y, ring * step * scale, 0, 7);
            pen.stroke();
        }
        pen.beginPath();
        pen.moveTo(...at({ east: -edge, north: 0 }));
        pen.lineTo(...at({ east: edge, north: 0 }));
        pen.moveTo(...at({ east: 0, north: -edge }));
        pen.lineTo(...at({ east: 0, north: edge }));
        pen.stroke();
        pen.fillStyle = colour("ink-soft");
        pen.textAlign = "center";
        pen.textBaseline = "middle";
        const out = edge + 10 / scale;
        for (const [name, east, north] of [["N", 0, out], ["E", out, 0], ["S", 0, -out], ["W", -out, 0]])
            pen.fillText(name, ...at({ east, north }));
    }

    // The last one as on the map.
    drawFixes(pen, at) {
        pen.fillStyle = colour("fix");
        pen.globalAlpha = 0.45;
        for (const error of this.errors) {
            const [u, v] = at(error);
            pen.fillRect(u - 1.5, v - 1.5, 3, 3);
        }
        pen.globalAlpha = 1;
        const [u, v] = at(this.errors.at(-1));
        pen.strokeStyle = colour("panel");
        pen.lineWidth = 2;
        pen.beginPath();
        pen.rect(u - 5, v - 5, 10, 10);
        pen.fill();
        pen.stroke();
    }

    drawCircles(pen, at, scale) {
        const [x, y] = at({ east: 0, north: 0 });
        pen.strokeStyle = colour("ink");
        pen.lineWidth = 1.5;
        for (const [radius, dash] of [[this.figures.cep50, []], [this.figures.cep95, [5, 4]]]) {
            pen.setLineDash(dash);
            pen.beginPath();
            pen.arc(x, y, radius * scale, 0, 7);
            pen.stroke();
        }
        pen.setLineDash([]);
        pen.fillStyle = colour("truth-mark");
        pen.beginPath();
        pen.arc(x, y, 4, 0, 7);
        pen.fill();
    }
}
