// SPDX-License-Identifier: Apache-2.0
// Elements made in one line, element("button", {class: "chip"}, "text", child), and what a JSON holds.

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

// What a report's JSON holds at a path: valueAt(measurement, "/cost/one_thread/median").
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
