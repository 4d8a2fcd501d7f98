// SPDX-License-Identifier: Apache-2.0
// Tables of methods: sorted by a click on a column's head, filtered along with their plot.

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

// Rows without a value come last either way.
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
