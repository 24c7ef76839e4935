// The program behind the page: requests, and the stream of snapshots.

// The token, where the program wants one, stands behind the '#' of the address, which browsers send to nobody.
const token = new URLSearchParams(location.hash.slice(1)).get("token");
const patience = 10_000;
const firstWait = 500;
const longestWait = 5000;

function headers(extra = {}) {
    return token ? { ...extra, Authorization: `Bearer ${token}` } : extra;
}

async function answerOf(response) {
    const body = await response.json().catch(() => null);
    if (response.ok) return body;
    const error = new Error(body?.error ?? `the program answers ${response.status}`);
    error.status = response.status;
    throw error;
}

/** GET of a path below /api. Throws an Error with the program's own sentence. */
export async function get(path) {
    return answerOf(await fetch(path, { headers: headers(), signal: AbortSignal.timeout(patience) }));
}

/** POST of an object as JSON. Throws as `get`. */
export async function post(path, body) {
    return answerOf(
        await fetch(path, {
            method: "POST",
            headers: headers({ "Content-Type": "application/json" }),
            body: JSON.stringify(body),
            signal: AbortSignal.timeout(patience),
        }),
    );
}

/** Ends a fault, all occurrences of it. Throws as `get`. */
export async function stopFault(name) {
    const path = `/api/faults/${encodeURIComponent(name)}`;
    return answerOf(
        await fetch(path, { method: "DELETE", headers: headers(), signal: AbortSignal.timeout(patience) }),
    );
}

// A WebSocket that is refused does not say why; a request does.
async function whyNot() {
    try {
        await get("/api/status");
        return "The connection is lost. Trying again.";
    } catch (error) {
        if (error.status === 401)
            return "The program wants a token: open the address that it printed when it began, with all behind the #.";
        if (error.status) return `The program refuses: ${error.message}`;
        return "The program has ended or cannot be reached. Trying again.";
    }
}

/**
 * Follows the stream for good, beginning anew whenever it breaks off.
 * @param rate snapshots a second
 * @param tell {snapshot(object), connected(), lost(sentence)}
 */
export function follow(rate, tell) {
    let wait = firstWait;
    const connect = () => {
        const protocols = token ? ["skyloop", `bearer.${token}`] : ["skyloop"];
        const scheme = location.protocol === "https:" ? "wss" : "ws";
        const stream = new WebSocket(`${scheme}://${location.host}/api/stream?rate=${rate}`, protocols);
        stream.onopen = () => {
            wait = firstWait;
            tell.connected();
        };
        stream.onmessage = (message) => tell.snapshot(JSON.parse(message.data));
        stream.onclose = async () => {
            tell.lost(await whyNot());
            setTimeout(connect, wait);
            wait = Math.min(wait * 2, longestWait);
        };
    };
    connect();
}
