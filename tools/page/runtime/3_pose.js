// SPDX-License-Identifier: Apache-2.0
// The scene at a time: matrices of nodes, instances, lights and the camera, joint matrices and
// morph weights, by the rules of libshade/src/scene/scene_graph.cpp.

class Scene {
  constructor(data, scene) {
    this.data = data;
    Object.assign(this, scene);
    this.keys = scene.animations.filter((a) => a.channels);
    for (const animation of this.keys)
      for (const channel of animation.channels) {
        channel.times = data.floats(channel.times);
        channel.values = data.floats(channel.values);
      }
    this.matrices = scene.instances.map((instance) => instance.matrix);
    this.poses = scene.instances.map((instance) => instance.pose || null);
    this.version = 0;  // Changes with the pose.
  }

  // Moves everything to a time.
  pose(seconds) {
    this.time = seconds;
    ++this.version;
    const local = this.nodes.map((node) => ({...node}));
    let clip = 0;
    for (const animation of this.animations) {
      if (animation.channels && this.clip !== null && this.clip !== clip++) continue;
      this.animate(animation, local, seconds);
    }
    const world = [];
    const matrixOf = (i) => {
      if (world[i]) return world[i];
      const own = localMatrix(local[i]);
      return world[i] = local[i].parent === undefined ? own : product(matrixOf(local[i].parent), own);
    };
    const carried = (object) => {
      if (object.node === undefined) return null;
      const node = matrixOf(object.node);
      if (!object.positionOnly) return product(node, object.fromObject);
      const matrix = [...object.fromObject];
      [matrix[12], matrix[13], matrix[14]] = transformed(node, column(object.fromObject, 3));
      return matrix;
    };
    this.instances.forEach((instance, i) => {
      const matrix = carried(instance);
      if (matrix) this.matrices[i] = matrix;
    });
    for (const kind of ['directional', 'point', 'spot'])
      for (const light of this.lights[kind]) {
        const matrix = carried(light);
        if (!matrix) continue;
        if (light.direction) light.direction = times(unit(column(matrix, 2), [0, 0, 1]), -1);
        if (light.position) light.position = column(matrix, 3);
      }
    const camera = carried(this.camera);
    if (camera) this.camera.matrix = cameraMatrix(camera);
    for (const deformed of this.deformed) this.deform(deformed, local[deformed.node], matrixOf);
    if (this.camera.seesAll) this.camera.far = this.farBehindAll();
  }

  animate(animation, local, seconds) {
    if (animation.orbit) {
      const o = animation;
      const azimuth = o.azimuth + o.azimuthSpeed * seconds, elevation = o.elevation + o.elevationSpeed * seconds;
      const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
      const back = [ce * sa, se, ce * ca];
      const node = local[o.node];
      node.translation = add(o.center, back, o.radius);
      if (o.facesCenter) node.axes = fromColumns([ca, 0, -sa], [-se * sa, ce, -se * ca], back, [0, 0, 0]);
    } else if (animation.turntable) {
      local[animation.node].turntable = turnAbout(unit(animation.axis), animation.angle + animation.speed * seconds);
    } else {
      const length = Math.max(0, ...animation.channels.map((c) => c.times[c.times.length - 1]));
      const now = length > 0 ? ((seconds % length) + length) % length : 0;
      for (const channel of animation.channels) {
        const value = valueAt(channel, now);
        if (channel.property === 'pointer') this.setNumber(channel, value);
        else local[channel.node][channel.property] = value;
      }
    }
  }

  // Moves a number or color of a light or of the camera.
  setNumber(channel, value) {
    const [list, name] = channel.pointer.split('.');
    const limit = (x) => Math.min(Math.max(x, channel.min), channel.max);
    const kind = list.replace('_lights', '');
    const object = list === 'cameras' ? (channel.node === this.chosenCamera ? this.camera : null)
        : this.lights[kind] && this.lights[kind][channel.node];
    if (!object) return;
    const field = name === 'orthographic_height' ? 'height' : name;
    object[field] = Array.isArray(object[field]) || name === 'color' || name === 'specular'
        ? value.slice(0, 3).map(limit) : limit(value[0]);
    if (kind === 'spot') {
      object.outer_cone = Math.max(object.outer_cone, 1e-3);
      object.inner_cone = Math.min(object.inner_cone, object.outer_cone * (1 - 1e-7));
    }
  }

  deform(deformed, node, matrixOf) {
    const pose = this.poses[deformed.instance];
    if (!pose) return;
    pose.weights = Array.from(node.weights || deformed.weights);
    if (!deformed.joints.length) return;
    pose.joints = deformed.joints.map((joint, i) => product(matrixOf(joint), deformed.fromMesh[i]));
    this.matrices[deformed.instance] = identity();
  }

  farBehindAll() {
    const eye = column(this.camera.matrix, 3);
    let reach = 0;
    this.instances.forEach((instance, i) => {
      for (let corner = 0; corner < 8; ++corner) {
        const at = [0, 1, 2].map((k) => instance[corner >> k & 1 ? 'max' : 'min'][k]);
        const distance = size(add(transformed(this.matrices[i], at), eye, -1));
        if (isFinite(distance)) reach = Math.max(reach, distance);
      }
    });
    return Math.max(2 * this.camera.near, 1.01 * reach);
  }
}

function localMatrix(node) {
  let matrix = node.matrix;
  if (!matrix) {
    const t = node.translation, s = node.scale;
    const axes = node.axes || fromRotation(unit(Array.from(node.rotation), [0, 0, 0, 1]));
    matrix = fromColumns(times(column(axes, 0), s[0]), times(column(axes, 1), s[1]), times(column(axes, 2), s[2]),
                         [t[0], t[1], t[2]]);
  }
  return node.turntable ? product(matrix, node.turntable) : matrix;
}

function fromRotation([x, y, z, w]) {
  return fromColumns([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
                     [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
                     [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], [0, 0, 0]);
}

// Rotation and translation without scale.
function cameraMatrix(matrix) {
  const back = unit(column(matrix, 2), [0, 0, 1]);
  const right = unit(cross(unit(column(matrix, 1), [0, 1, 0]), back), [1, 0, 0]);
  return fromColumns(right, cross(back, right), back, column(matrix, 3));
}

// The value of a channel between its keys (glTF 2.0, appendix C).
function valueAt(channel, seconds) {
  const {times: at, values, count} = channel;
  const isCubic = channel.interpolation === 'cubic_spline', rotates = channel.property === 'rotation';
  const part = (key, which) => {
    const first = (isCubic ? 3 * key + which : key) * count;
    return Array.from(values.subarray(first, first + count));
  };
  const value = (key) => (rotates ? unit(part(key, 1), [0, 0, 0, 1]) : part(key, 1));
  let next = 0;
  while (next < at.length && at[next] <= seconds) ++next;
  if (next === 0) return value(0);
  if (next === at.length || channel.interpolation === 'step') return value(next - 1);
  const span = at[next] - at[next - 1], t = (seconds - at[next - 1]) / span;
  if (isCubic) {
    const t2 = t * t, t3 = t2 * t;
    const from = part(next - 1, 1), out = part(next - 1, 2), into = part(next, 0), to = part(next, 1);
    const sum = from.map((a, i) => (2 * t3 - 3 * t2 + 1) * a + span * (t3 - 2 * t2 + t) * out[i] +
        (3 * t2 - 2 * t3) * to[i] + span * (t3 - t2) * into[i]);
    return rotates ? unit(sum, value(next - 1)) : sum;
  }
  const from = value(next - 1);
  let to = value(next);
  if (!rotates) return from.map((a, i) => a + t * (to[i] - a));
  if (dot(from, to) < 0) to = times(to, -1);
  const angle = 2 * Math.atan2(size(add(to, from, -1)), size(add(to, from)));
  const sine = Math.sin(angle);
  if (!(sine > 0)) return from.map((a, i) => a + t * (to[i] - a));
  return times(add(times(from, Math.sin((1 - t) * angle)), to, Math.sin(t * angle)), 1 / sine);
}
