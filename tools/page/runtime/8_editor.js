// SPDX-License-Identifier: Apache-2.0
// The panel of shaders: the parts of the picture's programs, which are edited in place. A change
// applies when typing pauses; the picture keeps the last text that compiles.

class Editor {
  constructor(page) {
    Object.assign(this, {page, texts: {}, code: page.root.querySelector('textarea')});
    const {data} = page, on = (name, kind, action) => page.part(name).addEventListener(kind, action);
    this.list = page.part('address');
    on('shader', 'toggle', () => this.show());
    on('address', 'change', () => this.show());
    on('undo', 'click', () => {
      delete this.texts[this.list.value];
      this.apply();
      this.show();
    });
    on('difference', 'click', (event) => {
      event.target.ariaPressed = String(event.target.ariaPressed !== 'true');
      this.show();
    });
    on('save', 'click', () => this.save());
    this.code.addEventListener('input', () => {
      this.texts[this.list.value] = this.code.value;
      clearTimeout(this.pause);
      this.pause = setTimeout(() => this.apply(), 400);
    });
    this.code.addEventListener('scroll', () => this.mark());
    this.original = (part) => data.page.parts[part];
  }

  // Lists the parts of the picture, those of its step first.
  fill(first) {
    const {page, list} = this, {programs, parts, pictures} = page.page, {draws, skybox, finishing} = pictures[page.picture];
    const used = [...draws, skybox, finishing].filter(Boolean).flatMap(({program}) => [programs[program].fragment, programs[program].vertex]);
    const all = new Set([...first, ...used.flatMap((stage) => [...assembled(parts, stage).parts])].filter((part) => part in parts));
    const known = list.value;
    list.replaceChildren(...[...all].map((part) => new Option(part)));
    list.value = first.length || !all.has(known) ? [...all][0] : known;
    this.show();
  }

  show() {
    const part = this.list.value, isDifference = this.page.part('difference').ariaPressed === 'true';
    const text = part in this.texts ? this.texts[part] : this.original(part);
    this.code.readOnly = isDifference;
    this.code.value = isDifference ? difference(this.original(part).split('\n'), text.split('\n')).join('\n') : text;
    this.mark();
  }

  // Draws with the edited parts, or shows why that fails.
  apply() {
    clearTimeout(this.pause);
    const {page} = this, {data} = page, part = this.list.value;
    const parts = {...data.page.parts, ...this.texts};
    this.places = [];
    try {
      page.painter.gpu.link(parts, part);
      data.parts = parts;
      page.change();
    } catch (error) {
      this.places = error.places || [[part, 0, error.message]];
    }
    this.mark();
  }

  // Messages stand at their lines.
  mark() {
    const marks = this.page.part('marks'), lines = [];
    if (!this.code.readOnly)
      for (const [part, line, text] of this.places || [])
        if (part === this.list.value) lines[line] = lines[line] || text;
        else lines[0] = lines[0] || `${part}: ${text}`;
    marks.textContent = Array.from(lines, (line) => line || '').join('\n');
    marks.style.transform = `translateY(${-this.code.scrollTop}px)`;
  }

  // A file with the edited parts of a file, for $RELIEF_SHADER_DIR.
  save() {
    const fileOf = (part) => part.split('#')[0], file = fileOf(this.list.value);
    const edited = Object.keys(this.texts).filter((part) => fileOf(part) === file);
    const text = (edited.length ? edited : [this.list.value]).map((part) => this.texts[part] || this.original(part)).join('\n');
    const link = Object.assign(document.createElement('a'), {download: file, href: URL.createObjectURL(new Blob([text]))});
    link.click();
    URL.revokeObjectURL(link.href);
  }
}

// The lines of two texts: those of both after "  ", of the first alone after "- ", of the second
// alone after "+ ".
function difference(a, b) {
  const common = Array.from({length: a.length + 1}, () => new Uint16Array(b.length + 1));
  for (let i = a.length; i-- > 0;)
    for (let j = b.length; j-- > 0;)
      common[i][j] = a[i] === b[j] ? common[i + 1][j + 1] + 1 : Math.max(common[i + 1][j], common[i][j + 1]);
  const lines = [];
  for (let i = 0, j = 0; i < a.length || j < b.length;)
    if (i < a.length && a[i] === b[j]) lines.push(`  ${a[i++]}`), ++j;
    else if (j === b.length || (i < a.length && common[i + 1][j] >= common[i][j + 1])) lines.push(`- ${a[i++]}`);
    else lines.push(`+ ${b[j++]}`);
  return lines;
}
