// SPDX-License-Identifier: Apache-2.0
// The resources of a page on the GPU: programs, meshes, textures and samplers. All are made again
// after the loss of the context.

const locations = ['position_object', 'normal_object', 'texcoord', 'tangent_object', 'color_linear', 'texcoord_2'];
const rowWidth = 2048;

class Gpu {
  constructor(gl, data) {
    this.gl = gl;
    this.data = data;
    gl.getExtension('EXT_color_buffer_float') || gl.getExtension('EXT_color_buffer_half_float');
    this.filtersFloats = gl.getExtension('OES_texture_float_linear') !== null;
    this.anisotropic = gl.getExtension('EXT_texture_filter_anisotropic');
    this.programs = [];
    this.meshes = [];
    this.samplers = [];
    this.link(data.parts);
  }

  // Links programs: all, or those that contain a part. If one fails, all stay as they are.
  link(parts, changed) {
    const {gl, data} = this, made = [];
    data.page.programs.forEach((program, i) => {
      const stages = [program.vertex, program.fragment].map((stage) => assembled(parts, stage));
      if (!changed || stages.some((stage) => stage.parts.has(changed))) made[i] = new Program(gl, ...stages);
    });
    made.forEach((program) => program.finish());
    made.forEach((program, i) => {
      if (this.programs[i]) gl.deleteProgram(this.programs[i].name);
      this.programs[i] = program;
    });
  }

  // Decodes and uploads all textures.
  async load() {
    this.textures = [];
    for (const texture of this.data.page.textures) this.textures.push(await this.texture(texture));
  }

  async texture(texture) {
    const {gl, data} = this;
    const name = gl.createTexture();
    const target = texture.kind === 'cube' ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    if (texture.kind === 'rows') {
      const values = data.floats(texture.d), height = Math.max(1, Math.ceil(texture.w / rowWidth));
      const width = height === 1 ? texture.w : rowWidth;
      const padded = new Float32Array(width * height * texture.c);
      padded.set(values);
      return this.rows(name, padded, width, height, texture.c);
    }
    if (texture.kind === 'cube') {
      gl.bindTexture(target, name);
      const bytes = data.section(texture.d), isCoded = texture.t === 'bits_8';
      const levels = texture.levels ? Math.log2(texture.w) : 0;
      let offset = 0, level = 0;
      for (let side = texture.w; offset < bytes.length; side = Math.max(side >> 1, 1), ++level)
        for (let face = 0; face < 6; ++face) {
          const length = side * side * (isCoded ? 3 : 4);
          const part = bytes.slice(offset, offset + length);
          offset += length;
          const at = gl.TEXTURE_CUBE_MAP_POSITIVE_X + face;
          if (!isCoded)
            gl.texImage2D(at, level, gl.RGB9_E5, side, side, 0, gl.RGB, gl.UNSIGNED_INT_5_9_9_9_REV, new Uint32Array(part.buffer));
          else if (texture.srgb) gl.texImage2D(at, level, gl.SRGB8_ALPHA8, side, side, 0, gl.RGBA, gl.UNSIGNED_BYTE, withAlpha(part));
          else gl.texImage2D(at, level, gl.RGB8, side, side, 0, gl.RGB, gl.UNSIGNED_BYTE, part);
        }
      gl.texParameteri(target, gl.TEXTURE_MAX_LEVEL, level - 1);
      return {name, target};
    }
    const image = await data.image(gl, texture);
    gl.bindTexture(target, name);
    const isByte = image.samples instanceof Uint8Array;
    const format = isByte ? (texture.srgb ? gl.SRGB8_ALPHA8 : gl.RGBA8) : this.filtersFloats ? gl.RGBA32F : gl.RGBA16F;
    const largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    let level = 0;
    const upload = ({width, height, samples}) => {
      if (Math.max(width, height) > largest) return;
      gl.texImage2D(target, level++, format, width, height, 0, gl.RGBA, isByte ? gl.UNSIGNED_BYTE : gl.FLOAT, samples);
    };
    upload(image);
    if (texture.levels || level === 0) {
      const smallerOnes = texture.maxima ? levelsOfMaxima(image) : smallerLevels(image, texture.srgb);
      for (const smaller of smallerOnes) upload(smaller);
    }
    gl.texParameteri(target, gl.TEXTURE_MAX_LEVEL, level - 1);
    return {name, target};
  }

  // A texture of rows from floats.
  rows(name, values, width, height, channels) {
    const {gl} = this;
    gl.bindTexture(gl.TEXTURE_2D, name);
    const [internal, format] = channels === 1 ? [gl.R32F, gl.RED] : [gl.RGBA32F, gl.RGBA];
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, gl.FLOAT, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return {name, target: gl.TEXTURE_2D};
  }

  sampler(i) {
    if (this.samplers[i]) return this.samplers[i];
    const {gl} = this, s = this.data.page.samplers[i];
    const name = gl.createSampler();
    for (const [parameter, value] of [[gl.TEXTURE_WRAP_S, s.u], [gl.TEXTURE_WRAP_T, s.v],
                                      [gl.TEXTURE_MIN_FILTER, s.min], [gl.TEXTURE_MAG_FILTER, s.mag]])
      gl.samplerParameteri(name, parameter, value);
    const e = this.anisotropic;
    if (e && s.anisotropy > 1)
      gl.samplerParameterf(name, e.TEXTURE_MAX_ANISOTROPY_EXT, Math.min(s.anisotropy, gl.getParameter(e.MAX_TEXTURE_MAX_ANISOTROPY_EXT)));
    return this.samplers[i] = name;
  }

  // The vertex array of a mesh. Draws in another order of triangles have one of their own.
  mesh(i, order) {
    const key = order === undefined ? i : `${i} ${order}`;
    if (this.meshes[key]) return this.meshes[key];
    const {gl, data} = this, mesh = data.page.meshes[i];
    const name = gl.createVertexArray();
    gl.bindVertexArray(name);
    for (const stream of mesh.streams) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer(stream.d, gl.ARRAY_BUFFER));
      const location = locations.indexOf(stream.attribute);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, stream.c, gl.FLOAT, false, 0, 0);
    }
    const triangles = order === undefined ? this.buffer(mesh.triangles, gl.ELEMENT_ARRAY_BUFFER) : gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
    gl.bindVertexArray(null);
    return this.meshes[key] = name;
  }

  buffer(section, target) {
    const {gl} = this;
    this.buffers = this.buffers || {};
    if (this.buffers[section]) return this.buffers[section];
    const name = gl.createBuffer();
    gl.bindBuffer(target, name);
    gl.bufferData(target, target === gl.ARRAY_BUFFER ? this.data.floats(section) : this.data.section(section), gl.STATIC_DRAW);
    return this.buffers[section] = name;
  }
}

function withAlpha(rgb) {
  const rgba = new Uint8Array(rgb.length / 3 * 4).fill(255);
  for (let i = 0; i < rgb.length / 3; ++i) for (let k = 0; k < 3; ++k) rgba[4 * i + k] = rgb[3 * i + k];
  return rgba;
}

// A program whose uniforms are set by name.
class Program {
  constructor(gl, vertex, fragment) {
    this.gl = gl;
    this.name = gl.createProgram();
    this.stages = [vertex, fragment];
    this.shaders = this.stages.map(({text}, i) => {
      const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(this.name, shader);
      return shader;
    });
    locations.forEach((attribute, i) => gl.bindAttribLocation(this.name, i, attribute));
    gl.linkProgram(this.name);
  }

  finish() {
    const {gl, name} = this;
    if (!gl.getProgramParameter(name, gl.LINK_STATUS) && !gl.isContextLost()) {
      const places = this.stages.flatMap((stage, i) => placesIn(gl.getShaderInfoLog(this.shaders[i]) || '', stage));
      throw shaderError(places.length ? places : placesIn(gl.getProgramInfoLog(name), this.stages[1]));
    }
    gl.useProgram(name);
    this.uniforms = {};
    this.samplers = [];
    const count = gl.getProgramParameter(name, gl.ACTIVE_UNIFORMS) || 0;
    const setters = {[gl.FLOAT]: 'uniform1fv', [gl.FLOAT_VEC2]: 'uniform2fv', [gl.FLOAT_VEC3]: 'uniform3fv',
                     [gl.FLOAT_VEC4]: 'uniform4fv', [gl.FLOAT_MAT3]: 'uniformMatrix3fv', [gl.FLOAT_MAT4]: 'uniformMatrix4fv',
                     [gl.INT]: 'uniform1iv', [gl.INT_VEC3]: 'uniform3iv'};
    for (let i = 0; i < count; ++i) {
      const {name: label, type} = gl.getActiveUniform(name, i);
      const location = gl.getUniformLocation(name, label);
      if (location === null) continue;  // In a block.
      const short = label.replace('[0]', '');
      if (setters[type]) {
        this.uniforms[short] = {location, setter: setters[type]};
      } else {
        gl.uniform1i(location, this.samplers.length);
        this.samplers.push(short);
      }
    }
    const block = gl.getUniformBlockIndex(name, 'Lights');
    this.hasLights = block !== gl.INVALID_INDEX;
    if (this.hasLights) gl.uniformBlockBinding(name, block, 0);
  }

  set(name, value) {
    const uniform = this.uniforms[name];
    if (!uniform) return;
    const values = typeof value === 'number' ? [value] : value;
    if (uniform.setter.startsWith('uniformMatrix')) this.gl[uniform.setter](uniform.location, false, values);
    else this.gl[uniform.setter](uniform.location, values);
  }
}
