// SPDX-License-Identifier: Apache-2.0
// The interactive parts of the page: tooltips, sorted tables, filters and picture pairs. The page itself holds all
// plots; the script shows and hides their parts.

// ---- The tooltip of all plots appears on hover and keyboard focus, and Escape hides it. The Tab key selects
// a plot, and the arrow keys select a point.

const tip = document.getElementById("tip");

function showTip(point) {
    const [name, ...lines] = point.dataset.tip.split("\n");
    const title = document.createElement("strong");
    title.textContent = name;
    tip.replaceChildren(title, ...lines.map((line) => {
        const row = document.createElement("div");
        row.textContent = line;
        return row;
    }));
    tip.hidden = false;
    const mark = point.querySelector(".reach").getBoundingClientRect();
    const box = tip.getBoundingClientRect();
    const isAbove = mark.bottom + 12 + box.height > innerHeight;
    const left = Math.min(mark.right + 12, document.documentElement.clientWidth - box.width - 8);
    tip.style.left = `${Math.max(8, left) + scrollX}px`;
    tip.style.top = `${(isAbove ? mark.top - box.height - 12 : mark.bottom + 12) + scrollY}px`;
}

function hideTip() {
    tip.hidden = true;
}

// Turns the titles of a plot's points into tooltips. The arrow keys follow the order of the document.
function addTips(plot) {
    const shown = () => [...plot.querySelectorAll(".point:not(.hidden)")];
    const steps = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -Infinity, End: Infinity};
    for (const point of shown()) {
        const title = point.querySelector("title");
        point.dataset.tip = title.textContent;
        point.setAttribute("role", "img");
        point.setAttribute("aria-label", title.textContent.replace("\n", ": ").replaceAll("\n", ", "));
        point.setAttribute("tabindex", point === shown()[0] ? "0" : "-1");
        title.remove();
        for (const event of ["pointerenter", "focus"]) point.addEventListener(event, () => showTip(point));
        for (const event of ["pointerleave", "blur"]) point.addEventListener(event, hideTip);
        point.addEventListener("keydown", (event) => {
            const step = steps[event.key];
            if (step === undefined) return;
            event.preventDefault();
            const points = shown();
            points[Math.max(0, Math.min(points.indexOf(point) + step, points.length - 1))].focus();
        });
    }
}

// ---- Filters: a method or curve is shown if a checked box of each choice has its index.

function addFilter(figure, table) {
    const choices = [...figure.querySelectorAll(".choice")].map((choice) => [...choice.querySelectorAll("input")]);
    const has = (box, index) => box.checked && box.dataset.members.split(" ").includes(index);
    const update = () => {
        hideTip();
        for (const node of [...figure.querySelectorAll("svg [data-index]"), ...(table?.tBodies[0].rows ?? [])]) {
            const isShown = choices.every((boxes) => boxes.some((box) => has(box, node.dataset.index)));
            node.classList.toggle("hidden", !isShown);
        }
    };
    figure.querySelectorAll(".choice input").forEach((box) => box.addEventListener("change", update));
}

// ---- Tables are sorted by a click on a column head. Rows without a number are last in both orders.

function makeSortable(table) {
    [...table.tHead.rows[0].cells].forEach((head, column) => {
        const button = document.createElement("button");
        button.className = "sort";
        button.append(...head.childNodes);
        head.append(button);
        button.addEventListener("click", () => {
            const way = head.ariaSort === "ascending" ? -1 : 1;
            for (const other of table.tHead.rows[0].cells) other.ariaSort = null;
            head.ariaSort = way === 1 ? "ascending" : "descending";
            const number = (row) => Number(row.cells[column].dataset.value ?? NaN);
            table.tBodies[0].append(...[...table.tBodies[0].rows].sort((a, b) => column === 0
                ? way * a.cells[0].textContent.localeCompare(b.cells[0].textContent, "en", {numeric: true})
                : isNaN(number(a)) - isNaN(number(b)) || way * (number(a) - number(b)) || 0));
        });
    });
}

// ---- Picture pairs have a slider that moves the line between the pictures.

function addSlider(pair) {
    const sides = pair.querySelector(".sides");
    const [before, after] = [...sides.querySelectorAll("span")].map((span) => span.textContent);
    const slider = document.createElement("input");
    slider.type = "range";
    slider.ariaLabel = `Line between ${before} (left) and ${after} (right)`;
    slider.addEventListener("input", () => sides.style.setProperty("--at", `${slider.value}%`));
    sides.append(slider);
}

// ---- The target of a link is opened.

function openTarget() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const body = target?.querySelector(":scope > .body");
    if (body) body.open = true;
}

document.addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll(".plot svg").forEach(addTips);
    document.querySelectorAll("figure.chart").forEach((figure) => addFilter(figure));
    for (const table of document.querySelectorAll("table.measurements")) {
        addFilter(table.closest("article").querySelector("figure.scatter"), table);
        makeSortable(table);
    }
    document.querySelectorAll("figure.pair").forEach(addSlider);
    document.addEventListener("keydown", (event) => { if (event.key === "Escape") hideTip(); });
    addEventListener("hashchange", openTarget);
    openTarget();
    document.documentElement.dataset.ready = "true";
});
