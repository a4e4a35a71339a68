"use strict";
(() => {
  const byId = (id) => document.getElementById(id);
  const root = document.documentElement;
  const canvas = byId("canvas");
  const message = byId("message");

  // What goes wrong is said in place of the picture, and is what a test reads.
  const fail = (what) => {
    root.dataset.state = "failed";
    message.hidden = false;
    message.textContent = `${what} The histogram and the tables stand without the picture.`;
  };
  window.addEventListener("error", (event) => fail(`The picture could not be drawn: ${event.message}.`));

  const scene = JSON.parse(byId("scene").textContent);

  // ---- what works without WebGL: the colours of the page, the order of the table

  const themes = [["auto", "Auto", "as the system has them"], ["light", "Light", "light"], ["dark", "Dark", "dark"]];
  let theme = 0;
  const themeButton = byId("theme");
  themeButton.hidden = false;
  themeButton.addEventListener("click", () => {
    theme = (theme + 1) % themes.length;
    const [value, label, words] = themes[theme];
    root.dataset.theme = value;
    themeButton.textContent = label;
    themeButton.setAttribute("aria-label", `Colours: ${words}`);
    redraw();
  });

  const table = document.querySelector(".faces table");
  const headings = table ? [...table.tHead.rows[0].cells] : [];
  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = heading.textContent;
    heading.replaceChildren(button);
    button.addEventListener("click", () => {
      const ascending = heading.getAttribute("aria-sort") === "descending" || (column < 2 && !heading.hasAttribute("aria-sort"));
      headings.forEach((other) => other.removeAttribute("aria-sort"));
      heading.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      const rows = [...table.tBodies[0].rows];
      const key = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent;
      const compare = (a, b) => {
        const [x, y] = [key(a), key(b)];
        return column === 1 ? x.localeCompare(y) : Number(x) - Number(y);
      };
      rows.sort((a, b) => (ascending ? compare(a, b) : compare(b, a)));
      table.tBodies[0].append(...rows);
    });
  });

  // ---- the data

  // Little-endian, as all machines are that have WebGL.
  const decode = (text, Numbers) => {
    const bytes = atob(text);
    const out = new Uint8Array(bytes.length);
    for (let i = 0; i < bytes.length; i++) out[i] = bytes.charCodeAt(i);
    return new Numbers(out.buffer);
  };
  const centre = scene.centre;
  const vertices = decode(scene.part.vertices, Float32Array);
  const normals = decode(scene.part.normals, Float32Array);
  const triangles = decode(scene.part.triangles, Uint32Array);
  const edges = decode(scene.edges, Float32Array);
  const position = decode(scene.points.position, Float64Array);
  const deviation = decode(scene.points.deviation, Float64Array);
  const lowerBound = decode(scene.points.lower_bound, Float64Array);
  const line = decode(scene.points.line, Float64Array);
  const face = decode(scene.points.face, Uint32Array);
  const flags = decode(scene.points.flags, Uint8Array);
  const count = deviation.length;
  const coloured = scene.faces.filter((one) => one.colour !== null && one.indices > 0);
  const NO_SIDE = 1;
  const NOT_CERTIFIED = 2;

  const colourOf = (value) => {
    const stops = scene.colours;
    const at = (Math.min(1, Math.max(-1, value / scene.limit)) + 1) / 2 * (stops.length - 1);
    const i = Math.min(Math.floor(at), stops.length - 2);
    return stops[i].map((c, k) => Math.round(c + (stops[i + 1][k] - c) * (at - i)));
  };
  const near = new Float32Array(3 * count);
  const colours = new Uint8Array(4 * count);
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 3; k++) near[3 * i + k] = position[3 * i + k] - centre[k];
    colours.set(colourOf(deviation[i]), 4 * i);
    colours[4 * i + 3] = 255;
  }

  // The box of the part, or of the points where there is none: what "Fit" shows.
  const box = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
  let reach = 0;
  const measure = (coordinates, grows) => {
    for (let i = 0; i < coordinates.length; i += 3) {
      reach = Math.max(reach, Math.hypot(coordinates[i], coordinates[i + 1], coordinates[i + 2]));
      for (let k = 0; grows && k < 3; k++) {
        box.min[k] = Math.min(box.min[k], coordinates[i + k]);
        box.max[k] = Math.max(box.max[k], coordinates[i + k]);
      }
    }
  };
  measure(vertices, true);
  measure(edges, true);
  measure(near, vertices.length + edges.length === 0);
  if (!(reach > 0)) reach = 1;

  // ---- the camera: a turntable about z, without perspective, so that lengths compare

  // Until somebody moves it, it fits the part into whatever size the window has.
  const camera = { azimuth: -60, elevation: 28, target: [0, 0, 0], half: 1, fits: true };
  const axes = () => {
    const [a, e] = [camera.azimuth, camera.elevation].map((degrees) => degrees * Math.PI / 180);
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    return { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], back: [ce * ca, ce * sa, se] };
  };
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const aspect = () => canvas.clientWidth / Math.max(1, canvas.clientHeight);
  const fit = () => {
    camera.fits = true;
    const { right, up } = axes();
    const low = [Infinity, Infinity];
    const high = [-Infinity, -Infinity];
    for (let corner = 0; corner < 8; corner++) {
      const p = [0, 1, 2].map((k) => ((corner >> k) & 1 ? box.max[k] : box.min[k]));
      [dot(p, right), dot(p, up)].forEach((x, k) => {
        low[k] = Math.min(low[k], x);
        high[k] = Math.max(high[k], x);
      });
    }
    if (!(low[0] <= high[0])) return;
    // beside the colour bar
    const free = Math.max(0.3, 1 - 112 / Math.max(1, canvas.clientWidth));
    camera.half = Math.max((high[1] - low[1]) / 2 / 0.9, (high[0] - low[0]) / 2 / aspect() / (0.94 * free), 1e-6 * reach);
    const aside = camera.half * aspect() * (1 - free);
    camera.target = [0, 1, 2].map((k) => (box.min[k] + box.max[k]) / 2 + aside * right[k]);
  };
  const pan = (dx, dy) => {
    camera.fits = false;
    const { right, up } = axes();
    const unit = 2 * camera.half / canvas.clientHeight;
    camera.target = camera.target.map((t, k) => t - unit * (dx * right[k] - dy * up[k]));
  };
  const turn = (dx, dy) => {
    camera.fits = false;
    camera.azimuth = (camera.azimuth - dx) % 360;
    camera.elevation = Math.min(90, Math.max(-90, camera.elevation + dy));
  };
  // What lies under the pointer stays there.
  const zoom = (factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) => {
    const before = camera.half;
    camera.fits = false;
    camera.half = Math.min(20 * reach, Math.max(1e-6 * reach, camera.half * factor));
    const moved = 1 - camera.half / before;
    const [dx, dy] = [x - canvas.clientWidth / 2, y - canvas.clientHeight / 2];
    const { right, up } = axes();
    const unit = 2 * before / canvas.clientHeight;
    camera.target = camera.target.map((t, k) => t + moved * unit * (dx * right[k] - dy * up[k]));
  };

  // ---- WebGL

  const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
  let redraw = () => {};
  if (!gl) {
    fail("The picture needs WebGL 2, which this browser does not give.");
    return;
  }

  const common = `#version 300 es
    precision highp float;
    uniform mat3 turning;
    uniform vec3 target;
    uniform vec2 extent;   // half of what is seen, in lengths
    uniform float depth;   // of all there is, in lengths
    vec4 placed(vec3 p) { return vec4(p.xy / extent, -p.z / depth, 1.0); }
  `;
  const plain = `#version 300 es
    precision highp float;
    uniform vec3 colour;
    out vec4 seen;
    void main() { seen = vec4(colour, 1.0); }
  `;
  const program = (vertex, fragment) => {
    const made = gl.createProgram();
    [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    });
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(made));
    const places = new Map();
    return {
      use: () => gl.useProgram(made),
      attribute: (name) => gl.getAttribLocation(made, name),
      uniform: (name) => {
        if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
        return places.get(name);
      },
    };
  };

  let made = null;
  const make = () => {
    const part = program(
      `${common}
      in vec3 position;
      in vec3 normal;
      out vec3 facing;
      void main() {
        gl_Position = placed(turning * (position - target));
        facing = turning * normal;
      }`,
      `#version 300 es
      precision highp float;
      in vec3 facing;
      uniform vec3 colour;
      out vec4 seen;
      void main() {
        vec3 n = normalize(facing);
        if (n.z < 0.0) n = -n;
        float key = max(dot(n, normalize(vec3(-0.45, 0.6, 0.75))), 0.0);
        float fill = max(dot(n, normalize(vec3(0.8, -0.2, 0.5))), 0.0);
        float shine = pow(max(dot(n, normalize(vec3(-0.22, 0.32, 1.0))), 0.0), 40.0);
        seen = vec4(colour * (0.36 + 0.58 * key + 0.2 * fill) + 0.08 * shine, 1.0);
      }`,
    );
    const edge = program(
      `${common}
      uniform float unit;    // of a pixel, in lengths
      uniform float width;   // in pixels
      uniform float raised;
      in vec2 corner;
      in vec3 from;
      in vec3 to;
      void main() {
        vec3 p = turning * (from - target);
        vec3 q = turning * (to - target);
        vec2 along = q.xy - p.xy;
        float span = length(along);
        along = span > 0.0 ? along / span : vec2(1.0, 0.0);
        vec3 at = corner.x < 0.5 ? p : q;
        at.xy += 0.5 * width * unit * (corner.y * vec2(-along.y, along.x) + 0.5 * (2.0 * corner.x - 1.0) * along);
        at.z += raised;
        gl_Position = placed(at);
      }`,
      plain,
    );
    const pointVertex = (paint) => `${common}
      uniform float raised;  // towards the eye: a point just behind its surface is seen too
      uniform float apart;   // depths are told apart by so much: of points in one place the later one is seen, and not the highest
      uniform float size;
      in vec3 position;
      ${paint ? "in vec4 tint; out vec3 colour;" : "flat out uint name;"}
      void main() {
        vec3 p = turning * (position - target);
        p.z = (floor(p.z / apart) + 1.0) * apart + raised;
        gl_Position = placed(p);
        gl_PointSize = size;
        ${paint ? "colour = tint.rgb;" : "name = uint(gl_VertexID) + 1u;"}
      }`;
    const point = program(
      pointVertex(true),
      `#version 300 es
      precision highp float;
      in vec3 colour;
      uniform float size;
      uniform float ring;
      uniform vec3 rim;
      out vec4 seen;
      void main() {
        float from_rim = 0.5 * size * (1.0 - length(2.0 * gl_PointCoord - 1.0));
        if (from_rim < 0.0) discard;
        float within = size < 5.0 ? 1.0 : smoothstep(0.0, 1.0, from_rim - ring);
        seen = vec4(mix(mix(colour, rim, ring > 1.0 ? 1.0 : 0.55), colour, within), 1.0);
      }`,
    );
    const name = program(
      pointVertex(false),
      `#version 300 es
      precision highp float;
      flat in uint name;
      out vec4 seen;
      void main() {
        if (length(2.0 * gl_PointCoord - 1.0) > 1.0) discard;
        seen = vec4(name & 255u, (name >> 8) & 255u, (name >> 16) & 255u, name >> 24) / 255.0;
      }`,
    );
    const array = () => {
      const made = gl.createVertexArray();
      gl.bindVertexArray(made);
      return made;
    };
    const buffer = (data, target = gl.ARRAY_BUFFER) => {
      const made = gl.createBuffer();
      gl.bindBuffer(target, made);
      gl.bufferData(target, data, gl.STATIC_DRAW);
      return made;
    };
    const attribute = (place, size, type = gl.FLOAT, stride = 0, offset = 0, step = 0) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, type, type === gl.UNSIGNED_BYTE, stride, offset);
      gl.vertexAttribDivisor(place, step);
    };
    const partArray = array();
    buffer(vertices);
    attribute(part.attribute("position"), 3);
    buffer(normals);
    attribute(part.attribute("normal"), 3);
    buffer(triangles, gl.ELEMENT_ARRAY_BUFFER);
    const edgeArray = array();
    buffer(new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]));
    attribute(edge.attribute("corner"), 2);
    buffer(edges);
    attribute(edge.attribute("from"), 3, gl.FLOAT, 24, 0, 1);
    attribute(edge.attribute("to"), 3, gl.FLOAT, 24, 12, 1);
    const pointArray = array();
    const places = buffer(near);
    attribute(point.attribute("position"), 3);
    buffer(colours);
    attribute(point.attribute("tint"), 4, gl.UNSIGNED_BYTE);
    const nameArray = array();
    gl.bindBuffer(gl.ARRAY_BUFFER, places);
    attribute(name.attribute("position"), 3);
    gl.bindVertexArray(null);
    made = { part, edge, point, name, partArray, edgeArray, pointArray, nameArray, target: null };
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  };

  const shown = { part: byId("show-part"), points: byId("show-points"), edges: byId("show-edges") };
  const sizeInput = byId("size");
  let printing = false;
  let picked = -1;
  let highlighted = -1;

  const look = () => {
    const dark = !printing && getComputedStyle(root).getPropertyValue("--dark").trim() === "1";
    return dark
      ? { part: [0.60, 0.64, 0.70], marked: [0.66, 0.54, 0.88], edge: [0.06, 0.07, 0.09], bare: [0.75, 0.79, 0.84], rim: [0.80, 0.83, 0.87], ring: [1, 1, 1] }
      : { part: [0.72, 0.75, 0.80], marked: [0.68, 0.56, 0.90], edge: [0.13, 0.16, 0.20], bare: [0.13, 0.16, 0.20], rim: [0.10, 0.12, 0.15], ring: [0, 0, 0] };
  };
  const ratio = () => canvas.width / Math.max(1, canvas.clientWidth);
  const setCamera = (program) => {
    program.use();
    const { right, up, back } = axes();
    gl.uniformMatrix3fv(program.uniform("turning"), false, [0, 1, 2].flatMap((k) => [right[k], up[k], back[k]]));
    gl.uniform3fv(program.uniform("target"), camera.target);
    gl.uniform2f(program.uniform("extent"), camera.half * aspect(), camera.half);
    gl.uniform1f(program.uniform("depth"), 1.1 * (reach + Math.hypot(...camera.target)));
  };
  const unit = () => 2 * camera.half / Math.max(1, canvas.height);
  const depthStep = Math.min(0.02 * reach, 2 * scene.limit);
  const raised = () => Math.min(0.02 * reach, 1.25 * scene.limit) + 3 * unit();

  const drawPart = (colour, marked) => {
    setCamera(made.part);
    gl.bindVertexArray(made.partArray);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.uniform3fv(made.part.uniform("colour"), colour);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
    // once more over it, in the same places
    const again = ({ first, indices }, colour) => {
      gl.uniform3fv(made.part.uniform("colour"), colour);
      gl.drawElements(gl.TRIANGLES, indices, gl.UNSIGNED_INT, 4 * first);
    };
    coloured.forEach((one) => again(one, one.colour));
    if (highlighted >= 0) again(scene.faces[highlighted], marked);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  };

  const draw = () => {
    if (gl.isContextLost()) return;
    const pixels = Math.min(3, window.devicePixelRatio || 1);
    const [width, height] = [Math.round(canvas.clientWidth * pixels), Math.round(canvas.clientHeight * pixels)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const tints = look();
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (shown.part.checked && triangles.length > 0) drawPart(tints.part, tints.marked);
    if (shown.edges.checked && edges.length > 0) {
      setCamera(made.edge);
      gl.uniform1f(made.edge.uniform("unit"), unit());
      gl.uniform1f(made.edge.uniform("width"), 1.3 * ratio());
      gl.uniform1f(made.edge.uniform("raised"), 1.5 * unit());
      gl.uniform3fv(made.edge.uniform("colour"), shown.part.checked && triangles.length > 0 ? tints.edge : tints.bare);
      gl.bindVertexArray(made.edgeArray);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, edges.length / 6);
    }
    if (shown.points.checked && count > 0) {
      setCamera(made.point);
      gl.bindVertexArray(made.pointArray);
      const size = Number(sizeInput.value) * ratio();
      gl.uniform1f(made.point.uniform("apart"), depthStep);
      gl.uniform1f(made.point.uniform("raised"), raised());
      gl.uniform1f(made.point.uniform("size"), size);
      gl.uniform1f(made.point.uniform("ring"), 0);
      gl.uniform3fv(made.point.uniform("rim"), tints.rim);
      gl.drawArrays(gl.POINTS, 0, count);
      if (picked >= 0) {
        gl.uniform1f(made.point.uniform("raised"), raised() + 4 * unit());
        gl.uniform1f(made.point.uniform("size"), size + 8 * ratio());
        gl.uniform1f(made.point.uniform("ring"), 2 * ratio());
        gl.uniform3fv(made.point.uniform("rim"), tints.ring);
        gl.drawArrays(gl.POINTS, picked, 1);
      }
    }
  };
  let waiting = false;
  redraw = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  };

  // ---- which point is under the pointer: the points' names drawn around it, behind the same part

  const nameTarget = () => {
    const [width, height] = [canvas.width, canvas.height];
    if (made.target && made.target.width === width && made.target.height === height) return made.target.frame;
    if (made.target) {
      gl.deleteFramebuffer(made.target.frame);
      made.target.buffers.forEach((buffer) => gl.deleteRenderbuffer(buffer));
    }
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const formats = [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]];
    const buffers = formats.map(([format, attachment]) => {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      return buffer;
    });
    made.target = { frame, buffers, width, height };
    return frame;
  };
  const pick = (x, y) => {
    if (gl.isContextLost() || !shown.points.checked || count === 0 || canvas.width === 0) return -1;
    const around = Math.ceil(5 * ratio());
    const side = 2 * around + 1;
    const [left, bottom] = [Math.round(x * ratio()) - around, canvas.height - Math.round(y * ratio()) - around];
    gl.bindFramebuffer(gl.FRAMEBUFFER, nameTarget());
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(left, bottom, side, side);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (shown.part.checked && triangles.length > 0) {
      gl.colorMask(false, false, false, false);
      drawPart([0, 0, 0], [0, 0, 0]);
      gl.colorMask(true, true, true, true);
    }
    setCamera(made.name);
    gl.bindVertexArray(made.nameArray);
    gl.uniform1f(made.name.uniform("apart"), depthStep);
    gl.uniform1f(made.name.uniform("raised"), raised());
    gl.uniform1f(made.name.uniform("size"), Number(sizeInput.value) * ratio());
    gl.drawArrays(gl.POINTS, 0, count);
    const seen = new Uint8Array(4 * side * side);
    gl.readPixels(left, bottom, side, side, gl.RGBA, gl.UNSIGNED_BYTE, seen);
    gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    let [best, name] = [Infinity, 0];
    for (let i = 0; i < side * side; i++) {
      const here = seen[4 * i] + 256 * (seen[4 * i + 1] + 256 * (seen[4 * i + 2] + 256 * seen[4 * i + 3]));
      const away = Math.hypot((i % side) - around, Math.floor(i / side) - around);
      if (here > 0 && away < best) [best, name] = [away, here];
    }
    return name - 1;
  };

  // ---- what is told of a point

  const tip = byId("tip");
  const digits = (value, places) => (scene.decimals === null ? value.toExponential(3 + places) : value.toFixed(scene.decimals + places));
  // Rounded downwards, so that what is shown is proven too.
  const downwards = (value) => {
    const places = Math.min(15, (scene.decimals ?? 9) + 6);
    const step = 10 ** places;
    return scene.decimals === null || value * step > 2 ** 52 ? String(value) : (Math.floor(value * step) / step).toFixed(places);
  };
  const tell = (index, x, y) => {
    if (index !== picked) {
      picked = index;
      redraw();
    }
    tip.hidden = index < 0;
    if (index < 0) return;
    const { id, name } = scene.faces[face[index]];
    const value = deviation[index];
    const title = document.createElement("b");
    const chip = document.createElement("span");
    chip.className = "chip";
    chip.style.background = `rgb(${colourOf(value).join(" ")})`;
    const signed = (flags[index] & NO_SIDE) === 0;
    title.append(chip, `${signed && value > 0 ? "+" : ""}${digits(value, 1)} ${scene.unit}${signed ? "" : " (no side)"}`);
    const list = document.createElement("dl");
    const rows = [
      ["line", `${line[index]}`],
      ...["x", "y", "z"].map((axis, k) => [axis, `${position[3 * index + k]}`]),
      ["deviation", digits(value, 6)],
      ["lower bound", downwards(lowerBound[index])],
      ["face", name === "" ? `${id}` : `${id} ${name}`],
    ];
    if (flags[index] & NOT_CERTIFIED) rows.push(["proof", "not certified"]);
    rows.forEach(([term, text]) => {
      const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
      dt.textContent = term;
      dd.textContent = text;
      list.append(dt, dd);
    });
    tip.replaceChildren(title, list);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const left = x + 16 + tip.offsetWidth > width ? x - 16 - tip.offsetWidth : x + 16;
    const top = y + 16 + tip.offsetHeight > height ? y - 16 - tip.offsetHeight : y + 16;
    tip.style.transform = `translate(${Math.max(4, Math.min(left, width - tip.offsetWidth - 4))}px, ${Math.max(4, Math.min(top, height - tip.offsetHeight - 4))}px)`;
  };

  // ---- hands on it

  const held = new Map();
  let moved = false;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, at(event));
    moved = false;
    canvas.classList.add("held");
  });
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = at(event);
    const before = held.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== "touch") tell(pick(x, y), x, y);
      return;
    }
    const [dx, dy] = [x - before[0], y - before[1]];
    if (!moved && Math.hypot(dx, dy) < 3) return;
    moved = true;
    tell(-1);
    if (held.size === 1) {
      if (event.shiftKey || event.buttons & 6) pan(dx, dy);
      else turn(0.4 * dx, 0.4 * dy);
    } else {
      const [other] = [...held].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const apart = (a, b) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
      pan(dx / 2, dy / 2);
      zoom(apart(before, other) / apart([x, y], other), (x + other[0]) / 2, (y + other[1]) / 2);
    }
    held.set(event.pointerId, [x, y]);
    redraw();
  });
  const release = (event) => {
    const [x, y] = at(event);
    const was = held.delete(event.pointerId);
    if (held.size === 0) canvas.classList.remove("held");
    if (was && !moved && event.type === "pointerup") tell(pick(x, y), x, y);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType !== "touch" && held.size === 0) tell(-1);
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 0 ? event.deltaY : 30 * event.deltaY;
    zoom(Math.exp(0.0015 * Math.max(-400, Math.min(400, lines))), ...at(event));
    tell(-1);
    redraw();
  }, { passive: false });
  const keys = {
    ArrowLeft: (move) => (move ? pan(40, 0) : turn(-5, 0)),
    ArrowRight: (move) => (move ? pan(-40, 0) : turn(5, 0)),
    ArrowUp: (move) => (move ? pan(0, 40) : turn(0, -5)),
    ArrowDown: (move) => (move ? pan(0, -40) : turn(0, 5)),
    "+": () => zoom(0.8),
    "=": () => zoom(0.8),
    "-": () => zoom(1.25),
    Home: () => fit(),
  };
  canvas.addEventListener("keydown", (event) => {
    const does = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
    if (!does) return;
    event.preventDefault();
    does(event.shiftKey);
    tell(-1);
    redraw();
  });
  document.querySelectorAll("[data-view]").forEach((button) => button.addEventListener("click", () => {
    [camera.azimuth, camera.elevation] = button.dataset.view.split(" ").map(Number);
    fit();
    redraw();
  }));
  Object.values(shown).forEach((input) => input.addEventListener("change", () => {
    tell(-1);
    redraw();
  }));
  sizeInput.addEventListener("input", redraw);

  // Names in the table show their faces in the picture.
  if (table) {
    const indices = new Map(scene.faces.map(({ id }, index) => [`${id}`, index]));
    [...table.tBodies[0].rows].forEach((row) => {
      const index = indices.get(row.cells[0].textContent);
      if (index === undefined || scene.faces[index].indices === 0) return;
      const cell = row.cells[1];
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = cell.textContent || "face";
      button.title = "Show this face in the picture";
      button.setAttribute("aria-pressed", "false");
      button.addEventListener("click", () => {
        const on = highlighted !== index;
        table.querySelectorAll("[aria-pressed]").forEach((other) => other.setAttribute("aria-pressed", "false"));
        button.setAttribute("aria-pressed", `${on}`);
        highlighted = on ? index : -1;
        redraw();
      });
      cell.replaceChildren(button);
    });
  }

  window.addEventListener("beforeprint", () => {
    printing = true;
    tell(-1);
    draw();
  });
  window.addEventListener("afterprint", () => {
    printing = false;
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => {
    make();
    redraw();
  });

  // ---- first picture

  make();
  const area = canvas.clientWidth * canvas.clientHeight;
  sizeInput.value = Math.min(8, Math.max(3, 0.45 * Math.sqrt(area / Math.max(1, count))));
  message.hidden = true;
  ["tools", "keys"].forEach((id) => { byId(id).hidden = false; });
  new ResizeObserver(() => {
    if (camera.fits) fit();
    draw();
  }).observe(canvas);
  fit();
  draw();
  const problem = gl.getError();
  if (problem !== gl.NO_ERROR) throw new Error(`WebGL error ${problem}`);
  root.dataset.points = count;
  root.dataset.triangles = triangles.length / 3;
  root.dataset.state = "drawn";
})();
