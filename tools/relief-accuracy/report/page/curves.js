// SPDX-License-Identifier: Apache-2.0
// Error along something that varies: a line a method on log axes, with the slopes fitted to them, the
// bound that errors should keep, and where methods break.

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
    const telling = curves.flatMap(({curve, index}) =>
        drawCurve(svg, chart, table, curve, index, x, y));
    makeTelling(telling);
    nameEnds(svg, curves, x, y, area);
    svg.setAttribute("aria-label", `${chart.y_label} against ${chart.x_label}: ` +
        curves.map(({curve}) => [curve.method, curveWords(curve)].filter(Boolean).join(", "))
            .join("; ") + ". Arrow keys go from point to point.");
}

function drawBound(svg, area, y, bound) {
    const at = y.place(bound);
    svg.append(drawn("line", {class: "bound", x1: area.left, x2: area.right, y1: at, y2: at}),
               drawn("text", {class: "bound-name", x: area.left + 6, y: at - 5, "aria-hidden": "true"},
                     `bound ${tickText(bound, "")}`));
}

// The line of the fitted slope, through the middle of the points on log axes.
function drawFit(svg, curve, index, x, y) {
    const known = curve.points.filter(([at, error]) => at > 0 && isNumber(error) && error > 0);
    if (!isNumber(curve.order) || known.length < 2 || !x.log) return;
    const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
    const level = mean(known.map(([at, error]) => Math.log(error) - curve.order * Math.log(at)));
    const fitted = (at) => Math.exp(level + curve.order * Math.log(at));
    const ends = [known[0][0], known.at(-1)[0]];
    svg.append(drawn("line", {
        class: `fit curve hue-${index % COLOURS}`, "data-curve": index,
        x1: x.place(ends[0]), x2: x.place(ends[1]),
        y1: y.place(fitted(ends[0])), y2: y.place(fitted(ends[1])),
    }));
}

// The line breaks where there is no result; what is exactly 0 lies in its strip, not joined.
function drawCurve(svg, chart, table, curve, index, x, y) {
    const isDense = curve.points.length > 24;
    let path = "";
    let isDown = false;
    for (const [at, error] of curve.points) {
        const isOnAxis = isNumber(error) && error > 0;
        if (isOnAxis) path += `${isDown ? "L" : "M"}${x.place(at)},${y.place(error)}`;
        isDown = isOnAxis;
    }
    svg.append(drawn("path", {class: `line curve hue-${index % COLOURS}`, "data-curve": index,
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

// Names stand to the right of the lines' ends where the plot is wide enough for that, and the lines
// few enough to be told apart.
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
            drawn("path", {class: `leader curve hue-${index % COLOURS}`, "data-curve": index,
                           d: `M${x.place(at[0]) + 6},${from}L${area.right + 4},${level}`}),
            drawn("text", {class: "end-name curve", "data-curve": index, x: area.right + 8,
                           y: level, dy: "0.34em", "aria-hidden": "true"}, curve.method));
    }
}
