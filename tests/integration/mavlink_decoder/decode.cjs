// Reads MAVLink frames from standard input and writes each as a line of JSON: who sent it, its fields, and the frame as
// node-mavlink itself would write it.
const { createRequire } = require("node:module");
const path = require("node:path");
const load = createRequire(path.join(process.env.SKYLOOP_NODE_FOLDER, "package.json"));
const { MavLinkPacketSplitter, MavLinkPacketParser, MavLinkProtocolV2, common, minimal } = load("node-mavlink");

const known = { ...minimal.REGISTRY, ...common.REGISTRY };
const parser = new MavLinkPacketParser();
const splitter = new MavLinkPacketSplitter();
parser.on("data", (packet) => {
    const { sysid, compid, msgid, seq } = packet.header;
    const message = packet.protocol.data(packet.payload, known[msgid]);
    const again = new MavLinkProtocolV2(sysid, compid).serialize(message, seq);
    const fields = {};
    for (const { name } of known[msgid].FIELDS)
        fields[name] = typeof message[name] === "bigint" ? Number(message[name]) : message[name];
    console.log(JSON.stringify({ sysid, compid, seq, name: known[msgid].MSG_NAME, fields,
                                 same: packet.buffer.equals(again), again: again.toString("hex"),
                                 was: packet.buffer.toString("hex") }));
});
process.stdin.pipe(splitter).pipe(parser);
