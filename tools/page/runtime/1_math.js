// SPDX-License-Identifier: Apache-2.0
// Matrices as arrays of 16 numbers, by columns, and vectors as arrays; all in double precision.

const identity = () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function product(a, b) {
  const c = new Array(16);
  for (let j = 0; j < 4; ++j)
    for (let i = 0; i < 4; ++i) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + i] * b[4 * j + k];
      c[4 * j + i] = sum;
    }
  return c;
}

function inverse(m) {
  // Gauss and Jordan, with the largest pivot.
  const a = [];
  for (let i = 0; i < 4; ++i)
    a.push([m[i], m[4 + i], m[8 + i], m[12 + i], +(i === 0), +(i === 1), +(i === 2), +(i === 3)]);
  for (let c = 0; c < 4; ++c) {
    let best = c;
    for (let r = c + 1; r < 4; ++r) if (Math.abs(a[r][c]) > Math.abs(a[best][c])) best = r;
    [a[c], a[best]] = [a[best], a[c]];
    const pivot = a[c][c];
    a[c] = a[c].map((x) => x / pivot);
    for (let r = 0; r < 4; ++r)
      if (r !== c) {
        const factor = a[r][c];
        a[r] = a[r].map((x, i) => x - factor * a[c][i]);
      }
  }
  const result = new Array(16);
  for (let i = 0; i < 4; ++i) for (let j = 0; j < 4; ++j) result[4 * j + i] = a[i][4 + j];
  return result;
}

const transformed = (m, p, w = 1) => [0, 1, 2].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i] * w);
const column = (m, i) => [m[4 * i], m[4 * i + 1], m[4 * i + 2]];
const add = (a, b, f = 1) => a.map((x, i) => x + f * b[i]);
const times = (a, f) => a.map((x) => x * f);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = (a) => Math.hypot(...a);

// The unit vector, or the fallback for one without a length.
function unit(a, fallback) {
  const length = size(a);
  return length > 0 && isFinite(length) ? times(a, 1 / length) : fallback;
}

// Four columns of three numbers as a matrix.
const fromColumns = (x, y, z, p) => [...x, 0, ...y, 0, ...z, 0, ...p, 1];

// The turn about a unit axis, counter-clockwise seen from its tip.
function turnAbout(axis, angle) {
  const cosine = Math.cos(angle), s = times(axis, Math.sin(angle)), c = times(axis, 1 - cosine);
  const [x, y, z] = axis;
  return fromColumns([c[0] * x + cosine, c[0] * y + s[2], c[0] * z - s[1]],
                     [c[1] * x - s[2], c[1] * y + cosine, c[1] * z + s[0]],
                     [c[2] * x + s[1], c[2] * y - s[0], c[2] * z + cosine], [0, 0, 0]);
}

// The projection of a camera times the inverse of its matrix.
function clipFromWorld(camera, aspect) {
  const {near, far} = camera;
  const y = 1 / halfHeight(camera);
  const p = new Array(16).fill(0);
  p[0] = y / aspect;
  p[5] = y;
  if (camera.height) {
    p[10] = 2 / (near - far);
    p[14] = (far + near) / (near - far);
    p[15] = 1;
  } else {
    p[10] = (far + near) / (near - far);
    p[11] = -1;
    p[14] = 2 * far * near / (near - far);
  }
  return product(p, inverse(camera.matrix));
}

const halfHeight = (camera) => (camera.height ? camera.height / 2 : Math.tan(camera.fov / 2));

// The eye in homogeneous coordinates; of an orthographic camera, the direction to it.
const eyeOf = (camera) => (camera.height ? [...column(camera.matrix, 2), 0] : [...column(camera.matrix, 3), 1]);
