// SPDX-License-Identifier: Apache-2.0
// What is worth its time: the rule of relief/mesh/frontier.h, for whichever cost and error are shown.

// prices: [{cost, error, undefined}], null where there is none. Returns the efficient ones, fastest
// first: cheaper ones all err more. Equal ones stand or fall together.
function frontierOf(prices) {
    const known = prices.filter((one) => one.cost !== null && one.error !== null && !one.undefined);
    known.sort((a, b) => a.cost - b.cost || a.error - b.error);
    const efficient = [];
    for (const one of known) {
        const last = efficient.at(-1);
        const isEqual = last && one.error === last.error && one.cost === last.cost;
        if (!last || isEqual || one.error < last.error) efficient.push(one);
    }
    return efficient;
}

// The least error that each time buys, as a line: level until the next method can be paid, then down.
function frontierLine(efficient, x, y) {
    let path = "";
    for (const one of efficient) {
        const [px, py] = [x.place(one.cost), y.place(one.error)];
        path += path === "" ? `M${px},${Math.min(y.end, y.begin)}V${py}` : `H${px}V${py}`;
    }
    return path === "" ? "" : `${path}H${Math.max(x.begin, x.end)}`;
}
