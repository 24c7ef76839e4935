// The program with its page, and a client on its pty that asks something now and then.
import { spawn } from "node:child_process";
import fs from "node:fs";
import { setTimeout as sleep } from "node:timers/promises";

const patience = 30_000;
// UBX-MON-VER, a poll: what every driver asks first.
const versionPoll = Buffer.from([0xb5, 0x62, 0x0a, 0x04, 0, 0, 0x0e, 0x34]);

const begun = new Set();

export class LiveRun {
    /** Ends all that have begun and not been ended. */
    static async endAll() {
        for (const run of begun) await run.end();
    }

    constructor(program, scenario, speed = 1) {
        this.log = "";
        this.process = spawn(program, ["run", scenario, "--control", "0", "--port", "pty", "--speed", String(speed)],
            { stdio: ["ignore", "ignore", "pipe"] });
        begun.add(this);
        this.ended = new Promise((resolve) => this.process.once("exit", resolve));
        this.process.stderr.on("data", (text) => (this.log += text));
    }

    /** Waits for its addresses, and takes the client's place. */
    async begin() {
        this.url = (await this.said(/^control: (\S+)$/m))[1];
        this.connect((await this.said(/^(?:\S+: )?port 0: (\S+) /m))[1]);
    }

    async said(pattern) {
        for (const end = Date.now() + patience; Date.now() < end; await sleep(50)) {
            const found = pattern.exec(this.log);
            if (found) return found;
            if (this.process.exitCode !== null) break;
        }
        throw new Error(`the program did not say ${pattern}; it said: ${this.log}`);
    }

    connect(pty) {
        this.wire = fs.openSync(pty, fs.constants.O_RDWR | fs.constants.O_NOCTTY | fs.constants.O_NONBLOCK);
        const buffer = Buffer.alloc(65536);
        const quietly = (action) => {
            try {
                action();
            } catch (error) {
                if (error.code !== "EAGAIN" && error.code !== "EIO") throw error;
            }
        };
        this.timers = [
            setInterval(() => quietly(() => fs.readSync(this.wire, buffer)), 20),
            setInterval(() => quietly(() => fs.writeSync(this.wire, versionPoll)), 1000),
        ];
    }

    /** Ends the program, kindly first. */
    async end() {
        begun.delete(this);
        this.timers?.forEach(clearInterval);
        if (this.wire !== undefined) fs.closeSync(this.wire);
        if (this.process.exitCode === null) this.process.kill("SIGINT");
        const late = await Promise.race([this.ended.then(() => false), sleep(5000, true, { ref: false })]);
        if (late) this.process.kill("SIGKILL");
    }
}
