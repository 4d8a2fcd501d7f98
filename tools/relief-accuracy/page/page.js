// SPDX-License-Identifier: Apache-2.0
// Filters of plots and tables, and sorted tables. Tooltips are the titles of points.
"use strict";

// A method or curve is shown if a checked box of each choice has its index.
for (const figure of document.querySelectorAll("figure:has(.choice)")) {
    const choices = [...figure.querySelectorAll(".choice")].map((choice) => [...choice.querySelectorAll("input")]);
    const rows = figure.classList.contains("scatter") ? figure.nextElementSibling.querySelectorAll("[data-index]") : [];
    figure.addEventListener("change", () => {
        for (const node of [...figure.querySelectorAll("[data-index]"), ...rows])
            node.classList.toggle("hidden", !choices.every((boxes) => boxes.some((box) =>
                box.checked && box.dataset.members.split(" ").includes(node.dataset.index))));
    });
}

// A click on the head of a column sorts the table. Rows without a number are last in both orders.
for (const head of document.querySelectorAll(".measurements thead th")) {
    head.innerHTML = `<button>${head.innerHTML}</button>`;
    head.addEventListener("click", () => {
        const body = head.closest("table").tBodies[0];
        const way = head.ariaSort === "ascending" ? -1 : 1;
        for (const other of head.parentElement.cells) other.ariaSort = null;
        head.ariaSort = way === 1 ? "ascending" : "descending";
        const number = (row) => Number(row.cells[head.cellIndex].dataset.value ?? NaN);
        body.append(...[...body.rows].sort((a, b) => head.cellIndex === 0
            ? way * a.cells[0].textContent.localeCompare(b.cells[0].textContent, "en", {numeric: true})
            : isNaN(number(a)) - isNaN(number(b)) || way * (number(a) - number(b)) || 0));
    });
}
