// How fast counts grow.

/** Rates of counts that only grow, each over its last seconds. */
export class Rates {
    /** @param span s over which a rate is taken */
    constructor(span) {
        this.span = span;
        this.seen = new Map();
    }

    /** How much a second the count of that key grows. @param now s, of any clock */
    of(key, count, now) {
        let past = this.seen.get(key) ?? [];
        const last = past.at(-1);
        if (last && (last.count > count || last.now > now)) past = []; // begun anew
        // While the clock stands still, one entry is enough.
        if (last?.now === now) past.pop();
        past.push({ now, count });
        while (past.length > 2 && now - past[0].now > this.span) past.shift();
        this.seen.set(key, past);
        const [first] = past;
        return now - first.now > 0.5 ? (count - first.count) / (now - first.now) : 0;
    }
}
