// The token, where the program wants one, stands behind the '#' of the address, which browsers send to nobody.
const token = new URLSearchParams(location.hash.slice(1)).get("token");
const state = document.getElementById("state");

function connect() {
    const protocols = token ? ["skyloop", "bearer." + token] : ["skyloop"];
    const stream = new WebSocket(`ws://${location.host}/api/stream?rate=2`, protocols);
    stream.onopen = () => { state.textContent = "connected"; };
    stream.onmessage = (message) => {
        const seen = JSON.parse(message.data);
        const receivers = seen.receivers.map((r) => ({ name: r.name, fix: r.fix, error: r.error }));
        document.getElementById("status").textContent =
            JSON.stringify({ time_utc: seen.time_utc, paused: seen.paused, receivers }, null, 2);
    };
    stream.onclose = () => {
        state.textContent = "the connection is lost";
        setTimeout(connect, 1000);
    };
}

connect();
