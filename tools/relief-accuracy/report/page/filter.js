// SPDX-License-Identifier: Apache-2.0
// Check boxes for what can be chosen. They are the plot's legend too: the choice that colours stand
// for has coloured marks, the one of the shapes has shapes.

// The choices of which there is more than one value: [{name, values}], in their order.
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

// look: {colour(value), shape(value)} of a choice, null where neither. onchange(isShown, hovered).
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
                       box, look ? swatch(look.shape(index), look.colour(index)) : null,
                       element("span", null, value));
    };
    const groups = choices.map((choice) => element("fieldset", {class: "choice"},
        element("legend", null, choice.name), element("div", {class: "chips"},
        ...choice.values.map((value, index) => chip(choice, looks.get(choice.name), value, index)))));
    return element("details", {class: "filters", open: matchMedia("(min-width: 40rem)").matches},
                   element("summary", null, "Legend and filter"), ...groups);
}

// A row of radio buttons that looks like one switch. options: [{value, label}].
function makeSwitch(name, options, chosen, onchange) {
    const group = newId("switch");
    return element("fieldset", {class: "switch"}, element("legend", null, name),
        ...options.map(({value, label}) => element("label", null,
            element("input", {type: "radio", name: group, value, checked: value === chosen,
                              onchange: () => onchange(value)}),
            element("span", null, label))));
}
