// SPDX-License-Identifier: Apache-2.0
// The interactive parts of the page: tooltips, tables, filters, picture pairs and the buttons of the page.

// ---- Elements, as in element("button", {class: "chip"}, "text", child), and values of the JSON report.

function fill(made, attributes, children) {
    for (const [name, value] of Object.entries(attributes || {})) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value !== null && value !== undefined && value !== false)
            made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
}

function element(tag, attributes, ...children) {
    return fill(document.createElement(tag), attributes, children);
}

function drawn(tag, attributes, ...children) {
    return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

// Returns the value at a path, or null: valueAt(measurement, "/cost/one_thread/median").
function valueAt(json, path) {
    let value = json;
    for (const key of path.split("/").slice(1)) value = value?.[key];
    return value ?? null;
}

function isNumber(value) {
    return typeof value === "number" && Number.isFinite(value);
}

let countedIds = 0;
function newId(kind) {
    countedIds += 1;
    return `${kind}-${countedIds}`;
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
    const mark = target.getBoundingClientRect();
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

// Adds tooltips to points: [{node, title, rows()}], in the order of the arrow keys.
function addTips(points) {
    points.forEach((point, index) => {
        const show = () => showTip(point.node, point.title, point.rows());
        const rows = point.rows();
        point.node.setAttribute("role", "img");
        point.node.setAttribute("tabindex", index === 0 ? "0" : "-1");
        point.node.setAttribute("aria-label", `${point.title}: ` +
            rows.map(([name, text]) => `${name} ${text}`).join(", "));
        point.node.addEventListener("pointerenter", show);
        point.node.addEventListener("pointerleave", hideTip);
        point.node.addEventListener("focus", show);
        point.node.addEventListener("blur", hideTip);
        point.node.addEventListener("keydown", (event) => {
            const to = keyTarget(event.key, index, points.length);
            if (to === null) return;
            event.preventDefault();
            point.node.setAttribute("tabindex", "-1");
            points[to].node.setAttribute("tabindex", "0");
            points[to].node.focus();
        });
    });
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

// Returns the names and texts of a row, without its first cell and empty cells.
function rowWords(table, row) {
    const heads = [...table.tHead.rows[0].cells].map((cell) => cell.dataset.name || cell.textContent);
    return [...row.cells].slice(1).map((cell, index) => [heads[index + 1], cell.textContent.trim()])
        .filter(([, text]) => text !== "" && text !== "–");
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

// ---- Filters: check boxes with the colors and shapes of the plot, which are also its legend.

// Returns the choices with more than one value: [{name, values}].
function varyingChoices(measurements) {
    const names = [...new Set(measurements.flatMap((one) => Object.keys(one.choices || {})))];
    return names.map((name) => ({
        name,
        values: [...new Set(measurements.map((one) => one.choices?.[name] ?? "–"))],
    })).filter((choice) => choice.values.length > 1);
}

function valueOfChoice(measurement, choice) {
    return measurement.choices?.[choice.name] ?? "–";
}

// looks: {color(index), shape(index)} by choice. onchange(isShown, hovered) gets two predicates.
function makeFilters(choices, looks, onchange) {
    const hidden = new Map(choices.map((choice) => [choice.name, new Set()]));
    const isShown = (measurement) => choices.every((choice) =>
        !hidden.get(choice.name).has(valueOfChoice(measurement, choice)));
    const chip = (choice, look, value, index) => {
        const box = element("input", {type: "checkbox", checked: true, onchange: (event) => {
            hidden.get(choice.name)[event.target.checked ? "delete" : "add"](value);
            onchange(isShown, null);
        }});
        const emphasise = () => onchange(isShown, (one) => valueOfChoice(one, choice) === value);
        return element("label", {class: "chip", onpointerenter: emphasise,
                                 onpointerleave: () => onchange(isShown, null)},
                       box, look ? swatch(look.shape(index), look.color(index)) : null,
                       element("span", null, value));
    };
    const groups = choices.map((choice) => element("fieldset", {class: "choice"},
        element("legend", null, choice.name), element("div", {class: "chips"},
        ...choice.values.map((value, index) => chip(choice, looks.get(choice.name), value, index)))));
    return element("details", {class: "filters", open: matchMedia("(min-width: 40rem)").matches},
                   element("summary", null, "Legend and filter"), ...groups);
}

// Returns a row of radio buttons. options: [{value, label}].
function makeSwitch(name, options, chosen, onchange) {
    const group = newId("switch");
    return element("fieldset", {class: "switch"}, element("legend", null, name),
        ...options.map(({value, label}) => element("label", null,
            element("input", {type: "radio", name: group, value, checked: value === chosen,
                              onchange: () => onchange(value)}),
            element("span", null, label))));
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
    const colors = makeSwitch("Colors", [{value: "auto", label: "auto"},
        {value: "light", label: "light"}, {value: "dark", label: "dark"}], storedTheme(), setTheme);
    document.querySelector(".page-buttons").append(colors, save);
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
        const scatter = makeScatter(experiment, table);
        table.closest(".scrolled").before(scatter);
        sortable(table, experiment.measurements);
    }
    for (const figure of article.querySelectorAll("figure.chart")) {
        figure.querySelector("details").open = false;
        makeChart(experiment.charts[figure.dataset.chart], figure);
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
    // Plots are drawn after layout, so they are complete when the next frame begins.
    requestAnimationFrame(() => requestAnimationFrame(() => {
        document.documentElement.dataset.ready = "true";
    }));
});
