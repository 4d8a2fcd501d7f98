// SPDX-License-Identifier: Apache-2.0
// The tooltip, shared by all plots: shown by pointer and by keyboard focus, gone by Escape. A plot
// is one stop for the Tab key; arrow keys go from point to point.

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

// Makes points tell themselves. points: [{node, title, rows()}], in the order of the arrow keys.
function makeTelling(points) {
    points.forEach((point, index) => {
        const tell = () => showTip(point.node, point.title, point.rows());
        const rows = point.rows();
        point.node.setAttribute("role", "img");
        point.node.setAttribute("tabindex", index === 0 ? "0" : "-1");
        point.node.setAttribute("aria-label", `${point.title}: ` +
            rows.map(([name, text]) => `${name} ${text}`).join(", "));
        point.node.addEventListener("pointerenter", tell);
        point.node.addEventListener("pointerleave", hideTip);
        point.node.addEventListener("focus", tell);
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

// Names and texts of a table's row, but for its first cell and what is empty.
function rowWords(table, row) {
    const heads = [...table.tHead.rows[0].cells].map((cell) => cell.dataset.name || cell.textContent);
    return [...row.cells].slice(1).map((cell, index) => [heads[index + 1], cell.textContent.trim()])
        .filter(([, text]) => text !== "" && text !== "–");
}
