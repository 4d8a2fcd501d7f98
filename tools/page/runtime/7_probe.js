// SPDX-License-Identifier: Apache-2.0
// Explained pixels: the point, its vectors and the terms of its light, from the double-precision
// reference, for the first view. A click shows the nearest one.

const colors = {n: '#4d8fff', t: '#ff5a4d', b: '#4dd964', v: '#fff', l: '#ffde4d', h: '#ff9a33', r: '#e673e6'};

class Probes {
  constructor(page, probes) {
    Object.assign(this, {page, probes, chosen: null});
    const button = page.part('explain');
    button.hidden = !probes.length;
    button.addEventListener('click', () => this.choose(this.chosen ? null : probes[probes.length >> 1]));
  }

  // Chooses the explained pixel next to a place of the canvas.
  pick(x, y) {
    const near = (probe) => size(add(this.place(probe.at) || [1e9, 0], [x, y], -1));
    if (this.probes.length) this.choose(this.probes.reduce((a, b) => (near(b) < near(a) ? b : a)));
  }

  choose(probe) {
    const {page} = this;
    this.chosen = probe;
    page.part('explain').ariaPressed = String(probe !== null);
    page.part('probe').hidden = !probe;
    this.drawFootprints(probe ? probe.lookups : []);
    if (probe) page.part('probe').textContent = probe.text + this.drawn(probe);
    page.change();
  }

  // Draws a small picture of each texture with the pixel's ellipse and a cross.
  async drawFootprints(lookups) {
    const {page} = this, {data} = page, list = page.part('lookups'), canvases = [];
    for (const lookup of lookups) {
      const texture = data.page.textures.find((t) => t.image === lookup.image);
      if (!texture || !page.painter) continue;
      const {width, height, samples} = await data.image(page.painter.gl, texture);
      const canvas = Object.assign(document.createElement('canvas'), {width, height}), ink = canvas.getContext('2d');
      const one = samples instanceof Uint8Array ? 1 : 255;
      ink.putImageData(new ImageData(Uint8ClampedArray.from(samples, (x, i) => (i % 4 === 3 ? 255 : one * x)), width, height), 0, 0);
      // A unit circle with the pixel's ways as axes, and a cross; textures repeat.
      const [x, y] = lookup.at.map((share) => share - Math.floor(share)), {right, down} = lookup;
      const path = new Path2D(), ellipse = new Path2D();
      ellipse.arc(0, 0, 0.5, 0, 7);
      path.addPath(ellipse, new DOMMatrix([...right, ...down, x, y]));
      path.addPath(new Path2D(`M${x - 0.06} ${y}h.12m-.06-.06v.12`));
      ink.scale(width, height);
      Object.assign(ink, {strokeStyle: '#ffdc3c', lineWidth: 1 / 64});
      ink.stroke(path);
      canvases.push(canvas);
    }
    list.hidden = !canvases.length;
    list.replaceChildren(...canvases);
  }

  // The pixel as this page draws it, with the first view in the size of the probe.
  drawn({x, y}) {
    const {page} = this, {camera, picture} = page, [width, height] = page.page.size;
    if (!page.painter || page.scene.time !== page.page.seconds) return '';
    Object.assign(page, {camera: null, picture: 0});
    page.draw(width, height);
    const {gl} = page.painter, codes = new Uint8Array(4);
    gl.readPixels(x, height - 1 - y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, codes);
    Object.assign(page, {camera, picture});
    return `this page\n  ${page.page.pictures[0].samples > 1 ? 'several samples' : 'one sample'}: codes ${[...codes].slice(0, 3).join(' ')}, alpha ${codes[3]}`;
  }

  // Where a point of the world is on the canvas, in its pixels; null behind the camera.
  place(at) {
    const {clientWidth: width, clientHeight: height} = this.page.canvas;
    const m = clipFromWorld(this.page.fitted(width / height), width / height);
    const w = m[3] * at[0] + m[7] * at[1] + m[11] * at[2] + m[15], [x, y] = transformed(m, at);
    return w > 0 ? [(0.5 + 0.5 * x / w) * width, (0.5 - 0.5 * y / w) * height] : null;
  }

  // The lobe of the highlight as rings of quadrilaterals about its axis (page_probes.cpp).
  lobe({at, lobe}, length) {
    if (!lobe) return [];
    const {axis, shares} = lobe, last = shares.length - 1;
    const x = unit(cross(Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], axis)), y = cross(axis, x);
    const places = shares.map((ring, i) => ring.map((share, k) => {
      const polar = Math.PI * (i / last) ** 2, turn = 2 * Math.PI * k / ring.length, s = Math.sin(polar);
      const direction = add(add(times(axis, Math.cos(polar)), x, s * Math.cos(turn)), y, s * Math.sin(turn));
      return this.place(add(at, direction, share * length)) || [0, 0];
    }));
    return places.slice(1).map((ring, i) => ring.map((place, k) => {
      const next = (k + 1) % ring.length;
      return `M${place}L${ring[next]}L${places[i][next]}L${places[i][k]}Z`;
    }).join(''));
  }

  // Draws the lobe and the vectors; those of unit length are a fifth of the picture's height if parallel to it.
  show() {
    const {page, chosen} = this, arrows = page.part('arrows'), from = chosen && this.place(chosen.at);
    arrows.replaceChildren();
    if (!from) return;
    const make = (kind, values, text = '') => {
      const element = document.createElementNS(arrows.namespaceURI, kind);
      for (const name in values) element.setAttribute(name, values[name]);
      element.textContent = text;
      arrows.append(element);
    };
    const camera = page.fitted(page.canvas.clientWidth / page.canvas.clientHeight);
    const depth = dot(add(column(camera.matrix, 3), chosen.at, -1), column(camera.matrix, 2));
    const length = 0.4 * halfHeight(camera) * (camera.height ? 1 : depth);
    for (const ring of this.lobe(chosen, length)) make('path', {d: ring, fill: '#fff', 'fill-opacity': 0.25, stroke: '#0004'});
    for (const [label, direction] of chosen.vectors) {
      const to = this.place(add(chosen.at, direction, length)), color = colors[label[0]];
      if (!to || !/^[ntbv]$|^[lhr]/.test(label)) continue;
      for (const [stroke, width] of [['#000', 4], [color, 2]])
        make('path', {d: `M${from}L${to}`, stroke, 'stroke-width': width});
      make('text', {x: to[0] + 4, y: to[1], fill: color, stroke: '#000', 'stroke-width': 3, 'paint-order': 'stroke'}, label);
    }
    make('circle', {cx: from[0], cy: from[1], r: 4, fill: '#fff', stroke: '#000'});
  }
}
