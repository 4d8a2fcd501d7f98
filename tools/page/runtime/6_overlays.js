// SPDX-License-Identifier: Apache-2.0
// Lines and discs over the finished picture, by the rules of libshade/src/render/overlays.cpp: the
// depth of opaque surfaces is drawn again, a little farther away.

function drawOverlays(painter, {draws, overlays}) {
  const {gl, gpu, scene, toClip} = painter;
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.colorMask(false, false, false, false);
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(1, 1);
  for (const draw of draws) if (draw.hides) painter.issue({...draw, program: draw.overlay});
  gl.disable(gl.POLYGON_OFFSET_FILL);
  gl.colorMask(true, true, true, true);
  for (const {kind, program: index, mesh, count, color, origin, instance} of overlays) {
    const program = gpu.programs[index], areDiscs = kind === 'markers';
    if (kind === 'wireframe') {
      for (const draw of draws) drawEdges(painter, draw, color);
    } else if (kind !== 'frames' || scene.time === gpu.data.page.seconds) {
      gl.useProgram(program.name);
      program.set('all_color', color);
      program.set('clip_from_object', product(toClip, areDiscs ? scene.matrices[instance]
          : fromColumns([1, 0, 0], [0, 1, 0], [0, 0, 1], origin)));
      if (areDiscs) gl.disable(gl.DEPTH_TEST);
      gl.bindVertexArray(gpu.mesh(mesh));
      gl.drawArrays(areDiscs ? gl.POINTS : gl.LINES, 0, count);
      gl.enable(gl.DEPTH_TEST);
    }
  }
}

// The edges of the triangles that the draw shows: those that turn their back are left out here,
// because the device culls no lines.
function drawEdges(painter, draw, color) {
  const {gl, gpu, toClip} = painter, program = gpu.programs[draw.overlay], {triangles} = painter.centersOf(draw);
  const matrix = product(toClip, painter.scene.matrices[draw.instance]), positions = painter.positions(draw), edges = [];
  const at = (i) => [0, 1, 3].map((k) => matrix[k] * positions[3 * i] + matrix[4 + k] * positions[3 * i + 1] +
                                          matrix[8 + k] * positions[3 * i + 2] + matrix[12 + k]);
  const side = painter.places[draw.instance].handedness;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = triangles.subarray(i, i + 3);
    if (draw.bothSides || side * dot(at(a), cross(at(b), at(c))) > 0) edges.push(a, b, b, c, c, a);
  }
  painter.use(draw, program, toClip);
  program.set('all_color', color);
  gl.bindVertexArray(gpu.mesh(draw.mesh, `edges ${draw.first}`));
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(edges), gl.DYNAMIC_DRAW);
  gl.drawElements(gl.LINES, edges.length, gl.UNSIGNED_INT, 0);
}
