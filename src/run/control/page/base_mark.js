// Where a base station says that it stands, on the map: a mark there, or an arrow at the edge that points to it.
import { colour } from "./appearance.js";
import { polyline } from "./canvas.js";
import { metres } from "./format.js";

const inset = 14; // pixels between the edge and what is drawn beside it
const sides = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

// Where a line from a point inside the view to one beyond it leaves the view.
function edge([x, y], [u, v], { width, height }) {
    const share = (from, to, size) =>
        to > size - inset ? (size - inset - from) / (to - from) : to < inset ? (inset - from) / (to - from) : 1;
    const part = Math.max(Math.min(share(x, u, width), share(y, v, height)), 0);
    return [x + (u - x) * part, y + (v - y) * part];
}

function label(pen, text, x, y) {
    pen.textBaseline = "middle";
    pen.lineWidth = 4;
    pen.lineJoin = "round";
    pen.strokeStyle = colour("panel");
    pen.strokeText(text, x, y);
    pen.fillStyle = colour("ink");
    pen.fillText(text, x, y);
}

function drawLine(pen, from, to) {
    pen.strokeStyle = colour("base");
    pen.lineWidth = 1.5;
    pen.setLineDash([6, 5]);
    polyline(pen, [from, to]);
    pen.setLineDash([]);
}

// A triangle with its tip at (0, 0), which points up before it is turned.
function drawTriangle(pen, [x, y], turn, [wide, high]) {
    pen.save();
    pen.translate(x, y);
    pen.rotate(turn);
    pen.beginPath();
    pen.moveTo(0, 0);
    pen.lineTo(wide / 2, high);
    pen.lineTo(-wide / 2, high);
    pen.closePath();
    pen.restore();
    pen.fillStyle = colour("base");
    pen.strokeStyle = colour("panel");
    pen.lineWidth = 2;
    pen.fill();
    pen.stroke();
}

function drawArrow(pen, from, tip, text, { width }) {
    const turn = Math.atan2(tip[0] - from[0], from[1] - tip[1]);
    drawTriangle(pen, tip, turn, [14, 16]);
    const [across, down] = [Math.sin(turn), -Math.cos(turn)];
    const half = pen.measureText(text).width / 2;
    pen.textAlign = "center";
    // Beside the line, where there is room.
    if (Math.abs(across) > Math.abs(down)) {
        const back = half + 18;
        const slope = Math.abs(down / across);
        const line = tip[1] - (down / Math.abs(across)) * back;
        label(pen, text, tip[0] - Math.sign(across) * back, line + (10 + slope * half) * (line < 60 ? 1 : -1));
    } else {
        const side = tip[0] + 2 * half + 30 < width ? 1 : -1;
        label(pen, text, tip[0] + side * (half + 18), tip[1] - Math.sign(down) * 10);
    }
}

/**
 * @param place of the base and @param rover of the receiver, {e, n} in metres; at(place) in pixels
 * @return how it lies there, in words
 */
export function drawBase(pen, { place, rover, at, width, height, corrections }) {
    const view = { width, height };
    const seen = ([x, y]) => x >= inset && y >= inset && x <= width - inset && y <= height - inset;
    const [base, own] = [at(place), at(rover)];
    const [east, north] = [place.e - rover.e, place.n - rover.n];
    const name = `base ${corrections.station}`;
    const far = metres(corrections.baseline?.length_m ?? Math.hypot(east, north));
    const side = sides[(Math.round(Math.atan2(east, north) / (Math.PI / 4)) + 8) % 8];
    if (seen(base)) {
        drawLine(pen, base, seen(own) ? own : edge(base, own, view));
        drawTriangle(pen, [base[0], base[1] - 9], 0, [16, 15]);
        const right = base[0] > width - 90;
        pen.textAlign = right ? "right" : "left";
        label(pen, name, base[0] + (right ? -13 : 13), base[1]);
        return `${name} stands ${far} to the ${side}`;
    }
    const from = seen(own) ? own : [width / 2, height / 2];
    const tip = edge(from, base, view);
    if (seen(own)) drawLine(pen, own, tip);
    drawArrow(pen, from, tip, `${name}, ${far}`, view);
    return `${name} stands ${far} to the ${side}, beyond the edge`;
}
