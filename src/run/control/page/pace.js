// How time passes: pause, step, speed, end.
import { ask, attempt } from "./ask.js";
import { post } from "./connection.js";
import { byId, mark, say } from "./dom.js";
import { clock, gpsTime, utc } from "./format.js";

const command = (name, more = {}) => attempt(() => post("/api/commands", { command: name, ...more }));

export class Pace {
    constructor() {
        this.paused = false;
        byId("pause").onclick = () => this.toggle();
        byId("step").onclick = () => this.step();
        byId("speed-factor").onchange = (event) => command("speed", { factor: Number(event.target.value) });
        byId("stop-run").onclick = () => this.end();
    }

    toggle() {
        return command(this.paused ? "resume" : "pause");
    }

    step() {
        return this.paused ? command("step", { seconds: 1 }) : undefined;
    }

    async end() {
        const agreed = await ask({
            title: "End the run?", text: "The program writes its files and ends.", yes: "End the run",
        });
        if (agreed) command("stop");
    }

    show(status) {
        this.paused = status.paused;
        say(byId("pause"), status.paused ? "Resume" : "Pause");
        byId("pause").disabled = status.virtual_time;
        byId("step").disabled = !status.paused;
        mark(byId("pace"), "paused", status.paused);
        const factor = byId("speed-factor");
        factor.disabled = status.virtual_time;
        if (document.activeElement !== factor) this.showSpeed(factor, status.speed);
        say(byId("now"), utc(status.time_utc));
        say(byId("gps-now"), gpsTime(status.gps_week, status.gps_tow_s));
        const span = status.span_s === null ? "" : ` of ${clock(status.span_s)}`;
        const pace = status.virtual_time ? ", virtual time" : status.paused ? ", paused" : "";
        say(byId("elapsed"), `${clock(status.elapsed_s)}${span}${pace}`);
    }

    // A speed that nobody chose here is shown all the same.
    showSpeed(factor, speed) {
        const value = String(speed);
        if (![...factor.options].some((option) => option.value === value)) factor.add(new Option(`${value}×`, value));
        factor.value = value;
    }
}
