// SPDX-License-Identifier: Apache-2.0
// The line between two pictures: it is dragged, or moved by the arrow keys.

class SplitLine {
  constructor(page, split) {
    this.line = page.part('split');
    this.page = page;
    this.right = split && split.right;  // Otherwise the name of the variant.
    this.at = split ? split.at : 1;
    if (!split) return;
    this.line.append(document.createElement('span'), document.createElement('span'));
    this.line.firstChild.textContent = split.left;
    const drag = (event) => {
      const box = page.canvas.getBoundingClientRect();
      this.move((event.clientX - box.left) / box.width);
    };
    this.line.addEventListener('pointerdown', (event) => {
      this.line.setPointerCapture(event.pointerId);
      drag(event);
    });
    this.line.addEventListener('pointermove', (event) => event.buttons && drag(event));
    this.line.addEventListener('keydown', (event) => {
      const step = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
      if (!step) return;
      this.move(this.at + step);
      event.preventDefault();
    });
  }

  move(at) {
    this.at = Math.max(0, Math.min(1, at));
    this.page.change();
  }

  // Shows the line if the picture has another side.
  show(isSplit) {
    const {line, page} = this;
    line.hidden = !isSplit;
    if (!isSplit) return;
    line.lastChild.textContent = this.right || page.page.pictures[page.picture].variant;
    line.style.left = `${100 * this.at}%`;
    line.style.height = `${page.canvas.clientHeight}px`;
    line.setAttribute('aria-valuenow', Math.round(100 * this.at));
  }
}
