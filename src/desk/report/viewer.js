// The viewer of a report: particles as shaded spheres, which are points of WebGL 2 with a depth of their own.
// Frames stand in the page as base64 of deflated bytes (src/report/viewer/frames.rs) and are unpacked when they
// are first shown. Lengths are in units of half the scene, from its middle.
"use strict";
(() => {
  const at = (id) => document.getElementById(id);
  const all = (name) => [...document.querySelectorAll(`[data-${name}]`)];
  const canvas = at("canvas");
  const gl = canvas?.getContext("webgl2", { alpha: true, preserveDrawingBuffer: true });
  if (!gl || !window.DecompressionStream) return; // No viewer in the page, or what it says without one stays.
  at("no-viewer").hidden = true;
  at("live").hidden = false;
  const scene = JSON.parse(at("scene").textContent);
  const axes = [0, 1, 2];
  const middle = axes.map((k) => (scene.lower[k] + scene.upper[k]) / 2);
  const half = Math.hypot(...axes.map((k) => scene.upper[k] - scene.lower[k])) / 2 || 1;
  const own = (x, k) => (x - middle[k]) / half;

  const vertex = `#version 300 es
    precision highp float;
    layout(location=0) in float x; layout(location=1) in float y; layout(location=2) in float z;
    layout(location=3) in float size; layout(location=4) in float body; layout(location=5) in float value;
    uniform vec3 lower, span, flip, shift, right, up, ahead, view;
    uniform vec4 cut;
    uniform float aspect, pixels, radius, deep, byField;
    uniform sampler2D palette;
    out vec3 colour; out float near;
    void main() {
      vec3 p = (lower + span * vec3(x, y, z)) * flip + shift;
      vec4 c = texelFetch(palette, ivec2(int(body), 0), 0);
      bool seen = c.a > 0.5 && dot(cut.xyz, p) <= cut.w;
      colour = byField > 0.5 ? texelFetch(palette, ivec2(int(value), 1), 0).rgb : c.rgb;
      float r = radius * size;
      near = 0.5 * r * deep;
      vec2 flat_ = (vec2(dot(right, p), dot(up, p)) - view.xy) * view.z;
      gl_Position = seen ? vec4(flat_.x / aspect, flat_.y, dot(ahead, p) * deep, 1) : vec4(2, 2, 2, 1);
      gl_PointSize = max(1.0, 2.0 * r * pixels * view.z);
    }`;
  const fragment = `#version 300 es
    precision highp float;
    in vec3 colour; in float near; out vec4 paint;
    void main() {
      vec2 d = 2.0 * gl_PointCoord - 1.0;
      float q = 1.0 - dot(d, d);
      if (q < 0.0) discard;
      vec3 normal = vec3(d.x, -d.y, sqrt(q));
      float light = 0.42 + 0.58 * max(dot(normal, vec3(-0.36, 0.48, 0.8)), 0.0);
      paint = vec4(colour * light, 1);
      gl_FragDepth = gl_FragCoord.z - near * normal.z;
    }`;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) console.error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const places = {};
  const set = (name, ...v) => {
    places[name] ??= gl.getUniformLocation(program, name);
    gl[`uniform${v.length}f`](places[name], ...v);
  };
  const [positions, bytes] = [gl.createBuffer(), gl.createBuffer()];
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);

  // Frames: unpacked ones are kept, the oldest go.
  const unpacked = new Map();
  const unpack = async (k) => {
    if (unpacked.has(k)) return unpacked.get(k);
    const packed = Uint8Array.from(atob(at(`frame${k}`).textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const raw = new Uint8Array(await new Response(stream).arrayBuffer());
    const n = scene.frames[k].n;
    const place = new Uint16Array(3 * n);
    for (const axis of axes) {
      const [high, low] = [raw.subarray(2 * axis * n), raw.subarray((2 * axis + 1) * n)];
      for (let i = 0, sum = 0; i < n; i++) {
        sum = (sum + 256 * high[i] + low[i]) & 65535;
        place[axis * n + i] = sum;
      }
    }
    const frame = { n, place, rest: raw.subarray(6 * n) };
    unpacked.set(k, frame);
    if (unpacked.size > 40) unpacked.delete(unpacked.keys().next().value);
    return frame;
  };

  let [shown, wanted, colour] = [-1, 0, 0];
  let frame = null;
  const show = async (k) => {
    wanted = k;
    const next = await unpack(k);
    if (wanted !== k) return;
    [frame, shown] = [next, k];
    gl.bindBuffer(gl.ARRAY_BUFFER, positions);
    gl.bufferData(gl.ARRAY_BUFFER, frame.place, gl.DYNAMIC_DRAW);
    for (const axis of axes) attribute(axis, gl.UNSIGNED_SHORT, true, 2 * axis * frame.n);
    gl.bindBuffer(gl.ARRAY_BUFFER, bytes);
    gl.bufferData(gl.ARRAY_BUFFER, frame.rest, gl.DYNAMIC_DRAW);
    at("time").value = k;
    at("clock").textContent = scene.frames[k].time;
    draw();
  };
  const attribute = (place, kind, normalised, offset) => {
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 1, kind, normalised, 0, offset);
  };

  // The camera: z is up, without a turn it looks along y; a flat model is seen from above. At first the scene fills the
  // picture, whatever its shape.
  const home = () => ({ ...(scene.dimension < 3 ? { yaw: 0, pitch: Math.PI / 2 } : { yaw: scene.yaw + 0.5, pitch: 0.35 }), zoom: 1, x: 0, y: 0 });
  let camera = home();
  const look = ({ yaw, pitch }) => {
    const [s, c, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
    return { right: [c, s, 0], up: [-s * sp, c * sp, cp], ahead: [-s * cp, c * cp, -sp] };
  };
  const fit = () => {
    const { right, up } = look(home());
    const most = (axis) => axes.reduce((sum, k) => sum + Math.abs(axis[k]) * (scene.upper[k] - scene.lower[k]) / 2 / half, 1e-9);
    return 0.92 / Math.max(most(right) * canvas.clientHeight / canvas.clientWidth, most(up));
  };
  const unit = (axis, sign = 1) => axes.map((k) => (k === axis ? sign : 0));
  const paint = () => {
    queued = false;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.max(1, Math.round(x * scale)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!frame) return;
    const { n } = frame;
    gl.bindBuffer(gl.ARRAY_BUFFER, bytes);
    attribute(3, gl.UNSIGNED_BYTE, true, n);
    attribute(4, gl.UNSIGNED_BYTE, false, 0);
    attribute(5, gl.UNSIGNED_BYTE, false, (colour > 0 ? colour + 1 : 0) * n);
    for (const [name, axis] of Object.entries(look(camera))) set(name, ...axis);
    const aspect = width / height;
    set("view", camera.x, camera.y, camera.zoom * fit());
    set("aspect", aspect);
    set("pixels", height / 2);
    set("radius", (scene.size * scene.enlarge) / 2 / half);
    set("byField", colour > 0 ? 1 : 0);
    const { lower, upper } = scene.frames[shown];
    set("lower", ...axes.map((k) => own(lower[k], k)));
    set("span", ...axes.map((k) => (upper[k] - lower[k]) / half));
    set("deep", 0.99 / scene.reach * half);
    const axis = +at("cut").value;
    const sign = at("other-side").checked ? -1 : 1;
    const place = lowest(axis) + (highest(axis) - lowest(axis)) * at("cut-at").value / 1000;
    set("cut", ...(axis < 0 ? [0, 0, 0, 1] : [...unit(axis, sign), sign * own(place, axis)]));
    at("cut-place").textContent = axis < 0 ? "" : `${"xyz"[axis]} = ${(place / scene.unit.size).toPrecision(3)} ${scene.unit.name}`;
    const mirrors = all("mirror").filter((box) => box.checked).map((box) => scene.mirrors[+box.dataset.mirror]);
    for (let images = 0; images < 1 << mirrors.length; images++) {
      const [flip, shift] = [[1, 1, 1], [0, 0, 0]];
      mirrors.forEach(({ axis: k, position }, m) => {
        if (images >> m & 1) [flip[k], shift[k]] = [-1, 2 * own(position, k)];
      });
      set("flip", ...flip);
      set("shift", ...shift);
      gl.drawArrays(gl.POINTS, 0, n);
    }
  };
  const lowest = (k) => Math.min(scene.lower[k] ?? 0, scene.upper[k] ?? 0);
  const highest = (k) => scene.upper[k] ?? 0;
  let queued = false;
  const draw = () => {
    if (!queued) requestAnimationFrame(paint);
    queued = true;
  };

  // Colours: the first row of a texture those of bodies, the second those of the field; 0 is no number.
  const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
  const dress = () => {
    colour = +at("colour").value;
    const table = new Uint8Array(2 * 256 * 4);
    const boxes = all("body");
    for (let i = 0; i < 256; i++) {
      const body = scene.bodies[i];
      table.set([...rgb(body?.colour ?? "#999999"), boxes[i] && !boxes[i].checked ? 0 : 255], 4 * i);
    }
    const field = scene.fields[colour - 1];
    at("legend").hidden = !field;
    if (field) {
      const stops = field.stops.map(rgb);
      for (let i = 1; i < 256; i++) {
        const share = (i - 1) / 254 * (stops.length - 1);
        const first = Math.min(Math.floor(share), stops.length - 2);
        const mix = axes.map((k) => stops[first][k] + (share - first) * (stops[first + 1][k] - stops[first][k]));
        table.set([...mix, 255], 4 * (256 + i));
      }
      table.set([255, 0, 255, 255], 4 * 256);
      at("ramp").style.background = `linear-gradient(90deg, ${field.stops.join(", ")})`;
      at("ticks").replaceChildren(...field.ticks.map((text) => {
        const tick = document.createElement("span");
        tick.textContent = text;
        return tick;
      }));
      at("legend-name").textContent = field.name;
    }
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 2, 0, gl.RGBA, gl.UNSIGNED_BYTE, table);
    draw();
  };

  // Time goes on by itself only when asked to, and by single steps for those who want less motion.
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const count = scene.frames.length;
  let timer = 0;
  const stop = () => {
    clearTimeout(timer);
    timer = 0;
    at("play").textContent = "▶ Play";
  };
  const tick = async () => {
    await show((wanted + 1) % count);
    if (timer) timer = setTimeout(tick, calm.matches ? 1500 : 160);
  };
  const play = () => {
    if (timer) return stop();
    at("play").textContent = "❚❚ Pause";
    timer = setTimeout(tick, 0);
  };
  const step = (by) => { stop(); show(Math.min(Math.max(wanted + by, 0), count - 1)); };
  const turn = (yaw, pitch) => {
    camera.yaw += yaw;
    camera.pitch = Math.min(Math.max(camera.pitch + pitch, -Math.PI / 2), Math.PI / 2);
    draw();
  };
  const zoom = (by) => { camera.zoom = Math.min(Math.max(camera.zoom * by, 0.05), 200); draw(); };
  const pan = (dx, dy) => {
    const size = 2 / (canvas.clientHeight * camera.zoom * fit());
    camera.x -= dx * size;
    camera.y += dy * size;
    draw();
  };

  const keys = {
    ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    " ": play, "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2),
    ".": () => step(1), ",": () => step(-1), Home: () => { camera = home(); draw(); },
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  const fingers = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - last[0], now[1] - last[1]];
    const others = [...fingers].filter(([id]) => id !== event.pointerId);
    fingers.set(event.pointerId, now);
    if (others.length) {
      const apart = (p) => Math.hypot(p[0] - others[0][1][0], p[1] - others[0][1][1]);
      zoom(apart(now) / (apart(last) || 1));
      pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) pan(dx, dy);
    else turn(-dx * 0.008, dy * 0.008);
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return; // The page scrolls until the viewer is chosen.
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.0015));
  }, { passive: false });

  at("play").addEventListener("click", play);
  at("home").addEventListener("click", keys.Home);
  at("time").addEventListener("input", () => { stop(); show(+at("time").value); });
  at("colour").addEventListener("input", dress);
  for (const box of all("body")) box.addEventListener("input", dress);
  for (const box of [...all("mirror"), at("cut"), at("cut-at"), at("other-side")]) box.addEventListener("input", draw);
  new ResizeObserver(draw).observe(canvas);
  dress();
  show(count - 1);
})();
