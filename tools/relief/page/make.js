// SPDX-License-Identifier: Apache-2.0
// Moves the split line, and chooses the picture on its right. Without this script, the page shows the source on the
// left half and the asset on the right half.
for (const figure of document.querySelectorAll(".comparison")) {
    const stack = figure.querySelector(".stack");
    const slider = figure.querySelector("input[type=range]");
    const right = stack.querySelector("img + img");
    const split = part => {
        slider.value = 100 * Math.min(1, Math.max(0, part));
        stack.style.setProperty("--split", slider.value + "%");
    };
    slider.addEventListener("input", () => split(slider.value / 100));
    const follow = event => {
        const box = stack.getBoundingClientRect();
        split((event.clientX - box.left) / box.width);
    };
    stack.addEventListener("pointerdown", follow);
    stack.addEventListener("pointermove", event => event.buttons && follow(event));
    for (const choice of figure.querySelectorAll("input[type=radio]"))
        choice.addEventListener("change", () => { right.src = document.getElementById(choice.value).src; });
}
