// SPDX-License-Identifier: Apache-2.0
// Draws a picture in the passes of libshade/src/render/renderer.cpp: shadow maps, opaque surfaces,
// the skybox, transmissive surfaces over a copy of these, blended surfaces from the farthest on,
// and the finishing pass.

class Painter {
  constructor(gpu, scene) {
    Object.assign(this, {gpu, scene, gl: gpu.gl, lights: {}, centers: {}, deformed: {}, version: -1});
    this.screen = this.gl.createVertexArray();
    this.blank = this.gl.createTexture();
  }

  // Draws into these columns of the canvas, which has this size.
  draw(picture, camera, width, height, [from, to] = [0, width]) {
    const {gl, scene} = this;
    if (this.version !== scene.version) {
      this.version = scene.version;
      this.lights = {};
      this.deformed = {};
      this.places = scene.matrices.map(placeOf);
      this.shadowOf = null;
    }
    this.camera = camera;
    this.picture = picture;
    this.toClip = clipFromWorld(camera, width / height);
    [width, height] = [Math.max(1, width), Math.max(1, height)];
    this.size = [width, height];
    this.limit = () => {
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(from, 0, to - from, height);
    };
    for (const [i, value] of [[1, [0, 0, 1, 0]], [2, [0, 0, 0, 0]], [5, [0, 0, 0, 0]], [3, [1, 0, 0, 1]], [4, [1, 1, 1, 1]]])
      gl.vertexAttrib4fv(i, value);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.cullFace(gl.BACK);
    gl.depthMask(true);
    if (picture.shadowMaps && this.shadowOf !== picture) this.drawShadows(picture);
    this.begin(picture);
    for (const draw of picture.draws) if (draw.pass === 'covering') this.issue(draw);
    if (picture.skybox) this.drawSky(picture.skybox);
    if (picture.copiesBehind) {
      this.copyBehind();
      for (const draw of picture.draws) if (draw.pass === 'transmissive') this.issue(draw);
    }
    this.issueBlended(picture);
    gl.disable(gl.BLEND);
    if (picture.finishing) this.finish(picture.finishing);
    if (picture.overlays.length) drawOverlays(this, picture);
    gl.disable(gl.SCISSOR_TEST);
    gl.bindVertexArray(null);
  }

  begin(picture) {
    const {gl} = this, [width, height] = this.size;
    this.target = picture.finishing ? this.targets(picture.samples) : null;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target && this.target.drawn);
    if (!this.target) this.limit();
    gl.viewport(0, 0, width, height);
    gl.clearColor(...(picture.counts ? [0, 0, 0, 1] : picture.clear));
    gl.clearDepth(1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!picture.counts) return;
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    gl.blendFuncSeparate(gl.ONE, gl.ONE, gl.ZERO, gl.ONE);
  }

  // Half floats with depth, with several samples where the device has them.
  targets(samples) {
    const {gl} = this, [width, height] = this.size;
    const known = this.kept;
    if (known && known.width === width && known.height === height && known.samples === samples) return known;
    if (known) {
      known.textures.forEach((t) => gl.deleteTexture(t));
      known.buffers.forEach((b) => gl.deleteRenderbuffer(b));
      known.framebuffers.forEach((f) => gl.deleteFramebuffer(f));
    }
    const made = {width, height, samples, textures: [], buffers: [], framebuffers: []};
    const color = () => {
      const name = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, name);
      const last = Math.floor(Math.log2(Math.max(width, height)));
      gl.texStorage2D(gl.TEXTURE_2D, last + 1, gl.RGBA16F, width, height);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST_MIPMAP_NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      made.textures.push(name);
      return name;
    };
    const framebuffer = (texture, level = 0) => {
      const name = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, name);
      if (texture) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, level);
      made.framebuffers.push(name);
      return name;
    };
    const buffer = (format, attachment, count) => {
      const name = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, name);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, count, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, name);
      made.buffers.push(name);
    };
    const offered = gl.getInternalformatParameter(gl.RENDERBUFFER, gl.RGBA16F, gl.SAMPLES) || [];
    const count = samples > 1 && Math.max(0, ...offered) >= samples ? samples : 0;
    made.color = color();
    made.resolved = framebuffer(made.color);
    made.drawn = made.resolved;
    if (count) {
      made.drawn = framebuffer(null);
      buffer(gl.RGBA16F, gl.COLOR_ATTACHMENT0, count);
    }
    buffer(gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT, count);
    made.levelsOf = (texture) => Array.from({length: Math.floor(Math.log2(Math.max(width, height))) + 1},
                                            (_, level) => framebuffer(texture, level));
    made.newColor = color;
    return this.kept = made;
  }

  // Copies what was drawn, with its levels, for transmissive surfaces.
  copyBehind() {
    const {gl, target} = this, [width, height] = this.size;
    if (!target.behind) {
      target.behind = target.newColor();
      target.behindLevels = target.levelsOf(target.behind);
    }
    const sizeOf = (level) => [Math.max(width >> level, 1), Math.max(height >> level, 1)];
    this.blit(target.drawn, target.behindLevels[0], sizeOf(0), sizeOf(0), gl.NEAREST);
    for (let level = 1; level < target.behindLevels.length; ++level)
      this.blit(target.behindLevels[level - 1], target.behindLevels[level], sizeOf(level - 1), sizeOf(level), gl.LINEAR);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.drawn);
  }

  // Copies colors from one framebuffer to another, of these sizes.
  blit(from, to, a, b, filter) {
    const {gl} = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
    gl.blitFramebuffer(0, 0, ...a, 0, 0, ...b, gl.COLOR_BUFFER_BIT, filter);
  }

  finish(pass) {
    const {gl, gpu, target} = this, [width, height] = this.size;
    if (target.drawn !== target.resolved) this.blit(target.drawn, target.resolved, this.size, this.size, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.limit();
    gl.viewport(0, 0, width, height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    const program = gpu.programs[pass.program];
    gl.useProgram(program.name);
    this.setAll(program, pass.values);
    program.samplers.forEach((name, unit) => this.bind(unit, {name: target.color, target: gl.TEXTURE_2D}, null));
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  drawSky(pass) {
    const {gl, gpu, camera} = this;
    const program = gpu.programs[pass.program];
    gl.useProgram(program.name);
    this.setAll(program, pass.values);
    const y = camera.height ? 0 : halfHeight(camera), aspect = this.size[0] / this.size[1];
    program.set('world_from_screen', [...times(column(camera.matrix, 0), y * aspect), ...times(column(camera.matrix, 1), y),
                                      ...times(column(camera.matrix, 2), -1)]);
    this.bindAll(program, pass.textures, {}, {});
    gl.disable(gl.CULL_FACE);
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  setAll(program, values) {
    for (const name in values) program.set(name, values[name]);
  }

  bind(unit, texture, sampler) {
    const {gl} = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(texture.target, texture.name);
    gl.bindSampler(unit, sampler);
  }

  bindAll(program, textures, rows, made) {
    program.samplers.forEach((name, unit) => {
      if (textures[name]) this.bind(unit, this.gpu.textures[textures[name][0]], this.gpu.sampler(textures[name][1]));
      else if (rows[name] !== undefined) this.bind(unit, this.gpu.textures[rows[name]], null);
      else if (made[name]) this.bind(unit, made[name], null);
      else this.bind(unit, {name: this.blank, target: this.gl.TEXTURE_2D}, null);
    });
  }

  // The uniforms of a surface; those that an animation moves, between the times that are recorded.
  valuesOf(index) {
    const {surfaces} = this.gpu.data.page, {scene} = this, {motion} = this.picture;
    const moved = motion && motion.clip === scene.clip && motion.surfaces[index];
    if (!moved) return surfaces[index].values;
    const {times} = motion, next = times.findIndex((t) => t > scene.time);
    if (next < 1) return surfaces[moved[next < 0 ? times.length - 1 : 0]].values;
    const [from, to] = [next - 1, next].map((k) => surfaces[moved[k]].values), values = {};
    const share = (scene.time - times[next - 1]) / (times[next] - times[next - 1]);
    for (const name in from) values[name] = from[name].map((x, i) => x + share * ((to[name] || from[name])[i] - x));
    return values;
  }

  // Sets the uniforms and textures of a draw.
  use(draw, program, toClip, eye) {
    const {gl, gpu, scene} = this, surface = gpu.data.page.surfaces[draw.surface];
    const place = this.places[draw.instance];
    gl.useProgram(program.name);
    this.setAll(program, this.valuesOf(draw.surface));
    this.setAll(program, place);
    program.set('clip_from_object', product(toClip, place.world_from_object));
    program.set('clip_from_world', toClip);
    if (eye) program.set('eye_world', eye);
    if (surface.values.blurred_level)
      program.set('blurred_level', surface.values.blurred_level[0] * Math.floor(Math.log2(Math.max(...this.size))));
    const made = this.shadowMaps ? {shadow_maps: this.shadowMaps} : {};
    if (this.target && this.target.behind) made.behind = {name: this.target.behind, target: gl.TEXTURE_2D};
    this.setShadow(program, place.world_from_object);
    const pose = scene.poses[draw.instance];
    if (pose) {
      const active = pose.weights.map((weight, i) => [weight, i, 0, 0]).filter((row) => row[0] !== 0);
      program.set('joint_pairs', draw.jointPairs);
      program.set('morph_layout', [active.length, ...draw.morphTexels]);
      const joints = pose.joints.flatMap((m) => [0, 1, 2].flatMap((i) => [m[i], m[4 + i], m[8 + i], m[12 + i]]));
      if (program.samplers.includes('joint_matrices')) made.joint_matrices = this.moving(draw.instance, 'joints', joints);
      if (program.samplers.includes('morph_weights')) made.morph_weights = this.moving(draw.instance, 'weights', active.flat());
    }
    if (program.hasLights || program.samplers.includes('light_buffer')) this.setLights(draw.lights, program, made);
    this.bindAll(program, surface.textures, draw.rows, made);
  }

  // A texture of rows that changes with the pose.
  moving(instance, kind, values) {
    const key = `${instance} ${kind}`;
    if (this.deformed[key]) return this.deformed[key];
    const count = Math.max(1, values.length / 4), height = Math.ceil(count / rowWidth);
    const width = height === 1 ? count : rowWidth, padded = new Float32Array(4 * width * height);
    padded.set(values);
    this.movingNames = this.movingNames || {};
    const name = this.movingNames[key] = this.movingNames[key] || this.gl.createTexture();
    return this.deformed[key] = this.gpu.rows(name, padded, width, height, 4);
  }

  setLights(layout, program, made) {
    const {gl} = this, key = JSON.stringify(layout);
    const known = this.lights[key] = this.lights[key] || {rows: lightRows(this.scene, layout)};
    if (program.hasLights) {
      if (!known.buffer) {
        known.buffer = gl.createBuffer();
        gl.bindBuffer(gl.UNIFORM_BUFFER, known.buffer);
        gl.bufferData(gl.UNIFORM_BUFFER, known.rows, gl.DYNAMIC_DRAW);
      }
      gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, known.buffer);
    } else {
      made.light_buffer = this.moving(key, 'lights', known.rows);
    }
  }

  setShadow(program, matrix) {
    const view = this.shadow;
    program.set('shadow_samples', view ? view.points.length : 0);
    if (!view) return;
    program.set('shadow_from_object', product(view.place, matrix));
    program.set('shadow_from_world', view.place);
    program.set('shadow_lift', times(view.place, view.lift));
    program.set('shadow_shift', view.shift);
    const points = new Array(32).fill(0);
    view.points.forEach((p, i) => [points[2 * i], points[2 * i + 1]] = p);
    program.set('shadow_points', points);
  }

  issue(draw) {
    const {gl, gpu} = this;
    const program = gpu.programs[draw.program];
    this.use(draw, program, this.toClip, eyeOf(this.camera));
    if (draw.bothSides) gl.disable(gl.CULL_FACE);
    else gl.enable(gl.CULL_FACE);
    gl.frontFace(this.places[draw.instance].handedness < 0 ? gl.CW : gl.CCW);
    if (draw.pass !== 'blended') {
      gl.bindVertexArray(gpu.mesh(draw.mesh));
      gl.drawElements(gl.TRIANGLES, 3 * draw.count, gl.UNSIGNED_INT, 12 * draw.first);
      return;
    }
    gl.bindVertexArray(gpu.mesh(draw.mesh, draw.first));
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.sorted(draw), gl.DYNAMIC_DRAW);
    gl.drawElements(gl.TRIANGLES, 3 * draw.count, gl.UNSIGNED_INT, 0);
  }

  // Blended draws from the one with the farthest center on, without writing depth.
  issueBlended(picture) {
    const {gl} = this, away = times(column(this.camera.matrix, 2), -1), eye = column(this.camera.matrix, 3);
    const draws = picture.draws.filter((draw) => draw.pass === 'blended').map((draw) => {
      const middle = transformed(this.scene.matrices[draw.instance], this.centersOf(draw).mean);
      return [dot(add(middle, eye, -1), away), draw];
    });
    if (!draws.length) return;
    draws.sort((a, b) => b[0] - a[0]);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.FUNC_ADD);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    for (const [, draw] of draws) this.issue(draw);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  // The centers of the triangles of a draw in object space, and their mean.
  centersOf(draw) {
    const key = `${draw.instance} ${draw.mesh} ${draw.first}`;
    const known = this.centers[key];
    if (known && (known.version === this.version || !this.isDeformed(draw))) return known;
    const {data} = this.gpu;
    const triangles = data.integers(data.page.meshes[draw.mesh].triangles).subarray(3 * draw.first, 3 * (draw.first + draw.count));
    const positions = this.positions(draw), centers = new Float32Array(triangles.length), sum = [0, 0, 0];
    for (let i = 0; i < centers.length; i += 3)
      for (let k = 0; k < 3; ++k) {
        centers[i + k] = (positions[3 * triangles[i] + k] + positions[3 * triangles[i + 1] + k] + positions[3 * triangles[i + 2] + k]) / 3;
        if (isFinite(centers[i + k])) sum[k] += centers[i + k];
      }
    return this.centers[key] = {centers, triangles, mean: times(sum, 3 / centers.length), version: this.version};
  }

  sorted(draw) {
    const {centers, triangles} = this.centersOf(draw), m = this.scene.matrices[draw.instance];
    const away = times(column(this.camera.matrix, 2), -1);
    const direction = [0, 1, 2].map((i) => dot(column(m, i), away));
    const depths = new Float32Array(draw.count), order = new Uint32Array(draw.count);
    for (let i = 0; i < draw.count; ++i) {
      const depth = centers[3 * i] * direction[0] + centers[3 * i + 1] * direction[1] + centers[3 * i + 2] * direction[2];
      depths[i] = isFinite(depth) ? depth : -Infinity;
      order[i] = i;
    }
    order.sort((a, b) => depths[b] - depths[a] || a - b);
    const result = new Uint32Array(triangles.length);
    order.forEach((from, i) => result.set(triangles.subarray(3 * from, 3 * from + 3), 3 * i));
    return result;
  }

  isDeformed(draw) {
    return this.scene.poses[draw.instance] !== null && (draw.jointPairs > 0 || draw.morphTexels[0] > 0);
  }

  // Positions in object space, as the pose deforms them (vertex.glsl).
  positions(draw) {
    const {data} = this.gpu, {page} = data;
    const rest = data.floats(page.meshes[draw.mesh].streams.find((s) => s.attribute === 'position_object').d);
    if (!this.isDeformed(draw)) return rest;
    const pose = this.scene.poses[draw.instance], moved = Float32Array.from(rest);
    const [perTarget, perVertex] = draw.morphTexels;
    const rows = (name) => (draw.rows[name] === undefined ? null : data.floats(page.textures[draw.rows[name]].d));
    const displacements = rows('morph_displacements'), joints = rows('joint_weights');
    for (let i = 0; i < moved.length / 3; ++i) {
      if (displacements)
        pose.weights.forEach((weight, target) => {
          if (weight !== 0)
            for (let k = 0; k < 3; ++k) moved[3 * i + k] += weight * displacements[4 * (target * perTarget + i * perVertex) + k];
        });
      if (!joints) continue;
      const at = [moved[3 * i], moved[3 * i + 1], moved[3 * i + 2]];
      let sum = [0, 0, 0];
      for (let k = 0; k < 2 * draw.jointPairs; ++k) {
        const [joint, weight] = joints.subarray(2 * (2 * i * draw.jointPairs + k));
        if (weight !== 0) sum = add(sum, transformed(pose.joints[joint], at), weight);
      }
      moved.set(sum, 3 * i);
    }
    return moved;
  }

  // The box of all that casts shadows, in world space.
  castingBounds(picture) {
    const bounds = {min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity]};
    const done = new Set();
    for (const draw of picture.draws) {
      if (draw.shadowProgram === undefined || done.has(draw.instance)) continue;
      done.add(draw.instance);
      const m = this.scene.matrices[draw.instance], positions = this.positions(draw);
      for (let i = 0; i < positions.length; i += 3)
        for (let k = 0; k < 3; ++k) {
          const x = m[k] * positions[i] + m[4 + k] * positions[i + 1] + m[8 + k] * positions[i + 2] + m[12 + k];
          if (x < bounds.min[k]) bounds.min[k] = x;
          if (x > bounds.max[k]) bounds.max[k] = x;
        }
    }
    return bounds;
  }

  drawShadows(picture) {
    const {gl, gpu} = this;
    this.shadowOf = picture;
    this.shadow = shadowView(this.scene, this.castingBounds(picture));
    if (!this.shadow) return;
    const {texels, points} = this.shadow, view = this.shadow;
    const target = gl.TEXTURE_2D_ARRAY;
    if (!this.shadowTarget) this.shadowTarget = gl.createFramebuffer();
    if (!this.shadowMaps || this.shadowMaps.texels !== texels || this.shadowMaps.layers !== points.length) {
      if (this.shadowMaps) gl.deleteTexture(this.shadowMaps.name);
      this.shadowMaps = {name: gl.createTexture(), target, texels, layers: points.length};
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(target, this.shadowMaps.name);
      gl.texStorage3D(target, 1, gl.DEPTH_COMPONENT16, texels, texels, points.length);
      for (const [parameter, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
                                        [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
                                        [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE], [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL]])
        gl.texParameteri(target, parameter, value);
    }
    const maps = this.shadowMaps;
    this.shadowMaps = this.shadow = null;  // Their own draws have no shadow.
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.viewport(0, 0, texels, texels);
    gl.disable(gl.CULL_FACE);
    gl.colorMask(false, false, false, false);
    points.forEach((point, layer) => {
      gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, maps.name, 0, layer);
      gl.clear(gl.DEPTH_BUFFER_BIT);
      const toClip = view.clip(point), light = view.light(point);
      for (const draw of picture.draws) {
        if (draw.shadowProgram === undefined) continue;
        this.use(draw, gpu.programs[draw.shadowProgram], toClip, light);
        gl.bindVertexArray(gpu.mesh(draw.mesh));
        gl.drawElements(gl.TRIANGLES, 3 * draw.count, gl.UNSIGNED_INT, 12 * draw.first);
      }
    });
    gl.colorMask(true, true, true, true);
    this.shadowMaps = maps;
    this.shadow = view;
  }
}

// The uniforms of an instance's matrix (set_place() of libshade/src/render/draw_values.cpp).
function placeOf(matrix) {
  const [x, y, z] = [0, 1, 2].map((i) => column(matrix, i));
  const cofactors = [cross(y, z), cross(z, x), cross(x, y)];
  const determinant = dot(x, cofactors[0]), side = determinant < 0 ? -1 : 1;
  const scaled = (columns) => {
    const all = columns.flat(), largest = Math.max(...all.map(Math.abs));
    return largest > 0 ? times(all, 1 / largest) : new Array(9).fill(0);
  };
  return {
    world_from_object: matrix,
    world_from_object_normal: scaled(cofactors.map((c) => times(c, side))),
    world_from_object_tangent: scaled([x, y, z]),
    handedness: side,
    object_scale: Math.cbrt(Math.abs(determinant)),
  };
}
