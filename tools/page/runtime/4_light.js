// SPDX-License-Identifier: Apache-2.0
// Lights as rows of four numbers, and the shadow maps of the main light, by the rules of
// libshade/src/effects/light_rows.cpp.

const isBlack = (color) => color.every((x) => x === 0);
const shines = (light) => light.on && !(isBlack(light.color) && isBlack(light.specular || light.color));

function lightRows(scene, layout) {
  const rows = [];
  const positionRow = (light) => rows.push(...light.position, light.range ? 1 / light.range : 0);
  const intensityRow = (light) => rows.push(...light.color, light.falloff ? 1 : 0);
  const write = {
    directional(light) {
      rows.push(...times(unit(light.direction), -1), 0);
      rows.push(...light.color, 0);
    },
    point(light) {
      positionRow(light);
      intensityRow(light);
    },
    spot(light) {
      const outer = Math.cos(light.outer_cone);
      const scale = 1 / Math.max(Math.cos(light.inner_cone) - outer, 1e-3);
      positionRow(light);
      intensityRow(light);
      rows.push(...times(unit(light.direction), scale), -outer * scale);
    },
  };
  const more = layout.colors ? 1 : 0;
  let end = 0;
  for (const [kind, perLight] of [['directional', 2], ['point', 2], ['spot', 3]]) {
    end += 4 * (perLight + more) * layout[kind];
    for (const light of scene.lights[kind]) {
      if (!shines(light) || rows.length >= end) continue;
      write[kind](light);
      if (more) rows.push(...(light.specular || light.color), 0);
    }
    while (rows.length < end) rows.push(0);
  }
  return new Float32Array(rows);
}

// The shadow of a scene as its maps show it: light_rows.h describes the members. Matrices are rows.
function shadowView(scene, bounds) {
  const light = scene.lights.directional.find(shines) || scene.lights.spot.find(shines) || scene.lights.point.find(shines);
  if (!light || !(bounds.min[0] <= bounds.max[0])) return null;
  const isDirectional = !light.position;
  const center = times(add(bounds.min, bounds.max), 0.5);
  const radius = 0.5 * size(add(bounds.max, bounds.min, -1));
  if (!(radius > 0)) return null;
  const toLight = isDirectional ? times(unit(light.direction), -1) : add(light.position, center, -1);
  const distance = isDirectional ? radius : size(toLight);
  if (!isDirectional && distance < 1.1 * radius) return null;
  const back = unit(toLight);
  const right = unit(cross(Math.abs(back[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], back)), up = cross(back, right);
  const isHard = scene.shadow === 0, tangent = Math.tan(0.5 * scene.shadow);
  const texels = isHard ? 2048 : 1024, margin = 1.02;
  const near = isDirectional ? radius - margin * radius : distance - Math.min(margin * radius, 0.98 * distance);
  const far = distance + margin * radius;
  const origin = add(center, back, distance);
  const x = [...right, -dot(right, origin)], y = [...up, -dot(up, origin)];
  const depth = [...times(back, -1), dot(back, origin)], one = [0, 0, 0, 1];
  const half = margin * (isDirectional ? radius * (1 + tangent)
      : radius / Math.sqrt(distance * distance - radius * radius) + tangent * radius / (distance - radius));
  const w = isDirectional ? one : depth;
  const z = times(add(depth, one, -near), (isDirectional ? 1 : far) / (far - near));
  const rows = [times(add(times(x, 1 / half), w), 0.5), times(add(times(y, 1 / half), w), 0.5), z, w];
  const slope = 0.5 * tangent / half;
  const shift = times(isDirectional ? [far - near, near - distance]
      : [distance * (far - near) / (far * near), 1 - distance / near], slope);
  const points = [];
  for (let i = 0; i < (isHard ? 1 : 16); ++i) {
    const angle = Math.PI * (3 - Math.sqrt(5)) * i, r = isHard ? 0 : Math.sqrt((i + 0.5) / 16);
    points.push([r * Math.cos(angle), r * Math.sin(angle)]);
  }
  return {texels, points, shift, place: fromRows(rows), lift: 2.5 * 2 * half * (isDirectional ? 1 : far) / texels,
          light(point) {  // The position of a point of the light, or the direction to it; homogeneous.
            const disc = add(times(right, point[0]), up, point[1]), reach = tangent * (isDirectional ? 1 : distance);
            return [...add(isDirectional ? back : light.position, disc, reach), isDirectional ? 0 : 1];
          },
          clip(point) {
            const moved = add(times(rows[2], shift[0]), rows[3], shift[1]);
            const side = (k) => add(times(add(rows[k], moved, point[k]), 2), rows[3], -1);
            return fromRows([side(0), side(1), add(times(rows[2], 2), rows[3], -1), rows[3]]);
          }};
}

const fromRows = (rows) => identity().map((_, i) => rows[i % 4][i >> 2]);
