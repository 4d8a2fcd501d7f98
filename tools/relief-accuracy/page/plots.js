// SPDX-License-Identifier: Apache-2.0
// The plots of the page: marks, axes, frontier, error against cost, and error curves.

// ---- Marks. Colors are classes, because the style sheet has a light and a dark set. Color and shape show the
// same choice, so that readers do not depend on color.

const COLORS = 10;
const SHAPES = [
    "M-4.2,0a4.2,4.2 0 1,0 8.4,0a4.2,4.2 0 1,0 -8.4,0Z",
    "M-3.8,-3.8h7.6v7.6h-7.6Z",
    "M0,-5L4.6,3.4H-4.6Z",
    "M0,-5.4L4.6,0L0,5.4L-4.6,0Z",
    "M0,5L4.6,-3.4H-4.6Z",
    "M-1.5,-4.8h3v3.3h3.3v3h-3.3v3.3h-3v-3.3h-3.3v-3h3.3Z",
    "M0,-5.2L1.5,-1.7L5.2,-1.5L2.3,0.9L3.3,4.6L0,2.5L-3.3,4.6L-2.3,0.9L-5.2,-1.5L-1.5,-1.7Z",
    "M-5,-2.3L-2.3,-5H2.3L5,-2.3V2.3L2.3,5H-2.3L-5,2.3Z",
];

function mark(shape, color, attributes) {
    return drawn("path", {
        d: SHAPES[shape % SHAPES.length],
        class: `mark hue-${color % COLORS}`,
        ...attributes,
    });
}

// Returns a mark for legends.
function swatch(shape, color) {
    return drawn("svg", {class: "swatch", viewBox: "-7 -7 14 14", width: 14, height: 14,
                         "aria-hidden": "true"}, mark(shape, color));
}

// ---- Axes. Values without a place on an axis (0 on a log axis, missing results) get a strip at one end.

const STRIP = 34;  // The width of a strip in pixels.

// values: numbers or null. begin, end: the pixels of the smallest and the largest value. spacing: the minimum
// distance of labeled ticks in pixels.
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

// Returns the range of an axis: the range of its numbers with a margin.
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

// room: the number of labels that fit.
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

// ---- The frame of a plot: grid, ticks, labels, and strips.

const MARGIN = {left: 62, right: 18, top: 30, bottom: 46};

// Calls draw(width, height) now and after each change of the width.
function drawnToWidth(box, draw) {
    let last = 0;
    const update = () => {
        const width = Math.floor(box.clientWidth);
        if (width === 0 || width === last) return;
        last = width;
        draw(width, Math.round(Math.min(440, Math.max(280, width * 0.56))));
    };
    new ResizeObserver(update).observe(box);
    update();
    return () => { last = 0; update(); };
}

// besides: the space to the right of the plot, in pixels.
function plotArea(width, height, besides = 0) {
    return {left: MARGIN.left, right: width - MARGIN.right - besides,
            top: MARGIN.top, bottom: height - MARGIN.bottom};
}

// Returns the x axis and the error axis, which is always logarithmic.
function makeAxes(area, along, errors, {log, unit}) {
    return [
        makeAxis(along, {log, begin: area.left, end: area.right, unit, spacing: 64}),
        makeAxis(errors, {log: true, begin: area.bottom, end: area.top, unit: "", spacing: 32}),
    ];
}

// Draws grid, ticks and labels. words: {x, y, xMissing}.
function drawFrame(svg, area, x, y, words) {
    const grid = drawn("g", {class: "grid", "aria-hidden": "true"});
    for (const tick of y.ticks) {
        const at = y.place(tick);
        grid.append(drawn("line", {x1: area.left, x2: area.right, y1: at, y2: at}),
                    drawn("text", {x: area.left - 8, y: at, dy: "0.34em", "text-anchor": "end"},
                          tickText(tick, y.unit)));
    }
    let free = -Infinity;
    for (const tick of x.ticks) {
        const at = x.place(tick);
        grid.append(drawn("line", {x1: at, x2: at, y1: area.top, y2: area.bottom}));
        const text = tickText(tick, x.unit);
        const half = text.length * 3.4;
        if (at - half < free) continue;
        free = at + half + 6;
        grid.append(drawn("text", {x: at, y: area.bottom + 18, "text-anchor": "middle"}, text));
    }
    svg.append(grid);
    drawStrips(svg, area, x, y, words);
    svg.append(drawn("text", {class: "axis-name", x: area.right, y: area.bottom + 38,
                              "text-anchor": "end"}, `${words.x} →`));
    svg.append(drawn("text", {class: "axis-name", x: 10, y: 18}, `↑ ${words.y}`));
}

// Draws a dashed line and a label for each strip.
function drawStrips(svg, area, x, y, words) {
    const strips = drawn("g", {class: "strips", "aria-hidden": "true"});
    const level = (edge, at, text) => strips.append(
        drawn("line", {x1: area.left, x2: area.right, y1: edge, y2: edge}),
        drawn("text", {x: area.left - 8, y: at, dy: "0.34em", "text-anchor": "end"}, text));
    const upright = (edge, at, text) => strips.append(
        drawn("line", {x1: edge, x2: edge, y1: area.top, y2: area.bottom}),
        drawn("text", {x: at, y: area.bottom + 18, "text-anchor": "middle"}, text));
    if (y.hasZero) level(y.from, y.zeroAt, "exact");
    if (y.hasMissing) level(y.to, y.missingAt, "no result");
    if (x.hasZero) upright(x.from, x.zeroAt, "0");
    if (x.hasMissing) upright(x.to, x.missingAt, words.xMissing);
    svg.append(strips);
}

// Places texts without overlap with each other or with the boxes in `taken`. Texts that do not fit are omitted.
// wanted: [{x, y, text}].
function placeLabels(svg, wanted, taken, area) {
    const boxes = [...taken];
    for (const {x, y, text} of wanted) {
        const label = drawn("text", {class: "point-label", "aria-hidden": "true"}, text);
        svg.append(label);
        const width = label.getComputedTextLength();
        const places = [[9, -7], [9, 15], [-9 - width, 15], [-9 - width, -7]];
        const found = places.map(([dx, dy]) => ({
            left: x + dx, right: x + dx + width, top: y + dy - 10, bottom: y + dy + 3,
        })).find((box) => box.left >= area.left && box.right <= area.right &&
            box.top >= area.top && box.bottom <= area.bottom &&
            !boxes.some((other) => box.left < other.right && other.left < box.right &&
                                   box.top < other.bottom && other.top < box.bottom));
        if (!found) { label.remove(); continue; }
        boxes.push(found);
        label.setAttribute("x", found.left);
        label.setAttribute("y", found.bottom - 3);
    }
}

// ---- The Pareto frontier for the shown cost and error, by the rule of relief/accuracy/experiment.h.

// prices: [{cost, error, undefined}] with null for missing values. Returns the efficient methods, fastest first:
// all cheaper methods have a larger error. Equal methods are all efficient or not.
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

// Returns the smallest error for each cost as a step line.
function frontierLine(efficient, x, y) {
    let path = "";
    for (const one of efficient) {
        const [px, py] = [x.place(one.cost), y.place(one.error)];
        path += path === "" ? `M${px},${Math.min(y.end, y.begin)}V${py}` : `H${px}V${py}`;
    }
    return path === "" ? "" : `${path}H${Math.max(x.begin, x.end)}`;
}

// ---- Error against cost, with a mark per method on log axes and labels on the frontier.

const COSTS = [
    {value: "one_thread", label: "one thread", axis: "time on one thread", unit: "seconds",
     path: "/cost/one_thread/median"},
    {value: "all_threads", label: "all threads", axis: "time on all threads", unit: "seconds",
     path: "/cost/all_threads/median"},
    {value: "peak_bytes", label: "memory", axis: "peak memory", unit: "bytes",
     path: "/cost/peak_bytes"},
    {value: "stored_bytes", label: "size", axis: "stored size", unit: "bytes",
     path: "/cost/stored_bytes"},
];
const NO_COST = {value: "none", axis: "order of the table (no times)", unit: ""};
const ERRORS = [{value: "rms", label: "RMS"}, {value: "mean", label: "mean"},
                {value: "p99", label: "99 %"}, {value: "max", label: "max"}];

// Returns the costs that some method has.
function costsOf(measurements) {
    return COSTS.filter(({path}) => measurements.some((one) => (valueAt(one, path) ?? 0) > 0));
}

function makeScatter(experiment, table) {
    const measurements = experiment.measurements;
    const choices = varyingChoices(measurements);
    const looks = looksOf(choices);
    const costs = costsOf(measurements);
    const state = {cost: costs[0] || NO_COST, error: ERRORS[0], isShown: () => true};
    const box = element("div", {class: "plot"});
    const draw = (width, height) =>
        drawScatter(box, width, height, {experiment, table, choices, looks, ...state});
    const redraw = drawnToWidth(box, draw);
    const change = (what) => { Object.assign(state, what); redraw(); };
    const onfilter = (isShown, hovered) => {
        if (isShown !== state.isShown || hovered === null) measurements.forEach((one, index) => {
            rowOf(table, index).hidden = !isShown(one);
        });
        if (hovered) emphasise(box, measurements, hovered);
        else change({isShown});
    };
    const switches = element("div", {class: "switches"},
        costs.length < 2 ? null : makeSwitch("Cost", costs, state.cost.value,
            (value) => change({cost: costs.find((one) => one.value === value)})),
        makeSwitch("Error", ERRORS, "rms",
            (value) => change({error: ERRORS.find((one) => one.value === value)})));
    return element("figure", {class: "scatter"},
        element("figcaption", null, element("h4", null, "Error against cost")), switches, box,
        choices.length === 0 ? null : makeFilters(choices, looks, onfilter));
}

// Colors show the first choice and shapes the second. Both show the same choice if there is only one.
function looksOf(choices) {
    const looks = new Map();
    const plain = () => 0;
    const order = (index) => index;
    if (choices.length === 1) looks.set(choices[0].name, {color: order, shape: order});
    if (choices.length > 1) {
        looks.set(choices[0].name, {color: order, shape: plain});
        looks.set(choices[1].name, {color: () => COLORS - 1, shape: order});
    }
    return looks;
}

function lookOf(measurement, choices, looks, index) {
    if (choices.length === 0) return {color: index, shape: index};
    const place = (choice) => choice.values.indexOf(valueOfChoice(measurement, choice));
    const [first, second] = choices;
    return {color: looks.get(first.name).color(place(first)),
            shape: looks.get((second || first).name).shape(place(second || first))};
}

function emphasise(box, measurements, isMeant) {
    for (const node of box.querySelectorAll(".point"))
        node.classList.toggle("dim", !isMeant(measurements[node.dataset.index]));
}

// Returns the cost and error of each visible method.
function pricesOf({experiment, cost, error, isShown}) {
    return experiment.measurements.map((measurement, index) => ({
        measurement, index,
        cost: cost === NO_COST ? index : costOf(measurement, cost),
        error: valueAt(measurement, `/error/${error.value}`),
        undefined: (valueAt(measurement, "/error/undefined") ?? 0) > 0,
    })).filter(({measurement}) => isShown(measurement));
}

function costOf(measurement, {value, path}) {
    const cost = valueAt(measurement, path);
    return value === "stored_bytes" && cost === 0 ? null : cost;
}

function drawScatter(box, width, height, view) {
    const {experiment, cost, error} = view;
    hideTip();
    const svg = drawn("svg", {width, height, viewBox: `0 0 ${width} ${height}`, role: "group"});
    box.replaceChildren(svg);
    const area = plotArea(width, height);
    const prices = pricesOf(view);
    const along = prices.flatMap((one) => [one.cost, ...rangeOf(one.measurement, cost)]);
    const [x, y] = makeAxes(area, along, prices.map((one) => one.error),
                            {log: cost !== NO_COST, unit: cost.unit});
    if (cost === NO_COST) x.ticks = [];
    drawFrame(svg, area, x, y, {x: cost.axis, y: `${error.label} error, ${experiment.error_unit}`,
                                xMissing: "not timed"});
    const efficient = cost === NO_COST ? [] : frontierOf(prices);
    svg.append(drawn("path", {class: "frontier", d: frontierLine(efficient, x, y)}));
    drawPoints(svg, prices, x, y, view);
    placeLabels(svg, efficient.map((one) => ({x: x.place(one.cost), y: y.place(one.error),
                                              text: one.measurement.method})),
                prices.map((one) => boxAround(x.place(one.cost), y.place(one.error))), area);
    svg.setAttribute("aria-label", `${error.label} error against ${cost.axis}: ` +
        `${prices.length} of ${experiment.measurements.length} methods. ` +
        (efficient.length === 0 ? "" :
            `Efficient: ${efficient.map((one) => one.measurement.method).join("; ")}. `) +
        "Arrow keys move between methods.");
    svg.dataset.efficient = JSON.stringify(efficient.map((one) => one.measurement.method));
}

function boxAround(x, y) {
    return {left: x - 5, right: x + 5, top: y - 5, bottom: y + 5};
}

function drawPoints(svg, prices, x, y, {experiment, table, choices, looks, cost}) {
    const ordered = [...prices].sort((a, b) =>
        x.place(a.cost) - x.place(b.cost) || a.index - b.index);
    addTips(ordered.map((one) => {
        const look = lookOf(one.measurement, choices, looks, one.index);
        const [px, py] = [x.place(one.cost), y.place(one.error)];
        const node = drawn("g", {class: `point${one.undefined ? " partial" : ""}`,
                                 "data-index": one.index, transform: `translate(${px},${py})`});
        node.append(drawn("circle", {class: "reach", r: 11}));
        const whisker = whiskerOf(one.measurement, cost, x, px, look.color);
        if (whisker) node.append(whisker);
        node.append(mark(look.shape, look.color));
        svg.append(node);
        return {node, title: one.measurement.method,
                rows: () => tipRows(table, rowOf(table, one.index), experiment, one.measurement)};
    }));
}

// Returns the range of the middle 80 % of the rounds, or nothing without times.
function rangeOf(measurement, cost) {
    const spread = cost.unit === "seconds" ? valueAt(measurement, `/cost/${cost.value}`) : null;
    return [spread?.p10, spread?.p90].filter(isNumber);
}

function whiskerOf(measurement, cost, x, px, color) {
    const [from, to] = rangeOf(measurement, cost);
    if (to === undefined) return null;
    return drawn("line", {class: `whisker hue-${color % COLORS}`, y1: 0, y2: 0,
                          x1: x.place(from) - px, x2: x.place(to) - px});
}

const ERROR_HEADS = ["RMS", "mean", "99 %", "max"];
function tipRows(table, row, {error_unit, item, items}, measurement) {
    const note = row.querySelector(".note");
    const rows = rowWords(table, row).map(([name, text]) =>
        [name, ERROR_HEADS.includes(name) ? `${text} ${error_unit}` : text]);
    const seconds = valueAt(measurement, "/cost/one_thread/median");
    if (items > 0 && seconds !== null)
        rows.push([`per ${item}`, `${tickText(seconds / items, "seconds")}, one thread`]);
    return note ? [...rows, ["note", note.textContent]] : rows;
}

// ---- Error curves with a line per method on log axes, fitted slopes, bounds, and the points where methods break.

function makeChart(chart, figure) {
    const table = figure.querySelector("table.points");
    const box = element("div", {class: "plot"});
    const hidden = new Set();
    const redraw = drawnToWidth(box, (width, height) =>
        drawChart(box, width, height, chart, table, hidden));
    const chips = chart.curves.map((curve, index) => {
        const emphasis = (isOn) => box.querySelectorAll(".curve").forEach((node) =>
            node.classList.toggle("dim", isOn && node.dataset.curve !== `${index}`));
        return element("label", {class: "chip", onpointerenter: () => emphasis(true),
                                 onpointerleave: () => emphasis(false)},
            element("input", {type: "checkbox", checked: true, onchange: (event) => {
                hidden[event.target.checked ? "delete" : "add"](index);
                redraw();
            }}),
            swatch(index, index), element("span", null, curve.method),
            curveWords(curve) === "" ? null : element("small", null, curveWords(curve)));
    });
    figure.querySelector("details").before(box,
        element("fieldset", {class: "choice"}, element("legend", {class: "unseen"}, "Curves"),
                element("div", {class: "chips"}, ...chips)));
}

function slopeText(order) {
    return order.toFixed(2).replace("-", "−");
}

// "slope 1.98 (theory 2), breaks at 1e−6"
function curveWords(curve) {
    const words = [];
    if (isNumber(curve.order)) words.push(`slope ${slopeText(curve.order)}`);
    if (isNumber(curve.expected_order))
        words.push(`theory ${Number(curve.expected_order.toFixed(2))}`.replace("-", "−"));
    if (isNumber(curve.breaks_at)) words.push(`breaks at ${tickText(curve.breaks_at, "")}`);
    return words.join(", ");
}

function drawChart(box, width, height, chart, table, hidden) {
    hideTip();
    const svg = drawn("svg", {width, height, viewBox: `0 0 ${width} ${height}`, role: "group"});
    box.replaceChildren(svg);
    const curves = chart.curves.map((curve, index) => ({curve, index}))
        .filter(({index}) => !hidden.has(index));
    const area = plotArea(width, height, roomForNames(width, curves));
    const points = curves.flatMap(({curve}) => curve.points);
    const bound = isNumber(chart.bound) ? [chart.bound] : [];
    const [x, y] = makeAxes(area, points.map(([at]) => at),
                            [...points.map(([, error]) => error), ...bound],
                            {log: chart.x_log !== false, unit: ""});
    drawFrame(svg, area, x, y, {x: chart.x_label, y: chart.y_label});
    if (bound.length > 0) drawBound(svg, area, y, chart.bound);
    for (const {curve, index} of curves) drawFit(svg, curve, index, x, y);
    const allPoints = curves.flatMap(({curve, index}) =>
        drawCurve(svg, chart, table, curve, index, x, y));
    addTips(allPoints);
    nameEnds(svg, curves, x, y, area);
    svg.setAttribute("aria-label", `${chart.y_label} against ${chart.x_label}: ` +
        curves.map(({curve}) => [curve.method, curveWords(curve)].filter(Boolean).join(", "))
            .join("; ") + ". Arrow keys move between points.");
}

function drawBound(svg, area, y, bound) {
    const at = y.place(bound);
    svg.append(drawn("line", {class: "bound", x1: area.left, x2: area.right, y1: at, y2: at}),
               drawn("text", {class: "bound-name", x: area.left + 6, y: at - 5, "aria-hidden": "true"},
                     `bound ${tickText(bound, "")}`));
}

// Draws a line with the fitted slope through the mean of the points on log axes.
function drawFit(svg, curve, index, x, y) {
    const known = curve.points.filter(([at, error]) => at > 0 && isNumber(error) && error > 0);
    if (!isNumber(curve.order) || known.length < 2 || !x.log) return;
    const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
    const level = mean(known.map(([at, error]) => Math.log(error) - curve.order * Math.log(at)));
    const fitted = (at) => Math.exp(level + curve.order * Math.log(at));
    const ends = [known[0][0], known.at(-1)[0]];
    svg.append(drawn("line", {
        class: `fit curve hue-${index % COLORS}`, "data-curve": index,
        x1: x.place(ends[0]), x2: x.place(ends[1]),
        y1: y.place(fitted(ends[0])), y2: y.place(fitted(ends[1])),
    }));
}

// The line has gaps at missing results and at errors of 0, which are in the strip.
function drawCurve(svg, chart, table, curve, index, x, y) {
    const isDense = curve.points.length > 24;
    let path = "";
    let isDown = false;
    for (const [at, error] of curve.points) {
        const isOnAxis = isNumber(error) && error > 0;
        if (isOnAxis) path += `${isDown ? "L" : "M"}${x.place(at)},${y.place(error)}`;
        isDown = isOnAxis;
    }
    svg.append(drawn("path", {class: `line curve hue-${index % COLORS}`, "data-curve": index,
                              d: path}));
    return curve.points.map(([at, error]) => {
        const node = drawn("g", {class: `point curve${isDense ? " dense" : ""}`, "data-curve": index,
                                 transform: `translate(${x.place(at)},${y.place(error)})`});
        node.append(drawn("circle", {class: "reach", r: 10}));
        if (curve.breaks_at === at) node.append(drawn("circle", {class: "breaks", r: 9}));
        node.append(mark(index, index));
        svg.append(node);
        return {node, title: curve.method, rows: () => curveRows(chart, table, curve, index, at)};
    });
}

function curveRows(chart, table, curve, index, at) {
    const row = [...table.tBodies[0].rows].find((one) => Number(one.dataset.x) === at);
    const rows = [[chart.x_label, row.cells[0].textContent],
                  [chart.y_label, row.cells[index + 1].textContent]];
    if (curve.breaks_at === at) rows.push(["here", "breaks"]);
    if (isNumber(curve.order)) rows.push(["slope", slopeText(curve.order)]);
    return rows;
}

// Returns the space for names to the right of the lines, if the plot is wide enough and has few lines.
function roomForNames(width, curves) {
    if (width < 620 || curves.length > 12) return 0;
    return Math.min(190, 20 + 6.2 * Math.max(0, ...curves.map(({curve}) => curve.method.length)));
}

function nameEnds(svg, curves, x, y, area) {
    if (area.right + MARGIN.right >= svg.width.baseVal.value) return;
    const ends = curves.map(({curve, index}) => ({
        curve, index, at: curve.points.findLast(([, error]) => isNumber(error) && error > 0) ||
                          curve.points.findLast(([, error]) => isNumber(error)),
    })).filter(({at}) => at).map((end) => ({...end, y: y.place(end.at[1])}));
    ends.sort((a, b) => a.y - b.y);
    const step = Math.min(14, (area.bottom - area.top) / Math.max(1, ends.length));
    let free = area.top - step;
    ends.forEach((end) => { free = end.level = Math.max(end.y, free + step); });
    let limit = area.bottom + step;
    [...ends].reverse().forEach((end) => { limit = end.level = Math.min(end.level, limit - step); });
    for (const {curve, index, at, y: from, level} of ends) {
        svg.append(
            drawn("path", {class: `leader curve hue-${index % COLORS}`, "data-curve": index,
                           d: `M${x.place(at[0]) + 6},${from}L${area.right + 4},${level}`}),
            drawn("text", {class: "end-name curve", "data-curve": index, x: area.right + 8,
                           y: level, dy: "0.34em", "aria-hidden": "true"}, curve.method));
    }
}
