// SPDX-License-Identifier: Apache-2.0
// Error against cost: a mark a method, on log axes, with the frontier drawn and its methods named.

const COSTS = [
    {value: "one_thread", label: "one thread", axis: "time on one thread", unit: "seconds",
     path: "/cost/one_thread/median"},
    {value: "all_threads", label: "all threads", axis: "time on all threads", unit: "seconds",
     path: "/cost/all_threads/median"},
    {value: "peak_bytes", label: "memory", axis: "memory at its peak", unit: "bytes",
     path: "/cost/peak_bytes"},
    {value: "stored_bytes", label: "size", axis: "stored size", unit: "bytes",
     path: "/cost/stored_bytes"},
];
const NO_COST = {value: "none", axis: "in the order of the table (nothing was timed)", unit: ""};
const ERRORS = [{value: "rms", label: "RMS"}, {value: "mean", label: "mean"},
                {value: "p99", label: "99 %"}, {value: "max", label: "max"}];

// Which costs an experiment has: any that is measured and says something.
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

// Colours stand for the first choice, shapes for the second; both for the same where it is alone.
function looksOf(choices) {
    const looks = new Map();
    const plain = () => 0;
    const order = (index) => index;
    if (choices.length === 1) looks.set(choices[0].name, {colour: order, shape: order});
    if (choices.length > 1) {
        looks.set(choices[0].name, {colour: order, shape: plain});
        looks.set(choices[1].name, {colour: () => COLOURS - 1, shape: order});
    }
    return looks;
}

function lookOf(measurement, choices, looks, index) {
    if (choices.length === 0) return {colour: index, shape: index};
    const place = (choice) => choice.values.indexOf(valueOfChoice(measurement, choice));
    const [first, second] = choices;
    return {colour: looks.get(first.name).colour(place(first)),
            shape: looks.get((second || first).name).shape(place(second || first))};
}

function emphasise(box, measurements, isMeant) {
    for (const node of box.querySelectorAll(".point"))
        node.classList.toggle("dim", !isMeant(measurements[node.dataset.index]));
}

// What is drawn of each method that is shown.
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
        "Arrow keys go from method to method.");
    svg.dataset.efficient = JSON.stringify(efficient.map((one) => one.measurement.method));
}

function boxAround(x, y) {
    return {left: x - 5, right: x + 5, top: y - 5, bottom: y + 5};
}

function drawPoints(svg, prices, x, y, {experiment, table, choices, looks, cost}) {
    const ordered = [...prices].sort((a, b) =>
        x.place(a.cost) - x.place(b.cost) || a.index - b.index);
    makeTelling(ordered.map((one) => {
        const look = lookOf(one.measurement, choices, looks, one.index);
        const [px, py] = [x.place(one.cost), y.place(one.error)];
        const node = drawn("g", {class: `point${one.undefined ? " partial" : ""}`,
                                 "data-index": one.index, transform: `translate(${px},${py})`});
        node.append(drawn("circle", {class: "reach", r: 11}));
        const whisker = whiskerOf(one.measurement, cost, x, px, look.colour);
        if (whisker) node.append(whisker);
        node.append(mark(look.shape, look.colour));
        svg.append(node);
        return {node, title: one.measurement.method,
                rows: () => tipRows(table, rowOf(table, one.index), experiment, one.measurement)};
    }));
}

// Where the middle 80 % of the rounds lie; empty where nothing was timed.
function rangeOf(measurement, cost) {
    const spread = cost.unit === "seconds" ? valueAt(measurement, `/cost/${cost.value}`) : null;
    return [spread?.p10, spread?.p90].filter(isNumber);
}

function whiskerOf(measurement, cost, x, px, colour) {
    const [from, to] = rangeOf(measurement, cost);
    if (to === undefined) return null;
    return drawn("line", {class: `whisker hue-${colour % COLOURS}`, y1: 0, y2: 0,
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
