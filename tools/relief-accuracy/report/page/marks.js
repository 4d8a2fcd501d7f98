// SPDX-License-Identifier: Apache-2.0
// Colours (as classes: the style sheet has them for light and dark) and shapes of a plot's marks.
// Both name a choice, so that no reader depends on colour.

const COLOURS = 10;
const SHAPES = [
    "M-4.2,0a4.2,4.2 0 1,0 8.4,0a4.2,4.2 0 1,0 -8.4,0Z",
    "M-3.8,-3.8h7.6v7.6h-7.6Z",
    "M0,-5L4.6,3.4H-4.6Z",
    "M0,-5.4L4.6,0L0,5.4L-4.6,0Z",
    "M0,5L4.6,-3.4H-4.6Z",
    "M-1.5,-4.8h3v3.3h3.3v3h-3.3v3.3h-3v-3.3h-3.3v-3h3.3Z",
    "M0,-5.2L1.5,-1.7L5.2,-1.5L2.3,0.9L3.3,4.6L0,2.5L-3.3,4.6L-2.3,0.9L-5.2,-1.5L-1.5,-1.7Z",
    "M-5,-2.3L-2.3,-5H2.3L5,-2.3V2.3L2.3,5H-2.3L-5,2.3Z",
];

function mark(shape, colour, attributes) {
    return drawn("path", {
        d: SHAPES[shape % SHAPES.length],
        class: `mark hue-${colour % COLOURS}`,
        ...attributes,
    });
}

// A small picture of a mark, for legends.
function swatch(shape, colour) {
    return drawn("svg", {class: "swatch", viewBox: "-7 -7 14 14", width: 14, height: 14,
                         "aria-hidden": "true"}, mark(shape, colour));
}
