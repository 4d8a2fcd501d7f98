// SPDX-License-Identifier: Apache-2.0
// Shaders from their parts, by the rules of libshade/src/effects/shader_source.cpp.

// The text of a stage, the part and the line in it of each line, and all parts.
function assembled(parts, stage) {
  const lines = stage.head.split('\n').slice(0, -1), origins = lines.map(() => null);
  const entered = new Set(), values = [];
  const add = (line, origin) => (lines.push(line), origins.push(origin));
  const enter = (address, place) => {
    if (entered.has(address)) return;
    entered.add(address);
    if (parts[address] === undefined) throw shaderError([[...place, `the page has no part '${address}'`]]);
    parts[address].split('\n').forEach((line, i) => {
      const origin = [address, i];
      const include = /^\/\/@include (?:"(.*)"|<(.*)>)/.exec(line);
      const value = /^([a-z][^ ]* ([^ (]+)) = ([^;]*;)/i.exec(line);
      if (include) {
        enter(include[1] || stage.steps[include[2]], origin);
      } else if (value) {  // GLSL ES computes no values where it declares global variables.
        add(`${value[1]};`, origin);
        values.push([`    ${value[2]} = ${value[3]}`, origin]);
      } else {
        add(line, origin);
        if (line === 'void main() {') while (values.length) add(...values.shift());
      }
    });
  };
  enter(stage.main, [stage.main, 0]);
  const text = Object.entries(stage.lookups).reduce((all, [from, to]) => all.replaceAll(from, to), lines.join('\n'));
  return {text, origins, parts: entered};
}

// An error with its places: [part, line from 0, message].
function shaderError(places) {
  const error = new Error(places.map(([part, line, text]) => `${part}, line ${line + 1}: ${text}`).join('\n'));
  error.places = places;
  return error;
}

// The places in a compiler's message: "ERROR: 0:12: 'x' : undeclared identifier".
function placesIn(message, {origins, parts}) {
  return message.split('\n').filter((line) => /\S/.test(line)).map((line) => {
    const [, number, text] = /^\w+: \d+:(\d+): (.*)/.exec(line) || [];
    return [...(origins[number - 1] || [[...parts][0], 0]), text || line];
  });
}
