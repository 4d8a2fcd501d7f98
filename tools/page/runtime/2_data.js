// SPDX-License-Identifier: Apache-2.0
// The data of a page: sections of bytes, and textures in the form in which they are uploaded.

class Data {
  constructor(page, bytes) {
    this.page = page;
    this.bytes = bytes;
    this.parts = {...page.parts};  // Of shaders, as they are edited.
  }

  section(i) {
    const [offset, length] = this.page.sections[i];
    return this.bytes.subarray(offset, offset + length);
  }
  floats(i) {
    const bytes = this.section(i), range = this.page.quantized[i];
    if (range) return range.values = range.values || unquantized(bytes, range);
    return new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  }
  integers(i) {
    const bytes = this.section(i);
    return new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  }

  // The samples of an image file, as four bytes per texel with row 0 on top, read back from a
  // texture: a 2D canvas would multiply colors by alpha.
  async decoded(gl, texture) {
    const picture = await createImageBitmap(new Blob([this.section(texture.d)]),
                                            {premultiplyAlpha: 'none', colorSpaceConversion: 'none'});
    const {width, height} = picture;
    const name = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, name);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, name, 0);
    const samples = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, samples);
    gl.deleteFramebuffer(target);
    gl.deleteTexture(name);
    picture.close();
    return {width, height, samples};
  }

  // The largest level, as four samples per texel.
  async image(gl, texture) {
    return texture.t === 'encoded' ? this.decoded(gl, texture) : this.spread(texture);
  }

  // Samples from their differences to the left (tools/page/page_images.cpp).
  samples({t, w, h, c, d, packed}) {
    const bytes = this.section(d), count = w * h * c, isWide = t === 'bits_16';
    if (!packed) return isWide ? new Uint16Array(bytes.buffer, bytes.byteOffset, count) : t === 'floats' ? this.floats(d) : bytes;
    const samples = new (isWide ? Uint16Array : Uint8Array)(count);
    for (let i = 0; i < count; ++i)
      samples[i] = bytes[i] + (isWide ? 256 * bytes[count + i] : 0) + (i % (w * c) < c ? 0 : samples[i - c]);
    return samples;
  }

  // Four samples per texel of an image that is stored as rows.
  spread(texture) {
    const {w, h, c, gray, z, heights} = texture;
    const from = heights ? normalsOf(this.samples({...texture, ...heights, c: 1}), w, h, heights) : this.samples(texture);
    const isByte = from instanceof Uint8Array, one = isByte ? 255 : 1, scale = from instanceof Uint16Array ? 65535 : 1;
    const count = w * h, samples = isByte ? new Uint8Array(4 * count) : new Float32Array(4 * count);
    for (let i = 0; i < count; ++i) {
      const at = (k) => from[c * i + k] / scale;
      for (let k = 0; k < 3; ++k) samples[4 * i + k] = gray ? at(0) : k < c ? at(k) : 0;
      samples[4 * i + 3] = c === 4 ? at(3) : gray && c === 2 ? at(1) : one;
      if (!z) continue;
      const [x, y] = [0, 1].map((k) => (at(k) * scale - z[0]) / z[1]);
      samples[4 * i + 2] = Math.round(z[0] + z[1] * Math.sqrt(Math.max(1 - x * x - y * y, 0))) / scale;
    }
    return {width: w, height: h, samples};
  }
}

// The normal map of heights, by the rule of libmesh/src/bump/bump.cpp in double precision, for borders
// that repeat or continue: differences use the point reflection beyond them, smoothing the border.
function normalsOf(heights, w, h, {taps, lines, wraps, scale}) {
  // The differences and means at each place of an axis: indices with weights.
  const sums = (n, repeats) => Array.from({length: n}, (_, i) => {
    const inside = (k) => (repeats ? (k + n) % n : Math.max(0, Math.min(k, n - 1)));
    const rises = taps.flatMap(([before, after, weight]) => [[before, -weight], [after, weight]].flatMap(([offset, f]) => {
      const at = i + offset, k = inside(at);
      return repeats || k === at ? [[k, f]] : [[k, 2 * f], [2 * k - at, -f]];
    }));
    return [rises, lines.flatMap((f, k) => (k ? [[inside(i - k), f], [inside(i + k), f]] : [[i, f]]))];
  });
  const columns = sums(w, wraps[0]), rows = sums(h, wraps[1]), result = new Uint16Array(3 * w * h);
  for (let y = 0; y < h; ++y) {
    const [rises, means] = rows[y].map((list) => {
      const sum = new Float64Array(w);
      for (const [at, f] of list) for (let x = 0; x < w; ++x) sum[x] += f * heights[at * w + x];
      return sum;
    });
    for (let x = 0; x < w; ++x) {
      let right = 0, down = 0;
      for (const [at, f] of columns[x][0]) right += f * means[at];
      for (const [at, f] of columns[x][1]) down += f * rises[at];
      const nx = -scale[0] * right, ny = scale[1] * down, f = 32767 / Math.sqrt(nx * nx + ny * ny + 1), i = 3 * (y * w + x);
      result[i] = 32768 + Math.round(f * nx);
      result[i + 1] = 32768 + Math.round(f * ny);
      result[i + 2] = 32768 + Math.round(f);
    }
  }
  return result;
}

// Attributes of 16 bits, by the least and the largest value of each component.
function unquantized(bytes, {min, max}) {
  const codes = new Uint16Array(bytes.buffer, bytes.byteOffset, bytes.length / 2), c = min.length;
  return Float32Array.from(codes, (code, i) => min[i % c] + (max[i % c] - min[i % c]) * code / 65535);
}

// Mip levels by the rule of libmesh/src/image/mip_levels.cpp: a box filter in linear light, with 16
// bits between levels of 8 bits; odd sizes take three texels.

const light = new Uint16Array(256), code = new Uint8Array(65536);
const linear = (c) => (c <= 0.04045 ? c / 12.92 : Math.pow((c + 0.055) / 1.055, 2.4));
for (let c = 0, filled = 0; c < 256; ++c) {
  light[c] = linear(c / 255) * 65535 + 0.5;
  const end = c === 255 ? 65536 : Math.ceil(linear((c + 0.5) / 255) * 65535);
  for (; filled < end; ++filled) code[filled] = c;
}

function taps(size, i) {
  if (size === 1) return [[0, 1]];
  if (size % 2 === 0) return [[2 * i, 0.5], [2 * i + 1, 0.5]];
  const m = size >> 1;
  return [[2 * i, (m - i) / size], [2 * i + 1, m / size], [2 * i + 2, (i + 1) / size]];
}

// The levels of a relief's heights, by the rule of libshade/src/render/height_levels.cpp: the maxima of
// patches, each between four texels.
function* levelsOfMaxima({width, height, samples}) {
  let last = new samples.constructor(samples.length);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      for (let k = 0; k < 4; ++k) {
        const at = (column, row) => samples[4 * ((row % height) * width + column % width) + k];
        last[4 * (y * width + x) + k] = Math.max(at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
      }
  while (width > 1 || height > 1) {
    const w = Math.max(width >> 1, 1), h = Math.max(height >> 1, 1);
    const next = new samples.constructor(4 * w * h);
    for (let y = 0; y < h; ++y)
      for (let x = 0; x < w; ++x)
        for (let row = 2 * y; row < (y + 1 === h ? height : 2 * y + 2); ++row)
          for (let column = 2 * x; column < (x + 1 === w ? width : 2 * x + 2); ++column)
            for (let k = 0; k < 4; ++k) {
              const to = 4 * (y * w + x) + k;
              next[to] = Math.max(next[to], last[4 * (row * width + column) + k]);
            }
    [width, height, last] = [w, h, next];
    yield {width, height, samples: last};
  }
}

function* smallerLevels(image, isSrgb) {
  let {width, height, samples} = image;
  const isByte = samples instanceof Uint8Array;
  if (isByte) {
    const wide = new Uint16Array(samples.length);
    for (let i = 0; i < wide.length; ++i) wide[i] = isSrgb && i % 4 !== 3 ? light[samples[i]] : samples[i] * 257;
    samples = wide;
  }
  while (width > 1 || height > 1) {
    const w = Math.max(width >> 1, 1), h = Math.max(height >> 1, 1);
    const next = new samples.constructor(4 * w * h);
    const isEven = width % 2 === 0 && height % 2 === 0;
    const across = Array.from({length: w}, (_, x) => taps(width, x));
    for (let y = 0; y < h; ++y) {
      const down = taps(height, y);
      for (let x = 0; x < w; ++x)
        for (let k = 0; k < 4; ++k) {
          let sum = 0;
          if (isEven) {
            const at = 4 * (2 * y * width + 2 * x) + k;
            sum = (samples[at] + samples[at + 4] + samples[at + 4 * width] + samples[at + 4 * width + 4]) / 4;
          } else {
            for (const [row, rowWeight] of down)
              for (const [at, weight] of across[x]) sum += rowWeight * weight * samples[4 * (row * width + at) + k];
          }
          next[4 * (y * w + x) + k] = isByte ? sum + 0.5 : sum;
        }
    }
    [width, height, samples] = [w, h, next];
    let stored = next;
    if (isByte) {
      stored = new Uint8Array(next.length);
      for (let i = 0; i < next.length; ++i)
        stored[i] = isSrgb && i % 4 !== 3 ? code[next[i]] : (next[i] + 128) / 257;
    }
    yield {width, height, samples: stored};
  }
}
