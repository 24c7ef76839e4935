// The map: truth and fixes over a metric grid, with what stands around.
import { colour } from "./appearance.js";
import { drawBase } from "./base_mark.js";
import { context, once, polyline } from "./canvas.js";
import { byId, say } from "./dom.js";
import { metres, roundMetres, roundStep } from "./format.js";
import { flat, unflat } from "./history.js";

const closest = 0.02; // m of ground a pixel
const widest = 5000;
const zoomStep = 1.5;
const mostPoints = 3000;
const handling = "Arrow keys move the map, + and − zoom.";

export class TrackMap {
    /** @param onPlace called with a place that was pointed at in "move" mode */
    constructor(onPlace) {
        this.canvas = byId("track");
        this.origin = null;
        this.scene = { roofs: [], trees: [] };
        this.centre = { e: 0, n: 0 };
        this.scale = 0.3; // m a pixel
        this.mode = "follow";
        this.history = null;
        this.receiver = null;
        this.moving = false;
        this.onPlace = onPlace;
        this.paint = once(() => this.draw());
        this.listen();
    }

    /** @param scene of /api/scene: its origin is that of the map */
    setScene(scene) {
        this.scene = scene;
        this.origin = scene.origin;
        this.paint();
    }

    show(receiver, history) {
        this.origin ??= receiver.truth;
        this.receiver = receiver;
        this.history = history;
        this.paint();
    }

    setMoving(moving) {
        this.moving = moving;
        this.canvas.classList.toggle("pointing", moving);
        byId("track-move").setAttribute("aria-pressed", String(moving));
        byId("track-hint").hidden = !moving;
    }

    setMode(mode) {
        this.mode = mode;
        for (const each of ["follow", "fit"])
            byId(`track-${each}`).setAttribute("aria-pressed", String(mode === each));
        this.paint();
    }

    zoom(factor) {
        this.scale = Math.min(Math.max(this.scale * factor, closest), widest);
        if (this.mode === "fit") this.setMode("follow");
        this.paint();
    }

    pan(across, down) {
        this.centre.e -= across * this.scale;
        this.centre.n += down * this.scale;
        this.setMode("free");
    }

    listen() {
        byId("track-follow").onclick = () => this.setMode("follow");
        byId("track-fit").onclick = () => this.setMode("fit");
        byId("track-in").onclick = () => this.zoom(1 / zoomStep);
        byId("track-out").onclick = () => this.zoom(zoomStep);
        byId("track-move").onclick = () => this.setMoving(!this.moving);
        this.canvas.addEventListener("wheel", (event) => {
            // Only with Ctrl, or after a click: else the page could not be scrolled over the map.
            if (!event.ctrlKey && document.activeElement !== this.canvas) return;
            event.preventDefault();
            this.zoom(event.deltaY > 0 ? zoomStep : 1 / zoomStep);
        }, { passive: false });
        this.canvas.addEventListener("keydown", (event) => this.key(event));
        this.listenToPointer();
        new ResizeObserver(this.paint).observe(this.canvas);
    }

    listenToPointer() {
        let from = null;
        this.canvas.addEventListener("pointerdown", (event) => {
            if (this.moving) return this.point(event.offsetX, event.offsetY);
            if (event.pointerType === "touch") return undefined; // a finger scrolls the page
            from = { x: event.clientX, y: event.clientY };
            this.canvas.setPointerCapture(event.pointerId);
            return undefined;
        });
        this.canvas.addEventListener("pointermove", (event) => {
            if (!from) return;
            const [across, down] = [event.clientX - from.x, event.clientY - from.y];
            if (this.mode !== "free" && Math.hypot(across, down) < 4) return;
            this.pan(across, down);
            from = { x: event.clientX, y: event.clientY };
        });
        for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, () => (from = null));
    }

    point(x, y) {
        if (!this.origin) return;
        const { clientWidth: width, clientHeight: height } = this.canvas;
        this.setMoving(false);
        this.onPlace(
            unflat({ e: this.centre.e + (x - width / 2) * this.scale, n: this.centre.n - (y - height / 2) * this.scale },
                this.origin));
    }

    key(event) {
        const step = 60;
        const pans = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
        if (pans[event.key]) this.pan(...pans[event.key]);
        else if (event.key === "+" || event.key === "=") this.zoom(1 / zoomStep);
        else if (event.key === "-") this.zoom(zoomStep);
        else if (event.key === "Enter" && this.moving)
            this.point(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2);
        else return;
        event.preventDefault();
    }

    aim(points, width, height) {
        if (this.mode === "follow") {
            this.centre = flat(this.receiver.truth, this.origin);
        }
        if (this.mode !== "fit" || !points.length) return;
        const east = points.map((p) => p.e);
        const north = points.map((p) => p.n);
        const [w, e, s, n] = [Math.min(...east), Math.max(...east), Math.min(...north), Math.max(...north)];
        this.centre = { e: (w + e) / 2, n: (s + n) / 2 };
        const wanted = Math.max((e - w) / (width - 60), (n - s) / (height - 60), closest);
        this.scale = Math.min(wanted, widest);
    }

    draw() {
        const area = context(this.canvas);
        if (!area || !this.receiver) return;
        const { pen, width, height } = area;
        const every = Math.ceil(this.history.samples.length / mostPoints);
        const kept = this.history.samples.filter((_, index, all) => index % every === 0 || index === all.length - 1);
        const truth = kept.map((sample) => flat(sample.truth, this.origin));
        const fixes = kept.map((sample) => (sample.fix ? flat(sample.fix, this.origin) : null));
        this.aim([...truth, ...fixes.filter(Boolean)], width, height);
        const at = (p) => [width / 2 + (p.e - this.centre.e) / this.scale, height / 2 - (p.n - this.centre.n) / this.scale];
        this.drawScene(pen, at);
        this.drawGrid(pen, width, height);
        pen.lineJoin = "round";
        pen.lineWidth = 4;
        pen.strokeStyle = colour("truth");
        polyline(pen, truth.map(at));
        pen.lineWidth = 2;
        pen.strokeStyle = colour("fix");
        polyline(pen, fixes.map((p) => p && at(p)));
        this.drawBase(pen, { at, width, height });
        this.drawMarks(pen, at);
    }

    drawBase(pen, view) {
        const { corrections, fix, truth } = this.receiver;
        const told = corrections?.base
            ? drawBase(pen, {
                ...view, corrections, place: flat(corrections.base, this.origin), rover: flat(fix.place ?? truth, this.origin),
            }) : "";
        this.canvas.setAttribute("aria-label", `Track, truth against fix. ${told ? `The ${told}. ` : ""}${handling}`);
    }

    drawScene(pen, at) {
        const area = (points) => {
            pen.beginPath();
            points.forEach(([e, n], index) => {
                const [x, y] = at({ e, n });
                if (index) pen.lineTo(x, y);
                else pen.moveTo(x, y);
            });
            pen.closePath();
            pen.fill();
        };
        pen.fillStyle = colour("trees");
        for (const ring of this.scene.trees) area(ring);
        pen.fillStyle = colour("roofs");
        pen.strokeStyle = colour("roofs");
        pen.lineWidth = 0.6; // closes the seams between the triangles of a roof
        for (const [a, b, c, d, e, f] of this.scene.roofs) {
            area([[a, b], [c, d], [e, f]]);
            pen.stroke();
        }
    }

    drawGrid(pen, width, height) {
        const step = roundStep(this.scale * 90);
        pen.strokeStyle = colour("grid");
        pen.lineWidth = 1;
        pen.beginPath();
        const west = this.centre.e - (width / 2) * this.scale;
        const south = this.centre.n - (height / 2) * this.scale;
        for (let e = Math.ceil(west / step) * step; (e - west) / this.scale < width; e += step) {
            const x = Math.round((e - west) / this.scale) + 0.5;
            pen.moveTo(x, 0);
            pen.lineTo(x, height);
        }
        for (let n = Math.ceil(south / step) * step; (n - south) / this.scale < height; n += step) {
            const y = Math.round(height - (n - south) / this.scale) + 0.5;
            pen.moveTo(0, y);
            pen.lineTo(width, y);
        }
        pen.stroke();
        this.drawScale(pen, step, height);
    }

    drawScale(pen, step, height) {
        const [left, base, long] = [12, height - 12, step / this.scale];
        pen.strokeStyle = colour("ink");
        pen.lineWidth = 2;
        polyline(pen, [[left, base - 5], [left, base], [left + long, base], [left + long, base - 5]]);
        pen.fillStyle = colour("ink");
        pen.textAlign = "left";
        pen.textBaseline = "alphabetic";
        pen.fillText(roundMetres(step), left + 4, base - 5);
    }

    drawMarks(pen, at) {
        const { truth, fix, error } = this.receiver;
        const [x, y] = at(flat(truth, this.origin));
        pen.lineWidth = 2;
        pen.strokeStyle = colour("panel");
        if (fix.place) {
            const [u, v] = at(flat(fix.place, this.origin));
            if (fix.h_acc_m) {
                pen.fillStyle = colour("fix-soft");
                pen.beginPath();
                pen.arc(u, v, Math.min(fix.h_acc_m / this.scale, 1e4), 0, 7);
                pen.fill();
            }
            pen.fillStyle = colour("fix");
            pen.beginPath();
            pen.rect(u - 5, v - 5, 10, 10);
            pen.fill();
            pen.stroke();
        }
        pen.fillStyle = colour("truth-mark");
        pen.beginPath();
        pen.arc(x, y, 5.5, 0, 7);
        pen.fill();
        pen.stroke();
        say(byId("track-off"), error ? `fix ${metres(Math.hypot(error.east_m, error.north_m))} off` : "no position");
    }
}
