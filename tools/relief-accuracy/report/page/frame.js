// SPDX-License-Identifier: Apache-2.0
// What all plots share: the paper with grid, ticks, labels and the strips for what has no place on an
// axis; and drawing again when the page gets another width.

const MARGIN = {left: 62, right: 18, top: 30, bottom: 46};

// Calls draw(width, height) now and whenever the width changes.
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

// besides: pixels that are wanted to the right of the plot.
function plotArea(width, height, besides = 0) {
    return {left: MARGIN.left, right: width - MARGIN.right - besides,
            top: MARGIN.top, bottom: height - MARGIN.bottom};
}

// The axes of a plot: numbers along x, and errors, which always lie on a log axis.
function makeAxes(area, along, errors, {log, unit}) {
    return [
        makeAxis(along, {log, begin: area.left, end: area.right, unit, spacing: 64}),
        makeAxis(errors, {log: true, begin: area.bottom, end: area.top, unit: "", spacing: 32}),
    ];
}

// Grid, ticks and labels. words: {x, y, xMissing}.
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

// A strip is set off by a dashed line and says in a word what lies in it.
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

// Places texts so that they cover neither each other nor what is in `taken` (boxes); what finds no
// place is left out. wanted: [{x, y, text}].
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
