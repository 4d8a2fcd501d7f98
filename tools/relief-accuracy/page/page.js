// SPDX-License-Identifier: Apache-2.0
// The interactive parts of the page: tooltips, tables, filters, axes of plots, picture pairs and the buttons of
// the page. The page itself holds all plots; the script shows, hides and moves their parts.

// ---- Elements, as in element("button", {class: "quiet"}, "text", child), and values of the JSON report.

function element(tag, attributes, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value !== null && value !== undefined && value !== false)
            made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
}

// Shows or hides an element of a plot.
function setShown(node, isShown) {
    if (isShown) node.removeAttribute("display");
    else node.setAttribute("display", "none");
}

// Returns the value at a path, or null: valueAt(measurement, "/cost/one_thread/median").
function valueAt(json, path) {
    let value = json;
    for (const key of path.split("/").slice(1)) value = value?.[key];
    return value ?? null;
}

// ---- The tooltip of all plots appears on hover and keyboard focus, and Escape hides it. The Tab key selects
// a plot, and the arrow keys select a point.

const tip = document.getElementById("tip");

// rows: [[name, text]].
function showTip(target, title, rows) {
    const list = element("dl", null, ...rows.flatMap(([name, text]) =>
        [element("dt", null, name), element("dd", null, text)]));
    tip.replaceChildren(element("strong", null, title), list);
    tip.hidden = false;
    const mark = target.querySelector(".reach").getBoundingClientRect();
    const box = tip.getBoundingClientRect();
    const across = document.documentElement.clientWidth;
    let left = mark.right + 12;
    if (left + box.width > across - 8) left = mark.left - box.width - 12;
    left = Math.max(8, Math.min(left, across - box.width - 8));
    let top = mark.top + mark.height / 2 - box.height / 2;
    const isCovered = left < mark.right && left + box.width > mark.left;
    if (isCovered) top = mark.bottom + 12 + box.height < innerHeight ? mark.bottom + 12
                                                                   : mark.top - box.height - 12;
    top = Math.max(8, Math.min(top, innerHeight - box.height - 8));
    tip.style.left = `${left + scrollX}px`;
    tip.style.top = `${top + scrollY}px`;
}

function hideTip() {
    tip.hidden = true;
}
document.addEventListener("keydown", (event) => { if (event.key === "Escape") hideTip(); });

// Turns the titles of a plot's points into tooltips. A title has a line for the point and a line for each value,
// "RMS: 0.1 degrees". The arrow keys follow the order of the document.
function addTips(svg) {
    for (const node of svg.querySelectorAll(".point")) {
        const title = node.querySelector("title");
        const [name, ...lines] = title.textContent.split("\n");
        title.remove();
        const rows = lines.map((line) => {
            const colon = line.indexOf(": ");
            return [line.slice(0, colon), line.slice(colon + 2)];
        });
        const show = () => showTip(node, name, rows);
        node.setAttribute("role", "img");
        node.setAttribute("aria-label",
                          `${name}: ` + rows.map(([head, text]) => `${head} ${text}`).join(", "));
        node.addEventListener("pointerenter", show);
        node.addEventListener("pointerleave", hideTip);
        node.addEventListener("focus", show);
        node.addEventListener("blur", hideTip);
        node.addEventListener("keydown", (event) => {
            const points = shownPoints(svg);
            const to = keyTarget(event.key, points.indexOf(node), points.length);
            if (to === null) return;
            event.preventDefault();
            node.setAttribute("tabindex", "-1");
            points[to].setAttribute("tabindex", "0");
            points[to].focus();
        });
    }
    setTabStop(svg);
}

function shownPoints(svg) {
    return [...svg.querySelectorAll(".point:not([display])")];
}

// The Tab key selects the first point.
function setTabStop(svg) {
    shownPoints(svg).forEach((node, index) => node.setAttribute("tabindex", index === 0 ? "0" : "-1"));
}

function keyTarget(key, index, count) {
    switch (key) {
        case "ArrowRight": case "ArrowDown": return Math.min(index + 1, count - 1);
        case "ArrowLeft": case "ArrowUp": return Math.max(index - 1, 0);
        case "Home": return 0;
        case "End": return count - 1;
        default: return null;
    }
}

// ---- Tables are sorted by a click on a column head, and filtered together with their plot.

function sortable(table, measurements) {
    const body = table.tBodies[0];
    for (const head of table.tHead.rows[0].cells) {
        const name = head.textContent;
        head.dataset.name = name;
        const button = element("button", {type: "button", class: "sort", onclick: () => {
            const isUp = head.getAttribute("aria-sort") !== "ascending";
            for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
            head.setAttribute("aria-sort", isUp ? "ascending" : "descending");
            sortRows(body, measurements, head.dataset.path, isUp ? 1 : -1);
        }}, name);
        head.replaceChildren(button);
    }
}

// Rows without a value are last in both orders.
function sortRows(body, measurements, path, way) {
    const valueOf = (row) => valueAt(measurements[row.dataset.index], path);
    const rows = [...body.rows].sort((a, b) => {
        const [x, y] = [valueOf(a), valueOf(b)];
        if (x === null || y === null) return (x === null) - (y === null);
        return way * (typeof x === "string" ? x.localeCompare(y, "en", {numeric: true}) : x - y);
    });
    body.append(...rows);
}

function rowOf(table, index) {
    return table.querySelector(`tr[data-index="${index}"]`);
}

// ---- Error against cost: switches of the axes, and filters of the methods, which are also the legend.

const LABEL_PLACES = [[9, -7, "start"], [9, 15, "start"], [-9, 15, "end"], [-9, -7, "end"]];

function makeScatter(figure, experiment, table) {
    const svg = figure.querySelector(".plot svg");
    const points = [...svg.querySelectorAll(".point")].map((node) => ({
        node, index: Number(node.dataset.index), measurement: experiment.measurements[node.dataset.index],
        x: node.dataset.x.split(" ").map(Number), y: node.dataset.y.split(" ").map(Number),
    }));
    addTips(svg);
    const update = () => drawView(svg, points, {
        cost: chosenAxis(figure, "x"), error: chosenAxis(figure, "y"), isShown: filterOf(figure),
    }, table);
    figure.querySelectorAll("input").forEach((input) => input.addEventListener("change", update));
    for (const chip of figure.querySelectorAll(".chip")) {
        const name = chip.closest(".choice").querySelector("legend").textContent;
        const value = chip.querySelector("input").value;
        const emphasise = (isOn) => points.forEach(({node, measurement}) =>
            node.classList.toggle("dim", isOn && valueOfChoice(measurement, name) !== value));
        chip.addEventListener("pointerenter", () => emphasise(true));
        chip.addEventListener("pointerleave", () => emphasise(false));
    }
    const filters = figure.querySelector(".filters");
    if (filters) filters.open = matchMedia("(min-width: 40rem)").matches;
}

// Returns the index of the checked button, or 0 without a switch.
function chosenAxis(figure, axis) {
    const buttons = [...figure.querySelectorAll(`.switch[data-axis="${axis}"] input`)];
    return Math.max(0, buttons.findIndex((button) => button.checked));
}

function valueOfChoice(measurement, name) {
    return measurement.choices?.[name] ?? "–";
}

// Returns whether the check boxes show a method.
function filterOf(figure) {
    const choices = [...figure.querySelectorAll(".choice")].map((choice) => ({
        name: choice.querySelector("legend").textContent,
        shown: new Set([...choice.querySelectorAll("input:checked")].map((input) => input.value)),
    }));
    return (measurement) => choices.every(({name, shown}) => shown.has(valueOfChoice(measurement, name)));
}

// Shows the chosen axes, moves the points, and marks the efficient methods of those that are shown.
function drawView(svg, points, {cost, error, isShown}, table) {
    hideTip();
    const axes = [[".x-axis", cost], [".y-axis", error]].map(([kind, chosen]) => {
        const groups = [...svg.querySelectorAll(kind)];
        groups.forEach((group, index) => setShown(group, index === chosen));
        return groups[chosen];
    });
    const errors = svg.querySelectorAll(".y-axis").length;
    points.sort((a, b) => a.x[cost] - b.x[cost] || a.index - b.index);
    for (const {node, index, measurement, x, y} of points) {
        node.setAttribute("transform", `translate(${x[cost]},${y[error]})`);
        setShown(node, isShown(measurement));
        rowOf(table, index).hidden = !isShown(measurement);
        node.querySelectorAll(".whisker").forEach((bar) =>
            setShown(bar, Number(bar.dataset.cost) === cost));
        svg.append(node);
    }
    const shown = points.filter(({measurement}) => isShown(measurement));
    const efficient = frontierOf(shown, axes[0].dataset.path, axes[1].dataset.path);
    for (const {node} of points) {
        const place = LABEL_PLACES[node.dataset.labels[cost * errors + error]];
        const label = node.querySelector(".point-label");
        const isEfficient = efficient.some((one) => one.node === node);
        node.classList.toggle("efficient", isEfficient);
        setShown(label, isEfficient && place);
        if (place) ["x", "y", "text-anchor"].forEach((name, i) => label.setAttribute(name, place[i]));
    }
    const line = svg.querySelector(".frontier");
    line.setAttribute("d", efficient.map(({x, y}, index) => index === 0 ?
        `M${x[cost]},${line.dataset.top}V${y[error]}` : `H${x[cost]}V${y[error]}`).join("") +
        (efficient.length === 0 ? "" : `H${line.dataset.right}`));
    const [along, up] = axes.map((axis) => axis.querySelector(".axis-name").textContent);
    const names = efficient.map(({measurement}) => measurement.method);
    svg.setAttribute("aria-label", `${up.slice(2)} against ${along.slice(0, -2)}: ` +
        `${shown.length} of ${points.length} methods. ` +
        (names.length === 0 ? "" : `Efficient: ${names.join("; ")}. `));
    setTabStop(svg);
}

// Returns the efficient methods, fastest first, by the rule of relief/accuracy/experiment.h: all cheaper methods
// have a larger error. Equal methods are all efficient or not.
function frontierOf(points, costPath, errorPath) {
    if (costPath === "") return [];
    const known = points.map((point) => ({
        point, cost: valueAt(point.measurement, costPath), error: valueAt(point.measurement, errorPath),
    })).filter(({point, cost, error}) => cost !== null && error !== null &&
        !(costPath === "/cost/stored_bytes" && cost === 0) &&
        !valueAt(point.measurement, "/error/undefined"));
    known.sort((a, b) => a.cost - b.cost || a.error - b.error);
    const efficient = [];
    for (const one of known) {
        const last = efficient.at(-1);
        const isEqual = last && one.error === last.error && one.cost === last.cost;
        if (!last || isEqual || one.error < last.error) efficient.push(one);
    }
    return efficient.map(({point}) => point);
}

// ---- Error curves: check boxes show and hide the curves.

function makeChart(figure) {
    addTips(figure.querySelector(".plot svg"));
    [...figure.querySelectorAll(".chip")].forEach((chip, index) => {
        const curve = figure.querySelectorAll(`.plot [data-curve="${index}"]`);
        const others = figure.querySelectorAll(`.plot .curve:not([data-curve="${index}"])`);
        chip.querySelector("input").addEventListener("change", (event) => {
            curve.forEach((node) => setShown(node, event.target.checked));
            setTabStop(figure.querySelector(".plot svg"));
        });
        const emphasise = (isOn) => others.forEach((node) => node.classList.toggle("dim", isOn));
        chip.addEventListener("pointerenter", () => emphasise(true));
        chip.addEventListener("pointerleave", () => emphasise(false));
    });
}

// ---- The switch of the colors.

function makeColorSwitch(chosen) {
    return element("fieldset", {class: "switch"}, element("legend", null, "Colors"),
        ...["auto", "light", "dark"].map((theme) => element("label", null,
            element("input", {type: "radio", name: "colors", value: theme, checked: theme === chosen,
                              onchange: () => setTheme(theme)}),
            element("span", null, theme))));
}

// ---- Picture pairs with a movable divider and a difference view.

function makePair(figure) {
    const sides = figure.querySelector(".sides");
    const names = [...sides.querySelectorAll("span")].map((span) => span.textContent);
    const line = element("div", {class: "divider", role: "slider", tabindex: "0",
        "aria-label": `Line between ${names[0]} (left) and ${names[1]} (right)`,
        "aria-valuemin": "0", "aria-valuemax": "100", "aria-orientation": "horizontal"});
    let at = 50;
    const move = (percent) => {
        at = Math.max(0, Math.min(100, percent));
        sides.style.setProperty("--at", `${at}%`);
        line.setAttribute("aria-valuenow", `${Math.round(at)}`);
        line.setAttribute("aria-valuetext", `${Math.round(at)} % ${names[0]}`);
    };
    const follow = (event) => {
        const box = sides.getBoundingClientRect();
        move(100 * (event.clientX - box.left) / box.width);
    };
    sides.addEventListener("pointerdown", (event) => {
        if (sides.classList.contains("difference")) return;
        sides.setPointerCapture(event.pointerId);
        line.focus({preventScroll: true});
        event.preventDefault();
        follow(event);
    });
    sides.addEventListener("pointermove", (event) => {
        if (sides.hasPointerCapture(event.pointerId)) follow(event);
    });
    line.addEventListener("keydown", (event) => {
        const to = lineAfter(event.key, at, event.shiftKey ? 10 : 2);
        if (to === null) return;
        event.preventDefault();
        move(to);
    });
    sides.classList.add("live");
    sides.append(line);
    figure.querySelector("figcaption").append(differenceButton(sides));
    move(50);
}

function lineAfter(key, at, step) {
    switch (key) {
        case "ArrowRight": case "ArrowUp": return at + step;
        case "ArrowLeft": case "ArrowDown": return at - step;
        case "PageUp": return at + 10;
        case "PageDown": return at - 10;
        case "Home": return 0;
        case "End": return 100;
        default: return null;
    }
}

function differenceButton(sides) {
    const button = element("button", {type: "button", class: "quiet", "aria-pressed": "false",
        onclick: () => {
            const isOn = sides.classList.toggle("difference");
            button.setAttribute("aria-pressed", `${isOn}`);
        }}, "difference × 8");
    return button;
}

// ---- The page: theme, buttons, and experiments.

function storedTheme() {
    try { return localStorage.getItem("relief-theme") || "auto"; } catch { return "auto"; }
}

function setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    try { localStorage.setItem("relief-theme", theme); } catch { /* The choice is not stored. */ }
}

function addPageButtons(report) {
    const save = element("button", {type: "button", class: "quiet", onclick: () => {
        const blob = new Blob([JSON.stringify(report, null, 2)], {type: "application/json"});
        const link = element("a", {href: URL.createObjectURL(blob), download: "accuracy.json"});
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }}, "Save numbers (JSON)");
    document.querySelector(".page-buttons").append(makeColorSwitch(storedTheme()), save);
}

// Copies the text, or selects it if the browser does not allow copying.
async function copyText(code, button) {
    try {
        await navigator.clipboard.writeText(code.textContent);
        button.textContent = "copied";
    } catch {
        getSelection().selectAllChildren(code);
        button.textContent = "selected";
    }
    setTimeout(() => { button.textContent = "copy"; }, 1500);
}

function addCopyButtons() {
    for (const code of document.querySelectorAll("code.command")) {
        const button = element("button", {type: "button", class: "quiet copy",
            "aria-label": `Copy the command ${code.textContent}`,
            onclick: () => copyText(code, button)}, "copy");
        code.after(button);
    }
}

function makeExperiment(article, experiment) {
    const table = article.querySelector("table.measurements");
    if (table) {
        makeScatter(article.querySelector("figure.scatter"), experiment, table);
        sortable(table, experiment.measurements);
    }
    for (const figure of article.querySelectorAll("figure.chart")) {
        figure.querySelector("details").open = false;
        makeChart(figure);
    }
    article.querySelectorAll("figure.pair").forEach(makePair);
}

// Highlights the link of the visible experiment.
function followReading() {
    const links = new Map([...document.querySelectorAll("nav a")].map((link) =>
        [decodeURIComponent(link.hash.slice(1)), link]));
    const observer = new IntersectionObserver((entries) => {
        for (const {target, isIntersecting} of entries) {
            const link = links.get(target.id);
            if (isIntersecting) link?.setAttribute("aria-current", "true");
            else link?.removeAttribute("aria-current");
            if (isIntersecting) openAlone(link?.closest("li li")?.closest("details"));
        }
    }, {rootMargin: "-30% 0px -60% 0px"});
    document.querySelectorAll("article.experiment").forEach((one) => observer.observe(one));
}

function openAlone(list) {
    if (!list) return;
    document.querySelectorAll("nav li details").forEach((one) => { one.open = one === list; });
}

// If there are many experiments, only the first of each subject and the target of the link are open.
const MAX_OPEN = 12;
function closeMost(articles) {
    if (articles.length > MAX_OPEN) {
        for (const article of articles)
            article.querySelector(".body").open = !article.previousElementSibling.matches("article");
    }
    document.querySelectorAll("nav li details").forEach((one, index) => { one.open = index === 0; });
    const openTarget = () => {
        const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
        const body = target?.querySelector(":scope > .body");
        if (body) body.open = true;
    };
    addEventListener("hashchange", openTarget);
    openTarget();
}

document.addEventListener("DOMContentLoaded", () => {
    const report = JSON.parse(document.getElementById("report").textContent);
    setTheme(storedTheme());
    addPageButtons(report);
    addCopyButtons();
    if (!matchMedia("(min-width: 70rem)").matches)
        document.querySelectorAll("nav > details, .machine").forEach((one) => { one.open = false; });
    const articles = [...document.querySelectorAll("article.experiment")];
    closeMost(articles);
    for (const article of articles)
        makeExperiment(article, report.experiments[article.dataset.experiment]);
    followReading();
    document.documentElement.dataset.ready = "true";
});
