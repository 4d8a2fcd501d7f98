// SPDX-License-Identifier: Apache-2.0
// An axis: where numbers lie in pixels, and its ticks. What has no place on it (0 on a log axis; no
// number at all) lies in a strip of its own at an end, so that nothing is left out of a plot.

const STRIP = 34;  // Pixels that such a strip is wide.

// values: numbers or null. log: their logarithms count. begin, end: pixels of the smallest and the
// largest. spacing: pixels between labelled ticks, at the least.
function makeAxis(values, {log, begin, end, unit, spacing}) {
    const numbers = values.filter((value) => value !== null && Number.isFinite(value));
    const shown = numbers.filter((value) => !log || value > 0);
    const hasZero = log && numbers.some((value) => value <= 0);
    const hasMissing = values.some((value) => value === null);
    const way = Math.sign(end - begin);
    const from = begin + (hasZero ? way * STRIP : 0);
    const to = end - (hasMissing ? way * STRIP : 0);
    const [low, high] = padded(shown, log);
    const measure = log ? Math.log10 : (value) => value;
    const at = (value) =>
        from + (to - from) * (measure(value) - measure(low)) / (measure(high) - measure(low));
    return {
        log, low, high, from, to, begin, end, unit, hasZero, hasMissing,
        zeroAt: begin + way * STRIP / 2,
        missingAt: end - way * STRIP / 2,
        isEmpty: shown.length === 0,
        place(value) {
            if (value === null || !Number.isFinite(value)) return this.missingAt;
            return log && value <= 0 ? this.zeroAt : at(value);
        },
        ticks: shown.length === 0 ? [] : ticksOf(low, high, log, Math.abs(to - from) / spacing),
    };
}

// The range of an axis: a little more than that of its numbers, and never nothing.
function padded(numbers, log) {
    if (numbers.length === 0) return log ? [0.1, 10] : [0, 1];
    let low = Math.min(...numbers);
    let high = Math.max(...numbers);
    if (log) {
        const margin = Math.max(0.08 * Math.log10(high / low), high / low < 1.5 ? 0.15 : 0.05);
        return [low / 10 ** margin, high * 10 ** margin];
    }
    const margin = 0.06 * (high - low) || Math.abs(high) * 0.1 || 1;
    return [low - margin, high + margin];
}

// room: for how many labels there is room.
function ticksOf(low, high, log, room) {
    room = Math.max(2, Math.floor(room));
    if (!log) return linearTicks(low, high, room);
    const decades = Math.log10(high / low);
    const steps = decades * 3 <= room || decades <= 1.2 ? [1, 2, 5] : [1];
    const every = Math.max(1, Math.ceil(decades / room));
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
        for (const step of steps) {
            const value = Number(`${step}e${power}`);
            if (value < low || value > high) continue;
            if (power % every === 0) ticks.push(value);
        }
    }
    return ticks.length >= 2 ? ticks : linearTicks(low, high, Math.min(room, 4));
}

function linearTicks(low, high, room) {
    const rough = (high - low) / room;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
    const ticks = [];
    for (let i = Math.ceil(low / step); i * step <= high; i += 1)
        ticks.push(Number((i * step).toPrecision(12)));
    return ticks;
}

const TICK_UNITS = {
    seconds: [[1, "s"], [1e-3, "ms"], [1e-6, "µs"], [1e-9, "ns"]],
    bytes: [[1e9, "GB"], [1e6, "MB"], [1e3, "kB"], [1, "B"]],
};

// "10 µs", "0.01", "10⁻⁵".
function tickText(value, unit) {
    const units = TICK_UNITS[unit];
    if (units) {
        const [size, name] = units.find(([size]) => value >= size * 0.9999) || units.at(-1);
        return `${Number((value / size).toPrecision(3))} ${name}`;
    }
    const size = Math.abs(value);
    if (size === 0 || (size >= 0.001 && size < 1e5)) return `${Number(value.toPrecision(3))}`;
    const [digits, power] = value.toExponential(0).split("e");
    const raised = power.replace("+", "").replace(/./g, (c) => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]);
    return digits === "1" ? `10${raised}` : `${digits}·10${raised}`;
}
