// SPDX-License-Identifier: Apache-2.0
// Two pictures with a line between them, to be dragged, or moved by arrow keys; and their difference.

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
