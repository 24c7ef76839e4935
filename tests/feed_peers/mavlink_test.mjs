// MAVLink with an implementation that knows nothing of ours: node-mavlink reads our frames, we read its frames, and what
// either has read it writes again as the same bytes. Ends with 77 where node-mavlink cannot be had.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const skipped = 77;
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const folder = process.env.SKYLOOP_NODE_FOLDER;
const helper = process.env.SKYLOOP_FEED_PEER;
const quiet = ["--no-audit", "--no-fund", "--no-package-lock", "--ignore-scripts"];

function skip(why) {
    console.log(`integration/mavlink_peer is skipped: ${why}`);
    process.exit(skipped);
}

/** node-mavlink and its messages, from the build folder; fetched there when they are not. */
function strangers() {
    fs.mkdirSync(folder, { recursive: true });
    fs.copyFileSync(path.join(here, "package.json"), path.join(folder, "package.json"));
    const require = createRequire(path.join(folder, "package.json"));
    const load = () => [require("node-mavlink"), require("mavlink-mappings")];
    try {
        return load();
    } catch {
        const npm = spawnSync("npm", ["install", ...quiet], { cwd: folder, timeout: 90_000, encoding: "utf8" });
        if (npm.status !== 0) skip(`npm cannot install node-mavlink: ${npm.stderr ?? npm.error}`);
        return load();
    }
}

const [mavlink, maps] = strangers();
const registry = { ...maps.minimal.REGISTRY, ...maps.common.REGISTRY };

function run(...words) {
    const done = spawnSync(helper, words, { encoding: "utf8", timeout: 20_000 });
    assert.equal(done.status, 0, done.stderr);
    return done.stdout;
}

/** The frames of a buffer as node-mavlink reads them: checked by its checksum and its table of extra bytes. */
function frames(buffer) {
    const found = [];
    for (let at = 0; at < buffer.length;) {
        const second = buffer[at] === mavlink.MavLinkProtocolV2.START_BYTE;
        const protocol = second ? new mavlink.MavLinkProtocolV2() : new mavlink.MavLinkProtocolV1();
        const size = buffer[at + 1] + (second ? 12 : 8);
        const bytes = buffer.subarray(at, at + size);
        const header = protocol.header(bytes);
        assert.equal(protocol.crc(bytes), mavlink.x25crc(bytes, 1, 2, maps.MSG_ID_MAGIC_NUMBER[header.msgid]),
            `checksum of message ${header.msgid}`);
        found.push({ bytes, header, protocol, data: protocol.data(protocol.payload(bytes), registry[header.msgid]) });
        at += size;
    }
    return found;
}

const place = { lat: 473977421, lon: 85455943 };
const velocity = { vn: 350, ve: -425, vd: -212 };
/** What feed_peer.cpp writes, in node-mavlink's names; of version 1 without `extensions`. */
const written = [
    [232, { timeUsec: 1700000000123456n, timeWeekMs: 477314000, ...place, alt: 488.25, hdop: 0.75, vdop: 1.25, vn: 3.5,
        ve: -4.25, vd: -2.125, speedAccuracy: 0.25, horizAccuracy: 1.5, vertAccuracy: 2.5, ignoreFlags: 0x88,
        timeWeek: 2445, gpsId: 1, fixType: 3, satellitesVisible: 17 }, { yaw: 5313 }],
    [24, { timeUsec: 1700000000123456n, ...place, alt: 488123, eph: 75, epv: 125, vel: 551, cog: 30950, fixType: 3,
        satellitesVisible: 17 }, { altEllipsoid: 535456, hAcc: 1500, vAcc: 2500, velAcc: 250, hdgAcc: 123456, yaw: 5313 }],
    [113, { timeUsec: 1700000000123456n, ...place, alt: 488123, eph: 75, epv: 125, vel: 551, ...velocity, cog: 30950,
        fixType: 3, satellitesVisible: 17 }, { id: 1, yaw: 5313 }],
    [0, { customMode: 77, type: 18, autopilot: 8, baseMode: 81, systemStatus: 4, mavlinkVersion: 3 }, {}],
    [76, { param1: 115, param2: 20000, param3: 3, param4: 4, param5: 5, param6: 6, param7: 7, command: 511,
        targetSystem: 1, targetComponent: 2, confirmation: 1 }, {}],
    [115, { timeUsec: 12345678n, attitudeQuaternion: [0.5, -0.5, 0.25, 0.75], rollspeed: 0.125, pitchspeed: -0.25,
        yawspeed: 0.5, ...place, alt: 488123, vx: 350, vy: -425, vz: -212, indAirspeed: 551, trueAirspeed: 552, xacc: 10,
        yacc: -20, zacc: -998 }, {}],
    [33, { timeBootMs: 12345, ...place, alt: 488123, relativeAlt: 10123, vx: 350, vy: -425, vz: -212, hdg: 5313 }, {}],
    [32, { timeBootMs: 12345, x: 1.5, y: -2.5, z: -3.5, vx: 4.5, vy: -5.5, vz: 6.5 }, {}],
    [30, { timeBootMs: 12345, roll: 0.25, pitch: -0.5, yaw: 0.75, rollspeed: 0.125, pitchspeed: -0.25, yawspeed: 0.5 }, {}],
    [49, { latitude: 473977421, longitude: 85455943, altitude: 488123 }, { timeUsec: 12345678n }],
    [2, { timeUnixUsec: 1700000000123456n, timeBootMs: 12345 }, {}],
];

function check(data, expected, what) {
    for (const [name, value] of Object.entries(expected))
        assert.deepEqual(data[name], value, `${what}: ${name}`);
}

function oursThere() {
    const file = path.join(folder, "ours.bin");
    run("write", file);
    const found = frames(fs.readFileSync(file));
    assert.equal(found.length, written.length * 2);
    for (const [index, { header, protocol, data, bytes }] of found.entries()) {
        const [id, base, extensions] = written[Math.floor(index / 2)];
        const second = index % 2 === 1;
        assert.equal(header.msgid, id);
        assert.deepEqual([header.sysid, header.compid, header.seq], [3, 220, 9]);
        check(data, base, `message ${id}, version ${second ? 2 : 1}`);
        if (!second) continue;
        check(data, extensions, `message ${id}`);
        protocol.sysid = 3;
        protocol.compid = 220;
        assert.deepEqual(Buffer.from(protocol.serialize(data, 9)), Buffer.from(bytes), `message ${id} written again`);
    }
    return found.length;
}

/** Near Zürich, north-east, climbing, 20° banked to the right, nose 10° up, heading 53.13°. */
const q = (() => {
    const [r, p, y] = [20, 10, 53.13].map((degrees) => degrees * Math.PI / 360);
    const [sr, cr, sp, cp, sy, cy] = [Math.sin(r), Math.cos(r), Math.sin(p), Math.cos(p), Math.sin(y), Math.cos(y)];
    return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy];
})();
const pose = { place: [47.3977, 8.5456, 510], ned: [3, 4, -2], angles: [20, 10, 53.13] };
const local = { timeBootMs: 5000, vx: 3, vy: 4, vz: -2 };
const integers = { lat: 473977000, lon: 85456000, alt: 510000, vx: 300, vy: 400, vz: -200 };
const rates = { rollspeed: 0.1, pitchspeed: 0.2, yawspeed: 0.3 };

function message(name, fields) {
    return Object.assign(new (maps.common[name] ?? maps.minimal[name])(), fields);
}

/** Frames of theirs, each with the time that we should read from it; undefined: no sample comes of it. */
function theirs() {
    const [q1, q2, q3, q4] = q;
    const radians = [20, 10, 53.13].map((degrees) => degrees * Math.PI / 180);
    const simulated = { q1, q2, q3, q4, xgyro: 0.1, ygyro: 0.2, zgyro: 0.3, alt: 510, vn: 3, ve: 4, vd: -2, lat: 47.3977,
        lon: 8.5456 };
    return [
        [message("HilStateQuaternion", { timeUsec: 1700000000123456n, attitudeQuaternion: q, ...rates, ...integers }),
            1700000000123456000],
        [message("SimState", simulated), null, 3e-6],
        [message("SimState", { ...simulated, lat: 473977000, lon: 85456000 }), null, 3e-6],
        [message("GpsGlobalOrigin", { latitude: 473977000, longitude: 85456000, altitude: 510000, timeUsec: 0n })],
        [message("AttitudeQuaternion", { timeBootMs: 5000, q1, q2, q3, q4, ...rates, reprOffsetQ: [0, 0, 0, 0] })],
        [message("Attitude", { timeBootMs: 5000, roll: radians[0], pitch: radians[1], yaw: radians[2], ...rates })],
        [message("GlobalPositionInt", { timeBootMs: 5000, ...integers, relativeAlt: 0, hdg: 5313 }), 5000000000],
        [message("LocalPositionNed", { ...local, x: 0, y: 0, z: 0 }), 5000000000],
        [message("Odometry", { timeUsec: 5000000n, x: 0, y: 0, z: 0, q, ...rates, vx: 0, vy: 0, vz: 0, frameId: 1,
            childFrameId: 12, poseCovariance: Array(21).fill(0), velocityCovariance: Array(21).fill(0), resetCounter: 1,
            estimatorType: 2 }), 5000000000],
    ];
}

function theirsHere() {
    let count = 0;
    for (const Protocol of [mavlink.MavLinkProtocolV1, mavlink.MavLinkProtocolV2]) {
        const first = Protocol === mavlink.MavLinkProtocolV1;
        const sent = theirs().filter(([data]) => !first || data.constructor.MSG_ID <= 255);
        const bytes = Buffer.concat(sent.map(([data], index) => new Protocol(7, 1).serialize(data, index)));
        const [file, again] = ["theirs.bin", "again.bin"].map((name) => path.join(folder, name));
        fs.writeFileSync(file, bytes);
        run("again", file, again);
        // Version 1 of node-mavlink sends extensions too, which the protocol does not have there.
        if (!first) assert.deepEqual(fs.readFileSync(again), bytes, "their frames written again by us");
        const samples = run("truth", file).trim().split("\n").map((line) => JSON.parse(line));
        const expected = sent.filter(([, time]) => time !== undefined);
        assert.equal(samples.length, expected.length);
        for (const [index, [data, time, tolerance]] of expected.entries())
            checkSample(samples[index], data, time, tolerance ?? 1e-7);
        count += sent.length;
    }
    return count;
}

function checkSample(sample, data, time, tolerance) {
    const name = data.constructor.MSG_NAME;
    const close = (found, wanted, within, what) => assert.ok(Math.abs(found - wanted) <= within, `${name}: ${what} ${found}`);
    assert.equal(sample.vehicle, "7");
    assert.equal(sample.time, time, name);
    close(sample.place[0], pose.place[0], tolerance, "latitude");
    close(sample.place[1], pose.place[1], tolerance, "longitude");
    close(sample.place[2], pose.place[2], 1e-3, "height");
    const standing = name === "ODOMETRY";
    sample.ned.forEach((found, axis) => close(found, standing ? 0 : pose.ned[axis], 1e-3, `velocity ${axis}`));
    if (name.endsWith("INT") || name.endsWith("NED")) return; // their attitude is of another message, and old by then
    sample.angles.forEach((found, axis) => close(found, pose.angles[axis], 1e-3, `angle ${axis}`));
}

console.log(`${oursThere()} frames of ours read there, ${theirsHere()} of theirs read here`);
